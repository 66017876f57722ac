//! A chain of 200 rods with masses between them hangs by both ends; in mid-run its last rod breaks. SI units.
//!
//! At rest `tan phi_i = V_i/H`, with `H` from the span. At the moment of the cut no mass moves yet, and the pulls solve
//! `2 T_i - T_(i-1) cos(phi_i - phi_(i-1)) - T_(i+1) cos(phi_(i+1) - phi_i) = 0`. At the pin it is `T_1 - T_2
//! cos(phi_2 - phi_1) = m g sin phi`.

use crate::SimulationExt;
use std::error::Error;
use std::fmt::Write;

use glam::DVec2;

use super::{Case, Extent, Readings, kinetic, load, run_to};
use crate::problems::linkage::greatest;
use jostle_engine::Simulation;
use jostle_engine::joints::Joint;

/// The case.
pub const CASE: Case = Case {
    name: "cut_chain",
    what: "a chain of 200 rods hangs by both ends and is cut in mid-run",
    source: "statics; equations of masses with multipliers",
    cheap: false,
    short: "it falls for 0.05 s only",
    run,
};

/// Number of rods.
const COUNT: usize = 200;
/// Length of a rod in m.
const LENGTH: f64 = 0.05;
/// Of each of the masses between rods, in kg.
const MASS: f64 = 0.1;
/// Distance of both ends in m.
const SPAN: f64 = 7.0;
const GRAVITY: f64 = 9.81;
/// When its last mass begins to be pulled, in s, and within which time by 1 N.
const CUT: f64 = 0.05;
const RAMP: f64 = 1e-3;

/// The horizontal part of all pulls in N: the one with which the rods reach from end to end.
fn horizontal() -> f64 {
    let reach = |pull: f64| directions(pull).map(|direction| direction.x * LENGTH).sum::<f64>();
    let (mut low, mut high) = (0.0, 1e6);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        *(if reach(middle) < SPAN { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// Directions of the rods at rest.
fn directions(pull: f64) -> impl Iterator<Item = DVec2> {
    (0..COUNT).map(move |rod| DVec2::new(pull, -MASS * GRAVITY * (0.5 * (COUNT as f64 - 1.0) - rod as f64)).normalize())
}

/// The chain. Its last rod bears `strength` in N; without that it is not there. From [`CUT`] on the last mass is pulled, within
/// [`RAMP`] by 1 N.
fn scene(method: &str, (tick, duration): (f64, f64), strength: Option<f64>) -> String {
    let (mut at, mut bodies, mut joints) = (DVec2::ZERO, String::new(), String::new());
    let rods: Vec<DVec2> = directions(horizontal()).collect();
    let mut before = "World, anchor_a: (0, 0)".to_owned();
    for (rod, direction) in rods[..COUNT - 1].iter().enumerate() {
        at += *direction * LENGTH;
        let _ = write!(
            bodies,
            "(name: \"mass_{rod}\", at: ({:?}, {:?}), mass: {MASS:?}, inertia: 1, atoms: Disc(radius: 0.01)),",
            at.x, at.y
        );
        let _ = write!(joints, "Distance(name: \"rod_{rod}\", a: {before}, b: \"mass_{rod}\", length: {LENGTH:?}),");
        before = format!("\"mass_{rod}\"");
    }
    let last = COUNT - 1;
    let pulled = strength.map_or_else(String::new, |strength| {
        let _ = write!(
            joints,
            "Distance(name: \"rod_{last}\", a: {before}, b: World, anchor_b: ({SPAN:?}, 0), length: {LENGTH:?}, assemble: true,
                      break_force: {strength:?}),"
        );
        let (x, y) = (-rods[last].x, -rods[last].y);
        format!("forces: [Drive(of: {before}, force: ({x:?}, {y:?}), course: Piecewise([({CUT:?}, 0), ({:?}, 1)]))],", CUT + RAMP)
    });
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}, tick: {tick:?}, method: {method}), gravity: (0, -{GRAVITY:?}),
        contacts: None, {pulled} bodies: [{bodies}], joints: [{joints}])"
    )
}

/// The pull in N in a rod.
fn pull(simulation: &Simulation, rod: usize) -> f64 {
    let joint = simulation.state().models_of::<Joint>().find(|joint| joint.name == format!("rod_{rod}"));
    joint.map_or(f64::NAN, |joint| joint.reaction.0.length())
}

/// Pulls in N at the moment of the cut: Thomas's algorithm.
fn pulls_at_the_cut() -> Vec<f64> {
    let rods: Vec<DVec2> = directions(horizontal()).take(COUNT - 1).collect();
    let (mut upper, mut right) = (Vec::<f64>::new(), Vec::<f64>::new());
    for rod in 0..rods.len() {
        let lower = if rod > 0 { -rods[rod].dot(rods[rod - 1]) } else { 0.0 };
        let beside = rods.get(rod + 1).map_or(0.0, |next| -next.dot(rods[rod]));
        // At the pin only one of both ends moves, and gravity does.
        let (diagonal, known) = if rod > 0 { (2.0, 0.0) } else { (1.0, -MASS * GRAVITY * rods[0].y) };
        let pivot = diagonal - lower * upper.last().unwrap_or(&0.0);
        right.push((known - lower * right.last().unwrap_or(&0.0)) / pivot);
        upper.push(beside / pivot);
    }
    for rod in (0..rods.len() - 1).rev() {
        right[rod] -= upper[rod] * right[rod + 1];
    }
    right
}

fn run(extent: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let tick = 1e-9;
    let mut simulation = load(&scene("Dop853", (tick, tick), None))?;
    simulation.run_to_end()?;
    let exact = pulls_at_the_cut();
    let off = greatest((0..COUNT - 1).map(|rod| pull(&simulation, rod) / exact[0] - exact[rod] / exact[0]));
    readings.at_most(
        "at the cut: greatest error of a pull, of the greatest",
        off,
        // The equations of 199 rods in a row have a condition of the square of their number.
        (COUNT * COUNT) as f64 * f64::EPSILON,
        "rounding times the condition of 199 equations in a row, the square of their number",
    );
    let (pulled, end) = (horizontal().hypot(0.5 * (COUNT as f64 - 1.0) * MASS * GRAVITY), extent.pick(0.1, 1.0));
    for (method, tick) in [("Dop853", 1e-3), ("VelocityVerlet", 5e-4)] {
        falls(method, (tick, end), pulled, readings)?;
    }
    Ok(())
}

/// The chain hangs still, breaks and falls. `pulled` is the pull in its last rod at rest, in N.
fn falls(method: &str, (tick, end): (f64, f64), pulled: f64, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let what = |what: &str| format!("{method}: {what}");
    let mut simulation = load(&scene(method, (tick, end), Some(pulled + 0.5)))?;
    let places = simulation.bodies().position.clone();
    run_to(&mut simulation, CUT)?;
    let moved = greatest(simulation.bodies().position.iter().zip(&places).map(|(now, was)| now.distance(*was)));
    // Directions round by a unit in the last place of a sum of 200 rods of 0.05 m each.
    readings.at_most(
        what("greatest way of a mass before the cut, m"),
        moved,
        COUNT as f64 * f64::EPSILON * SPAN,
        "places are sums of as many rods, each rounded once",
    );
    run_to(&mut simulation, end)?;
    let card = simulation.card();
    let broke = card.notes.iter().any(|note| note.contains("`rod_199` broke at"));
    readings.at_most(what("breaks that are not told"), f64::from(!broke), 0.0, "what breaks is told, with its time");
    let drift = card.largest_joint_drift.as_ref().map_or(f64::NAN, |drift| drift.meters);
    readings.at_most(what("joint drift, of the length"), drift / SPAN, 1e-12, "joints are closed to rounding");
    let energy = kinetic(simulation.bodies());
    readings.at_least(what("kinetic energy in the end, J"), energy, 0.1, "what is cut falls");
    if method == "Dop853" {
        readings.at_most(
            what("energy that is missing, of the kinetic energy"),
            card.energy.residual.abs() / energy,
            1e-9,
            "a break takes no energy; with ticks of 1 ms the fastest mode, below 500/s, has omega dt = 0.5 and order 8",
        );
    }
    Ok(())
}
