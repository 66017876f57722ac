//! Columns, stacks and a wedge with ticks from 1/30 to 1/960 s, and with the engine's choice. Most of the ticks are far
//! beyond the limit of their contacts. Numbers stay finite, and the energy never exceeds that of the start, or the
//! engine reports it. SI units.
//!
//! Below the critical tick the energy of a stable spring swings by `z^2/(1 - z^2)` of the turnover. Here `z` is the
//! tick over the critical one (Hairer, Lubich and Wanner 2006, I.5). Beyond it only a message is promised.

use crate::SimulationExt;
use std::error::Error;
use std::fmt::Write;

use super::{Case, Extent, Reading, Readings, Threshold, column, load, rounded};
use jostle_engine::Simulation;

/// The case.
pub const CASE: Case = Case {
    name: "tick_sweep",
    what: "a column, a stack, masses of 1 and 10 000 kg and a wedge of 2 degrees with ticks of 1/30 to 1/960 s",
    source: "conservation of energy; cases M03, S05, H01 and S04 of the catalogue",
    cheap: false,
    short: "two seconds of ten",
    run,
};

/// Ticks in a second.
const RATES: [u32; 6] = [30, 60, 120, 240, 480, 960];
/// Moments at which energy is looked at, a second.
const LOOKS: f64 = 30.0;
/// The rounding of energies that cancel, as a share of the turnover.
const ROUNDING: f64 = 1e-9;

/// Twenty boxes of 1 kg and half a metre, each on two atoms of the one below.
pub fn stack(tick: f64) -> String {
    let mut bodies = String::new();
    for number in 0..20 {
        let y = 0.25 + 0.5 * f64::from(number);
        let corners: Vec<String> = [(-0.2, -0.2), (0.2, -0.2), (-0.2, 0.2), (0.2, 0.2)]
            .map(|(x, y)| format!("(at: ({x:?}, {y:?}), radius: 0.05, mass: 0.25)"))
            .to_vec();
        let _ = write!(
            bodies,
            "(name: \"box_{number}\", at: (0, {y:?}), material: \"wood\", atoms: List([{}])),",
            corners.join(", ")
        );
    }
    format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: VelocityVerlet), gravity: (0, -9.81),
        contacts: Penalty(start: AsPlaced), materials: {{ \"wood\": (stiffness: 2e6, friction: 0.6, inelasticity: 0.3) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"wood\")], bodies: [{bodies}])"
    )
}

/// A disc of 1 kg between two walls that are 2 degrees from upright.
pub fn wedge(tick: f64) -> String {
    let (sin, cos) = libm::sincos(2.0_f64.to_radians());
    let radius = 0.05;
    let height = radius / sin;
    format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: VelocityVerlet), gravity: (0, -9.81),
        contacts: Penalty(start: AsPlaced), materials: {{ \"smooth\": (stiffness: 1e5, inelasticity: 0.3) }},
        walls: [
            (name: \"left\", left: (0, 0), right: ({:?}, {cos:?}), material: \"smooth\"),
            (name: \"right\", left: ({sin:?}, {cos:?}), right: (0, 0), material: \"smooth\"),
        ],
        bodies: [(name: \"disc\", at: (0, {height:?}), material: \"smooth\", atoms: Disc(radius: {radius:?}, mass: 1))])",
        -sin
    )
}

/// The scenes, by name; each is made with a tick.
type Scene = (&'static str, fn(f64) -> String);
const SCENES: [Scene; 5] = [
    ("column of 20", |tick| column::scene(&[column::DISC; 20], column::CLAY, tick)),
    ("stack of 20 boxes", stack),
    ("10 000 kg on 1 kg", |tick| column::scene(&[(0.5, 1.0, 2e7), (0.5, 1e4, 2e7)], column::CLAY, tick)),
    ("1 kg on 10 000 kg", |tick| column::scene(&[(0.5, 1e4, 2e7), (0.5, 1.0, 2e7)], column::CLAY, tick)),
    ("wedge of 2 degrees", wedge),
];

/// The results of a run.
struct Shown {
    /// Greatest energy above that at the start, J; NaN if the state was NaN.
    above: f64,
    /// Greatest kinetic and elastic energy, J.
    round: f64,
    /// The message of the engine on a tick that is too long.
    told: Option<String>,
    /// The tick over the critical one.
    share: f64,
    /// Deepest overlap, m.
    overlap: f64,
}

fn show(mut simulation: Simulation, duration: f64) -> Shown {
    let (tick, start) = (simulation.clock().dt, simulation.card().energy);
    let start = start.kinetic + start.potential + start.elastic;
    let (mut above, mut round) = (0.0_f64, 0.0_f64);
    let mut told = None;
    for look in 1..=(duration * LOOKS) as u32 {
        let ended = simulation.run_to_tick((f64::from(look) / LOOKS / tick).round() as u64);
        let energy = simulation.card().energy;
        let excess = energy.kinetic + energy.potential + energy.elastic - start;
        above = if excess.is_nan() { f64::NAN } else { above.max(excess) };
        round = round.max(energy.kinetic + energy.elastic);
        if let Err(failure) = ended {
            told = Some(failure.to_string());
            break;
        }
    }
    let card = simulation.card();
    let share = card.critical_tick.map_or(0.0, |critical| tick / critical);
    let told = told.or_else(|| card.warnings.iter().find(|warning| warning.contains("critical")).cloned());
    Shown { above, round, told, share, overlap: card.largest_overlap.meters }
}

fn run(extent: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let duration = extent.pick(2.0, 10.0);
    for (name, scene) in SCENES {
        let left_out = format!("tick: {:?}, ", 1.0);
        let chosen = load(&scene(1.0).replace(&left_out, ""))?;
        let tick = chosen.clock().dt;
        let fine = show(chosen, duration);
        let goes_round = fine.round;
        let mut judge = |tick: &str, shown: Shown| {
            let z = shown.share;
            let (bound, why) = if z < 1.0 {
                (z * z / (1.0 - z * z), "z^2/(1 - z^2), z the tick over the critical one: the swing of a stable spring")
            } else {
                (0.0, "no more than at the start; the tick is above the critical one")
            };
            readings.0.push(Reading {
                what: format!(
                    "{name}, {tick}: energy above the start, of the energy that changes form ({} of the critical tick, overlap {} m)",
                    rounded(z),
                    rounded(shown.overlap)
                ),
                value: shown.above / goes_round,
                threshold: Threshold::AtMost(bound + ROUNDING),
                why,
                told: shown.told.filter(|_| z >= 1.0),
            });
        };
        judge(&format!("chosen tick of {} s", rounded(tick)), fine);
        for rate in RATES {
            judge(&format!("1/{rate} s"), show(load(&scene(1.0 / f64::from(rate)))?, duration));
        }
    }
    Ok(())
}
