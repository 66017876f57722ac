//! A plugin for Jostle: a spring that pulls a body home, `F = -k (x - x_home)` on the centre of mass (Hooke).
//!
//! In a scene: `forces: [HomeSpring(of: "ball", home: (0, 0), stiffness: 2)]`; its sensor
//! `sensors: [HomeSpringStretch(of: "ball")]` gives the greatest stretch so far, the channel `ball.home_spring.stretch`.
//! Films show the spring.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle::record::{FilmAppExt, Mark, MarkShape};
use jostle::scene::units::{LengthPair as At, Stiffness};
use jostle::scene::values::Names;
use jostle::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, WrittenEntry};
use jostle::sensors::{self, Channel, Channels, SensorAppExt};
use jostle::tick::kept::SnapshotAppExt;
use jostle::tick::{SimTick, Stage, TickAppExt};
use jostle::world::{Body, Force, Name, Position};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Registers what scenes may name: `Simulation::load_with(&source, &Overrides::default(), home_spring::plugin)`.
pub fn plugin(app: &mut App) {
    app.register_entry::<HomeSpring>().register_entry::<HomeSpringStretch>();
    app.add_quantities(&[STRETCH], find_stretch);
    // Snapshots (`run --save`) keep what the springs remember.
    app.keep_resource::<Springs>();
}

/// A spring from a point of the world to the centre of mass.
// The entry as it stands in the scene. Quantities take numbers in SI units and texts with units; the comments with three
// strokes are what the manual says of it.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct HomeSpring {
    /// The bodies it acts on, `*` matches.
    of: Names,
    /// Where the spring is relaxed, in metres. Default: (0, 0).
    #[serde(default)]
    home: At,
    /// Stiffness k in N/m, above zero.
    stiffness: Stiffness,
}

/// The springs of a scene: state of the plugin's own. A scene without the entry never has it.
#[derive(Resource, Default, Serialize, Deserialize)]
struct Springs(Vec<Spring>);

#[derive(Serialize, Deserialize)]
struct Spring {
    body: Entity,
    home: DVec2,
    stiffness: f64,
    /// Greatest stretch at the end of a tick so far, in metres.
    greatest: f64,
}

impl Entry for HomeSpring {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "HomeSpring";
    const EXAMPLE: &'static str = "HomeSpring(of: \"ball\", home: (0, 0), stiffness: 2)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::BODY, outline, "of", report);
        report.positive("stiffness", self.stiffness);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let mut springs = Springs::default();
        for WrittenEntry { value, .. } in entries {
            for index in value.of.matching(NameKind::BODY, outline) {
                let Some(body) = body_named(app.world_mut(), &outline.names(NameKind::BODY)[index]) else { continue };
                springs.0.push(Spring { body, home: value.home.si(), stiffness: value.stiffness.si(), greatest: 0.0 });
            }
        }
        app.insert_resource(springs).add_force(pull_home);
        app.add_systems(SimTick, note_stretch.in_set(Stage::Observe));
        app.add_layer(draw_springs);
    }
}

/// Integrators run this as often as they need: a force depends on the state and changes nothing but forces.
fn pull_home(springs: Res<Springs>, mut bodies: Query<(&Position, &mut Force)>) {
    for spring in &springs.0 {
        if let Ok((position, mut force)) = bodies.get_mut(spring.body) {
            force.0 -= spring.stiffness * (position.0 - spring.home);
        }
    }
}

/// Runs once per tick, so it may remember.
fn note_stretch(mut springs: ResMut<Springs>, bodies: Query<&Position>) {
    for spring in &mut springs.0 {
        if let Ok(position) = bodies.get(spring.body) {
            spring.greatest = spring.greatest.max(position.0.distance(spring.home));
        }
    }
}

/// Called once for each frame: it looks and adds marks. A spring is a zigzag from a ring at home to the body.
fn draw_springs(world: &World, marks: &mut Vec<Mark>) {
    for spring in world.get_resource::<Springs>().into_iter().flat_map(|springs| &springs.0) {
        let Some(body) = world.get::<Position>(spring.body) else { continue };
        let way = body.0 - spring.home;
        let across = 0.05 * way.normalize_or_zero().perp();
        let corner = |step: usize| {
            let share = step as f64 / 16.0;
            spring.home + share * way + across * [0.0, 1.0, 0.0, -1.0][step % 4]
        };
        let zigzag = (0..16).map(|step| MarkShape::Line(corner(step), corner(step + 1)));
        let shapes = zigzag.chain([MarkShape::Circle(spring.home, 0.03)]);
        marks.extend(shapes.map(|shape| Mark { shape, color: Some("vermilion".to_owned()) }));
    }
}

const STRETCH: &str = "home_spring.stretch";

/// The greatest stretch of the springs so far, in metres: `ball.home_spring.stretch`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct HomeSpringStretch {
    /// The bodies, `*` matches.
    of: Names,
}

impl Entry for HomeSpringStretch {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "HomeSpringStretch";
    const EXAMPLE: &'static str = "HomeSpringStretch(of: \"ball\")";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        self.of.require(NameKind::BODY, outline, "of", report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for index in entries.iter().flat_map(|entry| entry.value.of.matching(NameKind::BODY, outline)) {
            let name = format!("{}.{STRETCH}", outline.names(NameKind::BODY)[index]);
            if let Some(channel) = sensors::find(app.world_mut(), &name) {
                Channels::add(app.world_mut(), channel);
            }
        }
    }
}

/// The channel in metres; zero for a body without a spring. Expectations find it by its name too.
fn find_stretch(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let body = body_named(world, owner).filter(|_| quantity == STRETCH)?;
    let read = move |world: &World| {
        let springs = world.get_resource::<Springs>().map_or(&[][..], |springs| &springs.0);
        springs.iter().filter(|spring| spring.body == body).fold(0.0, |most, spring| spring.greatest.max(most))
    };
    Some(Channel::new(format!("{owner}.{quantity}"), "m", read))
}

fn body_named(world: &mut World, name: &str) -> Option<Entity> {
    let mut bodies = world.query_filtered::<(Entity, &Name), With<Body>>();
    bodies.iter(world).find(|(_, found)| **found == *name).map(|(body, _)| body)
}

#[cfg(test)]
mod tests;
