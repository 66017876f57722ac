//! Ratios of masses of up to a million across a joint. One case is a light rope with a heavy load. The others are a light bar
//! with a heavy bob, and a heavy bar with a light bob. SI units.
//!
//! A bar of mass `m` swings as a pendulum, with a bob of mass `M` pinned to its end. Its rate is `w^2 = g/l (M + m/2)/(M + m/3)`.
//! From 90 degrees it is at the bottom after `K(1/sqrt(2))/w`. There the pin bears `M (g + 2 w^2 l)`.

use crate::SimulationExt;
use std::error::Error;

use glam::DVec2;

use super::{Case, Extent, Readings, load, run_to};
use crate::problems::linkage::{bar, greatest, turned_off};
use crate::problems::loaded_rope::{COUNT, TRUTH, scene_of};
use crate::problems::{ProblemSetting, Truth};
use jostle_engine::Simulation;
use jostle_engine::joints::Joint;

/// The case.
pub const CASE: Case = Case {
    name: "heavy_load",
    what: "ratios of masses of up to a million across a joint: a loaded rope, a bar with a bob",
    source: "statics, elliptic integral, Lagrange's equations; truth file S06",
    cheap: false,
    short: "the rope swings for 0.5 s only",
    run,
};

/// The complete elliptic integral of the first kind of the modulus `1/sqrt(2)`.
const QUARTER: f64 = 1.854_074_677_301_371_9;
const GRAVITY: f64 = 9.81;
/// Each force is a difference of others that are larger by the ratio of the masses.
const FORCE: &str =
    "forces of light bodies are found among those of heavy ones: a few units in the last place times the ratio";

fn run(extent: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    hangs((0.01, 100.0), 1e-4, readings)?;
    hangs((1e-3, 1e3), 1e-5, readings)?;
    swings(extent.pick(0.5, 2.0), readings)?;
    for masses in [(1e-3, 1e3), (1e3, 1e-3)] {
        bob(masses, readings)?;
    }
    Ok(())
}

/// The force in N of a joint on its second body.
fn force(simulation: &Simulation, name: &str) -> DVec2 {
    let joint = simulation.state().models_of::<Joint>().find(|joint| joint.name == name);
    joint.map_or(DVec2::NAN, |joint| joint.reaction.0)
}

/// The rope hangs straight: each pin bears the weight below it. `masses` are those of a link and of the load.
fn hangs(masses: (f64, f64), tick: f64, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let setting = ProblemSetting { method: "VelocityVerlet", tick, ..ProblemSetting::default() };
    let mut simulation = load(&scene_of(&setting.clock(100.0 * tick), masses, 0.0))?;
    simulation.run_to_end()?;
    let (link, load) = masses;
    let ratio = load / link;
    let off = (0..COUNT).map(|pin| {
        let below = (load + link * (COUNT - pin) as f64) * GRAVITY;
        force(&simulation, &format!("link_pin{pin}")).y / below - 1.0
    });
    readings.at_most(format!("straight rope, {ratio}: error of a pull, of itself"), greatest(off), bound(ratio), FORCE);
    Ok(())
}

fn bound(ratio: f64) -> f64 {
    4.0 * f64::EPSILON * ratio
}

/// The rope swings with a load of ten thousand links.
fn swings(until: f64, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let truth = Truth::read(TRUTH);
    let observable = "link angles after release of the straight rope";
    let error = |method: &str, tick: f64| -> Result<f64, Box<dyn Error>> {
        let setting = ProblemSetting { method, tick, ..ProblemSetting::default() };
        let mut simulation = load(&scene_of(&setting.clock(until), (0.01, 100.0), 30.0))?;
        let mut worst = 0.0_f64;
        for time in truth.times(observable).into_iter().filter(|time| *time <= until) {
            run_to(&mut simulation, time)?;
            worst = worst.max(turned_off(&simulation, 0, &truth.row(observable, time).unwrap_or_default()));
        }
        Ok(worst)
    };
    let tick = 1e-4;
    readings.at_most(
        format!("swinging rope, Dop853: error of an angle until {until} s, rad"),
        error("Dop853", tick)?,
        1e-12,
        "ten times the error of the reference",
    );
    let order = (error("VelocityVerlet", 0.25 * tick)? / error("VelocityVerlet", 0.125 * tick)?).log2();
    readings.at_least(
        "swinging rope, VelocityVerlet: order with which errors fall",
        order,
        1.75,
        "order 2 within a quarter, where the fastest mode has omega dt = 0.06",
    );
    Ok(())
}

/// A bar of 1 m with a bob at its end, let go level. `masses` are those of bar and bob.
fn bob(masses: (f64, f64), readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let (bar_mass, bob_mass) = masses;
    let square = GRAVITY * (bob_mass + bar_mass / 2.0) / (bob_mass + bar_mass / 3.0);
    let ticks = 200;
    let tick = QUARTER / square.sqrt() / f64::from(ticks);
    let setting = ProblemSetting { method: "Dop853", tick, ..ProblemSetting::default() };
    let clock = setting.clock(tick * f64::from(ticks));
    let bar = bar("bar", DVec2::ZERO, DVec2::X, bar_mass);
    let mut simulation = load(&format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: None,
        bodies: [{bar} (name: \"bob\", at: (1, 0), mass: {bob_mass:?}, inertia: {bob_mass:?}, atoms: Disc(radius: 0.1))],
        joints: [Revolute(name: \"hinge\", a: World, anchor_a: (0, 0), b: \"bar\", anchor_b: (-0.5, 0)),
                 Revolute(name: \"pin\", a: \"bar\", anchor_a: (0.5, 0), b: \"bob\", anchor_b: (0, 0))])"
    ))?;
    simulation.run_to_end()?;
    let what = |what: &str| format!("bar of {bar_mass} kg, bob of {bob_mass} kg: {what}");
    let angle = simulation.bodies().angle[0] + std::f64::consts::FRAC_PI_2;
    readings.at_most(what("error of the angle at the bottom, rad"), angle.abs(), 1e-12, "order 8 is at rounding");
    let pull = bob_mass * (GRAVITY + 2.0 * square);
    let ratio = (bar_mass / bob_mass).max(bob_mass / bar_mass);
    let off = (force(&simulation, "pin").y / pull - 1.0).abs();
    readings.at_most(what("error of the pull of the pin, of itself"), off, bound(ratio), FORCE);
    let drift = simulation.card().largest_joint_drift.map_or(f64::NAN, |drift| drift.meters);
    readings.at_most(what("joint drift, m"), drift, 1e-12, "joints are closed to rounding, whatever the masses");
    Ok(())
}
