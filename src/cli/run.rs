//! `jostle run`: runs a scene, prints its error card, writes its channels.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::Args;

use super::Exit;
use super::destination::{ends_as_picture, is_directory, takes_no_file};
use super::estimate::EstimateFlags;
use super::flags::{self, OverrideFlags, StrictFlag};
use super::inputs::Inputs;
use super::interrupt;
use super::load::Request;
use super::pace::{Ended, Runner};
use super::progress_bar::Progress;
use super::result::{self, Detail, Ran};
use super::row_ticks::Rows;
use super::save::{Saves, SnapshotFlags, Trouble};
use super::say::say;
use super::side_by_side::all_cores;
use super::wall_clock::WallClock;
use crate::cli::author;
use crate::output::OutputError;
use crate::output::csv::Table;
use crate::report::reversal::Reversal;
use crate::sensors::Channels;
use crate::simulation::{Overrides, Plan, Simulation};

/// The command `run`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct RunArguments {
    /// A scene file, or example:NAME for a scene that comes with the program
    #[arg(value_name = "SCENE")]
    scene: String,
    /// Write the channels of the scene's sensors here, as comma-separated values. Each frame of the film gives a row, at the
    /// nearest tick. `-` is standard output
    #[arg(short, long, value_name = "channels.csv")]
    output: Option<PathBuf>,
    /// Write so many rows of channels for each second of physics, each at the nearest tick. Default: one for each frame
    #[arg(long, value_name = "N", value_parser = flags::rows, allow_negative_numbers = true, requires = "output")]
    fps: Option<f64>,
    #[command(flatten)]
    overrides: OverrideFlags,
    #[command(flatten)]
    estimates: EstimateFlags,
    #[command(flatten)]
    snapshots: SnapshotFlags,
    #[command(flatten)]
    strict: StrictFlag,
    /// Afterwards run there and back: to the end, and with all velocities turned round as long again. The card says how closely
    /// the scene comes back to its beginning
    #[arg(long)]
    reverse: bool,
    /// Run no faster than the clock on the wall: a second of physics takes a second. The card counts ticks that come too late.
    /// Without this flag, a run is as fast as possible
    #[arg(long)]
    pace: bool,
    /// Share the work of a tick among so many threads, if there is enough of it. The results are the same to the bit. Default:
    /// one for each core
    #[arg(long, value_name = "N", value_parser = flags::threads, allow_negative_numbers = true)]
    threads: Option<usize>,
    /// Show no progress bar, and messages only if something is wrong
    #[arg(long)]
    quiet: bool,
    /// Print the result as one line of JSON on standard output
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle run example:projectile                 the error card: how far to trust the result
  jostle run my.ron -o channels.csv             the channels of the sensors
  jostle run my.ron -o channels.csv --fps 1000  the channels a thousand times a second
  jostle run my.ron -o - --quiet | head         the channels for another program
  jostle run my.ron --tick 0.1ms --json         another tick; the result for a program
  jostle run my.ron --tolerance 1e-6            the coarsest steps whose error stays below a millionth of the motion
  jostle run my.ron --method Reference          the smallest error there is, and how large it is
  jostle run my.ron --estimate --rounding --model
                                                how wrong it is: by its tick, by finite digits, by soft contacts
  jostle run my.ron --reverse                   there and back: how closely it returns
  jostle run my.ron --save at=2s:half.snapshot  store the run after two seconds ...
  jostle run my.ron --resume half.snapshot      ... and go on from there, to the same bits
  jostle run my.ron --pace                      at the speed of the clock on the wall

The card and all messages go to standard error (`2> card.txt` keeps them). Results for programs go to standard output.";

impl RunArguments {
    fn overrides(&self, plan: Option<Plan>) -> Overrides {
        let threads = Some(self.threads.unwrap_or_else(all_cores));
        Overrides { plan, threads, rate: self.fps, ..self.overrides.overrides() }
    }

    pub(super) fn execute(self) -> Exit {
        let request = Request { name: &self.scene, json: self.json, silent: self.quiet || self.json };
        if let Some(message) = self.output.as_deref().and_then(|path| objection(request, path)) {
            return request.usage(&message);
        }
        if self.json && self.output.as_deref() == Some(Path::new("-")) {
            return request.usage("standard output takes the channels or the result as JSON, not both: give -o a file");
        }
        let (source, mut simulation) = match request.load(&self.overrides.settings, &self.overrides(None)) {
            Ok(loaded) => loaded,
            Err(exit) => return exit,
        };
        let inputs = Inputs::of(request, &simulation).and(self.snapshots.input());
        if let Some(message) = self.output.as_deref().and_then(|path| inputs.objection(path)) {
            return request.usage(&message);
        }
        let mut saves = match self.snapshots.begin(&mut simulation, (request, &inputs), self.output.as_deref()) {
            Ok(saves) => saves,
            Err(message) => return request.usage(&message),
        };
        if !self.snapshots.resumes() {
            self.estimates.watch(&mut simulation);
        }
        let progress = Progress::new(simulation.ticks(), "ticks", self.quiet || self.json);
        let measures = simulation.get_resource::<Channels>().is_some_and(|channels| !channels.is_empty());
        if self.output.is_some() && !measures {
            say("note: the scene has no sensors, so the rows hold only times: add `sensors: [Energy()]` or others");
        }
        interrupt::arm();
        interrupt::reach_into(&mut simulation);
        let mut runner = Runner { progress, wall_clock: self.pace.then(WallClock::default) };
        let ran = match &self.output {
            Some(path) => {
                let rows = Rows::of(&simulation, self.fps);
                write_channels(&mut simulation, (path, &rows), (&mut runner, &mut saves))
            }
            None => {
                let end = simulation.ticks();
                saves.run_to(&mut runner, &mut simulation, end)
            }
        };
        let Runner { progress, wall_clock } = runner;
        drop(progress);
        if let Some(clock) = wall_clock.filter(|_| !self.quiet) {
            clock.report("step", "steps");
        }
        let failure = match ran {
            Ok(()) => None,
            Err(Trouble::Run(Ended::Wrong(failure))) => Some(failure),
            Err(Trouble::Run(Ended::Interrupted)) => None,
            // A reader that has gone away wants no more.
            Err(Trouble::Output(OutputError::Io { cause, .. })) if cause.kind() == ErrorKind::BrokenPipe => {
                return Exit::Good;
            }
            Err(Trouble::Output(error)) => return request.usage(&error.to_string()),
            Err(Trouble::Unsaved(message)) => return request.usage(&message),
        };
        if failure.is_none() && !interrupt::asked() && !self.snapshots.resumes() {
            let scene = (&source, &self.overrides(None));
            if let Err(exit) = self.estimates.estimate(&mut simulation, request, scene) {
                return exit;
            }
        }
        let back = if self.reverse && failure.is_none() && !interrupt::asked() {
            let again = Simulation::load_with(&source, &self.overrides(simulation.plan().cloned()), author::plugin);
            match again.map_err(|errors| request.refuse_scene(&errors)) {
                Ok(mut again) => Some(Reversal::of(&mut again)),
                Err(exit) => return exit,
            }
        } else {
            None
        };
        let strict = self.strict.strict;
        let ran = Ran { back: back.as_ref(), strict, ..Ran::whole(&simulation, failure.as_ref()) };
        match result::tell(request, &ran, Detail::of(self.json, self.quiet)) {
            Exit::Good if saves.failed => Exit::Usage,
            exit => exit,
        }
    }
}

/// The objection to a path for channels.
fn objection(request: Request, path: &Path) -> Option<String> {
    let name = path.display();
    if path.as_os_str().is_empty() {
        Some("-o needs the name of a file, such as channels.csv".to_owned())
    } else if request.is_at(path) {
        Some(format!("`{name}` is the scene itself: write the channels to another file, such as channels.csv"))
    } else if is_directory(path) {
        Some(format!("`{name}` is a directory: name a file in it, such as `{}`", path.join("channels.csv").display()))
    } else if ends_as_picture(path) {
        Some(format!("`run` writes comma-separated values, not `{name}`: use `jostle render` for pictures"))
    } else {
        takes_no_file(path)
    }
}

/// Runs, and writes a row in the beginning, at the moments of rows, and at the end.
fn write_channels(
    simulation: &mut Simulation,
    (path, rows): (&Path, &Rows),
    (runner, saves): (&mut Runner, &mut Saves),
) -> Result<(), Trouble> {
    let none = Channels::default();
    let channels = simulation.get_resource::<Channels>().unwrap_or(&none);
    let columns = channels.iter().map(|channel| (channel.name.as_str(), channel.unit));
    let mut table = Table::create(path, columns)?;
    let run = loop {
        let measured = simulation.get_resource::<Channels>().unwrap_or(&none);
        table.row(simulation.clock().time(), simulation.values(measured.iter()))?;
        let (done, end) = (simulation.clock().ticks, simulation.ticks());
        if done == end {
            break Ok(());
        }
        if let Err(trouble) = saves.run_to(runner, simulation, rows.next(done, end)) {
            break Err(trouble);
        }
    };
    // A failing run keeps the rows so far.
    table.finish()?;
    run
}
