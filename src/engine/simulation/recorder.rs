//! The recorder of a film: frame k shows its time exactly, interpolated between two ticks if necessary.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use jostle_shapes::Hull;

use crate::record::frame::{BodyLook, BodyPose, Cast, Disc, Frame, HullLook, WallLook};
use crate::record::layers::Layers;
use crate::simulation::Simulation;
use crate::tick::Failure;
use crate::world::between::{MotionSample, angle_between, position_between};
use crate::world::{Bodies, Intangible, Line, Materials, Motion, Name, Wall};

/// Takes frames of a running simulation.
#[derive(Default)]
pub struct Recorder {
    cast: Arc<Cast>,
    generation: Option<u64>,
    before: Vec<(u64, MotionSample)>,
    /// Poses alone: no layers.
    bare: bool,
    /// The last tick at which layers looked.
    looked: Option<u64>,
}

impl Recorder {
    /// A recorder of frames without layers, for the positions of bodies alone.
    pub fn bare() -> Self {
        Self { bare: true, ..Self::default() }
    }

    /// Runs to `time` seconds and takes the frame. Times may not go back by more than a tick.
    ///
    /// # Errors
    /// When the run fails.
    ///
    /// # Panics
    /// If the time is not a finite number; as [`Simulation::state`].
    pub fn frame(&mut self, simulation: &mut Simulation, time: f64) -> Result<Frame, Failure> {
        assert!(time.is_finite(), "no frame shows {time} s: its time has to be a finite number");
        let dt = simulation.clock().dt;
        // A time that is a tick up to rounding counts as that tick.
        let exact = time / dt;
        let on_tick = (exact - exact.round()).abs() < 1e-6;
        let tick = if on_tick { exact.round() } else { exact.floor() } as u64;
        self.look_on_the_way(simulation, tick, time)?;
        simulation.run_to_tick(tick)?;
        if !on_tick && simulation.clock().ticks == tick {
            self.before = samples(simulation.bodies(), simulation.clock().time());
            simulation.run_to_tick(tick + 1)?;
        }
        self.refresh_cast(simulation);
        let after = samples(simulation.bodies(), simulation.clock().time());
        let pose = |&(key, after): &(u64, MotionSample)| {
            let before = self.before.binary_search_by_key(&key, |(key, _)| *key).ok().map(|index| self.before[index].1);
            let before = before.filter(|before| !on_tick && before.time <= time).unwrap_or(after);
            BodyPose { position: position_between(&before, &after, time), angle: angle_between(&before, &after, time) }
        };
        let marks = if self.bare { Vec::new() } else { Layers::marks(simulation.unpublished_world()) };
        Ok(Frame { time, cast: self.cast.clone(), poses: after.iter().map(pose).collect(), marks, center: None })
    }

    /// Runs on, up to a tick, and stops wherever a layer looks.
    fn look_on_the_way(&mut self, simulation: &mut Simulation, tick: u64, time: f64) -> Result<(), Failure> {
        let dt = simulation.clock().dt;
        while let Some(next) = Layers::next_look(simulation.unpublished_world(), self.looked, time, dt)
            && next <= tick
            && !self.bare
        {
            self.looked = Some(next);
            simulation.run_to_tick(next)?;
            // Past ticks cannot be read.
            if simulation.clock().ticks == next {
                Layers::look(&mut simulation.world, next, dt);
            }
        }
        Ok(())
    }

    fn refresh_cast(&mut self, simulation: &Simulation) {
        let generation = simulation.bodies().generation;
        if self.generation != Some(generation) {
            self.generation = Some(generation);
            self.cast = Arc::new(cast_of(simulation));
        }
    }
}

fn samples(bodies: &Bodies, time: f64) -> Vec<(u64, MotionSample)> {
    (0..bodies.len()).map(|index| (bodies.key.at(index), MotionSample::of(bodies, index, time))).collect()
}

fn look(hull: &Hull) -> HullLook {
    let cuts = hull.sides().iter().map(|side| side.inner).collect();
    HullLook { corners: hull.corners().to_vec(), cuts, radius: hull.radius() }
}

/// The cast of a film from the current bodies and walls.
fn cast_of(simulation: &Simulation) -> Cast {
    let (world, bodies) = (simulation.unpublished_world(), simulation.bodies());
    let materials = world.get_resource::<Materials>();
    let color = |material: crate::world::MaterialIndex| {
        materials.and_then(|materials| materials.by_index.get(material.index())?.color.clone())
    };
    let name = |entity: Entity| world.get::<Name>(entity).map(Name::to_string).unwrap_or_default();
    let body = |index: usize| {
        let atoms = bodies.atoms_of(index);
        let discs = atoms
            .clone()
            .filter(|a| !bodies.is_corner(*a))
            .map(|a| Disc { offset: bodies.atom_offset(a), radius: bodies.atom_radius[a] });
        let intangible = world.get::<Intangible>(bodies.entity[index]);
        let parts = intangible.map_or(&[][..], |intangible| &intangible.hulls);
        let (round, sided) = parts.iter().partition::<Vec<&Hull>, _>(|hull| hull.corners().len() == 1);
        let seen = round.iter().map(|disc| Disc { offset: disc.corners()[0], radius: disc.radius() });
        let hulls = bodies.hulls_of(index).map(|packed| &packed.hull).chain(sided).map(look);
        let fixed =
            world.get::<crate::world::Body>(bodies.entity[index]).is_some_and(|body| body.motion == Motion::Fixed);
        BodyLook {
            name: name(bodies.entity[index]),
            color: (atoms.clone().next().map(|first| bodies.atom_material(first)))
                .or(intangible.map(|intangible| intangible.material))
                .and_then(color),
            discs: discs.chain(seen).collect(),
            hulls: hulls.collect(),
            fixed,
        }
    };
    let wall = |index: usize| {
        let entity = bodies.walls[index].entity;
        let Wall { left, right, thickness, material, .. } = *world.get::<Wall>(entity)?;
        let points = world.get::<Line>(entity).filter(|_| thickness.is_none());
        let points = points.map_or_else(Vec::new, |Line(points)| points.clone());
        Some(WallLook { name: name(entity), left, right, thickness, points, color: color(material) })
    };
    let walls = (0..bodies.walls.len()).filter(|index| bodies.whole_wall(*index) == *index);
    Cast {
        title: simulation.header().title.clone().unwrap_or_default(),
        bodies: (0..bodies.len()).map(body).collect(),
        walls: walls.filter_map(wall).collect(),
    }
}
