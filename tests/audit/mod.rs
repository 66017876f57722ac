//! Random scenes against independent references, and the stated errors of runs against the true ones.

mod agreement;
mod crowd;
mod defaults;
mod defects;
mod draw;
mod impact;
mod landings;
mod ran;
mod statements;
mod tolerances;
