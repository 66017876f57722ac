//! `Svg(file, height | unit, tolerance, rounding)`: the outlines of a drawing.
//!
//! The file is read before the sections of a scene, so the outlines are known here. `shapes/svg` describes how they are
//! found.

use glam::DVec2;
use jostle_shapes as shapes;
use jostle_shapes::ShapeError;

use super::{Sided, sided};
use crate::scene::units::Length;

sided! {
    /// The outlines of the paths, polygons, rectangles and ellipses of an SVG file. Its origin is the middle of the lower side of the box around them.
    SvgShape, "Svg" {
        /// The drawing: a path from the folder of the file with this entry.
        file: String,
        /// The id of the one element that counts, a group or an outline. Default: all of them.
        #[serde(default)]
        id: Option<String>,
        /// The height of the drawing, in m. Above zero. Write this or `unit`. Default: from `unit`.
        #[serde(default)]
        height: Option<Length>,
        /// The length of one unit of the drawing, in m. Above zero. Write this or `height`. Default: from `height`.
        #[serde(default)]
        unit: Option<Length>,
        /// The greatest distance of chords from their curves, in m. Above zero. Points that are nearer than a hundredth
        /// of it count as one. Default: a thousandth of the height.
        #[serde(default)]
        tolerance: Option<Length>,
        /// The radius of its corners in m. Corners that bend inwards stay sharp. Default: 0.
        #[serde(default)]
        rounding: Length,
        /// The outlines of the drawing: the corners of each, in m. Not written by hand.
        #[serde(default)]
        #[schemars(skip)]
        outlines: Vec<Vec<(f64, f64)>>,
    }
}

impl SvgShape {
    /// One correct use.
    pub const EXAMPLE: &'static str = "Svg(file: \"part.svg\", height: 0.2)";
}

impl Sided for SvgShape {
    fn made(&self) -> Result<shapes::Shape, ShapeError> {
        let polygon = |outline: &Vec<(f64, f64)>| {
            let points: Vec<DVec2> = outline.iter().map(|(x, y)| DVec2::new(*x, *y)).collect();
            shapes::polygon(&points, self.rounding.si())
        };
        let polygons: Vec<shapes::Shape> = self.outlines.iter().map(polygon).collect::<Result<_, _>>()?;
        match polygons.as_slice() {
            [polygon] => Ok(polygon.clone()),
            polygons => shapes::compound(polygons),
        }
    }

    fn example(&self) -> &'static str {
        Self::EXAMPLE
    }
}
