//! How a run went: the error card and the expectations, for people or as JSON.

use serde::Serialize;

use super::Exit;
use super::load::Request;
use super::say::{count, print_line, say};
use crate::expect::Outcome;
use crate::report::Card;
use crate::report::card::number;
use crate::simulation::Simulation;
use crate::tick::Failure;

/// How much is told of a run that went well.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// Only what is wrong.
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

/// Tells how a run went, and returns how it ended. A run that was `cut` short on purpose breaks no expectation that
/// was to be judged later.
pub(super) fn tell(
    request: Request,
    simulation: &Simulation,
    failure: Option<&Failure>,
    cut: bool,
    detail: Detail,
) -> Exit {
    let mut card = simulation.card();
    let mut exit = Exit::Good;
    if let Some(failure) = failure {
        let remedy = remedy(&card);
        say(&format!("error: {}: the run went wrong: {failure}\nhelp: {remedy}", request.name));
        card.verdict = format!("Do not trust it: the run went wrong: {failure}; {remedy}.");
        exit = Exit::RunWrong;
    }
    for warning in &card.warnings {
        say(&format!("warning: {}: {warning}", request.name));
    }
    let outcomes = simulation.outcomes();
    let broken = |outcome: &&Outcome| !(outcome.holds || cut && !outcome.judged);
    let broken: Vec<&Outcome> = outcomes.iter().filter(broken).collect();
    if !broken.is_empty() {
        exit = exit.worse(Exit::SceneWrong);
    }
    if detail == Detail::Json {
        return exit.worse(print_json(request.name, simulation, &card, &outcomes));
    }
    if detail == Detail::Card {
        say(&format!("{}\n{card}", simulation.header().title.as_deref().unwrap_or(request.name)));
    }
    for outcome in &broken {
        let place = if detail == Detail::Card { "  " } else { &format!("{}: ", request.name) };
        say(&format!("{place}expectation broken: {}: {}", outcome.text, outcome.measured));
    }
    let holding = outcomes.iter().filter(|outcome| outcome.holds).count();
    if detail == Detail::Card && broken.is_empty() && holding > 0 {
        say(&format!("  {}", count(holding, "expectation holds", "expectations hold")));
    }
    exit
}

/// The likely cause of a run that went wrong, and what to try.
pub(super) fn remedy(card: &Card) -> String {
    match card.critical_tick.zip(card.holder()) {
        Some((critical, holder)) if card.tick > critical => format!(
            "the tick of {} s is longer than the {holder} can bear, {} s: try `--tick {}`",
            number(card.tick),
            number(critical),
            number(card.advised_tick())
        ),
        _ => format!(
            "numbers grew beyond all bounds: look for enormous speeds, forces, stiffnesses or sizes, for masses near \
             zero, for drag that stops a body within a tick, for a plugin that does not book its work, or try `--tick {}`",
            number(card.tick / 4.0)
        ),
    }
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
    expect: &'a [Outcome],
}

/// Prints the result of a run as JSON, one line.
fn print_json(scene: &str, simulation: &Simulation, card: &Card, expect: &[Outcome]) -> Exit {
    let (bodies, clock) = (simulation.bodies(), simulation.clock());
    let state = |place: usize| BodyState {
        name: simulation.name(place),
        position: bodies.position[place].into(),
        angle: bodies.angle[place],
        velocity: bodies.velocity[place].into(),
        spin: bodies.spin[place],
    };
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
        Err(error) => {
            say(&format!("error: the result cannot be written as JSON: {error}"));
            Exit::RunWrong
        }
    }
}
