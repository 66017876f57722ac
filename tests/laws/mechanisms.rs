//! Laws of mechanisms on the problems that have joints: drift, reactions, accounts, the horizon of chaos.
//!
//! Sources: truth files J01 to J12, S06 and O04. Tolerances: joint drift is below 1e-12 of the size of a mechanism at every tick,
//! under all methods. Forces of joints and torques of motors are those of the truth within 1e-9 of the greatest of them under
//! `Dop853`: they are found from places and velocities that are good to 1e-12, and stiff mechanisms make of that up to a thousand
//! times as much. The energy that is missing under `Dop853` is rounding: each tick rounds each number once.
//!
//! Not tested: the motion itself, see `problems`, `convergence` and `conditioned`.

use glam::DVec2;
use jostle::joints::Joint;
use jostle::problems::linkage::greatest;
use jostle::problems::{self, EventTiming, Problem, ProblemSetting, Truth};
use jostle::{Simulation, SimulationExt};

use super::support::{self, run_to};

/// Joint drift over the size.
const DRIFT: f64 = 1e-12;
/// Error of a force under `Dop853` over the greatest.
const REACTION: f64 = 1e-9;

/// The problems that have joints.
fn mechanisms() -> impl Iterator<Item = &'static Problem> {
    let jointed = |problem: &&Problem| {
        let setting = ProblemSetting { method: "VelocityVerlet", tick: problem.tick, ..ProblemSetting::default() };
        (problem.scene)(&setting, problem.duration()).contains("joints: [")
    };
    problems::ALL.iter().filter(jointed)
}

fn load(problem: &Problem, method: &str) -> Simulation {
    let setting = ProblemSetting { method, tick: problem.tick, ..ProblemSetting::default() };
    problem.load(&setting).unwrap_or_else(|error| panic!("{error}"))
}

/// The greatest distance of two bodies, or of one from the origin, in m.
fn size(simulation: &Simulation) -> f64 {
    let places = &simulation.bodies().position;
    let apart = places.iter().flat_map(|a| places.iter().map(|b| a.distance(*b)));
    greatest(apart.chain(places.iter().map(|place| place.length())))
}

#[test]
fn there_are_fourteen_mechanisms() {
    assert_eq!(mechanisms().count(), 14);
}

/// What the card says is the greatest after any tick.
#[test]
fn joints_stay_closed_at_every_tick_under_all_methods() {
    let mut report = Vec::new();
    for problem in mechanisms() {
        for method in problems::methods() {
            for events in problem.timings(&method) {
                let setting =
                    ProblemSetting { method: method.name, tick: problem.tick, events, ..ProblemSetting::default() };
                let mut simulation = problem.load(&setting).unwrap_or_else(|error| panic!("{error}"));
                let size = size(&simulation);
                // An unstable method may end the run: joints hold until then.
                let ended = simulation.run_to_tick(simulation.ticks().min(400));
                assert!(ended.is_ok() || method.stability_limit == 0.0, "{}, {}", problem.name, method.name);
                if ended.is_ok() {
                    let drift = simulation.card().largest_joint_drift.expect("the scene has joints");
                    let told =
                        format!("{} {} {events:?}: {:.1e} m of {size:.2} m", problem.name, method.name, drift.meters);
                    assert!(drift.meters <= DRIFT * size, "{told} in `{}` at {} s", drift.joint, drift.time);
                    report.push(told);
                }
            }
        }
    }
    println!("{}", report.join("\n"));
}

/// The force in N that a joint exerts on its second body.
fn force(simulation: &Simulation, name: &str) -> DVec2 {
    let joint = simulation.state().models_of::<Joint>().find(|joint| joint.name == name);
    joint.unwrap_or_else(|| panic!("no joint `{name}`")).reaction.0
}

fn channel(simulation: &mut Simulation, name: &str) -> f64 {
    let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the channel is there");
    simulation.value(&channel)
}

/// Compares forces with the truth at all its times, under `Dop853`.
fn compare(problem: &Problem, observable: &str, truth: &str, find: impl Fn(&mut Simulation) -> Vec<f64>, from: usize) {
    let truth = Truth::read(truth);
    let largest = greatest(truth.numbers(observable));
    let mut simulation = load(problem, "Dop853");
    let mut worst = 0.0_f64;
    for time in truth.times(observable) {
        run_to(&mut simulation, time);
        let (found, row) = (find(&mut simulation), truth.row(observable, time).expect("a row for each time"));
        assert_eq!(found.len(), row.len() - from, "{observable}");
        worst = greatest(found.iter().zip(&row[from..]).map(|(found, exact)| found - exact).chain([worst]));
    }
    println!("{}: {observable}: {worst:.1e} of {largest:.1e}", problem.name);
    assert!(worst <= REACTION * largest, "{}: {observable}: {worst:e} of {largest:e}", problem.name);
}

#[test]
fn joints_bear_and_motors_give_what_the_truth_says() {
    for (bob, degrees) in problems::pendulum::STARTS.into_iter().enumerate() {
        let tension = |simulation: &mut Simulation| {
            let place = simulation.bodies().position[bob];
            vec![force(simulation, &format!("rod_{degrees}")).dot(-place.normalize())]
        };
        let observable = problems::pendulum::observable(degrees);
        compare(&problems::pendulum::PROBLEM, &observable, problems::pendulum::TRUTH, tension, 2);
    }
    let pin = |simulation: &mut Simulation| force(simulation, "pin").to_array().to_vec();
    let observable = "pin reaction on body [Fx,Fy]";
    compare(&problems::compound_pendulum::PROBLEM, observable, problems::compound_pendulum::TRUTH, pin, 0);
    let torque = |simulation: &mut Simulation| vec![channel(simulation, "drive.torque")];
    compare(&problems::four_bar::PROBLEM, "motor torque", problems::four_bar::TRUTH, torque, 0);
    compare(&problems::slider_crank::PROBLEM, "motor torque", problems::slider_crank::TRUTH, torque, 0);
}

/// What is known at one moment: a hanging chain, a falling rod where it is level, a turning ring.
#[test]
fn joints_bear_what_the_truth_says_in_the_end() {
    let at_end = |problem: &Problem, joint: &str| {
        let mut simulation = load(problem, "Dop853");
        run_to(&mut simulation, problem.duration());
        (force(&simulation, joint), simulation.bodies().position.clone())
    };
    let near = |what: &str, found: f64, exact: f64, largest: f64| {
        println!("{what}: {:.1e} of {largest:.1e}", (found - exact).abs());
        assert!((found - exact).abs() <= REACTION * largest, "{what}: {found} instead of {exact}");
    };
    let (found, _) = at_end(&problems::catenary::PROBLEM, "pin_0");
    let exact = Truth::read(problems::catenary::TRUTH).numbers("pin force left on chain [Fx,Fy]");
    near("catenary, across", found.x, exact[0], exact[1]);
    near("catenary, upwards", found.y, exact[1], exact[1]);
    let (found, _) = at_end(&problems::falling_rod::PROBLEM, "hinge");
    let exact = Truth::read(problems::falling_rod::TRUTH).numbers("hinge force at horizontal [horizontal,vertical]");
    near("falling rod, along", found.x, exact[0], exact[0].abs());
    near("falling rod, upwards", found.y, exact[1], exact[0].abs());
    let (found, places) = at_end(&problems::rigid_ring::PROBLEM, "rod0");
    let tension = problems::rigid_ring::tension();
    near("rigid ring", found.dot((places[0] - places[1]).normalize()), tension, tension);
}

/// Also: rows that follow from others are told, and no others.
#[test]
fn accounts_of_mechanisms_close_under_dop853() {
    for problem in mechanisms() {
        let mut simulation = load(problem, "Dop853");
        let (ticks, size) = (simulation.ticks() as f64, size(&simulation));
        let (mut energy, mut mass) = (0.0_f64, 0.0);
        for share in 1..=8 {
            simulation.run_to_tick(simulation.ticks() * share / 8).expect("numbers stay finite");
            energy = energy.max(problems::hard::kinetic(simulation.bodies()));
            mass = simulation.bodies().mass.iter().sum();
        }
        let card = simulation.card();
        // Roundings of places count with the weight, those of velocities with the momentum.
        let largest = energy + card.energy.work.abs() + 9.81 * mass * size;
        let bound = 8.0 * f64::EPSILON * ticks * largest;
        let residual = card.energy.residual.abs();
        println!("{}: {residual:.1e} J of {bound:.1e} J, {largest:.1e} J", problem.name);
        assert!(residual <= bound, "{}: {residual:e} J of {bound:e} J", problem.name);
        let told = card.notes.iter().any(|note| note.contains("repeat constraints of others"));
        assert_eq!(told, problem.name == "parallelogram", "{}: {:?}", problem.name, card.notes);
    }
}

/// A scene with contacts and no joint has no such note.
#[test]
fn contacts_alone_are_not_called_joints() {
    let problem = &problems::elastic_bounce::PROBLEM;
    let setting = ProblemSetting { method: "Symplectic4", tick: problem.tick, ..ProblemSetting::default() };
    let notes = problem.load(&setting).expect("a scene").notes().to_vec();
    assert!(!notes.iter().any(|note| note.contains("joints")), "{notes:?}");
}

/// Methods that are symplectic on free bodies, but project states onto joints, say so on the card.
#[test]
fn methods_that_project_say_that_they_are_not_symplectic() {
    let problem = &problems::pendulum::PROBLEM;
    for (method, events, projects) in [
        ("VelocityVerlet", EventTiming::PerTick, false),
        ("VelocityVerlet", EventTiming::Located, false),
        ("SemiImplicitEuler", EventTiming::PerTick, false),
        ("SemiImplicitEuler", EventTiming::Located, false),
        ("Symplectic4", EventTiming::Located, false),
        ("ImplicitMidpoint", EventTiming::Located, true),
        ("RungeKutta4", EventTiming::Located, false),
    ] {
        let setting = ProblemSetting { method, tick: problem.tick, events, ..ProblemSetting::default() };
        let notes = problem.load(&setting).expect("a scene").notes().to_vec();
        let told = notes.iter().any(|note| note.contains("is not symplectic here"));
        assert_eq!(told, projects, "{method} {events:?}: {notes:?}");
    }
}

/// Law: a symplectic method keeps the energy of a mechanism near its value, on what joints hold as well as on free bodies (Hairer, Lubich,
/// Wanner, IX.8 and VII.1): it swings, and has no trend. Scene: a chain of three bars with inertia that swings by some 40 degrees, which is
/// not chaotic; located and from tick to tick. Tolerance: the last third of the run may deviate by a fifth more than the first does.
/// Projection behind each step would make a trend: `ImplicitMidpoint` is not tested.
#[test]
fn symplectic_methods_keep_the_energy_of_mechanisms() {
    const TICKS: u64 = 30_000;
    for (method, events, tick) in [
        ("SemiImplicitEuler", "PerTick", 0.002),
        ("SemiImplicitEuler", "Located", 0.002),
        ("VelocityVerlet", "PerTick", 0.02),
        ("VelocityVerlet", "Located", 0.02),
        ("Symplectic4", "Located", 0.06),
    ] {
        let bar = |name: &str, y: f64| {
            format!(
                "(name: \"{name}\", at: ({:?}, {:?}), angle: 0.7, mass: 1, inertia: 0.02, atoms: Disc(radius: 0.05)),",
                -y * libm::sin(0.7),
                y * libm::cos(0.7)
            )
        };
        let scene = format!(
            "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}, events: {events}), gravity: (0, -9.81), contacts: None,
            bodies: [{} {} {}],
            joints: [Revolute(a: World, anchor_a: (0, 0), b: \"a\", anchor_b: (0, 0.25)),
                     Revolute(a: \"a\", anchor_a: (0, -0.25), b: \"b\", anchor_b: (0, 0.25)),
                     Revolute(a: \"b\", anchor_a: (0, -0.25), b: \"c\", anchor_b: (0, 0.25))])",
            TICKS as f64 * tick, bar("a", -0.25), bar("b", -0.75), bar("c", -1.25)
        );
        let mut simulation = support::load(&scene);
        let mut third = |from: u64| {
            let mut worst = 0.0_f64;
            for number in 1..=TICKS / 21 {
                simulation.run_to_tick(from + 7 * number).expect("numbers stay finite");
                worst = worst.max(simulation.card().energy.residual.abs());
            }
            worst
        };
        let (first, _, last) = (third(0), third(TICKS / 3), third(2 * TICKS / 3));
        println!("{method} {events}: {first:.2e} J, then {last:.2e} J");
        assert!(last <= 1.2 * first, "{method} {events}: {first:e} J, then {last:e} J");
    }
}

/// Law: errors of a double pendulum grow as `e^(lambda t)` with the greatest Lyapunov exponent, 0.86/s, known to 30 %. Source: J03, with 40
/// digits until 30 s. Tolerance: the rounding of as many ticks, by chance, grown with the upper end of that.
#[test]
fn a_double_pendulum_is_known_until_its_horizon() {
    let truth = Truth::read(problems::double_pendulum::TRUTH);
    let problem = Problem { samples: &[20.0], ..problems::double_pendulum::PROBLEM };
    let setting = ProblemSetting {
        method: "Dop853",
        tick: problem.tick,
        events: EventTiming::Located,
        ..ProblemSetting::default()
    };
    let mut simulation = problem.load(&setting).unwrap_or_else(|error| panic!("{error}"));
    let exponent = 1.3 * truth.number("largest Lyapunov exponent (finite time)");
    for time in [10.0, 15.0, 20.0] {
        run_to(&mut simulation, time);
        let row = truth.row("theta..omega, long, 40-digit arithmetic", time).expect("a row for each time");
        let exact = problems::double_pendulum::places(&row);
        let error =
            greatest(exact.iter().zip(&simulation.bodies().position).map(|(exact, found)| exact.distance(*found)));
        let bound = f64::EPSILON * (time / problem.tick).sqrt() * libm::exp(exponent * time);
        println!("at {time} s: {error:.1e} m of {bound:.1e} m");
        assert!(error <= bound, "at {time} s: {error:e} m of {bound:e} m");
    }
}
