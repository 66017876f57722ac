//! The choice of the engine where a scene names neither tick nor method nor tolerance, and failures that name their
//! cause.

use jostle::Simulation;
use jostle::SimulationExt;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::State;

use super::ran::run;

fn scene(name: &str) -> String {
    let path = format!("{}/assets/defects/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|wrong| panic!("{path}: {wrong}"))
}

fn end(text: &str, overrides: &Overrides) -> Simulation {
    let source = Source::new("default.ron", text);
    let mut simulation = Simulation::load_with(&source, overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}"));
    simulation
}

/// Law: a body on a spring along a line is at `L + A cos(omega t)`. Ten swings, slow and fast: the default is right to a
/// millionth of the swing, and states its error to within a factor of ten. It takes fewer evaluations than eight hundred a
/// swing beside two for each tick, at which the run is read.
#[test]
fn smooth_motion_gets_steps_of_high_order() {
    for (stiffness, duration) in [(1.0_f64, 62.8), (0.01, 628.0), (1e4, 0.628)] {
        let text = format!(
            "Scene(format: 1, clock: (duration: {duration:?}), contacts: None,
            bodies: [(name: \"b\", at: (1.25, 0), atoms: Disc(radius: 0.1, mass: 1))],
            forces: [Spring(a: \"b\", b: World, anchor_b: (0, 0), stiffness: {stiffness:?}, length: 1)])"
        );
        let simulation = end(&text, &Overrides::default());
        let (omega, time) = (stiffness.sqrt(), simulation.clock().time());
        let exact = 1.0 + 0.25 * libm::cos(omega * time);
        let error = (simulation.bodies().position[0].x - exact).abs();
        let ran = run(&text, 1).unwrap_or_else(|why| panic!("{why}"));
        let stated = ran.stated().unwrap_or_else(|| panic!("{}", ran.card.verdict));
        assert_eq!(ran.card.method, "Dop853", "{}", ran.card);
        assert!(error < 1e-6 * 0.25, "{stiffness}: {error:e}");
        assert!(stated.0 > 0.1 * error && stated.0 < 1e-5, "{stiffness}: {error:e}, {stated:?} stated");
        assert!(ran.is_trusted(), "{}", ran.card);
        let swings = omega * time / std::f64::consts::TAU;
        let evaluations = simulation.resource::<State>().evaluation().count as f64;
        let looks = simulation.ticks() as f64;
        assert!(
            evaluations < 800.0 * swings + 2.0 * looks,
            "{stiffness}: {evaluations} evaluations of {swings} swings"
        );
    }
}

/// The swing of 89 s over 2000 s: no more ticks than frames, and few evaluations beside them.
#[test]
fn a_slow_scene_does_not_take_millions_of_ticks() {
    let simulation = end(&scene("slow_default"), &Overrides::default());
    let evaluations = simulation.resource::<State>().evaluation().count;
    assert!(simulation.ticks() <= 60_000 && evaluations < 200_000, "{} {evaluations}", simulation.ticks());
    let notes = simulation.notes().join("; ");
    assert!(notes.contains("method Dop853 chosen: "), "{notes}");
    let drift = simulation.card().energy_error();
    assert!(drift < 1e-7, "{drift:e} of the energy");
}

/// Contacts, drives, a tick or a method that the scene names, and accelerations that do not change: the choice stays what
/// the manual says of them.
#[test]
fn other_scenes_keep_their_methods() {
    let text = |clock: &str, more: &str| {
        format!(
            "Scene(format: 1, clock: (duration: 0.1{clock}), gravity: (0, -1), bodies: [(name: \"b\", at: (0, 5), atoms: Disc(radius: 0.1))]{more})"
        )
    };
    let spring = ", forces: [Spring(a: \"b\", b: World, anchor_b: (0, 0), stiffness: 10)]";
    let drive = ", forces: [Spring(a: \"b\", b: World, anchor_b: (0, 0), stiffness: 10), Thrust(of: \"b\", force: (1, 0), from: 0.02, to: 0.05)]";
    let wall = ", walls: [(name: \"w\", left: (1, 0), right: (0, 0))]";
    for (clock, more, method) in [
        ("", spring, "Dop853"),
        (", tick: 1e-3", spring, "Symplectic4"),
        (", method: RungeKutta4", spring, "RungeKutta4"),
        ("", drive, "RungeKutta4"),
        ("", "", "VelocityVerlet"),
        ("", wall, "VelocityVerlet"),
    ] {
        let simulation = end(&text(clock, more), &Overrides::default());
        let card = simulation.card();
        assert_eq!(card.method, method, "{clock}{more}");
        // A contact asks for a finer tick.
        assert!((card.tick - 1e-3).abs() < 1e-12 || more == wall, "{clock}{more}: {}", card.tick);
    }
}

/// A cause that the scene does not have is blamed for nothing: a run without drag that fails is not told of drag.
#[test]
fn what_the_scene_lacks_is_not_blamed() {
    let text = "Scene(format: 1, clock: (duration: 1, tick: 0.1, method: ExplicitEuler), contacts: None,
        bodies: [(name: \"b\", at: (1.5, 0), atoms: Disc(radius: 0.1, mass: 1e-300))],
        forces: [Spring(a: \"b\", b: World, anchor_b: (0, 0), stiffness: 1e300, length: 1)])";
    let source = Source::new("blame.ron", text);
    let mut simulation = Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(simulation.run_to_end().is_err());
    let why = simulation.card().why.unwrap_or_default();
    assert!(!why.contains("drag takes"), "{why}");
}
