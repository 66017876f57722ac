//! Bodies that bounce to rest between contacts which face several ways, such as a box in a corner.
//!
//! Statics does not determine how springs and friction share the loads of such a body. The last bounces decide it. They are ever
//! smaller and come ever faster, until several contacts stop at one moment, up to rounding. Rounding then decides which of them
//! holds how. So runs with other steps come to rest at other places, as far apart as the springs give. Without bounces (a restitution
//! of 0) the place is determined. So is that of a body whose contacts stop one after another.

use bevy_ecs::entity::Entity;

use super::normal::{Mode, NormalForce};
use super::switching::View;

/// Normals are parallel if the sine of the angle between them is below this. It tilts a body by less than its springs give.
const PARALLEL: f64 = 1e-6;

/// A body that came to rest in one of several ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wedged {
    /// The body.
    pub body: Entity,
    /// The moment in s at which it came to rest first.
    pub since: f64,
    /// The sum of the overlaps of its contacts at rest in metres, the greatest of all bodies and moments.
    pub gives: f64,
}

impl View<'_> {
    /// Notes the bodies of which several contacts stopped at this event, at `time` seconds.
    pub(super) fn note_wedged<N: NormalForce>(&mut self, time: f64) {
        let mut halted = std::mem::take(&mut self.contacts.turned);
        if !N::SET_VALUED || halted.is_empty() {
            return;
        }
        halted.extend(&self.contacts.stopped);
        halted.sort_unstable();
        halted.dedup();
        let mut bodies: Vec<usize> = halted.iter().flat_map(|&index| self.movable(index as usize)).collect();
        bodies.sort_unstable();
        for several in bodies.chunk_by(|a, b| a == b).filter(|chunk| chunk.len() > 1) {
            let body = several[0];
            let Some(gives) = self.wedges(body) else { continue };
            let known = self.contacts.wedged;
            let (entity, since) = known.map_or((self.bodies.entity[body], time), |known| (known.body, known.since));
            let more = known.is_none_or(|known| gives > known.gives);
            let body = if more { self.bodies.entity[body] } else { entity };
            let gives = known.map_or(gives, |known| gives.max(known.gives));
            self.contacts.wedged = Some(Wedged { body, since, gives });
        }
    }

    /// The sum of the overlaps of the contacts that hold a body, in metres. `None`: they face one way, or have no friction or no
    /// bounces.
    fn wedges(&mut self, body: usize) -> Option<f64> {
        let (mut first, mut gives, mut wedged) = (None, 0.0, false);
        for index in self.touching() {
            if !self.movable(index).any(|other| other == body) {
                continue;
            }
            let geometry = self.look(index);
            let (contact, law) = self.contact(index);
            let held = contact.mode == Mode::Hold && law.friction_static > 0.0 && law.inelasticity < 1.0;
            drop(contact);
            if held {
                let normal = geometry.pair.normal;
                wedged |= first.get_or_insert(normal).perp_dot(normal).abs() > PARALLEL;
                gives += geometry.overlap;
            }
        }
        wedged.then_some(gives)
    }
}
