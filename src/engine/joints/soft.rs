//! A soft joint: each direction that it holds becomes a damped spring. Stiffness and damping follow from a frequency
//! `f`, a damping ratio `D`, and the effective mass `m` at the start. They are `k = m (2 pi f)^2` and `c = 2 D m 2 pi
//! f`.
//!
//! If two directions hold a point, both have one stiffness, by the mean of both responses. Both forces act at the anchor on body
//! B of the joint. So no direction of the world is preferred, and an open joint makes no angular momentum.

use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::ends::EndPair;
use super::law::{Held, JointLaw};
use crate::constraints::RowKind;
use crate::scene::Diagnostics;
use crate::scene::units::{Rate, Scalar};
use crate::tick::{State, SteadySpring, critical_step};
use crate::world::Bodies;

/// A frequency and a damping ratio, as a scene writes them.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
pub(super) struct Softness(Rate, Scalar);

impl Softness {
    /// In Hz and as a share of critical damping.
    pub fn si(self) -> [f64; 2] {
        [self.0.si(), self.1.si()]
    }

    /// Reports a frequency that is not positive, or a damping ratio below zero.
    pub fn check(softness: Option<Self>, report: &mut Diagnostics) {
        let Some(Self(frequency, ratio)) = softness else { return };
        report.positive("softness[0]", frequency);
        report.not_negative("softness[1]", ratio);
    }
}

/// The springs of a soft joint.
#[derive(Clone, Debug, Default)]
pub struct Soft {
    /// Stiffness and damping of each direction that is held.
    springs: Vec<(f64, f64)>,
    /// The power of the dashpots in the last evaluation, in W.
    pub power: f64,
}

impl Soft {
    /// Springs that swing at a frequency in Hz with a damping ratio, for the current poses of the bodies.
    pub fn new([frequency, ratio]: [f64; 2], law: &dyn JointLaw, pair: &EndPair, bodies: &Bodies) -> Self {
        let angular = std::f64::consts::TAU * frequency;
        let mut responses = Vec::new();
        law.hold(pair, &mut |held: Held| {
            let row = pair.row(&held.along, RowKind::Position);
            responses.push((turns(&held), row.response(&row, bodies)));
        });
        let of_kind = |(turns, _): &(bool, f64)| {
            let alike = || responses.iter().filter(|(other, _)| other == turns).map(|(_, response)| response);
            let mass = alike().count() as f64 / alike().sum::<f64>();
            (mass * angular * angular, 2.0 * ratio * mass * angular)
        };
        Self { springs: responses.iter().map(of_kind).collect(), power: 0.0 }
    }

    /// Shows each direction that is held with its stiffness and its damping.
    fn each(&self, law: &dyn JointLaw, pair: &EndPair, mut see: impl FnMut(Held, f64, f64)) {
        let mut springs = self.springs.iter();
        law.hold(pair, &mut |mut held| {
            if let Some(&(stiffness, damping)) = springs.next() {
                let [(direction, lever), _] = &mut held.along.sides;
                if *direction != DVec2::ZERO {
                    *lever = (pair.b.position - pair.a.position + pair.a.arm).perp_dot(*direction);
                }
                see(held, stiffness, damping);
            }
        });
    }

    /// Energy in J of its springs.
    pub fn energy(&self, law: &dyn JointLaw, pair: &EndPair) -> f64 {
        let mut sum = 0.0;
        self.each(law, pair, |held, stiffness, _| sum += 0.5 * stiffness * held.gap * held.gap);
        sum
    }

    /// Whether its springs are damped.
    pub fn is_damped(&self) -> bool {
        self.springs.iter().any(|(_, damping)| *damping > 0.0)
    }

    /// Adds its springs to a list.
    pub fn stiffness(&self, law: &dyn JointLaw, pair: &EndPair, bodies: &Bodies, list: &mut Vec<SteadySpring>) {
        let side =
            |end: &super::ends::JointEnd| end.body.filter(|body| bodies.dynamic[*body]).map(|body| (body, end.arm));
        let (a, b) = match (side(&pair.a), side(&pair.b)) {
            (a, Some(b)) => (a, b),
            (Some(a), None) => (None, a),
            (None, None) => return,
        };
        self.each(law, pair, |held, stiffness, damping| {
            let normal = held.along.sides[1].0;
            let turns = turns(&held);
            let of = |applies: bool, amount: f64| if applies { amount } else { 0.0 };
            let spring = critical_step::Spring {
                a,
                b,
                normal: if turns { DVec2::X } else { normal.normalize() },
                stiffness: (of(!turns, stiffness), 0.0),
                damped: 0.0,
                turning: of(turns, stiffness),
            };
            list.push(SteadySpring { spring, damping: of(!turns, damping), turning_damping: of(turns, damping) });
        });
    }

    /// Adds its forces. Returns force in N and torque about the anchor in N m on body B.
    pub fn push(&mut self, law: &dyn JointLaw, pair: &EndPair, state: &mut State) -> (DVec2, f64) {
        let (mut power, mut reaction) = (0.0, (DVec2::ZERO, 0.0));
        self.each(law, pair, |held, stiffness, damping| {
            let rate = pair.rate(&held.along);
            let amount = -stiffness * held.gap - damping * rate;
            power += damping * rate * rate;
            // Bodies with prescribed motion give the power that exceeds that of the spring.
            let got = pair.push(&held.along, amount, state);
            state.bodies_and_rates().1.work += got - amount * rate;
            let (direction, lever) = held.along.sides[1];
            reaction.0 += direction * amount;
            reaction.1 += (lever - pair.b.arm.perp_dot(direction)) * amount;
        });
        self.power = power;
        reaction
    }
}

/// Whether a direction that is held is a turn.
fn turns(held: &Held) -> bool {
    held.along.sides[1].0 == DVec2::ZERO
}
