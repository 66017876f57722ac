//! The laws of physics and of numerics that the engine must obey. Each file states its law and source, where its
//! tolerances come from, and what it does not test.

mod support;

mod convergence;
mod problems;
