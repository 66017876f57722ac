//! Constraints: rows of linear equations between bodies, and the one place that solves them.
//!
//! | file | what it solves |
//! |---|---|
//! | `rows.rs` | held relative accelerations and velocities, exactly, for methods with stages |
//! | `redundant.rs` | which forces are taken where rows depend on each other |
//! | `rest_solver/` | which bounded forces bring an island to rest within a tick, for methods from tick to tick |
//! | `islands.rs` | which links act on each other |
//!
//! Models give rows in stage Forces ([`Rows::add`]), the engine solves all of them together in stage Constraints, and each model
//! takes its answers in [`Model::take_rows`](crate::tick::Model::take_rows).

pub mod islands;
mod redundant;
pub mod rest_solver;
mod row;
mod rows;

pub use redundant::Share;
pub use row::{LostTo, Row, Side};
pub use rows::{Booking, Cancelled, Rows};
