//! Laws of joints beside the problems: energy of RATTLE in a million ticks, structures with more rows than freedoms, gears.
//!
//! Sources and tolerances: at each test. Joint drift: 1e-12 of the size of the mechanism, for all methods. Not tested: contacts beside
//! joints; motions with a reference, see `problems` and `mechanisms`.

use std::fmt::Write as _;

use jostle::joints::Joint;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

/// Joint drift is below that, for mechanisms of some metres.
const DRIFT: f64 = 1e-12;

fn load(method: &str, tick: f64, body: &str) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: {method}), gravity: (0, -9.81), contacts: None, {body})"
    );
    Simulation::load_with(&Source::new("joints.ron", scene), &Overrides::default(), |_| {})
        .unwrap_or_else(|errors| panic!("{errors}"))
}

fn run_to(simulation: &mut Simulation, time: f64) {
    let tick = (time / simulation.clock().dt).round() as u64;
    simulation.run_to_tick(tick).unwrap();
}

fn demand_small_drift(simulation: &Simulation, of: &str) {
    let drift = simulation.card().largest_joint_drift.expect("the scene has joints");
    assert!(drift.meters < DRIFT, "{of}: {drift:?}");
    for joint in simulation.state().models_of::<Joint>() {
        assert!(joint.drift(simulation.bodies()) < DRIFT, "{of}: {} is open", joint.name);
    }
}

const CLUSTER: &str = "bodies: [(name: \"cluster\", datum: Origin, at: (0, 0), atoms: List([
        (at: (0, 0), radius: 0.1, mass: 1), (at: (0.3, -0.2), radius: 0.15, mass: 1.5), (at: (0.5, 0.1), radius: 0.1, mass: 0.7)]))],
    joints: [Revolute(name: \"pin\", a: World, b: \"cluster\", anchor_b: (0, 0))]";

/// Law: RATTLE is symplectic (Hairer, Lubich, Wanner, theorem VII.1.3), so the energy of a conservative mechanism has no trend: its
/// greatest error in a million ticks is that of the first fifty thousand, within a tenth.
#[test]
fn energy_of_velocity_verlet_has_no_trend_in_a_million_ticks() {
    let mut simulation = load("VelocityVerlet", 0.002, CLUSTER);
    let mut worst = [0.0_f64; 2];
    for look in 1..=20_000 {
        simulation.run_to_tick(50 * look).unwrap();
        let error = simulation.card().energy.residual.abs();
        worst[usize::from(look > 1000)] = error.max(worst[usize::from(look > 1000)]);
    }
    assert!(worst[1] < 1.1 * worst[0], "{worst:?}");
    assert!(worst[0] > 1e-9, "it is an error of the method: {worst:?}");
    demand_small_drift(&simulation, "a million ticks");
}

/// Law: a grid of discs with pins in all four directions, more rows than its bodies have freedoms, is a rigid body that hangs in two corners: it
/// stays, and the pins of the corners bear its weight. Tolerance: rounding of a weight of 78 N. The card has nothing to say against
/// a structure that stands still.
#[test]
fn a_grid_with_more_pins_than_freedoms_hangs_still() {
    let (size, pitch) = (9, 0.2);
    let (mut bodies, mut joints) = (String::new(), String::new());
    for column in 0..size {
        for row in 0..size {
            let fixed = row == 0 && (column == 0 || column == size - 1);
            let (x, y) = (pitch * f64::from(column), -pitch * f64::from(row));
            writeln!(
                bodies,
                "(name: \"d{column}_{row}\", at: ({x:?}, {y:?}), mass: 0.1, fixed: {fixed}, atoms: Disc(radius: 0.08)),"
            )
            .unwrap();
            for (right, down, from, to) in [(1, 0, "(0.1, 0)", "(-0.1, 0)"), (0, 1, "(0, -0.1)", "(0, 0.1)")] {
                let (next, below) = (column + right, row + down);
                if next < size && below < size {
                    writeln!(
                        joints,
                        "Revolute(a: \"d{column}_{row}\", anchor_a: {from}, b: \"d{next}_{below}\", anchor_b: {to}),"
                    )
                    .unwrap();
                }
            }
        }
    }
    for method in ["VelocityVerlet", "RungeKutta4"] {
        let mut simulation = load(method, 0.01, &format!("bodies: [{bodies}], joints: [{joints}]"));
        let before = simulation.bodies().position.clone();
        run_to(&mut simulation, 0.5);
        let moved = simulation.bodies().position.iter().zip(&before).map(|(now, was)| now.distance(*was));
        assert!(moved.fold(0.0, f64::max) < 1e-13, "{method}");
        let state = simulation.state();
        let corners = state.models_of::<Joint>().filter(|joint| {
            joint.pair(state.bodies()).is_some_and(|pair| {
                pair.a.body.is_some_and(|body| !state.bodies().dynamic[body])
                    || pair.b.body.is_some_and(|body| !state.bodies().dynamic[body])
            })
        });
        // The reaction acts on the second body, which is a corner in one of the four joints.
        let weight: f64 = corners
            .map(|joint| {
                let pair = joint.pair(state.bodies()).unwrap();
                let on_grid = pair.b.body.is_some_and(|body| state.bodies().dynamic[body]);
                if on_grid { joint.reaction.0.y } else { -joint.reaction.0.y }
            })
            .sum();
        let exact = 0.1 * 9.81 * f64::from(size * size - 2);
        assert!((weight - exact).abs() < 1e-9, "{method}: {weight} instead of {exact}");
        let card = simulation.card();
        assert!(card.verdict.starts_with("Trust") || !card.verdict.contains("Do not"), "{method}: {}", card.verdict);
        demand_small_drift(&simulation, method);
    }
}

/// Two wheels that turn about their centres, one of them at the origin, and a pendulum on the second: gears divide the torque as they
/// divide the rates. Where nothing has a size but the wheels, gaps of rounding are no failure. The energy is that of the start, and the
/// angles keep their ratio.
#[test]
fn gears_about_the_origin_keep_their_ratio_and_the_energy() {
    for (method, tolerance) in
        [("Dop853", 1e-11), ("RungeKutta4", 1e-7), ("VelocityVerlet", 1e-3), ("Symplectic4", 1e-6)]
    {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 3, tick: \"1 ms\", method: {method}), gravity: (0, -9.81), contacts: None,
             bodies: [(name: \"first\", at: (0, 0), spin: 3, mass: 2, inertia: 0.3, atoms: Disc(radius: 0.05)),
                (name: \"second\", at: (1, 0), spin: -6, mass: 1, inertia: 0.1, atoms: Disc(radius: 0.05)),
                (name: \"bob\", at: (1, -0.7), velocity: (-1.8, 0), mass: 0.5, inertia: 0.02, atoms: Disc(radius: 0.05))],
             joints: [Revolute(name: \"p\", a: World, anchor_a: (0, 0), b: \"first\"),
                Revolute(name: \"q\", a: World, anchor_a: (1, 0), b: \"second\"), GearPair(of: (\"p\", \"q\"), ratio: -2),
                Revolute(a: \"second\", anchor_a: (0, -0.3), b: \"bob\", anchor_b: (0, 0.4))],
             sensors: [Energy()])"
        );
        let mut simulation =
            Simulation::load(&Source::new("gears.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_tick(3000).unwrap_or_else(|failure| panic!("{method}: {failure}"));
        let bodies = simulation.bodies();
        assert!((bodies.angle[1] + 2.0 * bodies.angle[0]).abs() < 1e-13, "{method}");
        assert!(bodies.position[0].length() < 1e-14, "{method}");
        let residual = simulation.card().energy.residual;
        assert!(residual.abs() < tolerance, "{method}: {residual}");
    }
}
