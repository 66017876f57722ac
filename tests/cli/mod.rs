//! The command line as its users meet it: the built program, run in folders of its own, one file per promise.

mod check;
mod failures;
mod film_control;
mod flags;
mod formats;
mod harness;
mod help;
mod interrupt;
mod json;
mod look;
mod new;
mod numbers;
mod outputs;
mod scene_files;
mod stills;
mod streams;
mod values;
mod warnings;
mod whole_files;
