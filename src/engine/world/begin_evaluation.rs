//! Preparation of each body before forces are summed: sums are reset, and atoms follow their bodies.

use glam::DVec2;

use super::chunk::{Chunk, PerBody};
use jostle_simd::{BLOCK, Lanes, Vectors};

/// Resets forces to the weight of each awake body (zero without a field), and moves atoms to their bodies.
#[derive(Clone)]
pub(super) struct BeginEvaluation {
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

impl BeginEvaluation {
    pub fn new(field: Option<DVec2>) -> Self {
        Self { field, sums: Sums::default() }
    }

    /// Adds the mass, and mass times position.
    pub fn add_to(&self, (mass, moment): &mut (f64, DVec2)) {
        *mass += self.sums.mass.into_iter().fold(0.0, |sum, part| sum + part);
        *moment += self.sums.moment.into_iter().fold(DVec2::ZERO, |sum, part| sum + part);
    }

    /// The forces alone, of bodies at these positions. Bodies that move by forces may have a weight.
    #[inline(always)]
    pub fn forces<V: Lanes>(&mut self, part: &mut Chunk, first: usize, place: Vectors<V>, mut moves: V::Mask) {
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

impl PerBody for BeginEvaluation {
    #[inline(always)]
    fn bodies<V: Lanes>(&mut self, part: &mut Chunk, first: usize) {
        let (place, moves) = (Vectors::<V>::load(&part.position[first..]), part.moving::<V>(first));
        self.forces(part, first, place, moves);
    }

    #[inline(always)]
    fn atoms<V: Lanes>(&mut self, part: &mut Chunk, body: usize) {
        if !part.lone_discs {
            part.place_atoms::<V>(body);
        }
    }
}
