//! `Disc(radius)`: a disc about its origin.

use glam::DVec2;
use jostle_shapes as shapes;
use jostle_shapes::ShapeError;

use super::{Sided, sided};
use crate::scene::units::Length;

sided! {
    /// A disc about its origin.
    DiscShape, "DiscShape" {
        /// The radius in m. Above zero.
        radius: Length,
    }
}

impl Sided for DiscShape {
    fn made(&self) -> Result<shapes::Shape, ShapeError> {
        shapes::disc(DVec2::ZERO, self.radius.si())
    }

    fn example(&self) -> &'static str {
        "Disc(radius: 0.1)"
    }
}
