//! The result of a run: the error card and the expectations, for people or as JSON.

use crate::SimulationExt;
use serde::Serialize;

use super::Exit;
use super::interrupt;
use super::load::Request;
use super::say::{count, number, print_json, say};
use super::trial::told;
use crate::expect::ExpectationOutcome;
use crate::report::Card;
use crate::report::reversal::Reversal;
use crate::scene::visible_line;
use crate::simulation::Simulation;
use crate::tick::Failure;

/// The detail of the report of a good run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// Only mistakes.
    Quiet,
    /// The card.
    Card,
    /// The result as JSON on standard output.
    Json,
}

impl Detail {
    pub fn of(json: bool, quiet: bool) -> Self {
        match (json, quiet) {
            (true, _) => Self::Json,
            (false, true) => Self::Quiet,
            (false, false) => Self::Card,
        }
    }
}

/// A run that has come to its end.
pub(super) struct Ran<'a> {
    pub simulation: &'a Simulation,
    /// The failure.
    pub failure: Option<&'a Failure>,
    /// It was cut short on purpose: that breaks no expectation that was to be judged later.
    pub cut: bool,
    /// The result of the way back, if that was requested.
    pub back: Option<&'a Result<Reversal, Failure>>,
    /// Whether the verdict `Do not trust it` counts as a failure.
    pub strict: bool,
}

impl<'a> Ran<'a> {
    pub fn whole(simulation: &'a Simulation, failure: Option<&'a Failure>) -> Self {
        Self { simulation, failure, cut: false, back: None, strict: false }
    }
}

/// Reports the result of a run, and returns its exit code.
pub(super) fn tell(request: Request, ran: &Ran, detail: Detail) -> Exit {
    let Ran { simulation, failure, cut, back, strict } = *ran;
    let card = simulation.card();
    let mut exit = Exit::Good;
    let (time, end) = (simulation.state().reached(), simulation.ticks() as f64 * simulation.clock().dt);
    let cut = cut || interrupt::asked() && time < end;
    if interrupt::asked() {
        let told = if time < end {
            let (time, end) = (number(time), number(end));
            format!("Ctrl-C ended the run at t = {time} s of {end} s. All results are those until then")
        } else {
            "Ctrl-C came after the end of the run. Its results are whole, but for the estimate of its error".to_owned()
        };
        say(&format!("note: {}: {told}", request.name));
        exit = Exit::Interrupted;
    }
    if let Some(failure) = failure {
        let why = card.why.as_deref().unwrap_or_default();
        say(&format!("error: {}: the run went wrong: {failure}\nhelp: {why}", request.name));
        exit = exit.worse(Exit::RunWrong);
    } else if strict && card.is_distrusted() {
        say(&format!("error: {}: {}", request.name, card.verdict));
        exit = exit.worse(Exit::RunWrong);
    }
    for warning in &card.warnings {
        say(&format!("warning: {}: {warning}", request.name));
    }
    let outcomes = simulation.outcomes();
    let broken = |outcome: &&ExpectationOutcome| !(outcome.holds || cut && !outcome.judged);
    let broken: Vec<&ExpectationOutcome> = outcomes.iter().filter(broken).collect();
    if !broken.is_empty() {
        exit = exit.worse(Exit::SceneWrong);
    }
    let back = match back {
        Some(Err(failure)) => {
            say(&format!("error: {}: the way back went wrong: {failure}", request.name));
            exit = exit.worse(Exit::RunWrong);
            None
        }
        Some(Ok(back)) => Some(back),
        None => None,
    };
    if detail == Detail::Json {
        return exit.worse(print_result(request.name, simulation, &card, &outcomes, back));
    }
    if detail == Detail::Card {
        // The lines above have told the warnings.
        let mut told = card.clone();
        told.notes.retain(|note| !note.starts_with("warning: "));
        let title = simulation.header().title.as_deref().unwrap_or(request.name);
        say(&format!("{}\n{told}", visible_line(title)));
    }
    if let Some(back) = back {
        say(&format!("  {}", returned(back)));
    }
    for outcome in &broken {
        let place = if detail == Detail::Card { "  " } else { &format!("{}: ", request.name) };
        say(&format!("{place}expectation broken: {}", told(outcome)));
    }
    let holding = outcomes.iter().filter(|outcome| outcome.holds).count();
    if detail == Detail::Card && broken.is_empty() && holding > 0 {
        say(&format!("  {}", count(holding, "expectation holds", "expectations hold")));
    }
    exit
}

/// The distance of a scene from its beginning after the way back, in a sentence.
fn returned(back: &Reversal) -> String {
    let because = back.because.as_ref().map_or_else(String::new, |because| format!(": {because}"));
    format!(
        "There and back: places to {:.1e} m, velocities to {:.1e} m/s, angles to {:.1e} rad of the beginning{because}.",
        back.position, back.velocity, back.angle
    )
}

/// A body in `--json`.
#[derive(Serialize)]
struct BodyState {
    name: String,
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
    bodies: Vec<BodyState>,
    card: &'a Card,
    expect: &'a [ExpectationOutcome],
    #[serde(skip_serializing_if = "Option::is_none")]
    reverse: Option<&'a Reversal>,
}

/// Prints the result of a run as JSON, one line.
fn print_result(
    scene: &str,
    simulation: &Simulation,
    card: &Card,
    expect: &[ExpectationOutcome],
    reverse: Option<&Reversal>,
) -> Exit {
    let (bodies, clock) = (simulation.bodies(), simulation.clock());
    let state = |index: usize| BodyState {
        name: simulation.name(index),
        position: bodies.position[index].into(),
        angle: bodies.angle[index],
        velocity: bodies.velocity[index].into(),
        spin: bodies.spin[index],
    };
    let result = RunResult {
        scene,
        time: simulation.state().reached(),
        ticks: clock.ticks,
        seconds_spent: simulation.seconds_spent(),
        bodies: (0..bodies.len()).map(state).collect(),
        card,
        expect,
        reverse,
    };
    print_json(&result)
}
