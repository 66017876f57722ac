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

/// Law: what comes to rest on a limit, or hangs on a rope, rests there, however often it has come back: rebounds after `n` have `e^n` of
/// the speed, and are over after `t (1 + e)/(1 - e)`. It bears the weight. Tolerance of the place: rounding.
#[test]
fn what_comes_back_by_a_share_comes_to_rest_at_the_limit() {
    for method in METHODS {
        for (e, rests) in [(0.0, 0.5), (0.1, 0.5), (0.5, 0.7), (0.8, 2.0)] {
            let scene = format!(
                "gravity: (0, -10),
                 bodies: [(name: \"cabin\", at: (0, 1), mass: 2, atoms: Disc(radius: 0.1)),
                    (name: \"bob\", at: (1, -0.8), mass: 3, atoms: Disc(radius: 0.1)),
                    (name: \"arm\", at: (3, 0), mass: 1, inertia: 0.1, atoms: Disc(radius: 0.1))],
                 joints: [Prismatic(name: \"shaft\", a: World, anchor_a: (0, 0), b: \"cabin\", axis: (0, 1), limits: (0.9, 2), restitution: {e:?}),
                    Rope(name: \"rope\", a: World, anchor_a: (1, 0), b: \"bob\", length: 1, restitution: {e:?}),
                    Revolute(name: \"hip\", a: World, anchor_a: (2.5, 0), b: \"arm\", anchor_b: (-0.5, 0), limits: (-0.2, 1), restitution: {e:?})],
                 sensors: [Joint(of: \"*\")]"
            );
            let mut simulation = load(method, &scene);
            for time in [rests, 5.0] {
                run_to(&mut simulation, time);
                let of = format!("{method}, restitution {e}, {time} s");
                let bodies = simulation.bodies();
                for body in 0..3 {
                    assert_eq!(bodies.velocity[body].length() + bodies.spin[body].abs(), 0.0, "{of}: {body}");
                }
                near(bodies.position[0].y, 0.9, 1e-15, &of);
                near(bodies.position[1].y, -1.0, 1e-15, &of);
                near(bodies.angle[2], -0.2, 1e-15, &of);
                for (name, force) in [("shaft.force.y", 20.0), ("rope.force.y", 30.0)] {
                    let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the channel is there");
                    near(simulation.value(&channel), force, 1e-12, &of);
                }
            }
        }
    }
}

/// Law: rebounds that last for many ticks keep their heights, `e^(2 n) h`: only those end that are over within a tick. Tolerance: each
/// arrival is seen within a tick, `v TICK` too far.
#[test]
fn rebounds_that_ticks_can_see_are_not_cut_short() {
    for method in METHODS {
        let scene = "gravity: (0, -10), bodies: [(name: \"cabin\", at: (0, 1), mass: 2, atoms: Disc(radius: 0.1))],
            joints: [Prismatic(a: World, anchor_a: (0, 0), b: \"cabin\", axis: (0, 1), limits: (0.2, 2), restitution: 0.5)]";
        let mut simulation = load(method, scene);
        let mut tops = Vec::new();
        let mut before = 0.0;
        for tick in 0..1240 {
            simulation.run_to_tick(tick).unwrap();
            let rate = simulation.bodies().velocity[0].y;
            if before > 0.0 && rate <= 0.0 {
                tops.push(simulation.bodies().position[0].y - 0.2);
            }
            before = rate;
        }
        for (n, top) in (1..=4).zip(&tops) {
            let exact = 0.8 * 0.25_f64.powi(n);
            let speed = 4.0 * 0.5_f64.powi(n - 1);
            near(*top, exact, 2.0 * speed * TICK, &format!("{method}, rebound {n}"));
        }
        assert!(tops.len() >= 4, "{method}: {tops:?}");
    }
}

/// Law: what is pushed against a limit that gives back all speed stays there too, if it comes to it slower than ticks can see. A cart leans
/// on its limit, 0.2 m/s2, at first with less than what a tick adds; and a ball that falls from far comes back to its height. Tolerance of
/// the height: arrivals are seen within a tick.
#[test]
fn a_limit_that_gives_back_all_speed_is_not_passed() {
    for method in METHODS {
        let scene = "gravity: (0.2, -10),
            bodies: [(name: \"cart\", at: (-1e-8, 0), mass: 1, atoms: Disc(radius: 0.1)),
                (name: \"ball\", at: (2, 1), mass: 2, atoms: Disc(radius: 0.1))],
            joints: [Prismatic(a: World, anchor_a: (0, 0), b: \"cart\", axis: (1, 0), limits: (-1, 0), restitution: 1),
                Prismatic(a: World, anchor_a: (2, 0), b: \"ball\", axis: (0, 1), limits: (0.5, 2), restitution: 1)]";
        let mut simulation = load(method, scene);
        let mut top = 0.0_f64;
        for tick in (0..5000).step_by(5) {
            simulation.run_to_tick(tick).unwrap();
            let bodies = simulation.bodies();
            assert!(bodies.position[0].x < 0.2 * TICK * TICK, "{method}: {} m at tick {tick}", bodies.position[0].x);
            if tick > 4300 {
                top = top.max(bodies.position[1].y);
            }
        }
        near(simulation.bodies().position[0].x, 0.0, 0.2 * TICK * TICK, method);
        // Eight arrivals at 3.2 m/s.
        near(top, 1.0, 8.0 * 3.2 * TICK, method);
    }
}

/// Law: what stands at its limit at the start and is pressed against it stays there from the first tick on, whatever the restitution.
#[test]
fn what_begins_at_rest_at_a_limit_stays() {
    for method in METHODS {
        for e in [0.0, 0.5, 1.0] {
            let scene = format!(
                "gravity: (0, -10),
                 bodies: [(name: \"cabin\", at: (0, 1), mass: 2, atoms: Disc(radius: 0.1)),
                    (name: \"bob\", at: (1, -1), mass: 3, atoms: Disc(radius: 0.1))],
                 joints: [Prismatic(a: World, anchor_a: (0, 0), b: \"cabin\", axis: (0, 1), limits: (1, 2), restitution: {e:?}),
                    Rope(a: World, anchor_a: (1, 0), b: \"bob\", restitution: {e:?})]"
            );
            let mut simulation = load(method, &scene);
            for tick in 0..100 {
                simulation.run_to_tick(tick).unwrap();
                let places = simulation.bodies().position[..2].iter().map(|place| place.y).collect::<Vec<_>>();
                assert_eq!(places, [1.0, -1.0], "{method}, restitution {e}, tick {tick}");
            }
            assert_eq!(simulation.card().energy.inelasticity, 0.0, "{method}");
        }
    }
}

const ALL_METHODS: [(&str, bool); 4] =
    [("VelocityVerlet", false), ("SemiImplicitEuler", false), ("RungeKutta4", true), ("Dop853", true)];

/// Law: a limit that holds gives no impulse that pulls. A cart with a pole runs into its stop at `V`, and the pole leans on its limit, pressed by a
/// torque. The stop gives the pole the rate `m l sin(a) V / (I + m l^2)` away from its limit; then the torque slows it evenly. Tolerance: from
/// tick to tick what the torque changes in two ticks; else rounding of the event.
#[test]
fn a_limit_that_holds_does_not_pull_in_a_blow() {
    let (mass, length, inertia, angle, torque) = (0.5, 0.6, 0.06, 1.2_f64, 0.5);
    let about_pin = inertia + mass * length * length;
    for (method, located) in ALL_METHODS {
        let scene = format!(
            "bodies: [(name: \"cart\", at: (0, 0), velocity: (-1, 0), mass: 1, atoms: Disc(radius: 0.05)),
                (name: \"pole\", at: ({:?}, {:?}), angle: {angle:?}, velocity: (-1, 0), mass: {mass:?}, inertia: {inertia:?},
                    atoms: Disc(radius: 0.03))],
            joints: [Prismatic(a: World, b: \"cart\", axis: (1, 0), limits: (-0.1, 1)),
                Revolute(name: \"pin\", a: \"cart\", anchor_a: (0, 0), b: \"pole\", anchor_b: (-{length:?}, 0), limits: (1.2, 3))],
            controllers: [Actuator(of: \"pin\", force: -{torque:?})]",
            length * angle.cos(),
            length * angle.sin()
        );
        let mut simulation = load(method, &scene);
        run_to(&mut simulation, 0.15);
        let exact = mass * length * angle.sin() / about_pin - torque / about_pin * 0.05;
        let tolerance = if located { 1e-9 } else { 2.0 * TICK * torque / about_pin };
        near(simulation.bodies().spin[1], exact, tolerance, method);
        near(simulation.bodies().velocity[0].x, 0.0, 1e-15, method);
    }
}

/// Law: a ball swings on one rope until a second one becomes taut. The blow takes the velocity along the second rope, and the first goes
/// slack: it cannot push. The loss is `m (v n)^2 / 2`. Tolerance: from tick to tick the way of a tick, over which `v n` changes by less than
/// its share of the length; else rounding of the event.
#[test]
fn a_taut_rope_does_not_push_in_a_blow() {
    let (first, second, long, short) = ((0.0, 0.0), (-0.5, -0.6), 1.0, 0.9);
    // The angle from straight down at which the ball, on its circle, is as far from the second anchor as that rope is long.
    let place = |angle: f64| (long * angle.sin(), -long * angle.cos());
    let room = |angle: f64| short - (place(angle).0 - second.0).hypot(place(angle).1 - second.1);
    let (mut low, mut high) = (-0.6_f64, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if room(middle) > 0.0 { &mut low } else { &mut high }) = middle;
    }
    let (x, y) = place(low);
    let speed = (2.0 * 9.81 * (-0.8 - y)).sqrt();
    let velocity = (speed * low.cos(), speed * low.sin());
    let along = (velocity.0 * (x - second.0) + velocity.1 * (y - second.1)) / short;
    for (method, located) in ALL_METHODS {
        let scene = format!(
            "gravity: (0, -9.81), bodies: [(name: \"ball\", at: (-0.6, -0.8), mass: 1, atoms: Disc(radius: 0.03))],
            joints: [Rope(a: World, anchor_a: {first:?}, b: \"ball\", length: {long:?}),
                Rope(a: World, anchor_a: {second:?}, b: \"ball\", length: {short:?})]"
        );
        let mut simulation = load(method, &scene);
        run_to(&mut simulation, 0.9);
        let lost = simulation.card().energy.inelasticity;
        let tolerance = if located { 1e-9 } else { 4.0 * along * speed * speed * TICK / short };
        near(lost, 0.5 * along * along, tolerance, method);
    }
}
