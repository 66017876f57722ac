//! Laws of motors and controllers of joints beside the problems.
//!
//! Sources: at each test. Tolerances: under `Dop853` 1e-12 of the greatest number that a value is found from; under velocity Verlet its
//! order. Not tested: contacts; motions with a reference, see `problems` and `mechanisms`.

use std::f64::consts::TAU;

use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

fn load(method: &str, tick: f64, scene: &str) -> Simulation {
    let scene =
        format!("Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: {method}), contacts: None, {scene})");
    Simulation::load_with(&Source::new("drives.ron", scene), &Overrides::default(), |_| {})
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

fn demand(found: &[f64], exact: &[f64], tolerance: f64, of: &str) {
    assert_eq!(found.len(), exact.len());
    for (found, exact) in found.iter().zip(exact) {
        assert!((found - exact).abs() < tolerance, "{of}: {found} instead of {exact}");
    }
}

/// Law: with an integral term and a constant load the error goes to zero (Astrom and Murray, Feedback Systems, section 10.1), and the
/// integral holds the load: `ki I = torque of the load`. All poles decay at least as `e^(-2 t)`: after 12 s nothing is left above 1e-9.
#[test]
fn an_integral_term_takes_the_last_error() {
    for (method, tick) in [("Dop853", 0.01), ("VelocityVerlet", 0.001), ("RungeKutta4", 0.005)] {
        let mut simulation = load(
            method,
            tick,
            "bodies: [(name: \"wheel\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
             joints: [Revolute(name: \"hub\", a: World, b: \"wheel\")],
             forces: [Torque(of: \"wheel\", value: 1.5)],
             controllers: [Servo(name: \"hold\", of: \"hub\", target: 1, kp: 20, ki: 60, kd: 4)]",
        );
        run_to(&mut simulation, 12.0);
        assert!((simulation.bodies().angle[0] - 1.0).abs() < 1e-9, "{method}: {}", simulation.bodies().angle[0]);
        assert!((channel(&mut simulation, "hold.torque") + 1.5).abs() < 1e-7, "{method}");
    }
}

/// Law: a bounded servo that is far from its target gives its bound, so the wheel turns evenly faster: `angle = limit t^2 / (2 I)`.
#[test]
fn a_bounded_servo_gives_no_more_than_its_bound() {
    for method in ["Dop853", "VelocityVerlet"] {
        let mut simulation = load(
            method,
            0.01,
            "bodies: [(name: \"wheel\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
             joints: [Revolute(name: \"hub\", a: World, b: \"wheel\")],
             controllers: [Servo(name: \"drive\", of: \"hub\", target: 1000, kp: 80, limit: 2)]",
        );
        run_to(&mut simulation, 1.0);
        assert!((simulation.bodies().angle[0] - 5.0).abs() < 1e-11, "{method}: {}", simulation.bodies().angle[0]);
        assert_eq!(channel(&mut simulation, "drive.torque"), 2.0);
    }
}

/// Law: between two samples the output stays. A wheel under P control sampled at 10 Hz goes by `q'' = kp (target - q_n) / I`, exactly
/// `q_(n+1) = q_n + v_n T + a T^2/2`, `v_(n+1) = v_n + a T`. Tolerance: rounding.
#[test]
fn a_sampled_servo_holds_its_output() {
    for method in ["Dop853", "VelocityVerlet", "RungeKutta4"] {
        let mut simulation = load(
            method,
            0.004,
            "bodies: [(name: \"wheel\", at: (0, 0), mass: 1, inertia: 0.5, atoms: Disc(radius: 0.1))],
             joints: [Revolute(name: \"hub\", a: World, b: \"wheel\")],
             controllers: [Servo(of: \"hub\", target: 1, kp: 3, rate: 10)]",
        );
        let (mut angle, mut rate) = (0.0, 0.0);
        for sample in 1..=20 {
            let acceleration = 3.0 * (1.0 - angle) / 0.5;
            angle += 0.1 * rate + 0.005 * acceleration;
            rate += 0.1 * acceleration;
            run_to(&mut simulation, 0.1 * f64::from(sample));
            let bodies = simulation.bodies();
            demand(&[bodies.angle[0], bodies.spin[0]], &[angle, rate], 1e-11, &format!("{method}, sample {sample}"));
        }
    }
}

/// Law: a bounded motor that starts a wheel gives its bound, `rate = limit t / I`, until the rate is reached, and what the load takes from
/// then on. Where it changes over the step ends that is under way: the time is right to a tick.
#[test]
fn a_bounded_motor_speeds_up_and_then_holds_its_rate() {
    for method in ["Dop853", "VelocityVerlet"] {
        let tick = 0.001;
        let mut simulation = load(
            method,
            tick,
            "bodies: [(name: \"wheel\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
             joints: [Revolute(name: \"hub\", a: World, b: \"wheel\")],
             forces: [Torque(of: \"wheel\", value: -0.5)],
             controllers: [Motor(name: \"drive\", of: \"hub\", speed: 4, limit: 2.5)]",
        );
        run_to(&mut simulation, 0.2);
        assert!((simulation.bodies().spin[0] - 2.0).abs() < 1e-11, "{method}: {}", simulation.bodies().spin[0]);
        run_to(&mut simulation, 1.0);
        assert!((simulation.bodies().spin[0] - 4.0).abs() < 1e-11, "{method}: {}", simulation.bodies().spin[0]);
        assert!((channel(&mut simulation, "drive.torque") - 0.5).abs() < 1e-9, "{method}");
        // 0.4 s at half the rate on average, then 0.6 s at it.
        let angle = 0.4 * 2.0 + 0.6 * 4.0;
        assert!((simulation.bodies().angle[0] - angle).abs() < 2.0 * 4.0 * tick, "{method}");
        assert!(simulation.bodies().angle[0] < TAU);
    }
}

/// Law: coupled motions have one inertia, `I1 + ratio^2 I2` about the first: a constant torque turns them evenly faster. The second joint
/// moves by `ratio` times as much. Tolerance: rounding.
#[test]
fn gears_and_racks_couple_what_they_drive() {
    let wheels = "bodies: [(name: \"first\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1)),
                  (name: \"second\", at: (0.3, 0), mass: 2, inertia: 0.05, angle: 0.7, atoms: Disc(radius: 0.1)),
                  (name: \"bar\", at: (0, 0.2), mass: 3, atoms: Disc(radius: 0.05))],
         forces: [Torque(of: \"first\", value: 1.2)],";
    let hubs = "Revolute(name: \"one\", a: World, b: \"first\"), Revolute(name: \"two\", a: World, b: \"second\"),
                Prismatic(name: \"slide\", a: World, b: \"bar\", axis: (1, 0))";
    for (method, tick) in [("Dop853", 0.01), ("VelocityVerlet", 0.01), ("RungeKutta4", 0.01)] {
        let mut geared =
            load(method, tick, &format!("{wheels} joints: [{hubs}, GearPair(of: (\"one\", \"two\"), ratio: -2)]"));
        run_to(&mut geared, 1.0);
        let turned = 0.5 * 1.2 / (0.2 + 4.0 * 0.05);
        demand(&geared.bodies().angle, &[turned, 0.7 - 2.0 * turned, 0.0], 1e-12, method);
        let mut racked =
            load(method, tick, &format!("{wheels} joints: [{hubs}, Rack(of: (\"one\", \"slide\"), radius: 0.1)]"));
        run_to(&mut racked, 1.0);
        let turned = 0.5 * 1.2 / (0.2 + 3.0 * 0.01);
        let bodies = racked.bodies();
        demand(&[bodies.angle[0], bodies.angle[1], bodies.position[2].x], &[turned, 0.7, 0.1 * turned], 1e-12, method);
        assert!(racked.card().energy.residual.abs() < 1e-11, "{method}: {:?}", racked.card().energy);
        // What teeth give to one side only comes from the world, through the bearings of the other.
        for card in [geared.card(), racked.card()] {
            let [x, y] = card.momentum_residual;
            let worst = x.abs().max(y.abs()).max(card.angular_momentum_residual.abs());
            assert!(worst < 1e-11, "{method}: {x} {y} {}", card.angular_momentum_residual);
        }
    }
}

/// Units say what is meant: a slide is driven in metres a second and by newtons, a hinge in turns a minute and by newton metres. A motor with
/// a limit pushes with its force: `v = F t/m` until its speed is reached.
#[test]
fn motors_take_the_units_of_their_joints() {
    let scene = "bodies: [(name: \"bar\", at: (0, 0), mass: 2, atoms: Disc(radius: 0.1)),
            (name: \"wheel\", at: (0, 1), mass: 1, inertia: 0.5, atoms: Disc(radius: 0.1))],
         joints: [Prismatic(name: \"rail\", a: World, b: \"bar\", axis: (1, 0)), Revolute(name: \"hub\", a: World, b: \"wheel\")],
         controllers: [Motor(of: \"rail\", speed: \"90 cm/s\", limit: \"0.001 kN\"), Motor(of: \"hub\", speed: \"30 rpm\", limit: \"1 N m\")]";
    let mut simulation = load("Dop853", 0.01, scene);
    run_to(&mut simulation, 1.0);
    let bodies = simulation.bodies();
    demand(&[bodies.velocity[0].x, bodies.spin[1]], &[0.5, 2.0], 1e-12, "on the way");
    run_to(&mut simulation, 3.0);
    let bodies = simulation.bodies();
    demand(&[bodies.velocity[0].x, bodies.spin[1]], &[0.9, std::f64::consts::PI], 1e-12, "at speed");
}

/// Law: between samples a sampled controller holds its output, so each period is an exact constant acceleration, however long steps are
/// (Astrom, Wittenmark, Computer-Controlled Systems, section 3.2). Under a tolerance and in a reference run steps go beyond ticks, but not
/// beyond a sample. Tolerance: that of the run for places, and ten times that of speeds of some rad/s.
#[test]
fn samples_of_a_servo_are_taken_by_steps_of_any_length() {
    let (inertia, kp, kd, period) = (0.2, 5.0, 0.6, 0.05);
    let (mut angle, mut spin) = (0.0_f64, 0.0_f64);
    for _ in 0..40 {
        let acceleration = (kp * (1.0 - angle) - kd * spin) / inertia;
        angle += period * (spin + 0.5 * period * acceleration);
        spin += period * acceleration;
    }
    for (clock, bound) in [
        ("tolerance: 1e-2", 1e-2),
        ("tolerance: 1e-4", 1e-4),
        ("tolerance: 1e-8", 1e-8),
        ("method: Reference", 1e-10),
        ("tick: 0.02, method: Dop853", 1e-13),
    ] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 2, {clock}),
            bodies: [(name: \"b\", at: (0, 0), mass: 1, inertia: {inertia:?}, atoms: Disc(radius: 0.1))],
            joints: [Revolute(name: \"hip\", a: World, anchor_a: (0, 0), b: \"b\")],
            controllers: [Servo(of: \"hip\", target: 1, kp: {kp:?}, kd: {kd:?}, rate: {:?})])",
            1.0 / period
        );
        let mut simulation = Simulation::load_with(&Source::new("servo.ron", scene), &Overrides::default(), |_| {})
            .unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_end().unwrap();
        let bodies = simulation.bodies();
        demand(&[bodies.angle[0], 0.1 * bodies.spin[0]], &[angle, 0.1 * spin], bound, clock);
    }
}

/// Law: a sample takes effect `delay` after it was taken and is held until the next one does (Astrom, Wittenmark, Computer-Controlled
/// Systems, section 3.2). A free wheel then has a constant torque from one effect to the next, so its motion is known exactly. The delays
/// are zero, a part of a period, a whole one, and two and a half. Ticks of 7 ms meet neither samples nor effects, except at the end.
/// Tolerance: rounding of some 300 steps, `300 2^-52 * 4 rad = 3e-13`, which the control takes back rather than adds up.
#[test]
fn a_late_servo_gives_its_samples_after_its_delay() {
    let (inertia, kp, kd, period) = (0.2, 1.5, 0.35, 0.05);
    for delay in [0.0, 0.02, 0.05, 0.125] {
        // Times in units of 5 ms, so that none is rounded: 1.75 s are 350 of them, and 250 ticks.
        let (every, late) = (10_u32, (delay / 0.005_f64).round() as u32);
        let (mut angle, mut spin, mut samples) = (0.0_f64, 0.0_f64, Vec::new());
        for unit in 0..350 {
            if unit % every == 0 {
                samples.push(kp * (1.0 - angle) - kd * spin);
            }
            let effective = (unit >= late).then(|| samples[((unit - late) / every) as usize]);
            let acceleration = effective.unwrap_or_default() / inertia;
            angle += 0.005 * (spin + 0.5 * 0.005 * acceleration);
            spin += 0.005 * acceleration;
        }
        for clock in [
            "tick: 0.007, method: Dop853",
            "tick: 0.007, method: RungeKutta4",
            "tick: 0.007, method: VelocityVerlet, events: Located",
            "tick: 0.005, method: VelocityVerlet, events: PerTick",
        ] {
            let scene = format!(
                "Scene(format: 1, clock: (duration: 1.75, {clock}),
                bodies: [(name: \"b\", at: (0, 0), mass: 1, inertia: {inertia:?}, atoms: Disc(radius: 0.1))],
                joints: [Revolute(name: \"hip\", a: World, anchor_a: (0, 0), b: \"b\")],
                controllers: [Servo(of: \"hip\", target: 1, kp: {kp:?}, kd: {kd:?}, rate: {:?}, delay: {delay:?})])",
                1.0 / period
            );
            let source = Source::new("servo.ron", scene);
            let mut simulation = Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"));
            simulation.run_to_end().unwrap();
            let bodies = simulation.bodies();
            let of = format!("{clock}, {delay} s late");
            demand(&[bodies.angle[0], bodies.spin[0]], &[angle, spin], 1e-12, &of);
        }
    }
}

/// Law: samples that have not taken effect, and whether the bound holds, are part of the state, so runs that go on from a snapshot, and from
/// a fork, have the same bits.
#[test]
fn a_snapshot_keeps_what_a_servo_knows() {
    for controller in [
        "target: 1, kp: 1.5, kd: 0.35, rate: 20, delay: 0.125",
        "target: Course([(0, 0), (0.3, 1), (0.7, -1)]), kp: 1.5, ki: 0.2, kd: 0.35, limit: 0.4",
    ] {
        let scene = format!(
            "bodies: [(name: \"b\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
            joints: [Revolute(name: \"hip\", a: World, b: \"b\")],
            controllers: [Servo(of: \"hip\", {controller})]"
        );
        let mut whole = load("Dop853", 0.01, &scene);
        run_to(&mut whole, 0.5);
        let snapshot = whole.snapshot().unwrap();
        let mut fork = whole.fork().unwrap();
        run_to(&mut whole, 1.0);
        let mut second = load("Dop853", 0.01, &scene);
        second.restore(&snapshot).unwrap();
        for other in [&mut second, &mut fork] {
            run_to(other, 1.0);
            assert_eq!(other.bodies().angle[0].to_bits(), whole.bodies().angle[0].to_bits());
            assert_eq!(other.future_hash().unwrap(), whole.future_hash().unwrap());
        }
    }
}

/// Law: a table in a file is the course with its points, to the last bit. Columns are found by name, with or without the unit that a run
/// writes behind it.
#[test]
fn a_target_from_a_file_is_the_course_with_its_points() {
    let folder = std::env::temp_dir().join(format!("jostle-target-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let table = "time [s],other,arm.angle [rad],force\n0,9,0,0\n0.3,9,0.7,2\n1.1,9,-0.25,-1\n";
    std::fs::write(folder.join("arm.csv"), table).unwrap();
    let run = |target: &str, force: &str| {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 1.5, tick: 0.01, method: Dop853),
            bodies: [(name: \"b\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1)),
                (name: \"c\", at: (1, 0), mass: 1, atoms: Disc(radius: 0.1))],
            joints: [Revolute(name: \"hip\", a: World, b: \"b\"),
                Prismatic(name: \"rail\", a: World, b: \"c\", axis: (0, 1))],
            controllers: [Servo(of: \"hip\", target: {target}, kp: 8, kd: 0.8), Actuator(of: \"rail\", force: {force})])"
        );
        let path = folder.join("arm.ron");
        std::fs::write(&path, scene).unwrap();
        Simulation::load(&Source::read(&path).unwrap()).map(|mut simulation| {
            simulation.run_to_end().unwrap();
            let bodies = simulation.bodies();
            [bodies.angle[0], bodies.spin[0], bodies.position[1].y].map(f64::to_bits)
        })
    };
    let written = run("Course([(0, 0), (0.3, 0.7), (1.1, -0.25)])", "Course([(0, 0), (0.3, 2), (1.1, -1)])");
    let written = written.unwrap_or_else(|errors| panic!("{errors}"));
    for (target, force) in [
        ("(file: \"arm.csv\", column: \"arm.angle\")", "(file: \"arm.csv\", time: \"time\", column: \"force\")"),
        (
            "(time: \"time [s]\", column: \"arm.angle [rad]\", file: \"arm.csv\")",
            "(file: \"arm.csv\", column: \"force\")",
        ),
    ] {
        let read = run(&format!("Csv{target}"), &format!("Csv{force}")).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(read, written);
    }
    for (target, says) in [
        ("Csv(file: \"leg.csv\", column: \"arm.angle\")", "there is no file `leg.csv`"),
        ("Csv(file: \"arm.csv\", column: \"arm.angel\")", "line 1 of `arm.csv` names no column `arm.angel`"),
        ("Csv(file: \"arm.csv\", time: \"other\", column: \"force\")", "line 3 of `arm.csv` goes back in time"),
        ("Csv(\"arm.csv\")", "line 1 of `arm.csv` has 4 columns, not two"),
    ] {
        let errors = run(target, "0").expect_err(target).to_string();
        assert!(errors.contains(says) && errors.contains("controllers[0].target"), "{target}: {errors}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Law: a weight on a rack, held by a torque on the pinion, is a balance of forces at the pitch point: the tooth bears the weight of the
/// rack, the torque is `m g r`, the bearing of the pinion bears both weights, and the rail bears the moment of the tooth force about the
/// rack's centre. The rack may lie on either side. Tolerance: 1e-12 of the numbers, some 50 N, as Dop853 has nothing to integrate.
#[test]
fn a_pinion_that_holds_a_rack_bears_it_on_its_bearing() {
    for (radius, side) in [(0.1, 1.0), (-0.1, -1.0)] {
        let mut simulation = load(
            "Dop853",
            0.01,
            &format!(
                "gravity: (0, -10),
                bodies: [(name: \"pinion\", at: (0, 0), mass: 2, inertia: 0.01, atoms: Disc(radius: 0.1)),
                    (name: \"bar\", at: (0.3, 1), mass: 3, atoms: Disc(radius: 0.05))],
                joints: [Revolute(name: \"pin\", a: World, b: \"pinion\"),
                    Prismatic(name: \"rail\", a: World, b: \"bar\", axis: (0, 1)),
                    Rack(name: \"mesh\", of: (\"pin\", \"rail\"), radius: {radius:?})],
                forces: [Torque(of: \"pinion\", value: {:?})], sensors: [Joint(of: \"*\")]",
                30.0 * radius
            ),
        );
        run_to(&mut simulation, 0.5);
        assert!(simulation.bodies().velocity[1].length() < 1e-12);
        let names = ["mesh.force", "pin.force.x", "pin.force.y", "pin.torque", "rail.force.x", "rail.torque"];
        let found = names.map(|name| channel(&mut simulation, name));
        demand(&found, &[30.0, 0.0, 50.0, 0.0, 0.0, 30.0 * (0.3 - 0.1 * side)], 5e-11, "the balance");
        let columns = jostle::sensors::Channels::iter(simulation.resource()).map(|channel| channel.name.clone());
        assert!(
            columns.clone().any(|name| name == "mesh.force") && !columns.into_iter().any(|name| name == "mesh.torque")
        );
    }
}

/// Law: geared wheels accelerate by `T/(I1 + ratio^2 I2)`; the second gets its share `I2 ratio` of that from the gears, as a torque alone, so
/// bearings without other loads bear nothing. A rack gets `m a` from the pinion, and the bearing of that gives as much. Tolerance: 1e-12 of
/// numbers of some N m and N.
#[test]
fn gears_and_racks_tell_what_their_teeth_give() {
    let scene = |coupling: &str| {
        format!(
            "bodies: [(name: \"first\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1)),
                (name: \"second\", at: (0.3, 0), mass: 2, inertia: 0.05, angle: 0.7, atoms: Disc(radius: 0.1)),
                (name: \"bar\", at: (0, 0.2), mass: 3, atoms: Disc(radius: 0.05))],
            forces: [Torque(of: \"first\", value: 1.2)],
            joints: [Revolute(name: \"one\", a: World, b: \"first\"), Revolute(name: \"two\", a: World, b: \"second\"),
                Prismatic(name: \"slide\", a: World, b: \"bar\", axis: (1, 0)), {coupling}]"
        )
    };
    for method in ["Dop853", "VelocityVerlet", "RungeKutta4"] {
        let mut geared = load(method, 0.01, &scene("GearPair(name: \"mesh\", of: (\"one\", \"two\"), ratio: -2)"));
        run_to(&mut geared, 0.5);
        let found = ["mesh.torque", "one.force.x", "two.force.y", "one.torque"].map(|name| channel(&mut geared, name));
        demand(&found, &[0.05 * -2.0 * (1.2 / 0.4), 0.0, 0.0, 0.0], 1e-11, method);
        let mut racked = load(method, 0.01, &scene("Rack(name: \"mesh\", of: (\"one\", \"slide\"), radius: -0.1)"));
        run_to(&mut racked, 0.5);
        let push = 3.0 * -0.1 * (1.2 / (0.2 + 3.0 * 0.01));
        let found = ["mesh.force", "one.force.x", "one.force.y", "slide.force.x"];
        let found = found.map(|name| channel(&mut racked, name));
        demand(&found, &[push, push, 0.0, 0.0], 1e-11, method);
        let card = racked.card();
        let [x, y] = card.momentum_residual;
        assert!(x.abs().max(y.abs()).max(card.angular_momentum_residual.abs()) < 1e-11, "{method}");
        assert!(card.energy.residual.abs() < 1e-11, "{method}");
    }
}

/// Law: teeth count for the break force of a bearing. The pinion drives a rack of mass m with a torque `c t`, so the bearing bears
/// `m r c t/(I + m r^2)` and breaks when that is its break force. Tolerance: forces are located to 1e-13 of the break force, and rounding
/// of the force is less than a hundred times that; its rate is 2 N/s. Not tested: breaks at the very end of a tick.
#[test]
fn a_bearing_breaks_by_the_force_of_teeth() {
    let mut simulation = load(
        "Dop853",
        0.03,
        "bodies: [(name: \"pinion\", at: (0, 0), mass: 1, inertia: 0.02, atoms: Disc(radius: 0.1)),
            (name: \"bar\", at: (0, 0.2), mass: 2, atoms: Disc(radius: 0.05))],
        forces: [Drive(of: \"pinion\", torque: 0.4, course: Piecewise([(0, 0), (10, 10)]))],
        joints: [Revolute(name: \"pin\", a: World, b: \"pinion\", break_force: 1.45),
            Prismatic(name: \"rail\", a: World, b: \"bar\", axis: (1, 0)), Rack(of: (\"pin\", \"rail\"), radius: 0.1)]",
    );
    run_to(&mut simulation, 0.9);
    let joint = simulation.state().models_of::<jostle::joints::Joint>().next().unwrap();
    let rate = 2.0 * 0.1 * 0.4 / (0.02 + 2.0 * 0.01);
    let broken = joint.parts.broken.expect("it breaks");
    assert!((broken - 1.45 / rate).abs() < 1e-11, "{broken}");
}

/// Law: a pinion on a cart that rolls along a fixed rack is pushed by it with `(M + m) a`, where `a = T r/(I + (M + m) r^2)`, and its bearing
/// takes `M a` of that to the cart. Tolerance: rounding.
#[test]
fn a_pinion_that_rolls_along_a_rack_pushes_its_cart() {
    for method in ["Dop853", "VelocityVerlet"] {
        let mut simulation = load(
            method,
            0.01,
            "bodies: [(name: \"cart\", at: (0, 0), mass: 3, inertia: 0.5, atoms: Disc(radius: 0.2)),
                (name: \"pinion\", at: (0.4, 0.1), mass: 1, inertia: 0.02, atoms: Disc(radius: 0.1))],
            forces: [Torque(of: \"pinion\", value: 0.5)],
            joints: [Revolute(name: \"pin\", a: \"cart\", anchor_a: (0.4, 0.1), b: \"pinion\"),
                Prismatic(name: \"rail\", a: World, b: \"cart\", axis: (1, 0)),
                Rack(name: \"mesh\", of: (\"pin\", \"rail\"), radius: 0.1)]",
        );
        run_to(&mut simulation, 1.0);
        let acceleration = 0.5 * 0.1 / (0.02 + 4.0 * 0.01);
        let bodies = simulation.bodies();
        demand(&[bodies.position[0].x, bodies.angle[1]], &[0.5 * acceleration, 5.0 * acceleration], 1e-12, method);
        let found = ["mesh.force", "pin.force.x"].map(|name| channel(&mut simulation, name));
        demand(&found, &[4.0 * acceleration, -3.0 * acceleration], 1e-11, method);
    }
}

/// Law: a rack and its pinion on a frame that nothing holds keep momentum, angular momentum and energy, and the travel stays `radius` times
/// the angle. Tolerance: Dop853 errs by `(w h)^8` with rates of some 3 rad/s and steps of 10 ms, 1e-12 a step, of energies of some J; rows are
/// brought back to rounding.
#[test]
fn a_rack_on_a_free_frame_keeps_momentum_and_energy() {
    let mut simulation = load(
        "Dop853",
        0.01,
        "bodies: [(name: \"frame\", at: (0, 0), mass: 3, inertia: 0.5, spin: 2, velocity: (0.3, 0.1), atoms: Disc(radius: 0.2)),
            (name: \"pinion\", at: (0.4, 0.1), mass: 1, inertia: 0.02, spin: 5, atoms: Disc(radius: 0.1)),
            (name: \"bar\", at: (0.1, -0.3), mass: 0.7, inertia: 0.03, atoms: Disc(radius: 0.1))],
        joints: [Revolute(name: \"pin\", a: \"frame\", anchor_a: (0.4, 0.1), b: \"pinion\"),
            Prismatic(name: \"rail\", a: \"frame\", b: \"bar\", axis: (0.6, 0.8)),
            Rack(of: (\"pin\", \"rail\"), radius: 0.1)]",
    );
    let travel = |simulation: &mut Simulation| ["rail.travel", "pin.angle"].map(|name| channel(simulation, name));
    let [before, turned] = travel(&mut simulation);
    run_to(&mut simulation, 2.0);
    let [after, turns] = travel(&mut simulation);
    assert!((turns - turned).abs() > 0.5, "it moves: {turns}");
    assert!((after - before - 0.1 * (turns - turned)).abs() < 1e-13);
    let card = simulation.card();
    let [x, y] = card.momentum_residual;
    assert!(x.abs().max(y.abs()).max(card.angular_momentum_residual.abs()) < 1e-12, "{x} {y}");
    assert!(card.energy.residual.abs() < 1e-10, "{}", card.energy.residual);
}

/// A wheel under proportional control with a bound, from rest: evenly faster, freely about the target, evenly slower, and back. `swing` is the
/// distance of the target at the start. Half a period is `2 t1 + t2`, with `t1 = sqrt(2 (swing - x) I/limit)` at the bound, where
/// `x = limit/kp`, and `t2 = 2 atan(x w/v)/w` between both bounds, with the speed `v = limit t1/I` and `w = sqrt(kp/I)`.
struct BoundedSwing {
    inertia: f64,
    kp: f64,
    limit: f64,
    swing: f64,
}

impl BoundedSwing {
    /// A quarter of the period in s, and the spin at the target in rad/s.
    fn quarter(&self) -> (f64, f64) {
        let (x, w) = (self.limit / self.kp, (self.kp / self.inertia).sqrt());
        let at_bound = (2.0 * (self.swing - x) * self.inertia / self.limit).sqrt();
        let speed = self.limit * at_bound / self.inertia;
        (at_bound + libm::atan2(x * w, speed) / w, (speed * speed + x * x * w * w).sqrt())
    }

    /// Angle from the target in rad, spin in rad/s and error of the energy in J after nine quarters of `ticks` ticks each.
    fn run(&self, clock: &str, ticks: u32) -> (f64, f64, f64) {
        let Self { inertia, kp, limit, swing } = self;
        let tick = self.quarter().0 / f64::from(ticks);
        let scene = format!(
            "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, {clock}), contacts: None,
            bodies: [(name: \"b\", at: (0, 0), mass: 1, inertia: {inertia:?}, atoms: Disc(radius: 0.1))],
            joints: [Revolute(name: \"hip\", a: World, b: \"b\")],
            controllers: [Servo(name: \"drive\", of: \"hip\", target: {swing:?}, kp: {kp:?}, limit: {limit:?})])",
            tick * f64::from(9 * ticks)
        );
        let mut simulation =
            Simulation::load(&Source::new("servo.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_tick(u64::from(9 * ticks)).unwrap();
        let bodies = simulation.bodies();
        (bodies.angle[0] - swing, bodies.spin[0], simulation.card().energy.residual)
    }
}

/// Law: see [`BoundedSwing`]; after nine quarters of its period the wheel passes the target at its greatest speed. The bound is met and left
/// nine times. The torque is continuous there, so a moment that is wrong by `e` costs `kp v e^2/(2 I)` of speed: rounding of moments costs
/// nothing. What is left is the truncation of `Dop853`, `(w h)^9/9!` a step at most, `(20 * 0.0019)^9/9! = 5e-19` of 1 rad, and rounding of
/// 900 steps of 1.1e-15 rad/s each, half an ulp of 10 rad/s, over 1.7 s: 2e-12.
#[test]
fn a_servo_reaches_and_leaves_its_bound_at_events() {
    let law = BoundedSwing { inertia: 0.2, kp: 80.0, limit: 11.0, swing: 1.0 };
    let (_, fastest) = law.quarter();
    let (off, spin, residual) = law.run("method: Dop853", 100);
    demand(&[off, spin / fastest, residual / 8.0], &[0.0, 1.0, 0.0], 2e-12, "Dop853");
}

/// Law: methods that locate events keep their order where the bound is met and left. Halving the tick divides the error by `2^order`; half
/// of the order less is more than located events may cost, and far from order 2 of methods that do not see them.
#[test]
fn methods_keep_their_order_at_the_bound_of_a_servo() {
    let law = BoundedSwing { inertia: 0.2, kp: 80.0, limit: 60.0, swing: 1.0 };
    for (clock, order, ticks) in
        [("method: Dop853", 8, 6), ("method: RungeKutta4", 4, 48), ("method: VelocityVerlet, events: Located", 2, 24)]
    {
        let [coarse, fine] = [ticks, 2 * ticks].map(|ticks| law.run(clock, ticks).0.abs());
        let found = (coarse / fine).log2();
        assert!(found > f64::from(order) - 0.5, "{clock}: {found}, {coarse:e} and {fine:e}");
    }
}

/// Law: where the rate of the target jumps, the output jumps from one bound to the other. From rest at 0.3 s the wheel gets `limit` for 50 ms
/// and then `-limit`, so it stands at `limit/I (50 ms)^2` after 50 ms more. Kinks lie between ticks. Tolerance: rounding of some 30 steps
/// and of times near 1 s, where the wheel moves at 0.5 rad/s at most.
#[test]
fn the_output_of_a_servo_jumps_between_its_bounds_where_its_target_bends() {
    for method in ["Dop853", "RungeKutta4"] {
        let mut simulation = load(
            method,
            0.016,
            "bodies: [(name: \"b\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
            joints: [Revolute(name: \"hip\", a: World, b: \"b\")],
            controllers: [Servo(name: \"drive\", of: \"hip\", kp: 1, kd: 1, limit: 2,
                target: Course([(0, 0), (0.3, 0), (0.35, 0.25), (0.45, -0.25)]))]",
        );
        run_to(&mut simulation, 0.4);
        let bodies = simulation.bodies();
        demand(&[bodies.angle[0], bodies.spin[0]], &[10.0 * 0.05 * 0.05, 0.0], 1e-14, method);
        assert_eq!(channel(&mut simulation, "drive.torque"), -2.0);
    }
}

/// Law: `I q'' = kd (r - q')` on a course with the rate `r` of each piece gives `v = r + (v0 - r) e^(-l t)` with `l = kd/I = 5/s`, and `q` as its
/// integral. Steps end at kinks and see the rate of their own piece, also in stages at their ends. Tolerance: the truncation of 25
/// steps of 16 ms from 5 rad/s, `(l h)^9/9!` each under `Dop853` and `(l h)^5/5!` under `RungeKutta4`, and rounding.
#[test]
fn a_servo_sees_the_rate_of_the_piece_on_which_its_target_is() {
    let pieces = [(0.3, 0.0), (0.05, 5.0), (0.05, -5.0_f64)];
    let (mut angle, mut spin) = (0.0, 0.0_f64);
    for (time, rate) in pieces {
        let faded = libm::exp(-5.0 * time);
        angle += rate * time + (spin - rate) * (1.0 - faded) / 5.0;
        spin = rate + (spin - rate) * faded;
    }
    let truncation = |order: i32, factorial: f64| 25.0 * 5.0 * (5.0 * 0.016_f64).powi(order) / factorial;
    for (clock, tolerance) in [
        ("method: Dop853, tick: 0.016", truncation(9, 362_880.0) + 1e-14),
        ("method: RungeKutta4, tick: 0.016", truncation(5, 120.0)),
        ("method: RungeKutta4, tick: 0.016, events: PerTick", truncation(5, 120.0)),
        ("tolerance: 1e-9", 1e-8),
    ] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 0.4, {clock}), contacts: None,
            bodies: [(name: \"b\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
            joints: [Revolute(name: \"hip\", a: World, b: \"b\")],
            controllers: [Servo(of: \"hip\", kp: 0, kd: 1,
                target: Course([(0, 0), (0.3, 0), (0.35, 0.25), (0.45, -0.25)]))])"
        );
        let mut simulation =
            Simulation::load(&Source::new("servo.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_end().unwrap();
        let bodies = simulation.bodies();
        demand(&[bodies.angle[0], bodies.spin[0]], &[angle, spin], tolerance, clock);
    }
}
