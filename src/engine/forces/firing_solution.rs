//! Aiming: a body gets the velocity of a given size with which its centre of mass flies through a point.
//!
//! The solution includes gravity, drag and wind of the scene (see [`super::ballistics`]). It ignores contacts and other
//! forces, and the card says so. It acts once, before the first tick, and is no force.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ballistics::{Arc, Flight, Miss, Shot};
use super::{drag, wind};
use crate::scene::units::{LengthPair, Speed};
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneAppExt, SceneError, WrittenEntry};
use crate::tick::Notes;
use crate::tick::{AfterLoad, LoadErrors, State};
use crate::world::Velocity;
use jostle_language::numbers::number;

/// Gives a body the velocity at the start with which its centre of mass flies through a point. Gravity, drag and wind of
/// the scene count. Other forces make it miss. An unreachable point is an error that names a sufficient speed.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Aim {
    /// The body that flies. It must have no `velocity` in the scene.
    of: String,
    /// The place that it reaches, in metres.
    at: LengthPair,
    /// Its speed at the start in m/s. Above zero.
    speed: Speed,
    /// The lower or the higher one of the two ways. Default: `Low`.
    #[serde(default)]
    arc: AimArc,
}

/// One of the two ways to a place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
enum AimArc {
    /// The shorter flight.
    #[default]
    Low,
    /// The longer flight.
    High,
}

/// The forces that the solution includes.
const RECKONED: [&str; 3] = ["Drag", "Wind", "Aim"];

impl Entry for Aim {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Aim";
    const EXAMPLE: &'static str = "Aim(of: \"ball\", at: (40, 5), speed: 25, arc: High)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        outline.require(NameKind::BODY, &self.of, "of", report);
        report.positive("speed", self.speed);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let mentions = outline.entries(Self::SECTION).iter();
        let paths = mentions.clone().filter(|mention| mention.name == Self::NAME).map(|mention| mention.path.clone());
        let aim = |(WrittenEntry { value, .. }, path): (WrittenEntry<Self>, String)| AimedBody {
            key: outline.position(NameKind::BODY, &value.of).unwrap_or_default() as u64,
            name: value.of,
            at: value.at.si(),
            speed: value.speed.si(),
            arc: if value.arc == AimArc::Low { Arc::Low } else { Arc::High },
            path,
        };
        let aims = entries.into_iter().zip(paths).map(aim).collect();
        let mut others: Vec<String> = mentions.map(|mention| mention.name.clone()).collect();
        others.retain(|name| !RECKONED.contains(&name.as_str()));
        others.sort();
        others.dedup();
        app.insert_resource(Aims { aims, others });
        app.world_mut().get_resource_or_init::<AfterLoad>().0.push(aim_bodies);
    }
}

struct AimedBody {
    key: u64,
    name: String,
    at: DVec2,
    speed: f64,
    arc: Arc,
    path: String,
}

#[derive(Resource)]
struct Aims {
    aims: Vec<AimedBody>,
    /// Names of forces of the scene that the solution does not reckon with.
    others: Vec<String>,
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Aim>();
}

fn aim_bodies(world: &mut World) {
    let Some(Aims { aims, others }) = world.remove_resource::<Aims>() else { return };
    let (mut errors, mut notes) = (Vec::new(), Vec::new());
    let mut aimed: Vec<u64> = Vec::new();
    for aim in &aims {
        let found = if aimed.contains(&aim.key) {
            let message = format!("`{}` is aimed twice", aim.name);
            Err(Box::new(SceneError::new(format!("{}.of", aim.path), message).with_help("keep one of the two")))
        } else {
            aim.solve(world)
        };
        aimed.push(aim.key);
        match found {
            Ok((body, shot)) => {
                let bodies = &mut world.resource_mut::<State>().bodies;
                bodies.velocity[body] = shot.velocity;
                let entity = bodies.entity[body];
                world.entity_mut(entity).insert(Velocity(shot.velocity));
                let DVec2 { x, y } = shot.velocity;
                let angle = number(libm::atan2(y, x).to_degrees());
                let (name, time) = (&aim.name, number(shot.time));
                notes.push(format!("`{name}` starts at {angle} deg and reaches its aim at t = {time} s"));
            }
            Err(error) => errors.push(*error),
        }
    }
    if !others.is_empty() && errors.is_empty() {
        notes.push(format!("the aim reckons with gravity, drag and wind, not with {}", others.join(", ")));
    }
    world.resource_mut::<Notes>().0.extend(notes);
    world.get_resource_or_init::<LoadErrors>().0.extend(errors);
}

impl AimedBody {
    /// Place of the body, and how it is thrown.
    fn solve(&self, world: &World) -> Result<(usize, Shot), Box<SceneError>> {
        let Self { key, name, at, speed, arc, path } = self;
        let wrong = |field: &str, message: String, help: String| {
            Err(Box::new(SceneError::new(format!("{path}.{field}"), message).with_help(help)))
        };
        let bodies = &world.resource::<State>().bodies;
        let body = bodies.key.find(*key).filter(|&body| bodies.dynamic[body]);
        let Some(body) = body else {
            let help = "aim a body that is neither `fixed` nor `kinematic`".to_owned();
            return wrong("of", format!("`{name}` does not move by forces"), help);
        };
        if bodies.velocity[body] != DVec2::ZERO {
            let help = "remove its `velocity`: the aim gives it one".to_owned();
            return wrong("of", format!("`{name}` has a `velocity` already"), help);
        }
        let state = world.resource::<State>();
        let gravity = state.gravity();
        let mut air = drag::resistance(state, *key);
        air.extend(wind::resistance(state, *key));
        let flight = Flight { gravity, mass: bodies.mass[body], air };
        match flight.aim(*at - bodies.position[body], *speed, *arc) {
            Ok(shot) => Ok((body, shot)),
            Err(Miss::Here) => {
                let message = format!("`{name}` is at ({}, {}) already", number(at.x), number(at.y));
                wrong("at", message, "aim at another place, or start elsewhere".into())
            }
            Err(Miss::Short { least, reach }) => {
                let (least, reach, speed) = (number(least), number(reach), number(*speed));
                let message = format!("{speed} m/s are too slow to reach ({}, {})", number(at.x), number(at.y));
                let help = format!("{least} m/s reach it; {speed} m/s reach {reach} m in this direction");
                wrong("speed", message, help)
            }
            Err(Miss::Never) => {
                let message = format!("no way to ({}, {}) was found at this speed", number(at.x), number(at.y));
                wrong("at", message, "aim nearer, or reduce the drag".into())
            }
            Err(Miss::OneWay) => {
                let message = "without gravity there is one way to the place, not two".to_owned();
                wrong("arc", message, "remove `arc`".into())
            }
        }
    }
}
