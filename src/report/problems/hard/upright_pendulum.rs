//! A pendulum that begins at 179 degrees, a degree from its upper equilibrium, beside those of 10 and 90 degrees. SI units.
//!
//! The period `T = 4 K/w` depends on the distance `delta` from the equilibrium as `-4/(w delta)` per radian. Rounding
//! of the energy at the bottom, `2 g l`, counts `2/delta` times there.

use std::error::Error;

use super::{Case, Extent, Readings, load, run_to};
use crate::problems::linkage::hanging;
use crate::problems::pendulum::{TRUTH, observable, scene_of};
use crate::problems::{ProblemSetting, Truth};
use jostle_engine::joints::Joint;

/// The case.
pub const CASE: Case = Case {
    name: "upright_pendulum",
    what: "a pendulum that begins a degree from its upper equilibrium, for 10 s",
    source: "Jacobi's elliptic functions; truth file J01",
    cheap: true,
    short: "",
    run,
};

/// Ticks in a second.
const RATE: f64 = 512.0;
/// In s.
const DURATION: f64 = 10.0;

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let truth = Truth::read(TRUTH);
    let setting = ProblemSetting { method: "Dop853", tick: 1.0 / RATE, ..ProblemSetting::default() };
    for degrees in [10, 90, 179] {
        let mut simulation = load(&scene_of(&setting.clock(DURATION), &[degrees]))?;
        let (mut place, mut pull) = (0.0_f64, 0.0_f64);
        for time in truth.times(&observable(degrees)) {
            run_to(&mut simulation, time)?;
            let row = truth.row(&observable(degrees), time).unwrap_or_default();
            let found = simulation.bodies().position[0];
            place = place.max(found.distance(hanging(row[0])));
            let joint = simulation.state().model::<Joint>().ok_or("no joint")?;
            pull = pull.max((joint.reaction.0.dot(-found.normalize()) - row[2]).abs());
        }
        let (bound, why) = match degrees {
            179 => (condition() * f64::EPSILON * (DURATION * RATE).sqrt(), "condition times rounding, by chance"),
            _ => (1e-12, "order 8 is at rounding"),
        };
        readings.at_most(format!("{degrees} degrees: greatest error of the place, of the length"), place, bound, why);
        // The tension is `3 m g cos theta` and a constant: it errs with the angle by at most 3 m g = 29.4 N.
        readings.at_most(
            format!("{degrees} degrees: greatest error of the tension, of 3 m g"),
            pull / 29.43,
            bound,
            "the tension is 3 m g cos theta and a constant: it is known as well as the place",
        );
    }
    Ok(())
}

/// By how much a relative error of the energy counts at the end.
fn condition() -> f64 {
    let (rate, delta) = (9.81_f64.sqrt(), 1.0_f64.to_radians());
    let period = 7.825_796_837_537_683;
    let late = DURATION / period * 4.0 / (rate * delta);
    2.0 / delta * late * 2.0 * rate
}
