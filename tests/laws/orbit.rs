//! Law: a planet keeps its energy and angular momentum. A symplectic method keeps the first within a bound, without
//! trend. It keeps the second exactly, because the attraction points along the line of centres. Source: Hairer, Lubich,
//! Wanner, *Geometric Numerical Integration*, I.2 and IX; truth file P07.
//!
//! Tolerances: passing the sun, where the kinetic energy is 19 times the total and the rate `r^-1.5`, the energy may be
//! wrong by `19 (rate dt)^2`; back at the far end, where the motion is slow, by much less: `(dt / 2)^2` of the rates
//! there, which are below one. Angular momentum: rounding of one kick each, all of one sign.
//!
//! Over ten thousand orbits the energy, averaged over a hundred of them at a time, may have no trend: the slope of its regression
//! line is within four times the statistical error that the scatter about the line gives it, or the whole of it below a
//! thousandth of the swing in an orbit. A method that is not symplectic has one: each passage takes the same share.
//!
//! Not tested: places on the ellipse (see `problems`) but those of `Dop853` after a hundred orbits.

use std::f64::consts::TAU;

use jostle::problems::{EventTiming, ProblemSetting, Truth, kepler};

use super::support::{assert_near, load, momenta};

#[test]
fn a_hundred_orbits_keep_energy_and_angular_momentum() {
    let truth = Truth::read(include_str!("../../assets/truths/P07_kepler.json"));
    let steps = 8000_u32;
    let tick = TAU / f64::from(steps);
    let setting = ProblemSetting { method: "VelocityVerlet", tick, shift: 0.0, ..ProblemSetting::default() };
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

/// With 4000 steps an orbit the rate at the sun times the step is 0.05: order 8 leaves rounding, of which a share of energy makes
/// the planet late by `1.5 t` of itself: `3 pi n` steps' worth of half an ulp each at worst.
#[test]
fn dop853_knows_the_place_after_a_hundred_orbits() {
    let tick = TAU / 4000.0;
    let setting = ProblemSetting { method: "Dop853", tick, shift: 0.0, events: EventTiming::Located };
    let mut simulation = kepler::PROBLEM.load(&setting).expect("the scene is correct");
    for orbits in [1.3, 10.3, 100.3] {
        simulation.run_to_tick((4000.0_f64 * orbits).round() as u64).expect("numbers stay finite");
        let found = simulation.bodies().position[1];
        let error = found.distance(kepler::state(simulation.clock().time()).0);
        println!("after {orbits} orbits: {error:e}");
        assert!(error <= 1e-8, "after {orbits} orbits: {error:e}");
    }
}

/// The energy over ten thousand orbits: greatest swing, and what the regression line gains with its standard error.
struct LongRun {
    swing: f64,
    gain: f64,
    uncertainty: f64,
}

/// Averages over a hundred orbits, a hundred of them, with so many ticks an orbit.
fn long_run(method: &str, eccentricity: f64, steps: u64) -> LongRun {
    let setting = ProblemSetting { method, tick: TAU / steps as f64, shift: 0.0, ..ProblemSetting::default() };
    let mut simulation = load(&kepler::scene_of(&setting, TAU, eccentricity));
    let (mut lowest, mut highest, mut means) = (f64::INFINITY, f64::NEG_INFINITY, Vec::new());
    // Every ninth tick, so that all parts of the orbit are seen.
    let stride = 9;
    for block in 0..100_u64 {
        let (mut sum, mut count) = (0.0, 0.0);
        let end = (block + 1) * 100 * steps;
        while simulation.clock().ticks + stride <= end {
            simulation.run_to_tick(simulation.clock().ticks + stride).expect("numbers stay finite");
            let bodies = simulation.bodies();
            let energy = 0.5 * bodies.velocity[1].length_squared() - 1.0 / bodies.position[1].length();
            let error = energy / -0.5 - 1.0;
            (lowest, highest) = (lowest.min(error), highest.max(error));
            sum += error;
            count += 1.0;
        }
        means.push(sum / count);
    }
    let count = means.len() as f64;
    let middle = (count - 1.0) / 2.0;
    let mean = means.iter().sum::<f64>() / count;
    let along = means.iter().enumerate();
    let spread: f64 = along.clone().map(|(index, _)| (index as f64 - middle).powi(2)).sum();
    let slope = along.clone().map(|(index, value)| (index as f64 - middle) * (value - mean)).sum::<f64>() / spread;
    let scatter = along.map(|(index, value)| (value - mean - slope * (index as f64 - middle)).powi(2)).sum::<f64>();
    let uncertainty = (scatter / (count - 2.0) / spread).sqrt();
    LongRun { swing: highest - lowest, gain: slope * count, uncertainty: uncertainty * count }
}

impl LongRun {
    fn has_trend(&self) -> bool {
        self.gain.abs() > (4.0 * self.uncertainty).max(1e-3 * self.swing)
    }
}

fn assert_no_trend(method: &str, eccentricity: f64, steps: u64) {
    let run = long_run(method, eccentricity, steps);
    let LongRun { swing, gain, uncertainty } = run;
    let what = format!("{method}, e = {eccentricity}, swing {swing:.2e}, gain {gain:.2e} +- {uncertainty:.2e}");
    println!("{what}");
    assert!(!run.has_trend(), "{what}");
    // Kinetic over total energy at the passage, and the error of one step there, of order 1 at worst; both ways.
    let rate = f64::powf(1.0 - eccentricity, -1.5) * TAU / steps as f64;
    let order = if method == "SemiImplicitEuler" { 1 } else { 2 };
    let bound = 2.0 * (1.0 + eccentricity) / (1.0 - eccentricity) * rate.powi(order);
    assert!(swing < bound, "{what}: above {bound:e}");
}

/// The orbit of truth file P07 with the cheap methods, at ticks that resolve the passage: the rate there times the tick is
/// a third.
#[test]
fn energy_has_no_trend_in_ten_thousand_sharp_orbits() {
    for method in ["SemiImplicitEuler", "VelocityVerlet"] {
        assert_no_trend(method, 0.9, 600);
    }
}

/// A rounder orbit, where a hundred steps do.
#[test]
fn energy_has_no_trend_in_ten_thousand_round_orbits() {
    for method in ["SemiImplicitEuler", "VelocityVerlet", "Symplectic4", "ImplicitMidpoint"] {
        assert_no_trend(method, 0.6, 100);
    }
    let run = long_run("RungeKutta4", 0.6, 100);
    assert!(run.has_trend(), "a method that is not symplectic loses energy, and that is seen: {}", run.gain);
}
