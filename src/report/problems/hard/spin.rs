//! A rigid cluster of three atoms at 1e4 rad/s for ten seconds, with nothing acting on it. SI units.
//!
//! Cosine and sine are computed from the angle at each tick and never accumulated, so atoms keep their distances.

use std::error::Error;

use super::{Case, Extent, METHODS, Readings, kinetic};
use crate::problems::{ProblemSetting, Truth, cluster_rotation};
use jostle_engine::Simulation;

/// The case.
pub const CASE: Case = Case {
    name: "spin",
    what: "a cluster at 1e4 rad/s keeps spin, energy, momentum and shape",
    source: "rigid body kinematics; truth file P05",
    cheap: true,
    short: "",
    run,
};

/// Distances of the atoms in m.
fn distances(simulation: &Simulation) -> [f64; 3] {
    let place = |atom| simulation.bodies().atom_place(atom);
    [(0, 1), (1, 2), (2, 0)].map(|(a, b)| place(a).distance(place(b)))
}

/// About the origin, in N m s.
fn angular_momentum(simulation: &Simulation) -> f64 {
    let bodies = simulation.bodies();
    bodies.position[0].perp_dot(bodies.mass[0] * bodies.velocity[0]) + bodies.inertia[0] * bodies.spin[0]
}

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let truth = Truth::read(cluster_rotation::TRUTH);
    let center = truth.numbers("centre of mass");
    for method in METHODS {
        let setting = ProblemSetting { method, tick: 1e-4, ..ProblemSetting::default() };
        let mut simulation = cluster_rotation::PROBLEM.load(&setting)?;
        let bodies = simulation.bodies();
        let made = [
            bodies.mass[0] - truth.number("mass"),
            bodies.inertia[0] - truth.number("inertia"),
            bodies.position[0].x - center[0],
            bodies.position[0].y - center[1],
        ];
        readings.at_most(
            format!("{method}: greatest error of mass, inertia and centre, SI"),
            made.into_iter().map(f64::abs).fold(0.0, f64::max),
            1e-15,
            "sums of three terms of size 1",
        );
        let before = distances(&simulation);
        let (mut changed, mut energy, mut turning, mut shape, mut place) =
            (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        for tick in [1, 100, 10_000, 100_000] {
            simulation.run_to_tick(tick)?;
            let bodies = simulation.bodies();
            let same = bodies.spin[0] == cluster_rotation::SPIN && bodies.velocity[0] == cluster_rotation::VELOCITY;
            changed += f64::from(!same);
            energy = energy.max((kinetic(bodies) / truth.number("kinetic energy") - 1.0).abs());
            let exact = truth.number("angular momentum about origin");
            turning = turning.max((angular_momentum(&simulation) / exact - 1.0).abs());
            let off = distances(&simulation).into_iter().zip(before).map(|(now, before)| (now - before).abs());
            shape = off.fold(shape, f64::max);
            place = place.max((cluster_rotation::PROBLEM.error)(&simulation, simulation.clock().time(), 0.0));
        }
        let why = "nothing acts: spin and velocity stay to the last bit";
        readings.at_most(format!("{method}: looks that find another spin or velocity"), changed, 0.0, why);
        let (ulps, why) = (16.0 * f64::EPSILON, "sums of a few terms: 16 units in the last place");
        readings.at_most(format!("{method}: error of the kinetic energy, of itself"), energy, ulps, why);
        readings.at_most(format!("{method}: error of the angular momentum, of itself"), turning, ulps, why);
        readings.at_most(
            format!("{method}: change of the distance of two atoms, m"),
            shape,
            4.0 * f64::EPSILON * 8.0,
            "one (cos, sin) a tick, not accumulated: four units in the last place of positions of up to 8 m",
        );
        readings.at_most(
            format!("{method}: greatest error of the place of an atom, m"),
            place,
            cluster_rotation::FLOOR,
            "the angle of 1e5 rad is known to an ulp, and the clock's product n dt too",
        );
    }
    Ok(())
}
