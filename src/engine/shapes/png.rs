//! `Png(file, height, count | radius)`: a silhouette from a picture file, covered by discs.
//!
//! The file is read before the sections of a scene, so the discs are known here. `silhouette` describes their choice.

use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::AtomSpec;
use crate::scene::Diagnostics;
use crate::scene::units::{Length, Stiffness};
use crate::scene::values::WholeNumber;

/// The largest number of atoms of one silhouette. Two larger bodies would take seconds on contact.
pub const MOST_ATOMS: u64 = 5000;

/// A silhouette covered by discs.
///
/// The silhouette is the opaque part, or the dark part of a picture without transparency. The origin is the middle of
/// its lowest edge. Discs overlap, so by default mass and inertia are those of the area that they cover together.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Png")]
pub struct Png {
    /// The picture: a path from the folder of the file with this entry. `example:cow.png` comes with the program.
    pub file: String,
    /// The height of the silhouette, in m. Margins of the picture do not count. Above zero.
    pub height: Length,
    /// At most this many discs of different sizes, from 1 to 5000. Write this or `radius`. Default: from `radius`.
    #[serde(default)]
    pub count: Option<WholeNumber>,
    /// Discs of this radius in m, side by side. Above zero. Write this or `count`. Default: from `count`.
    #[serde(default)]
    pub radius: Option<Length>,
    /// The stiffness of each disc in N/m. Above zero. Default: the material's.
    #[serde(default)]
    pub stiffness: Option<Stiffness>,
    /// The discs of the picture: centre and radius of each, in m. Not written by hand.
    #[serde(default)]
    #[schemars(skip)]
    pub discs: Vec<(f64, f64, f64)>,
}

impl Png {
    /// One correct use.
    pub const EXAMPLE: &'static str = "atoms: Png(file: \"example:cow.png\", height: 1.5, count: 60)";

    /// Reports numbers that are not above zero, and a picture that was not read.
    pub fn check(&self, report: &mut Diagnostics) {
        if self.numbers_are_good(report) && self.discs.is_empty() {
            let message = "the picture was not read";
            report.error("file", message).help("`Png` stands in `atoms` of a scene");
        }
    }

    /// Reports numbers that are not above zero. Returns whether all are.
    pub(crate) fn numbers_are_good(&self, report: &mut Diagnostics) -> bool {
        report.all_good(|report| {
            report.positive("height", self.height);
            report.positive_if_given("radius", self.radius);
            report.positive_if_given("stiffness", self.stiffness);
            if let Some(WholeNumber(count)) = self.count
                && !(1..=MOST_ATOMS).contains(&count)
            {
                report.error("count", format!("must be from 1 to {MOST_ATOMS}, got {count}"));
            }
            if self.count.is_some() == self.radius.is_some() {
                let message = if self.count.is_some() {
                    "`count` and `radius` exclude each other"
                } else {
                    "the field `count` or `radius` is missing"
                };
                let help = "`count: 60` covers the silhouette with discs of different sizes, `radius: \"2 cm\"` with equal ones";
                report.error("", message).help(help);
            }
        })
    }

    /// Its atoms.
    pub fn specs(&self) -> Vec<AtomSpec> {
        let atom = |&(x, y, radius): &(f64, f64, f64)| AtomSpec {
            offset: DVec2::new(x, y),
            radius,
            mass: None,
            stiffness: self.stiffness.map(f64::from),
        };
        self.discs.iter().map(atom).collect()
    }
}
