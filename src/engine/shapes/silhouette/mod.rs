//! From the silhouette in a PNG picture to discs that cover it, and how well they do.
//!
//! * [`Fineness::Count`]: the largest discs that fit inside, one after the other, each where it covers most of what is
//!   not covered yet (greedy, of the discs about the medial axis). They never reach outside.
//! * [`Fineness::Radius`]: equal discs that touch on a hexagonal lattice, those of which at least half lies inside; of 36
//!   positions of the lattice the one that covers best. Such a lattice covers 90.7 % of a plane at most.
//!
//! Everything is counted in pixels of a grid whose longer side has 256 to 512: larger pictures are averaged, smaller ones
//! magnified. Counting by pixels knows areas to about one pixel times the length of the outline.

mod cover;
mod embed;
mod mask;

pub(crate) use cover::{Covering, Fineness};
pub(crate) use embed::EMBEDDING;
pub(crate) use mask::Mask;
