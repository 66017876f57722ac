//! A rod slides on its leading tip. It is so steep and rough that friction presses the tip into the floor. No
//! acceleration fits a rigid rod (Painleve 1895). With a compliant contact the force grows as `exp(sqrt(-A k) t)` until
//! the tip stops. Here `A = (1 + 3 cos^2 a - 3 mu sin a cos a)/m` is below zero (Champneys and Varkonyi 2016). SI
//! units.
//!
//! The rod is a thin rhombus with sharp ends. Friction acts on the surface of the floor: its arm is the height of the centre. The
//! tip starts with an overlap of the size that bears the weight.

use super::{Class, Constant, EventTiming, Problem, ProblemSetting, Truth};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "jamming_rod",
    law: "friction presses the leading tip of a steep rod into the floor, ever faster",
    source: "Painleve 1895; Champneys and Varkonyi 2016; truth file H05, with friction on the surface of the floor",
    class: Class::VelocityDependent,
    tick: TIME / 256.0,
    samples: &[TIME],
    unit: "m",
    always_located: true,
    scene: |setting, duration| scene(setting, duration, OVERLAP),
    error,
    leading_error: None,
    constants: CONSTANTS,
    // The rounding of each tick grows with `exp(518 t)`, by 22 until the end. Their sum is that over the growth in a
    // tick.
    rounding: |tick| 0.5 * f64::EPSILON * 22.0 / (518.0 * tick),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 3.208e0),
    Constant::located("SemiImplicitEuler", 1, 8.675e-1),
    Constant::located("VelocityVerlet", 2, 1.500e2),
    Constant::located("RungeKutta4", 4, 8.090e6),
    Constant::located("ImplicitMidpoint", 2, 2.996e2),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/H05_painleve_rod.json");
/// Those with friction on the surface of the floor.
pub const SOFT: &str = include_str!("../../../assets/truths/H05_soft_rod.json");
/// Of the run in s: the tip still slides at its end.
const TIME: f64 = 0.006;
/// Of the tip at the start, in m.
const OVERLAP: f64 = 1e-5;
/// The coefficient of friction.
const FRICTION: f64 = 1.6;
/// Half the length of the rod, in m.
const HALF: f64 = 0.5;
/// At the start, in degrees from the floor.
const ANGLE: f64 = 55.0;
/// Of the rod at the start in m/s, to the left.
const SPEED: f64 = 4.0;
/// In N/m.
const STIFFNESS: f64 = 1e6;
/// In m/s2.
const GRAVITY: f64 = 9.81;

/// The rod of 1 kg, with an overlap of the tip in m at the start.
pub fn scene(setting: &ProblemSetting, duration: f64, overlap: f64) -> String {
    let clock = ProblemSetting { events: EventTiming::Located, ..*setting }.clock(duration);
    let angle = ANGLE.to_radians();
    let height = HALF * libm::sin(angle) - overlap;
    let inertia = HALF * HALF / 3.0;
    format!(
        "Scene({clock}, gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: Exact),
        materials: {{ \"chalk\": (stiffness: {STIFFNESS:?}, restitution: 1, friction: {FRICTION:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"chalk\")],
        bodies: [(name: \"rod\", at: (0, {height:?}), angle: {angle:?}, velocity: (-{SPEED:?}, 0), mass: 1, inertia: {inertia:?},
                  material: \"chalk\", shape: Polygon(points: [(-{HALF:?}, 0), (0, -0.01), ({HALF:?}, 0), (0, 0.01)]))])"
    )
}

/// Of the middle, or of the angle at the tip.
fn error(simulation: &Simulation, _: f64, _: f64) -> f64 {
    let (exact, bodies) =
        (Truth::read(SOFT).numbers("x, y, theta at 6 ms, from an overlap of 1e-5 m"), simulation.bodies());
    let place = bodies.position[0];
    (place.x - exact[0]).hypot(place.y - exact[1]).max(HALF * (bodies.angle[0] - exact[2]).abs())
}
