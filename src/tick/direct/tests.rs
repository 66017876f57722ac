//! Ticks without schedules against those with them.

use bevy_app::App;
use bevy_ecs::schedule::{ScheduleLabel, Schedules};

use super::*;
use crate::Simulation;
use crate::contacts::DeepestOverlap;
use crate::forces::Targets;
use crate::forces::drag::{self, DragForce};
use crate::forces::gravity::{self, Gravity};
use crate::integrate::{LocatedEvents, StepCount};
use crate::scene::Source;
use crate::tick::{Evaluate, Modes, SimTick, TickAppExt, Watch, add_packed_observer};
use crate::world::hash::state_hash;

/// Blocks that fall into a corner and come to rest, each kind of part beside the others.
fn scene(clock: &str, contacts: &str) -> Source {
    scene_with(clock, contacts, "")
}

fn scene_with(clock: &str, contacts: &str, forces: &str) -> Source {
    let block = |number: usize| {
        format!(
            "(name: \"{number}\", at: ({}, {}), spin: {number}, material: \"stone\",
              atoms: Picture(spacing: 0.1, mass: 0.02, rows: [\"##\", \"##\"])),",
            0.3 + 0.25 * (number % 3) as f64,
            0.3 + 0.3 * number as f64
        )
    };
    let blocks: String = (0..6).map(block).collect();
    let text = format!(
        "Scene(format: 1, clock: ({clock}),
        gravity: (0.1, -9.81), contacts: Penalty({contacts}), forces: [{forces}],
        materials: {{ \"stone\": (stiffness: 4000, friction: 0.4, inelasticity: 0.4) }},
        walls: [
            (name: \"floor\", left: (1, 0), right: (0, 0), material: \"stone\"),
            (name: \"left\", left: (0, 0), right: (0, 1), material: \"stone\"),
            (name: \"right\", left: (1.1, 1), right: (1.1, 0), material: \"stone\"),
        ],
        bodies: [{blocks}],
        sensors: [ContactForce(on: \"floor\"), Energy()],
        expect: [Inside(of: \"*\", box: ((0, 0), (1.1, 3))), Channel(name: \"energy.residual\", below: 0.01),
            Channel(name: \"0.position.y\", below: 1)])"
    );
    Source::new("direct.ron", text)
}

fn is_direct(world: &World) -> bool {
    let schedules = world.resource::<Schedules>();
    let [tick, evaluate, modes] =
        [SimTick.intern(), Evaluate.intern(), Modes.intern()].map(|label| schedules.get(label).unwrap());
    let method = world.resource::<Drive>().method.as_ref();
    method.is_none_or(|method| method.0.is_direct()) && stands_for_all(world, [tick, evaluate, modes])
}

/// Runs the scene in both ways, in batches that end at these ticks and at its end. How many events were located, and how many
/// ticks were too crowded for that.
fn compare(clock: &str, contacts: &str, batches: &[u64]) -> LocatedEvents {
    compare_scene(&scene(clock, contacts), batches)
}

fn compare_scene(scene: &Source, batches: &[u64]) -> LocatedEvents {
    let load = || Simulation::load(scene).unwrap_or_else(|errors| panic!("{errors}"));
    let (mut direct, mut scheduled) = (load(), load());
    // One system more is enough.
    add_packed_observer(scheduled.world_mut(), || {});
    for tick in batches.iter().copied().chain([direct.ticks()]) {
        direct.run_to_tick(tick).unwrap();
        scheduled.run_to_tick(tick).unwrap();
        assert_eq!(state_hash(direct.bodies()), state_hash(scheduled.bodies()), "{tick}: {scene:?}");
    }
    assert!(is_direct(direct.world()) && !is_direct(scheduled.world()));
    assert_eq!(direct.outcomes(), scheduled.outcomes());
    let [direct, scheduled] = [direct.world(), scheduled.world()];
    assert_eq!(direct.resource::<Ledger>(), scheduled.resource::<Ledger>());
    assert_eq!(direct.resource::<Balance>(), scheduled.resource::<Balance>());
    assert_eq!(direct.resource::<Evaluation>(), scheduled.resource::<Evaluation>());
    assert_eq!(direct.resource::<DeepestOverlap>().share, scheduled.resource::<DeepestOverlap>().share);
    assert_eq!(direct.get_resource::<StepCount>(), scheduled.get_resource::<StepCount>());
    assert_eq!(direct.get_resource::<LocatedEvents>(), scheduled.get_resource::<LocatedEvents>());
    direct.get_resource().copied().unwrap_or_default()
}

const LAWS: [&str; 4] = ["", "normal: Dashpot, damping: 2", "tangential: None", "rolling: Spring(friction: 0.05)"];

#[test]
fn both_ways_give_the_same_bits() {
    for law in LAWS {
        for method in ["VelocityVerlet", "SemiImplicitEuler"] {
            compare(&format!("duration: 2, tick: 0.0005, method: {method}"), law, &[1, 2, 9, 1000]);
        }
    }
}

/// Discs that fall, pile up and come to rest in part, at whom nobody looks: so the last kick of each tick waits for the next step.
/// Beside them a few that rest are hit by others.
fn heap(method: &str, contacts: &str, count: usize, more: &str) -> Source {
    let disc = |name: &str, number: u32, place: (f64, f64), more: &str| {
        let at = format!("at: {place:?}, {more}, material: \"stone\"");
        format!("(name: \"{name}_{number}\", {at}, atoms: Disc(radius: 0.1, mass: 0.1)),")
    };
    let mut bodies = String::new();
    for number in 0..20 {
        bodies += &disc("fence", number, (3.1, 0.1 + 0.15 * f64::from(number)), "fixed: true");
    }
    for number in 0..8 {
        let x = 3.4 + 0.3 * f64::from(number);
        bodies += &disc("resting", number, (x, 0.1), "spin: 0");
        bodies += &disc("shell", number, (x + 0.03, 2.0 + f64::from(number)), "velocity: (0.1, 0)");
    }
    let text = format!(
        "Scene(format: 1, clock: (duration: 1.5, tick: 0.0005, method: {method}),
        gravity: (0, -9.81), contacts: Penalty({contacts}),
        materials: {{ \"stone\": (stiffness: 4000, friction: 0.4, inelasticity: 0.6) }},
        walls: [
            (name: \"floor\", left: (3, 0), right: (0, 0), material: \"stone\"),
            (name: \"left\", left: (0, 0), right: (0, 1), material: \"stone\"),
        ],
        bodies: [{bodies}],
        fill: [(name: \"grain\", atoms: Disc(radius: 0.035, mass: 0.02), material: \"stone\", count: {count},
            within: ((0.1, 0.1), (2.9, 2.9)))]{more})"
    );
    Source::new("heap.ron", text)
}

/// With a few grains rest is looked for in each tick, with many in some.
#[test]
fn both_ways_give_the_same_bits_in_heaps_at_which_nobody_looks() {
    for (contacts, count) in [("normal: Dashpot", 900), ("normal: Dashpot", 30), ("normal: Inelasticity", 20)] {
        compare_scene(&heap("VelocityVerlet", contacts, count, ""), &[1, 2, 700, 701]);
    }
    for method in ["SemiImplicitEuler", "VelocityVerlet, events: Located"] {
        compare_scene(&heap(method, "normal: Dashpot", 20, ""), &[1, 700]);
    }
    // Whoever looks sees velocities as they are.
    let looking = ", expect: [AtRest(of: \"resting_3\", from: 0, speed_below: 1e-6)]";
    compare_scene(&heap("VelocityVerlet", "normal: Dashpot", 900, looking), &[1, 700]);
}

#[test]
fn both_ways_give_the_same_bits_where_events_are_located() {
    let methods = [
        "VelocityVerlet, events: Located",
        "SemiImplicitEuler, events: Located",
        "ExplicitEuler",
        "RungeKutta4",
        "Dop853",
        "ImplicitMidpoint",
        "Symplectic4",
    ];
    for (law, method) in LAWS.iter().flat_map(|law| methods.map(|method| (law, method))) {
        let clock = format!("duration: 0.5, tick: 0.001, method: {method}");
        assert!(compare(&clock, law, &[1, 2, 9, 240, 241, 242]).count > 0, "{law}, {method}");
    }
    // Crowds, in which methods change: the same number of events in fewer ticks.
    let crowded = |law: &&str| compare("duration: 1, tick: 0.25, method: RungeKutta4", law, &[1, 2]).given_up > 0;
    assert!(LAWS.iter().any(crowded));
    let exact = "tangential: Exact, rolling: Spring(friction: 0.05)";
    assert!(compare("duration: 0.5, tick: 0.001, method: RungeKutta4", exact, &[1, 2, 9]).count > 0);
}

#[test]
fn both_ways_give_the_same_bits_where_an_error_is_allowed() {
    for law in LAWS {
        for tolerance in ["1e-3", "1e-6"] {
            let clock = format!("duration: 0.5, tolerance: {tolerance}");
            assert!(compare(&clock, law, &[1, 2, 3, 4, 7]).count > 0, "{law}, {tolerance}");
        }
    }
}

#[test]
fn both_ways_give_the_same_bits_where_events_are_at_the_ends_of_stages() {
    for method in ["RungeKutta4", "ImplicitMidpoint", "Symplectic4", "Dop853"] {
        let clock = format!("duration: 0.5, tick: 0.0005, method: {method}, events: PerTick");
        compare(&clock, "tangential: Exact", &[1, 2, 9]);
    }
}

#[test]
fn both_ways_give_the_same_bits_under_all_forces_that_have_a_direct_form() {
    let forces = "Attraction(constant: 0.1, softening: 0.1), Torque(value: 0.001, of: \"1\"), Drag(linear: 0.01),
        Drag(quadratic: 0.01, of: \"2\"), Wind(velocity: (1, 0), linear: 0.01)";
    let clocks = [
        "duration: 1, tick: 0.0005, method: VelocityVerlet",
        "duration: 1, tick: 0.0005, method: SemiImplicitEuler",
        "duration: 0.3, tick: 0.001, method: RungeKutta4",
        "duration: 0.3, tick: 0.001, method: ImplicitMidpoint",
        "duration: 0.3, tolerance: 1e-4",
    ];
    for clock in clocks {
        compare_scene(&scene_with(clock, "", forces), &[1, 2, 3]);
    }
}

/// Of two installations of a force the last has all entries, and acts twice.
#[test]
fn a_force_that_is_installed_twice_keeps_the_schedules() {
    let mut app = App::new();
    app.add_tick();
    for direct in [true, false] {
        assert!(is_direct(app.world()));
        drag::install(vec![DragForce { linear: 0.1, quadratic: 0.0, of: Targets::default() }], &mut app);
        assert_eq!(is_direct(app.world()), direct);
    }
}

/// The weight is where sums of forces begin, and direct forms act in the order in which they are added.
#[test]
fn a_field_that_is_installed_behind_a_force_keeps_the_schedules() {
    let mut app = App::new();
    app.add_tick();
    drag::install(Vec::new(), &mut app);
    assert!(is_direct(app.world()));
    gravity::install(Gravity(glam::DVec2::Y), &mut app);
    assert!(!is_direct(app.world()));
}

/// What a plugin watches, or says of its model otherwise, is asked in the world.
#[test]
fn a_watch_without_a_direct_form_keeps_the_schedules() {
    let kinds: [fn(&mut Models); 4] = [
        |models| {
            models.watches.push(Watch {
                tell: |_, _| {},
                switch: |_, _| {},
                settle: |_| false,
                take_stock: |_| {},
                tidy: |world| {
                    world.resource_mut::<Seen>().0 += 1;
                    false
                },
            });
        },
        |models| models.edges.push(|_, _| f64::INFINITY),
        |models| models.handovers.push(|_, _| {}),
        |models| models.crowds.push(|_| false),
    ];
    for (number, add) in kinds.into_iter().enumerate() {
        let mut simulation = Simulation::load(&scene("duration: 0.1, tolerance: 1e-6", "")).unwrap();
        assert!(is_direct(simulation.world()));
        add(&mut simulation.world_mut().resource_mut::<Models>());
        simulation.world_mut().init_resource::<Seen>();
        assert!(!is_direct(simulation.world()), "{number}");
        simulation.run_to_end().unwrap();
        assert_eq!(simulation.world().resource::<Seen>().0 > 0, number == 0);
    }
}

#[derive(Resource, Default)]
struct Seen(u32);

#[test]
fn a_condition_on_a_stage_holds_in_all_ticks() {
    let fall = |batches: &[u64]| {
        let mut simulation = Simulation::load(&scene("duration: 2, tick: 0.0005, method: VelocityVerlet", "")).unwrap();
        simulation.world_mut().schedule_scope(Evaluate, |_, schedule| {
            schedule.configure_sets(EvaluateStage::Contacts.run_if(|| false));
        });
        batches.iter().for_each(|&tick| simulation.run_to_tick(tick).unwrap());
        simulation
    };
    let (at_once, one_by_one) = (fall(&[1, 1500]), fall(&(1..=1500).collect::<Vec<_>>()));
    assert_eq!(state_hash(at_once.bodies()), state_hash(one_by_one.bodies()));
    // Without contacts the floor is passed: 0.75 s are 2.8 m.
    assert!(at_once.bodies().position.iter().all(|position| position.y < 0.0), "{:?}", at_once.bodies().position);
}
