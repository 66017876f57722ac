//! A hull of a body: a rounded convex polygon or a capsule, with its sides. Its corners are atoms of the body.
//!
//! Corners touch hulls of others and walls. Corners of others and discs touch sides. A disc is an atom without a hull.

use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle_shapes::{Feature, Hull, Nearest, Pose, Rounded, distance_to, nearest};
use serde::{Deserialize, Serialize};

use super::Bodies;
use super::body::mark_changed;
use super::material::MaterialIndex;
use super::wall::PackedWall;

/// The hulls of a body with two corners and more, about its centre of mass, in metres. The last atoms of the body are their corners, hull by
/// hull.
#[derive(Component, Clone, Debug, PartialEq)]
#[component(immutable, on_insert = mark_changed, on_remove = mark_changed)]
pub struct Hulls(pub Vec<Hull>);

/// Parts of a body that are seen and have mass, but touch nothing.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Intangible {
    /// Hulls and discs about its centre of mass, in metres.
    pub hulls: Vec<Hull>,
    /// The index of their material.
    pub material: MaterialIndex,
}

/// The corrections of the numbers of shapes, for the notes of the card.
#[derive(Resource, Clone, Debug, Default)]
pub struct MendedShapes {
    /// Each correction with the names of its bodies, in the order of the scene.
    told: Vec<(String, Vec<String>)>,
}

impl MendedShapes {
    /// Adds a correction of the shape of a body, or of the bodies of an entry.
    pub fn add(&mut self, name: &str, correction: String) {
        match self.told.iter_mut().find(|(known, _)| *known == correction) {
            Some((_, names)) if names.iter().any(|known| known == name) => {}
            Some((_, names)) => names.push(name.to_owned()),
            None => self.told.push((correction, vec![name.to_owned()])),
        }
    }

    /// A note for each correction. Of many bodies it names the first.
    pub fn notes(&self) -> impl Iterator<Item = String> + '_ {
        self.told.iter().map(|(correction, names)| match &names[..] {
            [only] => format!("`{only}`: {correction}"),
            [first, others @ ..] => format!("`{first}` and {} more: {correction}", others.len()),
            [] => correction.clone(),
        })
    }
}

/// A hull as contacts see it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackedHull {
    /// Place of its body.
    pub body: u32,
    /// Place of the atom that is its first corner.
    pub first_atom: u32,
    /// Its shape about the centre of mass.
    pub hull: Hull,
    /// Its rounded shape for contacts with other sharp hulls, if it is sharp: see [`ROUNDING`].
    pub(crate) rounded: Option<Rounded>,
    /// Half of its least width in metres.
    pub half_width: f64,
    /// The distance that it reaches from the centre of mass, in metres.
    pub extent: f64,
    /// The middle of its corners, and how far it reaches from there, in metres.
    pub(crate) circle: (DVec2, f64),
}

/// If two sharp hulls meet, their corners are rounded off by this share of half their width. A sharp corner just above
/// the end of a sharp side is equally near to the other side. So aligned boxes would fall through each other.
pub(crate) const ROUNDING: f64 = 0.02;

/// Marks an atom that is no corner.
pub(super) const NO_HULL: u32 = u32::MAX;

/// The nearest point on the core of a hull, as seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestOnHull {
    /// Distance from the core in metres, negative inside.
    pub distance: f64,
    /// Unit normal of the hull there, outwards.
    pub normal: DVec2,
    /// The place on the core, from the centre of mass of the body, in metres.
    pub foot: DVec2,
    /// Whether it lies on a side, whose normal turns with the body.
    pub flat: bool,
    /// Whether it lies on the outline of the body; otherwise another hull of the body is touched there.
    pub owned: bool,
}

impl NearestOnHull {
    /// Transforms a point found in the frame of a hull to the world. `at` is the point to which it is the nearest.
    #[inline]
    fn of(found: &Nearest, pose: &Pose, hull: &Hull, at: DVec2) -> Self {
        let (distance, normal, foot) = match found.feature {
            // Two corners are near to each other, and far from the centres of their bodies. Both compute the same
            // normal to the last bit only if neither point is relative to the other body. Otherwise two equal contacts
            // would seem to differ.
            Feature::Corner(corner) if found.distance > 0.0 => {
                let corner = pose.point_to_world(hull.corners()[corner]);
                let away = at - corner;
                let distance = away.length();
                (distance, away / distance, corner - pose.position)
            }
            _ => {
                let normal = pose.direction_to_world(found.normal);
                (found.distance, normal, at - pose.position - normal * found.distance)
            }
        };
        Self { distance, normal, foot, flat: found.feature.is_side(), owned: true }
    }
}

impl PackedHull {
    /// Packs the hulls of the body at a place, whose corners are the last atoms before `end`.
    pub(super) fn of_body(body: usize, hulls: &Hulls, end: usize) -> impl Iterator<Item = Self> {
        let corners: usize = hulls.0.iter().map(|hull| hull.corners().len()).sum();
        let mut first = end - corners;
        // Parts that share corners are rounded alike.
        let half_widths = Hull::half_widths(&hulls.0);
        let least = half_widths.iter().copied().fold(f64::INFINITY, f64::min);
        let rounded = Hull::all_rounded(&hulls.0, ROUNDING * least);
        hulls.0.iter().zip(half_widths).zip(rounded).map(move |((hull, half_width), rounded)| {
            let first_atom = first as u32;
            first += hull.corners().len();
            let extent = hull.reach_of_core(DVec2::ZERO) + hull.radius();
            let middle = hull.corners().iter().sum::<DVec2>() / hull.corners().len() as f64;
            Self {
                body: body as u32,
                first_atom,
                hull: hull.clone(),
                rounded,
                half_width,
                extent,
                circle: (middle, hull.reach_of_core(middle) + hull.radius()),
            }
        })
    }

    /// The atoms that are its corners.
    pub fn corners(&self) -> std::ops::Range<usize> {
        let first = self.first_atom as usize;
        first..first + self.hull.corners().len()
    }
}

impl Bodies {
    /// Whether an atom is the corner of a hull.
    #[inline]
    pub fn is_corner(&self, atom: usize) -> bool {
        self.hull_of(atom).is_some()
    }

    /// Whether an atom touches walls and hulls: a disc, or a convex corner of the outline of its body.
    #[inline]
    pub fn probes(&self, atom: usize) -> bool {
        self.hull_of(atom).is_none_or(|hull| {
            let packed = &self.hulls[hull];
            packed.hull.probes(atom - packed.first_atom as usize)
        })
    }

    /// The place of the hull of which an atom is a corner.
    #[inline]
    pub fn hull_of(&self, atom: usize) -> Option<usize> {
        self.atom_hull.get(atom).filter(|hull| **hull != NO_HULL).map(|hull| *hull as usize)
    }

    /// The places of the hulls of a body.
    pub fn indices_of_hulls(&self, body: usize) -> std::ops::Range<usize> {
        let first = |body: usize| self.hulls.partition_point(|hull| (hull.body as usize) < body);
        first(body)..first(body + 1)
    }

    /// The hulls of a body.
    pub fn hulls_of(&self, body: usize) -> impl Iterator<Item = &PackedHull> {
        self.hulls[self.indices_of_hulls(body)].iter()
    }

    /// Half the width in metres of the owner of an atom. For a disc it is the radius, for a corner half the least width
    /// of its hull.
    #[inline]
    pub fn size_of_atom(&self, atom: usize) -> f64 {
        self.hull_of(atom).map_or(self.atom_radius[atom], |hull| self.hulls[hull].half_width)
    }

    /// The pose of a body with hulls.
    #[inline]
    pub fn pose_with_hulls(&self, body: usize) -> Pose {
        Pose { position: self.position[body], rotation: self.turned[body] }
    }

    /// A hull and an atom in the shapes in which they meet: if both are sharp, both are rounded. Returns the hull, the
    /// centre of the atom and its radius, in metres.
    #[inline]
    pub(crate) fn meeting(&self, hull: usize, atom: usize) -> (&Hull, DVec2, f64) {
        let packed = &self.hulls[hull];
        let rounded = packed.rounded.as_ref().and_then(|surface| Some((surface, self.round_corner(atom)?)));
        match rounded {
            Some((surface, (place, radius))) => (&surface.hull, place, radius),
            None => (&packed.hull, self.atom_place(atom), self.atom_radius[atom]),
        }
    }

    /// The position of an atom in metres for a wall, and its radius in metres. A sharp corner is rounded if it meets a
    /// strip without thickness.
    #[inline]
    pub(crate) fn meeting_wall(&self, wall: &PackedWall, atom: usize) -> (DVec2, f64) {
        let sharp = (self.atom_place(atom), self.atom_radius[atom]);
        if self.hulls.is_empty() || !wall.is_thin() { sharp } else { self.round_corner(atom).unwrap_or(sharp) }
    }

    /// The centre and the radius, both in metres, of the rounding of a sharp corner. `None` for other atoms.
    pub(crate) fn round_corner(&self, atom: usize) -> Option<(DVec2, f64)> {
        let own = &self.hulls[self.hull_of(atom)?];
        let round = &own.rounded.as_ref()?.hull;
        let corner = round.corners()[atom - own.first_atom as usize];
        Some((self.pose_with_hulls(own.body as usize).point_to_world(corner), round.radius()))
    }

    /// The nearest place of the core of a hull of a body to a point in the world, in metres. `hull` is one of the body's, or rounded.
    #[inline]
    pub(crate) fn nearest_on(&self, body: usize, hull: &Hull, at: DVec2) -> NearestOnHull {
        let pose = self.pose_with_hulls(body);
        let found = nearest(hull, pose.point_to_local(at));
        NearestOnHull { owned: hull.owns(&found), ..NearestOnHull::of(&found, &pose, hull, at) }
    }

    /// The same for a contact, with the distance. If the nearest point belongs to another part of the body, the hull
    /// counts as far. A feature that the contact keeps replaces the nearest one.
    #[inline]
    pub(crate) fn touched_on(
        &self,
        (hull, kept): (usize, Option<Feature>),
        shape: &Hull,
        at: DVec2,
    ) -> (NearestOnHull, f64) {
        let packed = &self.hulls[hull];
        if let Some(feature) = kept {
            let pose = self.pose_with_hulls(packed.body as usize);
            let found = NearestOnHull::of(&distance_to(shape, feature, pose.point_to_local(at)), &pose, shape, at);
            return (found, found.distance);
        }
        let found = self.nearest_on(packed.body as usize, shape, at);
        let distance = found.distance;
        let far = if found.owned { distance } else { distance.abs() + 2.0 * packed.extent };
        (NearestOnHull { distance: far, ..found }, distance)
    }

    /// The nearest place of the core of a hull to a point in the world, in metres.
    pub fn nearest_on_hull(&self, hull: usize, at: DVec2) -> NearestOnHull {
        let packed = &self.hulls[hull];
        self.nearest_on(packed.body as usize, &packed.hull, at)
    }

    /// The greatest distance in metres of sharp corners from a hull, beyond that at their meeting.
    pub(crate) fn spread(&self, hull: usize, atom: usize) -> f64 {
        let own = self.hull_of(atom).and_then(|own| self.hulls[own].rounded.as_ref());
        own.filter(|_| self.hulls[hull].rounded.is_some()).map_or(0.0, |own| own.spread)
    }
}
