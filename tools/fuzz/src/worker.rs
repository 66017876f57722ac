//! The child process: tries mutants, and says on standard output where it is. What
//! goes wrong here ends the process, which the parent sees.

use std::io::Write;
use std::path::Path;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use clap::Parser;
use jostle::cli::{CommandLine, Exit};
use jostle::scene::Source;
use jostle::simulation::{Goal, Overrides};
use jostle::tick::FailureKind;
use jostle::{Simulation, SimulationExt};

use crate::kinds::Kind;

/// Ticks of a short run.
const TICKS: u64 = 12;
/// A run goes on no longer, neither to a further tick nor to a further step.
const ENOUGH: Duration = Duration::from_secs(1);
/// Seconds of physics for which the trial runs of a tolerance are made.
const LONGEST_TRIED: f64 = 0.1;
/// Scenes of more atoms take seconds to be read and drawn by their number alone, so they are read and run here, and not drawn.
const MOST_ATOMS_DRAWN: usize = 100_000;
/// One good scene in so many is drawn through the command line too.
pub const DRAWN: u64 = 4;

/// Exit code of the child when a promise is broken that does not end a program by itself. No panic, and none of the
/// codes that `jostle` documents.
pub const BROKEN: i32 = 70;

/// When the run began, in milliseconds of this program.
static BEGIN: AtomicU64 = AtomicU64::new(0);

/// Milliseconds since this was asked first.
fn since_start() -> u64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_millis() as u64
}

/// Tells the parent where the child is: scene, and what happens to it.
pub fn mark(number: u64, word: &str) {
    let mut out = std::io::stdout().lock();
    // A parent that is gone needs to be told nothing.
    let _ = writeln!(out, "{number} {word}").and_then(|()| out.flush());
}

/// Works through `count` mutants from number `from` on.
pub fn batch(kind: &mut dyn Kind, seed: u64, from: u64, count: u64, scratch: &Path) {
    for number in from..from + count {
        // The work of making a mutant counts too.
        mark(number, "reading");
        let mutant = kind.mutant(seed, number);
        kind.attempt(&mutant, number, scratch);
    }
}

/// A short run.
pub struct Ran {
    end: f64,
    failed: bool,
    /// Whether a picture of it takes no longer than the promise says.
    is_short: bool,
}

impl Ran {
    /// Whether it reached the end of a tick, and a picture of that takes no longer than the promise says.
    pub fn is_to_be_drawn(&self) -> bool {
        self.end > 0.0 && self.is_short
    }

    /// Tells the parent how the run went.
    pub fn mark(&self, number: u64) {
        mark(number, if self.failed { "wrong" } else { "good" });
    }
}

/// Reads one scene, and runs it if it is good.
pub fn read_and_run(source: &Source, number: u64) -> Option<Ran> {
    mark(number, "reading");
    let untried = Overrides { untried: true, ..Overrides::default() };
    let mut simulation = match Simulation::load_with(source, &untried, |_| {}) {
        Ok(simulation) => simulation,
        Err(errors) => {
            let shown = errors.render(true);
            for error in errors.errors() {
                if error.message.is_empty() || !shown.contains("error") {
                    broken("a scene is refused without a word");
                }
                if error.line.is_none() {
                    broken(&format!("a mistake has no place: {}", errors.render(false).trim()));
                }
            }
            if errors.errors().is_empty() {
                broken("a scene is refused without a mistake");
            }
            mark(number, "refused");
            return None;
        }
    };
    // A tolerance tries whole runs, which take as long as the scene asks for: only short ones are tried here.
    if simulation.contains_resource::<Goal>() && simulation.duration() <= LONGEST_TRIED {
        mark(number, "running");
        let _ = Simulation::load(source);
    }
    Some(run_on(&mut simulation, number))
}

/// Runs on for some ticks.
pub fn run_on(simulation: &mut Simulation, number: u64) -> Ran {
    mark(number, "running");
    // Where ticks are long one of them takes many steps. A hang is a step that does not end.
    let begin = Instant::now();
    BEGIN.store(since_start(), Ordering::Relaxed);
    simulation.ask_inside_ticks(|_| since_start() - BEGIN.load(Ordering::Relaxed) < ENOUGH.as_millis() as u64);
    let first = simulation.clock().ticks;
    let last = simulation.ticks().max(first).min(first.saturating_add(TICKS));
    let (mut done, mut failed) = (first, false);
    while done < last && !failed && begin.elapsed() < ENOUGH {
        match simulation.run_to_tick(done + 1) {
            Ok(()) => {}
            // The tick that was ended is not drawn: it may take any time.
            Err(failure) if failure.wrong == FailureKind::Stopped => break,
            Err(_) => failed = true,
        }
        done += 1;
    }
    let end = (done - first) as f64 * simulation.clock().dt;
    let bodies = simulation.bodies();
    let finite = (0..bodies.len()).all(|body| {
        bodies.position[body].is_finite()
            && bodies.velocity[body].is_finite()
            && bodies.angle[body].is_finite()
            && bodies.spin[body].is_finite()
    });
    if !failed && !finite {
        broken("a state is not finite, and the run says nothing");
    }
    let _ = (simulation.card().to_string(), simulation.outcomes());
    // Drawing would try whole runs for a tolerance again, which take as long as the scene asks for.
    let tries = simulation.contains_resource::<Goal>();
    let is_short = simulation.bodies().atom_count() <= MOST_ATOMS_DRAWN && !tries;
    Ran { end, failed, is_short }
}

/// Draws the last frame of the short run through the command line.
pub fn draw(scene: &Path, ran: &Ran, number: u64, scratch: &Path) {
    mark(number, "drawing");
    let picture = scratch.join("mutant.png");
    let (scene, picture) = (scene.to_string_lossy(), picture.to_string_lossy());
    let end = format!("{:?}", ran.end);
    // Both values must lie in what the flags take: times above zero that are finite.
    let line = ["jostle", "render", &scene, "-o", &picture, "--quiet", "--threads", "1", "--size", "64x48"];
    let line = line.into_iter().chain(["--duration", &end, "--at", &end]);
    let exit = CommandLine::try_parse_from(line).map(CommandLine::execute);
    match exit {
        Ok(Exit::Good | Exit::SceneWrong | Exit::RunWrong | Exit::Interrupted) => {}
        Ok(Exit::Usage) => broken("a picture of a good scene is refused as a wrong command line"),
        Err(error) => broken(&format!("the command line is refused: {error}")),
    }
}

/// Ends the process: a promise is broken.
pub fn broken(why: &str) -> ! {
    eprintln!("broken promise: {why}");
    std::process::exit(BROKEN);
}
