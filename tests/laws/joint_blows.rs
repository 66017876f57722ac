//! Laws of blows at limits and at taut ropes from tick to tick, among joints with friction and motors with a limit.
//!
//! Reference values: closed forms, given at each test. Tolerance: methods from tick to tick see an arrival at the end of a tick, so that
//! places are off by the way of a tick before and after the blow, and speeds by what forces change in a tick. What rests is exact but for
//! rounding. Not tested: contacts, and where inside a tick a blow falls.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

const METHODS: [&str; 2] = ["VelocityVerlet", "SemiImplicitEuler"];
const TICK: f64 = 1e-3;

fn load(method: &str, scene: &str) -> Simulation {
    let clock = format!("format: 1, clock: (duration: 5, tick: {TICK:?}, method: {method}), contacts: None");
    let source = Source::new("blows.ron", format!("Scene({clock}, {scene})"));
    Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"))
}

fn run_to(simulation: &mut Simulation, time: f64) {
    let tick = (time / TICK).round() as u64;
    simulation.run_to_tick(tick).unwrap_or_else(|failure| panic!("{failure}"));
}

#[track_caller]
fn near(found: f64, exact: f64, tolerance: f64, of: &str) {
    assert!((found - exact).abs() <= tolerance, "{of}: {found} instead of {exact}, off by {:e}", found - exact);
}

/// Law: a blow at a limit turns round all that hangs together, the joint with friction too, whose force turns with it. Two slides with a
/// rod, 2 kg together, come at 2 m/s and are slowed by 0.1 N, 0.05 m/s2. The limit of the one, after 0.3 m, gives back the share `e`
/// of `v = sqrt(4 - 2 a 0.3)`. Two wheels with gears, 0.1 + 4 0.2 = 0.9 kg m2 as the first sees it, likewise under 2 0.045 N m.
#[test]
fn a_blow_turns_round_a_joint_with_friction() {
    let slides = |e: f64| {
        format!(
            "bodies: [(name: \"p\", at: (0, 0), velocity: (2, 0), mass: 1, atoms: Disc(radius: 0.05)),
                (name: \"q\", at: (1, 0), velocity: (2, 0), mass: 1, atoms: Disc(radius: 0.05))],
             joints: [Prismatic(a: World, b: \"p\", axis: (1, 0), friction: 0.1), Distance(a: \"p\", b: \"q\"),
                Prismatic(a: World, b: \"q\", axis: (1, 0), limits: (-9, 0.3), restitution: {e:?})]"
        )
    };
    let wheels = |e: f64| {
        format!(
            "bodies: [(name: \"a\", at: (0, 0), spin: 2, mass: 1, inertia: 0.1, atoms: Disc(radius: 0.1)),
                (name: \"b\", at: (1, 0), spin: -4, mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
             joints: [Revolute(name: \"h\", a: World, b: \"a\", limits: (-9, 0.3), restitution: {e:?}),
                Revolute(name: \"k\", a: World, b: \"b\", friction: 0.0225), GearPair(of: (\"h\", \"k\"), ratio: -2)]"
        )
    };
    for method in METHODS {
        for e in [1.0, 0.5, 0.2] {
            let slowed = 0.05_f64;
            let arrival = (4.0 - 2.0 * slowed * 0.3).sqrt();
            let (before, time) = ((2.0 - arrival) / slowed, 1.0);
            let after = time - before;
            let (speed, way) = (e * arrival - slowed * after, e * arrival * after - 0.5 * slowed * after * after);
            for (name, scene, mass) in [("slides", slides(e), 2.0), ("wheels", wheels(e), 0.9)] {
                let of = format!("{name} with {method}, restitution {e}");
                let mut simulation = load(method, &scene);
                run_to(&mut simulation, time);
                let bodies = simulation.bodies();
                let (place, rate) = match name {
                    "slides" => (bodies.position[0].x, bodies.velocity[0].x),
                    _ => (bodies.angle[0], bodies.spin[0]),
                };
                near(rate, -speed, 2.0 * slowed * TICK, &of);
                near(place, 0.3 - way, (1.0 + e) * arrival * TICK, &of);
                let energy = simulation.card().energy;
                // Friction is wrong for the tick of the blow, and the arrival by as much.
                let off = 2.0 * mass * slowed * arrival * TICK;
                near(energy.inelasticity, 0.5 * mass * (1.0 - e * e) * arrival * arrival, off, &of);
                near(energy.friction, mass * slowed * (0.3 + way), off, &of);
                near(energy.residual, 0.0, off, &of);
            }
        }
    }
}
