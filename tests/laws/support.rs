//! Common tools of laws: loading, phases, fits.

use std::fmt::Write;

use glam::DVec2;
use jostle::Simulation;
use jostle::contacts::ContactForces;
use jostle::integrate::Description;
pub use jostle::problems::hard::kinetic;
use jostle::problems::{EventTiming, Problem, ProblemSetting, hard};
use jostle::scene::Source;
use jostle::world::Bodies;
use jostle::world::hash::state_hash;

/// The two methods that stand in most tests by name.
pub const METHODS: [&str; 2] = ["SemiImplicitEuler", "VelocityVerlet"];

/// A scene, ready to run.
pub fn load(text: &str) -> Simulation {
    Simulation::load(&Source::new("law.ron", text)).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

/// A scene that has run to its end.
pub fn run(text: &str) -> Simulation {
    let mut simulation = load(text);
    simulation.run_to_end().expect("numbers stay finite");
    simulation
}

/// `count` phases between 0 and 1 that no tick falls on twice: multiples of the golden section.
pub fn phases(count: u32) -> impl Iterator<Item = f64> {
    hard::golden().take(count as usize)
}

/// Phases over which errors are averaged.
const PHASES: u32 = 16;

/// Errors of a method at a tick: one, or where events fall on other places of ticks one for each of 16 phases, each with its
/// own tick, up to a tenth shorter; infinite where a run explodes. With it the tick.
pub fn errors_at(problem: &Problem, method: &Description, events: EventTiming, tick: f64) -> Vec<(f64, f64)> {
    let measure = |setting: ProblemSetting| (setting.tick, problem.measure(&setting).unwrap_or(f64::INFINITY));
    let setting = ProblemSetting { method: method.name, tick, shift: 0.0, events };
    if !problem.class.depends_on_phase() {
        return vec![measure(setting)];
    }
    let at_phase = |(number, phase): (usize, f64)| {
        let tick = tick * (1.0 - 0.1 * (number as f64 * std::f64::consts::SQRT_2).fract());
        measure(ProblemSetting { tick, shift: phase * tick, ..setting })
    };
    phases(PHASES).enumerate().map(at_phase).collect()
}

/// Root mean square of [`errors_at`].
pub fn rms_error(problem: &Problem, method: &Description, events: EventTiming, tick: f64) -> f64 {
    let errors = errors_at(problem, method, events, tick);
    (errors.iter().map(|(_, error)| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

/// The power of the tick with which errors fall: least squares of their logarithms.
pub fn fitted_order(points: &[(f64, f64)]) -> f64 {
    let logarithms: Vec<(f64, f64)> = points.iter().map(|(tick, error)| (tick.ln(), error.ln())).collect();
    let count = logarithms.len() as f64;
    let (sum_x, sum_y) = logarithms.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0, sum.1 + point.1));
    let (mean_x, mean_y) = (sum_x / count, sum_y / count);
    let covariance: f64 = logarithms.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let variance: f64 = logarithms.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    covariance / variance
}

/// The same for those errors that are above `floor`, what rounding leaves; `None` if fewer than three are.
pub fn fitted_order_above(floor: f64, points: &[(f64, f64)]) -> Option<f64> {
    let above: Vec<(f64, f64)> = points.iter().copied().filter(|(_, error)| error.is_nan() || *error > floor).collect();
    (above.len() >= 3).then(|| fitted_order(&above))
}

/// Ticks and errors, to be shown when a test fails.
pub fn table(points: &[(f64, f64)]) -> String {
    points.iter().fold(String::new(), |mut text, (tick, error)| {
        let _ = write!(text, " {tick:.3e}: {error:.3e};");
        text
    })
}

/// Asserts that a number is what it should be, to an absolute tolerance.
#[track_caller]
pub fn assert_near(what: &str, found: f64, exact: f64, tolerance: f64) {
    let error = (found - exact).abs();
    assert!(error <= tolerance, "{what}: found {found:?}, exact {exact:?}, error {error:e} > {tolerance:e}");
}

/// Momentum in N s and angular momentum about the origin in N m s, summed here and not by the engine; and the sums of
/// their absolute values, to compare errors with.
pub fn momenta(bodies: &Bodies) -> ((DVec2, f64), (f64, f64)) {
    let mut totals = (DVec2::ZERO, 0.0);
    let mut scales = (0.0, 0.0);
    for body in (0..bodies.len()).filter(|&body| bodies.dynamic[body]) {
        let momentum = bodies.mass[body] * bodies.velocity[body];
        let own = bodies.inertia[body] * bodies.spin[body];
        let (position, turning) = (bodies.position[body], bodies.position[body].perp_dot(momentum));
        totals.0 += momentum;
        totals.1 += turning + own;
        scales.0 += momentum.length();
        scales.1 += position.length() * momentum.length() + own.abs();
    }
    (totals, scales)
}

/// Runs on to `time` seconds.
pub fn run_to(simulation: &mut Simulation, time: f64) {
    let tick = (time / simulation.clock().dt).round() as u64;
    simulation.run_to_tick(tick).expect("numbers stay finite");
}

/// Forces that contacts exert on walls and bodies. The scene must have a sensor that asks for them.
pub fn contact_forces(simulation: &Simulation) -> &ContactForces {
    simulation.state().contact_forces().expect("the scene has a sensor of contact forces")
}

/// Runs to `time`, asserts that by then nothing moves at all, and that it stays so to the last bit for `still` seconds.
#[track_caller]
pub fn assert_rest(what: &str, simulation: &mut Simulation, time: f64, still: f64) {
    run_to(simulation, time);
    let bodies = simulation.bodies();
    let moving = (0..bodies.len()).filter(|&body| bodies.velocity[body] != DVec2::ZERO || bodies.spin[body] != 0.0);
    let described = moving.fold(String::new(), |mut text, body| {
        let (position, velocity) = (bodies.position[body], bodies.velocity[body]);
        let _ = write!(text, "\n{} at {position}: {velocity} m/s, {} rad/s", simulation.name(body), bodies.spin[body]);
        text
    });
    assert!(described.is_empty(), "{what}: at {time} s these still move:{described}");
    assert_eq!(kinetic(bodies), 0.0, "{what}: kinetic energy at {time} s");
    let hash = state_hash(bodies);
    run_to(simulation, time + still);
    assert_eq!(state_hash(simulation.bodies()), hash, "{what}: the state changed after {time} s");
}

/// Whether nothing from outside acts on the bodies of a problem.
pub fn is_closed(problem: &Problem) -> bool {
    let setting =
        ProblemSetting { method: "VelocityVerlet", tick: problem.tick, shift: 0.0, ..ProblemSetting::default() };
    let text = (problem.scene)(&setting, problem.duration());
    let outside =
        ["gravity:", "walls:", "fixed:", "kinematic:", "World", "Drag(", "Drive(", "Thrust(", "Torque(", "Wind("];
    !outside.iter().any(|word| text.contains(word))
}
