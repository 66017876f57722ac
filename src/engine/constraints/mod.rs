//! Constraints: rows of linear equations between bodies, and the one place that solves them.
//!
//! | file | task |
//! |---|---|
//! | `rows.rs` | solves held relative accelerations and velocities, exactly, for methods with stages |
//! | `redundant.rs` | chooses the forces if rows depend on each other |
//! | `solver.rs` | solves the same for joints, by sparse factors (`block_cholesky.rs`) |
//! | `structure.rs` | finds the islands, blocks and borders of these rows, and keeps them while bodies are linked alike |
//! | `borders.rs` | solves held contacts beside those factors |
//! | `cones.rs` | keeps contacts that hold together within their cones and bands |
//! | `unheld.rs` | finds rows that others contradict |
//! | `within_bounds.rs` | finds forces within all bounds, if there are any |
//! | `projection.rs` | brings places and velocities back onto the constraints of joints |
//! | `rest_solver/` | finds bounded forces that bring an island to rest within a tick, for methods from tick to tick |
//! | `islands.rs` | groups the links that act on each other |
//! | `spring_network.rs` | finds the static displacements of bodies that springs hold |
//!
//! Models give rows in stage Forces ([`Rows::add`]). The engine solves all of them together in stage Constraints. Each
//! model takes its answers in [`Model::take_rows`](crate::tick::Model::take_rows).

mod block_cholesky;
mod borders;
mod cones;
mod dead_point;
pub mod islands;
mod projection;
mod redundant;
pub mod rest_solver;
mod row;
mod rows;
mod solver;
pub mod spring_network;
mod structure;
mod unheld;
mod within_bounds;

pub use cones::{Cone, ConePressure, DEPENDENT, HOLDS};
pub use dead_point::DeadPoints;
pub use projection::{Gap, Projection, Standing};
pub use redundant::Share;
pub use row::{LostTo, Row, RowKind, RowSide};
pub use rows::{Booking, Cancelled, Rows};
