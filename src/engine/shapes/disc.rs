//! `Disc(radius, mass)`: one disc at the origin.

use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::AtomSpec;
use crate::scene::Diagnostics;
use crate::scene::units::{Length, Mass, Stiffness};

/// One disc.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Disc")]
pub struct OneDisc {
    /// The radius in m. Above zero.
    pub radius: Length,
    /// The mass in kg. Above zero. Default: the material's density times the area.
    #[serde(default)]
    pub mass: Option<Mass>,
    /// The stiffness in N/m. Above zero. Default: the material's.
    #[serde(default)]
    pub stiffness: Option<Stiffness>,
}

impl OneDisc {
    /// Reports numbers that are not above zero.
    pub fn check(&self, report: &mut Diagnostics) {
        report.positive("radius", self.radius);
        report.positive_if_given("mass", self.mass);
        report.positive_if_given("stiffness", self.stiffness);
    }

    /// The one atom.
    pub fn specs(&self) -> Vec<AtomSpec> {
        vec![AtomSpec {
            offset: DVec2::ZERO,
            radius: self.radius.si(),
            mass: self.mass.map(f64::from),
            stiffness: self.stiffness.map(f64::from),
        }]
    }
}
