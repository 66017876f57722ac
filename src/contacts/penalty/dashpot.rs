//! Normal law: a spring and a dashpot side by side, `N = max(0, k d - c v_n)` with `v_n` the velocity with which the
//! sides part.
//!
//! The contact never pulls: it ends when the force does, before the overlap is gone (Schwager and Poeschel 2007). With
//! `m` the effective mass, `b = c/(2 m)`, `w0^2 = k/m` and `w^2 = w0^2 - b^2` it lasts
//! `t = atan2(2 b w, b^2 - w^2)/w` and the restitution is `e = exp(-b t)`; overdamped, with `W^2 = b^2 - w0^2`,
//! `t = artanh(2 b W/(b^2 + W^2))/W`. A restitution in the scene is turned into a damping ratio `b/w0` by solving that
//! for it; codes that let the contact pull until the overlap is gone need another ratio for the same restitution.
//!
//! The damping `c` is that of the ratio for the effective mass of the contact, `c = 2 zeta sqrt(k m)`, so that a single
//! contact has the restitution that was asked for, also off the centre of a body. A body that lands on n atoms at once
//! rebounds less than from one: with a damping in N s/m its damping ratio is `sqrt(n)` times as large, with a restitution
//! up to that, as atoms far from the centre of mass have less damping (two of them where one feels nothing of the other,
//! `m x^2 = I`, rebound as one does). The run notes it on its card.

use super::Penalty;
use super::law::PairLaw;
use super::normal::{Approach, Change, Mode, NormalForce, lost_work};
use crate::world::material::restitution_of;

/// The least restitution that is converted; zero would need infinite damping.
pub const LEAST_RESTITUTION: f64 = 0.01;

/// Damping of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Damping {
    /// Share of the critical damping of the contact.
    Ratio(f64),
    /// In N s/m.
    Coefficient(f64),
}

impl Default for Damping {
    /// None.
    fn default() -> Self {
        Self::Ratio(0.0)
    }
}

/// The law.
pub struct Dashpot;

impl NormalForce for Dashpot {
    const DEPENDS_ON_VELOCITY: bool = true;
    const SET_VALUED: bool = false;

    fn set_up(law: &mut PairLaw, inelasticity: f64, settings: &Penalty) {
        law.damping = match settings.damping {
            Some(damping) => Damping::Coefficient(damping.si()),
            None => Damping::Ratio(ratio_of(restitution_of(inelasticity).max(LEAST_RESTITUTION))),
        };
    }

    #[inline]
    fn chosen(_: Mode, _: f64) -> Mode {
        Mode::Loading
    }

    #[inline]
    fn force(law: &PairLaw, _: Mode, overlap: f64, approach: Approach) -> f64 {
        (law.stiffness * overlap - damping(law, approach.mobility) * approach.parting).max(0.0)
    }

    /// A contact whose force has vanished before its overlap is slack: unloading, without a force.
    fn smooth_force(law: &PairLaw, mode: Mode, overlap: f64, approach: Approach) -> f64 {
        match mode {
            Mode::Unloading => 0.0,
            _ => law.stiffness * overlap - damping(law, approach.mobility) * approach.parting,
        }
    }

    /// The damping of a ratio is in proportion to `1/sqrt(mobility)`.
    fn force_rate(law: &PairLaw, mode: Mode, approach: Approach, change: Change) -> f64 {
        if mode == Mode::Unloading {
            return 0.0;
        }
        let damping = damping(law, approach.mobility);
        let thinning = match law.damping {
            Damping::Ratio(_) => 0.5 * change.mobility / approach.mobility,
            Damping::Coefficient(_) => 0.0,
        };
        -law.stiffness * approach.parting - damping * (change.parting - thinning * approach.parting)
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

    #[inline]
    fn loss(law: &PairLaw, _: Mode, before: (f64, f64), after: (f64, f64)) -> f64 {
        lost_work(law, before, after)
    }

    fn response(law: &PairLaw, mobility: f64) -> (f64, f64) {
        (law.stiffness, damping(law, mobility))
    }

    fn dissipates(law: &PairLaw) -> bool {
        match law.damping {
            Damping::Ratio(damping) | Damping::Coefficient(damping) => damping > 0.0,
        }
    }
}

/// In N s/m, for a contact with this mobility in 1/kg.
#[inline]
fn damping(law: &PairLaw, mobility: f64) -> f64 {
    match law.damping {
        Damping::Ratio(ratio) => 2.0 * ratio * (law.stiffness / mobility).sqrt(),
        Damping::Coefficient(damping) => damping,
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
        // Two discs of mass pi/4 with k = 1e5 and b = 100, and an overdamped contact: event-located integration of the
        // law to 1e-12, printed to ten and seven digits.
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
            // A bisection to the last bit: what is left is rounding of the restitution.
            assert!((restitution(ratio_of(wanted)) - wanted).abs() < 1e-14);
        }
    }
}
