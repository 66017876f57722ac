//! `walls`: half-planes that nothing enters.

use bevy_app::App;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use crate::scene::units::{Position, Velocity};
use crate::scene::{Kind, Obstacle, Outline, Report, Section};
use crate::world::{material, sections};

/// One wall: the half-plane behind the line through two points.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Wall")]
pub struct WallEntry {
    /// The name, for sensors and messages.
    pub name: String,
    /// Seen from the open side, the point to the left, in m.
    pub left: Position,
    /// Seen from the open side, the point to the right, in m.
    pub right: Position,
    /// The name of its material. Default: `default`.
    #[serde(default)]
    pub material: Option<String>,
    /// The velocity of its surface along the wall, in m/s: a belt. Default: (0, 0).
    #[serde(default)]
    pub surface_velocity: Velocity,
}

/// How far a surface velocity may point out of its wall, as a share of itself: digits that people leave out.
const ALONG: f64 = 1e-6;

/// Half-planes that nothing enters, such as floors, slopes and belts.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub struct WallsSection(pub Vec<WallEntry>);

impl Section for WallsSection {
    const NAME: &'static str = "walls";
    const EXAMPLE: &'static str = "walls: [(name: \"floor\", left: (6, 0), right: (0, 0), material: \"rock\")]";

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    /// Declares the walls' names.
    fn declare(&self, outline: &mut Outline) {
        for (index, wall) in self.0.iter().enumerate() {
            outline.declare(Kind::WALL, &wall.name, &format!("[{index}].name"));
            outline.occupy(Obstacle::Wall { left: wall.left.si(), right: wall.right.si() });
        }
    }

    /// Reports two points in one place and unknown materials.
    fn check(&self, outline: &Outline, report: &mut Report) {
        for (index, wall) in self.0.iter().enumerate() {
            report.within(&format!("[{index}]"), |report| wall.check(outline, report));
        }
    }

    fn install(self, _: &Outline, app: &mut App) {
        sections::spawn_walls(self, app.world_mut());
    }
}

impl WallEntry {
    /// The velocity of its surface in m/s, without what rounding leaves across the wall.
    pub fn belt(&self) -> DVec2 {
        let along = (self.right.si() - self.left.si()).normalize_or_zero();
        along * self.surface_velocity.si().dot(along)
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        let (left, right) = (self.left.si(), self.right.si());
        let finite = report.finite_pair("left", left) & report.finite_pair("right", right);
        let length = (right - left).length();
        if finite && !(length > 0.0 && length.is_finite()) {
            let message = format!("must differ from `left`, got ({}, {}) for both", right.x, right.y);
            report.error("right", message).help("a wall is the line through two points, seen from the open side");
        }
        let velocity = self.surface_velocity.si();
        if report.finite_pair("surface_velocity", velocity) && finite && length > 0.0 {
            let tangential = self.belt();
            if (velocity - tangential).length() > ALONG * velocity.length() {
                let message = "a surface moves along its wall, not into or out of it";
                let digits = |value: f64| (value * 1e6).round() / 1e6;
                let (x, y) = (digits(tangential.x), digits(tangential.y));
                let help = format!("along this wall it would be ({x:?}, {y:?})");
                report.error("surface_velocity", message).help(help);
            }
        }
        material::require(self.material.as_deref(), outline, report);
    }
}
