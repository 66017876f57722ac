//! A contact law from outside, by the public plugin interface only: the axis-wise law of "Simulating the Physical
//! World", chapter 5.
//!
//! Law, for atom a of the earlier body against atom b of the later one, `d = x_a - x_b`, compression
//! `c = max(0, r_a + r_b - |d|)`, `k = 1/(1/k_a + 1/k_b)`, `w = v_a - v_b`, each component i with j the other one:
//! `N_i = k c d_i / |d|`, `f_i = N_i - mu_f |N_j| sign(w_i) - mu_e N_i sign(w_i)` on a, the opposite on b. Atom against
//! wall with normal n: `N_i = k c n_i`, `f_i = N_i - mu_f |N_j| sign(v_i) - mu_e N_i sign(v_i) sign(n_i)`.
//!
//! Source: trajectories recorded from the author's own program (`assets/trajectories`), evidence from other code.
//! Tolerance: 1e-6 m, as the program's own response to a perturbation of 1e-10 m is 1e-10 after 2 s without gravity and
//! 5e-10 after 1 s with it; angles likewise in rad, velocities and spins within 1e-6 per tick of 1 ms, that is 1e-3.
//! Not tested: energy (the law is not invariant under rotation, and nobody should use it for anything else).

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle::SimulationExt;
use jostle::contacts::{AtomPair, CandidatePairs, ContactLaw, LawSide, LawTouch, add_law};
use jostle::scene::{Entry, Outline, SceneAppExt, Source, WrittenEntry};
use jostle::simulation::{Overrides, Simulation};
use jostle::tick::{Energies, Model, Rates, State, SteadySpring};
use jostle::world::material::Rebound;
use jostle::world::{Bodies, Materials};
use schemars::JsonSchema;
use serde::Deserialize;

/// `contacts: AxisWise()`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct AxisWise {}

impl Entry for AxisWise {
    const SECTION: &'static str = "contacts";
    const NAME: &'static str = "AxisWise";
    const EXAMPLE: &'static str = "AxisWise()";

    fn install(_: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        app.init_resource::<Materials>();
        add_law(app, AxisWiseLaw::default());
    }
}

#[derive(Default)]
struct AxisWiseLaw {
    materials: Materials,
}

impl ContactLaw for AxisWiseLaw {
    fn law(&self) -> &'static str {
        "AxisWise"
    }

    fn pair_stiffness(&self, state: &State, pair: &LawTouch) -> (f64, f64) {
        let bodies = state.bodies();
        let along = match pair.a {
            LawSide::Atom(a) => series(bodies, a, pair.b),
            LawSide::Hull(_) | LawSide::Wall(_) => bodies.atom_stiffness(pair.b),
        };
        (along, 0.0)
    }
}

impl Model for AxisWiseLaw {
    fn start(&mut self, world: &mut World) {
        self.materials = world.resource::<Materials>().clone();
    }

    /// The law has no potential: what its springs alone would hold.
    fn energies(&self, state: &State) -> Energies {
        Energies { potential: 0.0, elastic: state.pairs().map_or(0.0, |pairs| elastic_energy(state.bodies(), pairs)) }
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn apply_forces(&mut self, state: &mut State) {
        if let (bodies, rates, Some(pairs)) = state.bodies_rates_and_pairs() {
            apply_axis_wise(&self.materials, pairs, bodies, rates);
        }
    }
}

fn apply_axis_wise(materials: &Materials, pairs: &CandidatePairs, bodies: &mut Bodies, rates: &mut Rates) {
    for &AtomPair { a, b } in &pairs.atoms {
        let (a, b) = (a as usize, b as usize);
        let between = bodies.atom_place(a) - bodies.atom_place(b);
        let distance = between.length();
        let compression = bodies.atom_radius[a] + bodies.atom_radius[b] - distance;
        if compression <= 0.0 {
            continue;
        }
        let stiffness = series(bodies, a, b);
        let pair = materials.pair(bodies.atom_material(a).index(), bodies.atom_material(b).index());
        let normal_force = between * (stiffness * compression / distance);
        let approach = sign(velocity(bodies, a) - velocity(bodies, b));
        let across = DVec2::new(normal_force.y.abs(), normal_force.x.abs());
        let friction = across * approach * pair.friction_dynamic;
        let force = normal_force - friction - normal_force * approach * inelasticity(pair.rebounds);
        push(bodies, rates, a, force);
        push(bodies, rates, b, -force);
    }
    let near_walls: Vec<_> = pairs.near_walls(bodies).collect();
    for (wall, atom) in near_walls {
        let wall = bodies.walls[wall];
        let height = (bodies.atom_place(atom) - wall.point).dot(wall.normal);
        let compression = bodies.atom_radius[atom] - height;
        if compression <= 0.0 {
            continue;
        }
        let pair = materials.pair(wall.material.index(), bodies.atom_material(atom).index());
        let normal_force = wall.normal * (bodies.atom_stiffness(atom) * compression);
        let motion = sign(velocity(bodies, atom));
        let across = DVec2::new(normal_force.y.abs(), normal_force.x.abs());
        let friction = across * motion * pair.friction_dynamic;
        let force = normal_force - friction - normal_force * motion * sign(wall.normal) * inelasticity(pair.rebounds);
        push(bodies, rates, atom, force);
    }
}

fn elastic_energy(bodies: &Bodies, pairs: &CandidatePairs) -> f64 {
    let energy = |stiffness: f64, compression: f64| 0.5 * stiffness * compression.max(0.0).powi(2);
    let of_atoms = pairs.atoms.iter().map(|&AtomPair { a, b }| {
        let (a, b) = (a as usize, b as usize);
        let distance = (bodies.atom_place(a) - bodies.atom_place(b)).length();
        energy(series(bodies, a, b), bodies.atom_radius[a] + bodies.atom_radius[b] - distance)
    });
    let of_walls = pairs.near_walls(bodies).map(|(wall, atom)| {
        let wall = bodies.walls[wall];
        let height = (bodies.atom_place(atom) - wall.point).dot(wall.normal);
        energy(bodies.atom_stiffness(atom), bodies.atom_radius[atom] - height)
    });
    of_atoms.chain(of_walls).sum()
}

/// The law knows inelasticities only, as its scenes do.
fn inelasticity(rebounds: [Rebound; 2]) -> f64 {
    let of = |rebound: Rebound| match rebound {
        Rebound::Inelasticity(inelasticity) => inelasticity,
        Rebound::Restitution(restitution) => 1.0 - restitution,
    };
    (of(rebounds[0]) + of(rebounds[1])) / 2.0
}

fn series(bodies: &Bodies, a: usize, b: usize) -> f64 {
    1.0 / (1.0 / bodies.atom_stiffness(a) + 1.0 / bodies.atom_stiffness(b))
}

fn velocity(bodies: &Bodies, atom: usize) -> DVec2 {
    let body = bodies.atom_body(atom);
    bodies.velocity_at(body, bodies.atom_place(atom) - bodies.position[body])
}

/// The law lets forces act at the centre of the atom.
fn push(bodies: &mut Bodies, rates: &mut Rates, atom: usize, force: DVec2) {
    let body = bodies.atom_body(atom);
    let arm = bodies.atom_place(atom) - bodies.position[body];
    bodies.push(body, arm, force);
    rates.outside(bodies.atom_place(atom), force, 0.0);
}

/// -1, 0 or 1 per component, 0 for 0: unlike `signum`.
fn sign(vector: DVec2) -> DVec2 {
    let of = |value: f64| if value == 0.0 { 0.0 } else { value.signum() };
    DVec2::new(of(vector.x), of(vector.y))
}

#[derive(Deserialize)]
struct Recorded {
    bodies: Vec<String>,
    rows: Vec<Vec<f64>>,
}

/// Runs along a recorded trajectory; returns the largest deviation of positions and angles, and of velocities and
/// spins.
fn deviation(gravity: f64, recorded: &str) -> (f64, f64) {
    let recorded: Recorded = serde_json::from_str(recorded).expect("the recorded trajectory is JSON");
    let text = include_str!("axis_wise.ron").replace("GRAVITY", &gravity.to_string());
    let register = |app: &mut App| {
        app.register_entry::<AxisWise>();
    };
    let source = Source::new("axis_wise.ron", text);
    let mut simulation = Simulation::load_with(&source, &Overrides::default(), register).unwrap();
    let names = simulation.header().outline.names(jostle::scene::NameKind::BODY).to_vec();
    let (mut pose, mut motion) = (0.0_f64, 0.0_f64);
    let mut samples = 0;
    for row in &recorded.rows {
        simulation.run_to_tick(row[0] as u64).unwrap();
        let bodies = simulation.bodies();
        for (name, expected) in recorded.bodies.iter().zip(row[2..].chunks_exact(6)) {
            let body = names.iter().position(|known| known == name).expect("the recorded body is in the scene");
            let (position, velocity) = (bodies.position[body], bodies.velocity[body]);
            let found = [position.x, position.y, bodies.angle[body], velocity.x, velocity.y, bodies.spin[body]];
            let off = |which: usize| (found[which] - expected[which]).abs();
            pose = pose.max(off(0)).max(off(1)).max(off(2));
            motion = motion.max(off(3)).max(off(4)).max(off(5));
            samples += 1;
        }
    }
    assert_eq!(samples, recorded.rows.len() * 5, "five bodies in every row");
    (pose, motion)
}

#[test]
fn the_recorded_trajectory_without_gravity_is_reproduced_for_two_seconds() {
    let (pose, motion) = deviation(0.0, include_str!("../../assets/trajectories/tetris_g0.json"));
    assert!(pose < 1e-6 && motion < 1e-3, "off by {pose:.2e} m or rad, {motion:.2e} m/s or rad/s");
}

#[test]
fn the_recorded_trajectory_with_gravity_is_reproduced_for_one_second() {
    let (pose, motion) = deviation(-3.0, include_str!("../../assets/trajectories/tetris_g3.json"));
    assert!(pose < 1e-6 && motion < 1e-3, "off by {pose:.2e} m or rad, {motion:.2e} m/s or rad/s");
}

/// A law that does not fill `Touches` is told of, where somebody asks for contacts.
#[test]
fn a_law_that_does_not_tell_who_touches_is_noted() {
    let noted = |sensors: &str| {
        let text = format!(
            "Scene(format: 1, clock: (duration: 0.1, tick: 1e-3), contacts: AxisWise(), {sensors}
            bodies: [(name: \"ball\", at: (0, 0), atoms: Disc(radius: 0.1))])"
        );
        let register = |app: &mut App| {
            app.register_entry::<AxisWise>();
        };
        let mut simulation = Simulation::load_with(&Source::new("axis.ron", text), &Overrides::default(), register)
            .expect("it is right");
        simulation.run_to_end().expect("numbers stay finite");
        let notes = simulation.card().notes;
        notes.iter().filter(|note| note.contains("`AxisWise` does not tell which bodies touch")).count()
    };
    assert_eq!(noted("sensors: [Contacts(of: \"ball\")],"), 1);
    assert_eq!(noted(""), 0);
}
