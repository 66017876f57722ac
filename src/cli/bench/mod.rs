//! `jostle bench`: the cost of ticks of scenes, beside a plain loop that does the same work.

mod memory;
mod print;

use clap::Args;

use super::Exit;
use super::flags::{self, OverrideFlags};
use super::load::{self, Request};
use super::progress_bar::Progress;
use super::say::{print_json, print_line, say};
use crate::cli::author;
use crate::report::bench::{self, BenchRequest, BenchResult, Stopped};
use crate::scene::{SceneErrors, Source};
use crate::simulation::{Overrides, Simulation};

/// The default scenes: an example, and a scene of this command.
const DEFAULT: [&str; 2] = ["example:tetris", GAS];
/// The scene of this command.
const GAS: &str = "bench:gas";
const GAS_TEXT: &str = include_str!("gas.ron");

/// The command `bench`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Bench {
    /// Scene files, or example:NAME for scenes that come with the program. Default: example:tetris, and bench:gas with two
    /// thousand discs
    #[arg(value_name = "SCENE")]
    scenes: Vec<String>,
    /// Ticks of a round. Default: as many as take about a fifth of a second, and at least 50. The duration of the scene limits it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    ticks: Option<u64>,
    /// Time so many rounds. Default: 7, or 3 with --quick
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rounds: Option<u32>,
    /// Make rounds short, for a first look
    #[arg(long)]
    quick: bool,
    /// Begin to measure after this time of the physics, such as 0.5 or 20ms, when a heap has settled
    #[arg(long, value_name = "T", value_parser = flags::moment, default_value = "0", allow_negative_numbers = true)]
    from: f64,
    #[command(flatten)]
    overrides: OverrideFlags,
    /// Share the work of a tick among so many threads, if there is enough of it. The results are the same to the bit
    #[arg(long, value_name = "N", value_parser = flags::threads, default_value = "1", allow_negative_numbers = true)]
    threads: usize,
    /// Print the measurement of each scene as one line of JSON on standard output
    #[arg(long)]
    json: bool,
    /// Print the bytes that reading and running the one scene takes, for another process that asks
    #[arg(long, hide = true)]
    memory: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle bench                                           a small look at this computer
  jostle bench scenes/benchmarks/dense_10k.ron           ten thousand discs at rest
  jostle bench scenes/benchmarks/*_1k.ron --json         several scenes, for a program
  jostle bench example:plinko --ticks 100 --rounds 20    more rounds, if they scatter
  jostle bench example:plinko --from 2                   from the state after two seconds on
  jostle bench scenes/bounce.ron --tick 0.5ms            with another tick
  jostle bench scenes/tetris.ron --simd scalar           without vector instructions

Paths of the examples are from the root of the source repository.

The columns of the table:
  bodies, atoms     the counts of bodies and atoms in the scene
  near, touching    pairs of atoms near each other, which each tick looks at; pairs that overlap
  us/tick           microseconds of a tick: the median over the rounds
  ns/atom           nanoseconds of a tick for each atom
  scatter           from the fastest round to the slowest, as a share of the median
  plain             ns/atom of a plain loop in the same program: arrays, a grid of cells, springs
                    with dashpots and friction, velocity Verlet, no vector instructions; a dash
                    if it cannot do what the scene asks
  x plain           time of the engine over that of the plain loop: the median over the rounds
  bytes/atom        memory to read and run the scene, for each atom, if the system tells it; a
                    dash below 1000 atoms, as the program itself takes more

The engine and the plain loop begin at the same state and run by turns. The command does not time the first round. Each round goes \
on from the end of the round before it. Times depend on your computer. The state hash depends only on --ticks, --rounds, --quick \
and --from.";

impl Bench {
    pub(super) fn execute(self) -> Exit {
        let scenes: Vec<&str> = match &self.scenes[..] {
            [] => DEFAULT.to_vec(),
            named => named.iter().map(String::as_str).collect(),
        };
        if let (true, [scene]) = (self.memory, &scenes[..]) {
            return self.print_memory(scene);
        }
        let order = self.order();
        let progress = Progress::new(order.steps() * scenes.len() as u64, "rounds", self.json);
        let (mut exit, mut rows) = (Exit::Good, Vec::new());
        for (number, scene) in scenes.iter().enumerate() {
            match self.measure(scene, order, &progress) {
                Ok((measured, bytes)) if self.json => {
                    exit = exit.worse(print_json(&print::json(scene, &measured, bytes)));
                }
                Ok((measured, bytes)) => rows.push(print::Row::of(scene, measured, bytes)),
                Err(stopped) => exit = exit.worse(progress.aside(|| self.tell(scene, &stopped))),
            }
            progress.at(order.steps() * (number as u64 + 1));
        }
        drop(progress);
        if !rows.is_empty() {
            exit = exit.worse(print_line(print::table(&rows).trim_end()));
        }
        if self.scenes.is_empty() && !self.json {
            say("note: larger scenes stand in scenes/benchmarks of the source repository");
        }
        exit
    }

    fn order(&self) -> BenchRequest {
        BenchRequest {
            ticks: self.ticks,
            rounds: self.rounds.unwrap_or(if self.quick { 3 } else { 7 }),
            quick: self.quick,
            from: self.from,
        }
    }

    /// The measurement of a scene, and its bytes.
    fn measure(
        &self,
        scene: &str,
        order: BenchRequest,
        progress: &Progress,
    ) -> Result<(BenchResult, Option<u64>), Stopped> {
        let source = self.source(scene)?;
        let load = |plan| {
            let overrides = Overrides { plan, threads: Some(self.threads), ..self.overrides.overrides() };
            Simulation::load_with(&source, &overrides, author::plugin)
        };
        let measured = bench::measure(load, order, || progress.step())?;
        let bytes = memory::of_other_process(self, scene, measured.ticks);
        Ok((measured, bytes))
    }

    /// Tells why nothing was measured.
    fn tell(&self, scene: &str, stopped: &Stopped) -> Exit {
        let request = Request { name: scene, json: self.json, silent: self.json };
        match stopped {
            Stopped::Scene(errors) => request.refuse_scene(errors),
            Stopped::Ended(end) => {
                let message = format!("--from {} s: the scene ends after {end} s", self.from);
                request.refuse(Exit::Usage, "", &message, "an earlier moment, or --duration beyond it")
            }
            Stopped::Run(failure) => {
                let help = "a shorter tick, softer contacts or heavier bodies; `jostle run` tells more";
                request.refuse(Exit::RunWrong, "", &failure.to_string(), help)
            }
        }
    }

    fn source(&self, scene: &str) -> Result<Source, SceneErrors> {
        let source = if scene == GAS { Source::new(GAS, GAS_TEXT) } else { load::source(scene)? };
        Ok(source.with_settings(&self.overrides.settings))
    }
}
