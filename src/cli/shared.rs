//! What the commands share: reading scenes, overriding them, reporting how they went.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::{Exit, examples};
use crate::expect::Outcome;
use crate::report::Card;
use crate::scene::{SceneError, SceneErrors, Source};
use crate::simulation::{Overrides, Simulation};

/// Flags that override the scene.
#[derive(Args, Clone, Debug)]
pub(super) struct OverrideFlags {
    /// Seconds of physics, instead of the scene's
    #[arg(long, value_name = "T")]
    pub duration: Option<f64>,
    /// Length of a tick in seconds, instead of the scene's
    #[arg(long, value_name = "DT")]
    pub tick: Option<f64>,
    /// Integration method, instead of the scene's: Auto, SemiImplicitEuler, VelocityVerlet
    #[arg(long, value_name = "NAME")]
    pub method: Option<String>,
    /// Error allowed, instead of a tick (not available yet)
    #[arg(long, value_name = "X")]
    pub tolerance: Option<f64>,
}

impl OverrideFlags {
    /// The overrides, if all of them are available.
    pub fn overrides(&self) -> Result<Overrides, Exit> {
        if self.tolerance.is_some() {
            return Err(usage("`--tolerance` is not available yet; use `--tick`"));
        }
        for (flag, value) in [("--duration", self.duration), ("--tick", self.tick)] {
            if value.is_some_and(|value| !(value.is_finite() && value > 0.0)) {
                return Err(usage(&format!("{flag} needs a finite number above zero")));
            }
        }
        Ok(Overrides { tick: self.tick, method: self.method.clone(), duration: self.duration })
    }
}

/// Prints a mistake of the command line.
pub(super) fn usage(message: &str) -> Exit {
    eprintln!("error: {message}");
    Exit::Usage
}

/// The name of a scene without directories and ending: what its film is called.
pub(super) fn stem(scene: &str) -> String {
    let name = scene.strip_prefix("example:").unwrap_or(scene);
    Path::new(name).file_stem().map_or_else(|| "film".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Reads the text of a scene: a file, or `example:NAME`.
pub(super) fn source(scene: &str) -> Result<Source, SceneErrors> {
    let Some(name) = scene.strip_prefix("example:") else { return Source::read(&PathBuf::from(scene)) };
    let found = examples::SCENES.iter().find(|(known, _)| *known == name);
    found.map(|(_, text)| Source::new(scene, *text)).ok_or_else(|| {
        let known: Vec<&str> = examples::SCENES.iter().map(|(name, _)| *name).collect();
        let error = SceneError::new("", format!("there is no example `{name}`"));
        let help = format!("examples: {}", known.join(", "));
        SceneErrors::new(Source::new(scene, ""), vec![error.with_help(help)], Vec::new())
    })
}

/// Reads a scene; prints what is wrong with it.
pub(super) fn load(scene: &str, overrides: &Overrides, json: bool) -> Result<Simulation, Exit> {
    source(scene).and_then(|source| Simulation::load_with(&source, overrides, |_| {})).map_err(|errors| {
        print_errors(&errors, json);
        Exit::SceneWrong
    })
}

/// Prints what is wrong with a scene: to people on standard error, to programs on standard output.
pub(super) fn print_errors(errors: &SceneErrors, json: bool) {
    if json {
        print_line(&errors.to_json().to_string());
    } else {
        eprintln!("{}", errors.render(std::io::stderr().is_terminal()).trim_end());
    }
}

/// Prints a line to standard output; a reader that has gone away is no error.
pub(super) fn print_line(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

/// Prints the card and the broken expectations; returns how it ended.
pub(super) fn print_card(scene: &str, simulation: &Simulation, card: &Card) -> Exit {
    let title = simulation.header().title.as_deref().unwrap_or(scene);
    eprintln!("{title}");
    eprintln!("{card}");
    print_outcomes(&simulation.outcomes())
}

/// Prints the broken expectations, a line each; returns how it ended.
pub(super) fn print_outcomes(outcomes: &[Outcome]) -> Exit {
    let broken: Vec<&Outcome> = outcomes.iter().filter(|outcome| !outcome.holds).collect();
    for outcome in &broken {
        eprintln!("  expectation broken: {}: {}", outcome.text, outcome.measured);
    }
    if !outcomes.is_empty() && broken.is_empty() {
        eprintln!("  {} expectations hold", outcomes.len());
    }
    if broken.is_empty() { Exit::Good } else { Exit::SceneWrong }
}

/// What to try when a run goes wrong.
pub(super) fn remedy(card: &Card) -> String {
    let critical = match card.critical_tick {
        Some(critical) if card.tick > critical => format!(
            "the tick of {} s is longer than the contacts can bear ({critical:.3e} s for a single contact); ",
            card.tick
        ),
        _ => String::new(),
    };
    format!("{critical}try `--tick {}`, or look for enormous stiffnesses, speeds or forces", card.tick / 10.0)
}

/// A body in `--json`.
#[derive(Serialize)]
struct BodyState<'a> {
    name: &'a str,
    position: [f64; 2],
    angle: f64,
    velocity: [f64; 2],
    spin: f64,
}

/// The result of a run in `--json`.
#[derive(Serialize)]
struct RunResult<'a> {
    scene: &'a str,
    time: f64,
    ticks: u64,
    seconds_spent: f64,
    bodies: Vec<BodyState<'a>>,
    card: &'a Card,
    expect: Vec<Outcome>,
}

/// Prints the result of a run as JSON, one line; returns how it ended.
pub(super) fn print_json(scene: &str, simulation: &Simulation, card: &Card) -> Exit {
    let (bodies, clock) = (simulation.bodies(), simulation.clock());
    let state = |place: usize| BodyState {
        name: simulation.name(place),
        position: bodies.position[place].into(),
        angle: bodies.angle[place],
        velocity: bodies.velocity[place].into(),
        spin: bodies.spin[place],
    };
    let expect = simulation.outcomes();
    let holds = expect.iter().all(|outcome| outcome.holds);
    let result = RunResult {
        scene,
        time: clock.time(),
        ticks: clock.ticks,
        seconds_spent: simulation.seconds_spent(),
        bodies: (0..bodies.len()).map(state).collect(),
        card,
        expect,
    };
    match serde_json::to_string(&result) {
        Ok(text) => print_line(&text),
        Err(error) => eprintln!("error: the result cannot be written as JSON: {error}"),
    }
    if holds { Exit::Good } else { Exit::SceneWrong }
}
