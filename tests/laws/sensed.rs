//! What sensors tell of forces: accelerations by all forces of the present state, joints among them.
//!
//! Source: Newton's law; a rod of length `l` that is let go level about its end begins with `3 g/(2 l)` (Goldstein, section 5.7). Tolerance:
//! rounding. Not tested: bodies that rest in contact.

use jostle::Simulation;
use jostle::scene::Source;

fn read(method: &str, tick: u64, bodies: &str, name: &str) -> f64 {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\", method: {method}), gravity: (0, -9.81), contacts: None, {bodies})"
    );
    let mut simulation =
        Simulation::load(&Source::new("sensed.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_tick(tick).unwrap();
    let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the channel is there");
    simulation.value(&channel)
}

#[test]
fn accelerations_are_those_of_all_forces() {
    let ball = "bodies: [(name: \"ball\", at: (0, 1), velocity: (3, 4), mass: 2, atoms: Disc(radius: 0.1))]";
    let pushed = format!(
        "{ball}, forces: [Drive(of: \"ball\", force: (5, 0), course: Sine(frequency: 0.25, phase: \"90 deg\"))]"
    );
    let rod =
        "bodies: [(name: \"rod\", at: (0.5, 0), mass: 2, inertia: 0.16666666666666666, atoms: Disc(radius: 0.1))],
        joints: [Revolute(a: World, anchor_a: (0, 0), b: \"rod\", anchor_b: (-0.5, 0))]";
    for method in ["VelocityVerlet", "Dop853", "RungeKutta4"] {
        assert!((read(method, 100, ball, "ball.acceleration.y") + 9.81).abs() < 1e-14, "{method}");
        assert!(
            read(method, 0, ball, "ball.acceleration.y").is_nan(),
            "{method}: nothing is known before the first tick"
        );
        assert!((read(method, 0, ball, "ball.speed") - 5.0).abs() < 1e-15, "{method}");
        let sine = read(method, 250, &pushed, "ball.acceleration.x");
        assert!((sine - 2.5 * libm::cos(std::f64::consts::FRAC_PI_8)).abs() < 1e-13, "{method}: {sine}");
        // Within the first tick the rod turns by 7e-6 rad, so that all changes by less than 1e-8.
        let turning = read(method, 1, rod, "rod.angular_acceleration");
        assert!((turning + 1.5 * 9.81).abs() < 1e-8, "{method}: {turning}");
        assert!((read(method, 1, rod, "rod.acceleration.y") + 0.75 * 9.81).abs() < 1e-8, "{method}");
    }
}

/// A body on a prescribed way has the acceleration of that way: none on a straight one.
#[test]
fn a_prescribed_body_has_the_acceleration_of_its_way() {
    let cart = "bodies: [(name: \"cart\", at: (0, 0), kinematic: (velocity: (2, 1)), atoms: Disc(radius: 0.1))]";
    for quantity in ["acceleration.x", "acceleration.y", "angular_acceleration"] {
        assert_eq!(read("VelocityVerlet", 10, cart, &format!("cart.{quantity}")), 0.0);
    }
}
