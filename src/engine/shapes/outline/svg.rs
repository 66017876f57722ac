//! `Svg(file, height | unit, tolerance, rounding)`: the outlines of a drawing.
//!
//! The file is read before the sections of a scene are: here the outlines are known already. How they are found stands in `shapes/svg`.

use glam::DVec2;
use jostle_shapes as shapes;
use jostle_shapes::ShapeError;

use super::{Sided, sided};
use crate::scene::units::Length;

sided! {
    /// The outlines of the paths, polygons, rectangles and ellipses of an SVG file. Its origin is the middle of the lower side of the box around them.
    SvgShape, "Svg" {
        /// The drawing: a path from the folder of the file in which this stands.
        file: String,
        /// The id of the one element that counts, a group or an outline. Default: all of them.
        #[serde(default)]
        id: Option<String>,
        /// How high the drawing becomes, in m. Above zero. Either this or `unit`. Default: `unit` says it.
        #[serde(default)]
        height: Option<Length>,
        /// The length of one unit of the drawing, in m. Above zero. Either this or `height`. Default: `height` says it.
        #[serde(default)]
        unit: Option<Length>,
        /// How far chords lie from the curves that they stand for at most, in m. Above zero. Points that are nearer than a hundredth of it are
        /// one. Default: a thousandth of the height.
        #[serde(default)]
        tolerance: Option<Length>,
        /// The radius of its corners in m; those that bend inwards stay sharp. Default: 0.
        #[serde(default)]
        rounding: Length,
        /// What the drawing became: corners of each outline, in m. Not written by hand.
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
