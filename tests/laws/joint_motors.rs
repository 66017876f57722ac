//! Laws of motors with a greatest torque: they hold their rate as long as the torque suffices, and yield otherwise. A
//! mechanism may have any number of them, of limits and of joints with friction.
//!
//! Reference values: closed forms, or one equation for the one angle that is free (Lagrange), integrated here by the classical Runge-Kutta
//! method in steps of 1e-5 s, whose error is below 1e-9. Tolerance: methods from tick to tick see at the end of a tick that a motor
//! reaches its rate or leaves its bound, so that torques are wrong for one tick at each change. Not tested: contacts.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

const METHODS: [&str; 5] = ["VelocityVerlet", "SemiImplicitEuler", "RungeKutta4", "Dop853", "Symplectic4"];
const TICK: f64 = 1e-3;

fn run(method: &str, scene: &str) -> Simulation {
    let clock = format!("format: 1, clock: (duration: 1, tick: {TICK:?}, method: {method}), contacts: None");
    let source = Source::new("motors.ron", format!("Scene({clock}, {scene})"));
    let mut simulation = Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{method}: {failure}"));
    simulation
}

#[track_caller]
fn near(found: f64, exact: f64, tolerance: f64, of: &str) {
    assert!((found - exact).abs() <= tolerance, "{of}: {found} instead of {exact}, off by {:e}", found - exact);
}

/// Law: a motor without a limit drives a wheel at 2 rad/s from the start, against a motor that asks for 1 rad/s with 3 N m at most, and
/// friction of 2 N m. Both give all they have: friction takes 4 W, the motors put in as much. Tolerance: rounding.
#[test]
fn a_motor_with_a_limit_gives_way_to_one_without() {
    for method in METHODS {
        let simulation = run(
            method,
            "bodies: [(name: \"wheel\", at: (0, 0), mass: 1, inertia: 0.3, atoms: Disc(radius: 0.1))],
             joints: [Revolute(name: \"hub\", a: World, b: \"wheel\", friction: 2)],
             controllers: [Motor(of: \"hub\", speed: 2), Motor(of: \"hub\", speed: 1, limit: 3)]",
        );
        near(simulation.bodies().angle[0], 2.0, 1e-12, method);
        let energy = simulation.card().energy;
        near(energy.friction, 4.0, 1e-11, method);
        near(energy.work, 4.0, 1e-11, method);
    }
}

/// Radius of the crank in m, square of the length of the rod in m2, greatest force of the motor of the slide in N.
const CRANK: f64 = 0.1;
const ROD_SQUARED: f64 = 0.17;
const BRAKE: f64 = 0.5;

fn slider_crank(spin: f64, controllers: &str) -> String {
    format!(
        "bodies: [(name: \"crank\", at: (0, {CRANK}), angle: \"90 deg\", spin: {spin:?}, mass: 1, inertia: 0.01, atoms: Disc(radius: 0.02)),
            (name: \"piston\", at: (0.4, 0), mass: 1, atoms: Disc(radius: 0.05))],
         joints: [Revolute(name: \"hub\", a: World, anchor_a: (0, 0), b: \"crank\", anchor_b: (-{CRANK}, 0)),
            Distance(name: \"rod\", a: \"crank\", b: \"piston\"),
            Prismatic(name: \"slide\", a: World, b: \"piston\", axis: (1, 0))],
         controllers: [{controllers}]"
    )
}

/// The place of the piston at an angle of the crank, its derivative and the second one: `r cos a + sqrt(l^2 - r^2 sin^2 a)`.
fn piston(angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let rod = (ROD_SQUARED - (CRANK * sin).powi(2)).sqrt();
    let slope = -CRANK * sin - CRANK * CRANK * sin * cos / rod;
    let bend = -CRANK * cos
        - CRANK * CRANK * (cos * cos - sin * sin) / rod
        - CRANK.powi(4) * (sin * cos).powi(2) / rod.powi(3);
    [CRANK * cos + rod, slope, bend]
}

/// Angle of the crank in rad and energy in J that the motor of the slide took after one second, where a torque in N m drives the hub until
/// it has a spin in rad/s, which is held from then on.
fn truth(mut spin: f64, torque: f64, held: f64) -> (f64, f64) {
    let rates = |[angle, spin, _]: [f64; 3]| {
        let [_, slope, bend] = piston(angle);
        let brake = BRAKE * (slope * spin).signum();
        let inertia = 0.01 + CRANK * CRANK + slope * slope;
        let holds = spin >= held;
        let angular = (torque - slope * bend * spin * spin - brake * slope) / inertia;
        [spin, if holds { 0.0 } else { angular }, brake * slope * spin]
    };
    // The joints leave 0.01 kg m2 of 0.03 kg m2.
    spin *= 0.01 / (0.01 + CRANK * CRANK + piston(std::f64::consts::FRAC_PI_2)[1].powi(2));
    let mut state = [std::f64::consts::FRAC_PI_2, spin, 0.0];
    let h = 1e-5;
    for _ in 0..100_000 {
        let plus = |rates: [f64; 3], share: f64| std::array::from_fn(|at| state[at] + share * h * rates[at]);
        let first = rates(state);
        let second = rates(plus(first, 0.5));
        let third = rates(plus(second, 0.5));
        let fourth = rates(plus(third, 1.0));
        state = std::array::from_fn(|at| {
            state[at] + h / 6.0 * (first[at] + 2.0 * second[at] + 2.0 * third[at] + fourth[at])
        });
    }
    (state[0] - std::f64::consts::FRAC_PI_2, state[2])
}

/// Law: a motor that asks for a standing slide and has a limit is a brake: it turns round with the slide at dead points, and does not
/// stop the crank there. Tolerance: it is wrong for one tick at each turn.
#[test]
fn a_motor_of_no_speed_brakes_as_friction_does() {
    let (turned, took) = truth(6.0, 0.0, f64::INFINITY);
    for method in METHODS {
        let simulation = run(method, &slider_crank(6.0, "Motor(of: \"slide\", speed: 0, limit: 0.5)"));
        let staged = !["VelocityVerlet", "SemiImplicitEuler"].contains(&method);
        let found = simulation.bodies().angle[0] - std::f64::consts::FRAC_PI_2;
        near(found, turned, if staged { 1e-7 } else { 2.0 * TICK }, method);
        let energy = simulation.card().energy;
        near(energy.work, -took, if staged { 1e-8 } else { BRAKE * 0.3 * TICK }, method);
        assert_eq!(energy.friction, 0.0, "{method}");
    }
}

/// Law: two motors with limits in one mechanism: that of the hub, 1 N m, speeds the crank up to 6 rad/s and holds that against the motor of
/// the slide, 0.5 N, which asks for 0.1 m/s, then for a standing slide. Tolerance: the hub reaches its rate within a tick, `T dt/I` too fast
/// for that tick, and the slide turns round within one; under semi-implicit Euler the speed-up is of order one.
#[test]
fn two_motors_with_limits_share_a_mechanism() {
    let (turned, took) = truth(0.0, 1.0, 6.0);
    for method in METHODS {
        let scene =
            slider_crank(0.0, "Motor(of: \"hub\", speed: 6, limit: 1), Motor(of: \"slide\", speed: 0, limit: 0.5)");
        let simulation = run(method, &scene);
        let found = simulation.bodies().angle[0] - std::f64::consts::FRAC_PI_2;
        near(found, turned, 6.0 * TICK, method);
        near(simulation.bodies().spin[0], 6.0, 1e-9, method);
        let energy = simulation.card().energy;
        // At 6 rad/s the piston has 0.18 J and the crank as much.
        near(energy.residual, 0.0, 0.72 * 6.0 * TICK, method);
        let kinetic = energy.kinetic;
        assert!(
            took > 0.0 && energy.work > 0.9 * kinetic,
            "{method}: {} J of work, {kinetic} J of motion",
            energy.work
        );
        // Other rates that the two ask for change nothing of that: the slide gives all it has, one way or the other.
        for (hub, slide) in
            [("speed: 6, limit: 2", "speed: 0.1, limit: 3"), ("speed: 6, limit: 2", "speed: -0.6, limit: 0.2")]
        {
            let controllers = format!("Motor(of: \"hub\", {hub}), Motor(of: \"slide\", {slide})");
            let simulation = run(method, &slider_crank(0.0, &controllers));
            assert!(simulation.card().energy.residual.abs() < 0.72 * 6.0 * TICK * 2.0, "{method}, {slide}");
        }
    }
}

/// Law: a motor that is stronger than all else stands against a stop, among motors and friction on the same cart, and the stop holds. The
/// cart of 4 kg is at 1 m/s within a tick, and the stop takes all of it: 2 J, and 0.5 I w^2 of no wheel.
#[test]
fn a_strong_motor_does_not_push_through_a_stop() {
    for method in METHODS {
        for (limit, restitution) in [(5000.0, 0.3), (20.0, 0.3), (5000.0, 0.0), (20.0, 1.0)] {
            let scene = format!(
                "bodies: [(name: \"cart\", at: (0, 0), mass: 2, inertia: 0.2, atoms: Disc(radius: 0.1)),
                    (name: \"w\", at: (0.3, 0), mass: 1, inertia: 0.05, atoms: Disc(radius: 0.1)),
                    (name: \"v\", at: (-0.3, 0), mass: 1, inertia: 0.05, atoms: Disc(radius: 0.1))],
                 joints: [Prismatic(name: \"r\", a: World, b: \"cart\", axis: (1, 0), limits: (-0.5, 0.2), restitution: {restitution:?}),
                    Revolute(name: \"hw\", a: \"cart\", b: \"w\", anchor_a: (0.3, 0), friction: 0.1),
                    Revolute(name: \"hv\", a: \"cart\", b: \"v\", anchor_a: (-0.3, 0), friction: 0.2)],
                 controllers: [Motor(of: \"r\", speed: 1, limit: {limit:?}), Motor(of: \"hw\", speed: 10, limit: 1000),
                    Motor(of: \"hv\", speed: -10, limit: 0.1)]"
            );
            let simulation = run(method, &scene);
            let (bodies, of) = (simulation.bodies(), format!("{method}, limit {limit}, restitution {restitution}"));
            assert!(bodies.position[0].x <= 0.2 + TICK, "{of}: the cart is at {} m", bodies.position[0].x);
            if restitution < 1.0 {
                near(bodies.position[0].x, 0.2, 1e-12, &of);
            }
            near(bodies.spin[1], 10.0, 1e-9, &of);
            near(bodies.spin[2], 0.0, 1e-12, &of);
        }
    }
}

/// Law: a motor that reaches its rate within its first tick puts in the energy of that, once: `I w^2/2`, and as much again for what the
/// grip takes, which counts as its work. Tolerance: rounding.
#[test]
fn a_motor_that_is_at_its_rate_at_once_puts_in_its_energy() {
    for method in ["VelocityVerlet", "SemiImplicitEuler"] {
        let simulation = run(
            method,
            "bodies: [(name: \"arm\", at: (0.5, 0), mass: 1, inertia: 0.08, atoms: Disc(radius: 0.1))],
             joints: [Revolute(name: \"h\", a: World, anchor_a: (0, 0), b: \"arm\", anchor_b: (-0.5, 0), limits: (-1, 1))],
             controllers: [Motor(of: \"h\", speed: 0.1, limit: 40)]",
        );
        near(simulation.bodies().spin[0], 0.1, 1e-14, method);
        let energy = simulation.card().energy;
        near(energy.work, 0.5 * (0.08 + 0.25) * 0.01, 1e-12, method);
        near(energy.residual, 0.0, 1e-12, method);
    }
}
