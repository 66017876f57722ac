//! Law: by friction a belt accelerates a body with `mu g` until it has the belt's velocity `V`, and then carries it
//! with exactly `V`. A disc that is free to turn ends at `V/3`. A body held by a spring sticks and slips. Source:
//! Coulomb 1785; sticking and slipping on a belt: den Hartog, *Mechanical Vibrations*, 1956, 7.
//!
//! Tolerances: the tangential spring is part of the exact answer where it matters: it is drawn out with
//! `e'' = -(k_t/m) e`, from `e' = V`, until `k_t e = mu N`. What is left is the end of slipping inside a tick: order one.
//!
//! Not tested: belts on slopes.

use std::f64::consts::PI;

use bevy_ecs::prelude::*;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::TickAppExt;
use jostle::world::{Force, Position};
use jostle::{Simulation, SimulationExt};

use super::support::{METHODS, assert_near, fitted_order, load, phases, run, table};

const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 0.1;

/// A disc of 1 kg that stands on a belt as deep as its weight presses it.
fn scene(method: &str, tick: f64, duration: f64, belt: f64, stiffness: f64, friction: &str, body: &str) -> String {
    let height = RADIUS - GRAVITY / stiffness;
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}, tick: {tick:?}, method: {method}), gravity: (0, -{GRAVITY:?}),
        materials: {{ \"rubber\": (stiffness: {stiffness:?}, friction: {friction}, inelasticity: 0.3) }},
        walls: [(name: \"belt\", left: (1, 0), right: (0, 0), material: \"rubber\", surface_velocity: ({belt:?}, 0))],
        bodies: [(name: \"disc\", at: (0, {height:?}), material: \"rubber\", {body} atoms: Disc(radius: {RADIUS:?}, mass: 1))])"
    )
}

/// So heavy to turn that it slides on.
const NEVER_ROLLS: &str = "inertia: 1e9,";

/// Where the body is after `duration`, when it has the velocity of the belt, and what the spring holds then.
fn carried(belt: f64, friction: f64, stiffness: f64, duration: f64) -> (f64, f64, f64) {
    let across: f64 = 0.8 * stiffness;
    let (omega, stretch) = (across.sqrt(), friction * GRAVITY / across);
    let slips = (stretch * omega / belt).asin() / omega;
    let (speed, place) = (belt * (1.0 - (omega * slips).cos()), belt * slips - stretch);
    let sliding = (belt - speed) / (friction * GRAVITY);
    let place = place + speed * sliding + 0.5 * friction * GRAVITY * sliding * sliding;
    let sticks = slips + sliding;
    (place + belt * (duration - sticks), sticks, 0.5 * across * stretch * stretch)
}

#[test]
fn a_body_is_taken_along_until_it_has_the_velocity_of_the_belt() {
    let (friction, stiffness, duration) = (0.3, 1e5, 1.0);
    for method in METHODS {
        for way in [1.0, -1.0] {
            let points: Vec<(f64, f64)> = (0..5)
                .map(|halving| {
                    let tick = 1e-3 / f64::from(1 << halving);
                    let error = |phase: f64| {
                        let belt = 1.5 + 0.02 * phase;
                        let text =
                            scene(method, tick, duration, way * belt, stiffness, &format!("{friction}"), NEVER_ROLLS);
                        let simulation = run(&text);
                        let (exact, _, held) = carried(belt, friction, stiffness, duration);
                        let (bodies, card) = (simulation.bodies(), simulation.card());
                        // It turns a little, whatever its inertia: what has the belt's velocity is its surface.
                        let arm = RADIUS - GRAVITY / stiffness;
                        let surface = bodies.velocity[0].x + bodies.spin[0] * arm;
                        assert_near("velocity", surface, way * belt, 4.0 * f64::EPSILON * belt);
                        // The belt worked mu m g V while it slipped: half of it is heat, half motion.
                        let energy = card.energy;
                        let lost = 0.5 * belt * belt;
                        let of_energy = (energy.work - 2.0 * lost).abs().max((energy.friction - lost).abs());
                        assert!(
                            of_energy <= 2.0 * held + friction * GRAVITY * belt * tick,
                            "{method} {tick}: {energy:?}"
                        );
                        (bodies.position[0].x * way - exact).abs()
                    };
                    (tick, phases(20).map(error).fold(0.0, f64::max))
                })
                .collect();
            let order = fitted_order(&points);
            // In the last tick of slipping friction is too strong by at most all of it: a way of mu g dt^2, and V dt of
            // the spring that is let go.
            let allowed = |tick: f64| friction * GRAVITY * tick * tick + 1.5 * tick;
            assert!(order > 0.75, "{method}: order {order}: {}", table(&points));
            assert!(points.iter().all(|&(tick, error)| error <= allowed(tick)), "{method}: {}", table(&points));
            println!("{method}: order {order}: {}", table(&points));
        }
    }
}

/// It slips for `V/(mu g)`: just before it is slower, just after it moves as the belt does.
#[test]
fn it_slips_for_v_over_mu_g() {
    let (friction, stiffness, belt, tick) = (0.3, 1e5, 2.0, 1e-4);
    let (_, sticks, _) = carried(belt, friction, stiffness, 1.0);
    assert_near("the spring matters little", sticks, belt / (friction * GRAVITY), 1e-3 * sticks);
    let mut simulation = load(&scene("VelocityVerlet", tick, 1.0, belt, stiffness, "0.3", NEVER_ROLLS));
    let ticks = (sticks / tick) as u64;
    simulation.run_to_tick(ticks - 2).expect("numbers stay finite");
    assert!(simulation.bodies().velocity[0].x < belt);
    simulation.run_to_tick(ticks + 3).expect("numbers stay finite");
    let (bodies, arm) = (simulation.bodies(), RADIUS - GRAVITY / stiffness);
    assert_near("velocity", bodies.velocity[0].x + bodies.spin[0] * arm, belt, 4.0 * f64::EPSILON * belt);
}

/// Friction gives `J` to the motion and `J r` to the turn (`I = m r^2/2`); slipping ends at `J/m + 2 J/m = V`.
#[test]
fn a_disc_that_is_free_to_turn_ends_at_a_third() {
    let (friction, stiffness, belt, tick) = (0.3, 1e5, 3.0, 1e-4);
    for method in METHODS {
        let bodies = run(&scene(method, tick, 1.0, belt, stiffness, "0.3", ""));
        let bodies = bodies.bodies();
        // The arm of friction is the radius less the overlap.
        let arm = RADIUS - GRAVITY / stiffness;
        let gained = arm * arm / (RADIUS * RADIUS / 2.0);
        let exact = belt / (1.0 + gained);
        // Until the spring is drawn out, and in one tick, some of mu g is missing, but not from the sum of both: where
        // slipping ends does not depend on when. What is left is the contact's overlap, which breathes with the band.
        let tolerance = exact * 2.0 * GRAVITY / stiffness / RADIUS + friction * GRAVITY * tick;
        assert_near("speed", bodies.velocity[0].x, exact, tolerance);
        assert_near("no slip", bodies.velocity[0].x + bodies.spin[0] * arm, belt, 1e-9 * belt);
    }
}

/// Seen from the belt nothing happens: a body that begins with its velocity keeps it, and no work is done.
#[test]
fn a_body_that_moves_as_the_belt_does_rests_on_it() {
    for method in METHODS {
        let simulation = run(&scene(method, 1e-3, 20.0, 0.7, 1e4, "0.5", "velocity: (0.7, 0),"));
        let (bodies, energy) = (simulation.bodies(), simulation.card().energy);
        assert_eq!((bodies.velocity[0].x, bodies.velocity[0].y, bodies.spin[0]), (0.7, 0.0, 0.0));
        assert_near("way", bodies.position[0].x, 14.0, 4.0 * f64::EPSILON * 14.0);
        // Forces over a tick carry the rounding of velocities, 1e-16 m/s over 1e-3 s.
        assert!(energy.work.abs() < 1e-11 && energy.friction.abs() < 1e-11, "{energy:?}");
    }
}

const SPRING: f64 = 50.0;

fn pull_home(mut bodies: Query<(&Position, &mut Force)>) {
    for (position, mut force) in &mut bodies {
        force.0.x -= SPRING * position.0.x;
    }
}

/// A body on a spring (`k = 50 N/m`, 1 kg) on a belt of 0.2 m/s, `mu_s = 0.5`, `mu_k = 0.3`: it is carried to
/// `x_s = mu_s m g/k`, slips as an oscillator about `x_k = mu_k m g/k`, and is caught when it has the belt's velocity
/// again: a period of `2 (pi - phi)/w + 2 (x_s - x_k)/V` with `tan phi = (x_s - x_k) w/V`.
#[test]
fn a_body_on_a_spring_sticks_and_slips() {
    let (belt, stiffness, tick) = (0.2_f64, 1e7_f64, 5e-5);
    let (to_slip, about) = (0.5 * GRAVITY / SPRING, 0.3 * GRAVITY / SPRING);
    let omega = SPRING.sqrt();
    let away = to_slip - about;
    let period = 2.0 * (PI - (away * omega / belt).atan()) / omega + 2.0 * away / belt;
    let least = about - (away * away + (belt / omega).powi(2)).sqrt();
    let text = scene("VelocityVerlet", tick, 8.0, belt, stiffness, "(static: 0.5, dynamic: 0.3)", NEVER_ROLLS);
    let plugin = |app: &mut bevy_app::App| {
        app.add_force(pull_home);
    };
    let mut simulation =
        Simulation::load_with(&Source::new("belt.ron", text), &Overrides::default(), plugin).expect("a correct scene");
    let (mut releases, mut lowest, mut highest, mut stuck) = (Vec::new(), f64::INFINITY, 0.0_f64, false);
    while simulation.clock().ticks < simulation.ticks() {
        simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
        let (place, speed) = (simulation.bodies().position[0].x, simulation.bodies().velocity[0].x);
        // The spring grows by k V dt in a tick, which is half a tick too late; in slip the speed changes by 1e-4 m/s.
        let sticks = (speed - belt).abs() < 1e-6;
        if stuck && !sticks {
            releases.push(simulation.clock().time());
        }
        stuck = sticks;
        highest = highest.max(place);
        lowest = if releases.is_empty() { lowest } else { lowest.min(place) };
    }
    println!("{releases:?} {period} {lowest} {least} {highest} {to_slip}");
    // When the grip changes the tangential spring goes from one coefficient to the other: within a quarter of its own
    // period, twice in a round, and at the end of a tick. Places differ by what the belt moves in that time.
    let slack = PI / (0.8 * stiffness).sqrt() + 2.0 * tick;
    assert!(releases.len() >= 3, "it should slip again and again: {releases:?}");
    for pair in releases[1..].windows(2) {
        assert_near("period", pair[1] - pair[0], period, slack);
    }
    // Once it slips it overshoots by V/w at most.
    let highest_exact = about + (away * away + (belt / omega).powi(2)).sqrt();
    assert_near("lowest place", lowest, least, belt * slack);
    assert_near("highest place", highest, highest_exact, belt * slack);
}
