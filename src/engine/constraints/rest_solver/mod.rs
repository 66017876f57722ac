//! The rest solver: implicit discretisation of set-valued contact laws (Moreau 1988; Acary and Brogliato 2008, chapter 1).
//!
//! A contact that does not move may have any normal force `N` in the band `[1 - mu_e, 1 + mu_e] k d` of its law. Its tangential
//! force is at most `mu N`, its rolling torque at most `mu_r R N`. For each contact that could stop, the solver finds the force
//! that makes its velocity zero within the tick. If a bound of the law is in the way, the contact gets that bound. There is no
//! threshold of speed: a contact stops if its bounds suffice within the tick, and only then.
//!
//! The equations are solved by projected successive over-relaxation (Cryer 1971) from the present forces. Equations without
//! active bounds are linear. Conjugate gradients solve these in slow islands. They reduce velocities by a factor per tick,
//! whatever the ratio of masses, and reach rounding after a few ticks. Rows of joints take part with forces that have no bounds.

mod blocks;
mod contact_direction;
mod gradients;
mod joint_row;
mod level_schedule;
mod moving_frame;
mod outcome;
mod rest_contact;
mod sweep;

use std::f64::consts::PI;

use jostle_simd::{BLOCK, Level, run};

use blocks::Blocks;
use gradients::Gradients;
use outcome::Found;
use sweep::Sweep;

pub use contact_direction::Mover;
pub use joint_row::{JointRow, JointRowSide};
pub use moving_frame::MovingFrame;
pub use rest_contact::{ContactOutcome, CoulombSpring, FrictionOutcome, RestContact, SpringPhase};

/// Sweeps of over-relaxation per tick. The next tick goes on from the forces where this one ended.
const SWEEPS: usize = 10;

/// The greatest factor of over-relaxation. With greater factors so few sweeps leave short waves behind.
const GREATEST_RELAXATION: f64 = 1.7;

/// Contacts and rows of joints up to which conjugate gradients are cheap at each tick.
const FEW: usize = 32;

/// A body is slow up to this share of the velocity that its forces give it in a tick. No bound prevents it from stopping.
const SLOW: f64 = 1e-4;

/// Turns of sweeps and conjugate gradients that find the active bounds.
const ROUNDS: usize = 2;

/// A share of a force that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// An island: its contacts and the bodies around them. Its memory is kept for the next island.
#[derive(Debug, Default)]
pub struct Island {
    /// Vector instructions to be used.
    pub level: Level,
    /// Velocities at the beginning of the tick. The first is that of the world, then come bodies and belts.
    pub begin: Vec<Mover>,
    /// The same at the end of the tick, under the present forces; after [`Island::solve`] under the forces found.
    pub movers: Vec<Mover>,
    /// Its contacts, in canonical order.
    pub contacts: Vec<RestContact>,
    /// Rows of joints.
    pub joint_rows: Vec<JointRow>,
    blocks: Blocks,
    gradients: Gradients,
    /// The memory of [`Island::loads`].
    loads: Vec<f64>,
}

impl Island {
    /// Forgets the island.
    pub fn clear(&mut self) {
        self.begin.clear();
        self.movers.clear();
        self.contacts.clear();
        self.joint_rows.clear();
    }

    /// Sets up the contacts and rows for the `dt` seconds to come.
    pub fn set_up(&mut self, dt: f64) {
        let Self { movers, contacts, joint_rows, blocks, .. } = self;
        blocks.set_up(contacts, movers, relaxation(contacts.len()), dt);
        let greatest = contacts.iter().fold(0.0_f64, |most, contact| most.max(contact.band.1));
        joint_rows.iter_mut().for_each(|row| row.scale(greatest));
    }

    /// Whether there are so few forces that conjugate gradients are cheap.
    pub fn is_small(&self) -> bool {
        self.contacts.len() + self.joint_rows.len() <= FEW
    }

    /// Whether all bodies are slow beside the velocities that their forces give them in `dt` seconds.
    pub fn is_slow(&mut self, dt: f64) -> bool {
        self.find_loads();
        let slow = |(mover, load): (&Mover, &f64)| mover.velocity.length() <= SLOW * load * mover.inverse_mass * dt;
        self.begin.iter().zip(&self.loads).all(|both| both.0.inverse_mass == 0.0 || slow(both))
    }

    /// Finds the forces for the `dt` seconds to come. `thorough`: sweeps take turns with conjugate gradients, which pays if all
    /// contacts of the island can stop.
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
                let Self { blocks, contacts, joint_rows, movers, gradients, .. } = self;
                blocks.leave(movers);
                gradients.finish((blocks, contacts, joint_rows), movers, dt);
                blocks.enter(movers);
            }
        }
        // A plain sweep takes forces off a limit that they do not need, and damps the short waves of over-relaxation.
        run(self.level, Sweep { blocks: &mut self.blocks, plain: true, dt });
        self.blocks.leave(&mut self.movers);
    }

    /// Relaxes all contacts and joints once. Returns whether that changed a force by more than rounding.
    fn sweep(&mut self, dt: f64) -> bool {
        let mut moved = run(self.level, Sweep { blocks: &mut self.blocks, plain: false, dt });
        if !self.joint_rows.is_empty() {
            self.blocks.leave(&mut self.movers);
            let greatest =
                self.joint_rows.iter_mut().fold(0.0_f64, |most, row| most.max(row.relax(&mut self.movers, dt)));
            moved |= greatest > 1e-2;
            self.blocks.enter(&self.movers);
        }
        moved
    }

    /// The outcome of each contact for the `dt` seconds to come, in their order.
    pub fn outcomes(&self, dt: f64) -> impl Iterator<Item = ContactOutcome> + '_ {
        let Self { blocks, contacts, begin, movers, .. } = self;
        let indices = contacts.iter().zip(&blocks.indices);
        indices.map(move |(contact, &index)| Found { blocks, contact, index, movers: [begin, movers], dt }.outcome())
    }

    /// For each mover the sum of the forces of its contacts and joints in newtons, by [`Island::find_loads`]. Its rounding is judged by
    /// that.
    pub fn loads(&self) -> &[f64] {
        &self.loads
    }

    /// Sums the loads.
    pub fn find_loads(&mut self) {
        let Self { movers, contacts, joint_rows, blocks, loads, .. } = self;
        loads.clear();
        loads.resize(movers.len(), 0.0);
        for (contact, &index) in contacts.iter().zip(&blocks.indices) {
            let force = blocks.normals[index / BLOCK].force[index % BLOCK];
            for end in [contact.ends.0, contact.ends.1] {
                loads[end] += force + contact.noise / ROUNDING;
            }
        }
        joint_rows.iter().for_each(|row| row.load(loads));
    }
}

/// The best factor of over-relaxation for a square patch of contacts, `2/(1 + sin(pi/L))` with `L` contacts to a side (Young
/// 1954). It is limited to factors that few sweeps can use. Few contacts need none.
fn relaxation(contacts: usize) -> f64 {
    if contacts <= FEW {
        return 1.0;
    }
    (2.0 / (1.0 + PI / (contacts as f64).sqrt())).clamp(1.0, GREATEST_RELAXATION)
}
