//! A saved and resumed run continues with the same bits: in another simulation, with other threads and vector
//! instructions, from the bytes of a file. It does so under every kind of method, and with contacts, rest, sleep,
//! flights and unfinished steps.
//!
//! Tolerance: none. Compared are the state's hash, all data that decides the future, and the card without its times.
//! Not tested here: another process, which the tests of the command line cover.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use jostle::scene::Source;
use jostle::simd::Level;
use jostle::simulation::{Overrides, Snapshot};
use jostle::world::Velocity;
use jostle::world::hash::state_hash;
use jostle::{Simulation, SimulationExt};

use super::pinned_methods::{WAYS, scenes, short};
use crate::part;

/// Moments at which runs are saved, as shares of a run. Runs take turns: each is saved at one of them.
const MOMENTS: [f64; 3] = [0.09, 0.47, 0.83];

/// What is compared of a run at its end: hashes, and the card without times of computing.
fn end(simulation: &mut Simulation) -> (u64, u64, serde_json::Value) {
    let mut card = serde_json::to_value(simulation.card()).unwrap();
    let fields = card.as_object_mut().unwrap();
    fields.retain(|name, _| !name.contains("seconds") && !name.contains("real_time") && !name.contains("ns_per"));
    (state_hash(simulation.bodies()), simulation.future_hash().unwrap(), card)
}

/// Why a run that is saved at a moment does not go on as it would have.
fn difference(source: &Source, overrides: &Overrides, moment: f64) -> Option<String> {
    let mut whole = Simulation::load_with(source, overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}"));
    whole.run_to_end().unwrap_or_else(|failure| panic!("{}: {failure}", source.name));
    let (expected, plan) = (end(&mut whole), whole.plan().cloned());
    let own = Overrides { plan, ..overrides.clone() };
    let others = Overrides { threads: Some(2), level: Some(Level::Scalar), ..own.clone() };
    let mut saved = Simulation::load_with(source, &own, |_| {}).unwrap();
    let tick = (moment * whole.ticks() as f64) as u64;
    saved.run_to_tick(tick).unwrap();
    let bytes = saved.snapshot().unwrap_or_else(|error| panic!("{}: {error}", source.name)).to_bytes();
    if saved.fork().unwrap().future_hash() != saved.future_hash() {
        return Some(format!("after {tick} ticks: the future of a fork is another"));
    }
    let mut resumed = Simulation::load_with(source, &others, |_| {}).unwrap();
    // What it has done before is forgotten.
    resumed.run_to_tick(tick / 2 + 1).unwrap();
    resumed.restore(&Snapshot::from_bytes(&bytes).unwrap()).unwrap();
    if resumed.future_hash() != saved.future_hash() {
        return Some(format!("after {tick} ticks: the future is another right away"));
    }
    resumed.run_to_end().unwrap();
    let found = end(&mut resumed);
    if found.0 != expected.0 {
        return Some(format!("after {tick} ticks: another state at the end"));
    }
    if found.2 != expected.2 {
        return Some(format!("after {tick} ticks: another card: {:#} instead of {:#}", found.2, expected.2));
    }
    if found.1 != expected.1 {
        return Some(format!("after {tick} ticks: another future at the end"));
    }
    None
}

fn demand_none(runs: Vec<(String, PathBuf, Overrides)>) {
    let runs = part::of(runs);
    assert!(runs.len() > part::least(20));
    let half = runs.len().div_ceil(2);
    let refused = AtomicUsize::new(0);
    let runs: Vec<_> = runs.into_iter().zip(MOMENTS.into_iter().cycle()).collect();
    // Some scenes refuse some methods, and say why.
    let refuses = |source: &Source, overrides: &Overrides| Simulation::load_with(source, overrides, |_| {}).is_err();
    let of = |((name, path, overrides), moment): &((String, PathBuf, Overrides), f64)| {
        let source = Source::read(path).unwrap();
        if refuses(&source, overrides) {
            refused.fetch_add(1, Ordering::Relaxed);
            return None;
        }
        let found = difference(&source, overrides, *moment)?;
        Some(format!("{name}: {found}"))
    };
    let found: Vec<String> = std::thread::scope(|scope| {
        let parts: Vec<_> =
            runs.chunks(half).map(|part| scope.spawn(move || part.iter().filter_map(of).collect::<Vec<_>>())).collect();
        parts.into_iter().flat_map(|part| part.join().unwrap()).collect()
    });
    assert_eq!(found, Vec::<String>::new());
    let refused = refused.into_inner();
    assert!(5 * refused <= runs.len(), "{refused} of {} runs are refused", runs.len());
}

#[test]
fn shipped_scenes_go_on_from_snapshots_to_the_same_bits() {
    let name = |path: &PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
    let whole = |path: PathBuf| {
        let own = short(&path, 2.0);
        (name(&path), path, own)
    };
    demand_none(scenes().into_iter().map(whole).collect());
}

#[test]
fn so_they_do_under_every_kind_of_method() {
    let mut runs = Vec::new();
    for path in scenes() {
        let name = path.file_stem().unwrap().to_str().unwrap();
        for (word, method, tolerance) in WAYS {
            if let Some(overrides) = super::pinned_methods::overrides(&path, method, tolerance) {
                runs.push((format!("{name}/{word}"), path.clone(), overrides));
            }
        }
    }
    demand_none(runs);
}

#[test]
fn forks_go_on_alike_and_do_not_touch_each_other() {
    let source = Source::read(&PathBuf::from("scenes/tetris.ron")).unwrap();
    let mut simulation = Simulation::load(&source).unwrap();
    simulation.run_to_tick(simulation.ticks() / 6).unwrap();
    let mut kicked = simulation.fork().unwrap();
    let mut plain = simulation.fork().unwrap();
    let before = simulation.future_hash();
    let world = kicked.world_mut();
    world.query::<&mut Velocity>().iter_mut(world).for_each(|mut velocity| velocity.0.x += 0.5);
    kicked.run_to_end().unwrap();
    assert_eq!(simulation.future_hash(), before);
    simulation.run_to_end().unwrap();
    plain.run_to_end().unwrap();
    assert_eq!(end(&mut plain), end(&mut simulation));
    assert_ne!(end(&mut kicked).0, end(&mut simulation).0);
}

#[test]
fn a_run_with_a_body_of_later_is_not_forked() {
    let mut simulation = Simulation::load(&Source::read(&PathBuf::from("scenes/tetris.ron")).unwrap()).unwrap();
    let body = simulation.bodies().entity[0];
    simulation.world_mut().despawn(body);
    simulation.run_to_tick(1).unwrap();
    let why = simulation.fork().err().expect("a refusal").to_string();
    assert_eq!(why, "it has other bodies, walls or accounts than this run");
}

/// Springs that stick are numbers of the state, so their number changes as contacts begin to stick and to slide. A run takes up the
/// snapshots of its own kind in all such moments.
#[test]
fn a_run_whose_springs_come_and_go_takes_up_its_snapshots() {
    let text = r#"Scene(
    format: 1,
    clock: (duration: 0.88),
    film: (fps: 100.0),
    gravity: (0.0, -9.81),
    contacts: Penalty(),
    materials: { "m": (inelasticity: 0.589, density: 115.9, friction: 0.7566, stiffness: 40550.0) },
    walls: [
        (name: "wall0", material: "m", left: (0.8775985594303569, 0.47939625414239756), right: (0.0, 0.0)),
    ],
    bodies: [
        (name: "b0", velocity: (0.0, 0.294), material: "m", atoms: List([(at: (0.0, -0.1167), radius: 0.385), (at: (0.1331, 0.0), radius: 0.1063), (at: (0.0, -0.1022), radius: 0.1075), (at: (0.0, -0.141), radius: 0.1973)]), at: (0.18210026663353457, 0.536831816949461)),
        (name: "b1", kinematic: (), material: "m", shape: Disc(radius: 0.3378, at: (-0.134, 0.0), collides: false), at: (0.07190177133663084, 1.2496772524580333)),
        (name: "b2", atoms: Disc(radius: 0.5324), fixed: false, kinematic: (spin: 1.801, path: [(time: 0.1459, velocity: (0.7231, -0.0858)), (time: 0.2415, turn: -0.9309), (time: 0.3671), (time: 0.3993, by: (-0.177, 0.0))]), material: "m", at: (0.4228273070464064, 2.0459807802580663)),
        (name: "b3", kinematic: (path: [(time: 0.03642), (time: 0.07886), (time: 0.1814, turn: -0.5766), (time: 0.442, velocity: (0.0, 0.3375))]), material: "m", shape: Regular(sides: 5, radius: 0.1125), at: (-0.32034495341639446, 1.4390198255628572)),
    ],
    forces: [
        Drive(of: ["b3", "b2"], force: (-2.514, 0.0), course: Piecewise([(0.2358, 0.4637), (0.2692, 1.022)])),
    ],
)"#;
    let source = Source::new("springs.ron", text.to_owned());
    let overrides = Overrides { tolerance: Some(1e-6), ..Overrides::default() };
    let load = || Simulation::load_with(&source, &overrides, |_| {}).unwrap_or_else(|error| panic!("{error}"));
    let (mut run, mut other) = (load(), load());
    for tick in 1..run.ticks() {
        run.run_to_tick(tick).unwrap();
        let bytes = run.snapshot().unwrap().to_bytes();
        let restored = other.restore(&Snapshot::from_bytes(&bytes).unwrap());
        assert_eq!(restored.map_err(|why| why.to_string()), Ok(()), "after {tick} ticks");
    }
}

/// Discs sleep on a floor while another one flies above them. So many are sorted into cells, and the neighbours of the flying one
/// are searched in the cells of the last search.
#[test]
fn a_run_takes_up_its_snapshots_while_most_bodies_sleep() {
    const COUNT: usize = 1500;
    let disc = |name: String, x: f64, y: f64| {
        format!("(name: \"{name}\", at: ({x:?}, {y:?}), material: \"m\", atoms: Disc(radius: 0.1, mass: 1)), ")
    };
    let heap: String = (0..COUNT).map(|index| disc(format!("b{index}"), 0.3 * index as f64, 0.1)).collect();
    let text = format!(
        "Scene(format: 1, clock: (duration: 1, tick: 0.001), gravity: (0, -9.81), contacts: Penalty(), \
         materials: {{\"m\": (stiffness: 1e5, restitution: 0.3, friction: 0.5)}}, \
         walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")], bodies: [{heap}{}])",
        disc("flies".to_owned(), 4.05, 4.0)
    );
    let source = Source::new("sleepers.ron", text);
    let mut run =
        Simulation::load_with(&source, &Overrides::default(), |_| {}).unwrap_or_else(|error| panic!("{error}"));
    run.run_to_tick(run.ticks() / 2).unwrap();
    assert_eq!((0..=COUNT).filter(|body| run.bodies().is_asleep(*body)).count(), COUNT);
    for moment in [0.1, 0.3, 0.6, 0.8, 0.95] {
        assert_eq!(difference(&source, &Overrides::default(), moment), None, "saved at {moment}");
    }
}
