//! Law: the tip of a rod that slides, tip first, accelerates away from the floor by `A N + b` under a normal force `N`, where
//! `A = (1 + 3 cos^2 a - 3 mu sin a cos a)/m` and `b = l w^2 sin a - g`. With `A` above zero the force of a rigid floor is `-b/A`. With `A`
//! below zero it has no force (`b` below zero) or two answers (Painleve 1895; Genot and Brogliato 1999; truth file H05).
//!
//! Here the force is that of an overlap, so both numbers are found from two overlaps, in any state. Friction acts on the surface of the floor,
//! an overlap above the tip: that adds `c N^2/k`, `c = 3 mu cos a/(l m)`. Tolerance: rounding of places is a share of 1e-8 of an overlap of
//! 1e-8 m.
//!
//! Not tested: how such states go on (see the problem `jamming_rod`).

use jostle::problems::Truth;

use super::support::{load, run_to};

const HALF: f64 = 0.5;
const GRAVITY: f64 = 9.81;
const STIFFNESS: f64 = 1e9;

/// The acceleration of the tip away from the floor in m/s2, under a normal force in N.
fn tip(angle: f64, spin: f64, friction: f64, force: f64) -> f64 {
    let (sin, cos) = libm::sincos(angle);
    let height = HALF * sin - force / STIFFNESS;
    // The tip slides to the left at 4 m/s, along the floor.
    let (x, y) = (-4.0 - HALF * spin * sin, HALF * spin * cos);
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 1e-12, tick: 1e-12, method: Dop853), gravity: (0, -{GRAVITY:?}), contacts: Penalty(tangential: Exact),
        materials: {{ \"default\": (stiffness: {STIFFNESS:?}, restitution: 1, friction: {friction:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0))], sensors: [Acceleration(of: \"rod\")],
        bodies: [(name: \"rod\", at: (0, {height:?}), angle: {angle:?}, velocity: ({x:?}, {y:?}), spin: {spin:?}, mass: 1, inertia: {:?},
                  shape: Polygon(points: [(-{HALF:?}, 0), (0, -0.01), ({HALF:?}, 0), (0, 0.01)]))])",
        HALF * HALF / 3.0
    ));
    run_to(&mut simulation, 1e-12);
    let mut read = |name: &str| {
        let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the sensor is there");
        simulation.value(&channel)
    };
    let (up, turning) = (read("rod.acceleration.y"), read("rod.angular_acceleration"));
    up - HALF * (turning * cos - spin * spin * sin)
}

#[test]
fn friction_turns_the_sign_of_what_a_normal_force_does() {
    let truth = Truth::read(include_str!("../../assets/truths/H05_painleve_rod.json"));
    let states = [
        (45.0, 0.0, 0.5, "th=45 w=0.0 mu=0.5", Some("th=45 mu=0.5: normal force")),
        (70.0, 0.0, 1.2, "th=70 w=0.0 mu=1.2", Some("th=70 mu=1.2: normal force")),
        (60.0, 0.0, 1.5, "th=60 w=0.0 mu=1.5", None),
        (63.434_948_822_922, 5.0, 1.5, "th=63.4349488229220 w=5.0 mu=1.5", None),
    ];
    for (degrees, spin, friction, name, rigid) in states {
        let angle = f64::to_radians(degrees);
        let of = |force: f64| tip(angle, spin, friction, force);
        let raised = 3.0 * friction * libm::cos(angle) / (HALF * STIFFNESS);
        let [one, two] = [10.0, 20.0].map(|force| of(force) - raised * force * force);
        let slope = (two - one) / 10.0;
        let free = one - 10.0 * slope;
        let (exact, fall) = (truth.number(&format!("{name}: A")), HALF * spin * spin * libm::sin(angle) - GRAVITY);
        assert!((slope - exact).abs() < 3e-8, "{name}: A = {slope} for {exact}");
        assert!((free - fall).abs() < 6e-7, "{name}: b = {free} for {fall}");
        if let Some(rigid) = rigid {
            let (found, exact) = (-free / slope, truth.number(rigid));
            assert!((found / exact - 1.0).abs() < 1e-6, "{name}: {found} N for {exact} N");
        }
    }
    // At tan a = 2 and this friction A is zero.
    let critical = truth.numbers("critical mu 4/3 at th=atan 2");
    let of = |force: f64| tip(critical[1], 0.0, critical[0], force);
    let raised = 3.0 * critical[0] * libm::cos(critical[1]) / (HALF * STIFFNESS);
    assert!((of(20.0) - of(10.0) - 300.0 * raised).abs() < 3e-7);
}
