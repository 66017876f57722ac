//! Law: if events are located, motion that ends in finite time ends there exactly. It has the closed form's number of
//! bounces and half swings, its position, and a velocity of exactly zero, and then no body moves. Source: closed forms
//! of `settling_bounce` (truth file C05) and `coulomb_oscillator` (F03).
//!
//! Tolerances: rounding for `Dop853` (its own error at these ticks lies below: `w dt` is 0.04 and 0.3, order 8, see
//! `convergence`), the problems' leading error for the others.
//!
//! Not tested: several contacts that come to rest together.

use jostle::SimulationExt;
use jostle::problems::{EventTiming, ProblemSetting, Truth, coulomb_oscillator, settling_bounce};

use super::support::{assert_near, assert_rest, load, run_to};

const METHODS: [&str; 4] = ["VelocityVerlet", "RungeKutta4", "Symplectic4", "Dop853"];

#[test]
fn a_bouncing_ball_ends_at_rest_after_the_exact_number_of_flights() {
    let truth = Truth::read(settling_bounce::TRUTH);
    let flights = truth.number("soft: number of flights after the first impact") as u32;
    let (_, overlap, end) = settling_bounce::history();
    for method in METHODS {
        let setting = ProblemSetting { method, tick: 1e-4, events: EventTiming::Located, ..ProblemSetting::default() };
        let text = (settling_bounce::PROBLEM.scene)(&setting, 4.0);
        let mut simulation = super::support::load(&text);
        let (mut found, mut in_air, mut rested) = (0, true, f64::INFINITY);
        while simulation.clock().time() < 3.5 {
            simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
            let bodies = simulation.bodies();
            let above = bodies.position[0].y > settling_bounce::RADIUS;
            found += u32::from(above && !in_air);
            in_air = above;
            let moves = bodies.velocity[0].y != 0.0;
            rested = if moves { f64::INFINITY } else { rested.min(simulation.clock().time()) };
        }
        assert_eq!(found, flights, "{method}");
        if method == "Dop853" {
            let place = settling_bounce::RADIUS - simulation.bodies().position[0].y;
            assert_near("overlap at rest", place, overlap, 1e-12);
            assert!(rested >= end && rested < end + 2e-4, "{method}: at rest from {rested} s, exact {end} s");
        }
        assert_rest(method, &mut simulation, 3.5, 4.0);
    }
}

#[test]
fn a_sled_on_a_spring_sticks_after_the_exact_number_of_half_swings() {
    let truth = Truth::read(coulomb_oscillator::TRUTH);
    let (half_swings, place) = (truth.number("half swings") as u32, truth.number("rest position"));
    for method in METHODS {
        let tick = 4e-3;
        let setting = ProblemSetting { method, tick, ..ProblemSetting::default() };
        let text = (coulomb_oscillator::PROBLEM.scene)(&setting, 4.0);
        let mut simulation = super::support::load(&text);
        let (mut found, mut before) = (0, 0.0);
        while simulation.clock().time() < 3.0 {
            simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
            let velocity = simulation.bodies().velocity[0].x;
            found += u32::from(velocity != 0.0 && velocity * before <= 0.0);
            before = velocity;
        }
        assert_eq!(found, half_swings, "{method}");
        let error = simulation.bodies().position[0].x - place;
        let order = if method == "Dop853" { 0.0 } else { coulomb_oscillator::leading_error(2, tick) };
        assert_near(method, error / coulomb_oscillator::BEGIN, 0.0, order + 1e-12);
        assert_rest(method, &mut simulation, 3.0, 4.0);
        let card = simulation.card();
        assert_eq!(card.events_located, u64::from(half_swings), "{method}: one event for each turn");
        // What friction took is force times way.
        let lost = truth.number("energy lost to friction");
        assert_near("lost to friction", card.energy.friction, lost, lost * (order + 1e-9));
    }
}

/// The numbers of the closed forms are those of the truth file.
#[test]
fn the_closed_form_of_the_sled_is_that_of_the_truth_file() {
    let truth = Truth::read(coulomb_oscillator::TRUTH);
    for (time, place) in truth.times("x(t)").into_iter().zip(truth.numbers("x(t)")) {
        assert_near("place", coulomb_oscillator::state(time).0, place, 1e-14);
    }
}

/// A block at rest on a rough floor that a thrust begins to push, within its cone (5 N) or beyond: it stands, or goes
/// `x = a t^2/2` from the moment on at which the thrust begins, be that the start of the run. All is constant in between, so
/// methods of order 2 and more err by rounding only, of sums of a hundred ticks.
#[test]
fn a_thrust_moves_a_block_from_the_moment_on_at_which_it_is_beyond_its_cone() {
    for method in ["VelocityVerlet", "RungeKutta4", "Dop853", "Symplectic4", "ImplicitMidpoint", "SemiImplicitEuler"] {
        for from in [0.0, 0.5, 0.5033] {
            for push in [4.0, 6.0] {
                let mut simulation = load(&format!(
                    "Scene(format: 1, clock: (duration: 1, tick: 0.01, method: {method}, events: Located),
                        gravity: (0, -10), contacts: Penalty(tangential: Exact),
                        materials: {{\"m\": (stiffness: 1e6, friction: 0.5, restitution: 0)}},
                        walls: [(name: \"floor\", left: (50, 0), right: (-50, 0), material: \"m\")],
                        bodies: [(name: \"b\", at: (0, 0.099995), material: \"m\", atoms: List([
                            (at: (-0.5, 0), radius: 0.1, mass: 0.5), (at: (0.5, 0), radius: 0.1, mass: 0.5),
                        ]))],
                        forces: [Thrust(of: \"b\", force: ({push}, 0), from: {from})])"
                ));
                run_to(&mut simulation, 1.0);
                let acceleration = (push - 5.0_f64).max(0.0);
                let (time, x) = (1.0 - from, simulation.bodies().position[0].x);
                let exact = 0.5 * acceleration * time * time;
                // The order of semi-implicit Euler is 1: it is ahead by `a dt t/2`.
                let order_1 = if method == "SemiImplicitEuler" { 0.5 * acceleration * 0.01 * time } else { 0.0 };
                let allowed = 1.01 * order_1 + 100.0 * f64::EPSILON;
                assert!((x - exact).abs() <= allowed, "{method}, {push} N from {from} s: {x:e} instead of {exact:e}");
            }
        }
    }
}
