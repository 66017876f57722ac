//! Forces in sensors: accelerations by all forces of the current state, joints among them.
//!
//! Source: Newton's law; a rod of length `l` that is let go level about its end begins with `3 g/(2 l)` (Goldstein, section 5.7). Tolerance:
//! rounding. Not tested: bodies that rest in contact.

use jostle::Simulation;
use jostle::SimulationExt;
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

/// A block on a floor, held by a spring and by a rod, pulls on what it is held by: the parts of the force add up to its mass times its
/// acceleration (Newton 1687), as nothing else acts on it. A sled on a slide is pushed by an actuator: that counts to joints.
#[test]
fn the_parts_of_a_force_add_up_to_all_of_it() {
    let scene = |method: &str| {
        format!(
            "Scene(format: 1, clock: (duration: 10, tick: \"0.5 ms\", method: {method}), gravity: (1, -9.81),
             materials: {{\"default\": (stiffness: 3000, restitution: 0.5, friction: 0.3)}},
             walls: [(name: \"floor\", left: (5, 0), right: (-5, 0))],
             bodies: [(name: \"block\", at: (0.3, 0.11), velocity: (0.5, -1), mass: 2, atoms: Disc(radius: 0.1)),
                (name: \"bob\", at: (0.3, 0.6), mass: 1, atoms: Disc(radius: 0.1)),
                (name: \"sled\", at: (-3, 2), mass: 4, atoms: Disc(radius: 0.1))],
             forces: [Spring(a: \"block\", b: World, anchor_b: (-0.3, 0.5), stiffness: 200, length: 0.3, damping: 2)],
             joints: [Distance(a: \"block\", b: \"bob\", length: 0.49),
                Prismatic(name: \"slide\", a: World, b: \"sled\", axis: (1, 0))],
             controllers: [Actuator(of: \"slide\", force: 12)],
             sensors: [Force(of: \"*\"), Force(of: \"block\", part: Weight), Force(of: \"block\", part: Contact),
                Force(of: \"block\", part: Spring), Force(of: \"block\", part: Joint)])"
        )
    };
    for method in ["VelocityVerlet", "RungeKutta4"] {
        let mut simulation =
            Simulation::load(&Source::new("parts.ron", scene(method))).unwrap_or_else(|e| panic!("{e}"));
        let mut touched = 0;
        for tick in (5..=400).step_by(5) {
            simulation.run_to_tick(tick).unwrap();
            let mut read = |name: &str| {
                let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the channel is there");
                simulation.value(&channel)
            };
            for axis in ["x", "y"] {
                let parts = ["weight", "contact_force", "spring_force", "joint_force"];
                let parts = parts.map(|part| read(&format!("block.{part}.{axis}")));
                let (sum, total) = (parts.iter().sum::<f64>(), read(&format!("block.total_force.{axis}")));
                assert!(
                    (sum - total).abs() < 1e-11 * 100.0,
                    "{method}, tick {tick}: {parts:?} make {sum}, not {total}"
                );
                assert!(parts[2] != 0.0 && parts[3] != 0.0, "{method}: spring and rod pull");
                touched += usize::from(parts[1] != 0.0);
            }
            assert_eq!([read("block.weight.x"), read("block.weight.y")], [2.0, -2.0 * 9.81]);
            // The slide bears the weight, and the actuator pushes.
            assert!(
                (read("sled.joint_force.x") - 12.0).abs() < 1e-12
                    && (read("sled.joint_force.y") - 4.0 * 9.81).abs() < 1e-11
            );
            assert!((read("sled.total_force.x") - 16.0).abs() < 1e-12 && read("sled.total_force.y").abs() < 1e-11);
        }
        assert!(touched > 4, "{method}: the block touches the floor now and then");
    }
}

/// Law: a pendulum let go at 90 degrees has the period `4 sqrt(l/g) K(1/sqrt 2)` with `K = 1.854074677301372` (Abramowitz, Stegun, table
/// 17.1), under every method but for its own error, and in a run that goes on from a snapshot. Tolerance: cubic interpolation at ticks of
/// 1 ms with at most 4.43 rad/s, `(w dt)^3 dt/40` = 2e-12 s, for each of two crossings, five times that for harmonics; velocity Verlet
/// `(w dt)^2` of it.
#[test]
fn the_period_of_a_pendulum_is_measured() {
    let exact = 4.0 * 1.854_074_677_301_372 / 9.81_f64.sqrt();
    let scene = "bodies: [(name: \"bob\", at: (1, 0), mass: 1, atoms: Disc(radius: 0.1))],
        joints: [Distance(a: World, anchor_a: (0, 0), b: \"bob\", length: 1)],
        sensors: [Period(name: \"swing\", of: \"bob.position.x\")]";
    for (method, bound) in [("Dop853", 2e-11), ("VelocityVerlet", 5e-5)] {
        let of = |name: &str| read(method, 12_000, scene, name);
        assert_eq!(of("swing.crossings"), 5.0, "{method}");
        for name in ["swing.period", "swing.period.mean"] {
            assert!((of(name) - exact).abs() < bound, "{method} {name}: {} of {exact}", of(name));
        }
        assert!((of("swing.crossings.last") - 4.75 * exact).abs() < 5.0 * bound, "{method}");
        assert!(read(method, 100, scene, "swing.period").is_nan());
    }
}

/// Law: the clearance of discs is the distance of their centres less both radii; from a strip, that from its nearest point. Scene: a body of
/// two discs beside a ball, above the end of a shelf and a floor. Tolerance: rounding.
#[test]
fn the_clearance_is_that_of_the_nearest_atoms() {
    let scene = "walls: [(name: \"floor\", left: (9, -1), right: (-9, -1)), (name: \"shelf\", from: (-2, -0.5), to: (-0.4, -0.5), thickness: 0.2)],
        bodies: [(name: \"pair\", at: (0, 0), fixed: true, atoms: List([(at: (-0.1, 0), radius: 0.1), (at: (0.1, 0), radius: 0.1)])),
                 (name: \"ball\", at: (0.4, 0.4), fixed: true, atoms: Disc(radius: 0.2))],
        sensors: [Clearance(name: \"gap\", a: \"pair\", b: \"ball\"), Clearance(name: \"height\", a: \"pair\", b: \"floor\"),
                  Clearance(name: \"edge\", a: \"pair\", b: \"shelf\")]";
    let edge = 0.3_f64.hypot(0.5) - 0.1 - 0.1;
    for (name, exact) in [("gap", 0.5 - 0.3), ("height", 0.9), ("edge", edge)] {
        let found = read("VelocityVerlet", 0, scene, &format!("{name}.clearance"));
        assert!((found - exact).abs() < 1e-15, "{name}: {found} instead of {exact}");
    }
}

/// Law: a ray meets what is nearest along it: a disc, a box that is turned, a strip, a half-plane, a line. It turns with its body and does not see
/// that, nor what touches nothing. Exact: distances of plane geometry. Tolerance: rounding.
#[test]
fn a_ray_meets_what_is_nearest() {
    let scene = "walls: [(name: \"floor\", left: (9, -1), right: (-9, -1)), (name: \"shelf\", from: (-2, 0.5), to: (-1, 0.5), thickness: 0.2),
                         (name: \"steps\", line: [(0.5, 2), (-0.5, 2)])],
        bodies: [(name: \"eye\", at: (0, 0), angle: \"30 deg\", fixed: true, atoms: Disc(radius: 0.1)),
                 (name: \"ghost\", at: (0.5, 0), fixed: true, collides: false, atoms: Disc(radius: 0.2)),
                 (name: \"ball\", at: (2, 0), fixed: true, atoms: Disc(radius: 0.2)),
                 (name: \"box\", at: (3, 3), angle: \"45 deg\", fixed: true, shape: Rectangle(width: 1, height: 1))],
        sensors: [Range(name: \"to_ball\", of: \"eye\", angle: \"-30 deg\"), Range(name: \"to_box\", of: \"eye\", angle: \"15 deg\"),
                  Range(name: \"to_floor\", of: \"eye\", angle: \"-120 deg\"), Range(name: \"to_shelf\", of: \"eye\", at: (-0.75, 0), angle: \"90 deg\"),
                  Range(name: \"short\", of: \"eye\", angle: \"-30 deg\", reach: 1.7), Range(name: \"up\", of: \"eye\", angle: \"60 deg\")]";
    // From (-0.75 cos 30, -0.75 sin 30), 120 degrees from x: to the lower side of the shelf at a height of 0.4 m.
    let to_shelf = (0.4 + 0.375) / 0.75_f64.sqrt();
    let exact = [
        ("to_ball", 1.8),
        ("to_box", 18.0_f64.sqrt() - 0.5),
        ("to_floor", 1.0),
        ("to_shelf", to_shelf),
        ("short", f64::INFINITY),
        ("up", 2.0),
    ];
    for (name, exact) in exact {
        let found = read("VelocityVerlet", 0, scene, &format!("{name}.range"));
        assert!(found == exact || (found - exact).abs() < 1e-14, "{name}: {found} instead of {exact}");
    }
}

/// Law: a strip that is hit from one side has its surface half its thickness in front of its middle line, and round ends; from behind it
/// is open. Where a ray begins in it, in a half-plane, or in a closed block of ground, the range is zero. Exact: distances of plane geometry, a
/// chord of the round end. Tolerance: rounding. Not tested: lines with a thickness that have joints, which no scene can have.
#[test]
fn a_ray_meets_a_strip_from_its_open_side() {
    let scene = "walls: [(name: \"shelf\", from: (-1, 0), to: (1, 0), thickness: 0.4, sides: Left),
                         (name: \"ceiling\", from: (-1, 5), to: (1, 5), thickness: 0.4, sides: Right),
                         (name: \"block\", line: [(10, 0), (10, 2), (12, 2), (12, 0), (10, 0)])],
        bodies: [(name: \"eye\", at: (0, 2), fixed: true, atoms: Disc(radius: 0.1))],
        sensors: [Range(name: \"down\", of: \"eye\", angle: \"-90 deg\"), Range(name: \"up\", of: \"eye\", angle: \"90 deg\"),
                  Range(name: \"end\", of: \"eye\", at: (3, -1.88), angle: \"180 deg\"),
                  Range(name: \"under_end\", of: \"eye\", at: (1.12, -5), angle: \"90 deg\"),
                  Range(name: \"behind\", of: \"eye\", at: (0, -5), angle: \"90 deg\"),
                  Range(name: \"in_shelf\", of: \"eye\", at: (0, -1.9), angle: \"90 deg\"),
                  Range(name: \"beside\", of: \"eye\", at: (8, -1)), Range(name: \"in_block\", of: \"eye\", at: (11, -1))]";
    // 0.12 m beside the centre of an end, half a chord is 0.16 m.
    let exact = [
        ("down", 1.8),
        ("up", 2.8),
        ("end", 2.0 - 0.16),
        ("under_end", 3.0 - 0.16),
        ("behind", 3.0 + 5.0 - 0.2),
        ("in_shelf", 0.0),
        ("beside", 2.0),
        ("in_block", 0.0),
    ];
    for (name, exact) in exact {
        let found = read("VelocityVerlet", 0, scene, &format!("{name}.range"));
        assert!((found - exact).abs() < 1e-14, "{name}: {found} instead of {exact}");
    }
}

/// Law: clearances are those of the surfaces that contacts know. Two corners of sharp squares that point at each other are nearer by the
/// rounding of both, `r (sqrt 2 - 1)` each with `r` 2 % of half a side; in a closed block of ground a body is as deep as the nearest side is
/// far, and its own radius or half its width. A body of parts that touch nothing is measured by those. Tolerance: rounding.
#[test]
fn clearances_are_those_of_what_contacts_know() {
    let scene = "walls: [(name: \"block\", line: [(10, 0), (10, 2), (14, 2), (14, 0), (10, 0)])],
        bodies: [(name: \"left\", at: (0, 0), angle: \"45 deg\", fixed: true, shape: Rectangle(width: 1, height: 1)),
                 (name: \"right\", at: (2, 0), angle: \"45 deg\", fixed: true, shape: Rectangle(width: 1, height: 1)),
                 (name: \"round\", at: (0, 3), fixed: true, atoms: Disc(radius: 0.5)),
                 (name: \"stone\", at: (10.6, 1), fixed: true, atoms: Disc(radius: 0.1)),
                 (name: \"brick\", at: (10.6, 1), fixed: true, shape: Rectangle(width: 0.2, height: 0.2)),
                 (name: \"ghost\", at: (0, 5), fixed: true, shape: Rectangle(width: 1, height: 1, collides: false))],
        sensors: [Clearance(name: \"corners\", a: \"left\", b: \"right\"), Clearance(name: \"corner\", a: \"left\", b: \"round\"),
                  Clearance(name: \"stone_in\", a: \"stone\", b: \"block\"), Clearance(name: \"brick_in\", a: \"brick\", b: \"block\"),
                  Clearance(name: \"unseen\", a: \"ghost\", b: \"round\")]";
    let root = 2.0_f64.sqrt();
    let exact = [
        ("corners", 2.0 - root + 2.0 * 0.01 * (root - 1.0)),
        ("corner", 3.0 - 0.5 - 0.5 * root),
        ("stone_in", -0.7),
        ("brick_in", -0.7),
        ("unseen", 1.0),
    ];
    for (name, exact) in exact {
        let found = read("VelocityVerlet", 0, scene, &format!("{name}.clearance"));
        assert!((found - exact).abs() < 1e-14, "{name}: {found} instead of {exact}");
    }
}

/// Law: a ball that is let go on a spring is pressed in by `2 m g/k`; on a disc that is as soft `k` is half of that of one. The heavy one of two
/// balls goes deeper in metres, the small one as a share of its radius: channels and card tell each. Tolerance: the time between ticks at the
/// lowest point, `(w dt)^2/8` of the depth with `w^2 = k/m`, 6e-6, and as much for the method.
#[test]
fn the_deepest_overlap_and_the_largest_share_are_of_different_pairs() {
    let big = "(name: \"big\", at: (0, 1), material: \"m\", atoms: Disc(radius: 1, mass: 10))";
    let small = "(name: \"small\", at: (5, 0.1), material: \"m\", atoms: Disc(radius: 0.1, mass: 2))";
    let post =
        |x: f64| format!("(name: \"post_{x}\", at: ({x:?}, -1), fixed: true, material: \"m\", atoms: Disc(radius: 1))");
    let floor = "(name: \"floor\", left: (50, 0), right: (-50, 0), material: \"m\")".to_owned();
    let on_posts = (String::new(), format!(", {}, {}", post(0.0), post(5.0)), 2.0);
    for (walls, posts, soft) in [(floor, String::new(), 1.0), on_posts] {
        for [first, second] in [[big, small], [small, big]] {
            let text = format!(
                "Scene(format: 1, clock: (duration: 1, tick: \"0.1 ms\", method: VelocityVerlet), gravity: (0, -10),
                 contacts: Penalty(start: AsPlaced), materials: {{\"m\": (stiffness: 1e4)}}, walls: [{walls}], bodies: [{first}, {second}{posts}], sensors: [Overlap()])"
            );
            let mut simulation =
                Simulation::load(&Source::new("overlaps.ron", text)).unwrap_or_else(|errors| panic!("{errors}"));
            simulation.run_to_tick(10_000).unwrap();
            let mut channel = |name: &str| {
                let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the channel is there");
                simulation.value(&channel)
            };
            let (meters, share) = (channel("overlap.deepest"), channel("overlap.share"));
            assert!((meters / (0.02 * soft) - 1.0).abs() < 1e-5, "{meters}");
            assert!((share / (0.04 * soft) - 1.0).abs() < 1e-5, "{share}");
            let card = simulation.card();
            assert_eq!((card.largest_overlap.meters, card.largest_overlap_share.share_of_radius), (meters, share));
            assert!(card.largest_overlap.bodies.contains(&"big".to_owned()));
            assert!(card.largest_overlap_share.bodies.contains(&"small".to_owned()));
            assert!(card.to_string().contains("largest share"), "{card}");
        }
    }
}

/// Law: a ball that loses nothing meets the floor after `t = sqrt(2 h/g)` and then each `2 t`, `h` the height of its fall: with 0.5 m that is
/// five times in 3 s. A counter counts contacts of its own two groups alone; it is read far from any contact.
#[test]
fn a_counter_counts_contacts_of_its_groups() {
    let scene = "walls: [(name: \"floor\", left: (9, 0), right: (-9, 0))],
        materials: {\"default\": (stiffness: 1e6, restitution: 1)},
        bodies: [(name: \"ball_0\", at: (0, 0.6), mass: 1, atoms: Disc(radius: 0.1)),
                 (name: \"ball_1\", at: (2, 0.6), mass: 1, atoms: Disc(radius: 0.1)),
                 (name: \"other\", at: (4, 0.6), mass: 1, atoms: Disc(radius: 0.1))],
        sensors: [Counter(name: \"one\", of: \"ball_0\", touching: \"floor\"), Counter(name: \"both\", of: \"ball_*\", touching: [\"floor\", \"other\"]),
                  Counter(name: \"none\", of: \"ball_*\", touching: \"other\")]";
    let text = format!(
        "Scene(format: 1, clock: (duration: 3, tick: \"0.1 ms\", method: VelocityVerlet), gravity: (0, -9.81), {scene})"
    );
    let source = Source::new("counter.ron", text);
    let mut simulation = Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"));
    let mut read = |tick: u64| {
        simulation.run_to_tick(tick).unwrap();
        ["one", "both", "none"].map(|name| {
            let channel = jostle::sensors::find(simulation.world_mut(), &format!("{name}.count")).expect("it is there");
            simulation.value(&channel)
        })
    };
    assert_eq!(read(3_000), [0.0, 0.0, 0.0]);
    assert_eq!(read(6_000), [1.0, 2.0, 0.0]);
    assert_eq!(read(30_000), [5.0, 10.0, 0.0]);
}

/// Law: an oscillator with a period of 1 s passes its middle twice in each, and a gate beside its path never. Passages to both sides cancel.
#[test]
fn a_gate_counts_those_that_pass() {
    let scene = "forces: [Spring(a: \"bob\", b: World, anchor_b: (0, 0), stiffness: 39.47841760435743, length: 0)],
        bodies: [(name: \"bob\", at: (1, 0), mass: 1, atoms: Disc(radius: 0.1)), (name: \"post\", at: (0, 9), fixed: true, atoms: Disc(radius: 0.1))],
        sensors: [Counter(name: \"middle\", of: \"*\", gate: ((0, -9), (0, 9))), Counter(name: \"beside\", of: \"bob\", gate: ((0, 1), (0, 9))),
                  Counter(name: \"turned\", of: \"bob\", gate: ((0, 9), (0, -9)))]";
    let read = |tick: u64, name: &str| read("VelocityVerlet", tick, scene, name);
    for (tick, count, net) in [(200, 0.0, 0.0), (300, 1.0, 1.0), (800, 2.0, 0.0), (9_800, 20.0, 0.0)] {
        assert_eq!(read(tick, "middle.count"), count, "tick {tick}");
        assert_eq!([read(tick, "middle.count.net"), read(tick, "turned.count.net")], [net, -net], "tick {tick}");
        assert_eq!(read(tick, "beside.count"), 0.0);
    }
}
