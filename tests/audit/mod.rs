//! Random scenes against independent references, and the stated errors of runs against the true ones.

mod agreement;
mod begins_at_rest;
mod crowd;
mod defects;
mod draw;
mod impact;
mod indeterminate;
mod landings;
mod ran;
mod statements;
