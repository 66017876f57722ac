//! Contacts at rest whose forces statics does not determine. An island at rest takes those forces that balance the loads and are
//! nearest to the springs of its contacts. So does [`crate::constraints`] in stages of steps. The card names the contacts whose
//! normal forces have a band.
//!
//! The nearest forces are `f = s + D^2 A^T y`. Here `s` are the forces of the springs, `D` the measures of the contacts, and `A` their
//! rows. `A D^2 A^T y` is what the springs' forces lack. That is the static displacement of a network of springs with stiffnesses
//! `D^2` ([`crate::constraints::spring_network`]).

use super::contact::Contact;
use super::pair_law::PairLaw;
use crate::constraints::rest_solver::{Mover, RestContact};
use crate::constraints::spring_network::{self, NetworkEnd, NetworkSpring, Twist};
use glam::DVec2;

/// Forces that are nearer to each other than this share of a measure are the same. The search for rest leaves as much.
const SAME: f64 = 1e-9;

/// Rounds in which forces beyond their bounds are put onto them, and the others are found again.
const ROUNDS: usize = 8;

/// Products with the rows of an island, each counted once for each row.
const WORK: usize = 1 << 20;

/// One force of a contact of an island at rest.
#[derive(Clone, Copy, Debug)]
struct Unknown {
    row: NetworkSpring,
    present: f64,
    natural: f64,
    measure: f64,
    /// A force on its bound stays there.
    fixed: Option<f64>,
}

impl Unknown {
    fn force(&self, displacements: &[Twist]) -> f64 {
        self.fixed.unwrap_or_else(|| self.natural + self.measure * self.measure * self.row.elongation(displacements))
    }
}

/// The forces of a contact: normal, tangential, and against rolling.
pub(super) type Forces = [f64; 3];

/// A contact of an island at rest.
pub(super) struct Resting<'a> {
    /// As the search for rest sees it.
    pub seen: &'a RestContact,
    pub contact: Contact,
    pub law: PairLaw,
    /// The force of the undisturbed rolling spring.
    pub rolling: f64,
    /// The forces that were found for it.
    pub found: Forces,
}

/// The forces nearest to those of the springs that balance the same loads. `None` if the forces found are these up to rounding, or
/// none of the nearest forces is within the bounds.
pub(super) fn nearest(contacts: &[Resting], movers: &[Mover]) -> Option<Vec<Forces>> {
    let mut unknowns: Vec<[Option<Unknown>; 3]> = contacts.iter().map(|contact| contact.unknowns(movers)).collect();
    let mut work = WORK;
    for _ in 0..ROUNDS {
        let mut lacking = vec![Twist::default(); movers.len()];
        let mut rows = Vec::new();
        for unknown in unknowns.iter().flatten().flatten() {
            let from = unknown.fixed.unwrap_or(unknown.natural);
            for end in unknown.row.ends.iter().flatten() {
                lacking[end.body] = lacking[end.body].plus(end.row, unknown.present - from);
            }
            if unknown.fixed.is_none() {
                rows.push(NetworkSpring { stiffness: unknown.measure * unknown.measure, ..unknown.row });
            }
        }
        let found = spring_network::solve(&rows, &lacking, &mut work).ok()?;
        let mut beyond = false;
        for (unknowns, contact) in unknowns.iter_mut().zip(contacts) {
            beyond |= contact.bound(unknowns, &found);
        }
        if beyond {
            continue;
        }
        let forces = |unknowns: &[Option<Unknown>; 3]| unknowns.map(|unknown| unknown.map_or(0.0, |u| u.force(&found)));
        let differs = |unknown: &Unknown| (unknown.force(&found) - unknown.present).abs() > SAME * unknown.measure;
        let some = unknowns.iter().flatten().flatten().any(differs);
        return some.then(|| unknowns.iter().map(forces).collect());
    }
    None
}

impl Resting<'_> {
    fn unknowns(&self, movers: &[Mover]) -> [Option<Unknown>; 3] {
        let Self { seen, contact, law, rolling, found } = self;
        let spring = law.stiffness * contact.overlap;
        let tangent = -seen.normal.perp();
        let drawn = law.tangential_stiffness * contact.tangential.elongation;
        let rows = [
            (along(seen, movers, seen.normal), spring, spring),
            (along(seen, movers, tangent), drawn, seen.tangential.limit * spring),
            (turning(seen, movers), *rolling, seen.rolling.limit * spring),
        ];
        let mut kind = 0;
        rows.map(|(row, natural, measure)| {
            kind += 1;
            let present = found[kind - 1];
            (measure > 0.0).then_some(Unknown { row, present, natural, measure, fixed: None })
        })
    }

    /// Puts forces that are beyond their bounds onto them. Returns whether there were any.
    fn bound(&self, unknowns: &mut [Option<Unknown>; 3], found: &[Twist]) -> bool {
        let mut beyond = false;
        let mut put = |unknown: &mut Unknown, least: f64, greatest: f64| {
            let force = unknown.force(found);
            let slack = SAME * unknown.measure;
            if unknown.fixed.is_none() && !(least - slack..=greatest + slack).contains(&force) {
                unknown.fixed = Some(if force < least { least } else { greatest });
                beyond = true;
            }
        };
        let mut normal = 0.0;
        if let Some(unknown) = &mut unknowns[0] {
            put(unknown, self.seen.band.0, self.seen.band.1);
            normal = unknown.force(found);
        }
        for (unknown, limit) in unknowns[1..].iter_mut().zip([self.seen.tangential.limit, self.seen.rolling.limit]) {
            if let Some(unknown) = unknown {
                put(unknown, -limit * normal, limit * normal);
            }
        }
        beyond
    }
}

/// The row of a direction: a force along it acts on side B, and its opposite on side A.
fn along(seen: &RestContact, movers: &[Mover], direction: DVec2) -> NetworkSpring {
    let end = |(mover, arm): (usize, DVec2), sign: f64| {
        let row = Twist { linear: direction * sign, angular: sign * arm.perp_dot(direction) };
        moves(&movers[mover]).then_some(NetworkEnd { body: mover, row })
    };
    let ends = [end((seen.ends.0, seen.arms.0), -1.0), end((seen.ends.1, seen.arms.1), 1.0)];
    NetworkSpring { ends, stiffness: 0.0 }
}

/// The row of a torque against the turn of side B.
fn turning(seen: &RestContact, movers: &[Mover]) -> NetworkSpring {
    let end = |mover: usize, sign: f64| {
        let row = Twist { linear: DVec2::ZERO, angular: sign };
        moves(&movers[mover]).then_some(NetworkEnd { body: mover, row })
    };
    NetworkSpring { ends: [end(seen.ends.0, 1.0), end(seen.ends.1, -1.0)], stiffness: 0.0 }
}

fn moves(mover: &Mover) -> bool {
    mover.inverse_mass > 0.0 || mover.inverse_inertia > 0.0
}
