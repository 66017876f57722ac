//! `Springs`: springs as coils, torsion springs as spirals.

use std::f64::consts::TAU;

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Mark, MarkShape, PictureHeight, add_own_layer};
use crate::forces::spring::SpringForce;
use crate::forces::torsion_spring::TorsionSpringForce;
use crate::record::sections::look::LAYERS;
use crate::scene::{Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::State;

/// Half the width of a coil as a share of the picture's height.
const HALF_WIDTH: f64 = 0.01;
/// Turns of a coil, and of a spiral without torque.
const COILS: u32 = 9;
const TURNS: f64 = 2.5;
/// Share of its length that is straight at each end.
const STRAIGHT: f64 = 0.12;
/// Outer radius of a spiral as a share of the picture's height.
const SPIRAL: f64 = 0.03;
/// Lines of a spiral in each turn.
const SIDES: f64 = 20.0;

/// Springs as coils between their ends, torsion springs as spirals about the centre of their body. A scene with springs
/// shows them by default.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Springs {}

impl Entry for Springs {
    const SECTION: &'static str = LAYERS;
    const NAME: &'static str = "Springs";
    const EXAMPLE: &'static str = "Springs";

    fn install(_: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        add_own_layer(app, draw);
    }
}

fn draw(world: &World, marks: &mut Vec<Mark>) {
    let state = world.resource::<State>();
    let height = PictureHeight::of(world);
    for spring in state.models_of::<SpringForce>() {
        if let Some((a, b)) = spring.link.ends(state.bodies()) {
            polyline(marks, &coil(a.position, b.position, HALF_WIDTH * height));
        }
    }
    for spring in state.models_of::<TorsionSpringForce>() {
        let Some((a, b)) = spring.link.ends(state.bodies()) else { continue };
        let turned = a.turn(state.bodies()).0 - b.turn(state.bodies()).0;
        polyline(marks, &spiral(a.position, a.turn(state.bodies()).0, TURNS * TAU + turned, SPIRAL * height));
    }
}

/// A zigzag between two points.
fn coil(from: DVec2, to: DVec2, half_width: f64) -> Vec<DVec2> {
    let along = to - from;
    let across = along.normalize_or_zero().perp() * half_width;
    let mut points = vec![from, from + along * STRAIGHT];
    for turn in 0..2 * COILS {
        let share = STRAIGHT + (1.0 - 2.0 * STRAIGHT) * (f64::from(turn) + 0.5) / f64::from(2 * COILS);
        points.push(from + along * share + if turn % 2 == 0 { across } else { -across });
    }
    points.extend([to - along * STRAIGHT, to]);
    points
}

/// A spiral from the centre outwards over an angle in rad, which ends at the angle `end`.
fn spiral(center: DVec2, end: f64, angle: f64, radius: f64) -> Vec<DVec2> {
    let lines = (angle.abs() / TAU * SIDES).ceil().clamp(SIDES, 50.0 * SIDES) as u32;
    let point = |line: u32| {
        let share = f64::from(line) / f64::from(lines);
        let (sin, cos) = libm::sincos(end - angle * (1.0 - share));
        center + DVec2::new(cos, sin) * (radius * share)
    };
    (0..=lines).map(point).collect()
}

fn polyline(marks: &mut Vec<Mark>, points: &[DVec2]) {
    marks.extend(points.windows(2).map(|pair| Mark::plain(MarkShape::Line(pair[0], pair[1]))));
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Springs>();
}
