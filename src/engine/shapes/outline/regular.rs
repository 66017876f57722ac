//! `Regular(sides, radius, rounding)`: a regular polygon about its origin.

use jostle_shapes as shapes;
use jostle_shapes::ShapeError;

use super::{Sided, sided};
use crate::scene::units::Length;

sided! {
    /// A regular polygon about its origin, with a corner at +x.
    RegularShape, "Regular" {
        /// The number of its sides. From 3 to 10 000.
        sides: usize,
        /// The radius in m of the circle through its sharp corners. Above zero.
        radius: Length,
        /// The radius of its corners in m. Default: 0.
        #[serde(default)]
        rounding: Length,
    }
}

impl Sided for RegularShape {
    fn made(&self) -> Result<shapes::Shape, ShapeError> {
        shapes::regular(self.sides, self.radius.si(), self.rounding.si())
    }

    fn example(&self) -> &'static str {
        "Regular(sides: 6, radius: 0.1)"
    }
}
