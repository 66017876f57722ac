//! A gate: the line between two places, and which bodies cross it from look to look.
//!
//! A body passes if its centre of mass crosses the line on its way from look to look. The way is the cubic polynomial through both
//! places with both velocities (Hermite interpolation). It is exact for a parabola, and off by `h^4/384` times the fourth
//! derivative otherwise. So a body that goes there and back between two looks passes twice. Left is the left hand of a walk from
//! the first place to the second.

use bevy_ecs::prelude::*;
use glam::DVec2;

use crate::scene::units::LengthPair;
use crate::scene::{Diagnostics, exact};
use crate::tick::{State, index_of};
use crate::world::between::{MotionSample, position_between};

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
        let message = format!("the ends of a gate must differ, got ({}, {}) for both", exact(to.x), exact(to.y));
        report.error("gate", message).help("for example `gate: ((-0.1, 0), (0.1, 0))`");
    }
}

impl Gate {
    /// A gate between two places for some bodies.
    pub fn new((from, to): (LengthPair, LengthPair), of: Vec<Entity>) -> Self {
        Self { from: from.si(), to: to.si(), of }
    }

    /// The passages since the last look, in the order of the bodies.
    pub fn passages(&self, before: &mut LastLook, world: &World) -> Vec<Passage> {
        let state = world.resource::<State>();
        let (bodies, time) = (state.bodies(), state.clock().time());
        let indices: Vec<Option<usize>> = self.of.iter().map(|body| index_of(world, *body)).collect();
        let now = indices.iter().map(|index| index.map(|index| MotionSample::of(bodies, index, time))).collect();
        let before = std::mem::replace(before, now);
        let passages = before.iter().zip(&indices).filter_map(|(before, index)| {
            let (before, body) = (*before).zip(*index)?;
            let way = Way { before, after: MotionSample::of(bodies, body, time) };
            Some(self.crossings(&way).into_iter().map(move |is_left| Passage { body, is_left }))
        });
        passages.flatten().collect()
    }

    /// For each crossing of a way with the gate, in order, whether it goes to the left.
    fn crossings(&self, way: &Way) -> Vec<bool> {
        let along = self.to - self.from;
        let [first, second, third, last] = way.controls().map(|at| along.perp_dot(at - self.from));
        // The curve lies within the hull of its control points.
        if [second, third, last].iter().all(|side| (*side < 0.0) == (first < 0.0)) {
            return Vec::new();
        }
        let side = |share: f64| along.perp_dot(way.at(share) - self.from);
        let [a, b, c] = [second - first, third - second, last - third];
        // Turns of the distance from the line: a nearer one than places are rounded by is none.
        let rounding = 8.0 * f64::EPSILON * along.length() * (self.from.length() + way.size());
        let turns = roots(a - 2.0 * b + c, 2.0 * (b - a), a).into_iter().flatten();
        let turns = turns.filter(|share| (0.0..1.0).contains(share) && side(*share).abs() > rounding);
        let mut pieces: Vec<(f64, f64)> = std::iter::once((0.0, first)).collect();
        pieces.extend(turns.map(|share| (share, side(share))));
        pieces.push((1.0, last));
        let crossing = |pair: &[(f64, f64)]| {
            let ((low, from), (high, to)) = (pair[0], pair[1]);
            if (from < 0.0) == (to < 0.0) {
                return None;
            }
            let at = way.at(root(low, high, |share| (side(share) < 0.0) == (from < 0.0)));
            (0.0..=along.length_squared()).contains(&(at - self.from).dot(along)).then_some(to >= 0.0)
        };
        pieces.windows(2).filter_map(crossing).collect()
    }
}

/// The bodies of a gate at the last look.
pub(super) type LastLook = Vec<Option<MotionSample>>;

/// The way of a body from look to look.
struct Way {
    before: MotionSample,
    after: MotionSample,
}

impl Way {
    /// The control points of its curve (Bezier): the ends, and a third of the time beside them.
    fn controls(&self) -> [DVec2; 4] {
        let (before, after, third) = (self.before, self.after, (self.after.time - self.before.time) / 3.0);
        let (leaves, arrives) = (before.velocity * third, after.velocity * third);
        [before.position, before.position + leaves, after.position - arrives, after.position]
    }

    /// The place after a share of the time.
    fn at(&self, share: f64) -> DVec2 {
        let Self { before, after } = self;
        position_between(before, after, before.time + (after.time - before.time) * share)
    }

    /// The distance from the origin in m to which rounding is relative.
    fn size(&self) -> f64 {
        self.before.position.length().max(self.after.position.length())
    }
}

/// The real roots of `a x^2 + b x + c` in ascending order, without cancellation.
fn roots(a: f64, b: f64, c: f64) -> [Option<f64>; 2] {
    let inside = b * b - 4.0 * a * c;
    if inside < 0.0 {
        return [None; 2];
    }
    let q = -0.5 * (b + inside.sqrt().copysign(b));
    let mut found = [q / a, c / q];
    found.sort_unstable_by(f64::total_cmp);
    found.map(|root| root.is_finite().then_some(root))
}

/// The place at which a condition that holds at `low` ceases to hold before `high`, by bisection.
fn root(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if holds(middle) { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gate() -> Gate {
        Gate { from: DVec2::new(1.0, 0.0), to: DVec2::new(-1.0, 0.0), of: Vec::new() }
    }

    fn thrown(height: f64, up: f64, time: f64) -> Way {
        let at = |time: f64| MotionSample {
            time,
            position: DVec2::new(0.0, height + up * time - 5.0 * time * time),
            velocity: DVec2::new(0.0, up - 10.0 * time),
            ..MotionSample::default()
        };
        Way { before: at(0.0), after: at(time) }
    }

    /// Law: a body thrown up with v from a depth h rises `v^2/(2 g)`. Above h it passes the gate twice, below never.
    #[test]
    fn a_body_that_turns_between_two_looks_passes_twice() {
        assert_eq!(gate().crossings(&thrown(-0.19, 2.0, 0.4)), [false, true]);
        assert!(gate().crossings(&thrown(-0.21, 2.0, 0.4)).is_empty());
        assert_eq!(gate().crossings(&thrown(-0.19, 2.0, 0.2)), [false]);
        assert_eq!(gate().crossings(&thrown(0.1, -1.0, 0.3)), [true]);
    }

    /// A body at rest on the line passes nothing, whatever rounding makes of its velocity.
    #[test]
    fn rest_on_the_line_passes_nothing() {
        for speed in [0.0, 1e-17, -1e-17] {
            let at = |time: f64, speed: f64| MotionSample {
                time,
                position: DVec2::new(0.3, 0.0),
                velocity: DVec2::new(0.0, speed),
                ..MotionSample::default()
            };
            let way = Way { before: at(0.0, speed), after: at(0.01, -speed) };
            assert!(gate().crossings(&way).is_empty(), "{speed}");
        }
    }

    /// Beside its ends there is no gate.
    #[test]
    fn ways_beside_the_ends_pass_nothing() {
        let mut way = thrown(-0.19, 2.0, 0.4);
        (way.before.position.x, way.after.position.x) = (1.1, 1.1);
        assert!(gate().crossings(&way).is_empty());
    }
}
