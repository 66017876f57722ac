//! Which forces keep touching bodies at rest: the contact laws are set-valued where a contact does not move.
//!
//! Normal force `N` within the band of the normal law (`[1 - mu_e, 1 + mu_e] k d`), tangential force `|T| <= mu N`,
//! rolling torque `|M| <= mu_r R N`. For the tick to come each contact that could stop gets the force that makes its
//! velocity zero at the end, or the bound that is nearest (the implicit discretisation of dry friction: Moreau 1988;
//! Acary and Brogliato 2008, chapter 1). There is no threshold: a velocity is taken away where the bounds of the law
//! suffice to do so within the tick, and nowhere else.
//!
//! Solved by projected Gauss-Seidel from the present forces. Where no bound is active the equations are linear: in an
//! island that may come to rest conjugate gradients bring the velocities down by a factor each tick, whatever the ratio
//! of masses, and after a few ticks to rounding. Rows of joints are among them: their forces have no bounds.

mod candidate;
mod frame;
mod gradients;
mod row;
mod tie;

use gradients::Gradients;

pub use candidate::{Candidate, Drawn, Friction, Seen, Verdict};
pub use frame::Frame;
pub use row::Mover;
pub use tie::{Tie, TieSide};

/// Sweeps of Gauss-Seidel per tick. What is left over is taken up in the next tick, from where this one ended.
const SWEEPS: usize = 10;

/// How often conjugate gradients and sweeps take turns to find the bounds that are active.
const ROUNDS: usize = 2;

/// A share of a force that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// An island: its contacts and the bodies around them. What memory it has it keeps for the next.
#[derive(Debug, Default)]
pub struct Island {
    /// What does not move by forces, then bodies and belts: velocities at the beginning of the tick.
    pub begin: Vec<Mover>,
    /// The same at its end, under the present forces; after [`Island::solve`] under those found.
    pub movers: Vec<Mover>,
    /// Contacts as they come.
    pub seen: Vec<Seen>,
    /// Contacts under search, in the same order.
    pub candidates: Vec<Candidate>,
    /// Rows of joints.
    pub ties: Vec<Tie>,
    /// For each mover the greatest tangential force and the greatest rolling torque of all its contacts.
    grips: Vec<[f64; 2]>,
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
        let Self { begin, movers, seen, candidates, ties, grips, .. } = self;
        grips.clear();
        grips.resize(movers.len(), [0.0; 2]);
        for Seen { ends, band, tangential, rolling, .. } in &*seen {
            for place in [ends.0, ends.1] {
                grips[place][0] += tangential.limit * band.1;
                grips[place][1] += rolling.limit * band.1;
            }
        }
        candidates.clear();
        candidates.extend(seen.iter().map(|seen| Candidate::new(begin, movers, grips, seen, dt)));
        let greatest = seen.iter().fold(0.0_f64, |most, seen| most.max(seen.band.1));
        ties.iter_mut().for_each(|tie| tie.scale(greatest));
    }

    /// Finds the forces for the `dt` seconds to come. `thorough`: sweeps take turns with conjugate gradients, which is worth it
    /// where nothing in the island has a contact that moves.
    pub fn solve(&mut self, thorough: bool, dt: f64) {
        for _ in 0..if thorough { ROUNDS } else { 1 } {
            for _ in 0..SWEEPS {
                let mut greatest = 0.0_f64;
                for candidate in &mut self.candidates {
                    greatest = greatest.max(candidate.relax(&mut self.movers, dt));
                }
                for tie in &mut self.ties {
                    greatest = greatest.max(tie.relax(&mut self.movers, dt));
                }
                if greatest <= 1e-2 {
                    return;
                }
            }
            if thorough {
                self.gradients.finish((&mut self.candidates, &mut self.ties), &mut self.movers, dt);
            }
        }
        // Forces that stand at a limit without need come off it.
        for candidate in &mut self.candidates {
            candidate.relax(&mut self.movers, dt);
        }
    }

    /// Sums over the contacts and joints of each mover of the force against which its rounding is to be judged, in newtons.
    pub fn loads(&self) -> Vec<f64> {
        let mut loads = vec![0.0; self.movers.len()];
        self.candidates.iter().for_each(|candidate| candidate.load(&mut loads));
        self.ties.iter().for_each(|tie| tie.load(&mut loads));
        loads
    }
}
