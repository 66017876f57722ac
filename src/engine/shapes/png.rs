//! `Png(file, height, count | radius)`: a silhouette from a picture file, covered by discs.
//!
//! The file is read before the sections of a scene are: here the discs are known already. How they are chosen stands in
//! `silhouette`.

use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::AtomSpec;
use crate::scene::Report;
use crate::scene::units::{Length, Stiffness};
use crate::scene::values::WholeNumber;

/// The largest number of atoms of one silhouette: two bodies of more would take seconds where they touch.
pub const MOST_ATOMS: u64 = 5000;

/// A silhouette covered by discs.
///
/// What is opaque is the silhouette; in a picture without transparency, what is dark. The origin is the middle of its
/// lowest edge. Discs overlap, so mass and inertia are by default those of the area they cover together.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Png")]
pub struct Png {
    /// The picture: a path from the folder of the file in which this stands, or `example:cow.png` for one that comes
    /// with the program.
    pub file: String,
    /// How high the silhouette is, in m; margins of the picture do not count. Above zero.
    pub height: Length,
    /// At most so many discs of different sizes, from 1 to 5000. Either this or `radius`. Default: `radius` says it.
    #[serde(default)]
    pub count: Option<WholeNumber>,
    /// Discs of this radius in m, side by side. Above zero. Either this or `count`. Default: `count` says it.
    #[serde(default)]
    pub radius: Option<Length>,
    /// The stiffness of each disc in N/m. Above zero. Default: the material's.
    #[serde(default)]
    pub stiffness: Option<Stiffness>,
    /// What the picture became: centre and radius of each disc, in m. Not written by hand.
    #[serde(default)]
    #[schemars(skip)]
    pub discs: Vec<(f64, f64, f64)>,
}

impl Png {
    /// One correct use.
    pub const EXAMPLE: &'static str = "atoms: Png(file: \"example:cow.png\", height: 1.5, count: 60)";

    /// Reports numbers that are not above zero, and a picture that nobody has read.
    pub fn check(&self, report: &mut Report) {
        if self.numbers_are_good(report) && self.discs.is_empty() {
            let message = "the picture was not read";
            report.error("file", message).help("`Png` stands in `atoms` of a scene");
        }
    }

    /// Reports numbers that are not above zero. Returns whether all are.
    pub(crate) fn numbers_are_good(&self, report: &mut Report) -> bool {
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
                    "`count` and `radius` cannot both be given"
                } else {
                    "how fine the atoms are is missing"
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
