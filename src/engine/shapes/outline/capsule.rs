//! `Capsule(from, to, radius)`: a bar with round ends.

use jostle_shapes as shapes;
use jostle_shapes::ShapeError;

use super::{Sided, sided};
use crate::scene::units::{Length, LengthPair};

sided! {
    /// A bar with round ends.
    CapsuleShape, "Capsule" {
        /// The beginning of its middle line, in m.
        from: LengthPair,
        /// The end of its middle line, in m.
        to: LengthPair,
        /// Half its thickness in m. Above zero.
        radius: Length,
    }
}

impl Sided for CapsuleShape {
    fn made(&self) -> Result<shapes::Shape, ShapeError> {
        shapes::capsule(self.from.si(), self.to.si(), self.radius.si())
    }

    fn example(&self) -> &'static str {
        "Capsule(from: (-0.5, 0), to: (0.5, 0), radius: 0.02)"
    }
}
