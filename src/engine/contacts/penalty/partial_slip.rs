//! Partial slip: a contact at its static cone beside another one that still sticks between the same two bodies.
//!
//! Rigid bodies with two points of contact slide at both or at none. While one of them sticks, the other one moves no
//! farther than springs give. So it keeps the static coefficient (Mindlin 1949, "Compliance of elastic bodies in contact").
//! It takes the dynamic coefficient once none sticks. So the friction of a box ends at `mu_s` times the sum of its normal
//! forces. The shares of the springs of its corners do not matter.
//!
//! An opposite contact may slide: a wheel between two plates rolls on one of them.

use glam::DVec2;

use super::apply::PenaltyContacts;
use super::contact_list::ContactList;
use super::coulomb::Grip;
use super::normal::Mode;
use super::switching::View;
use crate::constraints::DEPENDENT;
use crate::constraints::islands::IslandLink;
use crate::contacts::CandidatePairs;
use crate::contacts::geometry::ContactSides;
use crate::world::Bodies;
use jostle_simd::BLOCK;

/// The greatest tangent of the angle between the normal of an opposite contact and the line to the other one. That line is
/// the surface for corners of a side, and it is the normal for a wheel between plates. In a groove of 120 degrees it is at
/// 60 degrees, where a disc cannot roll on one side alone.
const OPPOSITE: f64 = 0.5;

/// A contact of two bodies.
struct Link {
    /// Both bodies in order; `None` for all that does not move.
    bodies: (Option<usize>, Option<usize>),
    index: usize,
    /// Its place in metres.
    place: DVec2,
    normal: DVec2,
    grip: Grip,
}

impl Link {
    fn of(index: usize, pair: &ContactSides, arm: DVec2, grip: Grip, bodies: &Bodies) -> Self {
        let place = bodies.position[pair.b.body] + arm;
        Self { bodies: between(pair, bodies), index, place, normal: pair.normal, grip }
    }

    /// Whether another contact of the same bodies sticks, so that this one cannot slide.
    fn is_kept_by(&self, other: &Self) -> bool {
        let way = self.place - other.place;
        let opposite = OPPOSITE * way.dot(self.normal).abs() >= way.perp_dot(self.normal).abs();
        matches!(other.grip, Grip::Stick | Grip::Hold) && other.index != self.index && !opposite
    }
}

/// Both bodies of a contact in order; `None` for all that does not move.
pub(super) type Between = (Option<usize>, Option<usize>);

/// Between which bodies a contact is.
pub(super) fn between(pair: &ContactSides, bodies: &Bodies) -> Between {
    let of = |body: Option<usize>| body.filter(|body| bodies.moves[*body]);
    let (a, b) = (of(pair.other_body()), of(Some(pair.b.body)));
    (a.min(b), a.max(b))
}

impl PenaltyContacts {
    /// The touching contacts, atoms first, that may have others between the same bodies. Two discs meet in one point.
    fn perhaps_several(&self, (bodies, pairs): (&Bodies, &CandidatePairs)) -> Vec<usize> {
        let alone = |atom: u32| {
            let body = bodies.atom_body(atom as usize);
            bodies.moves[body] && bodies.atoms_of(body).len() == 1
        };
        let atoms = self.atoms.touching().filter(|index| {
            let pair = pairs.atoms[*index];
            !(alone(pair.a) && alone(pair.b))
        });
        let surfaces = self.surfaces.touching().map(|index| self.atoms.len() + index);
        atoms.chain(surfaces).collect()
    }

    /// Contacts that have opened in partial slip begin anew, like all others, if they touch again.
    fn end_partial_slip(&mut self) {
        let Self { laws, atoms, surfaces, .. } = self;
        let is_partial = |law: u32| laws.twin(law) < law;
        for list in [atoms, surfaces] {
            if list.only_law.is_some_and(|law| !is_partial(law)) {
                continue;
            }
            let law_of = |list: &ContactList, index: usize| list.law[index / BLOCK][index % BLOCK];
            for index in 0..list.len() {
                let law = law_of(list, index);
                if is_partial(law) && !list.is_touching(index) {
                    list.edit(index).law = laws.twin(law);
                }
            }
        }
    }
}

/// The indices of contacts that slide, with none of the same bodies that keeps them from it. Each contact of an island has its arm, and its
/// grip in the tick to come.
pub(super) fn all_slide(contacts: impl Iterator<Item = (ContactSides, DVec2, Grip)>, bodies: &Bodies) -> Vec<usize> {
    let link =
        |(index, (pair, arm, grip)): (usize, (ContactSides, DVec2, Grip))| Link::of(index, &pair, arm, grip, bodies);
    let mut links: Vec<Link> = contacts.enumerate().map(link).collect();
    links.sort_unstable_by_key(|link| (link.bodies, link.index));
    let groups = links.chunk_by(|one, other| one.bodies == other.bodies);
    let slides = |link: &&Link| link.grip == Grip::Slide;
    groups
        .flat_map(|group| group.iter().filter(slides).filter(|link| !group.iter().any(|other| link.is_kept_by(other))))
        .map(|link| link.index)
        .collect()
}

impl View<'_> {
    /// Some contacts give way now. Friction of the same bodies that holds at its bound gives way with them, to the same side. They held
    /// it so far. `gave`: their bodies, and whether their forces are positive.
    pub(super) fn give_together(&mut self, gave: &[(Between, bool)]) {
        for index in 0..if gave.is_empty() { 0 } else { self.len() } {
            let bodies = between(&self.look(index).pair, self.bodies);
            let (mut contact, law) = self.contact(index);
            let slider = law.tangential();
            let limit = slider.friction_static * contact.normal_force;
            let force = contact.tangential.force(&slider);
            let bound = contact.mode != Mode::Open && contact.tangential.grip == Grip::Hold && slider.acts();
            if bound
                && force != 0.0
                && force.abs() >= limit * (1.0 - DEPENDENT)
                && gave.contains(&(bodies, force > 0.0))
            {
                contact.give(law, force > 0.0);
            }
        }
    }

    /// Finds the contacts that slip beside others which stick. Says whether the friction of one that slides has changed.
    /// `staged`: contacts are evaluated in stages of steps. Else the search for rest ends partial slip in the same tick
    /// ([`all_slide`]).
    pub(super) fn share_cones(&mut self, staged: bool) -> bool {
        if !self.contacts.laws.some_drop() {
            return false;
        }
        self.contacts.end_partial_slip();
        let mut links = Vec::new();
        for index in self.contacts.perhaps_several((self.bodies, self.pairs)) {
            let (geometry, bodies) = (self.look(index), self.bodies);
            let (contact, law) = self.contact(index);
            if law.tangential().acts() {
                let arm = geometry.contact_arms(law.shares()).1;
                links.push(Link::of(index, &geometry.pair, arm, contact.tangential.grip, bodies));
            }
        }
        links.sort_unstable_by_key(|link| (link.bodies, link.index));
        let mut changed = false;
        for group in links.chunk_by(|one, other| one.bodies == other.bodies) {
            for link in group {
                let kept = group.iter().any(|other| link.is_kept_by(other));
                changed |= self.take_cone(link, kept, staged);
            }
        }
        changed
    }

    /// Gives a contact the coefficients of partial slip, or of slip. One that sticks takes those of partial slip, and slips
    /// with them. Says whether a friction has changed.
    fn take_cone(&mut self, link: &Link, kept: bool, staged: bool) -> bool {
        let law = self.contact(link.index).0.law;
        let other = self.contacts.laws.twin(law);
        let is_partial = other < law;
        let may_be = match link.grip {
            Grip::Stick | Grip::Hold => true,
            Grip::Slip | Grip::Slide => is_partial,
        };
        if other == law || is_partial == (kept && may_be) {
            return false;
        }
        self.contact(link.index).0.law = other;
        let (mut contact, law) = self.contact(link.index);
        let grip = contact.tangential.grip;
        let slides = grip == Grip::Slide || staged && grip == Grip::Slip;
        if slides {
            contact.tangential.held = contact.tangential.sliding_force(&law.tangential(), contact.normal_force);
        }
        slides
    }
}
