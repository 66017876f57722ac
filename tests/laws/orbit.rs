//! Law: a planet keeps its energy and angular momentum. A symplectic method keeps the first within a bound, without
//! trend, and the second exactly, for the attraction points along the line of centres. Source: Hairer, Lubich, Wanner,
//! *Geometric Numerical Integration*, I.2 and IX; truth file P07.
//!
//! Tolerances: passing the sun, where the kinetic energy is 19 times the total and the rate `r^-1.5`, the energy may be
//! wrong by `19 (rate dt)^2`; back at the far end, where the motion is slow, by much less: `(dt / 2)^2` of the rates
//! there, which are below one. Angular momentum: rounding of one kick each, all of one sign.
//!
//! Not tested: places on the ellipse (see `problems`).

use std::f64::consts::TAU;

use jostle::problems::{Setting, Truth, kepler};

use super::support::{assert_near, momenta};

#[test]
fn a_hundred_orbits_keep_energy_and_angular_momentum() {
    let truth = Truth::read(include_str!("../../assets/truths/P07_kepler.json"));
    let steps = 8000_u32;
    let tick = TAU / f64::from(steps);
    let setting = Setting { method: "VelocityVerlet", tick, shift: 0.0, ..Setting::default() };
    let mut simulation = kepler::PROBLEM.load(&setting).expect("the scene is correct");
    let mass = simulation.bodies().mass[1];
    let energy = truth.number("energy per unit reduced mass");
    let turning = truth.number("angular momentum per unit reduced mass");
    let bound = 19.0 * ((1.0 - kepler::ECCENTRICITY).powf(-1.5) * tick).powi(2);
    let (mut worst, mut far) = (0.0_f64, Vec::new());
    for sample in 1..=10_000_u64 {
        simulation.run_to_tick(sample * u64::from(steps) / 100).expect("numbers stay finite");
        let bodies = simulation.bodies();
        let now = 0.5 * bodies.velocity[1].length_squared() - 1.0 / bodies.position[1].length();
        let error = now / energy - 1.0;
        worst = worst.max(error.abs());
        if sample % 100 == 0 {
            far.push(error);
        }
        let ticks = simulation.clock().ticks as f64;
        let ((_, found), _) = momenta(bodies);
        assert_near("angular momentum", found / (mass * turning), 1.0, (ticks + 8.0) * f64::EPSILON);
    }
    println!("worst {worst:.2e} of {bound:.2e}, at the far end {:.2e} .. {:.2e}", far[0], far[99]);
    assert!(worst <= bound, "{worst:e} > {bound:e}");
    assert!(worst > bound / 1000.0, "the energy must swing at all: {worst:e}");
    let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
    // No trend: a method that loses energy at each passage would show a hundred passages.
    let trend = (mean(&far[80..]) - mean(&far[..20])).abs();
    assert!(trend < worst / 100.0, "the energy at the far end wanders by {trend:e}");
}
