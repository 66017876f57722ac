//! `jostle sweep`: a scene with many values of its varied quantities, run side by side. It makes a table, a contact
//! sheet and films.

mod attempt;
mod contact_sheet;
mod merge;
mod record;
mod result_table;
mod vary;

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use self::attempt::{Attempt, attempt, refused};
use self::record::Record;
use self::result_table::{Row, Table};
use self::vary::{Grid, Variation};
use super::Exit;
use super::colors;
use super::destination::Place;
use super::film::{FilmRequest, Shot};
use super::flags::{self, OverrideFlags, StrictFlag};
use super::inputs::Inputs;
use super::interrupt;
use super::load::{self, Request};
use super::progress_bar::Progress;
use super::say::{count, print_json, say};
use super::side_by_side::{all_cores, in_order};
use super::trial::Verdict;
use crate::cli::author;
use crate::output::{OutputTarget, may_be_written, write_whole};
use crate::scene::{SceneRegistry, Source, suggest};
use crate::simulation::Simulation;
use jostle_language::digest::of_bytes;

/// The command `sweep`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Sweep {
    /// A scene file, or example:NAME for a scene that comes with the program
    #[arg(value_name = "SCENE", required_unless_present = "merge")]
    scene: Option<String>,
    /// Vary this name. The flag may stand several times. The command runs every combination, and the last name changes
    /// fastest. NAME is one of the scene's `params`, or a path into its text: clock.tick, gravity[1], bodies.ball.spin,
    /// fill[0].seed. VALUES are 1..5 (whole numbers), 0..1:11 (eleven values, ends included), 1..100:3:log, or a list a,b,c
    #[arg(long, value_name = "NAME=VALUES", value_parser = vary::variation, required_unless_present = "merge")]
    vary: Vec<Variation>,
    /// The directory for table.csv, contact_sheet.png and films
    #[arg(short, long, value_name = "DIR", required_unless_present = "merge")]
    output: Option<PathBuf>,
    /// Write a GIF of each run too: DIR/run_1.gif and so on
    #[arg(long)]
    films: bool,
    /// Size of the films in pixels, instead of the scene's
    #[arg(long, value_name = "WxH", value_parser = flags::size, requires = "films")]
    size: Option<(u32, u32)>,
    /// Write no contact sheet
    #[arg(long)]
    no_sheet: bool,
    /// Do only every Nth run from the Kth on, if N computers share a sweep. The table is DIR/table.K-of-N.csv
    #[arg(long, value_name = "K/N", value_parser = shard)]
    shard: Option<(usize, usize)>,
    /// Put the tables of all shards in a directory together: DIR/table.csv, the same bytes as without shards
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "vary", "output", "shard", "films", "no_sheet"])]
    merge: Option<PathBuf>,
    #[command(flatten)]
    overrides: OverrideFlags,
    #[command(flatten)]
    strict: StrictFlag,
    /// Do so many runs at the same time. No result depends on it. Default: one for each core
    #[arg(long, value_name = "N", value_parser = flags::threads, allow_negative_numbers = true)]
    threads: Option<usize>,
    /// Show no progress bar, and messages only if something is wrong
    #[arg(long)]
    quiet: bool,
    /// Print the result of each run as one line of JSON on standard output
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle sweep example:bounce --vary gravity[1]=-1..-20:20 -o moons/
  jostle sweep my.ron --vary friction=0..1:11 --vary seed=1..5 -o out/    `friction` and `seed` are params of my.ron
  jostle sweep my.ron --vary clock.tick=1ms,0.5ms,0.25ms -o ticks/        does the result depend on the tick?
  jostle sweep my.ron --vary mass=0.1..10:5:log -o out/ --films           a GIF of each run
  jostle sweep my.ron --vary seed=1..1600 -o out/ --shard 3/16            a sixteenth of the runs, on one of 16 computers
  jostle sweep --merge out/                                               one table, when all shards are there

DIR/table.runs holds all finished runs. If you give the command of an interrupted sweep again, only the other runs are made.

DIR/table.csv has a row for each run. Its first columns are the values that vary and the end of the run. Then follow the \
expectations that hold, the energy residual, and its share of the energy that changed form. The deepest overlap, the tick and the \
state hash come next. Each channel of the scene's sensors has its last, least and greatest value, over the film's frames and \
the end. The row of a run that fails holds the reason.

The exit code is that of the worst run: 0 good, 1 an expectation broken or a scene refused, 2 command line wrong, 3 run gone wrong.";

/// The most incomplete runs that are reported one by one.
const MOST_TOLD: usize = 10;

/// Reads `K/N`.
fn shard(text: &str) -> Result<(usize, usize), String> {
    let parts = text.split_once('/').and_then(|(which, of)| Some((which.parse().ok()?, of.parse().ok()?)));
    let good = parts.filter(|&(which, of)| 1 <= which && which <= of && of <= vary::MOST_RUNS);
    good.ok_or_else(|| "expected which shard of how many, such as 3/16".to_owned())
}

impl Sweep {
    pub(super) fn execute(self) -> Exit {
        let done = match (&self.merge, &self.scene, &self.output) {
            (Some(folder), ..) => merge::merge(folder, self.quiet),
            (None, Some(scene), Some(folder)) => self.sweep(scene, folder),
            // The command line asks for all of them.
            _ => Err("name a scene, a varied name with its values, and a directory".to_owned()),
        };
        done.unwrap_or_else(|message| {
            say(&format!("error: {message}"));
            Exit::Usage
        })
    }

    fn sweep(&self, scene: &str, folder: &Path) -> Result<Exit, String> {
        self.contradiction().map_or(Ok(()), Err)?;
        let grid = Grid::new(&self.vary)?;
        let request = Request { name: scene, json: self.json, silent: self.quiet || self.json };
        let source = match load::source(scene) {
            Ok(source) => source.with_settings(&self.overrides.settings),
            Err(errors) => return Ok(request.refuse_scene(&errors)),
        };
        // A mistake of the scene itself is reported once, with its place.
        let plain = match Simulation::load_with(&source, &self.overrides.overrides(), author::plugin) {
            Ok(plain) => plain,
            Err(errors) => return Ok(request.refuse_scene(&errors)),
        };
        let theme = match colors::theme(request, &source, &plain, None) {
            Ok(theme) => theme,
            Err(exit) => return Ok(exit),
        };
        self.strangers(&source, &plain)?;
        grid.scene(&source, 0)?;
        let inputs = Inputs::of(request, &plain).and(colors::file(&source, &plain, None));
        self.outputs(folder, grid.runs).find_map(|path| inputs.objection(&path)).map_or(Ok(()), Err)?;
        std::fs::create_dir_all(folder).map_err(|cause| format!("`{}` cannot be made: {cause}", folder.display()))?;
        // That a table cannot be written is to be known before the first run.
        may_be_written(&self.table(folder)).map_err(|error| error.to_string())?;
        let (first, step) = self.shard.map_or((0, 1), |(which, of)| (which - 1, of));
        let runs: Vec<usize> = (first..grid.runs).step_by(step).collect();
        let sheet = !self.no_sheet && runs.len() <= contact_sheet::MOST_PICTURES;
        let start = Instant::now();
        let fingerprint = self.fingerprint(&source, plain.resource());
        let films = if self.films { format!(" films {:?}", self.size) } else { String::new() };
        let record = folder.join(self.file("table", "runs"));
        let mut record = Record::open(&record, &format!("{fingerprint}{films}"))?;
        let left: Vec<usize> = runs.iter().copied().filter(|run| !record.rows.contains_key(&(run + 1))).collect();
        let taken = record.rows.len();
        if taken > 0 && !self.quiet {
            let taken = count(taken, "run is", "runs are");
            say(&format!("note: {taken} there already, and the sweep makes only the others"));
        }
        let (attempts, mut exit) = self.run_all(&source, &grid, &left, folder, sheet, &mut record);
        let seconds = start.elapsed().as_secs_f64();
        if attempts.len() < left.len() {
            let done = taken + attempts.len();
            say(&format!(
                "note: Ctrl-C ended the sweep after {done} of {}. `{}` keeps them, and the same command makes only the others",
                count(runs.len(), "run", "runs"),
                record.path().display()
            ));
            return Ok(exit.worse(Exit::Interrupted));
        }
        if let Some(errors) = all_refused(&attempts).filter(|_| taken == 0) {
            exit = exit.worse(request.refuse_scene(errors));
        }
        let mut rows = std::mem::take(&mut record.rows);
        exit = rows.values().filter_map(Row::verdict).fold(exit, |exit, verdict| exit.worse(verdict.exit()));
        let made = left.iter().zip(&attempts);
        rows.extend(made.map(|(&run, attempt)| (run + 1, Row::of(run + 1, owned(&grid, run), attempt))));
        let rows: Vec<Row> = rows.into_values().collect();
        let told = summary(&rows);
        let names = self.vary.iter().map(|variation| variation.name.clone()).collect();
        let path = self.table(folder);
        let sweep = self.shard.map(|_| fingerprint);
        write_whole(&path, Table { names, sweep, rows }.to_csv()).map_err(|error| error.to_string())?;
        let image = self.sheet(folder);
        // A sheet of some of the runs would be taken for the whole.
        let sheet = sheet && taken == 0;
        if sheet {
            contact_sheet::write(&image, &attempts, plain.film().size(), theme).map_err(|error| error.to_string())?;
        }
        record.close()?;
        if !self.quiet && !self.json {
            say(&format!("{}: {told}, {seconds:.2} s", path.display()));
            if sheet && attempts.iter().any(|attempt| attempt.picture.is_some()) {
                say(&format!("{}: the last moment of each run", image.display()));
            } else if !self.no_sheet && taken > 0 {
                say(
                    "note: there is no contact sheet, as some runs were there already. The same command once more makes it",
                );
            } else if !self.no_sheet && !sheet {
                say(&format!(
                    "note: a contact sheet shows at most {} runs, so there is none",
                    contact_sheet::MOST_PICTURES
                ));
            }
        }
        Ok(exit)
    }

    /// Varied names that are neither a parameter nor a path within a section, which are most likely misspelt.
    fn strangers(&self, source: &Source, plain: &Simulation) -> Result<(), String> {
        let registry = plain.resource::<SceneRegistry>();
        let params = source.params();
        let sections = registry.sections().into_iter().map(|section| section.name);
        let known: Vec<&str> = params.iter().map(String::as_str).chain(sections).collect();
        let begin = |name: &str| name.split(['.', '[']).next().unwrap_or_default().to_owned();
        match self.vary.iter().map(|variation| begin(&variation.name)).find(|name| !known.contains(&&**name)) {
            Some(name) => Err(format!(
                "--vary {name}: there is no parameter and no section of this name; {}",
                suggest::among(&name, known.into_iter(), "parameters and sections", '`')
            )),
            None => Ok(()),
        }
    }

    /// A text that is equal for two sweeps if scene, included files, flags and varied quantities are equal as text.
    fn fingerprint(&self, source: &Source, registry: &SceneRegistry) -> String {
        let OverrideFlags { duration, tick, method, tolerance, settings, simd: _ } = &self.overrides;
        let flags =
            format!("{duration:?} {tick:?} {method:?} {tolerance:?} {settings:?} {:?} {:?}", self.vary, self.strict);
        let texts = [&source.text, &source.made(registry), &flags, env!("CARGO_PKG_VERSION")];
        // No text has a byte 255 in it.
        let bytes = texts.into_iter().flat_map(|text| text.bytes().chain([255]));
        format!("{:016x}", of_bytes(bytes))
    }

    /// A flag of all runs for a varied quantity.
    fn contradiction(&self) -> Option<String> {
        let OverrideFlags { duration, tick, method, settings, .. } = &self.overrides;
        let flags = [("clock.duration", "--duration", duration.is_some()), ("clock.tick", "--tick", tick.is_some())];
        let flags = flags.into_iter().chain([("clock.method", "--method", method.is_some())]);
        let mut flags = flags.filter(|(.., given)| *given);
        let varies = |path: &str| self.vary.iter().any(|variation| variation.name == path);
        let flag =
            flags.find(|(path, ..)| varies(path)).map(|(path, flag, _)| format!("`{path}` varies: leave {flag} away"));
        let setting = settings.iter().find(|(name, _)| varies(name));
        let twice = self
            .vary
            .iter()
            .enumerate()
            .find(|(index, one)| self.vary[..*index].iter().any(|other| other.name == one.name));
        flag.or(setting.map(|(name, _)| format!("`{name}` varies: leave --set {name} away")))
            .or(twice.map(|(_, one)| format!("`{}` varies twice: name all its values in one --vary", one.name)))
    }

    fn run_all(
        &self,
        source: &Source,
        grid: &Grid,
        runs: &[usize],
        folder: &Path,
        sheet: bool,
        record: &mut Record,
    ) -> (Vec<Attempt>, Exit) {
        let progress = Progress::new(runs.len() as u64, "runs", self.quiet || self.json);
        let mut attempts: Vec<Attempt> = Vec::new();
        let (mut exit, mut told, mut recorded) = (Exit::Good, 0, true);
        interrupt::arm();
        in_order(
            runs,
            self.threads.unwrap_or_else(all_cores),
            |&run| match grid.scene(source, run) {
                Err(message) => Some((refused(source, message), Exit::Good)),
                Ok(scene) => {
                    let label = label(grid, run);
                    let done = attempt(&scene, &self.overrides, self.strict, sheet.then_some(&*label))?;
                    let film = if self.films { self.film(&scene, &label, grid, run, folder) } else { Exit::Good };
                    (film != Exit::Interrupted).then_some((done, film))
                }
            },
            |index, (attempt, film): (Attempt, Exit)| {
                let run = runs[index];
                exit = exit.worse(attempt.trial.verdict.exit()).worse(film);
                if matches!(attempt.trial.verdict, Verdict::Refused | Verdict::Failed) && !self.json {
                    told += 1;
                    let verdict = attempt.trial.verdict.word();
                    let line = format!("run {} ({}): {verdict}: {}", run + 1, label(grid, run), attempt.trial.reason);
                    if told <= MOST_TOLD {
                        progress.aside(|| say(&line));
                    }
                }
                // Without a record the sweep is equally good, unless it is interrupted. A run without its film is not
                // done.
                if recorded
                    && film == Exit::Good
                    && let Err(message) = record.add(&Row::of(run + 1, owned(grid, run), &attempt))
                {
                    recorded = false;
                    progress.aside(|| say(&format!("note: {message}. If you interrupt the sweep, it begins anew")));
                }
                if self.json {
                    exit = exit.worse(print_json(&json(grid, run, &attempt)));
                }
                attempts.push(attempt);
                progress.step();
            },
        );
        drop(progress);
        if told > MOST_TOLD {
            say(&format!(
                "... and {} more runs that were refused or failed: the table has their reasons",
                told - MOST_TOLD
            ));
        }
        (attempts, exit)
    }

    /// The film of a run. It is run once more for it.
    fn film(&self, scene: &Source, label: &str, grid: &Grid, run: usize, folder: &Path) -> Exit {
        let overrides = self.overrides.overrides();
        let path = film_of(folder, run, grid.runs);
        let name = format!("{} ({label})", scene.name);
        let request = Request { name: &name, json: false, silent: true };
        let (Ok(mut simulation), Ok(target)) =
            (Simulation::load_with(scene, &overrides, author::plugin), OutputTarget::new(path))
        else {
            // The run itself has reported the reason.
            return Exit::Good;
        };
        let order = FilmRequest {
            request,
            source: scene,
            overrides: &overrides,
            place: &Place { target, folder: None },
            shot: &Shot::Film,
            size: self.size,
            theme: None,
            frames_per_second: None,
            threads: Some(1),
            most_bytes: None,
            pace: false,
            whole: true,
            silent: true,
            quiet: true,
        };
        order.make(&mut simulation).map_or_else(|exit| exit, |_| Exit::Good)
    }

    fn table(&self, folder: &Path) -> PathBuf {
        folder.join(self.file("table", "csv"))
    }

    fn sheet(&self, folder: &Path) -> PathBuf {
        folder.join(self.file("contact_sheet", "png"))
    }

    /// All files that may be written.
    fn outputs(&self, folder: &Path, runs: usize) -> impl Iterator<Item = PathBuf> {
        let films = if self.films { runs } else { 0 };
        let films = (0..films).map(move |run| film_of(folder, run, runs));
        let record = folder.join(self.file("table", "runs"));
        [self.table(folder), self.sheet(folder), record].into_iter().chain(films)
    }

    /// The name of a file; that of a shard contains its number.
    fn file(&self, stem: &str, ending: &str) -> String {
        self.shard.map_or_else(|| format!("{stem}.{ending}"), |(which, of)| format!("{stem}.{which}-of-{of}.{ending}"))
    }
}

/// The mistakes of the first run, if the scene was refused with all values.
fn all_refused(attempts: &[Attempt]) -> Option<&crate::scene::SceneErrors> {
    let refused = |attempt: &Attempt| attempt.trial.verdict == Verdict::Refused;
    attempts.first().filter(|_| attempts.iter().all(refused))?.trial.errors.as_ref()
}

fn film_of(folder: &Path, run: usize, runs: usize) -> PathBuf {
    let digits = runs.to_string().len();
    folder.join(format!("run_{:0digits$}.gif", run + 1))
}

fn owned(grid: &Grid, run: usize) -> Vec<String> {
    grid.values(run).into_iter().map(str::to_owned).collect()
}

/// The varied quantities and their values, in a line.
fn label(grid: &Grid, run: usize) -> String {
    let pairs = grid.variations.iter().zip(grid.values(run));
    let pairs: Vec<String> = pairs.map(|(variation, value)| format!("{} = {value}", variation.name)).collect();
    pairs.join(", ")
}

fn summary(rows: &[Row]) -> String {
    let of = |wanted: Verdict| rows.iter().filter(|row| row.verdict() == Some(wanted)).count();
    let parts = Verdict::ALL.into_iter().map(|verdict| (of(verdict), verdict.word())).filter(|(number, _)| *number > 0);
    let parts: Vec<String> = parts.map(|(number, word)| format!("{number} {word}")).collect();
    let runs = count(rows.len(), "run", "runs");
    if parts.is_empty() { runs } else { format!("{runs}, {}", parts.join(", ")) }
}

fn json(grid: &Grid, run: usize, attempt: &Attempt) -> serde_json::Value {
    let names = grid.variations.iter().map(|variation| variation.name.clone());
    let values = grid.values(run).into_iter().map(serde_json::Value::from);
    let vary: serde_json::Map<String, serde_json::Value> = names.zip(values).collect();
    let track = |track: &attempt::Track| {
        let attempt::Track { name, unit, last, least, most } = track;
        (name.clone(), serde_json::json!({ "final": last, "min": least, "max": most, "unit": unit }))
    };
    let channels: serde_json::Map<String, serde_json::Value> = attempt.tracks.iter().map(track).collect();
    let trial = &attempt.trial;
    serde_json::json!({
        "run": run + 1,
        "vary": vary,
        "result": trial.verdict.word(),
        "reason": trial.reason,
        "seconds_spent": trial.seconds,
        "hash": trial.hash,
        "expect": trial.expect,
        "channels": channels,
        "card": attempt.card,
        "errors": trial.errors.as_ref().map_or(&[][..], |errors| errors.errors()),
    })
}
