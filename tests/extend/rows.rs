//! Models from outside that hold something exactly: rods as rows of constraints.
//!
//! Law: two point masses on two rods are a double pendulum. The rows of both models, of two instances of one type, are solved
//! together, so the motion is that of generalised coordinates (Goldstein, Classical Mechanics, section 1.6), integrated here apart
//! from the engine with steps a fortieth as long. Tolerance: the global error of Runge-Kutta 4 at this tick, (dt w)^4 with w = 8
//! rad/s at most, times the growth of a swing of two seconds, a hundred; for Dop853 that of the reference, likewise. Not tested:
//! contacts at the same time.

use bevy_app::App;
use glam::DVec2;
use jostle::constraints::{LostTo, Row, RowKind, RowSide, Rows, Share};
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{Energies, Model, State, SteadySpring, TickAppExt};
use jostle::world::Bodies;
use jostle::{Simulation, SimulationExt};

/// A rod that holds its place: see [`a_rod_that_holds_its_place_does_not_drift`].
struct Placed {
    length: f64,
    row: usize,
}

impl Model for Placed {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn has_rows(&self) -> bool {
        true
    }

    fn add_rows(&mut self, bodies: &Bodies, _: f64, rows: &mut Rows) {
        let (place, velocity) = (bodies.position[0], bodies.velocity[0]);
        let direction = place.normalize();
        let side = RowSide { body: 0, direction, force: direction, ..RowSide::default() };
        self.row = rows.len();
        rows.add(Row {
            sides: [None, Some(side)],
            inertial: velocity.perp_dot(direction).powi(2) / place.length(),
            kind: RowKind::Position,
            gap: place.length() - self.length,
            size: self.length,
            ..Row::default()
        });
    }

    fn take_rows(&mut self, state: &mut State) {
        state.apply_rows(self.row..self.row + 1);
    }
}

/// Keeps two centres, or a centre and the origin, at their distance.
struct Rod {
    bodies: [Option<usize>; 2],
    /// The index of its row in the present evaluation.
    row: usize,
}

impl Model for Rod {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn has_rows(&self) -> bool {
        true
    }

    fn apply_forces(&mut self, state: &mut State) {
        let bodies = state.bodies();
        let at = |body: Option<usize>| body.map_or(DVec2::ZERO, |body| bodies.position[body]);
        let velocity = |body: Option<usize>| body.map_or(DVec2::ZERO, |body| bodies.velocity[body]);
        let [a, b] = self.bodies;
        let (along, moved) = (at(b) - at(a), velocity(b) - velocity(a));
        let direction = along.normalize();
        let across = moved.perp_dot(direction);
        let side = |body: usize, sign: f64| RowSide {
            body,
            direction: sign * direction,
            force: sign * direction,
            ..RowSide::default()
        };
        let row = Row {
            sides: [a.map(|body| side(body, -1.0)), b.map(|body| side(body, 1.0))],
            inertial: across * across / along.length(),
            surface: DVec2::ZERO,
            share: Share { natural: 0.0, measure: 1.0 },
            lost_to: LostTo::Friction,
            ..Row::default()
        };
        self.row = state.rows().len();
        state.rows_mut().add(row);
    }

    fn take_rows(&mut self, state: &mut State) {
        state.apply_rows(self.row..self.row + 1);
    }
}

/// Masses in kg, lengths in m, gravity in m/s2.
const MASS: [f64; 2] = [1.0, 2.5];
const LENGTH: [f64; 2] = [0.5, 0.3];
const GRAVITY: f64 = 10.0;
const DURATION: f64 = 2.0;

/// Angles from the vertical and their rates: the equations of motion.
fn rates([a, b, u, w]: [f64; 4]) -> [f64; 4] {
    let ([m, n], [l, k]) = (MASS, LENGTH);
    let (sin, cos) = (libm::sin(a - b), libm::cos(a - b));
    // (m + n) l a" + n k b" cos + n k w^2 sin + (m + n) g sin a = 0
    // k b" + l a" cos - l u^2 sin + g sin b = 0
    let first = -n * k * w * w * sin - (m + n) * GRAVITY * libm::sin(a);
    let second = l * u * u * sin - GRAVITY * libm::sin(b);
    let alpha = (first - n * cos * second) / (l * (m + n * (1.0 - cos * cos)));
    let beta = (second - l * alpha * cos) / k;
    [u, w, alpha, beta]
}

/// Where both masses are at the end.
fn reference() -> [DVec2; 2] {
    let steps = 40_000;
    let h = DURATION / f64::from(steps);
    let mut state = [1.2, -0.4, 0.0, 0.0];
    let plus = |state: [f64; 4], rate: [f64; 4], h: f64| std::array::from_fn(|i| state[i] + h * rate[i]);
    for _ in 0..steps {
        let k1 = rates(state);
        let k2 = rates(plus(state, k1, h / 2.0));
        let k3 = rates(plus(state, k2, h / 2.0));
        let k4 = rates(plus(state, k3, h));
        state = std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    places(state[0], state[1])
}

fn places(a: f64, b: f64) -> [DVec2; 2] {
    let hangs = |angle: f64, length: f64| DVec2::new(libm::sin(angle), -libm::cos(angle)) * length;
    let first = hangs(a, LENGTH[0]);
    [first, first + hangs(b, LENGTH[1])]
}

fn pendulum(method: &str, tick: f64) -> Simulation {
    let [first, second] = places(1.2, -0.4);
    let scene = format!(
        "Scene(format: 1, clock: (duration: {DURATION}, tick: {tick}, method: {method}), gravity: (0, -{GRAVITY}),
          bodies: [(name: \"first\", at: ({}, {}), atoms: Disc(radius: 0.01, mass: {})),
                   (name: \"second\", at: ({}, {}), atoms: Disc(radius: 0.01, mass: {}))])",
        first.x, first.y, MASS[0], second.x, second.y, MASS[1]
    );
    let rods = |app: &mut App| {
        app.add_model(Rod { bodies: [None, Some(0)], row: 0 }).add_model(Rod { bodies: [Some(0), Some(1)], row: 0 });
    };
    Simulation::load_with(&Source::new("rods.ron", scene), &Overrides::default(), rods).expect("a correct scene")
}

#[test]
fn rods_from_outside_swing_as_a_double_pendulum() {
    let truth = reference();
    for (method, tick, tolerance) in [("RungeKutta4", 2e-3, 1e2 * (2e-3_f64 * 8.0).powi(4)), ("Dop853", 2e-3, 1e-11)] {
        let mut simulation = pendulum(method, tick);
        simulation.run_to_end().expect("numbers stay finite");
        for (place, truth) in simulation.bodies().position.iter().zip(truth) {
            let error = place.distance(truth);
            assert!(error <= tolerance, "{method}: off by {error}");
        }
        let card = simulation.card();
        assert!(card.energy.residual.abs() <= 20.0 * tolerance, "{method}: {:?}", card.energy);
        assert!(
            card.momentum_residual.iter().all(|share| share.abs() <= 1e-9),
            "{method}: {:?}",
            card.momentum_residual
        );
    }
}

/// Law: what both rods bear at first follows from the accelerations of the masses: `m a = F + T`. Tolerance: rounding.
#[test]
fn rows_of_two_models_are_solved_together() {
    let mut simulation = pendulum("RungeKutta4", 1e-3);
    simulation.run_to_tick(1).expect("numbers stay finite");
    let bodies = simulation.bodies();
    let [a, b] = [0, 1].map(|body| bodies.force[body] / MASS[body]);
    let of = |from: DVec2, to: DVec2, a: DVec2, u: DVec2| {
        let (along, length) = ((to - from).normalize(), (to - from).length());
        along.dot(a) + u.perp_dot(along).powi(2) / length
    };
    let (first, second) = (bodies.position[0], bodies.position[1]);
    let (u, w) = (bodies.velocity[0], bodies.velocity[1]);
    assert!(of(DVec2::ZERO, first, a, u).abs() < 1e-11);
    assert!(of(first, second, b - a, w - u).abs() < 1e-11);
}

/// Law: a row of kind `Position` is brought back in each step, by every kind of method; the card names the model. Tolerance: rounding of a
/// length of 1 m.
#[test]
fn a_rod_that_holds_its_place_does_not_drift() {
    for method in ["VelocityVerlet", "SemiImplicitEuler", "RungeKutta4", "Dop853", "ImplicitMidpoint"] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 20, tick: 0.01, method: {method}), gravity: (0, -9.81),
              bodies: [(name: \"bob\", at: (1, 0), atoms: Disc(radius: 0.01))])"
        );
        let rod = |app: &mut App| {
            app.add_model(Placed { length: 1.0, row: 0 });
        };
        let mut simulation =
            Simulation::load_with(&Source::new("rod.ron", scene), &Overrides::default(), rod).expect("a correct scene");
        simulation.run_to_end().expect("numbers stay finite");
        let off = (simulation.bodies().position[0].length() - 1.0).abs();
        assert!(off < 8.0 * f64::EPSILON, "{method}: {off:e}");
        let drift = simulation.card().largest_joint_drift.expect("the model holds a place");
        assert!(drift.meters < 8.0 * f64::EPSILON && drift.joint.contains("Placed"), "{method}: {drift:?}");
    }
}
