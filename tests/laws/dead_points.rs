//! Laws of parallelograms that momentum carries through their dead points, where all bars are in line.
//!
//! There joints alone leave two ways on, but the coupler of a parallelogram that does not turn goes on without turning. Reference value:
//! all of it swings as one pendulum, `(2 J + M l^2) a'' = -(2 m l/2 + M l) g cos a` with cranks of length `l` and inertia `J` about their
//! pins, integrated here by the classical Runge-Kutta method in steps of 1e-5 s, whose error is below 1e-9. Tolerance: the order of the
//! method times the square of the angle of a tick, over all the way. Not tested: ticks in which a loop stands in its dead point.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

const TICK: f64 = 1e-3;
const GRAVITY: f64 = 9.81;

/// Cranks of 1 m and 1 kg with 0.08 kg m2 about their middles, a coupler of 2 m and 1 kg, upright at first.
fn scene(method: &str, spin: f64) -> Source {
    let crank = |name: &str, x: f64| {
        format!(
            "(name: \"{name}\", at: ({x:?}, 0.5), angle: \"90 deg\", velocity: ({:?}, 0), spin: {spin:?}, mass: 1, inertia: 0.08, atoms: Disc(radius: 0.05))",
            -0.5 * spin
        )
    };
    let text = format!(
        "Scene(format: 1, clock: (duration: 3, tick: {TICK:?}, method: {method}), gravity: (0, -{GRAVITY:?}), contacts: None,
         bodies: [{}, (name: \"c\", at: (1, 1), velocity: ({:?}, 0), mass: 1, inertia: 0.3, atoms: Disc(radius: 0.05)), {}],
         joints: [Revolute(a: World, anchor_a: (0, 0), b: \"a\", anchor_b: (-0.5, 0)),
            Revolute(a: \"a\", anchor_a: (0.5, 0), b: \"c\", anchor_b: (-1, 0)),
            Revolute(a: \"c\", anchor_a: (1, 0), b: \"b\", anchor_b: (0.5, 0)),
            Revolute(a: World, anchor_a: (2, 0), b: \"b\", anchor_b: (-0.5, 0))])",
        crank("a", 0.0),
        -spin,
        crank("b", 2.0),
    );
    Source::new("parallelogram.ron", text)
}

/// The angle of the cranks in rad after three seconds.
fn truth(spin: f64) -> f64 {
    let rates = |[angle, spin]: [f64; 2]| {
        let inertia = 2.0 * (0.08 + 0.25) + 1.0;
        [spin, -2.0 * GRAVITY * angle.cos() / inertia]
    };
    let mut state = [std::f64::consts::FRAC_PI_2, spin];
    let h = 1e-5;
    for _ in 0..300_000 {
        let plus = |rates: [f64; 2], share: f64| [state[0] + share * h * rates[0], state[1] + share * h * rates[1]];
        let first = rates(state);
        let second = rates(plus(first, 0.5));
        let third = rates(plus(second, 0.5));
        let fourth = rates(plus(third, 1.0));
        state = std::array::from_fn(|at| {
            state[at] + h / 6.0 * (first[at] + 2.0 * second[at] + 2.0 * third[at] + fourth[at])
        });
    }
    state[0]
}

#[test]
fn a_parallelogram_runs_through_its_dead_points() {
    for spin in [8.7, 9.9] {
        let exact = truth(spin);
        for (method, order) in [("VelocityVerlet", 2), ("SemiImplicitEuler", 1), ("RungeKutta4", 4), ("Dop853", 8)] {
            let mut simulation = Simulation::load(&scene(method, spin)).unwrap_or_else(|errors| panic!("{errors}"));
            simulation.run_to_end().unwrap_or_else(|failure| panic!("{method}, {spin} rad/s: {failure}"));
            let bodies = simulation.bodies();
            let passes = (spin * TICK).powi(order).max(1e-7);
            let off = (bodies.angle[0] - exact).abs();
            assert!(off < 3.0 * spin * passes, "{method}, {spin} rad/s: off by {off} rad");
            assert!(bodies.angle[1].abs() < 1e-6, "{method}, {spin} rad/s: the coupler turns by {}", bodies.angle[1]);
            let card = simulation.card();
            if order < 4 {
                let residual = card.momentum_residual[0].abs().max(card.angular_momentum_residual.abs());
                assert!(residual < 1e-10, "{method}: {residual}");
            }
            let told = card.notes.iter().find(|note| note.contains("passes a dead point"));
            assert!(told.is_some(), "{method}: {:?}", card.notes);
        }
    }
}
