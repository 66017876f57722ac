//! Law: friction that has rested is rigid, and no spring takes up a part of a slide. So a box that slides by `s` from rest loses
//! `mu m g s`, however short its way is beside `mu N / k_t`.
//!
//! A push `F > mu_s m g` on the centre of mass for a time `t` makes the way `v^2/2 (1/a + 1/b)`, with `v = a t`, `a = F/m - mu_d g` and
//! `b = mu_d g`.

use super::ran::end;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

const G: f64 = 9.81;
const MASS: f64 = 3.0;
const WIDTH: f64 = 0.4;
const HEIGHT: f64 = 0.2;
const STATIC: f64 = 0.5;
const DYNAMIC: f64 = 0.4;
/// In N/m, along the surface. The tangential springs are as stiff as the normal ones.
const STIFFNESS: f64 = 3e4;
/// The greatest error of an energy in J. Energies are some 1e-3 J, of which the first tolerance allows ten times as much.
const ERROR: f64 = 1e-8;

/// A box on the floor that is pushed with `push` newtons from 0.01 s until `to` seconds.
fn scene(clock: &str, push: f64, to: f64) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 0.1, {clock}), gravity: (0, -{G}), contacts: Penalty(tangential: Spring(ratio: 1)),
            film: (fps: 500),
            materials: {{ \"m\": (stiffness: {STIFFNESS:?}, friction: (static: {STATIC}, dynamic: {DYNAMIC}), restitution: 0.1) }},
            walls: [(name: \"floor\", left: (1, 0), right: (-1, 0), material: \"m\")],
            bodies: [(name: \"box\", at: (0, {:?}), mass: {MASS:?}, material: \"m\",
                      shape: Rectangle(width: {WIDTH}, height: {HEIGHT}))],
            forces: [Thrust(of: \"box\", force: ({push:?}, 0), from: 0.01, to: {to:?})])",
        0.5 * HEIGHT,
    )
}

#[test]
fn slides_of_any_length_lose_friction_times_their_way() {
    let drawn = DYNAMIC * 0.5 * MASS * G / STIFFNESS;
    for share in [0.2, 0.9, 1.1, 4.0] {
        // Of the way that would draw the spring of a corner.
        let way = share * drawn;
        let (push, b) = (1.2 * STATIC * MASS * G, DYNAMIC * G);
        let a = push / MASS - b;
        let lasts = (2.0 * way / (a * a * (1.0 / a + 1.0 / b))).sqrt();
        for clock in [
            "tolerance: 1e-4",
            "tolerance: 1e-7",
            "method: Reference",
            "method: Dop853, tick: 1e-3",
            "method: RungeKutta4, tick: 1e-4",
        ] {
            let scene = scene(clock, push, 0.01 + lasts);
            let ran = end(&scene).expect("a run to its end");
            let place = ran.seen[0].1[0].place.x;
            assert!((place - way).abs() < 1e-4 * way, "{share} {clock}: {place:e} for {way:e}");
            let lost = DYNAMIC * MASS * G * way;
            let friction = ran.card.energy.friction;
            assert!((friction - lost).abs() < ERROR, "{share} {clock}: {friction:e} lost for {lost:e}");
        }
    }
}

/// Steps of a slide are longer than ticks, and the account closes at each tick.
#[test]
fn energy_closes_at_each_look_into_a_slide() {
    let source = Source::new("slide.ron", scene("tolerance: 1e-4", 1.2 * STATIC * MASS * G, 0.05));
    let mut simulation = Simulation::load_with(&source, &Overrides::default(), |_| {}).expect("a correct scene");
    let mut most = 0.0_f64;
    for tick in 1..=simulation.ticks() {
        simulation.run_to_tick(tick).expect("numbers stay finite");
        most = most.max(simulation.card().energy.residual.abs());
    }
    let steps = simulation.state().steps().accepted;
    assert!(steps < simulation.ticks(), "{steps} steps");
    // Some thousand sums of 3 J round.
    assert!(most < 1e-12, "{most:e} J are missing");
}

/// The place of the one body of a scene at its end.
fn place(source: &Source, overrides: &Overrides) -> f64 {
    let mut simulation = Simulation::load_with(source, overrides, |_| {}).expect("a correct scene");
    simulation.run_to_end().expect("numbers stay finite");
    simulation.bodies().position[0].x
}

/// Asserts that runs with located events end where velocity Verlet leads with any fine tick, and returns that place. A tick may be off by
/// the velocity that `acceleration`, in m/s2, gives within it. Over `time` seconds that makes the error.
fn ends_in_one_place(source: &Source, acceleration: f64, time: f64) -> f64 {
    let located = [1e-4, 1e-5, 1e-7]
        .map(|tolerance| place(source, &Overrides { tolerance: Some(tolerance), ..Overrides::default() }));
    for tick in [1.6e-5, 4e-6, 2e-6] {
        let method = Some("VelocityVerlet".to_owned());
        let by_ticks = place(source, &Overrides { method, tick: Some(tick), ..Overrides::default() });
        let error = acceleration * tick * time;
        let near = located.iter().all(|located| (located - by_ticks).abs() < error);
        assert!(near, "{located:?}, but {by_ticks} with a tick of {tick:e} s, which may err by {error:e}");
    }
    located[2]
}

/// Law: a contact that comes loose goes on with the spring that its slide has drawn, which holds less than `mu N`. A slide that turns
/// round has turned it to the other side. A swinging push and torque rock a box while it slides there and back.
#[test]
fn a_box_that_rocks_while_it_slides_goes_where_its_springs_lead() {
    let scene = "Scene(format: 1, clock: (duration: 1), gravity: (0, -9.81),
        materials: { \"m\": (stiffness: 79504, friction: 0.31, restitution: 0.43) },
        walls: [(name: \"floor\", left: (20, 0), right: (-20, 0), material: \"m\")],
        bodies: [(name: \"box\", at: (0, 0.17119), mass: 1.444, material: \"m\", shape: Rectangle(width: 0.3383, height: 0.3424))],
        forces: [Drive(of: \"box\", force: (11.83, 1.29), at: (0, -0.11), course: Sine(frequency: 1.15, phase: 0.76)),
                 Drive(of: \"box\", torque: 0.73, course: Sine(frequency: 2.07))])";
    ends_in_one_place(&Source::new("rocks.ron", scene), 12.0 / 1.444, 1.0);
}

/// Law: a box thrown with `v` against a push `F > mu m g` stops after `v^2/(2 (F/m + mu g))`, and comes back with the acceleration
/// `F/m - mu g`. The turn lets go of the front edge, whose springs add less than a swing, `mu N / sqrt(k_t m)`, to its velocity.
#[test]
fn a_box_thrown_against_a_push_turns_round_as_with_rigid_friction() {
    const FRICTION: f64 = 0.5;
    const LASTS: f64 = 0.5;
    for (push, velocity) in [(5.5, 0.5), (6.5, 0.7), (8.0, 0.4)] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: {LASTS}), gravity: (0, -{G}),
                materials: {{ \"m\": (stiffness: 1e5, friction: {FRICTION}, restitution: 0.2) }},
                walls: [(name: \"floor\", left: (1, 0), right: (-1, 0), material: \"m\")],
                bodies: [(name: \"box\", at: (0, 0.1), mass: 1, velocity: ({velocity}, 0), material: \"m\",
                          shape: Rectangle(width: 0.3, height: 0.2, rounding: 0.01))],
                forces: [Thrust(of: \"box\", force: (-{push:?}, 0))])"
        );
        let (there, back) = (push + FRICTION * G, push - FRICTION * G);
        let place = ends_in_one_place(&Source::new("thrown.ron", scene), there, LASTS);
        let turns = velocity / there;
        let rigid = 0.5 * velocity * turns - 0.5 * back * (LASTS - turns).powi(2);
        let swing = FRICTION * G / (0.8 * 1e5_f64).sqrt();
        assert!((place - rigid).abs() < 0.5 * swing * (LASTS - turns), "{push} N: {place} for {rigid}");
    }
}
