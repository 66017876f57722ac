//! Laws of limits, ropes, friction in joints, joints that break, and soft ones.
//!
//! Reference values: closed forms, given at each test. Tolerances: where events are located, 1e-11 of numbers near one: a step's error of
//! `Dop853` and the rounding of the event's time. Under velocity Verlet events count at the ends of ticks, so errors are of the size of
//! what passes within a tick. Not tested: contacts.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

const METHODS: [(&str, f64); 2] = [("Dop853", 1e-11), ("RungeKutta4", 1e-9)];

fn load(method: &str, tick: f64, scene: &str) -> Simulation {
    let scene =
        format!("Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: {method}), contacts: None, {scene})");
    Simulation::load_with(&Source::new("limits.ron", scene), &Overrides::default(), |_| {})
        .unwrap_or_else(|errors| panic!("{errors}"))
}

fn run_to(simulation: &mut Simulation, time: f64) {
    let tick = (time / simulation.clock().dt).round() as u64;
    simulation.run_to_tick(tick).unwrap();
}

fn channel(simulation: &mut Simulation, name: &str) -> f64 {
    let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the channel is there");
    simulation.value(&channel)
}

#[track_caller]
fn near(found: f64, exact: f64, tolerance: f64, of: &str) {
    assert!((found - exact).abs() <= tolerance, "{of}: {found} instead of {exact}");
}

fn lift(extra: &str) -> String {
    format!(
        "gravity: (0, -10), bodies: [(name: \"cabin\", at: (0, 1), velocity: (0, 0), mass: 2, atoms: Disc(radius: 0.1))],
         joints: [Prismatic(name: \"shaft\", a: World, anchor_a: (0, 0), b: \"cabin\", axis: (0, 1), {extra})]"
    )
}

/// A mass that falls onto a limit stays there: `t = sqrt(2 h/g)`, force `m g`, energy lost `m g h`.
#[test]
fn a_limit_takes_the_speed_and_bears_the_weight() {
    for (method, tolerance) in METHODS {
        let mut simulation = load(method, 0.01, &lift("limits: (0.2, 2)"));
        run_to(&mut simulation, 0.39);
        near(simulation.bodies().position[0].y, 1.0 - 5.0 * 0.39 * 0.39, tolerance, method);
        for time in [0.41, 1.0, 3.0] {
            run_to(&mut simulation, time);
            near(simulation.bodies().position[0].y, 0.2, tolerance, method);
            near(simulation.bodies().velocity[0].y, 0.0, tolerance, method);
            near(channel(&mut simulation, "shaft.force.y"), 20.0, 20.0 * tolerance, method);
        }
        let card = simulation.card();
        near(card.energy.inelasticity, 16.0, 16.0 * tolerance, method);
        near(card.energy.residual, 0.0, 16.0 * tolerance, method);
        assert!(card.momentum_residual[1].abs() < 1e-10, "{:?}", card.momentum_residual);
    }
}

/// The same from tick to tick: the last fall into the limit is seen at the end of a tick, and undone.
#[test]
fn a_limit_holds_from_tick_to_tick() {
    for method in ["VelocityVerlet", "SemiImplicitEuler"] {
        let mut simulation = load(method, 0.0001, &lift("limits: (0.2, 2)"));
        run_to(&mut simulation, 1.0);
        assert_eq!(simulation.bodies().velocity[0].y, 0.0, "{method}");
        near(simulation.bodies().position[0].y, 0.2, 1e-15, method);
        near(channel(&mut simulation, "shaft.force.y"), 20.0, 1e-12, method);
        let card = simulation.card();
        // Within a tick of 0.1 ms the cabin falls 0.4 mm.
        near(card.energy.inelasticity, 16.0, 20.0 * 0.0004, method);
        near(card.energy.residual, 0.0, 20.0 * 0.0004, method);
    }
}

/// Rebounds with `e v`: after the n-th the height is `h e^(2 n)`. The last of them end at rest after `t (1 + e)/(1 - e)`.
#[test]
fn a_limit_gives_back_a_share_of_the_speed() {
    for (method, tolerance) in METHODS {
        let mut simulation = load(method, 0.01, &lift("limits: (0.2, 2), restitution: 0.5"));
        // Arrival at 0.4 s with 4 m/s, back with 2 m/s until 0.8 s, back with 1 m/s until 1 s.
        for (time, height) in [(0.6, 0.2 + 0.2), (0.7, 0.2 + 0.2 - 0.05), (0.9, 0.2 + 0.05)] {
            run_to(&mut simulation, time);
            near(simulation.bodies().position[0].y, height, tolerance, &format!("{method} at {time} s"));
        }
        run_to(&mut simulation, 1.5);
        near(simulation.bodies().position[0].y, 0.2, tolerance, method);
        near(simulation.bodies().velocity[0].y, 0.0, 1e-12, method);
        near(simulation.card().energy.inelasticity, 16.0, 1e-9, method);
    }
}

/// A mass pushed against a limit by `F = A cos(w t)` leaves it at `t = pi/(2 w)`, and is then at
/// `x = A/(m w^2) (pi/2 - w t + ... )`: from `m x'' = A cos(w t)` with rest at `t0`.
#[test]
fn a_joint_leaves_its_limit_where_that_would_have_to_pull() {
    let scene = "bodies: [(name: \"cart\", at: (0.5, 0), mass: 2, atoms: Disc(radius: 0.1))],
        joints: [Prismatic(name: \"rail\", a: World, anchor_a: (0, 0), b: \"cart\", axis: (1, 0), limits: (-9, 0.5))],
        controllers: [Actuator(of: \"rail\", force: Sine(amplitude: 3, frequency: 0.5, phase: \"90 deg\"))]";
    for (method, tolerance) in [("Dop853", 1e-11), ("RungeKutta4", 1e-8)] {
        let mut simulation = load(method, 0.01, scene);
        run_to(&mut simulation, 0.5);
        near(simulation.bodies().position[0].x, 0.5, 1e-14, method);
        for time in [0.75, 1.0, 1.25] {
            run_to(&mut simulation, time);
            // w = pi, t0 = 0.5: v = A/(m w) (sin w t - 1), x = x0 + A/(m w^2) (-cos w t) - A/(m w) (t - t0).
            let exact = 0.5 - 1.5 / (PI * PI) * libm::cos(PI * time) - 1.5 / PI * (time - 0.5);
            near(simulation.bodies().position[0].x, exact, tolerance, &format!("{method} at {time} s"));
        }
    }
}

/// A slide with friction `F` stops after `t = m v/F` and stays; the heat is `m v^2/2`.
#[test]
fn friction_in_a_joint_stops_it_for_good() {
    let scene = "bodies: [(name: \"cart\", at: (0, 0), velocity: (2, 0), mass: 3, atoms: Disc(radius: 0.1))],
        joints: [Prismatic(name: \"rail\", a: World, b: \"cart\", axis: (1, 0), friction: 4)]";
    for (method, tolerance) in METHODS.into_iter().chain([("VelocityVerlet", 1e-3)]) {
        let mut simulation = load(method, 0.001, scene);
        run_to(&mut simulation, 0.9);
        near(simulation.bodies().position[0].x, 1.8 - 2.0 / 3.0 * 0.81, tolerance, method);
        run_to(&mut simulation, 4.0);
        near(simulation.bodies().position[0].x, 1.5, 2.0 * tolerance, method);
        assert_eq!(simulation.bodies().velocity[0].x, 0.0, "{method}");
        let card = simulation.card();
        near(card.energy.friction, 6.0, 6.0 * tolerance, method);
        near(card.energy.residual, 0.0, 6.0 * tolerance, method);
    }
}

/// A hinge that sticks lets go where the torque on it exceeds its bound: `A sin(w t) = bound`.
#[test]
fn friction_in_a_joint_sticks_until_its_bound() {
    let scene = "bodies: [(name: \"wheel\", at: (0, 0), mass: 1, inertia: 0.5, atoms: Disc(radius: 0.1))],
        joints: [Revolute(name: \"axle\", a: World, b: \"wheel\", friction: 0.3)],
        controllers: [Actuator(of: \"axle\", force: Sine(amplitude: 0.6, frequency: 0.25))]";
    for (method, tolerance) in [("Dop853", 1e-11), ("RungeKutta4", 1e-8)] {
        let mut simulation = load(method, 0.01, scene);
        run_to(&mut simulation, 0.33);
        assert_eq!(simulation.bodies().angle[0], 0.0, "{method}");
        run_to(&mut simulation, 1.0);
        // w = pi/2, t0 = 1/3: I w' = A sin(w t) - bound.
        let (w, t0, t) = (FRAC_PI_2, 1.0 / 3.0, 1.0);
        let exact = (0.6 / w * (libm::cos(w * t0) - libm::cos(w * t)) - 0.3 * (t - t0)) / 0.5;
        near(simulation.bodies().spin[0], exact, tolerance, method);
    }
}

/// A ball inside the reach of its rope falls freely; where the rope is taut it keeps the part of its velocity across the rope, and swings
/// on with that energy.
#[test]
fn a_rope_jerks_and_holds() {
    let scene = "gravity: (0, -10), bodies: [(name: \"ball\", at: (0.6, 0), mass: 2, atoms: Disc(radius: 0.05))],
        joints: [Rope(name: \"rope\", a: World, anchor_a: (0, 0), b: \"ball\", length: 1)]";
    for (method, tolerance) in METHODS {
        let mut simulation = load(method, 0.001, scene);
        run_to(&mut simulation, 0.4);
        near(simulation.bodies().position[0].y, -0.8, tolerance, method);
        // At (0.6, -0.8) with 4 m/s downwards; across the rope, direction (0.8, 0.6), are 2.4 m/s.
        run_to(&mut simulation, 0.401);
        let bodies = simulation.bodies();
        let speed = (2.4_f64.powi(2) - 20.0 * (bodies.position[0].y + 0.8)).sqrt();
        near(bodies.velocity[0].length(), speed, 1e-9, method);
        near(bodies.position[0].length(), 1.0, 1e-13, method);
        near(simulation.card().energy.inelasticity, 16.0 - 5.76, 1e-8, method);
        for time in [0.5, 0.6, 0.7] {
            run_to(&mut simulation, time);
            let bodies = simulation.bodies();
            let (position, velocity) = (bodies.position[0], bodies.velocity[0]);
            near(position.length(), 1.0, 1e-13, method);
            let pull = 2.0 * velocity.length_squared() - 20.0 * position.y;
            let force = channel(&mut simulation, "rope.force.x").hypot(channel(&mut simulation, "rope.force.y"));
            near(force, pull, 1e-9, method);
        }
    }
}

/// A rope that goes slack lets the ball fly: thrown at the bottom with `v^2 = 3.5 g l` it leaves the circle at `cos a = -(v^2/(g l) - 2)/3`.
#[test]
fn a_rope_goes_slack_where_its_pull_ends() {
    let speed = 35.0_f64.sqrt();
    let scene = format!(
        "gravity: (0, -10), bodies: [(name: \"ball\", at: (0, -1), velocity: ({speed:?}, 0), mass: 2, atoms: Disc(radius: 0.05))],
        joints: [Rope(name: \"rope\", a: World, anchor_a: (0, 0), b: \"ball\")]"
    );
    for (method, tolerance) in [("Dop853", 1e-10), ("RungeKutta4", 1e-7)] {
        let mut simulation = load(method, 0.002, &scene);
        let mut left = None;
        for tick in 1..400 {
            simulation.run_to_tick(tick).unwrap();
            let bodies = simulation.bodies();
            let (position, velocity) = (bodies.position[0], bodies.velocity[0]);
            if position.length() < 1.0 - 1e-4 {
                left = Some((position, velocity));
                break;
            }
        }
        let (position, velocity) = left.expect("the rope goes slack");
        // Free flight from (sin a, -cos a), cos a = -1/2, with v^2 = g l/2 along the tangent: back along the parabola by its height.
        let (start, begun) = (DVec2::new(0.75_f64.sqrt(), 0.5), 5.0_f64.sqrt() * DVec2::new(-0.5, 0.75_f64.sqrt()));
        near(velocity.x, begun.x, tolerance, method);
        let flown = (begun.y - velocity.y) / 10.0;
        near(position.x, start.x + begun.x * flown, tolerance, method);
        near(position.y, start.y + begun.y * flown - 5.0 * flown * flown, tolerance, method);
        near(simulation.card().energy.inelasticity, 0.0, 1e-9, method);
    }
}

/// A pendulum released level pulls its rod with `3 m g cos a`, with `a` from the vertical: one that bears `2 m g` breaks at `cos a = 2/3`.
#[test]
fn a_joint_breaks_at_its_force_in_the_midst_of_a_step() {
    let scene = "gravity: (0, -10), bodies: [(name: \"ball\", at: (1, 0), mass: 2, atoms: Disc(radius: 0.05))],
        joints: [Distance(name: \"rod\", a: World, anchor_a: (0, 0), b: \"ball\", break_force: 40)]";
    for (method, tolerance) in [("Dop853", 1e-10), ("RungeKutta4", 1e-6)] {
        let mut simulation = load(method, 0.02, scene);
        run_to(&mut simulation, 1.0);
        let bodies = simulation.bodies();
        let (cos, sin) = (2.0_f64 / 3.0, 5.0_f64.sqrt() / 3.0);
        let begun = (20.0 * cos).sqrt() * DVec2::new(-cos, -sin);
        near(bodies.velocity[0].x, begun.x, tolerance, method);
        let flown = (begun.y - bodies.velocity[0].y) / 10.0;
        near(bodies.position[0].x, sin + begun.x * flown, tolerance, method);
        near(bodies.position[0].y, -cos + begun.y * flown - 5.0 * flown * flown, tolerance, method);
        assert!(
            simulation.card().notes.iter().any(|note| note.contains("`rod` broke at")),
            "{:?}",
            simulation.card().notes
        );
    }
}

/// A bounded motor that drives an arm against its limit: both hold, the arm stands, and the motor gives its greatest torque.
#[test]
fn a_motor_stands_against_a_limit() {
    let scene = "bodies: [(name: \"arm\", at: (0, 0), mass: 1, inertia: 0.5, atoms: Disc(radius: 0.1))],
        joints: [Revolute(name: \"hip\", a: World, b: \"arm\", limits: (-1, 1))],
        controllers: [Motor(name: \"drive\", of: \"hip\", speed: 100, limit: 3)]";
    for method in ["Dop853", "RungeKutta4", "VelocityVerlet"] {
        let mut simulation = load(method, 0.001, scene);
        run_to(&mut simulation, 2.0);
        near(simulation.bodies().angle[0], 1.0, 1e-13, method);
        assert_eq!(simulation.bodies().spin[0], 0.0, "{method}");
        near(channel(&mut simulation, "drive.torque"), 3.0, 1e-12, method);
        near(channel(&mut simulation, "hip.torque"), -3.0, 1e-12, method);
        let card = simulation.card();
        near(card.energy.residual, 0.0, if method == "VelocityVerlet" { 0.02 } else { 1e-10 }, method);
    }
}

/// Restored in the midst of everything a run goes on to the same bits.
#[test]
fn snapshots_keep_the_modes_of_joints() {
    let scene = "gravity: (0, -10),
        bodies: [(name: \"bar\", at: (0.5, 0), mass: 2, inertia: 0.3, atoms: Disc(radius: 0.05)), (name: \"bob\", at: (1.2, 0.1), mass: 1, atoms: Disc(radius: 0.05))],
        joints: [Revolute(name: \"hip\", a: World, anchor_a: (0, 0), b: \"bar\", anchor_b: (-0.5, 0), limits: (\"-80 deg\", 1), restitution: 0.3, friction: 0.1),
                 Rope(a: \"bar\", anchor_a: (0.5, 0), b: \"bob\", length: 0.5, break_force: 60)]";
    for method in ["Dop853", "RungeKutta4", "VelocityVerlet"] {
        let mut simulation = load(method, 0.002, scene);
        let mut at = Vec::new();
        for tick in (0..1000).step_by(37) {
            simulation.run_to_tick(tick).unwrap();
            at.push(simulation.snapshot().unwrap());
        }
        simulation.run_to_tick(1000).unwrap();
        let hash = simulation.future_hash().unwrap();
        for snapshot in at {
            simulation.restore(&snapshot).unwrap();
            simulation.run_to_tick(1000).unwrap();
            assert_eq!(simulation.future_hash().unwrap(), hash, "{method}");
        }
    }
}

/// A soft rod swings about its length with its frequency and damping: `m x'' = -k x - c x'`, `k = m (2 pi f)^2`, here without gravity.
#[test]
fn a_soft_joint_is_a_damped_spring() {
    let scene = "bodies: [(name: \"ball\", at: (1.1, 0), mass: 2, atoms: Disc(radius: 0.05))],
        joints: [Distance(name: \"rod\", a: World, anchor_a: (0, 0), b: \"ball\", length: 1, softness: (2, 0.1))]";
    for (method, tolerance) in [("Dop853", 1e-11), ("RungeKutta4", 1e-7), ("VelocityVerlet", 1e-4)] {
        let mut simulation = load(method, 0.001, scene);
        let begun = simulation.bodies().position[0].x;
        near(begun, 1.1, 1e-15, method);
        run_to(&mut simulation, 0.7);
        let (angular, ratio) = (4.0 * PI, 0.1_f64);
        let damped = angular * (1.0 - ratio * ratio).sqrt();
        let decayed = 0.1 * libm::exp(-ratio * angular * 0.7);
        let exact = decayed * (libm::cos(damped * 0.7) + ratio * angular / damped * libm::sin(damped * 0.7));
        near(simulation.bodies().position[0].x, 1.0 + exact, tolerance, method);
        let card = simulation.card();
        near(card.energy.residual, 0.0, tolerance, method);
        assert!(card.energy.accounts["damping"] > 0.5, "{:?}", card.energy);
        // With damping velocity Verlet bears `2 (sqrt(1 + D^2) - D)/w`, or less.
        let bears = 2.0 * ((1.0 + ratio * ratio).sqrt() - ratio) / angular;
        let critical = card.critical_tick.unwrap_or(bears);
        assert!(method != "VelocityVerlet" || critical > 0.7 * bears && critical < 1.2 * bears, "{critical} {bears}");
        // The force on the ball is that of the spring and the dashpot.
        let bodies = simulation.bodies();
        let (x, v) = (bodies.position[0].x - 1.0, bodies.velocity[0].x);
        let force = -2.0 * (angular * angular * x + 2.0 * ratio * angular * v);
        near(channel(&mut simulation, "rod.force.x"), force, 1e-3, method);
    }
}

/// Law: soft joints between two free bodies of unlike mass, struck and damped, keep momentum and angular momentum however far they open, and
/// what their dashpots take is booked. Tolerance: rounding of a thousand steps; Runge-Kutta methods keep angular momentum, a quadratic invariant,
/// to their error, which for springs of 2 Hz is `(4 pi dt)^4` under `RungeKutta4`.
#[test]
fn soft_joints_keep_angular_momentum() {
    for joint in ["Weld(a: \"a\", b: \"b\", softness: (1, 0.2))", "Revolute(a: \"a\", b: \"b\", softness: (2, 0.3))"] {
        let scene = format!(
            "bodies: [(name: \"a\", at: (0, 0), mass: 1, inertia: 0.1, atoms: Disc(radius: 0.1)),
                (name: \"b\", at: (0.5, 0.1), mass: 2, inertia: 0.3, velocity: (1, 1), spin: 2, atoms: Disc(radius: 0.1))],
             joints: [{joint}]"
        );
        for method in ["Dop853", "RungeKutta4", "VelocityVerlet"] {
            let mut simulation = load(method, 0.001, &scene);
            run_to(&mut simulation, 1.0);
            let card = simulation.card();
            let kept = if method == "RungeKutta4" { (4.0 * PI * 0.001).powi(4) } else { 1e-12 };
            near(card.angular_momentum_residual, 0.0, kept, &format!("{method}, {joint}"));
            near(card.momentum_residual[0].hypot(card.momentum_residual[1]), 0.0, 1e-12, method);
            assert!(card.energy.accounts["damping"] > 0.05, "{:?}", card.energy);
            // Some 2 J.
            let kept = if method == "VelocityVerlet" { 1e-3 } else { 2.0 * kept.max(1e-10) };
            near(card.energy.residual, 0.0, kept, method);
        }
    }
}

/// Slack again, a rope pulls nothing.
#[test]
fn a_slack_rope_has_no_force() {
    let scene = "gravity: (0, -10), bodies: [(name: \"ball\", at: (0, -0.5), velocity: (0, -1), mass: 2, atoms: Disc(radius: 0.05))],
        joints: [Rope(name: \"rope\", a: World, anchor_a: (0, 0), b: \"ball\", length: 1, restitution: 0.8)]";
    for method in ["Dop853", "VelocityVerlet"] {
        let mut simulation = load(method, 0.001, scene);
        for tick in (1..600).step_by(7) {
            simulation.run_to_tick(tick).unwrap();
            if simulation.bodies().position[0].y > -0.999 {
                assert_eq!(channel(&mut simulation, "rope.force.y"), 0.0, "{method} at tick {tick}");
            }
        }
    }
}

/// What friction, limits and ropes of a bridge take is booked, from tick to tick as well: a chain of planks with friction in its hinges
/// falls into its rope. Tolerance: the share of a tick in the second that the fall takes.
#[test]
fn a_jerk_among_joints_that_stick_is_booked() {
    let scene = "gravity: (0, -9.81),
        bodies: [Repeat(count: 8, make: (name: \"plank_{i}\", at: (\"0.2 + 0.4 * i\", 0), mass: 1, inertia: 0.014, atoms: Disc(radius: 0.05)))],
        joints: [Revolute(a: World, anchor_a: (0, 0), b: \"plank_0\", anchor_b: (-0.2, 0), friction: 0.5),
            Repeat(count: 7, make: Revolute(name: \"p_{i}\", a: \"plank_{i}\", anchor_a: (0.2, 0), b: \"plank_{i + 1}\", anchor_b: (-0.2, 0), friction: 0.5)),
            Rope(a: \"plank_7\", anchor_a: (0.2, 0), b: World, anchor_b: (3.4, 0), length: 0.4)]";
    let residual = |method: &str, tick: f64| {
        let mut simulation = load(method, tick, scene);
        run_to(&mut simulation, 3.0);
        let card = simulation.card();
        assert!(card.energy.friction > 1.0 && card.energy.inelasticity > 1.0, "{method}: {:?}", card.energy);
        card.energy.residual.abs() / (card.energy.friction + card.energy.inelasticity)
    };
    assert!(residual("Dop853", 0.002) < 1e-9, "{}", residual("Dop853", 0.002));
    for tick in [0.001, 0.00025] {
        let found = residual("VelocityVerlet", tick);
        assert!(found < tick, "{found} with ticks of {tick} s");
    }
}
