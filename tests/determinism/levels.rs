//! Promise: the vector instructions of the processor change no bit of a run, neither in the state nor in the accounts.

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simd::Level;
use jostle::simulation::Overrides;
use jostle::tick::Ledger;
use jostle::world::hash::state_hash;

fn run(name: &str, text: &str, level: Level, duration: f64) -> (u64, Ledger) {
    let overrides = Overrides { level: Some(level), duration: Some(duration), ..Overrides::default() };
    let simulation = Simulation::load_with(&Source::new(name, text), &overrides, |_| {});
    let mut simulation = simulation.unwrap_or_else(|errors| panic!("{name}: {errors}"));
    simulation.run_to_end().expect("numbers stay finite");
    (state_hash(simulation.bodies()), simulation.state().ledger().clone())
}

fn demand_same_bits(name: &str, text: &str, duration: f64) {
    let expected = run(name, text, Level::Scalar, duration);
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        assert_eq!(run(name, text, level, duration), expected, "{name} with {level}");
    }
}

#[test]
fn shipped_scenes_end_in_the_same_bits_at_all_levels() {
    for (name, duration) in [("tetris", 6.0), ("billiards", 3.0), ("plinko", 1.0), ("conveyor", 2.0)] {
        let path = format!("{}/scenes/{name}.ron", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("the scene is there");
        demand_same_bits(name, &text, duration);
    }
}

/// Grains of two sizes and two materials, clumps among them, under both normal laws: blocks of eight pairs of many laws, some
/// of them held, slipping, parting.
#[test]
fn so_do_heaps_under_both_laws() {
    for contacts in [
        "Penalty()",
        "Penalty(normal: Dashpot)",
        "Penalty(normal: Dashpot, damping: 3)",
        "Penalty(normal: Dashpot, damping_rate: 100)",
        "Penalty(tangential: None)",
        "Penalty(rolling: Spring(friction: 0.1))",
    ] {
        let text = format!(
            "Scene(format: 1, clock: (duration: 1, tick: 0.001), gravity: (0, -9.81), contacts: {contacts},
            materials: {{ \"stone\": (stiffness: 20000, friction: (static: 0.6, dynamic: 0.4), restitution: 0.4, density: 10),
                          \"wood\": (stiffness: 10000, friction: 0.3, restitution: 0.6, density: 5) }},
            walls: [(name: \"floor\", left: (2, 0), right: (0, 0)), (name: \"left\", left: (0, 0), right: (0, 1)),
                    (name: \"right\", left: (2, 1), right: (2, 0))],
            fill: [
                (name: \"grain\", atoms: Disc(radius: 0.05), material: \"stone\", count: 61, within: ((0, 0), (2, 3)), speed: 1),
                (name: \"log\", atoms: List([(at: (0, 0), radius: 0.06), (at: (0.1, 0), radius: 0.08)]), material: \"wood\",
                 count: 13, within: ((0, 0), (2, 3)), speed: 1),
            ])"
        );
        demand_same_bits(contacts, &text, 1.0);
    }
}

/// Discs that fly for most of the time, under both normal laws.
#[test]
fn so_do_gases() {
    for contacts in ["Penalty()", "Penalty(normal: Dashpot, damping_rate: 100)"] {
        let text = format!(
            "Scene(format: 1, clock: (duration: 0.5, tick: 0.001, method: VelocityVerlet), gravity: (0, -1), contacts: {contacts},
            materials: {{ \"stone\": (stiffness: 20000, friction: 0.4, restitution: 0.8, density: 10) }},
            walls: [(name: \"floor\", left: (6, 0), right: (0, 0)), (name: \"left\", left: (0, 0), right: (0, 1)),
                    (name: \"right\", left: (6, 1), right: (6, 0))],
            fill: [(name: \"disc\", atoms: Disc(radius: 0.05), material: \"stone\", count: 301, within: ((0, 0), (6, 6)), speed: 3)])"
        );
        demand_same_bits(contacts, &text, 0.5);
        let mut simulation =
            Simulation::load(&Source::new("gas.ron", &text)).unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_tick(400).unwrap();
        assert!(simulation.bodies().flying() > 200, "{} fly", simulation.bodies().flying());
    }
}
