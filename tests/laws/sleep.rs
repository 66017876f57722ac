//! Law: to leave bodies at rest out of the work changes nothing, before and after they wake (numerics: a body whose
//! forces balance and do not change stays at rest). A run whose evaluations include them ends in the same bits.
//!
//! Tolerances: none for the motion. The force on the floor is summed in another order while bodies are asleep: sums of `n` terms of
//! one sign in two orders differ by at most `2 (n - 1) u` of themselves, `u = 2^-53`; those along the floor, of both signs, by as
//! much of the sum of their sizes, which friction keeps below that of the normal forces.
//!
//! Not tested: bodies at rest under forces that change, which are always looked at.

use std::fmt::Write;

use glam::DVec2;
use jostle::Simulation;
use jostle::contacts::penalty::PenaltyState;
use jostle::tick::State;
use jostle::world::Velocity;
use jostle::world::hash::state_hash;

use super::support::{load, run_to};

/// A heap that comes to rest, and is hit by a bullet at 4 s; a ball far away goes on falling.
fn heap(normal: &str, grains: u32) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 6, tick: 0.001, method: VelocityVerlet), gravity: (0, -5),
        materials: {{ \"stone\": (stiffness: 20000, friction: 0.5, restitution: 0.3, density: 10) }},
        contacts: Penalty(normal: {normal}),
        walls: [(name: \"floor\", left: (3, 0), right: (0, 0), material: \"stone\"),
                (name: \"left\", left: (0, 0), right: (0, 1), material: \"stone\"),
                (name: \"right\", left: (3, 1), right: (3, 0), material: \"stone\")],
        fill: [(name: \"grain\", atoms: Disc(radius: 0.1), material: \"stone\", count: {grains}, within: ((0.1, 0.1), (2.9, 1.5)))],
        bodies: [
            (name: \"block\", at: (1.5, 1.8), material: \"stone\",
             atoms: Picture(spacing: 0.2, mass: 0.3, rows: [\"##\", \"##\"])),
            (name: \"bullet\", at: (1.5, 42), material: \"stone\", atoms: Disc(radius: 0.05)),
        ],
        sensors: [ContactForce(on: \"floor\")])"
    )
}

fn load_awake(text: &str, may_sleep: bool) -> Simulation {
    let mut simulation = load(text);
    let mut state = simulation.world_mut().resource_mut::<State>();
    state.model_mut::<PenaltyState>().unwrap().contacts.may_sleep = may_sleep;
    simulation
}

/// While some grains are asleep and the block and the bullet still fall onto them, and after.
#[test]
fn the_force_on_the_floor_is_the_same_but_for_its_last_bits() {
    let text = heap("Inelasticity", 24);
    let (mut asleep, mut awake) = (load_awake(&text, true), load_awake(&text, false));
    let mut partly = 0;
    for tick in (2000..6000).step_by(20) {
        asleep.run_to_tick(tick).unwrap();
        awake.run_to_tick(tick).unwrap();
        let force = |simulation: &Simulation| simulation.state().contact_forces().unwrap().on_wall[0];
        let (found, expected) = (force(&asleep), force(&awake));
        let terms = asleep.bodies().atom_count() as f64;
        let rounding = terms * f64::EPSILON * expected.y.abs();
        assert!((found - expected).abs().max_element() <= rounding, "{found} {expected} at tick {tick}");
        let bodies = asleep.bodies();
        partly += u32::from(!bodies.asleep.is_empty() && !bodies.all_asleep());
    }
    assert!(partly > 0, "at no time some were asleep and others not");
}

#[test]
fn sleep_changes_no_bit() {
    for (normal, grains) in [("Inelasticity", 24), ("Dashpot", 3)] {
        let text = heap(normal, grains);
        let (mut asleep, mut awake) = (load_awake(&text, true), load_awake(&text, false));
        let mut slept = false;
        for time in [1.0, 2.0, 3.0, 3.9, 4.0, 4.1, 4.2, 5.0, 6.0] {
            run_to(&mut asleep, time);
            run_to(&mut awake, time);
            assert_eq!(state_hash(asleep.bodies()), state_hash(awake.bodies()), "{normal} at {time} s");
            assert!(awake.bodies().asleep.is_empty());
            slept |= asleep.bodies().asleep.iter().any(|bits| *bits != 0);
        }
        assert!(slept, "{normal}: nobody slept");
    }
}

/// Blocks that land one after the other, a bullet that has candidate lists made anew every few ticks all the while, and a
/// ball that falls on the first of them once all are at rest.
fn landings() -> String {
    let mut blocks = String::new();
    for number in 0..40 {
        let (x, y) = (0.5 * f64::from(number), 0.11 + 0.003 * f64::from(number));
        let _ = write!(
            blocks,
            "(name: \"block_{number}\", at: ({x:?}, {y:?}), material: \"stone\",
              atoms: Picture(spacing: 0.1, mass: 0.3, rows: [\"##\", \"##\"])),"
        );
    }
    format!(
        "Scene(format: 1, clock: (duration: 2, tick: 0.0005, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{ \"stone\": (stiffness: 50000, friction: 0.5, restitution: 0.3, density: 10) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"stone\")],
        bodies: [{blocks}
            (name: \"ball\", at: (0.03, 10), material: \"stone\", atoms: Disc(radius: 0.05)),
            (name: \"bullet\", at: (0, 100), velocity: (40, 40), material: \"stone\", atoms: Disc(radius: 0.05))])"
    )
}

#[test]
fn a_body_is_laid_to_rest_in_the_tick_in_which_lists_are_made_anew_as_in_any_other() {
    let text = landings();
    let (mut asleep, mut awake) = (load_awake(&text, true), load_awake(&text, false));
    let version = |simulation: &Simulation| simulation.state().pairs().unwrap().version;
    let moving = |simulation: &Simulation| simulation.bodies().velocity.iter().filter(|v| **v != DVec2::ZERO).count();
    let (mut coincidences, mut before) = (0, (version(&asleep), moving(&asleep)));
    for tick in 1..=4000 {
        let sleepers = asleep.bodies().asleep.iter().any(|bits| *bits != 0);
        for simulation in [&mut asleep, &mut awake] {
            simulation.run_to_tick(tick).expect("numbers stay finite");
        }
        assert_eq!(state_hash(asleep.bodies()), state_hash(awake.bodies()), "tick {tick}");
        let now = (version(&asleep), moving(&asleep));
        coincidences += u32::from(sleepers && now.0 != before.0 && now.1 < before.1);
        before = now;
    }
    assert!(coincidences > 0, "nobody was laid to rest while others slept and lists were made anew");
}

/// More bodies than boxes are swept for, all but four of which come to rest: one flies far away, one bounces between two of the
/// others, one slides into the end of the row, gives its motion on to a disc that is farther from the next than lists reach, and
/// stands; and one falls on the row from so high that many lists were made by then.
fn a_few_among_many(block: &str) -> String {
    let mut row = String::new();
    for number in 0..240 {
        let _ = write!(
            row,
            "(name: \"{number}\", at: ({:?}, 0.05), material: \"{}\", atoms: Disc(radius: 0.05)),",
            0.2 * f64::from(number) + 0.8 * f64::from((number - 230).max(0)),
            if number > 230 { "ice" } else { "stone" }
        );
    }
    format!(
        "Scene(format: 1, clock: (duration: 2, tick: 0.0005, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{
            \"stone\": (stiffness: 50000, friction: 0.5, restitution: 0.3, density: 10),
            \"ice\": (stiffness: 50000, friction: 0, restitution: 1, density: 10),
            \"lake\": (stiffness: 50000, friction: 0, restitution: 0.3, density: 10),
        }},
        walls: [(name: \"floor\", left: (100, 0), right: (-10, 0), material: \"lake\")],
        bodies: [{row} {block}
            (name: \"beside\", at: (20.1, 4.5), material: \"ice\", atoms: Disc(radius: 0.04)),
            (name: \"far\", at: (70, 100), velocity: (20, 20), material: \"ice\", atoms: Disc(radius: 0.05)),
            (name: \"striker\", at: (57, 0.05), velocity: (-3, 0), material: \"ice\", atoms: Disc(radius: 0.05)),
            (name: \"late\", at: (10.02, 10), velocity: (0, -1), material: \"stone\", atoms: Disc(radius: 0.1)),
        ])"
    )
}

#[test]
fn lists_that_stay_because_most_sleep_change_no_bit() {
    let block = "(name: \"block\", at: (-2, 0.11), material: \"stone\",
        atoms: Picture(spacing: 0.1, mass: 0.3, rows: [\"##\", \"##\"])),";
    for text in [a_few_among_many(""), a_few_among_many(block)] {
        let (mut asleep, mut awake) = (load_awake(&text, true), load_awake(&text, false));
        let lists = |simulation: &Simulation| simulation.state().pairs().unwrap().version;
        let (mut stayed, mut woken, mut before) = (0, 0, (0, 0, 0));
        for tick in 1..=4000 {
            for simulation in [&mut asleep, &mut awake] {
                simulation.run_to_tick(tick).expect("numbers stay finite");
                if tick == 200 {
                    // By hand: of whoever was awake before no pair changes.
                    let kicked = simulation.bodies().entity[231];
                    *simulation.world_mut().get_mut::<Velocity>(kicked).unwrap() = Velocity(DVec2::new(-3.0, 0.0));
                }
            }
            assert_eq!(state_hash(asleep.bodies()), state_hash(awake.bodies()), "tick {tick}");
            let sleepers = asleep.bodies().asleep.iter().map(|bits| bits.count_ones()).sum::<u32>();
            let now = (lists(&asleep), lists(&awake), sleepers);
            stayed += u32::from(now.0 == before.0 && now.1 > before.1);
            woken += u32::from(now.2 < before.2);
            before = now;
        }
        assert!(stayed > 10, "lists stayed {stayed} times");
        assert!(woken > 1, "sleepers woke {woken} times");
    }
}

/// Discs that stand on the floor, one beside the other, and a gas that hits them now and then, so that all wake: most of it flies until they
/// rest again.
fn shelled(method: &str, seed: u32) -> String {
    let mut row = String::new();
    for number in 0..8 {
        let _ = write!(
            row,
            "(name: \"{number}\", at: ({:?}, 0.1), material: \"stone\", atoms: Disc(radius: 0.1)),",
            3.3 + 0.2 * f64::from(number)
        );
    }
    format!(
        "Scene(format: 1, clock: (duration: 1.5, tick: 0.0005, method: {method}), gravity: (0, -9.81),
        materials: {{
            \"stone\": (stiffness: 20000, friction: 0.5, restitution: 0, density: 10),
            \"air\": (stiffness: 20000, friction: 0, restitution: 1, density: 10),
        }},
        contacts: Penalty(normal: Inelasticity),
        walls: [(name: \"floor\", left: (8, 0), right: (0, 0), material: \"air\"),
                (name: \"left\", left: (0, 0), right: (0, 8), material: \"air\"),
                (name: \"right\", left: (8, 8), right: (8, 0), material: \"air\")],
        bodies: [{row}],
        fill: [(name: \"gas\", atoms: Disc(radius: 0.03), material: \"air\", count: 118, within: ((0.1, 2.6), (7.9, 8)),
            speed: 2, seed: {seed})])"
    )
}

/// Sleepers that are hit have all forces evaluated once more: nothing but these may follow from it, not when lists are made, and so
/// not when others begin to fly.
#[test]
fn whoever_flies_does_not_see_who_sleeps() {
    for method in ["VelocityVerlet", "SemiImplicitEuler"] {
        let (mut flew, mut woken) = (false, 0);
        for seed in 1..=8 {
            let text = shelled(method, seed);
            let (mut asleep, mut awake) = (load_awake(&text, true), load_awake(&text, false));
            let mut before = 0;
            for tick in (10..=asleep.ticks()).step_by(10) {
                for simulation in [&mut asleep, &mut awake] {
                    simulation.run_to_tick(tick).expect("numbers stay finite");
                }
                let what = format!("{method}, seed {seed}, tick {tick}");
                assert_eq!(state_hash(asleep.bodies()), state_hash(awake.bodies()), "{what}");
                assert_eq!(asleep.bodies().flying(), awake.bodies().flying(), "{what}");
                let sleepers = asleep.bodies().asleep.iter().map(|bits| bits.count_ones()).sum::<u32>();
                woken += u32::from(sleepers < before);
                flew |= woken > 0 && asleep.bodies().flying() > 0;
                before = sleepers;
            }
        }
        assert!(woken > 3, "{method}: sleepers woke {woken} times");
        assert_eq!(flew, method == "VelocityVerlet", "{method}");
    }
}

/// Promise: what is fixed is not counted among those of whom some have to sleep.
#[test]
fn a_few_that_rest_among_many_that_are_fixed_sleep() {
    let mut pegs = String::new();
    for number in 0..200 {
        let (x, y) = (0.2 * f64::from(number % 20), 2.0 + 0.2 * f64::from(number / 20));
        let _ = write!(
            pegs,
            "(name: \"peg_{number}\", fixed: true, at: ({x:?}, {y:?}), material: \"stone\", atoms: Disc(radius: 0.05)),"
        );
    }
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 2, tick: 0.001, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{ \"stone\": (stiffness: 50000, friction: 0.5, restitution: 0.3, density: 10) }},
        walls: [(name: \"floor\", left: (4, 0), right: (0, 0), material: \"stone\")],
        bodies: [{pegs}
            (name: \"ball\", at: (1, 0.11), material: \"stone\", atoms: Disc(radius: 0.1)),
            (name: \"other\", at: (2, 0.12), material: \"stone\", atoms: Disc(radius: 0.1))])"
    ));
    run_to(&mut simulation, 2.0);
    assert!(simulation.bodies().all_asleep());
}

/// Blocks that sleep on a thin support, and a heavy striker that comes once all rest and drives one of them down.
fn struck(support: &str, block: &str) -> String {
    let mut row = String::new();
    for number in 0..24 {
        let x = 0.3 * f64::from(number);
        let _ = write!(row, "(name: \"block_{number}\", at: ({x:?}, 0.051), material: \"stone\", {block}),");
    }
    format!(
        "Scene(format: 1, clock: (duration: 1, tick: \"20 us\", method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{ \"stone\": (stiffness: 50000, friction: 0.5, restitution: 0, density: 10) }},
        {support} {row}
            (name: \"striker\", at: (2.13, 1.6), velocity: (0, -1), mass: 5000, material: \"stone\", atoms: Disc(radius: 0.3))])"
    )
}

/// Promise: a sleeping body is not looked at for crossings until it wakes, and then as ever. A block is driven through its support out
/// of its sleep. The run ends in the same tick, and with the same words, as a run without sleep.
#[test]
fn a_block_that_wakes_and_passes_through_its_support_ends_the_run() {
    let plate = "bodies: [(name: \"support\", fixed: true, at: (3, -0.009), material: \"stone\", shape: Rectangle(width: 9, height: 0.02)),";
    let strip = "walls: [(name: \"support\", from: (-1, 0), to: (8, 0), material: \"stone\")], bodies: [";
    let blocks = ["shape: Rectangle(width: 0.1, height: 0.1)", "atoms: Disc(radius: 0.05)"];
    for (support, block) in [plate, strip].into_iter().flat_map(|support| blocks.map(|block| (support, block))) {
        let text = struck(support, block);
        let [asleep, awake] = [true, false].map(|may_sleep| {
            let mut simulation = load_awake(&text, may_sleep);
            run_to(&mut simulation, 0.35);
            assert_eq!(simulation.bodies().is_asleep(simulation.bodies().len() - 10), may_sleep, "{support} {block}");
            simulation.run_to_tick(50_000).expect_err("the striker drives a block through").to_string()
        });
        assert!(asleep.contains("`block_7` has passed through `support`"), "{asleep}");
        assert_eq!(asleep, awake, "{support} {block}");
    }
}

/// Two rows of discs between stops, each pressed together, and a ball that falls on the end of one. Names run against the way of the blow.
fn two_rows() -> String {
    let mut rows = String::new();
    for number in (0..80).rev() {
        let (row, place) = (number / 40, number % 40);
        let x = 0.1998 * f64::from(place) + 20.0 * f64::from(row);
        let _ = write!(rows, "(name: \"{number}\", at: ({x:?}, 0.1), material: \"stone\", atoms: Disc(radius: 0.1)),");
    }
    format!(
        "Scene(format: 1, clock: (duration: 2, tick: 0.0002, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{ \"stone\": (stiffness: 50000, friction: 0.5, restitution: 0, density: 10) }},
        walls: [(name: \"floor\", left: (9, 0), right: (-9, 0), material: \"stone\")],
        bodies: [
            (name: \"stop_0\", fixed: true, at: (-0.1998, 0.1), material: \"stone\", atoms: Disc(radius: 0.1)),
            (name: \"stop_1\", fixed: true, at: (7.992, 0.1), material: \"stone\", atoms: Disc(radius: 0.1)),
            (name: \"stop_2\", fixed: true, at: (19.8002, 0.1), material: \"stone\", atoms: Disc(radius: 0.1)),
            (name: \"stop_3\", fixed: true, at: (27.992, 0.1), material: \"stone\", atoms: Disc(radius: 0.1)),
            {rows}
            (name: \"ball\", at: (-0.05, 12), material: \"stone\", atoms: Disc(radius: 0.1))])"
    )
}

/// Promise: rest ends in one tick for all bodies that contacts connect to a body that moves, through others at rest. The other bodies
/// rest on, and so do those beyond a body that is fixed.
#[test]
fn a_blow_wakes_at_once_all_bodies_that_contacts_connect_and_no_others() {
    let mut simulation = load(&two_rows());
    let asleep = |simulation: &Simulation, row: usize| {
        let bodies = simulation.bodies();
        let of_row = |body: &usize| bodies.dynamic[*body] && bodies.position[*body].y < 0.2;
        let of_row = (0..bodies.len()).filter(of_row).filter(|body| (bodies.position[*body].x > 15.0) == (row == 1));
        of_row.filter(|body| bodies.is_asleep(*body)).count()
    };
    run_to(&mut simulation, 1.4);
    assert_eq!([asleep(&simulation, 0), asleep(&simulation, 1)], [40, 40]);
    let tick = (7000..10_000).find(|tick| {
        simulation.run_to_tick(*tick).expect("numbers stay finite");
        asleep(&simulation, 0) < 40
    });
    assert!(tick.is_some(), "the ball woke no disc");
    assert!(asleep(&simulation, 0) > 38, "discs woke that the ball did not touch, before the search");
    simulation.run_to_tick(tick.unwrap() + 1).expect("numbers stay finite");
    assert_eq!([asleep(&simulation, 0), asleep(&simulation, 1)], [0, 40]);
}
