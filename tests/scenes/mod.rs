//! The scenes that come with the program, and films of them.

mod film;
mod shipped;
