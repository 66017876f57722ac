//! `Rack(teeth, module)`: a bar with the teeth on which a gear of the same module rolls.

use jostle_shapes as shapes;
use jostle_shapes::ShapeError;

use super::{Sided, sided};
use crate::scene::units::{Angle, Length};

sided! {
    /// A bar with teeth above; its pitch line lies along x through its origin, the middle of its length.
    RackShape, "RackShape" {
        /// The number of its teeth. From 1 to 1000.
        teeth: usize,
        /// Distance of the teeth over pi, in m. Above zero.
        module: Length,
        /// Angle in rad between the flanks and the normal of the pitch line. Default: 20 degrees.
        #[serde(default)]
        pressure_angle: Option<Angle>,
        /// Play in m between the rack and its gear. The rack gives half of it. Default: 0.
        #[serde(default)]
        backlash: Length,
        /// Thickness in m of the bar below the roots. Default: two modules.
        #[serde(default)]
        back: Option<Length>,
    }
}

impl Sided for RackShape {
    fn made(&self) -> Result<shapes::Shape, ShapeError> {
        let usual = shapes::Rack::new(self.teeth, self.module.si());
        let rack = shapes::Rack {
            pressure_angle: self.pressure_angle.map_or(usual.pressure_angle, f64::from),
            backlash: self.backlash.si(),
            back: self.back.map_or(usual.back, f64::from),
            ..usual
        };
        rack.shape()
    }

    fn example(&self) -> &'static str {
        "Rack(teeth: 12, module: \"5 mm\")"
    }
}
