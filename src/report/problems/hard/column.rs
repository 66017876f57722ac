//! A column of twenty discs on a floor: each contact carries the weight of all discs above it. SI units.
//!
//! Under `Inelasticity` contacts hold with any force that their law allows at rest. Elastic discs settle by drag and
//! have one overlap only, force over stiffness, so the springs alone decide there.

use std::error::Error;
use std::fmt::Write;

use super::{Case, Extent, Readings, load, run_to};
use crate::problems::Truth;
use jostle_engine::Simulation;
use jostle_engine::tick::State;

/// The case.
pub const CASE: Case = Case {
    name: "column",
    what: "twenty discs, one on top of the other",
    source: "hydrostatics; truth file M03",
    cheap: false,
    short: "",
    run,
};

/// The reference values.
pub const TRUTH: &str = include_str!("../../../../assets/truths/M03_column_hydrostatic.json");
/// Radius in m, mass in kg and stiffness in N/m of each disc.
pub const DISC: (f64, f64, f64) = (0.05, 0.5, 2e5);
/// Contacts that lose energy, and hold at rest.
pub const CLAY: &str = "materials: { \"smooth\": (stiffness: 1, inelasticity: 0.3) },";
/// Contacts without loss, in a medium.
pub const ELASTIC: &str = "materials: { \"smooth\": (stiffness: 1) }, forces: [Drag(linear: 1.0)],";
/// A body may be laid to rest with an imbalance of this share of the weight.
const IMBALANCE: f64 = 1e-9;

/// Frictionless discs on a floor, one above the other between guides that they do not touch. Each has a radius in m, a
/// mass in kg and a stiffness in N/m. `rest` holds the material `smooth` and all further entries.
pub fn scene(discs: &[(f64, f64, f64)], rest: &str, tick: f64) -> String {
    let mut bodies = String::new();
    let mut height = 0.0;
    for (number, (radius, mass, stiffness)) in discs.iter().enumerate() {
        height += radius;
        let _ = write!(
            bodies,
            "(name: \"disc_{number}\", at: (0, {height:?}), material: \"smooth\",
              atoms: List([(at: (0, 0), radius: {radius:?}, mass: {mass:?}, stiffness: {stiffness:?})])),"
        );
        height += radius;
    }
    format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: VelocityVerlet), gravity: (0, -9.81), {rest}
        contacts: Penalty(start: AsPlaced), walls: [
            (name: \"floor\", left: (1, 0), right: (0, 0), material: \"smooth\"),
            (name: \"left\", left: (-0.6, 0), right: (-0.6, 1), material: \"smooth\"),
            (name: \"right\", left: (0.6, 1), right: (0.6, 0), material: \"smooth\"),
        ],
        sensors: [ContactForce(on: \"floor\")], bodies: [{bodies}])"
    )
}

/// Contact forces in N from the floor up, that of the floor first. Each contact between discs carries the contact
/// forces on all above it.
pub fn carried(simulation: &Simulation) -> Vec<f64> {
    let Some(forces) = simulation.resource::<State>().contact_forces() else { return Vec::new() };
    let mut carried: Vec<f64> = forces
        .on_body
        .iter()
        .rev()
        .scan(0.0, |sum, force| {
            *sum += force.y;
            Some(*sum)
        })
        .collect();
    carried.push(-forces.on_wall[0].y);
    carried.reverse();
    carried
}

/// Lets a column with losses settle, and compares what each of its contacts carries.
///
/// # Errors
/// When the run fails.
pub fn stands(
    what: &str,
    discs: &[(f64, f64, f64)],
    tick: f64,
    exact: &[f64],
    readings: &mut Readings,
) -> Result<(), Box<dyn Error>> {
    let mut simulation = load(&scene(discs, CLAY, tick))?;
    readings.rests(what, &mut simulation, 20.0, 1.0)?;
    let carried = carried(&simulation);
    // The floor bears the force of the lowest disc.
    let exact = exact.first().into_iter().chain(exact);
    let worst = carried.iter().zip(exact).map(|(found, exact)| (found / exact - 1.0).abs()).fold(0.0, f64::max);
    readings.at_most(
        format!("{what}: greatest error of a contact force, of itself"),
        if carried.len() == discs.len() + 1 { worst } else { f64::NAN },
        IMBALANCE,
        "the imbalance with which a body may be laid to rest",
    );
    Ok(())
}

/// Overlaps in m from the floor up.
fn overlaps(simulation: &Simulation, radius: f64) -> Vec<f64> {
    let heights: Vec<f64> = simulation.bodies().position.iter().map(|position| position.y).collect();
    let between = heights.windows(2).map(|pair| 2.0 * radius - (pair[1] - pair[0]));
    std::iter::once(radius - heights[0]).chain(between).collect()
}

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let truth = Truth::read(TRUTH);
    stands("column", &[DISC; 20], 2e-4, &truth.numbers("contact forces from the floor up"), readings)?;
    // The lowest mode dies out with exp(-c t/2 m): to 1e-13 of its 10 mm after 30 s.
    let exact = truth.numbers("overlaps from the floor up");
    let mut simulation = load(&scene(&[DISC; 20], ELASTIC, 2e-4))?;
    run_to(&mut simulation, 40.0)?;
    let found = overlaps(&simulation, DISC.0);
    // The floor is infinitely stiff. So its contact has the disc's own stiffness, twice that of a pair.
    let exact = std::iter::once(exact[0] / 2.0).chain(exact[1..].iter().copied());
    let worst = found.iter().zip(exact).map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max);
    readings.at_most(
        "elastic column: greatest error of an overlap after 40 s, m",
        worst,
        1e-12,
        "the slowest mode has died out to 1e-13 of 10 mm; 20 heights of 2 m are rounded to 4e-16 m each",
    );
    Ok(())
}
