//! The command line as its users meet it: the built program, run in folders of its own, one file per promise.

mod check;
mod explain;
mod failures;
mod film_control;
mod flags;
mod fmt;
mod formats;
mod harness;
mod help;
mod interrupt;
mod json;
mod list;
mod look;
mod new;
mod numbers;
mod outputs;
mod plots;
mod scene_files;
mod schema;
mod stills;
mod streams;
mod sweep;
mod test_command;
mod values;
mod warnings;
mod whole_files;
