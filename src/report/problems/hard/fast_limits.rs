//! A wheel between two limits that it hits with at most 100 rad/s. Each hit leaves nine tenths of its rate. SI units.
//!
//! Between two hits the rate is constant. Each hit takes `I (w^2 - w'^2)/2`.

use crate::SimulationExt;
use std::error::Error;

use super::{Case, Extent, Readings, load};
use crate::problems::methods;

/// The case.
pub const CASE: Case = Case {
    name: "fast_limits",
    what: "a wheel hits the limits of its hinge with 100 rad/s",
    source: "Newton's law of impact",
    cheap: true,
    short: "",
    run,
};

/// Rate at the start in rad/s.
const SPIN: f64 = 100.0;
/// Share of the rate that comes back.
const RESTITUTION: f64 = 0.9;
/// In kg m2.
const INERTIA: f64 = 0.5;
/// In s.
const DURATION: f64 = 0.3;

/// Angle in rad, rate in rad/s and number of hits until `time`.
fn state(time: f64) -> (f64, f64, u32) {
    let (mut since, mut angle, mut rate, mut hits) = (0.0, 0.0_f64, SPIN, 0);
    loop {
        let takes = (rate.signum() - angle) / rate;
        if since + takes > time {
            return (angle + rate * (time - since), rate, hits);
        }
        (since, angle, rate, hits) = (since + takes, rate.signum(), -RESTITUTION * rate, hits + 1);
    }
}

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    for method in methods() {
        let per_tick = method.whole_ticks.is_some();
        for tick in [1e-2, 1e-3] {
            hits(method.name, tick, per_tick, readings)?;
        }
    }
    Ok(())
}

fn hits(method: &str, tick: f64, per_tick: bool, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: {DURATION:?}, tick: {tick:?}, method: {method}), contacts: None,
        bodies: [(name: \"wheel\", at: (0, 0), spin: {SPIN:?}, mass: 1, inertia: {INERTIA:?}, atoms: Disc(radius: 0.1))],
        joints: [Revolute(name: \"hub\", a: World, b: \"wheel\", limits: (-1, 1), restitution: {RESTITUTION:?})])"
    ))?;
    let (angle, rate, hits) = state(DURATION);
    let mut beyond = 0.0_f64;
    for tick in 1..=simulation.ticks() {
        simulation.run_to_tick(tick)?;
        beyond = beyond.max(simulation.bodies().angle[0].abs() - 1.0);
    }
    let what = |what: &str| format!("{method}, tick {tick} s: {what}");
    let rounding = 8.0 * f64::from(hits) * f64::EPSILON;
    let (bound, why) = match per_tick {
        true => (SPIN * tick, "hits are seen at the ends of ticks"),
        false => (rounding, "hits are located: rounding of each"),
    };
    readings.at_most(what("how far it goes beyond a limit, rad"), beyond, bound, why);
    let card = simulation.card();
    let lost = 0.5 * INERTIA * (SPIN * SPIN - simulation.bodies().spin[0].powi(2));
    readings.at_most(
        what("energy that is not booked, of all"),
        (card.energy.inelasticity - lost).abs() / (0.5 * INERTIA * SPIN * SPIN),
        rounding,
        "each hit is booked: rounding",
    );
    if !per_tick {
        let off = (simulation.bodies().angle[0] - angle).abs();
        // A hit whose place rounds comes earlier or later, and the rate jumps by up to 190 rad/s there.
        readings.at_most(
            what("error of the angle, rad"),
            off,
            SPIN * DURATION * rounding,
            "rounding of all times of hits",
        );
        let off = (simulation.bodies().spin[0] / rate - 1.0).abs();
        readings.at_most(what("error of the rate, of itself"), off, rounding, "each hit multiplies by the restitution");
    }
    Ok(())
}
