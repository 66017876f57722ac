//! **Jostle**: a 2D physics engine without a window. A scene is a RON file; out come films, numbers and a statement
//! of how wrong they are.
//!
//! ```text
//!  scenes/*.ron                                                *.gif *.png *.csv
//!       |                                                              ^
//!       v                                                              |
//!     scene --> world --> tick --> record --> raster --------------> output
//!                          |         ^
//!                          v         | frames, readings
//!    +-> integrate ( bounds -> forces, contacts -> constraints ) -> sensors -+
//!    +------------------------------ next tick <----------------------------+
//! ```
//!
//! The modules stand in this order. Nothing points back: a module uses those above it in the list below and none under it, and
//! a test holds it. [`raster`] and [`output`] know no ECS type, and a physical model knows nothing of pictures.
//!
//! ```
//! use jostle::{Simulation, scene::Source};
//!
//! let scene = r#"Scene(
//!     format: 1,
//!     clock: (duration: 1, tick: "1 ms", method: VelocityVerlet),
//!     gravity: (0, -10),
//!     bodies: [(name: "ball", at: (0, 5), velocity: (2, 0), atoms: Disc(radius: 0.1))],
//! )"#;
//! let mut simulation = Simulation::load(&Source::new("throw.ron", scene))?;
//! simulation.run_to_end()?;
//! assert!((simulation.bodies().position[0].x - 2.0).abs() < 1e-12);
//! println!("{}", simulation.card());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod digest;
pub(crate) mod numbers;
pub mod threads;
#[doc(inline)]
pub use jostle_simd as simd;

pub mod scene;

pub mod shapes;
pub mod world;

pub mod constraints;
pub mod tick;

pub mod contacts;
pub mod forces;
pub mod joints;

pub mod controllers;

pub mod integrate;

pub mod sensors;

pub mod expect;

pub mod record;

pub mod raster;

pub mod output;

pub mod plugins;
pub mod simulation;

pub mod problems;
pub mod report;

pub mod bevy;
pub mod cli;

pub use simulation::Simulation;

/// The examples of the README are run by the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// So are those of the manual of plugins.
#[cfg(doctest)]
#[doc = include_str!("../docs/plugins.md")]
struct Plugins;
