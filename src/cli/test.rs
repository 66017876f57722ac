//! `jostle test`: runs all scenes of a folder and checks their expectations.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::Exit;
use super::destination::{is_directory, takes_no_file};
use super::find::scenes_in;
use super::flags::{self, OverrideFlags, StrictFlag};
use super::inputs::is_same_file;
use super::interrupt;
use super::junit;
use super::load::Request;
use super::pace::{Ended, Runner};
use super::progress_bar::Progress;
use super::say::{count, print_json, print_line, say};
use super::side_by_side::{all_cores, in_order};
use super::trial::{Trial, Verdict, told};
use crate::output::write_whole;
use crate::scene::Source;

/// The command `test`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Test {
    /// Folders with scenes (all files *.ron in them and below), scene files, or example:NAME. Default: the current directory
    #[arg(value_name = "DIR|SCENE")]
    places: Vec<String>,
    /// Also write a report as JUnit XML, which build servers read
    #[arg(long, value_name = "FILE.xml")]
    junit: Option<PathBuf>,
    #[command(flatten)]
    overrides: OverrideFlags,
    #[command(flatten)]
    strict: StrictFlag,
    /// Run so many scenes at the same time. No result depends on it. Default: one for each core
    #[arg(long, value_name = "N", value_parser = flags::threads, allow_negative_numbers = true)]
    threads: Option<usize>,
    /// Print only mistakes, broken expectations and the summary
    #[arg(long)]
    quiet: bool,
    /// Print the result of each scene as one line of JSON on standard output
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle test                                  all scenes here and below
  jostle test scenes/ my.ron                   the scenes of a folder, and one more
  jostle test scenes/ --junit report.xml       for a build server
  jostle test scenes/ --tick 0.1ms             do they hold with a finer tick?

The output has a line for each scene:
  good       all expectations hold
  untested   the scene ran, but has no expectations
  broken     an expectation does not hold
  refused    the scene is wrong
  failed     the run went wrong, or with --strict the verdict is `Do not trust it`
  skipped    a file of a folder without a `clock` and without mistakes of syntax: it is no scene,
             or a part that other scenes include

Exit codes: 0 all good, 1 broken or refused, 2 command line wrong, 3 failed.";

/// A scene to be tried.
struct Candidate {
    name: String,
    /// Whether it was found in a folder. A file there that is not a scene is no mistake.
    found: bool,
}

/// The result of a file.
enum Tried {
    Trial(Box<Trial>),
    /// Not a scene, but this kind of file.
    Skipped(String),
}

impl Tried {
    fn trial(&self) -> Option<&Trial> {
        match self {
            Self::Trial(trial) => Some(trial),
            Self::Skipped(_) => None,
        }
    }

    /// The same for the report. `None`: a Ctrl-C came first.
    fn reported(tried: Option<&Self>) -> Result<&Trial, &'static str> {
        match tried {
            Some(Self::Trial(trial)) => Ok(trial),
            Some(Self::Skipped(_)) => Err("not a scene"),
            None => Err("interrupted"),
        }
    }
}

impl Test {
    pub(super) fn execute(self) -> Exit {
        let candidates = match self.candidates() {
            Ok(candidates) => candidates,
            Err(message) => {
                say(&format!("error: {message}"));
                return Exit::Usage;
            }
        };
        let start = Instant::now();
        let progress = Progress::new(candidates.len() as u64, "scenes", self.quiet || self.json);
        let width = candidates.iter().map(|candidate| candidate.name.chars().count()).max().unwrap_or(0).min(60);
        let mut results: Vec<Option<Tried>> = candidates.iter().map(|_| None).collect();
        let (mut exit, mut mute) = (Exit::Good, false);
        interrupt::arm();
        in_order(
            &candidates,
            self.threads.unwrap_or_else(all_cores),
            |candidate| self.attempt(candidate),
            |index, tried| {
                let name = &candidates[index].name;
                // Unwritable output is reported once.
                if !mute {
                    let written = progress.aside(|| self.tell(name, &tried, width));
                    mute = written != Exit::Good;
                    exit = exit.worse(written);
                }
                if let Some(trial) = tried.trial() {
                    exit = exit.worse(trial.verdict.exit());
                }
                results[index] = Some(tried);
                progress.step();
            },
        );
        drop(progress);
        let seconds = start.elapsed().as_secs_f64();
        let done: Vec<&Tried> = results.iter().flatten().collect();
        if !self.json && !mute {
            exit = exit.worse(print_line(&summary(&done, seconds)));
        }
        if done.len() < results.len() {
            let all = count(results.len(), "scene", "scenes");
            say(&format!("note: Ctrl-C ended the test after {} of {all}", done.len()));
            exit = exit.worse(Exit::Interrupted);
        }
        if let Some(path) = &self.junit {
            let reported = results.iter().map(|tried| Tried::reported(tried.as_ref()));
            let named: Vec<junit::Named> = candidates.iter().map(|candidate| &*candidate.name).zip(reported).collect();
            let read = named.iter().any(|(name, trial)| {
                let files = trial.iter().flat_map(|trial| &trial.files).map(PathBuf::as_path);
                files.chain([Path::new(name)]).any(|file| is_same_file(file, path))
            });
            let written = match read {
                true => Err(format!("`{}` belongs to a scene: write the report to another file", path.display())),
                false => write_whole(path, junit::report(&named, seconds)).map_err(|error| error.to_string()),
            };
            if let Err(message) = written {
                say(&format!("error: {message}"));
                return Exit::Usage;
            }
        }
        exit
    }

    /// The requested scenes.
    fn candidates(&self) -> Result<Vec<Candidate>, String> {
        if let Some(path) = &self.junit {
            let message = if is_directory(path) {
                Some(format!("`{}` is a directory: name a file, such as `report.xml`", path.display()))
            } else {
                takes_no_file(path)
            };
            message.map_or(Ok(()), Err)?;
        }
        let here = [".".to_owned()];
        let places = if self.places.is_empty() { &here[..] } else { &self.places };
        let mut candidates: Vec<Candidate> = Vec::new();
        for place in places {
            if !Path::new(place).is_dir() {
                if (Request { name: place, json: false, silent: true }).is_missing() {
                    return Err(format!("there is no scene and no folder `{place}`"));
                }
                candidates.push(Candidate { name: place.clone(), found: false });
                continue;
            }
            let names = scenes_in(Path::new(place)).map_err(|cause| format!("cannot look into `{place}`: {cause}"))?;
            if names.is_empty() {
                return Err(format!(
                    "there are no scenes (*.ron) in `{place}` and below; `jostle new scene first` writes one"
                ));
            }
            candidates.extend(names.into_iter().map(|name| Candidate { name, found: true }));
        }
        Ok(candidates)
    }

    /// The result of a scene; `None` if a Ctrl-C ends it.
    fn attempt(&self, candidate: &Candidate) -> Option<Tried> {
        let name = &candidate.name;
        if candidate.found
            && let Some(other) = Source::read(Path::new(name)).ok().and_then(|source| source.other_than_scene())
        {
            return Some(Tried::Skipped(other));
        }
        let request = Request { name, json: self.json, silent: self.quiet || self.json };
        let trial = match request.read(&self.overrides.settings, &self.overrides.overrides()) {
            Err(errors) => Trial::refused(errors),
            Ok((_, mut simulation)) => {
                interrupt::reach_into(&mut simulation);
                let end = simulation.ticks();
                let progress = Progress::new(end, "ticks", true);
                let failure = match (Runner { progress, wall_clock: None }).run_to(&mut simulation, end) {
                    Ok(()) => None,
                    Err(Ended::Wrong(failure)) => Some(failure),
                    Err(Ended::Interrupted) => return None,
                };
                Trial::of(&simulation, failure.as_ref(), self.strict.strict)
            }
        };
        Some(Tried::Trial(Box::new(trial)))
    }

    fn tell(&self, name: &str, tried: &Tried, width: usize) -> Exit {
        if self.json {
            return print_json(&json(name, tried));
        }
        let line = |word: &str, what: String| print_line(&format!("{word:<9} {name:<width$}  {what}"));
        let trial = match tried {
            Tried::Skipped(_) if self.quiet => return Exit::Good,
            Tried::Skipped(other) => return line("skipped", format!("not a scene: {other}")),
            Tried::Trial(trial) => trial,
        };
        let spent = format!("{:.2} s", trial.seconds);
        let exit = match trial.verdict {
            Verdict::Good if self.quiet => Exit::Good,
            Verdict::Good if trial.expect.is_empty() => {
                line("untested", format!("{spent}, runs to its end; nothing is expected"))
            }
            Verdict::Good => {
                let held = count(trial.expect.len(), "expectation holds", "expectations hold");
                line("good", format!("{spent}, {held}"))
            }
            Verdict::Broken => {
                let (all, held) = (trial.expect.len(), trial.held());
                let broken = trial.expect.iter().filter(|outcome| !outcome.holds);
                let broken = broken.map(|outcome| format!("\n            {}", told(outcome)));
                let broken: String = broken.collect();
                line(
                    "BROKEN",
                    format!("{spent}, {} of {}{broken}", all - held, count(all, "expectation", "expectations")),
                )
            }
            Verdict::Refused => {
                let errors = trial.errors.as_ref();
                let shown = errors.map_or_else(String::new, |errors| errors.render(false));
                let many = errors.map_or(0, |errors| errors.errors().len());
                let indented: String = shown.trim_end().lines().map(|line| format!("\n            {line}")).collect();
                line("REFUSED", format!("{}{indented}", count(many, "mistake", "mistakes")))
            }
            Verdict::Failed => line("FAILED", format!("{spent}, {}", trial.reason)),
        };
        let warned = trial.warnings.iter().map(|warning| print_line(&format!("            warning: {warning}")));
        warned.fold(exit, Exit::worse)
    }
}

fn summary(results: &[&Tried], seconds: f64) -> String {
    let trials: Vec<&Trial> = results.iter().filter_map(|tried| tried.trial()).collect();
    let of = |wanted: Verdict| trials.iter().filter(|trial| trial.verdict == wanted).count();
    let untested = trials.iter().filter(|trial| trial.verdict == Verdict::Good && trial.expect.is_empty()).count();
    let skipped = results.len() - trials.len();
    let parts = [
        (of(Verdict::Good) - untested, "good"),
        (untested, "untested"),
        (of(Verdict::Broken), "broken"),
        (of(Verdict::Refused), "refused"),
        (of(Verdict::Failed), "failed"),
        (skipped, "skipped"),
    ];
    let parts: Vec<String> =
        parts.into_iter().filter(|(number, _)| *number > 0).map(|(number, word)| format!("{number} {word}")).collect();
    format!("{} in {seconds:.2} s: {}", count(results.len(), "scene", "scenes"), parts.join(", "))
}

fn json(name: &str, tried: &Tried) -> serde_json::Value {
    match tried {
        Tried::Skipped(other) => serde_json::json!({ "scene": name, "result": "skipped", "reason": other }),
        Tried::Trial(trial) => serde_json::json!({
            "scene": name,
            "result": trial.verdict.word(),
            "reason": trial.reason,
            "seconds_spent": trial.seconds,
            "hash": trial.hash,
            "expect": trial.expect,
            "warnings": trial.warnings,
            "errors": trial.errors.as_ref().map_or(&[][..], |errors| errors.errors()),
        }),
    }
}
