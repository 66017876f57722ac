//! `Gear(teeth, module)`: a spur gear with involute teeth (ISO 53, ISO 21771).

use jostle_shapes as shapes;
use jostle_shapes::ShapeError;

use super::{Sided, sided};
use crate::scene::units::{Angle, Length};

sided! {
    /// A spur gear about its origin; one tooth points along +x. Its pitch diameter is teeth times module.
    GearShape, "Gear" {
        /// The number of its teeth. From 3 to 1000.
        teeth: usize,
        /// Pitch diameter over number of teeth, in m. Above zero.
        module: Length,
        /// Angle in rad between the line of action and the common tangent of the pitch circles. Default: 20 degrees.
        #[serde(default)]
        pressure_angle: Option<Angle>,
        /// Play in m between two such gears along the pitch circle. Each gives half of it. Default: 0.
        #[serde(default)]
        backlash: Length,
        /// The number of chords for the involute of each flank. From 1 to 64. Default: 8.
        #[serde(default)]
        chords: Option<usize>,
    }
}

impl Sided for GearShape {
    fn made(&self) -> Result<shapes::Shape, ShapeError> {
        let usual = shapes::Gear::new(self.teeth, self.module.si());
        let gear = shapes::Gear {
            pressure_angle: self.pressure_angle.map_or(usual.pressure_angle, f64::from),
            backlash: self.backlash.si(),
            chords: self.chords.unwrap_or(usual.chords),
            ..usual
        };
        gear.shape()
    }

    fn example(&self) -> &'static str {
        "Gear(teeth: 24, module: \"5 mm\")"
    }
}
