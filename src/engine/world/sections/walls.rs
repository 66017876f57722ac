//! `walls`: impenetrable half-planes, strips and lines.

use std::borrow::Cow;

use bevy_app::App;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;

use crate::scene::units::{Length, LengthPair, SpeedPair};
use crate::scene::{Diagnostics, NameKind, Obstacle, Outline, Section, exact};
use crate::world::{material, sections};

/// One wall: the half-plane behind the line through two points. With `from` and `to` it is a strip with two round ends.
/// With `line` or `heights` it is a surface of many pieces.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Wall")]
pub struct WallEntry {
    /// The name, for sensors and messages.
    pub name: String,
    /// The point of a half-plane to the left, seen from the open side, in m. Default: none, for a strip.
    #[serde(default)]
    pub left: Option<LengthPair>,
    /// The point of a half-plane to the right, seen from the open side, in m. Default: none, for a strip.
    #[serde(default)]
    pub right: Option<LengthPair>,
    /// The beginning of the middle line of a strip, in m. Bodies hit a strip from both sides. Default: none, for a
    /// half-plane.
    #[serde(default)]
    pub from: Option<LengthPair>,
    /// The end of the middle line of a strip, in m. Default: none, for a half-plane.
    #[serde(default)]
    pub to: Option<LengthPair>,
    /// The thickness of a strip, in m. Its ends are round. Default: 0.
    #[serde(default)]
    pub thickness: Option<Length>,
    /// The sides of a strip that bodies hit, seen on the way from `from` to `to`. They are `Left`, `Right` or `Both`.
    /// Default: `Both`.
    #[serde(default)]
    pub sides: Option<Sides>,
    /// The points of a line, in m. It is one surface, open to the left of the way from the first point to the last. It
    /// is closed if both are the same. Default: none.
    #[serde(default)]
    pub line: Option<Vec<LengthPair>>,
    /// The points of a line that is open upwards, in m, from left to right. They are a list, or a file, `(file:
    /// "ground.csv")`. They may also be a function of `x`, `(of: "0.1 * sin(3 * x)", from: -10, to: 10, pieces: 200)`.
    /// Default: none.
    #[serde(default)]
    #[schemars(with = "Option<Heights>")]
    pub heights: Option<Vec<LengthPair>>,
    /// The name of its material. Default: `default`.
    #[serde(default)]
    pub material: Option<String>,
    /// The velocity of the surface of a half-plane along the wall, in m/s. Such a wall is a belt. Default: (0, 0).
    #[serde(default)]
    pub surface_velocity: SpeedPair,
}

/// The content of `heights`, for the schema. Scenes are read with the points of the file or function in its place.
struct Heights;

impl JsonSchema for Heights {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "heights".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let text = |about: &str| json_schema!({ "type": "string", "description": about });
        let length = generator.subschema_for::<Length>();
        json_schema!({
            "anyOf": [generator.subschema_for::<Vec<LengthPair>>(), {
                "type": "object",
                "properties": {
                    "file": text("The file."),
                    "x": text("The name of the column of places. Default: the first column."),
                    "column": text("The name of the column of heights. Default: the second column of two."),
                },
                "required": ["file"],
                "additionalProperties": false,
            }, {
                "type": "object",
                "properties": {
                    "of": text("The height as a function of `x`, in m."),
                    "from": length,
                    "to": length,
                    "pieces": { "type": ["number", "string"], "description": "The number of its pieces." },
                },
                "required": ["of", "from", "to", "pieces"],
                "additionalProperties": false,
            }],
            "x-value": "list of `(x, y)`, or `file: .., x: .., column: ..`, or `of: .., from: .., to: .., pieces: ..`",
        })
    }
}

/// The sides from which a strip is hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum Sides {
    /// From the left of the way from its first point to the last.
    Left,
    /// From the right of it.
    Right,
    /// From both sides.
    Both,
}

/// The allowed component of a surface velocity out of its wall, as a share of the velocity. It allows for omitted
/// digits.
const ALONG: f64 = 1e-6;

/// Impenetrable half-planes, strips with two ends, and lines of many pieces. Half-planes are floors, slopes and belts.
/// Strips are shelves and funnels. Lines are the ground of a landscape.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub struct WallsSection(pub Vec<WallEntry>);

impl Section for WallsSection {
    const NAME: &'static str = "walls";
    const EXAMPLE: &'static str = "walls: [(name: \"floor\", left: (6, 0), right: (0, 0), material: \"rock\")]";

    /// Declares the walls' names.
    fn declare(&self, outline: &mut Outline) {
        for (index, wall) in self.0.iter().enumerate() {
            outline.declare(NameKind::WALL, &wall.name, &format!("[{index}].name"));
            let [left, right] = wall.ends();
            let points = wall.points();
            match wall.thickness() {
                None if points.is_none() => outline.occupy(Obstacle::Wall { left, right }),
                thickness => {
                    let radius = 0.5 * thickness.unwrap_or(0.0);
                    let points = points.unwrap_or_else(|| vec![right, left]);
                    points.windows(2).for_each(|two| {
                        outline.occupy(Obstacle::Strip { from: two[0], to: two[1], radius });
                    });
                }
            }
        }
    }

    /// Reports two points in one place and unknown materials.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        for (index, wall) in self.0.iter().enumerate() {
            report.within(&format!("[{index}]"), |report| wall.check(outline, report));
        }
    }

    fn install(self, _: &Outline, app: &mut App) {
        sections::spawn_walls(self, app.world_mut());
    }
}

/// Fields of a half-plane, and of a strip.
/// The remedy for two points whose distance has no finite square.
const TOO_LONG: &str = "walls are shorter than 1e150 m";

const HALF_PLANE: [&str; 2] = ["left", "right"];
const STRIP: [&str; 2] = ["from", "to"];

/// Whether the way through three points turns back at the second: the turn is half a turn, up to rounding.
fn turns_back(first: DVec2, second: DVec2, third: DVec2) -> bool {
    let (before, behind) = ((second - first).normalize_or_zero(), (third - second).normalize_or_zero());
    1.0 + before.dot(behind) < 1e-12
}

impl WallEntry {
    /// Left and right point in m, seen from the open side. For a strip the view is from the left of its way. The check
    /// reports absent points.
    pub fn ends(&self) -> [DVec2; 2] {
        let points = if self.is_strip() { [self.to, self.from] } else { [self.left, self.right] };
        points.map(|point| point.map(|point| point.si()).unwrap_or_default())
    }

    /// The thickness in m of a strip; `None`: a half-plane.
    pub fn thickness(&self) -> Option<f64> {
        self.is_strip().then(|| self.thickness.map_or(0.0, |thickness| thickness.si()))
    }

    /// The points in m of a surface that is open to the left of the way along them. They belong to a line, or to a
    /// strip that is hit from one side.
    pub fn points(&self) -> Option<Vec<DVec2>> {
        if let Some((_, points)) = self.surface() {
            return Some(points.iter().map(|point| point.si()).collect());
        }
        let [left, right] = self.ends();
        match self.sides {
            Some(Sides::Left) => Some(vec![right, left]),
            Some(Sides::Right) => Some(vec![left, right]),
            Some(Sides::Both) | None => None,
        }
    }

    /// The field that holds the points of a line, and its points.
    fn surface(&self) -> Option<(&'static str, &[LengthPair])> {
        let line = self.line.as_deref().map(|points| ("line", points));
        line.or_else(|| self.heights.as_deref().map(|points| ("heights", points)))
    }

    fn is_strip(&self) -> bool {
        self.from.is_some() || self.to.is_some()
    }

    /// The velocity of its surface in m/s, without what rounding leaves across the wall.
    pub fn belt(&self) -> DVec2 {
        let [left, right] = self.ends();
        let along = (right - left).normalize_or_zero();
        along * self.surface_velocity.si().dot(along)
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        match self.surface() {
            Some((field, points)) => self.check_points(field, points, report),
            None => self.check_ends(report),
        }
        material::require(self.material.as_deref(), outline, report);
    }

    /// Reports fields that a line does not have, points that are no line, and heights that do not ascend.
    fn check_points(&self, field: &'static str, points: &[LengthPair], report: &mut Diagnostics) {
        let others = [
            ("heights", self.heights.is_some()),
            ("left", self.left.is_some()),
            ("right", self.right.is_some()),
            ("from", self.from.is_some()),
            ("to", self.to.is_some()),
            ("thickness", self.thickness.is_some()),
            ("sides", self.sides.is_some()),
            ("surface_velocity", self.surface_velocity.si() != DVec2::ZERO),
        ];
        for (other, _) in others.iter().filter(|(other, given)| *given && *other != field) {
            let message = format!("a wall with `{field}` is a line: it has no `{other}`");
            report.error(other, message).help("leave it out, or write two walls");
        }
        if points.len() < 2 {
            let message = format!("a line has at least two points, got {}", points.len());
            report.error(field, message).help(format!("for example `{field}: [(0, 0), (1, 0.1), (2, 0)]`"));
        }
        let points: Vec<DVec2> = points.iter().map(|point| point.si()).collect();
        let mut finite = true;
        for (index, point) in points.iter().enumerate() {
            finite &= report.finite_pair(&format!("{field}[{index}]"), *point);
        }
        for (index, two) in points.windows(2).enumerate().filter(|_| finite) {
            let place = format!("{field}[{}]", index + 1);
            let (before, x, y) = (two[0], two[1].x, two[1].y);
            let length = before.distance(two[1]);
            if field == "heights" && x <= before.x {
                let message = format!(
                    "must lie to the right of the point before it, at x = {}, got x = {}",
                    exact(before.x),
                    exact(x)
                );
                report.error(&place, message).help("heights ascend in x; a line that turns back stands in `line`");
            } else if length == 0.0 {
                let message =
                    format!("must differ from the point before it, got ({}, {}) for both", exact(x), exact(y));
                report.error(&place, message).help("leave one of both out");
            } else if !length.is_finite() {
                let message =
                    format!("is too far from the point before it at ({}, {})", exact(before.x), exact(before.y));
                report.error(&place, message).help(TOO_LONG);
            } else if index > 0 && turns_back(points[index - 1], before, two[1]) {
                let message = "the line turns back onto itself here";
                report.error(&place, message).help("between two pieces some room is left, however narrow");
            } else {
                continue;
            }
            break;
        }
    }

    fn check_ends(&self, report: &mut Diagnostics) {
        let fields = if self.is_strip() { STRIP } else { HALF_PLANE };
        let given = if self.is_strip() { [self.from, self.to] } else { [self.left, self.right] };
        let mut complete = true;
        for (field, point) in fields.into_iter().zip(given) {
            if point.is_none() {
                complete = false;
                let help = "a half-plane has `left` and `right`, seen from its open side. A strip has `from` and `to`, and perhaps `thickness`. A line has `line` or `heights`";
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
        if !self.is_strip() && self.sides.is_some() {
            report
                .error("sides", "a half-plane is open on one side")
                .help("a strip has `from` and `to` in place of `left` and `right`");
        }
        if let Some(thickness) = self.thickness {
            report.not_negative("thickness", thickness.si());
        }
        let [left, right] = self.ends();
        let [first, last] = if self.is_strip() { [right, left] } else { [left, right] };
        let finite = report.finite_pair(fields[0], first) & report.finite_pair(fields[1], last);
        let length = (right - left).length();
        if complete && finite && length == 0.0 {
            let message =
                format!("must differ from `{}`, got ({}, {}) for both", fields[0], exact(last.x), exact(last.y));
            report.error(fields[1], message).help("a wall is the line through two points");
        } else if complete && finite && !length.is_finite() {
            let message = format!("is too far from `{}` at ({}, {})", fields[0], exact(first.x), exact(first.y));
            report.error(fields[1], message).help(TOO_LONG);
        }
        let velocity = self.surface_velocity.si();
        if report.finite_pair("surface_velocity", velocity) && complete && finite && length > 0.0 {
            self.check_belt(velocity, report);
        }
    }

    fn check_belt(&self, velocity: DVec2, report: &mut Diagnostics) {
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
