//! **Jostle**: a 2D physics engine without a window. A scene is a RON file. The results are films, numbers and a
//! statement of their error.
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
//! Each room of the engine is a crate in `src/`, and this crate re-exports them. They are [`simd`], the language in
//! [`scene`], the physics, [`raster`] and [`output`], [`problems`] and [`report`]. No dependence points back:
//! [`raster`] and [`output`] use no ECS type, and a physical model does not use pictures.
//!
//! ```
//! use jostle::prelude::*;
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

#[doc(inline)]
pub use jostle_simd as simd;

#[doc(inline)]
pub use jostle_engine::{
    constraints, contacts, controllers, expect, forces, integrate, joints, plugins, record, scene, sensors, shapes,
    simulation, threads, tick, world,
};
#[doc(inline)]
pub use jostle_film::{output, raster};
#[doc(inline)]
pub use jostle_report as report;
#[doc(inline)]
pub use jostle_report::problems;

pub mod bevy;
pub mod cli;
pub mod prelude;

pub use jostle_engine::Simulation;
pub use jostle_report::SimulationExt;

/// The examples of the README are run by the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// So are those of the manual of plugins.
#[cfg(doctest)]
#[doc = include_str!("../docs/plugins.md")]
struct Plugins;
