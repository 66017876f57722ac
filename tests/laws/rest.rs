//! Law: a contact at rest holds with any force that its law allows there, `[1 - mu, 1 + mu] k d`. So a body comes to
//! rest in finite time with an overlap between `m g/(k (1 + mu))` and `m g/(k (1 - mu))`. From then on no body moves at
//! all. Source: statics; truth file C05.
//!
//! Tolerances: "at rest" is a velocity of exactly zero and a state that does not change by a bit. Heights of rebounds: a share `2 x 2 mu s^2/e^2`,
//! `s = w dt`, at each impact for restitution (see `restitution`; heights go with the square of the speed).
//!
//! Not tested: rest on slopes (see `slope`); columns and piles (see `hard`).

use std::f64::consts::PI;

use jostle::problems::hard::column;
use jostle::problems::{ProblemSetting, Truth, settling_bounce};
use jostle::scene::Source;
use jostle::simulation::{Overrides, Simulation};

use super::support::{METHODS, assert_near, assert_rest, fitted_order, load, phases, run_to, table};

/// The greatest heights of the flights after each impact, one after the other, in m.
fn rebounds(simulation: &mut Simulation, until: f64) -> Vec<f64> {
    let mut heights = Vec::new();
    let mut before = (0.0, f64::NEG_INFINITY);
    while simulation.clock().time() < until {
        simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
        let (position, velocity) = (simulation.bodies().position[0].y, simulation.bodies().velocity[0].y);
        let gap = position - settling_bounce::RADIUS;
        if before.0 > 0.0 && velocity <= 0.0 && gap > 0.0 {
            // The top lies between two ticks.
            heights.push(gap + velocity * velocity / (2.0 * settling_bounce::GRAVITY));
        }
        before = (velocity, gap);
    }
    heights
}

#[test]
fn a_ball_bounces_to_rest_as_the_closed_form_says() {
    let truth = Truth::read(settling_bounce::TRUTH);
    let exact = truth.numbers("soft: rebound heights 1..6");
    let (mu, omega) = (settling_bounce::INELASTICITY, settling_bounce::STIFFNESS.sqrt());
    let squared = (1.0 - mu) / (1.0 + mu);
    for method in METHODS {
        let mut points = Vec::new();
        for tick in [2e-4, 1e-4, 5e-5, 2.5e-5] {
            let mut worst = 0.0_f64;
            for phase in phases(8) {
                let setting = ProblemSetting { method, tick, shift: phase * tick, ..ProblemSetting::default() };
                let mut simulation = settling_bounce::PROBLEM.load(&setting).expect("the scene is correct");
                let found = rebounds(&mut simulation, 2.56);
                for (number, (found, exact)) in found.iter().zip(&exact).enumerate() {
                    let share = (number + 1) as f64 * (4.0 * mu / squared + 1.0) * (omega * tick).powi(2);
                    // Semi-implicit Euler falls from up to half a tick's way higher.
                    let higher = if method == METHODS[0] { 9.81 * tick * (2.0 * 9.81_f64).sqrt() / 9.81 } else { 0.0 };
                    assert_near(&format!("rebound {number}"), found / exact, 1.0, share + higher);
                    worst = worst.max((found / exact - 1.0).abs());
                }
                assert!(found.len() >= exact.len(), "{} rebounds", found.len());
            }
            points.push((tick, worst));
        }
        let order = fitted_order(&points);
        println!("{method}: heights, order {order:.2};{}", table(&points));
        assert!(order >= 0.75, "{method}: order {order};{}", table(&points));
    }
}

/// The overlap at rest depends on where in a tick the last turn falls, but not by more than the band; the time to rest
/// by no more than the last flight and the last contacts.
#[test]
fn the_ball_rests_inside_the_band_and_never_moves_again() {
    let truth = Truth::read(settling_bounce::TRUTH);
    let band = truth.numbers("soft: band of admissible rest overlaps [mg/(k(1+mu)), mg/(k(1-mu))]");
    let at_rest = truth.number("soft: time at rest");
    let (_, overlap, end) = settling_bounce::history();
    assert_near("closed form: rest overlap", overlap, truth.number("soft: rest overlap"), 1e-15);
    assert_near("closed form: time at rest", end, at_rest, 1e-12);
    for method in METHODS {
        for tick in [2e-4, 5e-5] {
            for phase in phases(8) {
                let setting = ProblemSetting { method, tick, shift: phase * tick, ..ProblemSetting::default() };
                let text = (settling_bounce::PROBLEM.scene)(&setting, 10.0);
                let mut simulation = load(&text);
                let mut rested = f64::INFINITY;
                while simulation.clock().time() < 4.0 {
                    simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
                    if simulation.bodies().velocity[0].y == 0.0 {
                        rested = rested.min(simulation.clock().time());
                    } else {
                        rested = f64::INFINITY;
                    }
                }
                let found = settling_bounce::RADIUS - simulation.bodies().position[0].y;
                assert!(band[0] <= found && found <= band[1], "{method} {tick}: {found:e} outside {band:?}");
                // Twelve flights, each changed by a share of up to 2 mu s^2/e^2 of at most 0.7 s, and the last one of them,
                // of some 20 ms, may be there or not.
                let step = settling_bounce::STIFFNESS.sqrt() * tick;
                let share = 2.0 * 0.3 * step * step * 1.3 / 0.7;
                assert_near("time at rest", rested, at_rest, at_rest * 12.0 * share + 0.03);
                assert_rest("ball", &mut simulation, 4.0, 5.0);
            }
        }
    }
}

/// Five elastic discs of pi/4 kg, which settle by drag, on a floor as soft as a pair: the lowest has half the stiffness of the others
/// there. The lowest mode dies out with `exp(-c t/2 m)`.
#[test]
fn an_elastic_column_on_a_soft_floor_sinks_in_by_weight_over_stiffness() {
    let mass = PI / 4.0;
    let mut discs = vec![(0.5, mass, 2e5); 5];
    discs[0].2 = 1e5;
    let mut simulation = load(&column::scene(&discs, column::ELASTIC, 2e-4));
    run_to(&mut simulation, 60.0);
    let overlap = 0.5 - simulation.bodies().position[0].y;
    assert_near("bottom overlap", overlap, 5.0 * mass * 9.81 / 1e5, 1e-12);
    assert_near("bottom overlap of the catalogue", overlap, 3.852_378_0e-4, 1e-10);
}

#[test]
fn tetris_comes_to_rest() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/tetris.ron")).expect("it is there");
    for tick in [1e-3, 0.25e-3] {
        let overrides = Overrides { tick: Some(tick), duration: Some(120.0), ..Default::default() };
        let source = Source::new("tetris.ron", text.clone());
        let mut simulation = Simulation::load_with(&source, &overrides, |_| {}).expect("a correct scene");
        assert_rest(&format!("tetris at {tick} s"), &mut simulation, 60.0, 60.0);
    }
}
