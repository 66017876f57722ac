//! `walls`: half-planes and strips that nothing enters.

use bevy_app::App;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use crate::scene::units::{Length, Position, Velocity};
use crate::scene::{Kind, Obstacle, Outline, Report, Section};
use crate::world::{material, sections};

/// One wall: the half-plane behind the line through two points; or, with `from` and `to`, a strip with two round ends.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Wall")]
pub struct WallEntry {
    /// The name, for sensors and messages.
    pub name: String,
    /// Of a half-plane: seen from the open side, the point to the left, in m. Default: none, for a strip.
    #[serde(default)]
    pub left: Option<Position>,
    /// Of a half-plane: seen from the open side, the point to the right, in m. Default: none, for a strip.
    #[serde(default)]
    pub right: Option<Position>,
    /// Of a strip: where its middle line begins, in m. A strip is hit from both sides. Default: none, for a half-plane.
    #[serde(default)]
    pub from: Option<Position>,
    /// Of a strip: where its middle line ends, in m. Default: none, for a half-plane.
    #[serde(default)]
    pub to: Option<Position>,
    /// Of a strip: its thickness, in m; ends are round. Default: 0.
    #[serde(default)]
    pub thickness: Option<Length>,
    /// The name of its material. Default: `default`.
    #[serde(default)]
    pub material: Option<String>,
    /// Of a half-plane: the velocity of its surface along the wall, in m/s: a belt. Default: (0, 0).
    #[serde(default)]
    pub surface_velocity: Velocity,
}

/// How far a surface velocity may point out of its wall, as a share of itself: digits that people leave out.
const ALONG: f64 = 1e-6;

/// Half-planes that nothing enters, such as floors, slopes and belts; and strips with two ends, such as shelves and funnels.
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
            let [left, right] = wall.line();
            outline.occupy(match wall.thickness() {
                None => Obstacle::Wall { left, right },
                Some(thickness) => Obstacle::Strip { from: right, to: left, radius: 0.5 * thickness },
            });
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

/// Fields of a half-plane, and of a strip.
const HALF_PLANE: [&str; 2] = ["left", "right"];
const STRIP: [&str; 2] = ["from", "to"];

impl WallEntry {
    /// Left and right point in m, seen from the open side, or from the left of the way from one end to the other. Points that are missing
    /// are reported by the check.
    pub fn line(&self) -> [DVec2; 2] {
        let points = if self.is_strip() { [self.to, self.from] } else { [self.left, self.right] };
        points.map(|point| point.map(|point| point.si()).unwrap_or_default())
    }

    /// The thickness in m of a strip; `None`: a half-plane.
    pub fn thickness(&self) -> Option<f64> {
        self.is_strip().then(|| self.thickness.map_or(0.0, |thickness| thickness.si()))
    }

    fn is_strip(&self) -> bool {
        self.from.is_some() || self.to.is_some()
    }

    /// The velocity of its surface in m/s, without what rounding leaves across the wall.
    pub fn belt(&self) -> DVec2 {
        let [left, right] = self.line();
        let along = (right - left).normalize_or_zero();
        along * self.surface_velocity.si().dot(along)
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        let fields = if self.is_strip() { STRIP } else { HALF_PLANE };
        let given = if self.is_strip() { [self.from, self.to] } else { [self.left, self.right] };
        let mut complete = true;
        for (field, point) in fields.into_iter().zip(given) {
            if point.is_none() {
                complete = false;
                let help = "a half-plane has `left` and `right`, seen from its open side; a strip has `from` and `to`, and perhaps `thickness`";
                report.missing(field, help);
            }
        }
        if self.is_strip() {
            for (field, point) in HALF_PLANE.into_iter().zip([self.left, self.right]) {
                if point.is_some() {
                    let message = format!("a wall with `from` and `to` is a strip: it has no `{field}`");
                    report.error(field, message).help("leave it out, or write two walls");
                }
            }
        } else if self.thickness.is_some() {
            report
                .error("thickness", "a half-plane has no thickness")
                .help("a strip has `from` and `to` in place of `left` and `right`");
        }
        if let Some(thickness) = self.thickness {
            report.not_negative("thickness", thickness.si());
        }
        let [left, right] = self.line();
        let [first, last] = if self.is_strip() { [right, left] } else { [left, right] };
        let finite = report.finite_pair(fields[0], first) & report.finite_pair(fields[1], last);
        let length = (right - left).length();
        if complete && finite && !(length > 0.0 && length.is_finite()) {
            let message = format!("must differ from `{}`, got ({}, {}) for both", fields[0], last.x, last.y);
            report.error(fields[1], message).help("a wall is the line through two points");
        }
        let velocity = self.surface_velocity.si();
        if report.finite_pair("surface_velocity", velocity) && complete && finite && length > 0.0 {
            self.check_belt(velocity, report);
        }
        material::require(self.material.as_deref(), outline, report);
    }

    fn check_belt(&self, velocity: DVec2, report: &mut Report) {
        if self.is_strip() && velocity != DVec2::ZERO {
            let message = "surfaces of strips do not move yet";
            report.error("surface_velocity", message).help("a half-plane with `left` and `right` can be a belt");
            return;
        }
        let tangential = self.belt();
        if (velocity - tangential).length() > ALONG * velocity.length() {
            let message = "a surface moves along its wall, not into or out of it";
            let digits = |value: f64| (value * 1e6).round() / 1e6;
            let (x, y) = (digits(tangential.x), digits(tangential.y));
            let help = format!("along this wall it would be ({x:?}, {y:?})");
            report.error("surface_velocity", message).help(help);
        }
    }
}
