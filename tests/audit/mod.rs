//! Random scenes against independent references, and the stated errors of runs against the true ones.

mod agreement;
mod breaking;
mod crowd;
mod defects;
mod draw;
mod impact;
mod landings;
mod ran;
mod soft_contacts;
mod statements;
