//! Law: a force in a straight line changes the speed by its impulse over the mass, however short it acts: `v = integral of F dt / m`.
//! Triangular pulses of tens of nanoseconds lie between long steps of free flight. At a time that rounding puts beside a corner the
//! force is another one. The long step before must not see it.

use super::ran::end;
use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

/// Corners of a pulse as rounded times in s.
struct Pulse {
    times: [f64; 3],
    force: f64,
}

impl Pulse {
    /// It begins near `at` and gives some 1 N s.
    fn of(at: f64, width: f64) -> Self {
        let times = [at, at + 0.4 * width, at + width];
        Self { times, force: 2.0 / width }
    }

    /// In N s. Differences of neighbouring times are exact (Sterbenz).
    fn impulse(&self) -> f64 {
        let [begin, top, end] = self.times;
        0.5 * self.force * ((top - begin) + (end - top))
    }
}

#[test]
fn pulses_of_nanoseconds_give_their_impulse() {
    const MASS: f64 = 0.5;
    let clocks = [
        "method: VelocityVerlet, events: Located, tick: 1e-2",
        "method: Symplectic4, events: Located, tick: 1e-2",
        "method: RungeKutta4, tick: 2e-2",
        "method: ImplicitMidpoint, events: Located, tick: 1e-2",
        "method: Dop853, tick: 5e-2",
        "tolerance: 1e-6",
        "method: Reference",
    ];
    for (at, width) in [(1.003, 2e-8), (0.7137, 2e-8), (1.4151, 2e-7), (0.123456, 2e-6), (1.0, 7e-8)] {
        let pulse = Pulse::of(at, width);
        let [begin, top, finish] = pulse.times;
        let law = pulse.impulse() / MASS;
        // Times of stages err by half a unit, and forces there by their slope: the peak in 0.4 of the width. The mean force is half
        // the peak. The weights of Dop853 have absolute values that add up to 13, and those of other methods to less.
        let bound = 13.0 * 0.5 * f64::EPSILON * finish / (0.4 * width) * 2.0 * law;
        for clock in clocks {
            let ran = end(&format!(
                "Scene(format: 1, clock: (duration: 2, {clock}), gravity: (0, 0), film: (fps: 30),
                    bodies: [(name: \"A\", at: (0, 0), mass: {MASS}, atoms: Disc(radius: 0.1))],
                    forces: [Drive(of: \"A\", force: (1, 0),
                                   course: Piecewise([({begin:?}, 0), ({top:?}, {:?}), ({finish:?}, 0)]))])",
                pulse.force
            ))
            .expect("a run to its end");
            let (_, poses) = ran.seen.last().expect("the end");
            let off = (poses[0].velocity.x - law).abs();
            assert!(off < bound, "{clock}, {width:e} s at {at} s: {off:e} m/s off, allowed {bound:e}");
        }
    }
}

/// A run from tick to tick loses a pulse between two ticks. A servo that sees the rate of its target at ticks loses its way. The verdict
/// names the entry, also without a second run beside it, and also of a run that ends early.
#[test]
fn courses_of_controllers_between_ticks_are_named() {
    const PULSE: &str = "[(0, 0), (0.5003, 0), (0.500301, 1e6), (0.500302, 0)]";
    for (controller, named) in [
        (format!("Actuator(of: \"hinge\", force: Course({PULSE}))"), true),
        (format!("Servo(of: \"hinge\", kp: 50, target: Course({PULSE}))"), true),
        ("Servo(of: \"hinge\", kp: 50, kd: 5, target: Course([(0, 0), (0.5, 0), (0.500001, 1)]))".to_owned(), true),
        ("Servo(of: \"hinge\", kp: 50, kd: 5, target: Course([(0, 0), (0.5, 0), (0.7, 1)]))".to_owned(), false),
        // Points of a table with its own clock lie between ticks, and neighbours make up for each other.
        (format!("Servo(of: \"hinge\", kp: 50, kd: 5, target: Course([{}]))", swing()), false),
    ] {
        let scene = |clock: &str| {
            format!(
                "Scene(format: 1, clock: (duration: 1, tick: 1e-4, {clock}), gravity: (0, 0),
                    bodies: [(name: \"base\", at: (0, 0), fixed: true, atoms: Disc(radius: 0.01)),
                             (name: \"arm\", at: (0.5, 0), mass: 1, shape: Rectangle(width: 1, height: 0.1))],
                    joints: [Revolute(name: \"hinge\", a: \"base\", b: \"arm\", anchor_b: (-0.5, 0), collide: false)],
                    controllers: [{controller}])"
            )
        };
        for (clock, whole_ticks) in [("method: VelocityVerlet, events: PerTick", true), ("events: Located", false)] {
            let source = Source::new("controllers.ron", scene(clock));
            let mut simulation = Simulation::load(&source).expect("a good scene");
            let _ = simulation.run_to_end();
            let verdict = simulation.card().verdict;
            let found = verdict.contains("oints of the course of `controllers[0]` lie between ticks");
            assert_eq!(found, named && whole_ticks, "{clock}, {controller}: {verdict}");
        }
    }
}

/// A target that swings with 2 Hz, at points of 93.7 Hz.
fn swing() -> String {
    let point = |index: u32| {
        let time = f64::from(index) / 93.7;
        format!("({time:?}, {:?})", 0.5 - 0.5 * libm::cos(4.0 * std::f64::consts::PI * time))
    };
    (0..90).map(point).collect::<Vec<_>>().join(", ")
}
