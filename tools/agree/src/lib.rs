//! Random scenes from all that the registry lists, and the comparison of their runs.

pub mod chance;
pub mod judge;
pub mod language;
pub mod laws;
pub mod minimise;
pub mod ranges;
pub mod run;
pub mod scene;
pub mod walk;
pub mod ways;
pub mod written;
