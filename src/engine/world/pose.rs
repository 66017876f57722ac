//! What happens to each body before forces are summed: their sums begin anew, and atoms stand where their bodies are.

use glam::DVec2;

use super::part::{Part, PerBody};
use jostle_simd::{BLOCK, Lanes, Vectors};

/// Clears forces, to the weight of each body that is not asleep where there is a field, and puts atoms where their bodies are.
#[derive(Clone)]
pub(super) struct Pose {
    field: Option<DVec2>,
    sums: Sums,
}

/// Partial sums.
#[derive(Clone, Default)]
struct Sums {
    mass: [f64; BLOCK],
    /// Of mass times place.
    moment: [DVec2; BLOCK],
}

impl Pose {
    pub fn new(field: Option<DVec2>) -> Self {
        Self { field, sums: Sums::default() }
    }

    /// Adds what was weighed: the mass, and mass times place.
    pub fn add_to(&self, (mass, moment): &mut (f64, DVec2)) {
        *mass += self.sums.mass.into_iter().fold(0.0, |sum, part| sum + part);
        *moment += self.sums.moment.into_iter().fold(DVec2::ZERO, |sum, part| sum + part);
    }

    /// The forces alone, of bodies that stand at these places; those that move by forces may have a weight.
    #[inline(always)]
    pub fn forces<V: Lanes>(&mut self, part: &mut Part, first: usize, place: Vectors<V>, mut moves: V::Mask) {
        let zero = V::splat(0.0);
        zero.store(&mut part.torque[first..]);
        let none = Vectors::of(zero, zero);
        let Some(field) = self.field else { return none.store(&mut part.force[first..]) };
        let lane = first % BLOCK;
        if let Some(asleep) = part.asleep.get(first / BLOCK) {
            moves = moves & V::mask(!asleep >> lane);
        }
        let mass = V::load(&part.mass[first..]).only(moves);
        let field = Vectors::of(V::splat(field.x), V::splat(field.y));
        (none + field * mass).store(&mut part.force[first..]);
        let Sums { mass: of_mass, moment } = &mut self.sums;
        (V::load(&of_mass[lane..]) + mass).store(&mut of_mass[lane..]);
        (Vectors::load(&moment[lane..]) + place * mass).store(&mut moment[lane..]);
    }
}

impl PerBody for Pose {
    #[inline(always)]
    fn bodies<V: Lanes>(&mut self, part: &mut Part, first: usize) {
        let (place, moves) = (Vectors::<V>::load(&part.position[first..]), part.moving::<V>(first));
        self.forces(part, first, place, moves);
    }

    #[inline(always)]
    fn atoms<V: Lanes>(&mut self, part: &mut Part, body: usize) {
        if !part.lone_discs {
            part.place_atoms::<V>(body);
        }
    }
}
