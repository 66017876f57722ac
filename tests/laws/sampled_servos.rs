//! Laws of controllers that take samples, where the engine chooses how long steps are.
//!
//! Not tested: equal ticks, see `drives`.

use jostle::Simulation;
use jostle::scene::Source;

/// Law: the integral of a sampled controller grows while nothing moves yet, and steps stay long. A wheel under PI control, sampled at 10 Hz and
/// late by one period, has `u_n = kp e_n + ki (sum of e)` from the next sample on. Tolerance: rounding; held outputs make exact parabolas.
#[test]
fn a_late_sampled_servo_with_an_integral_runs_under_a_tolerance() {
    for clock in ["tolerance: 1e-4", "tolerance: 1e-8", "method: Reference", "method: Dop853, tick: 0.01"] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 2, {clock}), contacts: None,
             bodies: [(name: \"wheel\", at: (0, 0), mass: 1, inertia: 0.5, atoms: Disc(radius: 0.1))],
             joints: [Revolute(name: \"hub\", a: World, b: \"wheel\")],
             controllers: [Servo(of: \"hub\", target: 1, kp: 0.3, ki: 0.2, rate: 10, delay: 0.1)])"
        );
        let mut simulation =
            Simulation::load(&Source::new("servo.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_end().unwrap_or_else(|failure| panic!("{clock}: {failure}"));
        let (mut angle, mut rate, mut integral, mut late) = (0.0, 0.0, 0.0, 0.0);
        let period = 0.1_f64;
        for _ in 0..20 {
            let acceleration = late / 0.5;
            late = 0.3 * (1.0 - angle) + 0.2 * integral;
            integral += period * (1.0 - angle - 0.5 * period * rate - period * period * acceleration / 6.0);
            angle += period * rate + 0.5 * period * period * acceleration;
            rate += period * acceleration;
        }
        let bodies = simulation.bodies();
        for (found, exact) in [(bodies.angle[0], angle), (bodies.spin[0], rate)] {
            assert!((found - exact).abs() < 1e-11, "{clock}: {found} instead of {exact}");
        }
    }
}
