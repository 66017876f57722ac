//! The scenes that come with the program, and films of them.

mod authoring;
mod authoring_files;
mod drawings;
mod extremes;
mod fills;
mod film;
mod layers;
mod manual;
mod overlaps;
mod packings;
mod pictures;
mod schema;
mod shipped;
mod silhouettes;
mod tour;
mod wrong;
mod wrong_mills;
