//! Ctrl-C: the first one ends a run between two ticks, and the program keeps all that was reached. The second ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

use super::Exit;
use super::say::say;

static ASKED: AtomicBool = AtomicBool::new(false);

/// From here on a Ctrl-C waits for the end of the tick. Before, it ends the program: nothing is there to be kept.
pub(super) fn arm() {
    let end = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Interrupted as i32);
        }
        say("interrupted: the program keeps all that was reached. Press Ctrl-C again to end it at once");
    };
    // The second scene of a command finds the handler of the first. Without any, Ctrl-C ends the program.
    let _ = ctrlc::set_handler(end);
}

/// Whether the user asked for the end.
pub(super) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
