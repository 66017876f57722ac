//! Law: runs state the faults of one kind of methods. The fault is a force from outside that acts only in steps with stages.
//! It moves a body of 1 kg by `F t^2/2`. Velocity Verlet and methods that locate events then differ by that way. Velocity
//! Verlet states it wherever bodies touch, and the others if contacts carry loads that change.
//!
//! Tolerance: a hundredth of the way, far above the errors of both methods for a constant force. Not tested: faults in part
//! of a run, and scenes that only one kind can run.

use bevy_app::App;
use glam::DVec2;
use jostle::report::estimate::{Effort, EstimateRequest, Repeated, estimate, watch};
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{Energies, EvaluationMode, Model, State, SteadySpring, TickAppExt};
use jostle::{Simulation, SimulationExt};

/// The force of the fault in N, and the length of the run in s.
const FORCE: f64 = 0.01;
const DURATION: f64 = 1.0;
/// The way of a body of 1 kg under it.
const WAY: f64 = 0.5 * FORCE * DURATION * DURATION;

struct Fault;

impl Model for Fault {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn apply_forces(&mut self, state: &mut State) {
        if state.evaluation().mode == EvaluationMode::Frozen {
            let (bodies, rates) = state.bodies_and_rates();
            let force = DVec2::new(FORCE, 0.0);
            rates.outside(bodies.position[1], force, 0.0);
            bodies.push(1, DVec2::ZERO, force);
        }
    }
}

/// A box that lies on the floor under a load, and two bodies that touch nothing, with the fault. The stated error of places in m,
/// and the verdict.
fn stated(load: &str, clock: &str) -> (f64, String) {
    let scene = format!(
        "Scene(format: 1, clock: (duration: {DURATION:?}{clock}), gravity: (0, -9.81),
            materials: {{ \"m\": (stiffness: 1e4, friction: 0.5, restitution: 0.2) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"box\", at: (0, 0.1), material: \"m\", mass: 1, shape: Rectangle(width: 0.2, height: 0.2)),
                     (name: \"ghost\", at: (0, 9), collides: false, atoms: Disc(radius: 0.1, mass: 1)),
                     (name: \"wheel\", at: (3, 9), collides: false, atoms: Disc(radius: 0.1, mass: 1))],
            forces: [{load}])"
    );
    stated_with(scene, |app| {
        app.add_model(Fault);
    })
}

/// The same for a scene without a fault.
fn stated_by(scene: &str) -> (f64, String) {
    stated_with(scene.to_owned(), |_| {})
}

fn stated_with(scene: String, plugins: fn(&mut App)) -> (f64, String) {
    let source = Source::new("kinds.ron", scene);
    let load = |overrides: &Overrides| Simulation::load_with(&source, overrides, plugins);
    let overrides = Overrides::default();
    let mut simulation = load(&overrides).expect("a correct scene");
    let wanted = EstimateRequest { effort: Effort::Little, ..EstimateRequest::default() };
    watch(&mut simulation, wanted);
    simulation.run_to_end().expect("numbers stay finite");
    let repeated = Repeated { overrides: &overrides, load: &load, tell: None, interrupted: None };
    estimate(&mut simulation, wanted, &repeated).expect("the scene is still correct");
    let card = simulation.card();
    (card.error.and_then(|error| error.position.discretisation).expect("an error is stated"), card.verdict)
}

const CLOCKS: [&str; 4] = ["", ", tolerance: 1e-6", ", method: Dop853, tick: 1e-3", ", method: Reference"];

#[test]
fn a_fault_of_one_kind_of_methods_is_stated_under_loads_that_change() {
    for load in [
        "Drive(of: \"box\", force: (1, 0), course: Sine(frequency: 2))",
        "Thrust(of: \"box\", force: (1, 0), from: 0.3)",
        // At its speed the motor gives less than its limit.
        "], joints: [Revolute(name: \"axle\", a: World, anchor_a: (3, 9), b: \"wheel\")],
        controllers: [Motor(name: \"drive\", of: \"axle\", speed: 5, limit: 0.05)",
    ] {
        for clock in CLOCKS {
            let (error, verdict) = stated(load, clock);
            assert!((error - WAY).abs() < 0.01 * WAY, "{load}{clock}: {error:e} stated for {WAY:e}: {verdict}");
            let located = !clock.is_empty();
            assert!(!located || verdict.contains("Do not trust places"), "{load}{clock}: {verdict}");
        }
    }
}

/// Under a constant load, finer runs alone tell the error of methods with located events.
#[test]
fn a_fault_of_runs_from_tick_to_tick_is_stated_under_a_constant_load() {
    for clock in CLOCKS {
        let (error, verdict) = stated("Torque(of: \"ghost\", value: 0)", clock);
        let (least, most) = if clock.is_empty() { (0.99 * WAY, 1.01 * WAY) } else { (0.0, 0.01 * WAY) };
        assert!((least..=most).contains(&error), "{clock}: {error:e} stated: {verdict}");
    }
}

/// Two discs in one body fall on a third. Coarse ticks of velocity Verlet stop springs that swing on, and go elsewhere by half a
/// millimetre. Finer ticks do not. So they are no reason to distrust a run that locates events.
#[test]
fn a_departure_that_finer_ticks_take_back_is_none() {
    for (along, friction, restitution) in [(0.0, 0.6, 0.5), (0.1, 0.3, 0.05), (0.1, 0.3, 0.5), (0.1, 0.6, 0.5)] {
        for clock in [", tolerance: 1e-6", ", method: Reference"] {
            let (error, verdict) = stated_by(&format!(
                "Scene(format: 1, clock: (duration: 0.4{clock}), gravity: (0, -9.81),
                materials: {{ \"m\": (stiffness: 6e4, restitution: {restitution:?}, friction: {friction:?}) }},
                bodies: [(name: \"under\", at: (0, 0), mass: 6, material: \"m\", shape: Disc(radius: 0.25)),
                    (name: \"b\", at: ({along:?}, 0.36), velocity: (0, -0.6), material: \"m\", atoms: List([
                        (at: (-0.09, 0), radius: 0.1, mass: 0.7), (at: (0.1, 0), radius: 0.09, mass: 0.6)]))],
                forces: [Thrust(of: \"under\", force: (0, 58.86)), Thrust(of: \"b\", force: (0, -20))])"
            ));
            assert!(verdict.starts_with("Trust it") && error < 1e-6, "{along}{clock}: {error:e} stated: {verdict}");
        }
    }
}

/// A press holds two boxes on a slope, near all that their contacts can bear. Located events hold them. Velocity Verlet lets them slide, by
/// centimetres, at every tick.
#[test]
fn a_departure_of_bodies_at_their_limits_is_stated() {
    let (error, verdict) = stated_by(
        "Scene(format: 1, clock: (duration: 1.5, method: Dop853, tick: 1e-3), gravity: (-4.025677, -8.945950),
            materials: { \"w\": (stiffness: 1e6, friction: (static: 0.5, dynamic: 0.4), restitution: 0.5) },
            walls: [(name: \"floor\", left: (20, 0), right: (-20, 0), material: \"w\")],
            bodies: [(name: \"a\", at: (0, 0.05), shape: Rectangle(width: 0.4, height: 0.1), mass: 2, material: \"w\"),
                (name: \"b\", at: (0, 0.15), shape: Rectangle(width: 0.3, height: 0.1), mass: 1, material: \"w\")],
            forces: [Drive(of: \"b\", force: (-0.410365, -0.911922), course: Piecewise([(0, 0), (0.3, 0), (1.2, 50)]))])",
    );
    assert!(error > 1e-4 && verdict.contains("Do not trust places: velocity Verlet"), "{error:e} stated: {verdict}");
}

/// Law: bodies that rest in a run, and go elsewhere in a run that locates events, are not trusted to rest. A ceiling presses a wheel
/// that gravity pulls aside. As placed, it presses as a contact that loads, and that holds the wheel. Held contacts let it roll.
#[test]
fn rest_that_a_run_of_the_other_kind_contradicts_is_not_trusted() {
    let scene = |friction: f64| {
        format!(
            "Scene(format: 1, clock: (duration: 0.2), gravity: (20, -10), contacts: Penalty(start: AsPlaced),
                materials: {{ \"m\": (stiffness: 1e6, restitution: 0.3, friction: {friction:?}) }},
                walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\"),
                        (name: \"ceiling\", left: (0, 0.19997), right: (1, 0.19997), material: \"m\")],
                bodies: [(name: \"w\", at: (0, 0.09998), material: \"m\", atoms: Disc(radius: 0.1, mass: 1))])"
        )
    };
    let (error, verdict) = stated_by(&scene(0.8));
    assert!(error > 0.1 && verdict.starts_with("Do not trust it: bodies rest that go"), "{error}: {verdict}");
    // With more friction, all runs rest.
    let (_, verdict) = stated_by(&scene(2.0));
    assert!(verdict.starts_with("Trust it: all bodies rest"), "{verdict}");
}
