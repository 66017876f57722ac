//! `bodies`: all bodies that move or are fixed.

use bevy_app::App;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::units::{Angle, LengthPair, Mass, SpeedPair, Spin};
use crate::scene::{Diagnostics, NameKind, Obstacle, Outline, Section};
use crate::shapes::mass_properties::{self, MassProperties};
use crate::shapes::outline::OutlineShape;
use crate::shapes::{AtomShape, AtomSpec};
use crate::world::{IgnoredPairs, Kinematic, material, sections};

use crate::world::sections::{KinematicEntry, MOST_ATOMS, ignored};

pub use crate::shapes::mass_properties::{Datum, InertiaRule};

/// One body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Body")]
pub struct BodyEntry {
    /// The name. No other body, wall, joint or sensor has it.
    pub name: String,
    /// Its discs. Default: none, for a body with a `shape`.
    #[serde(default)]
    pub atoms: Option<AtomShape>,
    /// Its shape with sides, beside the discs if it has both. Default: none.
    #[serde(default)]
    pub shape: Option<OutlineShape>,
    /// Its centre of mass at the start, in m. With `datum: Origin` it is the origin of its atoms, and may be absent.
    /// Default: (0, 0).
    #[serde(default)]
    pub at: Option<LengthPair>,
    /// The turn of its atoms about that point, in rad, counter-clockwise. Default: 0.
    #[serde(default)]
    pub angle: Angle,
    /// The velocity of its centre of mass at the start, in m/s. Default: (0, 0).
    #[serde(default)]
    pub velocity: SpeedPair,
    /// The spin at the start, in rad/s, counter-clockwise. Default: 0.
    #[serde(default)]
    pub spin: Spin,
    /// The name of its material. Default: `default`.
    #[serde(default)]
    pub material: Option<String>,
    /// Whether it never moves. Default: `false`.
    #[serde(default)]
    pub fixed: bool,
    /// Its motion, if no force is to move it. Without it forces move the body. Default: none.
    #[serde(default)]
    pub kinematic: Option<KinematicEntry>,
    /// Whether it touches other bodies and walls. If not, it still feels forces. Default: `true`.
    #[serde(default = "yes")]
    pub collides: bool,
    /// The groups to which it belongs, with names of your choice. Default: none.
    #[serde(default)]
    pub groups: Vec<String>,
    /// The groups whose bodies it does not touch. Default: none.
    #[serde(default)]
    pub ignores: Vec<String>,
    /// The origin of the atoms' coordinates. Default: `CenterOfMass`.
    #[serde(default)]
    pub datum: Datum,
    /// The mass in kg, in place of that of the atoms. Above zero. Default: that of the atoms.
    #[serde(default)]
    pub mass: Option<Mass>,
    /// The moment of inertia about the centre of mass in kg m2, or the rule it follows from. Default: `Discs`, for `Png`
    /// `Union`.
    #[serde(default)]
    pub inertia: Option<InertiaRule>,
}

fn yes() -> bool {
    true
}

/// All bodies that move or are fixed.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub struct BodiesSection(pub Vec<BodyEntry>);

impl Section for BodiesSection {
    const NAME: &'static str = "bodies";
    const EXAMPLE: &'static str = "bodies: [(name: \"ball\", at: (2, 3), atoms: Disc(radius: 0.2))]";

    /// Declares the bodies' names.
    fn declare(&self, outline: &mut Outline) {
        let fit = self.fitting().len();
        for (index, body) in self.0.iter().enumerate() {
            outline.declare(NameKind::BODY, &body.name, &format!("[{index}].name"));
            if index < fit && body.touches() {
                body.occupy(outline);
            }
        }
        if fit < self.0.len() {
            let message =
                format!("bodies must have at most {MOST_ATOMS} atoms and corners in all: with this one they have more");
            outline.refuse(&format!("[{fit}]"), message).help("use fewer bodies, or simpler ones");
        }
    }

    /// Reports wrong atoms, masses and positions, and unknown materials.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        for (index, body) in self.fitting().iter().enumerate() {
            report.within(&format!("[{index}]"), |report| body.check(outline, report));
        }
        ignored::check(&self.0, report);
    }

    fn install(self, outline: &Outline, app: &mut App) {
        let apart = ignored::pairs(&self.0, outline);
        if !apart.is_empty() {
            app.world_mut().get_resource_or_init::<IgnoredPairs>().extend(apart);
        }
        sections::spawn_bodies(self, outline, app.world_mut());
    }
}

impl BodiesSection {
    /// The bodies before those that are too many.
    fn fitting(&self) -> &[BodyEntry] {
        let mut atoms = 0;
        let too_many = self.0.iter().position(|body| {
            atoms += sections::size(body.atoms.as_ref(), body.shape.as_ref());
            atoms > MOST_ATOMS
        });
        &self.0[..too_many.unwrap_or(self.0.len())]
    }
}

impl BodyEntry {
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        if let Some(atoms) = &self.atoms {
            report.within("atoms", |report| atoms.check(report));
        }
        if let Some(shape) = &self.shape {
            report.within("shape", |report| shape.check(report));
        }
        if self.atoms.is_none() && self.shape.is_none() {
            report.missing("atoms", "say what it is made of: write `atoms: Disc(radius: 0.1)`, or a `shape`");
        }
        match self.at {
            Some(at) => {
                report.finite_pair("at", at.si());
            }
            None if self.datum == Datum::Origin => {}
            None => report.missing("at", "say where the centre of mass is: write `at: (0, 1)`"),
        }
        report.finite("angle", self.angle);
        report.finite_pair("velocity", self.velocity.si());
        report.finite("spin", self.spin);
        if let Some(mass) = self.mass {
            report.positive("mass", mass);
        }
        if let Some(InertiaRule::Given(inertia)) = self.inertia {
            report.positive("inertia", inertia);
        }
        material::require(self.material.as_deref(), outline, report);
        let specs = self.specs();
        if report.is_clean() && (self.shape.is_some() || mass_properties::check_union(&specs, self.rule(), report)) {
            self.mass_properties(1.0).check(report);
        }
        if self.inertia == Some(InertiaRule::Points) && specs.len() == 1 && !self.fixed && self.kinematic.is_none() {
            let message = "one atom counted as a point has no moment of inertia";
            report.error("inertia", message).help("leave `inertia` out, or give a number in kg m2");
        }
        if self.shape.is_some() {
            if matches!(self.inertia, Some(InertiaRule::Discs | InertiaRule::Points)) {
                let message = "the moment of inertia of a shape follows from its area";
                report.error("inertia", message).help("leave `inertia` out, or give a number in kg m2");
            }
            if specs.iter().any(|atom| atom.mass.is_some()) {
                let message = "beside a `shape` discs have no masses of their own: all are of one area";
                report.error("atoms", message).help("remove the atoms' `mass`; the body's own `mass` may stay");
            }
        } else if self.inertia == Some(InertiaRule::Union) && specs.iter().any(|atom| atom.mass.is_some()) {
            let message = "with `Union` the mass follows from the covered area, but atoms have masses of their own";
            report.error("inertia", message).help("remove the atoms' `mass`; the body's own `mass` may stay");
        }
        if let Some(kinematic) = &self.kinematic {
            report.within("kinematic", |report| kinematic.check(report));
        }
        let held = match (&self.kinematic, self.fixed) {
            (Some(_), true) => {
                report.error("kinematic", "a fixed body does not move").help("remove this, or remove `fixed: true`");
                None
            }
            (Some(_), false) => {
                Some(("a kinematic body moves as `kinematic` says", "write it into `kinematic: (..)`, and remove this"))
            }
            (None, true) => Some(("a fixed body does not move", "remove this, or remove `fixed: true`")),
            (None, false) => None,
        };
        if let Some((message, help)) = held {
            for (path, moves) in [("velocity", self.velocity.si() != DVec2::ZERO), ("spin", self.spin.si() != 0.0)] {
                if moves {
                    report.error(path, message).help(help);
                }
            }
        }
    }

    /// Mass, centre of mass, inertia and atoms, given the density of its material in kg/m2.
    pub fn mass_properties(&self, density: f64) -> MassProperties {
        let mass = self.mass.map(f64::from);
        let Some(shape) = &self.shape else {
            return mass_properties::of(&self.specs(), mass, self.rule(), density);
        };
        let rule = self.inertia.unwrap_or(InertiaRule::Union);
        mass_properties::of_parts(&self.specs(), &shape.parts().parts, mass, rule, density)
    }

    /// Whether any of its parts touches others.
    pub fn touches(&self) -> bool {
        let parts = self.shape.as_ref().map_or_else(Vec::new, |shape| shape.parts().parts);
        self.collides && (self.atoms.is_some() || parts.iter().any(|part| part.collides))
    }

    /// The discs that it is made of, without those of its shape.
    fn specs(&self) -> Vec<AtomSpec> {
        self.atoms.as_ref().map_or_else(Vec::new, AtomShape::specs)
    }

    /// The rule for mass and inertia of its discs.
    fn rule(&self) -> InertiaRule {
        self.inertia.unwrap_or_else(|| self.atoms.as_ref().map_or_else(InertiaRule::default, AtomShape::own_rule))
    }

    /// Its centre of mass at the start, in m.
    pub fn start(&self, properties: &MassProperties) -> DVec2 {
        let at = self.at.unwrap_or_default().si();
        match self.datum {
            Datum::CenterOfMass => at,
            Datum::Origin => {
                let (sine, cosine) = libm::sincos(self.angle.si());
                at + DVec2::new(cosine, sine).rotate(properties.center)
            }
        }
    }

    /// Its prescribed motion, if it has one. The guided point is the one that `at` names.
    pub fn prescribed(&self, properties: &MassProperties) -> Option<Kinematic> {
        let entry = self.kinematic.as_ref()?;
        let center = if self.datum == Datum::Origin { properties.center } else { DVec2::ZERO };
        let position = self.at.unwrap_or_default().si();
        Some(Kinematic { since: 0.0, position, angle: self.angle.si(), center, path: entry.path() })
    }

    /// The places that `fill` must keep clear of.
    fn occupy(&self, outline: &mut Outline) {
        let specs = self.specs();
        if self.shape.is_none() && !mass_properties::is_affordable(&specs, self.rule()) {
            // The check refuses it.
            return;
        }
        if mass_properties::center_depends_on_density(&specs) && self.datum == Datum::CenterOfMass {
            // The material is not known yet; this circle holds the body wherever its centre of mass is.
            let center = self.at.unwrap_or_default().si();
            outline.occupy(Obstacle::Disc { center, radius: mass_properties::reach(&specs, self.rule()) });
            return;
        }
        let properties = self.mass_properties(1.0);
        let start = self.start(&properties);
        let (sine, cosine) = libm::sincos(self.angle.si());
        for atom in &properties.atoms {
            let center = start + DVec2::new(cosine, sine).rotate(atom.offset);
            outline.occupy(Obstacle::Disc { center, radius: atom.radius });
        }
        for hull in &properties.hulls {
            let radius = hull.reach_of_core(DVec2::ZERO) + hull.radius();
            outline.occupy(Obstacle::Disc { center: start, radius });
        }
    }
}
