//! Tangential law: a spring with a Coulomb limit (Cundall and Strack 1979).
//!
//! The spring's elongation `s` follows the tangential displacement of the two bodies at the contact. It pulls with
//! `k_t s` as long as that is at most `mu N`; beyond, the contact slips and the elongation is `mu N / k_t`. A contact
//! that sticks gives way at the static coefficient, one that slips is limited by the dynamic one. What the spring
//! holds when the contact opens, and the work of slipping, is energy lost to friction.

use super::law::PairLaw;

/// Phase of the tangential law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Grip {
    /// The spring holds.
    #[default]
    Stick,
    /// The spring has given way and pulls with `mu N`.
    Slip,
    /// At rest along both directions: the force is whatever keeps it so, within the cone of the static coefficient.
    Hold,
}

/// What became of a tangential spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretched {
    /// Elongation in metres.
    pub elongation: f64,
    /// Whether the contact sticks or slips.
    pub grip: Grip,
    /// Energy lost to friction in J.
    pub loss: f64,
}

/// Stretches a spring by `displacement` metres under the normal force `normal_force`; `None`: no time has passed, only
/// the normal force is another one. A contact that slips begins to stick by moving back, never by being looked at.
#[inline]
pub fn stretch(law: &PairLaw, before: f64, grip: Grip, displacement: Option<f64>, normal_force: f64) -> Stretched {
    let stiffness = law.tangential_stiffness;
    let trial = before + displacement.unwrap_or(0.0);
    let coefficient = if grip == Grip::Slip { law.friction_dynamic } else { law.friction_static };
    let beyond = stiffness * trial.abs() > coefficient * normal_force;
    if !beyond && displacement.is_none() {
        return Stretched { elongation: before, grip, loss: 0.0 };
    }
    let (grip, elongation) = if beyond {
        (Grip::Slip, (law.friction_dynamic * normal_force / stiffness).copysign(trial))
    } else {
        (Grip::Stick, trial)
    };
    // Mean force times the displacement that the spring did not take up.
    let loss = 0.5 * stiffness * (before + elongation) * (trial - elongation);
    Stretched { elongation, grip, loss }
}

/// Elongation of the spring when a contact that held with `held` newtons is let go: it takes over the force as far as
/// the energy it has allows.
#[inline]
pub fn released(law: &PairLaw, elongation: f64, held: f64) -> f64 {
    (held / law.tangential_stiffness).abs().min(elongation.abs()).copysign(held)
}

/// Energy in J that a spring holds.
#[inline]
pub fn energy(law: &PairLaw, elongation: f64) -> f64 {
    0.5 * law.tangential_stiffness * elongation * elongation
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: PairLaw = PairLaw {
        stiffness: 100.0,
        inelasticity: 0.0,
        friction_static: 0.6,
        friction_dynamic: 0.4,
        tangential_stiffness: 80.0,
        share_a: 0.5,
        share_b: 0.5,
    };

    #[test]
    fn a_sticking_spring_holds_up_to_the_static_limit_and_loses_nothing() {
        let stuck = stretch(&LAW, 0.0, Grip::Stick, Some(0.59 * 10.0 / 80.0), 10.0);
        assert_eq!(stuck.grip, Grip::Stick);
        assert_eq!(stuck.loss, 0.0);
        let slipped = stretch(&LAW, 0.0, Grip::Stick, Some(0.61 * 10.0 / 80.0), 10.0);
        assert_eq!(slipped.grip, Grip::Slip);
        assert_eq!(slipped.elongation, 0.4 * 10.0 / 80.0);
    }

    #[test]
    fn a_spring_that_is_let_go_never_has_more_energy_than_it_had() {
        assert_eq!(released(&LAW, 0.1, 4.0), 0.05);
        assert_eq!(released(&LAW, 0.1, -4.0), -0.05);
        assert_eq!(released(&LAW, -0.01, 4.0), 0.01);
    }

    #[test]
    fn steady_slip_loses_force_times_way() {
        let limit = 0.4 * 10.0 / 80.0;
        let slipped = stretch(&LAW, limit, Grip::Slip, Some(0.01), 10.0);
        assert!((slipped.loss - 0.4 * 10.0 * 0.01).abs() < 1e-15);
    }
}
