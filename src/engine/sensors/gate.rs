//! A gate: the line between two places, and which bodies cross it from tick to tick.
//!
//! A body passes if its centre of mass crosses the line on the straight way from tick to tick. Left is the left hand of a walk
//! from the first place to the second.

use bevy_ecs::prelude::*;
use glam::DVec2;

use crate::scene::Diagnostics;
use crate::scene::units::LengthPair;
use crate::tick::{State, index_of};

/// A gate, and the bodies that are watched.
pub(super) struct Gate {
    from: DVec2,
    to: DVec2,
    of: Vec<Entity>,
}

/// The passage of a body through a gate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Passage {
    /// The index of the body.
    pub body: usize,
    /// Whether it went to the left.
    pub is_left: bool,
}

/// Reports ends that make no gate.
pub(super) fn check(ends: (LengthPair, LengthPair), report: &mut Diagnostics) {
    let (from, to) = (ends.0.si(), ends.1.si());
    let finite = report.finite_pair("gate", from) && report.finite_pair("gate", to);
    if finite && from == to {
        let message = format!("the ends of a gate must differ, got ({}, {}) for both", to.x, to.y);
        report.error("gate", message).help("for example `gate: ((-0.1, 0), (0.1, 0))`");
    }
}

impl Gate {
    /// A gate between two places for some bodies.
    pub fn new((from, to): (LengthPair, LengthPair), of: Vec<Entity>) -> Self {
        Self { from: from.si(), to: to.si(), of }
    }

    /// The passages since the last look, in the order of the bodies. `before` holds where each body was then, in metres.
    pub fn passages(&self, before: &mut Vec<Option<DVec2>>, world: &World) -> Vec<Passage> {
        let bodies = world.resource::<State>().bodies();
        let indices: Vec<Option<usize>> = self.of.iter().map(|body| index_of(world, *body)).collect();
        let now = indices.iter().map(|index| index.map(|index| bodies.position[index])).collect();
        let before = std::mem::replace(before, now);
        let ways = before.iter().zip(&indices);
        let passage = |(before, index): (&Option<DVec2>, &Option<usize>)| {
            let (before, body) = before.zip(*index)?;
            let is_left = self.crossing(before, bodies.position[body])?;
            Some(Passage { body, is_left })
        };
        ways.filter_map(passage).collect()
    }

    /// Whether a way crosses the gate, and if so whether to the left.
    fn crossing(&self, before: DVec2, now: DVec2) -> Option<bool> {
        let along = self.to - self.from;
        let [first, last] = [before, now].map(|at| along.perp_dot(at - self.from));
        if (first < 0.0) == (last < 0.0) {
            return None;
        }
        let crossing = before + (now - before) * (first / (first - last));
        let within = (0.0..=along.length_squared()).contains(&(crossing - self.from).dot(along));
        within.then_some(last >= 0.0)
    }
}
