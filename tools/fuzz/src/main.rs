//! Mutates scenes and files that scenes read, and looks for one that makes Jostle panic, hang, take too much memory, end in an undocumented way,
//! refuse without a place, or go on with numbers that are not finite.
//!
//! The parent makes nothing itself: children read, run and draw many mutants each, under limits, and say where they
//! are. When one breaks, its last scene is tried alone, made as small as it still breaks, and stored.

mod bytes;
mod corpus;
mod kinds;
mod minimise;
mod mutate;
mod tokens;
mod watch;
mod worker;

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Parser;
use clap::builder::PossibleValuesParser;

use kinds::Kind;
use watch::{Break, watch};

/// Mutants per child: few enough that a child lasts some seconds.
const BATCH: u64 = 100;
/// How long a finding is made smaller.
const MINIMISING: Duration = Duration::from_secs(120);
/// How many mutants of one kind of finding are stored; the rest is counted.
const STORED: u64 = 3;

/// Mutates scenes, reads them, runs and draws the good ones for a few ticks, and stores every scene that breaks a
/// promise: a panic, more than 5 s of processor time, more than 1 GiB of memory, an undocumented exit code, a mistake
/// without a place, a state that is not finite and nobody says so. Needs Linux.
///
/// Exit codes: 0 nothing found, 1 something found, 2 wrong command line or a file cannot be written.
#[derive(Parser, Debug)]
#[command(name = "jostle_fuzz")]
struct Flags {
    /// Seed of chance: the same seed and the same scenes to begin with give the same mutants
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Seconds to go on for
    #[arg(long, default_value_t = 60)]
    seconds: u64,
    /// What is mutated. Files other than scenes are read by scenes that stay as they are
    #[arg(long, default_value = "scenes", value_parser = PossibleValuesParser::new(kinds::names()))]
    kind: String,
    /// Seconds of processor time that one mutant may take. Runs end after a second, also inside ticks
    #[arg(long, default_value_t = 5.0)]
    patience: f64,
    /// Folder for findings: NAME.ron or of another ending, and NAME.txt that says what it does
    #[arg(long, default_value = "findings")]
    out: PathBuf,
    /// Folders or files to begin with; default: `scenes`, `tests`, `assets` and the fuzzer's own
    #[arg(long)]
    corpus: Vec<PathBuf>,
    /// Try these files as they are, each alone, in place of mutants
    #[arg(long, num_args = 1..)]
    only: Vec<PathBuf>,
    /// What a child does: mutants from this number on
    #[arg(long, hide = true)]
    batch_from: Option<u64>,
    /// What a child does: this file
    #[arg(long, hide = true)]
    child: Option<PathBuf>,
}

/// Prints a line. Whoever reads no further needs to be told nothing.
macro_rules! say {
    ($($words:tt)*) => {
        let _ = writeln!(std::io::stdout(), $($words)*);
    };
}

fn main() -> ExitCode {
    let flags = Flags::parse();
    let scratch = std::env::current_dir().unwrap_or_default();
    let mut kind = match kinds::make(&flags.kind, &flags.corpus()) {
        Ok(kind) => kind,
        Err(error) => return refuse(&format!("files to begin with cannot be read: {error}")),
    };
    if let Some(file) = &flags.child {
        let mutant = std::fs::read(file).expect("the parent wrote the file");
        kind.attempt(&mutant, 0, &scratch);
        return ExitCode::SUCCESS;
    }
    if let Some(from) = flags.batch_from {
        worker::batch(&mut *kind, flags.seed, from, BATCH, &scratch);
        return ExitCode::SUCCESS;
    }
    match Hunt::new(&flags, kind).and_then(Hunt::go) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => refuse(&error.to_string()),
    }
}

fn refuse(why: &str) -> ExitCode {
    eprintln!("error: {why}");
    ExitCode::from(2)
}

impl Flags {
    fn corpus(&self) -> Vec<PathBuf> {
        if !self.corpus.is_empty() {
            return self.corpus.iter().map(|path| path.canonicalize().unwrap_or_else(|_| path.clone())).collect();
        }
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        ["../../scenes", "../../tests", "../../assets", "seeds"].iter().map(|folder| root.join(folder)).collect()
    }
}

/// The parent at work.
struct Hunt<'a> {
    flags: &'a Flags,
    kind: Box<dyn Kind>,
    scratch: PathBuf,
    tried: u64,
    refused: u64,
    good: u64,
    wrong: u64,
    slowest: (f64, u64),
    found: BTreeMap<Break, u64>,
}

impl<'a> Hunt<'a> {
    fn new(flags: &'a Flags, kind: Box<dyn Kind>) -> std::io::Result<Self> {
        let scratch = std::env::temp_dir().join(format!("jostle_fuzz_{}", std::process::id()));
        std::fs::create_dir_all(&scratch)?;
        let found = BTreeMap::new();
        Ok(Self { flags, kind, scratch, tried: 0, refused: 0, good: 0, wrong: 0, slowest: (0.0, 0), found })
    }

    /// Whether nothing was found.
    fn go(mut self) -> std::io::Result<bool> {
        let begin = Instant::now();
        let end = Duration::from_secs(self.flags.seconds);
        if self.flags.only.is_empty() {
            let (mut next, mut told) = (0, Duration::ZERO);
            while begin.elapsed() < end {
                next = self.batch(next)?;
                if begin.elapsed() > told + Duration::from_secs(60) {
                    told = begin.elapsed();
                    say!("{:>6} s: {}", told.as_secs(), self.summary());
                }
            }
        } else {
            for scene in &self.flags.only {
                let broke = self.alone(&std::fs::read(scene)?)?;
                self.tried += 1;
                match broke {
                    Some(broke) => {
                        say!("{}: {broke}", scene.display());
                        *self.found.entry(broke).or_default() += 1;
                    }
                    None => {
                        say!("{}: good", scene.display());
                    }
                }
            }
        }
        std::fs::remove_dir_all(&self.scratch)?;
        say!("{}", self.summary());
        for (broke, times) in &self.found {
            say!("  {times} x {broke}");
        }
        Ok(self.found.is_empty())
    }

    fn summary(&self) -> String {
        let Self { tried, refused, good, wrong, slowest, found, .. } = self;
        format!(
            "{tried} {}: {refused} refused, {good} ran, {wrong} went wrong and said so; {} kinds of findings; the \
             slowest, {}, took {:.2} s",
            self.flags.kind,
            found.len(),
            slowest.1,
            slowest.0
        )
    }

    /// Runs one child; returns the number of the next mutant.
    fn batch(&mut self, from: u64) -> std::io::Result<u64> {
        let mut arguments = self.own_arguments();
        arguments.push(format!("--batch-from={from}"));
        let report = watch(&arguments, self.flags.patience, &self.scratch)?;
        self.refused += report.refused;
        self.good += report.good;
        self.wrong += report.wrong;
        if report.slowest.0 > self.slowest.0 {
            self.slowest = report.slowest;
        }
        let Some((number, broke)) = report.broken else {
            self.tried += BATCH;
            return Ok(from + BATCH);
        };
        self.tried += number + 1 - from;
        let mutant = self.kind.mutant(self.flags.seed, number);
        self.keep(number, &mutant, broke)?;
        Ok(number + 1)
    }

    /// What children need to make the same mutants.
    fn own_arguments(&self) -> Vec<String> {
        let Flags { seed, kind, .. } = self.flags;
        let mut arguments = vec![format!("--seed={seed}"), format!("--kind={kind}")];
        arguments.extend(self.flags.corpus().iter().map(|path| format!("--corpus={}", path.display())));
        arguments
    }

    /// Tries a mutant alone in a child.
    fn alone(&self, mutant: &[u8]) -> std::io::Result<Option<Break>> {
        let file = self.scratch.join("alone").with_extension(self.kind.ending());
        std::fs::write(&file, mutant)?;
        let mut arguments = self.own_arguments();
        arguments.push(format!("--child={}", file.display()));
        let report = watch(&arguments, self.flags.patience, &self.scratch)?;
        Ok(report.broken.map(|(_, broke)| broke))
    }

    /// Stores a finding, as small as it still breaks.
    fn keep(&mut self, number: u64, mutant: &[u8], broke: Break) -> std::io::Result<()> {
        let alone = self.alone(mutant)?;
        let (small, broke, note) = match alone {
            Some(alone) => {
                let times = self.found.get(&alone).copied().unwrap_or(0);
                let small = match std::str::from_utf8(mutant) {
                    Ok(text) if times == 0 && self.kind.is_text() => {
                        let breaks = |text: &str| self.alone(text.as_bytes()).ok().flatten().as_ref() == Some(&alone);
                        minimise::minimise(text, MINIMISING, breaks).into_bytes()
                    }
                    _ => mutant.to_owned(),
                };
                (small, alone, "")
            }
            None => (mutant.to_owned(), broke, "; not when it is read alone"),
        };
        let times = self.found.entry(broke.clone()).or_default();
        *times += 1;
        if *times > STORED {
            return Ok(());
        }
        let seed = self.flags.seed;
        let ending = self.kind.ending();
        say!("mutant {number} of seed {seed}: {broke}{note}");
        std::fs::create_dir_all(&self.flags.out)?;
        let stem = self.flags.out.join(format!("{}_{seed}_{number}", broke.kind));
        std::fs::write(stem.with_extension(ending), small)?;
        std::fs::write(stem.with_extension("txt"), format!("{broke}{note}\nmutant {number} of seed {seed}\n"))
    }
}
