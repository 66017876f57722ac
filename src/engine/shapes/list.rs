//! `List([..])`: discs one by one.

use schemars::JsonSchema;
use serde::Deserialize;

use super::AtomSpec;
use crate::scene::Diagnostics;
use crate::scene::units::{Length, LengthPair, Mass, Stiffness};

/// One disc of a list.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "ListedDisc")]
pub struct ListedDisc {
    /// The centre in m, in the body's own frame.
    pub at: LengthPair,
    /// The radius in m. Above zero.
    pub radius: Length,
    /// The mass in kg. Above zero. Default: the material's density times the area.
    #[serde(default)]
    pub mass: Option<Mass>,
    /// The stiffness in N/m. Above zero. Default: the material's.
    #[serde(default)]
    pub stiffness: Option<Stiffness>,
}

/// Discs one by one, at least one.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
pub struct DiscList(pub Vec<ListedDisc>);

impl DiscList {
    /// Reports an empty list and numbers that are not above zero.
    pub fn check(&self, report: &mut Diagnostics) {
        if self.0.is_empty() {
            report.error("", "a body needs at least one atom").help("for example: List([(at: (0, 0), radius: 0.1)])");
        }
        for (index, disc) in self.0.iter().enumerate() {
            report.within(&format!("[{index}]"), |report| {
                report.finite_pair("at", disc.at.si());
                report.positive("radius", disc.radius);
                report.positive_if_given("mass", disc.mass);
                report.positive_if_given("stiffness", disc.stiffness);
            });
        }
    }

    /// Its atoms in the order of the list.
    pub fn specs(&self) -> Vec<AtomSpec> {
        let atom = |disc: &ListedDisc| AtomSpec {
            offset: disc.at.si(),
            radius: disc.radius.si(),
            mass: disc.mass.map(f64::from),
            stiffness: disc.stiffness.map(f64::from),
        };
        self.0.iter().map(atom).collect()
    }
}
