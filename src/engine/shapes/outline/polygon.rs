//! `Polygon(points, rounding)`: a polygon. The engine cuts a concave one into convex parts.

use glam::DVec2;
use jostle_shapes as shapes;
use jostle_shapes::{MOST_CORNERS, ShapeError};

use super::{Sided, sided};
use crate::scene::units::{Length, LengthPair};

sided! {
    /// A polygon, convex or concave.
    PolygonShape, "Polygon" {
        /// Its corners in m, in order around it. From 3 to 1000.
        points: Vec<LengthPair>,
        /// The radius of its corners in m. Corners that bend inwards stay sharp. Default: 0.
        #[serde(default)]
        rounding: Length,
    }
}

impl Sided for PolygonShape {
    fn made(&self) -> Result<shapes::Shape, ShapeError> {
        if self.points.len() > MOST_CORNERS {
            let (quantity, found) = ("the number of corners", self.points.len());
            return Err(ShapeError::TooMany { quantity, found, most: MOST_CORNERS });
        }
        let points: Vec<DVec2> = self.points.iter().map(|point| point.si()).collect();
        shapes::polygon(&points, self.rounding.si())
    }

    fn example(&self) -> &'static str {
        "Polygon(points: [(0, 0), (1, 0), (0, 1)])"
    }
}
