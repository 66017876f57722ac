//! Blows that break joints. A blow is an impulse without time, so its force at a rigid joint is infinite. It counts as an even force
//! over a time that impacts of hard bodies take ([`BLOW`]).
//!
//! A joint that breaks in a blow gives no impulse: its bodies keep their velocities, and no energy is lost. Of several joints that
//! would break, the one breaks first whose force is the greatest multiple of its bound. The others then take the blow that is left.

use super::blows::Blow;
use super::stabilisation::find_rows;
use super::{EvaluationMode, State};
use crate::constraints::Rows;
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// The time in s that a blow takes at a joint with a break force. Hard bodies of everyday size touch for about as long. By the law of
/// Hertz, a steel ball of 5 cm at 1 m/s touches wood for 1 ms. It also is the longest tick that the engine
/// chooses. So a load that the joint bears in each tick is no blow.
pub const BLOW: f64 = 1e-3;

/// A blow at a joint with a break force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BlowAtJoint {
    /// Impulse in N s.
    pub impulse: f64,
    /// The time in s that it counts as taking.
    pub lasts: f64,
    /// When, in s.
    pub time: f64,
}

impl BlowAtJoint {
    /// The force in N as which it counts.
    pub fn force(&self) -> f64 {
        self.impulse / self.lasts
    }
}

impl State {
    /// Breaks the joints that do not bear the blows of this step. Their own blows fall away.
    pub(super) fn break_joints(&mut self, time: f64, blows: &mut Vec<(usize, Blow)>) {
        let is_jump = |blow: &Blow| !matches!(blow, Blow::Sticks | Blow::Grips);
        while blows.iter().any(|(_, blow)| is_jump(blow))
            && self.models.iter().any(|model| model.break_force().is_some())
        {
            let taken = self.blows_at_joints(time, blows);
            let shares = taken.iter().map(|(joint, blow, most)| (*joint, *blow, blow.force() / most));
            // Of equal ones the first.
            let worst = shares.rev().max_by(|a, b| a.2.total_cmp(&b.2)).filter(|(.., share)| *share > 1.0);
            let Some((joint, blow, _)) = worst else {
                return taken.into_iter().for_each(|(joint, blow, _)| self.models[joint].take_blow(blow, false));
            };
            self.models[joint].take_blow(blow, true);
            blows.retain(|(by, _)| *by != joint);
            self.change_rows();
        }
    }

    /// The blows at all joints with a break force, if all joints hold. Each has the index of the joint, and its break force in N.
    fn blows_at_joints(&mut self, time: f64, blows: &[(usize, Blow)]) -> Vec<(usize, BlowAtJoint, f64)> {
        let (mut rows, mut owners) = (Rows::default(), Vec::new());
        for &index in &self.roles.rows {
            find_rows(&mut self.models, &[index], (&self.bodies, time), &mut rows);
            owners.resize(rows.len(), index);
        }
        let gives_way: Vec<bool> = rows.all().iter().map(|row| row.gives_way()).collect();
        let mut indices = 0..;
        owners.retain(|_| indices.next().is_some_and(|index: usize| !gives_way[index]));
        rows.retain(|row| !row.gives_way());
        for (by, blow) in blows {
            if let Blow::Rebounds(row) = blow {
                rows.add(**row);
                owners.push(*by);
            }
        }
        let all = rows.all().to_vec();
        let before = (self.bodies.velocity.clone(), self.bodies.spin.clone(), self.progress.trouble);
        let impulses = self.push_apart(&mut rows, time).1;
        (self.bodies.velocity, self.bodies.spin, self.progress.trouble) = before;
        let mut sums = vec![DVec2::ZERO; self.models.len()];
        for (index, impulse) in impulses {
            // On body B, or the opposite of that on body A if B is the world.
            let force = match all[index].sides {
                [_, Some(side)] => side.force,
                [Some(side), None] => -side.force,
                [None, None] => DVec2::ZERO,
            };
            sums[owners[index]] += force * impulse;
        }
        // Without located events, a joint may give way for a step. It comes back with the speed that its load gave it there.
        let lasts = if self.evaluation.mode == EvaluationMode::Frozen { BLOW } else { BLOW.max(self.span.length) };
        let bearing = |index: usize| {
            let most = self.models.get(index)?.break_force()?;
            let impulse = sums[index].length();
            Some((index, BlowAtJoint { impulse, lasts, time }, most))
        };
        self.roles.rows.iter().filter_map(|index| bearing(*index)).collect()
    }
}
