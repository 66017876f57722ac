//! The scenes that come with the program, and films of them.

mod extremes;
mod film;
mod manual;
mod shipped;
mod wrong;
