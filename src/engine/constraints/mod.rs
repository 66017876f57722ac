//! Constraints: rows of linear equations between bodies, and the one place that solves them.
//!
//! | file | what it solves |
//! |---|---|
//! | `rows.rs` | held relative accelerations and velocities, exactly, for methods with stages |
//! | `redundant.rs` | which forces are taken where rows depend on each other |
//! | `solver.rs` | the same for joints, by sparse factors (`block_cholesky.rs`) |
//! | `borders.rs` | held contacts beside those factors |
//! | `projection.rs` | places and velocities brought back onto what joints hold |
//! | `rest_solver/` | which bounded forces bring an island to rest within a tick, for methods from tick to tick |
//! | `islands.rs` | which links act on each other |
//!
//! Models give rows in stage Forces ([`Rows::add`]). The engine solves all of them together in stage Constraints. Each
//! model takes its answers in [`Model::take_rows`](crate::tick::Model::take_rows).

mod block_cholesky;
mod borders;
mod dead_point;
pub mod islands;
mod projection;
mod redundant;
pub mod rest_solver;
mod row;
mod rows;
mod solver;

pub use dead_point::DeadPoints;
pub use projection::{Gap, Projection, Standing};
pub use redundant::Share;
pub use row::{LostTo, Row, RowKind, RowSide};
pub use rows::{Booking, Cancelled, Rows};
