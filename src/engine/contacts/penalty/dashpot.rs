//! Normal law: a spring and a dashpot side by side, `N = max(0, k d - c v_n)` with `v_n` the velocity with which the
//! sides part.
//!
//! The contact never pulls: it ends when the force does, before the overlap is gone (Schwager and Poeschel 2007). Let
//! `m` be the effective mass, `b = c/(2 m)`, `w0^2 = k/m` and `w^2 = w0^2 - b^2`. Then the contact lasts `t = atan2(2 b
//! w, b^2 - w^2)/w`, and the restitution is `e = exp(-b t)`. If it is overdamped, with `W^2 = b^2 - w0^2`, then `t =
//! artanh(2 b W/(b^2 + W^2))/W`. A restitution in the scene is converted to a damping ratio `b/w0` by solving that
//! equation. Codes whose contacts pull until the overlap is gone need another ratio for the same restitution.
//!
//! The damping is that of the ratio for the effective mass of the contact, `c = 2 zeta sqrt(k m)`. So a single contact
//! has the required restitution, also off the centre of a body. A body that lands on n atoms at once rebounds less than
//! from one. With a damping in N s/m its damping ratio is `sqrt(n)` times as large. With a restitution it is at most
//! that, because atoms far from the centre of mass have less damping. If two atoms do not affect each other, `m x^2 =
//! I`, they rebound like one. The card notes the effect.

use super::Penalty;
use super::inelasticity::restitution_of;
use super::normal::{Approach, Change, Mode, NormalForce, lost_work};
use super::pair_law::PairLaw;
use jostle_simd::Lanes;
use serde::{Deserialize, Serialize};

/// The least restitution that is converted; zero would need infinite damping.
pub const LEAST_RESTITUTION: f64 = 0.01;

/// Damping of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Damping<V = f64> {
    /// Share of the critical damping of the contact.
    Ratio(V),
    /// In N s/m.
    Coefficient(V),
    /// Over the effective mass, in 1/s.
    Rate(V),
}

impl<V: Default> Default for Damping<V> {
    /// No damping.
    fn default() -> Self {
        Self::Ratio(V::default())
    }
}

impl Damping {
    /// The number, whatever it is of.
    pub(super) fn number(self) -> f64 {
        match self {
            Self::Ratio(number) | Self::Coefficient(number) | Self::Rate(number) => number,
        }
    }

    /// The same kind of damping with other numbers.
    #[inline(always)]
    pub(super) fn kind<V>(self, numbers: V) -> Damping<V> {
        match self {
            Self::Ratio(_) => Damping::Ratio(numbers),
            Self::Coefficient(_) => Damping::Coefficient(numbers),
            Self::Rate(_) => Damping::Rate(numbers),
        }
    }
}

impl<V> Damping<V> {
    /// Whether it depends on the mobility of the contact.
    #[inline(always)]
    pub(super) fn depends_on_mobility(&self) -> bool {
        !matches!(self, Self::Coefficient(_))
    }
}

/// The law.
pub struct Dashpot;

impl NormalForce for Dashpot {
    const DEPENDS_ON_VELOCITY: bool = true;
    const SET_VALUED: bool = false;

    fn set_up(law: &mut PairLaw, inelasticity: f64, settings: &Penalty) {
        law.damping = match (settings.damping, settings.damping_rate) {
            (Some(damping), _) => Damping::Coefficient(damping.si()),
            (None, Some(rate)) => Damping::Rate(rate.si()),
            (None, None) => Damping::Ratio(ratio_of(restitution_of(inelasticity).max(LEAST_RESTITUTION))),
        };
    }

    #[inline]
    fn chosen(_: Mode, _: f64) -> Mode {
        Mode::Loading
    }

    #[inline(always)]
    fn force<V: Lanes>(law: &PairLaw<V>, _: V, overlap: V, approach: Approach<V>) -> V {
        (law.stiffness * overlap - damping(law, approach.mobility) * approach.parting).at_least_zero()
    }

    /// A contact whose force has vanished before its overlap is slack: unloading, without a force.
    fn smooth_force(law: &PairLaw, mode: Mode, overlap: f64, approach: Approach) -> f64 {
        match mode {
            Mode::Unloading => 0.0,
            _ => law.stiffness * overlap - damping(law, approach.mobility) * approach.parting,
        }
    }

    /// The damping of a ratio is proportional to `1/sqrt(mobility)`, that of a rate to `1/mobility`.
    fn force_rate(law: &PairLaw, mode: Mode, approach: Approach, change: Change) -> f64 {
        if mode == Mode::Unloading {
            return 0.0;
        }
        let damping = damping(law, approach.mobility);
        let thinning = match law.damping {
            Damping::Ratio(_) => 0.5 * change.mobility / approach.mobility,
            Damping::Coefficient(_) => 0.0,
            Damping::Rate(_) => change.mobility / approach.mobility,
        };
        -law.stiffness * approach.parting - damping * (change.parting - thinning * approach.parting)
    }

    /// The contact itself changes the acceleration of its sides, by its mobility times the rate of its force.
    fn force_second_rate(law: &PairLaw, mode: Mode, approach: Approach, change: Change) -> f64 {
        if mode == Mode::Unloading {
            return 0.0;
        }
        let jerk = approach.mobility * Self::force_rate(law, mode, approach, change);
        -law.stiffness * change.parting - damping(law, approach.mobility) * jerk
    }

    fn remaining(mode: Mode, overlap: f64, force: f64) -> (f64, bool) {
        if mode == Mode::Unloading { (overlap, true) } else { (force, false) }
    }

    fn stays(_: &PairLaw, mode: Mode, _: (f64, f64), loading: f64) -> Option<(f64, f64)> {
        (mode == Mode::Unloading).then_some((-loading, f64::NAN))
    }

    fn after(mode: Mode, parted: bool) -> Mode {
        match (mode, parted) {
            (Mode::Unloading, true) => Mode::Open,
            (Mode::Unloading, false) => Mode::Loading,
            _ => Mode::Unloading,
        }
    }

    /// The force has one value at rest: that of the spring.
    fn band(_: &PairLaw, _: f64, present: f64) -> (f64, f64) {
        (present, present)
    }

    #[inline(always)]
    fn loss<V: Lanes>(law: &PairLaw<V>, _: V, before: (V, V), after: (V, V)) -> V {
        lost_work(law, before, after)
    }

    fn response(law: &PairLaw, mobility: f64) -> (f64, f64) {
        (law.stiffness, damping(law, mobility))
    }

    fn dissipates(law: &PairLaw) -> bool {
        law.damping.number() > 0.0
    }
}

/// In N s/m, for a contact with this mobility in 1/kg.
#[inline(always)]
fn damping<V: Lanes>(law: &PairLaw<V>, mobility: V) -> V {
    match law.damping {
        Damping::Ratio(ratio) => V::splat(2.0) * ratio * (law.stiffness / mobility).sqrt(),
        Damping::Coefficient(damping) => damping,
        Damping::Rate(rate) => rate / mobility,
    }
}

/// Restitution of a single contact without other loads, for a damping ratio.
pub fn restitution(ratio: f64) -> f64 {
    // In units of 1/w0.
    let squared = 1.0 - ratio * ratio;
    let root = squared.abs().sqrt();
    let duration = if squared > 0.0 {
        libm::atan2(2.0 * ratio * root, ratio * ratio - squared) / root
    } else if squared < 0.0 {
        libm::atanh(2.0 * ratio * root / (ratio * ratio + root * root)) / root
    } else {
        2.0
    };
    libm::exp(-ratio * duration)
}

/// The damping ratio that gives a restitution from [`LEAST_RESTITUTION`] to 1.
pub fn ratio_of(wanted: f64) -> f64 {
    let (mut low, mut high) = (0.0, 10.0);
    // The restitution falls as the ratio grows; bisection ends where floating-point numbers do.
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return low;
        }
        if restitution(middle) > wanted { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn restitution_of_a_contact_that_does_not_pull() {
        // Two discs of mass pi/4 with k = 1e5 and b = 100, and an overdamped contact. The values come from
        // event-located integration of the law to 1e-12, printed to ten and seven digits.
        let ratio = 100.0 / (1e5 / (std::f64::consts::PI / 8.0)).sqrt();
        assert!((restitution(ratio) - 0.574_364_374_5).abs() < 1e-9);
        assert!((restitution(1.5) - 0.075_588_3).abs() < 1e-7);
        // Critical damping: the limit exp(-2) of both branches.
        for near in [1.0 - 1e-9, 1.0, 1.0 + 1e-9] {
            assert!((restitution(near) - libm::exp(-2.0)).abs() < 1e-8);
        }
    }

    #[test]
    fn a_restitution_is_converted_by_the_rule_that_ends_the_contact() {
        assert!((ratio_of(0.9) - 0.034_265_20).abs() < 1e-8);
        assert!((ratio_of(0.5) - 0.255_275_64).abs() < 1e-8);
        for wanted in [LEAST_RESTITUTION, 0.05, 0.3, 0.7, 0.99, 1.0] {
            // A bisection to the last bit: only rounding of the restitution remains.
            assert!((restitution(ratio_of(wanted)) - wanted).abs() < 1e-14);
        }
    }
}
