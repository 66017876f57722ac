//! Law: a sliding body is decelerated by `mu g` (Coulomb) at every speed. A sliding disc begins to roll and then keeps
//! two thirds of its speed. A contact that slips obeys the dynamic coefficient. Source: Coulomb 1785; any textbook (a
//! disc has `I = m r^2/2`).
//!
//! Tolerances: the tangential spring must be drawn out by `s = mu m g/k_t` before friction is full, for a time `s/v` and
//! one tick: that much of `mu g` is missing. After it has begun to roll a disc swings on that spring, undamped, with a
//! speed of up to `mu g sqrt(m/3 k_t)`. The arm of friction is the radius less the overlap.
//!
//! Not tested: bodies at rest on slopes, collisions with friction.

use bevy_ecs::prelude::*;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{SimTick, Stage};
use jostle::world::Position;
use jostle::{Simulation, SimulationExt};

use super::support::{METHODS, assert_near, run};

const GRAVITY: f64 = 9.81;
const STIFFNESS: f64 = 1e4;
const TANGENTIAL: f64 = 0.8 * STIFFNESS;
const SPEED: f64 = 3.0;
const TICK: f64 = 1e-4;
const RADIUS: f64 = 0.1;
const OVERLAP: f64 = GRAVITY / STIFFNESS;

/// A disc of 1 kg that stands on the floor as deep as its weight presses it, and slides.
fn sliding(method: &str, duration: f64, friction: &str, inertia: &str) -> String {
    let height = RADIUS - OVERLAP;
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}, tick: {TICK:?}, method: {method}), gravity: (0, -{GRAVITY:?}),
        materials: {{ \"rubber\": (stiffness: {STIFFNESS:?}, friction: {friction}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"rubber\")],
        bodies: [(name: \"disc\", at: (0, {height:?}), velocity: ({SPEED:?}, 0), material: \"rubber\", {inertia}
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])"
    )
}

/// So heavy to turn that it slides on.
const NEVER_ROLLS: &str = "inertia: 1e9,";

/// What is missing of the loss of speed while the spring is drawn out, at the least speed.
fn missing(friction: f64, least_speed: f64) -> f64 {
    let stretch = friction * GRAVITY / TANGENTIAL;
    friction * GRAVITY * (stretch / least_speed + TICK)
}

#[test]
fn sliding_friction_slows_by_mu_g() {
    for method in METHODS {
        for friction in [0.1, 0.3] {
            for way in [1.0, -1.0] {
                let text = sliding(method, 0.5, &format!("{friction:?}"), NEVER_ROLLS);
                let simulation = run(&text.replace("velocity: (3.0", &format!("velocity: ({:?}", way * SPEED)));
                let left = SPEED - friction * GRAVITY * 0.5;
                let found = simulation.bodies().velocity[0].x * way;
                assert_near("speed", found, left, missing(friction, SPEED));
                // What kinetic energy lost the ledger has, but for what the spring holds.
                let lost = 0.5 * (SPEED * SPEED - found * found);
                let held = (friction * GRAVITY).powi(2) / TANGENTIAL / 2.0;
                let energy = simulation.card().energy;
                // The spring follows displacements to second order in the tick; order 1 misses a tick of friction.
                let tolerance = held + friction * GRAVITY * SPEED * TICK;
                assert_near("friction", energy.friction, lost, tolerance);
            }
        }
    }
}

#[test]
fn a_sliding_disc_rolls_off_with_two_thirds_of_its_speed() {
    let friction = 0.3;
    let arm = RADIUS - OVERLAP;
    let gained = arm * arm / (RADIUS * RADIUS / 2.0);
    let rolling = SPEED * gained / (1.0 + gained);
    for method in METHODS {
        // Rolling begins after v0/(3 mu g) = 0.34 s.
        let simulation = run(&sliding(method, 0.6, "0.3", ""));
        let bodies = simulation.bodies();
        let swing = friction * GRAVITY / (3.0 * TANGENTIAL).sqrt();
        assert_near("speed", bodies.velocity[0].x, rolling, swing + missing(friction, rolling));
        // It rolls to the right, so it turns clockwise; the swing turns it twice as fast as it moves it.
        assert_near("speed of the rim", -bodies.spin[0] * arm, rolling, 2.0 * swing + missing(friction, rolling));
    }
}

fn look(_: Query<&Position>) {}

/// Once it slips it slips by the dynamic coefficient, also when forces are evaluated twice for the same state, as the
/// presence of an ordinary system makes the engine do.
#[test]
fn a_contact_that_slips_obeys_the_dynamic_coefficient() {
    for method in METHODS {
        for looked_at in [false, true] {
            let text = sliding(method, 0.25, "(static: 0.6, dynamic: 0.2)", NEVER_ROLLS);
            let plugins = move |app: &mut bevy_app::App| {
                if looked_at {
                    app.add_systems(SimTick, look.in_set(Stage::Begin));
                }
            };
            let source = Source::new("slip.ron", text);
            let mut simulation =
                Simulation::load_with(&source, &Overrides::default(), plugins).expect("a correct scene");
            simulation.run_to_end().expect("numbers stay finite");
            let found = simulation.bodies().velocity[0].x;
            // Until it slips it is held by more than in slip: three times at most, for three times as long.
            let tolerance = missing(0.6, SPEED) * 3.0;
            let what = format!("{method}, looked at: {looked_at}: speed");
            assert_near(&what, found, SPEED - 0.2 * GRAVITY * 0.25, tolerance);
        }
    }
}
