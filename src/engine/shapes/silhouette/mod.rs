//! From the silhouette in a PNG picture to discs that cover it, and the quality of the cover.
//!
//! * [`Fineness::Count`]: the largest discs that fit inside, one after the other. Each covers most of the rest (greedy,
//!   of the discs about the medial axis). They never reach outside.
//! * [`Fineness::Radius`]: equal discs that touch on a hexagonal lattice, if at least half of each lies inside. Of 36
//!   positions of the lattice the best is taken. Such a lattice covers at most pi/sqrt(12) = 0.907 of a plane.
//!
//! All areas are counts of pixels in a grid whose longer side has 256 to 512. Larger pictures are averaged, smaller
//! ones magnified. The error of areas is about one pixel times the length of the outline.

mod cover;
mod embed;
mod mask;

pub(crate) use cover::{Covering, Fineness};
pub(crate) use embed::EMBEDDING;
pub(crate) use mask::Mask;
