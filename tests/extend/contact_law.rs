//! A contact law from outside has the engine's results on the card: overlap, energy, critical tick.
//!
//! Law: a spring of `k` between a disc and a floor. A disc of mass m that comes down with v presses it in by
//! `m g/k + sqrt((m g/k)^2 + m v^2/k)`; its critical tick is `2 sqrt(m/k)` under
//! velocity Verlet, `sqrt(8 m/k)` under Runge-Kutta 4. Tolerance: second order in the tick.

use bevy_app::App;
use glam::DVec2;
use jostle::contacts::{CandidatePairs, ContactLaw, LawTouch, add_law};
use jostle::report::Card;
use jostle::scene::{Entry, Outline, SceneAppExt, Source, WrittenEntry};
use jostle::simulation::Overrides;
use jostle::tick::{Dependence, Energies, Model, State, SteadySpring};
use jostle::world::Bodies;
use jostle::{Simulation, SimulationExt};
use schemars::JsonSchema;
use serde::Deserialize;

/// `contacts: Floor(stiffness: 500)`: a spring between atoms and walls, and nothing between atoms.
#[derive(Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Floor {
    stiffness: f64,
}

impl Entry for Floor {
    const SECTION: &'static str = "contacts";
    const NAME: &'static str = "Floor";
    const EXAMPLE: &'static str = "Floor(stiffness: 500)";

    fn install(written: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        add_law(app, written[0].value);
    }
}

impl ContactLaw for Floor {
    fn law(&self) -> &'static str {
        "Floor"
    }

    fn pair_stiffness(&self, _: &State, _: &LawTouch) -> (f64, f64) {
        (self.stiffness, 0.0)
    }
}

impl Model for Floor {
    fn dependence(&self) -> Dependence {
        Dependence::Position
    }

    fn energies(&self, state: &State) -> Energies {
        let pressed = state.pairs().map_or_else(Vec::new, |pairs| pressed(state.bodies(), pairs));
        Energies { potential: 0.0, elastic: pressed.iter().map(|(_, by, _)| 0.5 * self.stiffness * by * by).sum() }
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn apply_forces(&mut self, state: &mut State) {
        let (bodies, rates, Some(pairs)) = state.bodies_rates_and_pairs() else { return };
        for (atom, overlap, normal) in pressed(bodies, pairs) {
            let force = normal * (self.stiffness * overlap);
            let body = bodies.atom_body(atom);
            let arm = bodies.atom_place(atom) - bodies.position[body];
            bodies.push(body, arm, force);
            rates.outside(bodies.atom_place(atom), force, 0.0);
        }
    }
}

/// Atoms in walls, with what they are pressed in by, and the normal.
fn pressed(bodies: &Bodies, pairs: &CandidatePairs) -> Vec<(usize, f64, DVec2)> {
    let all = pairs.near_walls(bodies).map(|(wall, atom)| {
        let wall = bodies.walls[wall];
        let height = (bodies.atom_place(atom) - wall.point).dot(wall.normal);
        (atom, bodies.atom_radius[atom] - height, wall.normal)
    });
    all.filter(|(_, overlap, _)| *overlap > 0.0).collect()
}

fn card(method: &str, stiffness: f64) -> Card {
    let text = format!(
        "Scene(format: 1, clock: (duration: 0.5, tick: 1e-4, method: {method}), gravity: (0, -9.81),
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
    for (method, limit) in [("VelocityVerlet", 2.0), ("RungeKutta4", 8.0_f64.sqrt())] {
        let card = card(method, 5e4);
        let overlap = &card.largest_overlap;
        assert!((overlap.meters / deepest(5e4) - 1.0).abs() < 1e-3, "{card}");
        assert_eq!(overlap.bodies, ["floor", "ball"], "{card}");
        assert!(card.energy.residual.abs() < 1e-3 * 2.0, "{card}");
        let critical = card.critical_tick.expect("contacts touched");
        assert!((critical / (limit / 5e4_f64.sqrt()) - 1.0).abs() < 1e-9, "{critical} s\n{card}");
    }
}

#[test]
fn a_body_that_sinks_in_is_not_trusted() {
    for method in ["VelocityVerlet", "RungeKutta4"] {
        let card = card(method, 50.0);
        assert!(deepest(50.0) > 0.1);
        assert!(card.largest_overlap.share_of_radius > 1.0, "{card}");
        assert!(!card.verdict.starts_with("Trust it"), "{card}");
    }
}
