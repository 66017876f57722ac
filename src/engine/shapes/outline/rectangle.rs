//! `Rectangle(width, height, rounding)`: a rectangle about its origin.

use jostle_shapes as shapes;
use jostle_shapes::ShapeError;

use super::{Sided, sided};
use crate::scene::units::Length;

sided! {
    /// A rectangle about its origin.
    RectangleShape, "Rectangle" {
        /// The width in m. Above zero.
        width: Length,
        /// The height in m. Above zero.
        height: Length,
        /// The radius of its corners in m. Default: 0.
        #[serde(default)]
        rounding: Length,
    }
}

impl Sided for RectangleShape {
    fn made(&self) -> Result<shapes::Shape, ShapeError> {
        shapes::rectangle(self.width.si(), self.height.si(), self.rounding.si())
    }

    fn example(&self) -> &'static str {
        "Rectangle(width: 0.4, height: 0.2, rounding: 0.005)"
    }
}
