//! Active features of contacts with hulls in stages of a step. The touched corner or side stays fixed, so that forces
//! are smooth. A change of the nearest feature is an event. There normal and overlap are continuous, and their rates
//! jump.
//!
//! If the outline continues at another part of the shape, the contact moves to the pair of that part. It takes all its
//! history along.

use glam::DVec2;
use jostle_shapes::{Feature, Hull, beyond};

use super::apply::PenaltyContacts;
use super::contact::Contact;
use super::contact_list::ContactList;
use super::normal::Mode;
use super::rolling::RollingContacts;
use super::switching::{Told, View, What};
use crate::contacts::{CandidatePairs, Probe, Surface, SurfacePair};
use crate::tick::{Bend, Indicator};
use crate::world::{Bodies, PackedHull};

/// Between ticks, or where states follow one another, the nearest feature counts.
pub(super) fn release(pairs: &mut CandidatePairs) {
    if std::mem::take(&mut pairs.keeps) {
        pairs.surfaces.iter_mut().for_each(|pair| pair.keep(None));
    }
}

/// Before a step with stages: contacts that touch a hull keep the nearest feature, or the earlier one.
pub(super) fn keep(pairs: &mut CandidatePairs, touching: &ContactList, bodies: &Bodies) {
    if bodies.hulls.is_empty() {
        return;
    }
    pairs.keeps = true;
    for index in 0..pairs.surfaces.len() {
        let pair = pairs.surfaces[index];
        let found = || Seen::of(pair, bodies).and_then(|seen| seen.nearest());
        let kept = touching.is_touching(index).then(|| pair.kept().or_else(found));
        pairs.surfaces[index].keep(kept.flatten());
    }
}

/// A probe as seen from a hull.
struct Seen<'a> {
    hull: usize,
    packed: &'a PackedHull,
    shape: &'a Hull,
    /// In the frame of the hull, in m and m/s.
    place: DVec2,
    velocity: DVec2,
}

impl<'a> Seen<'a> {
    /// `None` if the surface is not a hull.
    fn of(pair: SurfacePair, bodies: &'a Bodies) -> Option<Self> {
        let Surface::Hull(hull) = pair.surface(bodies) else { return None };
        let packed = &bodies.hulls[hull];
        let (shape, center, velocity) = match pair.probe(bodies) {
            Probe::Atom(atom) => {
                let (shape, center, _) = bodies.meeting(hull, atom);
                let body = bodies.atom_body(atom);
                (shape, center, bodies.velocity_at(body, center - bodies.position[body]))
            }
            Probe::End(wall, right) => (&packed.hull, bodies.walls[wall].end(right).0, DVec2::ZERO),
        };
        let body = packed.body as usize;
        let pose = bodies.pose_with_hulls(body);
        let seen = velocity - bodies.velocity_at(body, center - bodies.position[body]);
        let (place, velocity) = (pose.point_to_local(center), pose.direction_to_local(seen));
        Some(Self { hull, packed, shape, place, velocity })
    }

    /// Under the outline no border parts the features that are known here.
    fn nearest(&self) -> Option<Feature> {
        let found = jostle_shapes::nearest(self.shape, self.place);
        (found.distance > 0.0).then_some(found.feature)
    }

    fn is_rounded(&self) -> bool {
        !std::ptr::eq(self.shape, &self.packed.hull)
    }

    /// The hull and the feature to which the probe has come.
    fn beyond(&self, feature: Feature, passed: [bool; 2], bodies: &'a Bodies) -> Option<(usize, Feature)> {
        let indices = bodies.indices_of_hulls(self.packed.body as usize);
        let first = indices.start;
        let shape = |packed: &'a PackedHull| match &packed.rounded {
            Some(rounded) if self.is_rounded() => &rounded.hull,
            _ => &packed.hull,
        };
        let hulls: Vec<&Hull> = bodies.hulls[indices].iter().map(shape).collect();
        let second = self.shape.passed_second(feature, self.place, passed);
        beyond(&hulls, self.hull - first, feature, second).map(|(part, feature)| (first + part, feature))
    }
}

impl View<'_> {
    /// Adds the indicators of the borders of the feature that a contact keeps. `place` counts all contacts.
    pub(super) fn tell_borders(&self, index: usize, what: &mut Told, told: &mut Vec<Indicator>) {
        let Some(surface) = index.checked_sub(self.contacts.atoms.len()) else { return };
        let pair = self.pairs.surfaces[surface];
        let Some(feature) = pair.kept() else { return };
        let Some(seen) = Seen::of(pair, self.bodies) else { return };
        let rounding = 4.0 * f64::EPSILON * (seen.place.abs().max_element() + seen.packed.extent);
        let borders = seen.shape.borders(feature, seen.place, seen.velocity).into_iter().flatten();
        for (second, (value, slope)) in [false, true].into_iter().zip(borders) {
            what.push((index as u32, What::Border(second)));
            told.push(Indicator { rounding, ..Indicator::new(value, slope, Bend::Fitted) });
        }
    }
}

/// The contacts whose borders are passed keep what lies beyond.
pub(super) fn cross(
    fired: &[usize],
    (bodies, pairs): (&Bodies, &mut CandidatePairs),
    contacts: &mut PenaltyContacts,
    mut rolling: Option<&mut RollingContacts>,
) {
    let atoms = contacts.atoms.len();
    let told = std::mem::take(&mut contacts.told);
    let mut passed: Vec<(usize, [bool; 2])> = Vec::new();
    for &(index, what) in fired.iter().filter_map(|index| told.get(*index)) {
        if let What::Border(second) = what {
            let index = index as usize - atoms;
            let known = passed.last_mut().filter(|(other, _)| *other == index);
            match known {
                Some((_, both)) => both[usize::from(second)] = true,
                None => passed.push((index, [!second, second])),
            }
        }
    }
    contacts.told = told;
    for (index, borders) in passed {
        let pair = pairs.surfaces[index];
        let Some((feature, seen)) = pair.kept().zip(Seen::of(pair, bodies)) else { continue };
        if contacts.surfaces.get(index).mode == Mode::Open {
            continue;
        }
        let next = seen.beyond(feature, borders, bodies);
        pairs.surfaces[index].keep(None);
        match next {
            Some((hull, feature)) if hull == seen.hull => pairs.surfaces[index].keep(Some(feature)),
            Some((hull, feature)) => {
                let other = SurfacePair::new((bodies.walls.len() + hull) as u32, pair.probe);
                let found = pairs.surfaces.binary_search_by_key(&other.names(), SurfacePair::names).ok();
                let free = found.filter(|found| contacts.surfaces.get(*found).mode == Mode::Open);
                if let Some(to) = free {
                    pairs.surfaces[to].keep(Some(feature));
                    let history = contacts.surfaces.get(index);
                    let law = contacts.surfaces.get(to).law;
                    contacts.surfaces.set(to, &Contact { law, ..history });
                    if let Some(rolling) = &mut rolling {
                        rolling.surfaces[to] = std::mem::take(&mut rolling.surfaces[index]);
                    }
                }
                open(contacts, index);
            }
            None => open(contacts, index),
        }
    }
}

/// The outline ends there, and another contact bears the load, or none does.
fn open(contacts: &mut PenaltyContacts, index: usize) {
    let law = contacts.surfaces.get(index).law;
    contacts.surfaces.set(index, &Contact::open(law));
}
