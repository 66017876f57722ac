//! Which forces keep touching bodies at rest: the contact laws are set-valued where a contact does not move.
//!
//! Normal force `N` within the band of the normal law (`[1 - mu_e, 1 + mu_e] k d`), tangential force `|T| <= mu N`,
//! rolling torque `|M| <= mu_r R N`. For the tick to come each contact that could stop gets the force that makes its
//! velocity zero at the end, or the bound that is nearest (the implicit discretisation of dry friction: Moreau 1988;
//! Acary and Brogliato 2008, chapter 1). There is no threshold: a velocity is taken away where the bounds of the law
//! suffice to do so within the tick, and nowhere else.
//!
//! Solved by projected successive over-relaxation (Cryer 1971) from the present forces. Where no bound is active the equations are
//! linear: in an island that is nearly at rest conjugate gradients bring the velocities down by a factor each tick, whatever
//! the ratio of masses, and after a few ticks to rounding. Rows of joints are among them: their forces have no bounds.

mod blocks;
mod frame;
mod gradients;
mod row;
mod seen;
mod slots;
mod sweep;
mod tie;
mod verdict;

use std::f64::consts::PI;

use jostle_simd::{BLOCK, Level, run};

use blocks::Blocks;
use gradients::Gradients;
use sweep::Sweep;
use verdict::Judged;

pub use frame::Frame;
pub use row::Mover;
pub use seen::{Drawn, Friction, Seen, Verdict};
pub use tie::{Tie, TieSide};

/// Sweeps of over-relaxation per tick. What is left over is taken up in the next tick, from where this one ended.
const SWEEPS: usize = 10;

/// The greatest factor of over-relaxation. With greater ones sweeps as few as these leave much of what they add.
const GREATEST_RELAXATION: f64 = 1.7;

/// Contacts and rows of joints up to which conjugate gradients cost nothing to speak of.
const FEW: usize = 32;

/// Share of what the forces on a body do to its velocity in a tick, up to which it is slow: no bound is in the way of stopping it.
const SLOW: f64 = 1e-4;

/// How often conjugate gradients and sweeps take turns to find the bounds that are active.
const ROUNDS: usize = 2;

/// A share of a force that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// An island: its contacts and the bodies around them. What memory it has it keeps for the next.
#[derive(Debug, Default)]
pub struct Island {
    /// Vector instructions to be used.
    pub level: Level,
    /// What does not move by forces, then bodies and belts: velocities at the beginning of the tick.
    pub begin: Vec<Mover>,
    /// The same at its end, under the present forces; after [`Island::solve`] under those found.
    pub movers: Vec<Mover>,
    /// Contacts as they come.
    pub seen: Vec<Seen>,
    /// Rows of joints.
    pub ties: Vec<Tie>,
    blocks: Blocks,
    gradients: Gradients,
}

impl Island {
    /// Forgets the island of before.
    pub fn clear(&mut self) {
        self.begin.clear();
        self.movers.clear();
        self.seen.clear();
        self.ties.clear();
    }

    /// Sets up what was seen for the `dt` seconds to come.
    pub fn set_up(&mut self, dt: f64) {
        let Self { movers, seen, ties, blocks, .. } = self;
        blocks.set_up(seen, movers, relaxation(seen.len()), dt);
        let greatest = seen.iter().fold(0.0_f64, |most, seen| most.max(seen.band.1));
        ties.iter_mut().for_each(|tie| tie.scale(greatest));
    }

    /// Whether there are so few forces that conjugate gradients cost nothing to speak of.
    pub fn is_small(&self) -> bool {
        self.seen.len() + self.ties.len() <= FEW
    }

    /// Whether no body is faster than a share of what its forces do in `dt` seconds.
    pub fn is_slow(&self, dt: f64) -> bool {
        let loads = self.loads();
        let slow = |(mover, load): (&Mover, &f64)| mover.velocity.length() <= SLOW * load * mover.inverse_mass * dt;
        self.begin.iter().zip(&loads).all(|both| both.0.inverse_mass == 0.0 || slow(both))
    }

    /// Finds the forces for the `dt` seconds to come. `thorough`: sweeps take turns with conjugate gradients, which is worth it
    /// where nothing in the island has a contact that moves.
    pub fn solve(&mut self, thorough: bool, dt: f64) {
        self.blocks.enter(&self.movers);
        for _ in 0..if thorough { ROUNDS } else { 1 } {
            for _ in 0..SWEEPS {
                if !self.sweep(dt) {
                    self.blocks.leave(&mut self.movers);
                    return;
                }
            }
            if thorough {
                let Self { blocks, seen, ties, movers, gradients, .. } = self;
                blocks.leave(movers);
                gradients.finish((blocks, seen, ties), movers, dt);
                blocks.enter(movers);
            }
        }
        // Forces that stand at a limit without need come off it, and short waves that over-relaxation left decay.
        run(self.level, Sweep { blocks: &mut self.blocks, plain: true, dt });
        self.blocks.leave(&mut self.movers);
    }

    /// Relaxes all contacts and joints once. Returns whether that changed a force by more than rounding.
    fn sweep(&mut self, dt: f64) -> bool {
        let mut moved = run(self.level, Sweep { blocks: &mut self.blocks, plain: false, dt });
        if !self.ties.is_empty() {
            self.blocks.leave(&mut self.movers);
            let greatest = self.ties.iter_mut().fold(0.0_f64, |most, tie| most.max(tie.relax(&mut self.movers, dt)));
            moved |= greatest > 1e-2;
            self.blocks.enter(&self.movers);
        }
        moved
    }

    /// What each contact does in the `dt` seconds to come, in their order.
    pub fn verdicts(&self, dt: f64) -> impl Iterator<Item = Verdict> + '_ {
        let Self { blocks, seen, begin, movers, .. } = self;
        let places = seen.iter().zip(&blocks.places);
        places.map(move |(seen, &place)| Judged { blocks, seen, place, movers: [begin, movers], dt }.verdict())
    }

    /// Sums over the contacts and joints of each mover of the force against which its rounding is to be judged, in newtons.
    pub fn loads(&self) -> Vec<f64> {
        let mut loads = vec![0.0; self.movers.len()];
        for (seen, &place) in self.seen.iter().zip(&self.blocks.places) {
            let force = self.blocks.normals[place / BLOCK].force[place % BLOCK];
            for end in [seen.ends.0, seen.ends.1] {
                loads[end] += force + seen.noise / ROUNDING;
            }
        }
        self.ties.iter().for_each(|tie| tie.load(&mut loads));
        loads
    }
}

/// The best factor of over-relaxation for a square patch of so many contacts, of which the longest wave is what sweeps take longest
/// for (Young 1954: `2/(1 + sin(pi/L))` with `L` contacts to a side), as far as few sweeps can use it. Few contacts need none.
fn relaxation(contacts: usize) -> f64 {
    if contacts <= FEW {
        return 1.0;
    }
    (2.0 / (1.0 + PI / (contacts as f64).sqrt())).clamp(1.0, GREATEST_RELAXATION)
}
