//! Shapes, and their common form: a list of discs, the atoms.
//!
//! A shape is one file with its fields, its check and `specs`, and one line in [`AtomShape`].

pub mod disc;
mod lately;
pub mod list;
pub mod mass_properties;
pub mod outline;
pub mod picture;
pub mod png;
pub(crate) mod silhouette;
pub(crate) mod svg;
mod union;

use glam::DVec2;
use mass_properties::InertiaRule;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::Diagnostics;

/// One atom as a shape gives it, in the shape's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtomSpec {
    /// The centre, in m from the shape's origin.
    pub offset: DVec2,
    /// The radius, in m.
    pub radius: f64,
    /// The mass in kg; `None`: the material's density times the disc's area.
    pub mass: Option<f64>,
    /// The stiffness in N/m; `None`: the material's.
    pub stiffness: Option<f64>,
}

impl AtomSpec {
    /// The same atom with a mass: its own, or density (kg/m2) times area.
    #[must_use]
    pub fn with_density(self, density: f64) -> Self {
        let area = std::f64::consts::PI * self.radius * self.radius;
        Self { mass: Some(self.mass.unwrap_or(density * area)), ..self }
    }
}

macro_rules! shapes {
    ($($(#[$about:meta])* $name:ident($fields:ty),)*) => {
        /// The discs a body is made of: one of the shapes.
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        #[schemars(rename = "Atoms")]
        pub enum AtomShape {
            $($(#[$about])* $name($fields),)*
        }

        impl AtomShape {
            /// Reports what its type cannot exclude; paths are relative to the shape.
            pub fn check(&self, report: &mut Diagnostics) {
                match self {
                    $(Self::$name(shape) => shape.check(report),)*
                }
            }

            /// Its atoms, in canonical order.
            pub fn specs(&self) -> Vec<AtomSpec> {
                match self {
                    $(Self::$name(shape) => shape.specs(),)*
                }
            }
        }
    };
}

impl AtomShape {
    /// The default rule for mass and inertia: the covered area for shapes whose discs overlap by design.
    pub fn own_rule(&self) -> InertiaRule {
        if matches!(self, Self::Png(_)) { InertiaRule::Union } else { InertiaRule::default() }
    }
}

// The list of shapes: one line each.
shapes! {
    /// `Picture(spacing: 0.1, mass: 0.01, rows: ["##", "#."])`: equal discs on a square grid.
    Picture(picture::Picture),
    /// `List([(at: (0, 0), radius: 0.1, mass: 0.02)])`: discs one by one.
    List(list::DiscList),
    /// `Disc(radius: 0.2)`: one disc.
    Disc(disc::OneDisc),
    /// `Png(file: "example:cow.png", height: 1.5, count: 60)`: discs that cover a silhouette.
    Png(png::Png),
}
