//! A sign of life on standard error while a scene is read and prepared. On a terminal it shows after a second. Elsewhere lines tell of it.

use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::ProgressBar;

use super::progress_bar::Lines;
use crate::scene::visible_line;

/// The time before the first sign, and between two of them.
const STEP: Duration = Duration::from_secs(1);

/// Shows how long the reading lasts, until it is dropped.
pub(super) struct Reading {
    done: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Reading {
    /// Begins now, for a scene of a name. Nothing shows a `silent` one.
    pub fn begin(name: &str, silent: bool) -> Self {
        if silent {
            return Self { done: None, thread: None };
        }
        let name = visible_line(name).into_owned();
        if !std::io::stderr().is_terminal() {
            let lines = Lines::begin();
            return Self::show_each(STEP, move |_| {
                if let Some(since) = lines.due() {
                    eprintln!("progress: {}", message(&name, since));
                }
            });
        }
        let mut bar = None;
        Self::show_each(STEP, move |since| {
            let bar = bar.get_or_insert_with(ProgressBar::new_spinner);
            bar.set_message(message(&name, since));
            bar.tick();
        })
    }

    /// Calls `show` after each step with the time since the beginning. It is dropped at the end.
    fn show_each(step: Duration, mut show: impl FnMut(Duration) + Send + 'static) -> Self {
        let (done, ended) = channel();
        let begin = Instant::now();
        let thread = std::thread::spawn(move || {
            while ended.recv_timeout(step) == Err(RecvTimeoutError::Timeout) {
                show(begin.elapsed());
            }
        });
        Self { done: Some(done), thread: Some(thread) }
    }
}

/// A tolerance finds its steps before the run, which takes most of the time.
fn message(name: &str, since: Duration) -> String {
    format!("{name}: reading the scene and finding its steps, {} s", since.as_secs())
}

impl Drop for Reading {
    fn drop(&mut self) {
        self.done = None;
        // The bar is off the screen before anything else is printed.
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_reading_shows_itself_and_a_short_one_does_not() {
        let (send, shown) = channel();
        drop(Reading::show_each(Duration::from_secs(3600), {
            let send = send.clone();
            move |_| {
                let _ = send.send(0);
            }
        }));
        assert!(shown.try_recv().is_err());
        let reading = Reading::show_each(Duration::from_millis(1), move |_| {
            let _ = send.send(1);
        });
        assert_eq!(shown.recv(), Ok(1));
        drop(reading);
        assert!(shown.iter().all(|count| count == 1));
    }
}
