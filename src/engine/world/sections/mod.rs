//! The conversion of the scene's `materials`, `pairs`, `walls`, `bodies`, `packings` and `fill` to entities.

pub mod bodies;
pub mod fill;
mod ignored;
pub mod kinematic;
pub mod packing;
pub mod region;
pub mod size_distribution;
mod taken;
pub mod walls;

pub use bodies::{BodiesSection, BodyEntry, Datum, InertiaRule};
pub use fill::{FillEntry, FillSection, Placed};
pub use kinematic::{KinematicEntry, PathEntry};
pub use packing::{PackingEntry, PackingsSection};
pub use region::Region;
pub use walls::{WallEntry, WallsSection};

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use super::hull::MendedShapes;
use super::material::{MaterialIndex, Materials, MaterialsSection, PairsSection};
use super::spawn::{NextKey, Series, after_others, spawn_series};
use super::{Atom, Intangible, Line, Motion, Name, NewBody, Origin, Wall};
use crate::scene::name_series::of_series;
use crate::scene::{NameKind, Outline, SceneAppExt, register_embedding};
use crate::shapes::mass_properties::MassProperties;
use crate::shapes::outline::OutlineShape;
use crate::shapes::{AtomShape, AtomSpec, silhouette, svg};

/// The largest number of atoms and corners of all bodies of a section. Each takes about a kilobyte.
pub(super) const MOST_ATOMS: u64 = 1_000_000;

/// The number of atoms and corners of a body.
fn size(atoms: Option<&AtomShape>, shape: Option<&OutlineShape>) -> u64 {
    let hulls = shape.map_or_else(Vec::new, |shape| shape.parts().parts).into_iter().flat_map(|part| part.hulls);
    let corners: usize = hulls.map(|hull| hull.corners().len()).sum();
    (atoms.map_or(0, |atoms| atoms.specs().len()) + corners) as u64
}

/// Registers the sections. Materials come first: the others name them.
pub fn plugin(app: &mut App) {
    app.init_resource::<Materials>();
    app.register_section::<MaterialsSection>();
    app.register_section::<PairsSection>();
    app.register_section::<WallsSection>();
    app.register_section::<BodiesSection>();
    app.register_section::<PackingsSection>();
    register_embedding(app, packing::EMBEDDING);
    register_embedding(app, silhouette::EMBEDDING);
    register_embedding(app, svg::EMBEDDING);
    app.register_section::<FillSection>();
}

/// Spawns the walls of a scene.
pub fn spawn_walls(section: WallsSection, world: &mut World) {
    for wall in section.0 {
        let material = material(world, wall.material.as_deref());
        let mut next = world.get_resource_or_init::<NextKey>();
        let key = next.wall;
        next.wall += 1;
        let (points, thickness) = (wall.points(), wall.thickness());
        let [left, right] = match points.as_deref() {
            Some([first, .., last]) => [*last, *first],
            _ => wall.ends(),
        };
        let surface_velocity = wall.belt();
        let wall = (Wall { key, left, right, thickness, material, surface_velocity }, Name::from(wall.name));
        match points {
            Some(points) => world.spawn((wall, Line(points))),
            None => world.spawn(wall),
        };
    }
}

/// Spawns the bodies of a scene.
pub fn spawn_bodies(section: BodiesSection, outline: &Outline, world: &mut World) {
    after_others(world, section.0.len(), |world| spawn_entries(section, outline, world));
}

fn spawn_entries(section: BodiesSection, outline: &Outline, world: &mut World) {
    for entry in section.0 {
        let made_of = MadeOf::named(world, entry.material.as_deref());
        let mut properties = entry.mass_properties(made_of.density);
        if !entry.touches() {
            properties.intangible.append(&mut properties.hulls);
        }
        let kinematic = entry.prescribed(&properties);
        let origin = (entry.datum == Datum::Origin).then_some(Origin(-properties.center));
        let start = kinematic.as_ref().map(|motion| motion.state(0.0));
        let body = NewBody {
            position: entry.start(&properties),
            motion: if entry.fixed { Motion::Fixed } else { Motion::Dynamic },
            collides: entry.touches(),
            angle: entry.angle.si(),
            velocity: start.map_or(entry.velocity.si(), |start| start.velocity),
            spin: start.map_or(entry.spin.si(), |start| start.spin),
            kinematic,
            name: entry.name.clone(),
            ..made_of.body(&properties)
        };
        for mended in entry.shape.iter().flat_map(|shape| shape.parts().mended) {
            world.get_resource_or_init::<MendedShapes>().add(&body.name, mended);
        }
        let (key, body) = keyed(body, outline);
        let entity = body.spawn_keyed(world, key);
        if let Some(origin) = origin {
            world.entity_mut(entity).insert(origin);
        }
    }
}

/// Spawns the bodies of the packings of a scene.
pub fn spawn_packings(section: PackingsSection, outline: &Outline, world: &mut World) {
    for entry in section.0 {
        let Some(table) = entry.read(outline) else { continue };
        let made_of = MadeOf::named(world, entry.material.as_deref());
        let body = |number| {
            let start = table.body(number, made_of.density);
            NewBody {
                position: start.position,
                angle: start.angle,
                velocity: start.velocity,
                spin: start.spin,
                ..made_of.body(&start.properties)
            }
        };
        let lone_discs = table.atom_count() == table.body_count();
        spawn_series(world, series(entry.name, table.body_count(), lone_discs, outline), body);
    }
}

/// Spawns the bodies of the fills of a scene.
pub fn spawn_fill(section: FillSection, outline: &Outline, world: &mut World) {
    for (entry, placed) in section.0.iter().zip(section.place(outline)) {
        let made_of = MadeOf::named(world, entry.material.as_deref());
        let mut properties = entry.mass_properties(made_of.density);
        if !entry.touches() {
            properties.intangible.append(&mut properties.hulls);
        }
        for mended in entry.shape.iter().flat_map(|shape| shape.parts().mended) {
            world.get_resource_or_init::<MendedShapes>().add(&entry.name, mended);
        }
        let body = |number: usize| {
            let Placed { position, angle, velocity, radius } = placed[number];
            let own = entry.radius.is_some().then(|| fill::disc(radius, made_of.density));
            let made = made_of.body(own.as_ref().unwrap_or(&properties));
            NewBody { collides: entry.touches(), position, angle, velocity, ..made }
        };
        let is_disc = matches!(properties.atoms[..], [AtomSpec { offset: DVec2::ZERO, .. }]);
        let lone_discs = is_disc && properties.hulls.is_empty();
        spawn_series(world, series(entry.name.clone(), placed.len(), lone_discs, outline), body);
    }
}

fn material(world: &World, name: Option<&str>) -> MaterialIndex {
    MaterialIndex::new(world.resource::<Materials>().index(name))
}

/// The key of a body is its index in the outline. Names are looked up there, and keys are the canonical order.
fn keyed(body: NewBody, outline: &Outline) -> (Option<u64>, NewBody) {
    (outline.position(NameKind::BODY, &body.name).map(|index| index as u64), body)
}

/// Bodies that are named by their numbers. They follow one another in the outline.
fn series(prefix: String, count: usize, lone_discs: bool, outline: &Outline) -> Series {
    let key = outline.position(NameKind::BODY, &of_series(&prefix, 0)).map(|index| index as u64);
    Series { prefix, count, key, lone_discs }
}

/// The common data of bodies of one material.
struct MadeOf {
    material: MaterialIndex,
    density: f64,
    stiffness: Option<f64>,
}

impl MadeOf {
    fn named(world: &World, name: Option<&str>) -> Self {
        let material = material(world, name);
        let materials = world.resource::<Materials>();
        let density = materials.by_index[material.index()].density;
        Self { material, density, stiffness: materials.stiffness(material.index()) }
    }

    /// A body at rest in the origin. Atoms without a stiffness of their own have the material's. If it has none either, they wait for
    /// one with NaN.
    fn body(&self, properties: &MassProperties) -> NewBody {
        let atom = |spec: &AtomSpec| Atom {
            offset: spec.offset,
            radius: spec.radius,
            mass: spec.mass.unwrap_or_default(),
            stiffness: spec.stiffness.or(self.stiffness).unwrap_or(f64::NAN),
            material: self.material,
        };
        let corners = properties.hulls.iter().flat_map(|hull| {
            let radius = hull.radius();
            hull.corners().iter().map(move |&offset| AtomSpec { offset, radius, mass: None, stiffness: None })
        });
        let corners = corners.map(|spec| atom(&spec));
        NewBody {
            mass: properties.mass,
            inertia: properties.inertia,
            atoms: properties.atoms.iter().map(atom).chain(corners).collect(),
            hulls: properties.hulls.clone(),
            intangible: (!properties.intangible.is_empty())
                .then(|| Intangible { hulls: properties.intangible.clone(), material: self.material }),
            ..NewBody::default()
        }
    }
}
