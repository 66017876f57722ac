//! Laws of joints at rest under oscillating loads, which the estimated error of a step does not see. Motors reach their
//! limits, friction slips and joints break at the times that the load determines, however long steps are.
//!
//! Reference: closed forms of the motion from event to event; the times of events by bisection. Tolerance: the share that is allowed,
//! times the largest load over the inertia, over the square of the duration; a hundredfold of it for the sum over some hundred steps.
//!
//! Not tested: methods from tick to tick, whose ticks resolve the load.

use std::f64::consts::TAU;

use jostle::Simulation;
use jostle::scene::Source;

const INERTIA: f64 = 0.1;
const SPEED: f64 = -6.0;
const DURATION: f64 = 2.0;

fn run(clock: &str, scene: &str) -> Simulation {
    let text = format!("Scene(format: 1, clock: (duration: {DURATION:?}, {clock}), contacts: None, {scene})");
    let mut simulation = Simulation::load(&Source::new("load.ron", text)).unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_end().unwrap();
    simulation
}

/// The clocks that are tried, and the share of its error that each allows.
const CLOCKS: [(&str, f64); 4] = [
    ("tolerance: 1e-3", 1e-3),
    ("tolerance: 1e-8", 1e-8),
    ("method: Reference", 1e-11),
    ("tick: 2e-3, method: Dop853", 1e-11),
];

/// Where `f` first falls from a positive value through zero, after `from`; `DURATION` if it does not.
fn falls(from: f64, f: impl Fn(f64) -> f64) -> f64 {
    let step = 1e-5;
    let count = ((DURATION - from) / step) as usize;
    let Some(after) = (1..=count).map(|number| from + step * number as f64).find(|time| f(*time) < 0.0) else {
        return DURATION;
    };
    let (mut low, mut high) = (after - step, after);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if f(middle) < 0.0 { &mut high } else { &mut low }) = middle;
    }
    0.5 * (low + high)
}

/// The angle of a wheel whose rate `held` is kept by at most `limit` against the load `amplitude sin(omega t)`.
fn angle(amplitude: f64, omega: f64, (held, limit): (f64, f64)) -> f64 {
    let load = |time: f64| amplitude * (omega * time).sin();
    let (mut now, mut angle) = (0.0, 0.0);
    while now < DURATION {
        let slips = falls(now, |time| limit - load(time).abs());
        angle += held * (slips - now);
        let sign = load(slips).signum();
        // Integrals of `(load - sign limit) / I`, once and twice.
        let rate = |time: f64| {
            let swing = amplitude / omega * ((omega * slips).cos() - (omega * time).cos());
            (swing - sign * limit * (time - slips)) / INERTIA
        };
        let stops = if slips < DURATION { falls(slips + 1e-4, |time| sign * rate(time)) } else { DURATION };
        let way = stops - slips;
        let swing =
            amplitude / omega * ((omega * slips).cos() * way - ((omega * stops).sin() - (omega * slips).sin()) / omega);
        angle += held * way + (swing - 0.5 * sign * limit * way * way) / INERTIA;
        now = stops;
    }
    angle
}

fn allowed(share: f64, amplitude: f64) -> f64 {
    100.0 * share * amplitude / INERTIA * DURATION * DURATION
}

/// Law: `I (rate)' = load - sign(load) limit` while the load is above the limit, and until the rate is reached again.
#[test]
fn a_motor_gives_way_when_the_load_of_the_clock_exceeds_its_limit() {
    // The last load exceeds the limit for a hundredth of its period, ten times.
    for (amplitude, frequency, drives) in
        [(40.0, 1.0, true), (40.0, 0.7, false), (40.0, 20.0, true), (25.01, 2.2, false), (30.0, 0.2, false)]
    {
        let truth = angle(amplitude, TAU * frequency, (SPEED, 25.0));
        assert!((truth - SPEED * DURATION).abs() > 1e-7, "the wheel slips: {truth}");
        let course = format!("Sine(amplitude: {amplitude:?}, frequency: {frequency:?})");
        let (force, controller) = if drives {
            (format!("forces: [Drive(of: \"w\", torque: 1, course: {course})],"), String::new())
        } else {
            (String::new(), format!("Actuator(of: \"h\", force: {course})"))
        };
        for (clock, share) in CLOCKS {
            let simulation = &run(
                clock,
                &format!(
                    "bodies: [(name: \"w\", at: (0, 0), mass: 2, inertia: {INERTIA:?}, spin: {SPEED:?}, atoms: Disc(radius: 0.3))],
                    joints: [Revolute(name: \"h\", a: World, b: \"w\")], {force}
                    controllers: [Motor(of: \"h\", speed: {SPEED:?}, limit: 25), {controller}]"
                ),
            );
            let found = simulation.state().bodies().angle[0];
            let most = allowed(share, amplitude);
            assert!((found - truth).abs() < most, "{amplitude} at {frequency} Hz, {clock}: {found}, {truth}");
        }
    }
}

/// Law: friction in a hinge holds a wheel at rest until the load exceeds its bound.
#[test]
fn friction_in_a_joint_slips_when_the_load_of_the_clock_exceeds_its_bound() {
    for (amplitude, frequency) in [(40.0, 1.0), (25.01, 2.2)] {
        let truth = angle(amplitude, TAU * frequency, (0.0, 25.0));
        for (clock, share) in CLOCKS {
            let simulation = &run(
                clock,
                &format!(
                    "bodies: [(name: \"w\", at: (0, 0), mass: 2, inertia: {INERTIA:?}, atoms: Disc(radius: 0.3))],
                    joints: [Revolute(name: \"h\", a: World, b: \"w\", friction: 25)],
                    controllers: [Actuator(of: \"h\", force: Sine(amplitude: {amplitude:?}, frequency: {frequency:?}))]"
                ),
            );
            let found = simulation.state().bodies().angle[0];
            let most = allowed(share, amplitude);
            assert!((found - truth).abs() < most, "{amplitude} at {frequency} Hz, {clock}: {found}, {truth}");
        }
    }
}

/// Law: a weld breaks when its force reaches `break_force`; from then on its body goes by the load alone.
#[test]
fn a_joint_breaks_when_the_load_of_the_clock_reaches_its_bound() {
    for peak in [1.5_f64, 1.0001] {
        let (omega, bound, mass) = (TAU * 1.5, 10.0, 2.0);
        let amplitude = peak * bound;
        let begin = (1.0 / peak).asin() / omega;
        let way = DURATION - begin;
        let swing = (omega * begin).cos() * way - ((omega * DURATION).sin() - (omega * begin).sin()) / omega;
        let truth = amplitude / (mass * omega) * swing;
        for (clock, share) in CLOCKS {
            let simulation = &run(
                clock,
                &format!(
                    "bodies: [(name: \"w\", at: (0, 0), mass: {mass:?}, atoms: Disc(radius: 0.3))],
                    joints: [Weld(a: World, b: \"w\", break_force: {bound:?})],
                    forces: [Drive(of: \"w\", force: (1, 0), course: Sine(amplitude: {amplitude:?}, frequency: 1.5))]"
                ),
            );
            let found = simulation.state().bodies().position[0].x;
            assert!((found - truth).abs() < allowed(share, amplitude), "{peak}, {clock}: {found}, {truth}");
        }
    }
}

/// Law: where a joint stands at its limit the limit bears what presses it. When the load turns round, friction alone holds the joint, and it slips
/// when the load exceeds the bound: `I a'' = A sin(w t - 90 deg) - f` from `w t = 90 deg + asin(f / A)` on.
#[test]
fn friction_holds_a_joint_that_its_limit_lets_go() {
    let (amplitude, bound, omega, time) = (2.0_f64, 1.0, TAU, 0.48);
    let begin = (0.25 * TAU + (bound / amplitude).asin()) / omega;
    let phase = |time: f64| omega * time - 0.25 * TAU;
    let way = time - begin;
    let swing = amplitude / omega * (phase(begin).cos() * way - (phase(time).sin() - phase(begin).sin()) / omega);
    let truth = (swing - 0.5 * bound * way * way) / INERTIA;
    for (clock, share) in CLOCKS.into_iter().chain([("tick: 1e-3, method: RungeKutta4", 1e-11)]) {
        let scene = format!(
            "bodies: [(name: \"w\", at: (0, 0), mass: 2, inertia: {INERTIA:?}, atoms: Disc(radius: 0.3))],
            joints: [Revolute(name: \"h\", a: World, b: \"w\", friction: {bound:?}, limits: (0, 3))],
            controllers: [Actuator(of: \"h\", force: Sine(amplitude: {amplitude:?}, frequency: 1, phase: \"-90 deg\"))]"
        );
        let text = format!("Scene(format: 1, clock: (duration: {time:?}, {clock}), contacts: None, {scene})");
        let mut simulation =
            Simulation::load(&Source::new("load.ron", text)).unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_end().unwrap();
        let found = simulation.state().bodies().angle[0];
        assert!((found - truth).abs() < allowed(share, amplitude), "{clock}: {found}, {truth}");
    }
}

/// Law: frictions of two hinges that a gear of ratio `r` couples hold as much as `f + |r| g` together, also where one gives way before the
/// other: the wheels of inertia `I/2` and `I/(2 r^2)` slip at the peaks of a load that exceeds it by little.
#[test]
fn coupled_frictions_slip_at_the_peak_of_the_load() {
    for (amplitude, frequency, part, ratio) in
        [(26.5, 0.8, 0.625, -0.6), (25.01, 2.2, 0.5, 1.5), (27.0, 0.7, 0.1, -2.0), (26.0, 1.0, 0.9, 0.5_f64)]
    {
        let truth = angle(amplitude, TAU * frequency, (0.0, 25.0));
        let (first, second) = (part * 25.0, (1.0 - part) * 25.0 / ratio.abs());
        for (clock, share) in CLOCKS {
            let simulation = &run(
                clock,
                &format!(
                    "bodies: [(name: \"w\", at: (0, 0), mass: 2, inertia: {:?}, atoms: Disc(radius: 0.3)),
                        (name: \"v\", at: (2, 0), mass: 2, inertia: {:?}, atoms: Disc(radius: 0.3))],
                    joints: [Revolute(name: \"h\", a: World, b: \"w\", friction: {first:?}),
                        Revolute(name: \"k\", a: World, b: \"v\", friction: {second:?}), GearPair(of: (\"h\", \"k\"), ratio: {ratio:?})],
                    controllers: [Actuator(of: \"h\", force: Sine(amplitude: {amplitude:?}, frequency: {frequency:?}))]",
                    0.5 * INERTIA,
                    0.5 * INERTIA / (ratio * ratio)
                ),
            );
            let found = simulation.state().bodies().angle[0];
            let most = allowed(share, amplitude);
            assert!(
                (found - truth).abs() < most,
                "{amplitude} at {frequency} Hz, {part} {ratio}, {clock}: {found}, {truth}"
            );
        }
    }
}
