//! Laws of the force `Drive` of scenes; each test says its law and its tolerance.

use std::f64::consts::TAU;

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

fn driven(course: &str, method: &str) -> Simulation {
    driven_by(course, &format!("tick: \"1 ms\", method: {method}"))
}

fn driven_by(course: &str, clock: &str) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 2, {clock}),
        bodies: [(name: \"cart\", at: (0, 0), mass: 2, inertia: 0.5, atoms: Disc(radius: 0.1))],
        forces: [Drive(of: \"cart\", force: (4, 0), torque: 1, at: (0, 0.25), course: {course})])"
    );
    let mut simulation = Simulation::load(&Source::new("drive.ron", scene)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run_to_end().unwrap();
    simulation
}

/// A tick that the scene does not name follows the drive: 1/80 of a period of 0.5 ms, rounded down to 1, 2 or 5 times a power of
/// ten, is 5e-6 s. A named one stays.
#[test]
fn the_chosen_tick_follows_the_fastest_drive() {
    let course = "Sine(frequency: 2000)";
    assert_eq!(driven_by(course, "method: VelocityVerlet").clock().dt, 5e-6);
    assert_eq!(driven_by(course, "tick: 0.01").clock().dt, 0.01);
}

/// `v = F/m integral of s`: of `sin(w t)` it is `(1 - cos w t)/w`. Tolerance: the trapezoidal rule of order 2 errs by
/// `(w dt)^2/12`, 5e-6 of the amplitude `F/(m w)`. Not tested: the way.
#[test]
fn a_sine_swings_as_its_integral() {
    let rate = 2.0 * TAU * 0.6;
    let simulation = driven("Sine(amplitude: 3, frequency: \"1.2 Hz\")", "VelocityVerlet");
    let exact = 3.0 * 2.0 * (1.0 - libm::cos(rate * 2.0)) / rate;
    let share = (rate * 1e-3_f64).powi(2) / 12.0;
    let velocity = simulation.bodies().velocity[0].x;
    assert!((velocity - exact).abs() < 12.0 / rate * share, "{velocity} {exact}");
    let card = simulation.card();
    assert!(card.momentum_residual[0].abs() < 1e-12 && card.angular_momentum_residual.abs() < 1e-12);
    // `w` in rad/s is the same.
    let other = driven(&format!("Sine(amplitude: 3, angular_frequency: {rate:?})"), "VelocityVerlet");
    assert!((other.bodies().velocity[0].x - velocity).abs() < 1e-12);
}

/// A ramp is integrated exactly by the trapezoidal rule whose ticks meet its kinks: rounding of 2000 ticks.
#[test]
fn a_ramp_gives_the_area_below_it() {
    let simulation = driven("Piecewise([(0.5, 0), (1, 2), (1.5, 0)])", "VelocityVerlet");
    let velocity = simulation.bodies().velocity[0].x;
    assert!((velocity - 2.0).abs() < 2000.0 * f64::EPSILON * 2.0, "{velocity}");
    // Force and torque turn the body in opposite ways, as much: 4 J go into its motion.
    let card = simulation.card();
    assert!((card.energy.work - 4.0).abs() < 1e-5 && card.energy_error() < 1e-5, "{:?}", card.energy);
}

/// A pulse much shorter than a step: its area is 1 s, the lever arm brings -1 N m beside a torque of 1 N m. Exact:
/// `v = 4 N s / 2 kg`, and the way from the middle of the pulse on. Each piece of a table is linear, and methods of order 2 and
/// more integrate it exactly. Rounding is that of the area and of at most 200 steps. Steps end at times rounded to an ulp of 1 s,
/// and the course rises by 1e6 a second there. Not tested: courses that are no table.
#[test]
fn a_pulse_between_two_ticks_is_met_by_every_step_inside_ticks() {
    let pulse = "Piecewise([(0.5004, 0), (0.5014, 1000), (0.5024, 0)])";
    let clocks = [
        "tick: \"10 ms\", method: RungeKutta4",
        "tick: \"10 ms\", method: Dop853",
        "tick: \"10 ms\", method: VelocityVerlet, events: Located",
        "tick: \"10 ms\", method: Symplectic4, events: PerTick",
        "tolerance: 1e-3",
        "tolerance: 1e-9",
        "method: Reference",
    ];
    for clock in clocks {
        let simulation = driven_by(pulse, clock);
        let bodies = simulation.bodies();
        let (speed, way) = (bodies.velocity[0].x, bodies.position[0].x);
        let rounding = 1e6 * f64::EPSILON + 200.0 * f64::EPSILON * 3.0;
        assert!((speed - 2.0).abs() < rounding, "{clock}: {speed}");
        assert!((way - 2.0 * (2.0 - 0.5014)).abs() < 2.0 * rounding, "{clock}: {way}");
    }
}

/// A pulse between two ticks is not seen at all, one whose top lies on a tick is seen as a pulse of two ticks: twice its
/// area where it takes one. Where points lie on ticks, or steps end at them, there is nothing to warn of.
#[test]
fn the_card_says_what_comes_of_points_between_ticks() {
    let verlet = "tick: \"1 ms\", method: VelocityVerlet";
    let warned = |course: &str, clock: &str| {
        let warnings = driven_by(course, clock).card().warnings.into_iter();
        warnings.filter(|warning| warning.contains("between ticks")).collect::<Vec<String>>()
    };
    let cases = [
        ("Piecewise([(0.5002, 0), (0.5004, 1000), (0.5006, 0)])", "Of its impulse, the run lost 100 %."),
        ("Piecewise([(0.4995, 0), (0.5, 1000), (0.5005, 0)])", "Of its impulse, the run gained 100 %."),
    ];
    for (course, says) in cases {
        let warnings = warned(course, verlet);
        assert!(
            warnings.len() == 1 && warnings[0].contains(says) && warnings[0].contains("`forces[0]`"),
            "{warnings:?}"
        );
        for clock in ["tick: \"1 ms\", method: RungeKutta4", "tick: \"1 ms\", method: VelocityVerlet, events: Located"]
        {
            assert_eq!(warned(course, clock), Vec::<String>::new(), "{clock}");
        }
    }
    for course in
        ["Piecewise([(0.5, 0), (0.501, 1000), (0.502, 0)])", "Piecewise([(0.3, 0), (0.7, 2)])", "Sine(frequency: 3)"]
    {
        assert_eq!(warned(course, verlet), Vec::<String>::new(), "{course}");
    }
}

/// The file stands beside the scene. A constant force makes `v = F t/m`; the numbers chosen leave no rounding.
#[test]
fn a_course_comes_from_the_file_beside_the_scene() {
    let folder = std::env::temp_dir().join(format!("jostle-course-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("course.csv"), "time,share\n0,0.5\n10,0.5\n").unwrap();
    let text = "Scene(format: 1, clock: (duration: 1, tick: 0.125),
        bodies: [(name: \"cart\", at: (0, 0), mass: 2, atoms: Disc(radius: 0.1))],
        forces: [Drive(of: \"cart\", force: (8, 0), course: Csv(\"course.csv\"))])";
    std::fs::write(folder.join("cart.ron"), text).unwrap();
    let source = Source::read(&folder.join("cart.ron")).unwrap();
    let mut simulation = Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_end().unwrap();
    assert_eq!(simulation.bodies().velocity[0].x, 2.0);
    std::fs::remove_dir_all(&folder).unwrap();
    let errors = Simulation::load(&source).err().unwrap().to_string();
    assert!(errors.contains("there is no file `course.csv`"), "{errors}");
}
