//! Conditions that must not change the result: another run, the order of spawning, foreign components, batches,
//! pictures, and idle foreign systems.

use bevy_ecs::prelude::*;
use jostle::tick::{Evaluate, EvaluateStage, SimTick, Stage, TickAppExt};
use jostle::world::{Body, Force, Position};

use super::{clumps, hash, load, new_clump, run, scene, stirred};

const TICKS: u64 = 4000;
const METHODS: [&str; 2] = ["SemiImplicitEuler", "VelocityVerlet"];

fn hash_of(text: &str) -> u64 {
    let mut simulation = load(text, |_| {});
    run(&mut simulation, TICKS);
    hash(&simulation)
}

#[test]
fn two_runs_are_the_same_to_the_last_bit() {
    for method in METHODS {
        let text = scene(method, "", &clumps());
        assert_eq!(hash_of(&text), hash_of(&text));
        // The hash sees a change of one unit in the last place.
        let nudged = text.replace("at: (0.3, 0.3)", "at: (0.30000000000000004, 0.3)");
        assert_ne!(text, nudged);
        assert_ne!(hash_of(&text), hash_of(&nudged));
    }
}

/// A fixed peg: a scene needs a body, the clumps come later.
const PEG: &str = "(name: \"peg\", fixed: true, at: (1, 0.1), material: \"wood\", atoms: Disc(radius: 0.06))";

/// Spawns clumps with given keys in a given order.
fn spawned(order: impl Iterator<Item = usize>, mark: impl Fn(usize, &mut EntityWorldMut)) -> u64 {
    let mut simulation = load(&scene("VelocityVerlet", "", PEG), |_| {});
    let world = simulation.world_mut();
    for number in order {
        let entity = new_clump(world, number).spawn_with_key(world, 10 + number as u64);
        mark(number, &mut world.entity_mut(entity));
    }
    run(&mut simulation, TICKS);
    assert_eq!(simulation.bodies().len(), 13);
    hash(&simulation)
}

#[test]
fn the_order_of_spawning_does_not_matter() {
    let forward = spawned(0..12, |_, _| {});
    assert_eq!(forward, spawned((0..12).rev(), |_, _| {}));
    assert_eq!(forward, spawned((0..12).map(|number| number * 5 % 12), |_, _| {}));
}

#[derive(Component)]
struct Marker;
#[derive(Component)]
struct Label(#[expect(dead_code, reason = "an unrelated component holds something")] f64);

#[test]
fn components_of_others_do_not_matter() {
    let plain = spawned(0..12, |_, _| {});
    let marked = spawned(0..12, |number, body| {
        if number % 3 == 0 {
            body.insert(Marker);
        }
        if number % 2 == 1 {
            body.insert(Label(1.0));
        }
    });
    assert_eq!(plain, marked);
}

#[test]
fn batches_do_not_matter() {
    for text in METHODS.into_iter().flat_map(|method| [scene(method, "", &clumps()), stirred(method)]) {
        let whole = hash_of(&text);
        let mut simulation = load(&text, |_| {});
        let mut tick = 0;
        for size in [1, 2, 3, 7, 100, 1].into_iter().cycle() {
            tick += size;
            run(&mut simulation, tick.min(TICKS));
            if tick >= TICKS {
                break;
            }
        }
        assert_eq!(hash(&simulation), whole, "{text}");
    }
}

#[test]
fn pictures_do_not_matter() {
    let plain = hash_of(&scene("VelocityVerlet", "", &clumps()));
    for sections in [
        "film: (fps: 25, size: (320, 180), speed: 0.5),",
        "camera: Look(center: (1, 1), height: 4),",
        "title: \"Pile\", notes: \"Said in words.\",",
        "sensors: [Energy(), Pose(of: \"*\"), ContactForce(on: \"floor\")],",
    ] {
        assert_eq!(hash_of(&scene("VelocityVerlet", sections, &clumps())), plain, "{sections}");
    }
}

fn look(bodies: Query<(&Body, &Position)>) {
    assert!(bodies.iter().all(|(_, position)| position.0.is_finite()));
}

/// Adds nothing, but makes the engine keep the force components up to date.
fn push_with_nothing(mut forces: Query<&mut Force>) {
    for mut force in &mut forces {
        force.0 += glam::DVec2::ZERO;
    }
}

fn assert_that_looking_does_not_matter(method: &str, text: &str) {
    let plain = hash_of(text);
    for stage in [Stage::Begin, Stage::Observe] {
        let mut simulation = load(text, move |app| {
            app.add_systems(SimTick, look.in_set(stage));
        });
        run(&mut simulation, TICKS);
        assert_eq!(hash(&simulation), plain, "{method}: a system that only looks in {stage:?}");
    }
    let mut simulation = load(text, |app| {
        app.add_systems(Evaluate, look.in_set(EvaluateStage::Forces));
    });
    run(&mut simulation, TICKS);
    assert_eq!(hash(&simulation), plain, "{method}: a system that only looks in the evaluation");
}

const DRAG: &str = "forces: [Drag(linear: 0.01)],";

fn one_coefficient(text: &str) -> String {
    let one = text.replace("(static: 0.5, dynamic: 0.3)", "0.5").replace("(static: 0.4, dynamic: 0.25)", "0.4");
    assert!(!one.contains("static") && text.contains("static"), "{one}");
    one
}

/// An ordinary system makes the engine keep components up to date, and nothing else: forces that are evaluated again
/// for the same state must leave it and the history of contacts as they are.
#[test]
fn systems_that_only_look_do_not_matter() {
    for method in METHODS {
        let text = scene(method, "", &clumps()).replace(DRAG, "");
        assert_that_looking_does_not_matter(method, &one_coefficient(&text));
    }
}

/// A contact that slips must not stick because forces were evaluated again.
#[test]
fn systems_that_only_look_do_not_matter_where_static_friction_exceeds_dynamic() {
    for method in METHODS {
        assert_that_looking_does_not_matter(method, &scene(method, "", &clumps()).replace(DRAG, ""));
    }
}

/// Drag must not see other velocities because forces were evaluated again.
#[test]
fn systems_that_only_look_do_not_matter_to_drag() {
    for method in METHODS {
        assert_that_looking_does_not_matter(method, &one_coefficient(&scene(method, "", &clumps())));
    }
}

/// A force of an ordinary system may depend on velocities, so the method may take another way; but the way must not
/// depend on batches.
#[test]
fn batches_do_not_matter_with_a_force_of_a_plugin() {
    for text in METHODS.into_iter().flat_map(|method| [scene(method, "", &clumps()), stirred(method)]) {
        let hashes = [TICKS, 1, 13].map(|size| {
            let mut simulation = load(&text, |app| {
                app.add_force(push_with_nothing);
            });
            for tick in (0..=TICKS).step_by(size as usize).chain([TICKS]) {
                run(&mut simulation, tick);
            }
            hash(&simulation)
        });
        assert_eq!(hashes[0], hashes[1], "{text}");
        assert_eq!(hashes[0], hashes[2], "{text}");
    }
}
