//! Law: under constant acceleration each integrator has an exact discrete solution, which identifies it. After `n`
//! ticks of `dt` from rest semi-implicit Euler is at `a dt^2 n (n + 1)/2`, and velocity Verlet at `a (n dt)^2/2`.
//! Source: truth file P02 (ticks of a second); the formulas for other ticks.
//!
//! Tolerance: 4 units in the last place: each of tick, acceleration and product is rounded once, the same way at every
//! tick, and positions are summed with compensation.
//!
//! Not tested: forces that change.

use jostle::problems::{ProblemSetting, Truth, constant_acceleration};

use super::support::METHODS;

const TRUTH: &str = include_str!("../../assets/truths/P02_euler_table.json");

fn positions(method: &str, tick: f64, ticks: u64) -> Vec<f64> {
    let setting = ProblemSetting { method, tick, shift: 0.0, ..ProblemSetting::default() };
    let mut simulation = constant_acceleration::PROBLEM.load(&setting).expect("the scene is correct");
    let mut positions = vec![simulation.bodies().position[0].x];
    for done in 1..=ticks {
        simulation.run_to_tick(done).expect("numbers stay finite");
        positions.push(simulation.bodies().position[0].x);
    }
    positions
}

#[track_caller]
fn assert_within_4_ulp(what: &str, found: &[f64], exact: &[f64]) {
    assert_eq!(found.len(), exact.len());
    for (tick, (found, exact)) in found.iter().zip(exact).enumerate() {
        let ulp = exact.abs().max(f64::MIN_POSITIVE).next_up() - exact.abs().max(f64::MIN_POSITIVE);
        assert!((found - exact).abs() <= 4.0 * ulp, "{what}, tick {tick}: {found:?} instead of {exact:?}");
    }
}

#[test]
fn the_table_in_ticks_of_a_second_tells_the_methods_apart() {
    let truth = Truth::read(TRUTH);
    for (method, column) in METHODS.into_iter().zip(["x semi_implicit_euler", "x verlet_midpoint_rk4"]) {
        assert_within_4_ulp(method, &positions(method, 1.0, 10), &truth.numbers(column));
    }
}

#[test]
fn so_do_the_tables_in_shorter_ticks() {
    let half = constant_acceleration::ACCELERATION / 2.0;
    for (tick, ticks) in [(0.5, 20), (0.1, 100)] {
        let square = tick * tick;
        let euler = (0..=ticks).map(|n| half * square * (n * (n + 1)) as f64);
        let verlet = (0..=ticks).map(|n| half * square * (n * n) as f64);
        let columns: [Vec<f64>; 2] = [euler.collect(), verlet.collect()];
        for (method, exact) in METHODS.into_iter().zip(&columns) {
            assert_within_4_ulp(&format!("{method} at {tick} s"), &positions(method, tick, ticks), exact);
        }
    }
}
