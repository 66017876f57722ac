//! A force from outside that jumps at given states, with located jumps: the escapement of a clock as an impulse.
//!
//! Law: `I th'' = -M g d sin th - c th' + tau s`, where `s` is the sign of `th'` while `-b1 < th sign(th') < b2`, else zero (Airy 1826;
//! truth file J11). Each swing takes up `tau (b1 + b2)`, and the pendulum settles to the amplitude at which drag takes as much. Tolerances: a
//! method of order `p` leaves the share `(w h)^p` of a period, `w` the frequency of the pendulum; Dop853 with ticks of 10 ms 1e-12 at most. Not
//! tested: methods that do not locate events.

use std::f64::consts::TAU;

use bevy_app::App;
use jostle::problems::Truth;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{Bend, Energies, EvaluationMode, Events, Indicator, Model, State, SteadySpring, TickAppExt};
use jostle::{Simulation, SimulationExt};

/// Where a swing stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    Before,
    Impulse,
    After,
}

/// Turns body 0 by a torque while it swings through the arc.
struct Escapement {
    torque: f64,
    from: f64,
    to: f64,
    /// That of the spin.
    sign: f64,
    phase: Phase,
    /// Time in s and angle in rad of each turning point.
    turned: Vec<(f64, f64)>,
}

impl Escapement {
    fn new(torque: f64, from: f64, to: f64) -> Self {
        Self { torque, from, to, sign: 1.0, phase: Phase::Before, turned: Vec::new() }
    }

    fn choose(&mut self, state: &State) {
        let (angle, spin) = (state.bodies().angle[0], state.bodies().spin[0]);
        self.sign = if spin < 0.0 { -1.0 } else { 1.0 };
        self.phase = match angle * self.sign {
            angle if angle < -self.from => Phase::Before,
            angle if angle < self.to => Phase::Impulse,
            _ => Phase::After,
        };
    }
}

impl Model for Escapement {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn has_modes(&self) -> bool {
        true
    }

    fn begin_step(&mut self, state: &mut State) {
        // In steps from event to event the phase follows from events alone.
        if state.evaluation().mode != EvaluationMode::Frozen {
            self.choose(state);
        }
    }

    fn apply_forces(&mut self, state: &mut State) {
        if self.phase == Phase::Impulse {
            let torque = self.torque * self.sign;
            let (bodies, rates) = state.bodies_and_rates();
            bodies.torque[0] += torque;
            rates.torque += torque;
            rates.work += torque * bodies.spin[0];
        }
    }

    fn events(&mut self) -> Option<&mut dyn Events> {
        Some(self)
    }
}

impl Events for Escapement {
    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>) {
        let bodies = state.bodies();
        let (angle, spin, spin_rate) = (bodies.angle[0], bodies.spin[0], bodies.torque[0] / bodies.inertia[0]);
        // A pendulum speeds up by `w^2` rad/s2 per rad at most, and its jerk is so much per rad/s.
        let swings = GRAVITY * ARM * MASS;
        let slope = -self.sign * spin;
        let until = |value: f64| Indicator::new(value, slope, Bend::AtMost(swings));
        told.push(match self.phase {
            Phase::Before => until(-self.from - self.sign * angle),
            Phase::Impulse => until(self.to - self.sign * angle),
            Phase::After => Indicator::new(self.sign * spin, self.sign * spin_rate, Bend::AtMost(swings)),
        });
    }

    fn switch(&mut self, state: &mut State, fired: &[usize]) {
        if fired.is_empty() {
            return;
        }
        (self.phase, self.sign) = match self.phase {
            Phase::Before => (Phase::Impulse, self.sign),
            Phase::Impulse => (Phase::After, self.sign),
            Phase::After => {
                self.turned.push((state.evaluation().time, state.bodies().angle[0]));
                (Phase::Before, -self.sign)
            }
        };
    }

    fn take_stock(&mut self, state: &State) {
        self.choose(state);
    }
}

/// In kg, m and m/s2: `M g d` is 9.81 N m, and the moment of inertia about the pivot 1 kg m2.
const MASS: f64 = 4.0;
const ARM: f64 = 0.25;
const GRAVITY: f64 = 9.81;

/// A pendulum that is let go from an angle in rad, after some seconds.
fn swung(clock: &str, angle: f64, torque: f64, seconds: f64) -> Simulation {
    let (sin, cos) = libm::sincos(angle);
    let scene = format!(
        "Scene(format: 1, clock: (duration: {seconds:?}, {clock}), gravity: (0, -{GRAVITY:?}),
          forces: [TorsionSpring(a: \"bob\", b: World, stiffness: 0, damping: 0.02)],
          joints: [Revolute(a: \"bob\", b: World, anchor_a: (0, {ARM:?}))],
          bodies: [(name: \"bob\", at: ({:?}, {:?}), angle: {angle:?}, mass: {MASS:?}, inertia: {:?}, shape: Disc(radius: 0.05))])",
        ARM * sin,
        -ARM * cos,
        1.0 - MASS * ARM * ARM
    );
    let escapement = move |app: &mut App| {
        app.add_model(Escapement::new(torque, 0.02, 0.03));
    };
    let mut simulation = Simulation::load_with(&Source::new("clock.ron", scene), &Overrides::default(), escapement)
        .unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_end().expect("numbers stay finite");
    simulation
}

/// Period in s and amplitude in rad of the last full swing.
fn last_swing(simulation: &Simulation) -> (f64, f64) {
    let turned = &simulation.state().model::<Escapement>().expect("the model is there").turned;
    let [.., before, _, last] = turned[..] else { panic!("no full swing: {turned:?}") };
    (last.0 - before.0, last.1.abs())
}

fn truth() -> Truth {
    Truth::read(include_str!("../../assets/truths/J11_pendulum_clock.json"))
}

/// Drag brings an amplitude nearer by `c/I` per second, so that 1400 s leave `e^-28` of how far it was at the start.
#[test]
fn the_pendulum_settles_to_the_cycle_whatever_it_began_with() {
    let truth = truth();
    let (period, amplitude) = (truth.number("limit-cycle period"), truth.number("limit-cycle amplitude"));
    for begin in [0.12, 0.2] {
        let (found, reached) = last_swing(&swung("method: Dop853, tick: \"10 ms\"", begin, 0.05, 1400.0));
        assert!((reached - amplitude).abs() < 1e-12, "amplitude from {begin} rad: {reached} for {amplitude}");
        assert!((found - period).abs() < 1e-12, "period from {begin} rad: {found} for {period}");
    }
}

/// The ledger has `tau (b1 + b2)` for each swing. The run begins at a turning point and ends between an impulse and the next one.
#[test]
fn each_swing_takes_up_the_torque_times_the_arc() {
    let truth = truth();
    let each = truth.number("energy per tick (= tau*(b1+b2))");
    let simulation = swung("method: Dop853, tick: \"20 ms\"", truth.number("limit-cycle amplitude"), 0.05, 100.4);
    let swings = simulation.state().model::<Escapement>().expect("the model is there").turned.len();
    let energy = simulation.card().energy;
    assert_eq!(swings, 100);
    assert!((energy.work - 100.0 * each).abs() < 1e-14, "{energy:?}");
    assert!(energy.residual.abs() < 1e-13, "{energy:?}");
}

/// A tenth more torque: 13 s a day too slow. Tolerance: that of the truth file.
#[test]
fn more_torque_makes_the_clock_slower() {
    let truth = truth();
    let period = |torque| last_swing(&swung("method: Dop853, tick: \"20 ms\"", 0.16, torque, 1400.0)).0;
    let rate = (1.0 - period(0.055) / period(0.05)) * 86400.0;
    let exact = truth.number("isochronism: rate change for +10 % torque");
    assert!((rate - exact).abs() < 2e-6, "{rate} s a day for {exact}");
}

/// The error of the period falls with the order of the method.
#[test]
fn errors_fall_with_the_order_of_the_method() {
    let (period, amplitude) = (truth().number("limit-cycle period"), truth().number("limit-cycle amplitude"));
    for (method, order) in [("RungeKutta4", 4), ("ImplicitMidpoint", 2)] {
        let error = |tick: f64| {
            let clock = format!("method: {method}, tick: {tick:?}");
            (last_swing(&swung(&clock, amplitude, 0.05, 100.0)).0 / period - 1.0).abs()
        };
        let (coarse, fine) = (error(0.04), error(0.02));
        assert!(fine < (TAU / period * 0.02).powi(order), "{method}: {fine:e}");
        let found = (coarse / fine).log2();
        assert!((found - f64::from(order)).abs() < 0.2, "{method}: order {found} from {coarse:e} and {fine:e}");
    }
}
