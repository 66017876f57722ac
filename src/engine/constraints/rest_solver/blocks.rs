//! The contacts of an island as a structure of arrays, in blocks of eight: sweeps read and write them.

use glam::DVec2;
use jostle_simd::{BLOCK, Quad, QuadPairs};

use super::contact_direction::{Mover, Row, Sides};
use super::level_schedule::LevelSchedule;
use super::rest_contact::{CoulombSpring, RestContact};

/// Greatest factor of over-relaxation where a normal force gives a tangential velocity, and the other way round. Coulomb's law
/// makes the equations unsymmetric there. With greater factors the sweeps may oscillate.
const COUPLED: f64 = 1.2;

/// A coupling below this share of the mobilities is rounding.
const ROUND: f64 = 1e-9;

pub(super) type Eight = [f64; BLOCK];

/// Eight normal forces. Lanes without a contact are zero.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Normals {
    pub normal: [Eight; 2],
    /// Levers of the normal on both sides, in metres.
    pub levers: [Eight; 2],
    /// Levers of the tangent on both sides, in metres.
    pub tangent_levers: [Eight; 2],
    /// In 1/(kg m2).
    pub inverse_inertia: [Eight; 2],
    /// Force in newtons that takes away one m/s within the tick.
    pub gain: Eight,
    /// Factor of each correction.
    pub relaxation: Eight,
    /// Least and greatest force in newtons.
    pub band: [Eight; 2],
    /// In newtons.
    pub force: Eight,
    /// A bit for each force that stands at a bound. Such a force would have to leave its band to stop the contact.
    pub at_limit: u8,
    /// The number of lanes with a contact, which are the first ones.
    pub count: u8,
}

/// Eight springs with a Coulomb limit.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Springs {
    /// Force in newtons that takes away one m/s within the tick; torque and rad/s for rolling.
    pub gain: Eight,
    /// Share of the normal force beyond which the spring gives way.
    pub gives: Eight,
    /// Share of the normal force that the spring has then.
    pub slips: Eight,
    /// The force of a spring that is not engaged.
    pub drawn: Eight,
    pub force: Eight,
    /// A bit for each spring that may hold in the tick to come. The others keep their forces.
    pub engaged: u8,
    /// A bit for each force that would have to exceed its limit to stop the contact. A comparison of the force with the limit would
    /// depend on rounding.
    pub at_limit: u8,
}

impl Springs {
    fn put(&mut self, lane: usize, gain: f64, spring: &CoulombSpring, engaged: bool) {
        self.gain[lane] = gain;
        (self.gives[lane], self.slips[lane]) =
            if engaged { (spring.limit, spring.limit) } else { (spring.gives, spring.slips) };
        (self.drawn[lane], self.force[lane]) = (spring.force, spring.force);
        self.engaged |= u8::from(engaged) << lane;
    }

    pub fn is_engaged(&self, lane: usize) -> bool {
        (self.engaged >> lane) & 1 != 0
    }

    pub fn is_free(&self, lane: usize) -> bool {
        ((self.engaged & !self.at_limit) >> lane) & 1 != 0
    }

    pub fn note_limit(&mut self, lane: usize, at_limit: bool) {
        self.at_limit = self.at_limit & !(1 << lane) | u8::from(at_limit) << lane;
    }
}

/// The contacts of an island in blocks.
#[derive(Debug, Default)]
pub(super) struct Blocks {
    schedule: LevelSchedule,
    pub pairs: QuadPairs,
    pub normals: Vec<Normals>,
    pub tangential: Vec<Springs>,
    /// Torques against rolling; empty where there are none.
    pub rolling: Vec<Springs>,
    /// For each contact eight times its block, and its lane.
    pub indices: Vec<usize>,
    /// The velocities of movers, and of copies of the one that never moves: both axes, spin, and 1/mass.
    pub quads: Vec<Quad>,
    /// For each mover the greatest tangential force and the greatest rolling torque of all its contacts.
    grips: Vec<[f64; 2]>,
}

impl Blocks {
    /// Takes up contacts for the `dt` seconds to come. `over`: the factor of over-relaxation.
    pub fn set_up(&mut self, contact: &[RestContact], movers: &[Mover], over: f64, dt: f64) {
        self.grip(contact, movers.len());
        let Self { schedule, pairs, normals, tangential, rolling, indices, grips, .. } = self;
        schedule.begin(movers.len());
        indices.clear();
        indices.extend(contact.iter().map(|contact| schedule.put(contact.ends, movers)));
        pairs.clear();
        schedule.blocks.iter().for_each(|block| pairs.push(*block));
        let rolls = contact.iter().any(|contact| contact.rolling.acts());
        let count = schedule.blocks.len();
        normals.resize(count, Normals::default());
        tangential.resize(count, Springs::default());
        rolling.resize(if rolls { count } else { 0 }, Springs::default());
        // All lanes of a full block are overwritten. In other blocks the lanes without a contact must be zero.
        for block in 0..count {
            let full = schedule.count(block) == BLOCK;
            if !full {
                normals[block] = Normals::default();
            }
            normals[block].count = schedule.count(block) as u8;
            for springs in [Some(&mut tangential[block]), rolling.get_mut(block)].into_iter().flatten() {
                if full {
                    springs.engaged = 0;
                } else {
                    *springs = Springs::default();
                }
            }
        }
        for (contact, &index) in contact.iter().zip(&*indices) {
            let (block, lane) = (index / BLOCK, index % BLOCK);
            let sides = Sides::of(movers, contact.ends);
            let rows = Rows::of(contact, &sides);
            let grips = (grips[contact.ends.0], grips[contact.ends.1]);
            let engaged = |kind: usize, row: &Row, spring: &CoulombSpring| {
                // The force may go from one limit to the other, and neighbours may do as much again. A faster contact slides on.
                let (of_a, of_b) = row.mobilities(&sides);
                let reach = 4.0 * (grips.0[kind] * of_a + grips.1[kind] * of_b) * dt;
                let may = contact.engaged || spring.phase.is_rigid() || spring.force == 0.0;
                may && spring.limit > 0.0 && row.velocity(&sides).abs() <= reach
            };
            normals[block].put(lane, contact, &rows, &sides, over, dt);
            let tangent_gain = 1.0 / (rows.tangent.mobility * dt);
            let holds = engaged(0, &rows.tangent, &contact.tangential);
            tangential[block].put(lane, tangent_gain, &contact.tangential, holds);
            if rolls {
                let holds = engaged(1, &rows.turn, &contact.rolling);
                rolling[block].put(lane, 1.0 / (rows.turn.mobility * dt), &contact.rolling, holds);
            }
        }
    }

    /// Sums the tangential forces and rolling torques that the contacts of each mover can hold.
    fn grip(&mut self, contact: &[RestContact], movers: usize) {
        self.grips.clear();
        self.grips.resize(movers, [0.0; 2]);
        for RestContact { ends, band, tangential, rolling, .. } in contact {
            for index in [ends.0, ends.1] {
                self.grips[index][0] += tangential.limit * band.1;
                self.grips[index][1] += rolling.limit * band.1;
            }
        }
    }

    /// Copies the velocities of movers into the quads.
    pub fn enter(&mut self, movers: &[Mover]) {
        self.quads.clear();
        let quad = |mover: &Mover| Quad([mover.velocity.x, mover.velocity.y, mover.spin, mover.inverse_mass]);
        self.quads.extend(movers.iter().map(quad));
        self.quads.resize(self.schedule.movers(), quad(&movers[0]));
    }

    /// Copies the velocities of the quads back to the movers.
    pub fn leave(&self, movers: &mut [Mover]) {
        for (mover, Quad([x, y, spin, _])) in movers.iter_mut().zip(&self.quads) {
            (mover.velocity, mover.spin) = (DVec2::new(*x, *y), *spin);
        }
    }

    /// The springs of a kind: tangential, then rolling ones.
    pub fn springs(&mut self) -> [&mut [Springs]; 2] {
        [&mut self.tangential, &mut self.rolling]
    }
}

impl Normals {
    fn put(&mut self, lane: usize, contact: &RestContact, rows: &Rows, sides: &Sides, over: f64, dt: f64) {
        let Rows { normal, tangent, .. } = rows;
        let coupled = tangent.coupling(normal, sides).abs() > ROUND * normal.mobility.min(tangent.mobility);
        let both = |list: &mut [Eight; 2], [a, b]: [f64; 2]| (list[0][lane], list[1][lane]) = (a, b);
        both(&mut self.normal, contact.normal.to_array());
        both(&mut self.levers, normal.levers());
        both(&mut self.tangent_levers, tangent.levers());
        both(&mut self.inverse_inertia, [sides.a.inverse_inertia, sides.b.inverse_inertia]);
        let (least, greatest) = contact.band;
        both(&mut self.band, [least, greatest]);
        // If overlaps have become infinite, the bounds are NaN. Then the force is NaN too, which ends the run.
        self.gain[lane] = if least <= greatest { 1.0 / (normal.mobility * dt) } else { f64::NAN };
        self.relaxation[lane] = if coupled { over.min(COUPLED) } else { over };
        self.force[lane] = contact.normal_force;
    }
}

/// The rows of a contact.
pub(super) struct Rows {
    pub normal: Row,
    pub tangent: Row,
    pub turn: Row,
}

impl Rows {
    #[inline(always)]
    pub fn of(contact: &RestContact, sides: &Sides) -> Self {
        let along = |direction: DVec2| {
            let levers = (contact.arms.0.perp_dot(direction), contact.arms.1.perp_dot(direction));
            Row::new(sides, levers, direction)
        };
        Self {
            normal: along(contact.normal),
            tangent: along(-contact.normal.perp()),
            turn: Row::new(sides, (-1.0, -1.0), DVec2::ZERO),
        }
    }
}
