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

/// Law: samples that have not taken effect are part of the state, so runs that go on from a snapshot, and from a
/// fork, have the same bits.
#[test]
fn a_snapshot_keeps_the_samples_that_are_under_way() {
    let scene = "bodies: [(name: \"b\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
        joints: [Revolute(name: \"hip\", a: World, b: \"b\")],
        controllers: [Servo(of: \"hip\", target: 1, kp: 1.5, kd: 0.35, rate: 20, delay: 0.125)]";
    let mut whole = load("Dop853", 0.01, scene);
    run_to(&mut whole, 0.5);
    let snapshot = whole.snapshot().unwrap();
    let mut fork = whole.fork().unwrap();
    run_to(&mut whole, 1.0);
    let mut second = load("Dop853", 0.01, scene);
    second.restore(&snapshot).unwrap();
    for other in [&mut second, &mut fork] {
        run_to(other, 1.0);
        assert_eq!(other.bodies().angle[0].to_bits(), whole.bodies().angle[0].to_bits());
        assert_eq!(other.future_hash().unwrap(), whole.future_hash().unwrap());
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
