//! The child process: reads scenes, runs and draws those that are good, and says on standard output where it is. What
//! goes wrong here ends the process, which the parent sees.

use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use clap::Parser;
use jostle::cli::{CommandLine, Exit};
use jostle::scene::Source;
use jostle::simulation::{Goal, Overrides};
use jostle::{Simulation, SimulationExt};

use crate::corpus::Corpus;
use crate::mutate::mutant;

/// Ticks of a short run.
const TICKS: u64 = 12;
/// No further tick begins after so long.
const ENOUGH: Duration = Duration::from_secs(1);
/// Seconds of physics for which the trial runs of a tolerance are made.
const LONGEST_TRIED: f64 = 0.1;
/// One good scene in so many is drawn through the command line too.
const DRAWN: u64 = 4;

/// Exit code of the child when a promise is broken that does not end a program by itself. No panic, and none of the
/// codes that `jostle` documents.
pub const BROKEN: i32 = 70;

/// Tells the parent where the child is: scene, and what happens to it.
fn mark(number: u64, word: &str) {
    let mut out = std::io::stdout().lock();
    // A parent that is gone needs to be told nothing.
    let _ = writeln!(out, "{number} {word}").and_then(|()| out.flush());
}

/// Works through `count` mutants from number `from` on.
pub fn batch(corpus: &Corpus, seed: u64, from: u64, count: u64, scratch: &Path) {
    for number in from..from + count {
        one(&mutant(corpus, seed, number), number, scratch);
    }
}

/// Reads one scene, and runs and draws it if it is good.
pub fn one(text: &str, number: u64, scratch: &Path) {
    mark(number, "reading");
    let (source, untried) = (Source::new("mutant.ron", text), Overrides { untried: true, ..Overrides::default() });
    let mut simulation = match Simulation::load_with(&source, &untried, |_| {}) {
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
            return;
        }
    };
    mark(number, "running");
    // A tolerance tries whole runs, which take as long as the scene asks for: only short ones are tried here.
    if simulation.contains_resource::<Goal>() && simulation.duration() <= LONGEST_TRIED {
        let _ = Simulation::load(&source);
    }
    // Where ticks are long one of them takes many steps: a hang is a tick that does not end.
    let (ticks, begin) = (simulation.ticks().min(TICKS), Instant::now());
    let (mut done, mut failed) = (0, false);
    while done < ticks && !failed && begin.elapsed() < ENOUGH {
        done += 1;
        failed = simulation.run_to_tick(done).is_err();
    }
    let end = done as f64 * simulation.clock().dt;
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
    drop(simulation);
    if number.is_multiple_of(DRAWN) {
        mark(number, "drawing");
        draw(text, end, scratch);
    }
    mark(number, if failed { "wrong" } else { "good" });
}

/// Draws the last frame of the short run through the command line.
fn draw(text: &str, end: f64, scratch: &Path) {
    let (scene, picture) = (scratch.join("mutant.ron"), scratch.join("mutant.png"));
    std::fs::write(&scene, text).expect("the scratch folder was made by the parent");
    let (scene, picture) = (scene.to_string_lossy(), picture.to_string_lossy());
    let end = format!("{end:?}");
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
fn broken(why: &str) -> ! {
    eprintln!("broken promise: {why}");
    std::process::exit(BROKEN);
}
