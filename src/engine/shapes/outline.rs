//! `shape: Rectangle(..)`: shapes with sides, each the convex hull of its corners grown by a radius.
//!
//! A shape is one line in the list below with its fields; [`jostle_shapes`] makes hulls of them.

use glam::DVec2;
use jostle_shapes as shapes;
use jostle_shapes::{Hull, ShapeError};
use schemars::JsonSchema;
use serde::Deserialize;

use super::AtomSpec;
use crate::scene::Report;
use crate::scene::units::{Length, Position};

/// A shape with sides, or a disc. Measures are those of the outside; `rounding` goes inwards and makes corners round.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// `Disc(radius: 0.2)`: a disc about the origin.
    Disc {
        /// The radius in m. Above zero.
        radius: Length,
    },
    /// `Capsule(from: (-0.5, 0), to: (0.5, 0), radius: 0.02)`: a bar with round ends.
    Capsule {
        /// Where its middle line begins, in m.
        from: Position,
        /// Where its middle line ends, in m.
        to: Position,
        /// Half its thickness in m. Above zero.
        radius: Length,
    },
    /// `Rectangle(width: 0.4, height: 0.2, rounding: 0.005)`: a rectangle about the origin.
    Rectangle {
        /// The width in m. Above zero.
        width: Length,
        /// The height in m. Above zero.
        height: Length,
        /// The radius of its corners in m. Default: 0.
        #[serde(default)]
        rounding: Length,
    },
    /// `Regular(sides: 6, radius: 0.1)`: a regular polygon about the origin, with a corner at +x.
    Regular {
        /// How many sides it has. Three or more.
        sides: usize,
        /// The radius in m of the circle through its corners, before they are rounded. Above zero.
        radius: Length,
        /// The radius of its corners in m. Default: 0.
        #[serde(default)]
        rounding: Length,
    },
    /// `Polygon(points: [(0, 0), (1, 0), (0, 1)])`: a convex polygon.
    Polygon {
        /// Its corners in m, in order.
        points: Vec<Position>,
        /// The radius of its corners in m. Default: 0.
        #[serde(default)]
        rounding: Length,
    },
}

/// What a shape is made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    /// Convex hulls of two and more corners.
    pub hulls: Vec<Hull>,
    /// Discs.
    pub discs: Vec<AtomSpec>,
    /// What was mended in the numbers of the scene.
    pub mended: Vec<String>,
}

impl Shape {
    /// # Errors
    /// Numbers of which no shape can be made.
    fn made(&self) -> Result<shapes::Shape, ShapeError> {
        match self {
            Self::Disc { radius } => shapes::disc(DVec2::ZERO, radius.si()),
            Self::Capsule { from, to, radius } => shapes::capsule(from.si(), to.si(), radius.si()),
            Self::Rectangle { width, height, rounding } => shapes::rectangle(width.si(), height.si(), rounding.si()),
            Self::Regular { sides, radius, rounding } => shapes::regular(*sides, radius.si(), rounding.si()),
            Self::Polygon { points, rounding } => {
                let points: Vec<DVec2> = points.iter().map(|point| point.si()).collect();
                shapes::polygon(&points, rounding.si())
            }
        }
    }

    /// Reports numbers of which no shape can be made.
    pub fn check(&self, report: &mut Report) {
        match self.made() {
            Err(error) => {
                report.error("", error.to_string()).help(remedy(error));
            }
            Ok(made) if made.hulls.len() > 1 => {
                let message = "the polygon is concave, which is not available yet";
                report.error("", message).help("make convex bodies of its parts, and join them by `Weld`");
            }
            Ok(_) => {}
        }
    }

    /// What it is made of; nothing if it cannot be made.
    pub fn parts(&self) -> Parts {
        let mut parts = Parts::default();
        let Ok(made) = self.made() else { return parts };
        for hull in made.hulls {
            match *hull.corners() {
                [center] => {
                    parts.discs.push(AtomSpec { offset: center, radius: hull.radius(), mass: None, stiffness: None })
                }
                _ => parts.hulls.push(hull),
            }
        }
        parts.mended = made.mended.iter().map(ToString::to_string).collect();
        parts
    }
}

fn remedy(error: ShapeError) -> &'static str {
    match error {
        ShapeError::EqualPoints { .. } => "give each corner once, and a capsule two different ends",
        ShapeError::TooFewPoints { .. } | ShapeError::ZeroArea => {
            "a polygon is a list of corners in order: Polygon(points: [(0, 0), (1, 0), (0, 1)])"
        }
        ShapeError::SelfCrossing { .. } => "give the corners in order, around the outline",
        ShapeError::RoundingTooLarge { .. } => "make `rounding` smaller, or the shape larger",
        _ => "for example: Rectangle(width: 0.4, height: 0.2, rounding: 0.005)",
    }
}
