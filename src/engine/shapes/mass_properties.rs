//! Mass, centre of mass and moment of inertia of a body made of atoms.
//!
//! With masses m_i, radii r_i and distances d_i from the common centre of mass, the moment of inertia is
//! * `Discs`: the sum of m_i r_i^2 / 2 + m_i d_i^2: each atom a solid disc, overlaps counted twice;
//! * `Points`: the sum of m_i d_i^2;
//! * `Union`: that of the area the atoms cover together, uniformly heavy, overlaps counted once; mass and centre too;
//! * a number in kg m2.
//!
//! A given mass replaces the sum, and all results of the sum are scaled to it.

use std::cell::RefCell;

use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserializer};
use serde::{Deserialize, Serialize};

use jostle_shapes::{AreaMoments, Hull, mark_inner};

use super::lately::Lately;
use super::outline::OutlinePart;
use super::{AtomSpec, union};
use crate::scene::Diagnostics;
use crate::scene::units::Inertia;

/// The origin of the coordinates of a body's atoms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Datum {
    /// `at` is the centre of mass, wherever it is in the shape's own frame.
    #[default]
    CenterOfMass,
    /// `at` is the origin of the shape's frame: the atoms keep their coordinates.
    Origin,
}

/// The rule for a body's moment of inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum InertiaRule {
    /// Each atom is a solid disc.
    #[default]
    Discs,
    /// Each atom is a point.
    Points,
    /// The covered area, uniformly heavy.
    Union,
    /// A number, in kg m2.
    Given(f64),
}

impl JsonSchema for InertiaRule {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "InertiaRule".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [{ "enum": ["Discs", "Points", "Union"] }, generator.subschema_for::<Inertia>()],
        })
    }
}

impl<'de> Deserialize<'de> for InertiaRule {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        // A word or a quantity: their readers differ, so the text is kept and looked at.
        let text = Box::<ron::value::RawValue>::deserialize(reader)?;
        let text = text.get_ron().trim();
        match text {
            "Discs" => return Ok(Self::Discs),
            "Points" => return Ok(Self::Points),
            "Union" => return Ok(Self::Union),
            _ => {}
        }
        match ron::from_str::<Inertia>(text) {
            Ok(inertia) => Ok(Self::Given(inertia.si())),
            Err(ron::error::SpannedError { code: ron::Error::Message(message), .. }) => Err(de::Error::custom(message)),
            Err(_) => Err(de::Error::custom(format!(
                "expected `Discs`, `Points`, `Union` or a moment of inertia such as `0.2`, found `{text}`"
            ))),
        }
    }
}

/// How heavy a body is and where.
#[derive(Clone, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass in kg.
    pub mass: f64,
    /// Centre of mass in the shape's own frame, in m.
    pub center: DVec2,
    /// Moment of inertia about the centre of mass, in kg m2.
    pub inertia: f64,
    /// The atoms with their places counted from the centre of mass; their masses add up to `mass`.
    pub atoms: Vec<AtomSpec>,
    /// The hulls about the centre of mass. Their corners are no atoms here.
    pub hulls: Vec<Hull>,
    /// The hulls and discs that are seen, but touch nothing, about the centre of mass.
    pub intangible: Vec<Hull>,
}

impl MassProperties {
    /// Reports atoms, at `atoms`, that are so large that results are infinite.
    pub fn check(&self, report: &mut Diagnostics) {
        let sizes = [self.mass, self.inertia, self.center.x, self.center.y];
        if report.is_clean() && !sizes.iter().all(|size| size.is_finite()) {
            let message = "its mass or moment of inertia is infinite";
            report.error("atoms", message).help("sizes are in metres and masses in kg: look for a zero too many");
        }
    }
}

/// The looks at pairs of discs that a union may take: some seconds. Silhouettes of 5000 atoms take fewer.
const MOST_LOOKS: usize = 1 << 25;

/// Whether the area that atoms cover together can be found in some time.
pub fn is_affordable(specs: &[AtomSpec], rule: InertiaRule) -> bool {
    rule != InertiaRule::Union || !union::takes_more(specs, MOST_LOOKS)
}

/// Reports atoms that cover too much of each other for [`InertiaRule::Union`]. Says whether there are none.
pub fn check_union(specs: &[AtomSpec], rule: InertiaRule, report: &mut Diagnostics) -> bool {
    let affordable = is_affordable(specs, rule);
    if !affordable {
        let message =
            format!("too many of its {} atoms lie in each other to find the area that they cover", specs.len());
        report.error("inertia", message).help("give the moment of inertia in kg m2, or use fewer or smaller atoms");
    }
    affordable
}

/// Works out mass, centre and inertia. `mass` wins over the sum of the atoms; `density` is the material's, in kg/m2.
pub fn of(specs: &[AtomSpec], mass: Option<f64>, rule: InertiaRule, density: f64) -> MassProperties {
    let mut atoms: Vec<AtomSpec> = specs.iter().map(|atom| atom.with_density(density)).collect();
    let sum: f64 = atoms.iter().filter_map(|atom| atom.mass).sum();
    let (own_mass, center, own_inertia) = match rule {
        InertiaRule::Union => {
            let area = union::area_moments(&atoms);
            (density * area.area, area.centroid, density * area.polar)
        }
        _ => {
            let center = atoms.iter().map(|atom| atom.mass.unwrap_or(0.0) * atom.offset).sum::<DVec2>() / sum;
            let one = |atom: &AtomSpec| {
                let own = if rule == InertiaRule::Points { 0.0 } else { atom.radius * atom.radius / 2.0 };
                atom.mass.unwrap_or(0.0) * (own + (atom.offset - center).length_squared())
            };
            (sum, center, atoms.iter().map(one).sum())
        }
    };
    let mass = mass.unwrap_or(own_mass);
    let inertia = match rule {
        InertiaRule::Given(inertia) => inertia,
        _ => own_inertia * (mass / own_mass),
    };
    for atom in &mut atoms {
        atom.offset -= center;
        atom.mass = atom.mass.map(|own| own * (mass / sum));
    }
    MassProperties { mass, center, inertia, atoms, hulls: Vec::new(), intangible: Vec::new() }
}

/// The same for a body with parts with sides beside its atoms.
///
/// If no part has a mass or density, mass and inertia are those of their union, uniformly heavy. Otherwise each part weighs
/// separately, and overlaps of two parts count twice. The atoms together are one such part.
pub fn of_parts(
    specs: &[AtomSpec],
    parts: &[OutlinePart],
    mass: Option<f64>,
    rule: InertiaRule,
    density: f64,
) -> MassProperties {
    let disc = |atom: &AtomSpec| Hull::disc(atom.offset, atom.radius).ok();
    let atoms: Vec<Hull> = specs.iter().filter_map(disc).collect();
    let own = parts.iter().any(|part| part.mass.is_some() || part.density.is_some());
    let heap = if own {
        let each = parts.iter().map(|part| Heavy::of(&part.hulls, part.mass, part.density.unwrap_or(density)));
        let atoms = (!atoms.is_empty()).then(|| Heavy::of(&atoms, None, density));
        each.chain(atoms).reduce(Heavy::with).unwrap_or_default()
    } else {
        let all: Vec<Hull> = parts.iter().flat_map(|part| part.hulls.iter().cloned()).chain(atoms).collect();
        Heavy::of(&all, None, density)
    };
    let (center, total) = (heap.center, mass.unwrap_or(heap.mass));
    let inertia = match rule {
        InertiaRule::Given(inertia) => inertia,
        _ => heap.inertia * (total / heap.mass),
    };
    let mut atoms: Vec<AtomSpec> = specs.to_vec();
    let (mut hulls, mut intangible) = (Vec::new(), Vec::new());
    // If no atom of a body touches, the body does not touch.
    let none_touches = specs.is_empty() && !parts.iter().any(|part| part.collides);
    for part in parts {
        let to = if part.collides || none_touches { &mut hulls } else { &mut intangible };
        to.extend(Hull::all_moved(&part.hulls, -center));
    }
    hulls = OUTLINES.with_borrow_mut(|outlines| outlines.get(&hulls, || marked(hulls.clone())));
    // A disc that touches is an atom.
    let is_disc = |hull: &Hull| hull.corners().len() == 1;
    for disc in hulls.iter().filter(|hull| is_disc(hull)) {
        atoms.push(AtomSpec { offset: disc.corners()[0] + center, radius: disc.radius(), mass: None, stiffness: None });
    }
    hulls.retain(|hull| !is_disc(hull));
    let squares: f64 = atoms.iter().map(|atom| atom.radius * atom.radius).sum();
    for atom in &mut atoms {
        let share = atom.radius * atom.radius / squares;
        *atom = AtomSpec {
            offset: atom.offset - center,
            mass: Some(if hulls.is_empty() { total * share } else { 0.0 }),
            ..*atom
        };
    }
    MassProperties { mass: total, center, inertia, atoms, hulls, intangible }
}

thread_local! {
    static AREAS: RefCell<Lately<AreaMoments>> = const { RefCell::new(Lately::new()) };
    static OUTLINES: RefCell<Lately<Vec<Hull>>> = const { RefCell::new(Lately::new()) };
}

/// The hulls of a body, with their inner sides marked.
fn marked(mut hulls: Vec<Hull>) -> Vec<Hull> {
    mark_inner(&mut hulls);
    hulls
}

/// A part of a body with its mass.
#[derive(Clone, Copy, Debug, Default)]
struct Heavy {
    mass: f64,
    center: DVec2,
    /// About its own centre of mass, in kg m2.
    inertia: f64,
}

impl Heavy {
    /// The union of some hulls, uniformly heavy.
    fn of(hulls: &[Hull], mass: Option<f64>, density: f64) -> Self {
        let area = AREAS.with_borrow_mut(|areas| areas.get(hulls, || AreaMoments::union_of(hulls)));
        let mass = mass.unwrap_or(density * area.area);
        Self { mass, center: area.centre, inertia: mass / area.area * area.second_moment }
    }

    /// Both as one body.
    fn with(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        let share = other.mass / mass;
        let apart = other.center - self.center;
        let inertia = self.inertia + other.inertia + self.mass * share * apart.length_squared();
        Self { mass, center: self.center + apart * share, inertia }
    }
}

/// Whether some atoms have masses of their own and others follow the material.
pub fn center_depends_on_density(specs: &[AtomSpec]) -> bool {
    let own = specs.iter().filter(|atom| atom.mass.is_some()).count();
    own != 0 && own != specs.len()
}

/// The radius of a circle about the centre of mass that holds all atoms, in m. If the centre depends on the density, it
/// holds them for every density.
pub fn reach(specs: &[AtomSpec], rule: InertiaRule) -> f64 {
    let widest =
        |center: DVec2| specs.iter().map(|atom| (atom.offset - center).length() + atom.radius).fold(0.0, f64::max);
    if center_depends_on_density(specs) {
        let middle = specs.iter().map(|atom| atom.offset).sum::<DVec2>() / specs.len() as f64;
        // The centre of mass lies among the atoms' centres, all of which are within this distance from the middle.
        return 2.0 * widest(middle);
    }
    widest(of(specs, None, rule, 1.0).center)
}

/// The same of a body that has parts with sides.
pub fn reach_of_parts(specs: &[AtomSpec], parts: &[OutlinePart]) -> f64 {
    let disc = |atom: &AtomSpec| Hull::disc(atom.offset, atom.radius).ok();
    let hulls: Vec<Hull> =
        parts.iter().flat_map(|part| part.hulls.iter().cloned()).chain(specs.iter().filter_map(disc)).collect();
    let widest =
        |center: DVec2| hulls.iter().map(|hull| hull.reach_of_core(center) + hull.radius()).fold(0.0, f64::max);
    let own = parts.iter().filter(|part| part.mass.is_some() || part.density.is_some()).count();
    if own != 0 && (own != parts.len() || !specs.is_empty()) {
        // The centre of mass lies among those of the parts, and the farthest distance is a convex function of it.
        let atoms: Vec<Hull> = specs.iter().filter_map(disc).collect();
        let each = parts.iter().map(|part| &part.hulls).chain((!atoms.is_empty()).then_some(&atoms));
        return each.map(|hulls| widest(AreaMoments::union_of(hulls).centre)).fold(0.0, f64::max);
    }
    widest(of_parts(specs, parts, None, InertiaRule::Union, 1.0).center)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn atom(x: f64, y: f64, radius: f64, mass: Option<f64>) -> AtomSpec {
        AtomSpec { offset: DVec2::new(x, y), radius, mass, stiffness: None }
    }

    #[test]
    fn a_dumbbell_follows_the_parallel_axis_theorem() {
        let atoms = [atom(0.0, 0.0, 0.5, Some(1.0)), atom(4.0, 0.0, 1.0, Some(3.0))];
        let discs = of(&atoms, None, InertiaRule::Discs, 1.0);
        assert_eq!((discs.mass, discs.center), (4.0, DVec2::new(3.0, 0.0)));
        assert_eq!(discs.inertia, 9.0 + 3.0 + 0.125 + 1.5);
        assert_eq!(discs.atoms[1].offset, DVec2::new(1.0, 0.0));
        assert_eq!(of(&atoms, None, InertiaRule::Points, 1.0).inertia, 12.0);
    }

    #[test]
    fn given_mass_and_inertia_win() {
        let atoms = [atom(0.0, 0.0, 1.0, Some(2.0))];
        let heavier = of(&atoms, Some(6.0), InertiaRule::Discs, 1.0);
        assert_eq!((heavier.mass, heavier.inertia, heavier.atoms[0].mass), (6.0, 3.0, Some(6.0)));
        assert_eq!(of(&atoms, None, InertiaRule::Given(0.2), 1.0).inertia, 0.2);
    }

    #[test]
    fn the_union_of_one_disc_is_the_disc() {
        let disc = [atom(3.0, -2.0, 0.7, None)];
        let union = of(&disc, None, InertiaRule::Union, 2.5);
        let discs = of(&disc, None, InertiaRule::Discs, 2.5);
        // Rounding of a handful of operations on numbers near one.
        assert!((union.mass - discs.mass).abs() < 1e-14 * discs.mass);
        assert!((union.inertia - discs.inertia).abs() < 1e-13 * discs.inertia);
        assert!((union.center - discs.center).length() < 1e-14);
    }

    #[test]
    fn a_circle_of_reach_holds_the_body() {
        let mixed = [atom(0.0, 0.0, 0.5, Some(1.0)), atom(4.0, 0.0, 1.0, None)];
        for density in [1e-6, 1.0, 1e6] {
            let properties = of(&mixed, None, InertiaRule::Discs, density);
            assert!(
                properties
                    .atoms
                    .iter()
                    .all(|atom| atom.offset.length() + atom.radius <= reach(&mixed, InertiaRule::Discs))
            );
        }
        assert_eq!(reach(&[atom(7.0, 0.0, 0.5, None)], InertiaRule::Discs), 0.5);
    }
}
