//! Starting a child process with limits, and watching it: where it is, what it takes, how it ends.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::worker::BROKEN;

/// A child that says nothing for so long is stuck even if it computes nothing.
const SILENCE: Duration = Duration::from_secs(120);
/// Memory that a child may ask for, in KiB.
pub const MEMORY: u64 = 1 << 20;
/// Clock ticks of the kernel's accounts per second: the same on every Linux of today.
const TICKS_PER_SECOND: f64 = 100.0;

/// How a child broke.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Break {
    /// Panic, hang, memory, signal, promise.
    pub kind: &'static str,
    /// What the child was doing: reading, running, drawing.
    pub phase: String,
    /// Where in the code, or in which words.
    pub place: String,
}

impl std::fmt::Display for Break {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} while {}: {}", self.kind, self.phase, self.place)
    }
}

/// What became of a batch.
#[derive(Default)]
pub struct Report {
    /// Scenes that were refused with a message.
    pub refused: u64,
    /// Scenes that ran to the end.
    pub good: u64,
    /// Scenes whose run went wrong and said so.
    pub wrong: u64,
    /// The last scene, and how it broke the child.
    pub broken: Option<(u64, Break)>,
    /// The most processor time that a scene took, in seconds.
    pub slowest: (f64, u64),
}

/// Runs this program as a child with `arguments` and watches it until it ends, or stops it after `patience` seconds of
/// processor time for one mutant. Not time on the clock: machines are busy.
///
/// # Errors
/// When no child can be started.
pub fn watch(arguments: &[String], patience: f64, scratch: &Path) -> std::io::Result<Report> {
    let program = std::env::current_exe()?;
    let limit = format!("ulimit -v {MEMORY} && ulimit -c 0 && exec \"$0\" \"$@\"");
    let mut child = Command::new("sh")
        .args(["-c", &limit])
        .arg(program)
        .args(arguments)
        .current_dir(scratch)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let (marks, errors) = listen(&mut child);
    let mut report = Report::default();
    let mut present = (0_u64, "starting".to_owned());
    let (mut cpu_at_mark, mut heard) = (0.0, Instant::now());
    let stopped = loop {
        match marks.recv_timeout(Duration::from_millis(100)) {
            Ok((number, word)) => {
                heard = Instant::now();
                match word.as_str() {
                    "reading" => {
                        // Where nothing was read from the accounts since, a scene took less than a look does.
                        (cpu_at_mark, present) = (cpu_at_mark, (number, word));
                        if let Some(now) = processor_time(child.id()) {
                            cpu_at_mark = now;
                        }
                        continue;
                    }
                    "refused" => report.refused += 1,
                    "good" => report.good += 1,
                    "wrong" => report.wrong += 1,
                    _ => present.1.clone_from(&word),
                }
                if let Some(now) = processor_time(child.id()).filter(|_| !["running", "drawing"].contains(&&*word)) {
                    let spent = now - cpu_at_mark;
                    if spent > report.slowest.0 {
                        report.slowest = (spent, number);
                    }
                    present.1 = "between scenes".into();
                }
            }
            Err(std::sync::mpsc::RecvTimeoutError::Timeout) => {
                let spent = processor_time(child.id()).map_or(0.0, |now| now - cpu_at_mark);
                if spent > patience || heard.elapsed() > SILENCE {
                    // The child may be gone already.
                    let _ = child.kill();
                    break true;
                }
            }
            Err(std::sync::mpsc::RecvTimeoutError::Disconnected) => break false,
        }
    };
    let status = child.wait()?;
    let errors = errors.join().unwrap_or_default();
    let (number, phase) = present;
    let broke = if stopped {
        Some(Break { kind: "hang", phase, place: format!("more than {patience} s of processor time") })
    } else {
        judge(status, &errors, phase)
    };
    report.broken = broke.map(|broke| (number, broke));
    Ok(report)
}

type Mark = (u64, String);

/// Threads that read what the child says, so that it never waits for a full pipe.
fn listen(child: &mut Child) -> (Receiver<Mark>, JoinHandle<String>) {
    let (send, marks) = channel();
    if let Some(out) = child.stdout.take() {
        std::thread::spawn(move || {
            for line in BufReader::new(out).lines().map_while(Result::ok) {
                let mark =
                    line.split_once(' ').and_then(|(number, word)| Some((number.parse().ok()?, word.to_owned())));
                if mark.is_some_and(|mark| send.send(mark).is_err()) {
                    break;
                }
            }
        });
    }
    let errors = child.stderr.take();
    let errors = std::thread::spawn(move || errors.map(last_words).unwrap_or_default());
    (marks, errors)
}

/// The end of what the child says on standard error: the command line's messages come before a panic.
fn last_words(mut errors: impl Read) -> String {
    const KEPT: usize = 16_384;
    let (mut kept, mut buffer) = (Vec::new(), [0; 4096]);
    while let Ok(count @ 1..) = errors.read(&mut buffer) {
        kept.extend_from_slice(&buffer[..count]);
        if kept.len() > 2 * KEPT {
            kept.drain(..kept.len() - KEPT);
        }
    }
    String::from_utf8_lossy(&kept).into_owned()
}

/// What an exit code and the last words mean; nothing if all is well.
fn judge(status: ExitStatus, errors: &str, phase: String) -> Option<Break> {
    let broke = |kind, place: &str| Some(Break { kind, phase: phase.clone(), place: place.to_owned() });
    let after = |mark: &str| errors.rfind(mark).map(|at| errors[at..].lines().next().unwrap_or(""));
    if let Some(line) = after("memory allocation of") {
        return broke("memory", line.split(" bytes").next().map_or(line, |_| "an allocation beyond the limit"));
    }
    if after("has overflowed its stack").is_some() {
        return broke("stack", "overflow");
    }
    if let Some(line) = after("panicked at") {
        return broke("panic", line.trim_end_matches(':'));
    }
    match status.code() {
        Some(0) => None,
        Some(BROKEN) => {
            // Numbers and names differ from mutant to mutant; the words do not.
            let line = after("broken promise").unwrap_or("");
            let line: String = line.chars().filter(|letter| !letter.is_ascii_digit()).collect();
            broke("promise", line.split(['`', '"']).next().unwrap_or(&line).trim())
        }
        Some(code) => broke("exit", &format!("code {code}")),
        None => broke("signal", &status.to_string()),
    }
}

/// Processor time of a process so far, in seconds; nothing where the kernel does not tell.
fn processor_time(process: u32) -> Option<f64> {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name in brackets may hold blanks; fields are counted behind it: state is the first, times are 12 and 13.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |index: usize| fields.get(index)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / TICKS_PER_SECOND)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_told_apart() {
        use std::os::unix::process::ExitStatusExt;
        let exit = |code: i32| ExitStatus::from_raw(code << 8);
        let kind = |status, errors: &str| judge(status, errors, "reading".into()).map(|broke| broke.kind);
        assert_eq!(kind(exit(0), "error: whatever"), None);
        assert_eq!(kind(exit(101), "thread 'main' panicked at src/x.rs:1:2:\nno"), Some("panic"));
        assert_eq!(kind(ExitStatus::from_raw(6), "memory allocation of 12 bytes failed"), Some("memory"));
        assert_eq!(kind(ExitStatus::from_raw(6), "thread 'main' has overflowed its stack"), Some("stack"));
        assert_eq!(kind(ExitStatus::from_raw(11), ""), Some("signal"));
        assert_eq!(kind(exit(BROKEN), "broken promise: x"), Some("promise"));
        assert_eq!(kind(exit(7), ""), Some("exit"));
    }
}
