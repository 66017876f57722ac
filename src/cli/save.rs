//! `--save` and `--resume`: runs that are saved at a moment and resumed.

use std::path::{Path, PathBuf};

use clap::Args;

use super::destination::{is_directory, takes_no_file};
use super::flags::moment;
use super::inputs::{Inputs, is_same_file};
use super::load::Request;
use super::pace::{Ended, Runner};
use super::say::say;
use crate::output::{OutputError, write_whole};
use crate::simulation::{Simulation, Snapshot};
use crate::tick::Notes;

/// Flags of snapshots.
#[derive(Args, Clone, Debug)]
pub(super) struct SnapshotFlags {
    /// Save the run at a moment, to go on from there with --resume. The flag may stand several times
    #[arg(long, value_name = "at=T:FILE", value_parser = saving)]
    save: Vec<Saving>,
    /// Go on from a file that --save wrote in a run of the same scene with the same flags. Channels begin at that moment. The
    /// card counts from the beginning of the first run, and estimates no error
    #[arg(long, value_name = "FILE", conflicts_with_all = ["estimate", "rounding", "model", "reverse"])]
    resume: Option<PathBuf>,
}

/// A moment in seconds and the file of its snapshot.
#[derive(Clone, Debug)]
struct Saving {
    at: f64,
    file: PathBuf,
}

fn saving(text: &str) -> Result<Saving, String> {
    let wrong = || "expected a moment and a file, such as at=2s:half.snapshot".to_owned();
    let (at, file) = text.strip_prefix("at=").and_then(|rest| rest.split_once(':')).ok_or_else(wrong)?;
    if file.is_empty() {
        return Err(wrong());
    }
    Ok(Saving { at: moment(at)?, file: PathBuf::from(file) })
}

/// Why a run ended early.
pub(super) enum Trouble {
    Run(Ended),
    Output(OutputError),
    /// The run cannot be saved.
    Unsaved(String),
}

impl From<OutputError> for Trouble {
    fn from(error: OutputError) -> Self {
        Self::Output(error)
    }
}

/// The snapshots that a run is still to write, in order of their ticks.
#[derive(Debug, Default)]
pub(super) struct Saves {
    /// Ticks and files, in order of ticks.
    missing: Vec<(u64, PathBuf)>,
    /// Whether one could not be written.
    pub failed: bool,
}

impl SnapshotFlags {
    /// The file from which the run continues.
    pub fn input(&self) -> Option<PathBuf> {
        self.resume.clone()
    }

    /// Whether the run continues from a file.
    pub fn resumes(&self) -> bool {
        self.resume.is_some()
    }

    /// Resumes the run from a file, if that is requested, and settles the paths of snapshots. Mistakes are reported
    /// before any run.
    pub fn begin(
        &self,
        simulation: &mut Simulation,
        (request, inputs): (Request, &Inputs),
        output: Option<&Path>,
    ) -> Result<Saves, String> {
        if let Some(file) = &self.resume {
            resume(simulation, file)?;
        }
        let mut saves = Saves::default();
        for (number, Saving { at, file }) in self.save.iter().enumerate() {
            let (name, dt) = (file.display(), simulation.clock().dt);
            if file == Path::new("-") {
                return Err("--save: a snapshot needs a file, not standard output: name one".to_owned());
            }
            let tick = (at / dt).round() as u64;
            let same = |other: &Path| other == file.as_path() || is_same_file(other, file);
            let (begin, end) = (simulation.clock().time(), simulation.ticks() as f64 * dt);
            if tick < simulation.clock().ticks || tick > simulation.ticks() {
                return Err(format!("--save: {at} s is not in the run, which goes from {begin} s to {end} s"));
            } else if request.is_at(file) {
                return Err(format!("--save: `{name}` is the scene itself: name another file"));
            } else if is_directory(file) {
                return Err(format!("--save: `{name}` is a directory: name a file in it"));
            } else if output.is_some_and(same) || self.save[..number].iter().any(|other| same(&other.file)) {
                return Err(format!("--save: this command writes `{name}` already: name another file"));
            } else if let Some(message) = inputs.objection(file).or_else(|| takes_no_file(file)) {
                return Err(format!("--save: {message}"));
            }
            saves.missing.push((tick, file.clone()));
        }
        if !saves.missing.is_empty() {
            simulation.snapshot().map_err(|error| format!("--save: this run cannot be saved: {error}"))?;
        }
        saves.missing.sort_by_key(|save| save.0);
        Ok(saves)
    }
}

fn resume(simulation: &mut Simulation, file: &Path) -> Result<(), String> {
    let name = file.display();
    let told = |why: &dyn std::fmt::Display| format!("--resume: `{name}`: {why}");
    let is_file = std::fs::metadata(file).map_err(|error| told(&error))?.is_file();
    if !is_file {
        return Err(told(&"this is no file"));
    }
    let bytes = std::fs::read(file).map_err(|error| told(&error))?;
    let snapshot = Snapshot::from_bytes(&bytes).map_err(|error| told(&error))?;
    simulation.restore(&snapshot).map_err(|error| told(&error))?;
    let time = simulation.clock().time();
    if snapshot.ticks() > simulation.ticks() {
        return Err(told(&format!("it is of t = {time} s, behind the end of this run")));
    }
    let note = format!(
        "the run went on from a snapshot of t = {time} s. Accounts count from the first beginning, and no error is estimated"
    );
    simulation.world_mut().resource_mut::<Notes>().0.push(note);
    Ok(())
}

impl Saves {
    /// Runs to a tick, and writes the snapshots of the moments on the way. An unwritable snapshot is reported at once
    /// and does not end the run.
    pub fn run_to(&mut self, runner: &mut Runner, simulation: &mut Simulation, tick: u64) -> Result<(), Trouble> {
        while let Some((at, _)) = self.missing.first().filter(|(at, _)| *at <= tick) {
            runner.run_to(simulation, *at).map_err(Trouble::Run)?;
            let (_, file) = self.missing.remove(0);
            let snapshot = simulation.snapshot().map_err(|error| Trouble::Unsaved(error.to_string()))?;
            if let Err(error) = write_whole(&file, snapshot.to_bytes()) {
                say(&format!("error: --save: {error}; the run goes on"));
                self.failed = true;
            }
        }
        runner.run_to(simulation, tick).map_err(Trouble::Run)
    }
}
