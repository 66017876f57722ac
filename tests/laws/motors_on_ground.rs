//! Laws of motors with a limit on wheels that touch the ground: torques keep to their limits, and work is booked.
//!
//! Not tested: motors without contacts, see `joint_motors`; the path of the wheels, which is chaotic.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

/// Stiffness of the wheels in N/m.
const STIFFNESS: f64 = 80e3;
/// Greatest torque of each motor in N m.
const LIMIT: f64 = 9.0;
/// Rate of the motors in rad/s and radius of the wheels in m.
const RATE: f64 = 16.0;
const RADIUS: f64 = 0.14;

/// A bar on two driven wheels, which hop over waves.
fn two_wheels(tick: f64) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 2.5, tick: {tick:?}, method: VelocityVerlet), gravity: (0, -9.81),
            materials: {{ \"ground\": (friction: 1, restitution: 0.1),
                \"rubber\": (stiffness: {STIFFNESS:?}, friction: 1, restitution: 0.3, density: 60) }},
            walls: [(name: \"ground\", heights: (of: \"0.2 * sin(2 * x)\", from: -4, to: 12, pieces: 100), material: \"ground\")],
            bodies: [(name: \"bar\", at: (0, 0.3), mass: 8, inertia: 0.4, collides: false, atoms: Disc(radius: 0.05)),
                (name: \"rear\", at: (-0.36, 0.3), material: \"rubber\", atoms: Disc(radius: {RADIUS})),
                (name: \"front\", at: (0.36, 0.3), material: \"rubber\", atoms: Disc(radius: {RADIUS}))],
            joints: [Revolute(name: \"r\", a: \"bar\", anchor_a: (-0.36, 0), b: \"rear\"),
                Revolute(name: \"f\", a: \"bar\", anchor_a: (0.36, 0), b: \"front\")],
            controllers: [Motor(name: \"rear_drive\", of: \"r\", speed: -{RATE:?}, limit: {LIMIT:?}),
                Motor(name: \"front_drive\", of: \"f\", speed: -{RATE:?}, limit: {LIMIT:?})])"
    );
    Simulation::load(&Source::new("wheels.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Law: a motor gives at most its limit in every tick, whatever contacts open, close, stick and slip beside it. Work and losses account
/// for all energy. Velocity Verlet misses a part of what a contact takes up in its first and last tick. The force there is `k v dt`
/// at most, over a way of `v dt`. So a touch misses up to `k v^2 dt^2`, and the residual is of order 2.
///
/// Tolerance: `v` is the speed of the rims, 2.24 m/s; no fall in this scene is faster. Some sixteen touches have errors of either sign, so
/// four of them remain. A motor impulse that the ledger leaves out misses `limit dt` times the rate. Contacts change in a share of all
/// ticks, so such an error is of order 0.
#[test]
fn motors_on_wheels_keep_to_their_limits_and_book_their_work() {
    let speed = RATE * RADIUS;
    for tick in [2e-4, 1e-4, 5e-5] {
        let mut simulation = two_wheels(tick);
        let drives = ["rear_drive.torque", "front_drive.torque"]
            .map(|name| jostle::sensors::find(simulation.world_mut(), name).expect("the channel is there"));
        let (mut bounded, mut held) = (0, 0);
        for number in 1..=(2.5 / tick).round() as u64 {
            simulation.run_to_tick(number).unwrap();
            for drive in &drives {
                let torque = simulation.value(drive).abs();
                assert!(torque <= LIMIT, "tick {tick}: {torque} N m at tick {number}");
                *(if torque == LIMIT { &mut bounded } else { &mut held }) += 1;
            }
        }
        // The scene has both: motors at their limits, and motors that hold their rates.
        assert!(bounded.min(held) * 4 > bounded.max(held), "tick {tick}: {bounded} and {held}");
        let energy = simulation.card().energy;
        let most = 4.0 * STIFFNESS * speed.powi(2) * tick.powi(2);
        assert!(energy.residual.abs() < most, "tick {tick}: {} J, {most} J at most", energy.residual);
        assert!(energy.work > 100.0 * most, "tick {tick}: {energy:?}");
    }
}

/// Law: friction takes what the work of the motor does not leave to the bodies, whatever ends a step. A ball falls on a roller that a motor with a
/// limit drives: the motor comes to its bound and off it while the ball slips. Tolerance: the fourth power of the tick over a touch, which lasts 6
/// ms, of the energy that changes form, for RungeKutta4; 1e-9 of it for Dop853.
#[test]
fn friction_is_booked_whole_where_a_motor_comes_to_its_limit() {
    for (clock, share) in [
        ("method: RungeKutta4, tick: \"50 us\"", (50e-6_f64 / 6e-3).powi(4)),
        ("method: RungeKutta4, tick: \"200 us\"", (200e-6_f64 / 6e-3).powi(4)),
        ("method: Dop853, tick: \"100 us\"", 1e-9),
    ] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 0.5, {clock}), gravity: (0, -9.81),
                materials: {{ \"default\": (stiffness: 1e5, friction: 0.4, restitution: 0.3) }},
                bodies: [(name: \"roll\", at: (0, 0), spin: 9.42, atoms: Disc(radius: 0.1, mass: 1)),
                    (name: \"ball\", at: (0.01, 0.25), atoms: Disc(radius: 0.1, mass: 2))],
                joints: [Revolute(name: \"hub\", a: World, anchor_a: (0, 0), b: \"roll\")],
                controllers: [Motor(of: \"hub\", speed: 9.42, limit: 6)])"
        );
        let mut simulation =
            Simulation::load(&Source::new("roller.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_end().unwrap();
        let energy = simulation.card().energy;
        assert!(energy.friction > 0.1, "{clock}: {energy:?}");
        let changed = energy.friction + energy.inelasticity;
        assert!(energy.residual.abs() < share * changed, "{clock}: {energy:?}");
    }
}
