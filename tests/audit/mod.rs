//! Random scenes against references that are written apart from the engine, and what runs state of their error against the
//! truth.

mod agreement;
mod crowd;
mod defects;
mod draw;
mod impact;
mod landings;
mod ran;
mod statements;
