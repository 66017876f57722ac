//! A touching pair as a case for the rest solver: whether it parts, or could stop within a tick.

use glam::DVec2;

use super::apply::Sink;
use super::contact::Contact;
use super::normal::{Mode, NormalForce};
use super::pair_law::PairLaw;
use crate::constraints::islands::IslandLink;
use crate::contacts::geometry::{ContactSides, PairGeometry, SideA};
use crate::world::Bodies;

/// Units in the last place by which a place and the overlap that follows from it may err.
const UNITS: f64 = 4.0;

impl PairGeometry {
    /// The relative acceleration in m/s2 by a force that is all rounding of places. Zero for sides that overlap by more, or lie
    /// farther apart.
    pub(super) fn unknown_acceleration(&self, law: &PairLaw, mobility: f64, bodies: &Bodies) -> f64 {
        let rounding = self.pair.rounding(bodies);
        if self.overlap.abs() <= rounding { mobility * law.stiffness * rounding } else { 0.0 }
    }
}

impl ContactSides {
    /// Normal force in newtons that rounding of places makes.
    pub(super) fn noise(&self, law: &PairLaw, bodies: &Bodies) -> f64 {
        let place = bodies.position[self.b.body] + self.b.arm;
        UNITS * f64::EPSILON * place.abs().max_element() * law.stiffness
    }

    /// The error in metres of the overlap by rounding of places. Sides that a joint leads along each other meet by it, wherever they
    /// are. So the parts of a place count, which may cancel.
    pub(super) fn rounding(&self, bodies: &Bodies) -> f64 {
        let place = bodies.position[self.b.body].abs() + self.b.arm.abs();
        UNITS * f64::EPSILON * place.max_element()
    }

    /// `force` acts on side B, the opposite on side A, where they touch.
    #[inline]
    pub(super) fn push(&self, sink: &mut Sink, law: &PairLaw, overlap: f64, force: DVec2) {
        match &self.a {
            SideA::Atom(other) | SideA::Hull(other) => {
                sink.between((other, &self.b), self.normal, overlap, law.shares(), force)
            }
            SideA::Wall(wall) => {
                sink.wall_pushes(&self.b, *wall, self.normal, self.b.radius - overlap, force);
            }
        }
    }

    /// Whether the contact parts under no force, and the present accelerations do not turn it within `dt` seconds. Without restitution
    /// parting may take long, and bodies at rest beside it do not wait for it.
    pub(super) fn parts_freely(&self, contact: &Contact, bodies: &Bodies, parting: f64, dt: f64) -> bool {
        let acts = contact.normal_force != 0.0 || contact.mode != Mode::Unloading;
        !acts && parting > 2.0 * dt * self.relative_acceleration(bodies).abs()
    }

    /// Acceleration of side B along the normal, seen from side A, in m/s2.
    fn relative_acceleration(&self, bodies: &Bodies) -> f64 {
        let acceleration = |body: usize| bodies.force[body] * bodies.inverse_mass(body);
        let other = self.other_body().map_or(DVec2::ZERO, acceleration);
        (acceleration(self.b.body) - other).dot(self.normal)
    }

    /// Whether a contact that is not held could stop within `dt` seconds. It could if a force within the bounds of its law can
    /// reverse its normal velocity. Neighbours may do as much again at the same time.
    pub(super) fn could_stop<N: NormalForce>(
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
        let other = self.other_body();
        let inverse_mass = bodies.inverse_mass(self.b.body) + other.map_or(0.0, |body| bodies.inverse_mass(body));
        let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
        parting.abs() <= 2.0 * dt * (self.relative_acceleration(bodies).abs() + (greatest - least) * inverse_mass)
    }
}
