//! Ctrl-C: the first one ends a run between two ticks or steps, and the program keeps all that was reached. The second ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

use super::Exit;
use super::say::say;
use crate::simulation::Simulation;
use crate::tick::{Failure, FailureKind};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Whether the command has begun with what an interruption keeps.
static KEEPS: AtomicBool = AtomicBool::new(false);

/// From here on a Ctrl-C is heard, in all commands.
pub(super) fn listen() {
    let end = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Interrupted as i32);
        }
        if !KEEPS.load(Ordering::Relaxed) {
            say("interrupted: there is nothing to keep");
            std::process::exit(Exit::Interrupted as i32);
        }
        say("interrupted: the program keeps all that was reached. Press Ctrl-C again to end it at once");
    };
    // A program that has a handler of its own keeps it.
    let _ = ctrlc::set_handler(end);
}

/// From here on a Ctrl-C ends the program with a word. Trials of a tolerance and a look ahead for the camera keep nothing.
pub(super) fn disarm() {
    KEEPS.store(false, Ordering::Relaxed);
}

/// From here on a Ctrl-C waits for the end of the tick or step.
pub(super) fn arm() {
    KEEPS.store(true, Ordering::Relaxed);
}

/// From here on a Ctrl-C also ends this run inside a tick that takes long.
pub(super) fn reach_into(simulation: &mut Simulation) {
    simulation.ask_inside_ticks(|_| !asked());
}

/// A failure, unless it is the end that the user asked for.
pub(super) fn unless_asked(failure: Failure) -> Option<Failure> {
    (failure.wrong != FailureKind::Stopped).then_some(failure)
}

/// Whether the user asked for the end.
pub(super) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
