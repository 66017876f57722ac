//! A contact law from outside stands on the card as the engine's own does: overlap, energy, critical tick.
//!
//! Law: a spring of `k` between a disc and a floor. A disc of mass m that comes down with v presses it in by
//! `m g/k + sqrt((m g/k)^2 + m v^2/k)`; its critical tick is `2 sqrt(m/k)`. Tolerance: second order in the tick.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle::Simulation;
use jostle::contacts::{CandidatePairs, FindPairs, Law, Touching, add_law};
use jostle::report::Card;
use jostle::scene::{Entry, Outline, SceneAppExt, Source, Written};
use jostle::simulation::Overrides;
use jostle::tick::{Balance, Evaluate, EvaluateStage, TickAppExt};
use jostle::world::Bodies;
use serde::Deserialize;

/// `contacts: Floor(stiffness: 500)`: a spring between atoms and walls, and nothing between atoms.
#[derive(Resource, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct Floor {
    stiffness: f64,
}

impl Entry for Floor {
    const SECTION: &'static str = "contacts";
    const NAME: &'static str = "Floor";
    const EXAMPLE: &'static str = "Floor(stiffness: 500)";

    fn install(written: Vec<Written<Self>>, _: &Outline, app: &mut App) {
        app.insert_resource(written[0].value);
        let stiffness = |world: &World, _: &Touching| (world.resource::<Floor>().stiffness, 0.0);
        add_law(app, Law { name: "Floor", elastic_energy, stiffness });
        app.add_packed_systems(Evaluate, push_back.after(FindPairs).in_set(EvaluateStage::Contacts));
    }
}

/// Atoms in walls, with what they are pressed in by, and the normal.
fn pressed<'a>(bodies: &'a Bodies, pairs: &'a CandidatePairs) -> impl Iterator<Item = (usize, f64, DVec2)> + 'a {
    let all = pairs.walls.iter().map(|pair| {
        let (wall, atom) = (bodies.walls[pair.wall as usize], pair.atom as usize);
        let height = (bodies.atom_place(atom) - wall.point).dot(wall.normal);
        (atom, bodies.atom_radius[atom] - height, wall.normal)
    });
    all.filter(|(_, overlap, _)| *overlap > 0.0)
}

fn elastic_energy(world: &World) -> f64 {
    let stiffness = world.resource::<Floor>().stiffness;
    pressed(world.resource(), world.resource()).map(|(_, overlap, _)| 0.5 * stiffness * overlap * overlap).sum()
}

fn push_back(floor: Res<Floor>, pairs: Res<CandidatePairs>, mut bodies: ResMut<Bodies>, mut balance: ResMut<Balance>) {
    let found: Vec<_> = pressed(&bodies, &pairs).collect();
    for (atom, overlap, normal) in found {
        let force = normal * (floor.stiffness * overlap);
        let body = bodies.atom_body(atom);
        let arm = bodies.atom_place(atom) - bodies.position[body];
        bodies.push(body, arm, force);
        balance.outside(bodies.atom_place(atom), force, 0.0);
    }
}

fn card(stiffness: f64) -> Card {
    let text = format!(
        "Scene(format: 1, clock: (duration: 0.5, tick: 1e-4, method: VelocityVerlet), gravity: (0, -9.81),
            contacts: Floor(stiffness: {stiffness:?}),
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
            bodies: [(name: \"ball\", at: (0, 0.1), velocity: (0, -2), atoms: Disc(radius: 0.1, mass: 1))])"
    );
    let register = |app: &mut App| {
        app.register_entry::<Floor>();
    };
    let mut simulation =
        Simulation::load_with(&Source::new("floor.ron", text), &Overrides::default(), register).unwrap();
    simulation.run_to_end().unwrap();
    simulation.card()
}

fn deepest(stiffness: f64) -> f64 {
    let sag = 9.81 / stiffness;
    sag + (sag * sag + 4.0 / stiffness).sqrt()
}

#[test]
fn overlap_energy_and_critical_tick_stand_on_the_card() {
    let card = card(5e4);
    let overlap = &card.largest_overlap;
    assert!((overlap.meters / deepest(5e4) - 1.0).abs() < 1e-3, "{card}");
    assert_eq!(overlap.bodies, ["floor", "ball"], "{card}");
    assert!(card.energy.residual.abs() < 1e-3 * 2.0, "{card}");
    let critical = card.critical_tick.expect("contacts touched");
    assert!((critical / (2.0 / 5e4_f64.sqrt()) - 1.0).abs() < 1e-9, "{critical} s\n{card}");
}

#[test]
fn a_body_that_sinks_in_is_not_trusted() {
    let card = card(50.0);
    assert!(deepest(50.0) > 0.1);
    assert!(card.largest_overlap.share_of_radius > 1.0, "{card}");
    assert!(!card.verdict.starts_with("Trust it"), "{card}");
}
