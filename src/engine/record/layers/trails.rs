//! `Trails(of: ["T"], seconds: 0.5)`: the past positions of the centres of bodies, fading and tapering.
//!
//! Positions are noted at the end of ticks, at least so often that a trail has 256 points. With very many bodies a
//! trail has fewer. So all trails together stay within some 33 000 points, however long the film is.

use std::collections::{BTreeMap, VecDeque};

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::of_bodies::OfBodies;
use super::{Layer, LayerMemory, Mark, MarkShape, Shown, stride};
use crate::scene::units::Time;
use crate::scene::values::Names;
use crate::scene::{Diagnostics, NameKind, Outline, SceneAppExt};
use crate::tick::State;

/// Points of one trail, at most and at least.
const POINTS: (usize, usize) = (4, 256);

/// Points of all trails of one kind together, unless each has the least.
const ALL_POINTS: usize = 1 << 15;

/// The past positions of the centres of bodies, fading. It may stand more than once.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Trails {
    /// The bodies. `*` stands for any letters. Default: all that move.
    #[serde(default)]
    of: Option<Names>,
    /// The length of a trail, in s of physics. Above zero. Default: 0.5.
    #[serde(default = "half_a_second")]
    seconds: Time,
}

fn half_a_second() -> Time {
    Time::new(0.5)
}

impl OfBodies for Trails {
    const NAME: &'static str = "Trails";
    const EXAMPLE: &'static str = "Trails(of: [\"ball\"], seconds: 0.5)";

    fn of(&self) -> Option<&Names> {
        self.of.as_ref()
    }

    fn check_others(&self, report: &mut Diagnostics) {
        report.positive("seconds", self.seconds);
    }

    fn layer(self, shown: Shown, outline: &Outline) -> impl Layer {
        let count = shown.0.as_ref().map_or(outline.count(NameKind::BODY), Vec::len);
        let points = (ALL_POINTS / count.max(1)).clamp(POINTS.0, POINTS.1);
        Tracks { shown, seconds: self.seconds.si(), points, looked: None, tracks: BTreeMap::new() }
    }
}

/// The past positions of bodies.
struct Tracks {
    shown: Shown,
    /// The length of a trail, in seconds.
    seconds: f64,
    /// The most points of a trail.
    points: usize,
    /// The tick of the last look.
    looked: Option<u64>,
    /// By the keys of bodies, from early to late.
    tracks: BTreeMap<u64, VecDeque<DVec2>>,
}

impl Layer for Tracks {
    fn draw(&self, world: &World, marks: &mut Vec<Mark>) {
        let (bodies, dt) = (&world.resource::<State>().bodies, world.resource::<State>().clock.dt);
        let step = self.memory().map_or(1.0, |memory| stride(memory, dt) as f64 * dt / self.seconds);
        for body in self.shown.indices(bodies) {
            let Some(track) = self.tracks.get(&bodies.key.at(body)) else { continue };
            let points: Vec<DVec2> = track.iter().copied().chain([bodies.position[body]]).collect();
            marks.push(Mark::plain(MarkShape::Trail { body, points, step }));
        }
    }

    fn memory(&self) -> Option<LayerMemory> {
        Some(LayerMemory { every: self.seconds / self.points as f64, length: self.seconds })
    }

    fn look(&mut self, world: &World) {
        let (bodies, clock) = (&world.resource::<State>().bodies, &world.resource::<State>().clock);
        // Between two distant frames no positions are needed until the trail of the second one begins.
        let stride = self.memory().map_or(1, |memory| stride(memory, clock.dt));
        if self.looked.is_some_and(|looked| looked + stride != clock.ticks) {
            self.tracks.clear();
        }
        self.looked = Some(clock.ticks);
        let indices: Vec<usize> = self.shown.indices(bodies).collect();
        self.tracks.retain(|key, _| bodies.key.find(*key).is_some());
        for body in indices {
            let track = self.tracks.entry(bodies.key.at(body)).or_default();
            if track.len() >= self.points {
                track.pop_front();
            }
            track.push_back(bodies.position[body]);
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Trails>();
}
