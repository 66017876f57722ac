//! Laws of motors and controllers of joints.
//!
//! Reference values: `assets/truths/J05` to `J08`, closed forms and two independent methods. Tolerances: under `Dop853` ten times the
//! reference's own error, or 1e-12 of the greatest number that it is found from; under velocity Verlet its order. Not tested: contacts.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec2;
use jostle::problems::Truth;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

fn truth(name: &str) -> Truth {
    Truth::read(&std::fs::read_to_string(format!("assets/truths/{name}.json")).unwrap())
}

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

const ARM: &str = "gravity: (0, -9.81),
    bodies: [(name: \"upper\", at: (SIN1, COS1), angle: ANGLE1, mass: 1, inertia: 0.020833333333333332, atoms: Disc(radius: 0.02)),
             (name: \"lower\", at: (SIN2, COS2), angle: ANGLE2, mass: 0.8, inertia: 0.01066666666666667, atoms: Disc(radius: 0.02))],
    joints: [Revolute(name: \"shoulder\", a: World, anchor_a: (0, 0), b: \"upper\", anchor_b: (-0.25, 0)),
             Revolute(name: \"elbow\", a: \"upper\", anchor_a: (0.25, 0), b: \"lower\", anchor_b: (-0.2, 0))]";

fn arm() -> String {
    let (one, two) = (30.0_f64.to_radians(), 75.0_f64.to_radians());
    let along = |angle: f64| DVec2::new(libm::sin(angle), -libm::cos(angle));
    let (first, second) = (along(one) * 0.25, along(one) * 0.5 + along(two) * 0.2);
    let places = [
        ("SIN1", first.x),
        ("COS1", first.y),
        ("ANGLE1", one - FRAC_PI_2),
        ("SIN2", second.x),
        ("COS2", second.y),
        ("ANGLE2", two - FRAC_PI_2),
    ];
    places.into_iter().fold(ARM.to_owned(), |text, (word, value)| text.replace(word, &format!("{value:?}")))
}

/// Source: J05, a two-link arm under PD control and gravity.
#[test]
fn a_servo_moves_an_arm_as_its_law_says() {
    let truth = truth("J05_two_link_arm");
    let servos = "controllers: [Servo(name: \"one\", of: \"shoulder\", target: \"-30 deg\", kp: 60, kd: 3),
                                Servo(name: \"two\", of: \"elbow\", target: \"45 deg\", kp: 30, kd: 1)]";
    for (method, tick, tolerance) in [("Dop853", 0.005, 1e-11), ("VelocityVerlet", 0.0005, 2e-3)] {
        let mut simulation = load(method, tick, &format!("{}, {servos}", arm()));
        for time in truth.times("PD theta..omega (t<=2)") {
            run_to(&mut simulation, time);
            let bodies = simulation.bodies();
            let found = [bodies.angle[0] + FRAC_PI_2, bodies.angle[1] + FRAC_PI_2, bodies.spin[0], bodies.spin[1]];
            let exact = truth.row("PD theta..omega (t<=2)", time).unwrap();
            demand(&found, &exact, tolerance, &format!("{method} at {time} s"));
        }
        let card = simulation.card();
        let scale = card.energy.work.abs() + 6.0;
        assert!(card.energy.residual.abs() < tolerance * scale, "{method}: {:?}", card.energy);
    }
}

/// Source: J06, a wheel under PD control: a damped oscillator.
#[test]
fn a_servo_on_a_wheel_is_a_damped_oscillator() {
    let truth = truth("J06_pd_joint");
    let mut simulation = load(
        "Dop853",
        0.005,
        "bodies: [(name: \"wheel\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
         joints: [Revolute(name: \"hub\", a: World, b: \"wheel\")],
         controllers: [Servo(of: \"hub\", target: 1, kp: 80, kd: 2)]",
    );
    for time in truth.times("q") {
        run_to(&mut simulation, time);
        demand(&[simulation.bodies().angle[0]], &truth.row("q", time).unwrap(), 1e-12, &format!("at {time} s"));
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

fn slider_crank() -> String {
    let (r, l) = (0.05, 0.2);
    format!(
        "bodies: [(name: \"crank\", at: ({:?}, 0), mass: 0.4, inertia: {:?}, atoms: Disc(radius: 0.005)),
                  (name: \"rod\", at: ({:?}, 0), mass: 0.3, inertia: {:?}, atoms: Disc(radius: 0.005)),
                  (name: \"piston\", at: ({:?}, 0), mass: 0.5, inertia: 1, atoms: Disc(radius: 0.005))],
         joints: [Revolute(name: \"hub\", a: World, anchor_a: (0, 0), b: \"crank\", anchor_b: ({:?}, 0)),
                  Revolute(a: \"crank\", anchor_a: ({:?}, 0), b: \"rod\", anchor_b: (-0.1, 0)),
                  Revolute(a: \"rod\", anchor_a: (0.1, 0), b: \"piston\", anchor_b: (0, 0)),
                  Prismatic(name: \"slide\", a: World, anchor_a: (0, 0), b: \"piston\", anchor_b: (0, 0), axis: (1, 0))],
         controllers: [Motor(name: \"drive\", of: \"hub\", speed: 100)]",
        r / 2.0,
        0.4 * r * r / 12.0,
        r + l / 2.0,
        0.3 * l * l / 12.0,
        r + l,
        -r / 2.0,
        r / 2.0
    )
}

/// Source: J08, a slider-crank at 100 rad/s: place, speed and the torque of the motor, 955 turns per minute.
#[test]
fn a_motor_turns_a_slider_crank() {
    let truth = truth("J08_slider_crank");
    for (method, tick, tolerance) in [("Dop853", 0.0005, 1e-10), ("VelocityVerlet", 0.00001, 2e-3)] {
        let mut simulation = load(method, tick, &slider_crank());
        for time in truth.times("motor torque") {
            run_to(&mut simulation, time);
            let exact = truth.row("piston x,v,a", time).unwrap();
            let found = [channel(&mut simulation, "slide.travel"), channel(&mut simulation, "slide.rate")];
            demand(&found, &exact[..2], tolerance, &format!("{method} at {time} s"));
            let torque = truth.row("motor torque", time).unwrap()[0];
            demand(
                &[channel(&mut simulation, "drive.torque")],
                &[torque],
                100.0 * tolerance,
                &format!("{method} at {time} s"),
            );
        }
        let card = simulation.card();
        assert!(card.largest_joint_drift.unwrap().meters < 1e-13, "{method}");
        assert!(card.energy.residual.abs() < 10.0 * tolerance, "{method}: {:?}", card.energy);
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
    }
}

/// Source: J07, a four-bar linkage under a motor: angles and rates of the loop, and the torque of the motor.
#[test]
fn a_motor_turns_a_four_bar_linkage() {
    let truth = truth("J07_four_bar");
    let (crank, tip) = (DVec2::new(0.1, 0.0), DVec2::new(0.4, 0.0));
    // Where circles about both ends meet.
    let x = 0.1 + 0.1225 / 0.6;
    let top = DVec2::new(x, (0.1225 - (x - 0.1) * (x - 0.1)).sqrt());
    let bar = |name: &str, from: DVec2, to: DVec2, mass: f64| {
        let (middle, along) = (0.5 * (from + to), to - from);
        let inertia = mass * along.length_squared() / 12.0;
        let angle = libm::atan2(along.y, along.x);
        format!(
            "(name: \"{name}\", at: ({:?}, {:?}), angle: {angle:?}, mass: {mass:?}, inertia: {inertia:?}, atoms: Disc(radius: 0.005))",
            middle.x, middle.y
        )
    };
    let bodies = [bar("crank", DVec2::ZERO, crank, 0.2), bar("coupler", crank, top, 0.7), bar("rocker", tip, top, 0.6)];
    let scene = format!(
        "gravity: (0, -9.81), bodies: [{}],
         joints: [Revolute(name: \"hub\", a: World, anchor_a: (0, 0), b: \"crank\", anchor_b: (-0.05, 0)),
                  Revolute(a: \"crank\", anchor_a: (0.05, 0), b: \"coupler\", anchor_b: (-0.175, 0)),
                  Revolute(a: \"coupler\", anchor_a: (0.175, 0), b: \"rocker\", anchor_b: (0.15, 0)),
                  Revolute(a: World, anchor_a: (0.4, 0), b: \"rocker\", anchor_b: (-0.15, 0))],
         controllers: [Motor(name: \"drive\", of: \"hub\", speed: 10)]",
        bodies.join(", ")
    );
    for (method, tick, tolerance) in [("Dop853", 0.0025, 1e-11), ("VelocityVerlet", 0.0001, 2e-5)] {
        let mut simulation = load(method, tick, &scene);
        for time in truth.times("motor torque") {
            run_to(&mut simulation, time);
            let of = format!("{method} at {time} s");
            let bodies = simulation.bodies();
            demand(&bodies.angle, &truth.row("angles crank,coupler,rocker", time).unwrap(), tolerance, &of);
            demand(&bodies.spin, &truth.row("rates crank,coupler,rocker", time).unwrap(), 100.0 * tolerance, &of);
            let torque = truth.row("motor torque", time).unwrap();
            demand(&[channel(&mut simulation, "drive.torque")], &torque, 100.0 * tolerance, &of);
        }
        assert!(simulation.card().largest_joint_drift.unwrap().meters < 1e-13, "{method}");
    }
}
