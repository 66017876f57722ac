//! Random scenes against independent references, and the stated errors of runs against the true ones.

mod agreement;
mod crowd;
mod defects;
mod draw;
mod impact;
mod landings;
mod other_kind;
mod ran;
mod statements;
