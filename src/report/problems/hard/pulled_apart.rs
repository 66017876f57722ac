//! A mass on two rods between bodies whose motion is prescribed. Their distance determines its position, until they are
//! further apart than both rods. Beyond that no motion exists, and the run has to report it. SI units.
//!
//! With half the distance `s` and rods of length `l` the mass is at `y = -sqrt(l^2 - s^2)`, and `y'' = s'^2 l^2/(l^2 - s^2)^(3/2)`.

use std::error::Error;

use super::{Case, Extent, Readings, load, run_to};
use jostle_engine::joints::Joint;

/// The case.
pub const CASE: Case = Case {
    name: "pulled_apart",
    what: "joints between bodies whose motion is prescribed, until they are pulled apart",
    source: "geometry; Newton's second law",
    cheap: true,
    short: "",
    run,
};

/// Rate of the second body along x in m/s; the first moves with 1 m/s.
const SPEED: f64 = 1.8;
const GRAVITY: f64 = 9.81;
const TICK: f64 = 1e-3;

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    for method in ["SemiImplicitEuler", "VelocityVerlet", "RungeKutta4", "Dop853"] {
        stretch(method, readings)?;
    }
    Ok(())
}

fn stretch(method: &str, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 1, tick: {TICK:?}, method: {method}), gravity: (0, -{GRAVITY:?}), contacts: None,
        bodies: [(name: \"left\", at: (0, 0), kinematic: (velocity: (1, 0)), atoms: Disc(radius: 0.1)),
                 (name: \"right\", at: (1, 0), kinematic: (velocity: ({SPEED:?}, 0)), atoms: Disc(radius: 0.1)),
                 (name: \"mass\", at: (0.5, -0.5), velocity: (1.4, 0.4), mass: 2, inertia: 1, atoms: Disc(radius: 0.1))],
        joints: [Distance(a: \"left\", b: \"mass\"), Distance(a: \"right\", b: \"mass\")])"
    ))?;
    let time = 0.4;
    run_to(&mut simulation, time)?;
    let (rate, half) = (0.5 * (SPEED - 1.0), 0.5 * (1.0 + (SPEED - 1.0) * time));
    let below = 0.5 - half * half;
    let found = simulation.bodies().position[2];
    let off = (found.x - time - half).abs().max((found.y + below.sqrt()).abs());
    readings.at_most(
        format!("{method}: error of the place at {time} s, m"),
        off,
        // Near the end of the possible motion, `y` changes by `s/y` times the distance: 1.3.
        1e-12,
        "joints are closed to rounding, and leave the mass no freedom",
    );
    if method == "Dop853" {
        let pulls = simulation.state().models_of::<Joint>().map(|joint| joint.reaction.0.y).sum::<f64>();
        let exact = 2.0 * (GRAVITY + rate * rate * 0.5 / below.powf(1.5));
        readings.at_most(
            format!("{method}: error of the pull of both rods, of itself"),
            (pulls / exact - 1.0).abs(),
            1e-9,
            "the place is good to 1e-12, and the pull grows at most with its third power",
        );
    }
    let ended = simulation.run_to_end().err();
    let late = ended.map_or(f64::INFINITY, |failure| failure.time) - (2.0_f64.sqrt() - 1.0) / (SPEED - 1.0);
    readings.at_most(
        format!("{method}: s until the run ends after the rods are in line"),
        late,
        TICK,
        "there is no motion beyond: the first tick that ends there cannot be closed",
    );
    Ok(())
}
