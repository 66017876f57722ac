//! What happens to each body before forces are summed: their sums begin anew, and atoms stand where their bodies are.

use glam::DVec2;

use super::part::{Part, PerBody};
use crate::simd::{BLOCK, Lanes};

/// Clears forces, to the weight of each body that is not asleep where there is a field, and puts atoms where their bodies are.
#[derive(Clone)]
pub(super) struct Pose {
    field: Option<DVec2>,
    /// Partial sums of mass, and of mass times place.
    sums: [[f64; BLOCK]; 3],
}

impl Pose {
    pub fn new(field: Option<DVec2>) -> Self {
        Self { field, sums: [[0.0; BLOCK]; 3] }
    }

    /// Adds what was weighed: the mass, and mass times place.
    pub fn add_to(&self, (mass, moment): &mut (f64, DVec2)) {
        let [part, x, y] = self.sums.map(|partial| partial.into_iter().fold(0.0, |sum, part| sum + part));
        *mass += part;
        *moment += DVec2::new(x, y);
    }

    /// The forces alone, of bodies that stand at these places; those that move by forces may have a weight.
    #[inline(always)]
    pub fn forces<V: Lanes>(&mut self, part: &mut Part, first: usize, (x, y): (V, V), mut moves: V::Mask) {
        let zero = V::splat(0.0);
        zero.store(&mut part.torque[first..]);
        let Some(field) = self.field else { return V::store_pairs(zero, zero, &mut part.force[first..]) };
        let lane = first % BLOCK;
        if let Some(asleep) = part.asleep.get(first / BLOCK) {
            moves = moves & V::mask(!asleep >> lane);
        }
        let mass = V::load(&part.mass[first..]).only(moves);
        let weight = (zero + V::splat(field.x) * mass, zero + V::splat(field.y) * mass);
        V::store_pairs(weight.0, weight.1, &mut part.force[first..]);
        let sums = &mut self.sums;
        (V::load(&sums[0][lane..]) + mass).store(&mut sums[0][lane..]);
        (V::load(&sums[1][lane..]) + x * mass).store(&mut sums[1][lane..]);
        (V::load(&sums[2][lane..]) + y * mass).store(&mut sums[2][lane..]);
    }
}

impl PerBody for Pose {
    #[inline(always)]
    fn bodies<V: Lanes>(&mut self, part: &mut Part, first: usize) {
        let (place, moves) = (V::load_pairs(&part.position[first..]), part.moving::<V>(first));
        self.forces(part, first, place, moves);
    }

    #[inline(always)]
    fn atoms<V: Lanes>(&mut self, part: &mut Part, body: usize) {
        if !part.lone_discs {
            part.place_atoms::<V>(body);
        }
    }
}
