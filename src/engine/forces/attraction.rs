//! Attraction between all bodies (Newton): `F = G m1 m2 / (r^2 + s^2)` along the line of centres for `s = 0`. With
//! softening it is that of a Plummer sphere (Plummer 1911): `F = G m1 m2 r / (r^2 + s^2)^(3/2)`. The potential energy
//! is `-G m1 m2 / sqrt(r^2 + s^2)`.
//!
//! A negative constant repels. Every pair is visited: the cost grows with the square of the number of bodies.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::scene::units::{Dimension, Length, Powers, Quantity};
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, SceneError, WrittenEntry};
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::tick::{AfterLoad, Dependence, Energies, LoadErrors, Model, State, SteadySpring, TickAppExt};
use crate::world::{Bodies, Name};

/// Attraction between all bodies, like that between planets. Two bodies `r` apart with a softening of `s = 0` have `F =
/// G m1 m2 / (r^2 + s^2)`. With softening it is `F = G m1 m2 r / (r^2 + s^2)^(3/2)`. The cost grows with the square of
/// the number of bodies.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Attraction {
    /// `G` in N m2/kg2. A negative one repels.
    constant: Quantity<GravitationalConstant>,
    /// Length `s` in metres below which the force stops growing. Default: 0.
    #[serde(default)]
    softening: Length,
}

/// The most bodies of a scene with attraction. An evaluation of all their pairs, 134 million,
/// takes some tenths of a second. With more, a run would not end.
const MOST_BODIES: usize = 1 << 14;

/// Dimension of `G`.
struct GravitationalConstant;

impl Dimension for GravitationalConstant {
    const NAME: &'static str = "a gravitational constant";
    const POWERS: Powers = Powers { meter: 3, kilogram: -1, second: -2, radian: 0 };
    const UNIT: &'static str = "N m2/kg2";
    const EXAMPLE: &'static str = "`1.0` or \"6.674e-11 N m2/kg2\"";
}

impl Entry for Attraction {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Attraction";
    const EXAMPLE: &'static str = "Attraction(constant: 1.0)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        report.not_negative("softening", self.softening);
        let bodies = outline.count(NameKind::BODY);
        if bodies > MOST_BODIES {
            let message = format!("{bodies} bodies attract each other, at most {MOST_BODIES} can");
            report.error("", message).help("the cost grows with the square of their number: make fewer bodies");
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let mut paths = outline.entries(Self::SECTION).iter().filter(|mention| mention.name == Self::NAME);
        let hard = entries.iter().zip(&mut paths).find(|(entry, _)| entry.value.softening.si() == 0.0);
        if let Some((_, mention)) = hard {
            app.insert_resource(Unsoftened(mention.path.clone()));
            app.world_mut().get_resource_or_init::<AfterLoad>().0.push(refuse_coincident);
        }
        for WrittenEntry { value, .. } in entries {
            let (constant, softening) = (value.constant.si(), value.softening.si());
            app.add_model(AttractionForce { constant, softening, nearest: SteepestFall::default() });
        }
    }
}

/// Path of an entry without softening.
#[derive(Resource)]
struct Unsoftened(String);

/// Two bodies in one place attract each other infinitely, without a direction.
fn refuse_coincident(world: &mut World) {
    let bodies = &world.resource::<State>().bodies;
    let same = |(a, b): &(usize, usize)| bodies.position[*a] == bodies.position[*b];
    let Some((a, b)) = pairs(&bodies.dynamic).find(same) else { return };
    let name = |body: usize| world.get::<Name>(bodies.entity[body]).map(Name::to_string).unwrap_or_default();
    let message = format!("`{}` and `{}` stand in one place: their attraction is infinite", name(a), name(b));
    let help = "move one of them, or write `softening:`, a length below which the force stops growing";
    let error = SceneError::new(world.resource::<Unsoftened>().0.clone(), message).with_help(help);
    world.get_resource_or_init::<LoadErrors>().0.push(error);
}

/// One entry, ready to be applied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttractionForce {
    /// `G` in N m2/kg2.
    pub constant: f64,
    /// Length `s` in metres below which the force stops growing.
    pub softening: f64,
    /// Its steepest encounter so far, without softening.
    pub nearest: SteepestFall,
}

/// The encounter of two bodies with the steepest attraction, without softening.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SteepestFall {
    /// Square of the angular frequency of a circular orbit at that distance, in 1/s2; zero without an encounter.
    pub squared_rate: f64,
    /// Places of both in [`Bodies`].
    pub between: (usize, usize),
}

/// The steepest encounter under an attraction without softening, over all evaluations of a run.
pub fn nearest(state: &State) -> Option<SteepestFall> {
    let all = state.models_of::<AttractionForce>().map(|attraction| attraction.nearest);
    all.filter(|nearest| nearest.squared_rate > 0.0).max_by(|a, b| a.squared_rate.total_cmp(&b.squared_rate))
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Attraction>();
}

fn pairs(dynamic: &[bool]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let all = (0..dynamic.len()).flat_map(|a| (a + 1..dynamic.len()).map(move |b| (a, b)));
    all.filter(|&(a, b)| dynamic[a] || dynamic[b])
}

impl Model for AttractionForce {
    fn dependence(&self) -> Dependence {
        Dependence::Position
    }

    fn save(&self) -> Memory {
        Memory::of(&self.nearest)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        self.nearest = recall(bytes)?;
        Ok(())
    }

    fn energies(&self, state: &State) -> Energies {
        let bodies = &state.bodies;
        let energy = |(a, b): (usize, usize)| {
            let between: DVec2 = bodies.position[b] - bodies.position[a];
            let distance = (between.length_squared() + self.softening * self.softening).sqrt();
            let strength = self.constant * bodies.mass[a] * bodies.mass[b];
            -strength / distance
        };
        Energies { potential: pairs(&bodies.dynamic).map(energy).sum(), elastic: 0.0 }
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn apply_forces(&mut self, state: &mut State) {
        let (bodies, rates) = state.bodies_and_rates();
        let Bodies { dynamic, moves, position, velocity, mass, force: sums, .. } = bodies;
        for (a, b) in pairs(dynamic) {
            let between = position[b] - position[a];
            let squared = between.length_squared() + self.softening * self.softening;
            let strength = self.constant * mass[a] * mass[b];
            let stiffness = strength / (squared * squared.sqrt());
            let force = between * stiffness;
            let squared_rate = stiffness * (mass[a] + mass[b]) / (mass[a] * mass[b]);
            if self.softening == 0.0 && squared_rate > self.nearest.squared_rate {
                self.nearest = SteepestFall { squared_rate, between: (a, b) };
            }
            sums[a] += force;
            sums[b] -= force;
            if !dynamic[a] {
                rates.outside(position[b], -force, 0.0);
                rates.work -= if moves[a] { force.dot(velocity[a]) } else { 0.0 };
            }
            if !dynamic[b] {
                rates.outside(position[a], force, 0.0);
                rates.work += if moves[b] { force.dot(velocity[b]) } else { 0.0 };
            }
        }
    }
}
