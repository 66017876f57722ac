//! A touching pair as the search for rest sees it.

use glam::DVec2;

use super::apply::{End, Sink, arms};
use super::contact::Contact;
use super::law::PairLaw;
use super::normal::{Mode, NormalForce};
use crate::constraints::islands::Link;
use crate::constraints::rest_solver::Mover;
use crate::world::Bodies;

/// What stands on side A of a contact.
#[derive(Clone, Copy)]
pub(super) enum Other {
    Atom(End),
    Wall(u32),
}

/// A touching pair that may come to rest in the tick to come.
#[derive(Clone, Copy)]
pub(super) struct Case {
    pub place: u32,
    pub normal: DVec2,
    pub other: Other,
    pub end: End,
}

impl Link for Case {
    fn other_body(&self) -> Option<usize> {
        Case::other_body(self)
    }

    fn own_body(&self) -> usize {
        self.end.body
    }
}

impl Case {
    /// Side A unless it is a wall.
    pub fn other_end(&self) -> Option<&End> {
        match &self.other {
            Other::Atom(end) => Some(end),
            Other::Wall(_) => None,
        }
    }

    pub fn other_body(&self) -> Option<usize> {
        self.other_end().map(|end| end.body)
    }

    /// Arms of both sides.
    pub fn arms(&self, law: &PairLaw, overlap: f64) -> (DVec2, DVec2) {
        match &self.other {
            Other::Atom(other) => arms((other, &self.end), self.normal, overlap, law),
            Other::Wall(_) => (DVec2::ZERO, self.end.arm - self.normal * (self.end.radius - overlap)),
        }
    }

    /// A wall whose surface moves.
    pub fn belt(&self, bodies: &Bodies) -> Option<Mover> {
        let Other::Wall(wall) = self.other else { return None };
        bodies.belts.get(wall as usize).map(|&velocity| Mover { velocity, ..Mover::default() })
    }

    pub fn push(&self, sink: &mut Sink, law: &PairLaw, overlap: f64, force: DVec2) {
        match &self.other {
            Other::Atom(other) => sink.between((other, &self.end), self.normal, overlap, law, force),
            Other::Wall(wall) => {
                sink.wall_pushes(&self.end, *wall, self.normal, self.end.radius - overlap, force);
            }
        }
    }

    /// Whether the contact could stop within `dt` seconds: its normal velocity can be reversed by a force within the
    /// bounds of its law, or by what its neighbours may do at the same time (as much again).
    pub fn could_stop<N: NormalForce>(
        &self,
        contact: &Contact,
        law: &PairLaw,
        bodies: &Bodies,
        parting: f64,
        dt: f64,
    ) -> bool {
        if !N::dissipates(law) {
            return false;
        }
        if contact.mode == Mode::Hold {
            return true;
        }
        let acceleration = |body: usize| bodies.force[body] * bodies.inverse_mass(body);
        let other = self.other_body();
        let relative = acceleration(self.end.body) - other.map_or(DVec2::ZERO, acceleration);
        let inverse_mass = bodies.inverse_mass(self.end.body) + other.map_or(0.0, |body| bodies.inverse_mass(body));
        let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
        parting.abs() <= 2.0 * dt * (relative.dot(self.normal).abs() + (greatest - least) * inverse_mass)
    }
}
