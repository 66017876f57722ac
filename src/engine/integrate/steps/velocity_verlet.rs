//! Velocity Verlet: kick by `h/2`, drift by `h`, kick by `h/2`. States of models are advanced in the middle of the
//! drift.
//!
//! Order 2, symmetric in time, symplectic for accelerations without velocities, stable for `omega h < 2`. With damping
//! it is stable as long as the kicks converge, `h c/m < 4`. Sources: Swope, Andersen, Berens, Wilson 1982; Hairer,
//! Lubich, Wanner, Geometric Numerical Integration, 2nd ed. 2006, sections I.1.4 and II.5.
//!
//! One evaluation per step: the first kick has the rates of the beginning. Accelerations that depend on velocities are
//! iterated to rounding in both kicks. That takes 3 to 5 evaluations each for `h c/m` up to 0.2. States of models cost
//! two evaluations, or more if their rates depend on themselves.

use super::splitting::Splitting;
use super::{OneStep, Start};
use crate::tick::Flow;

/// Velocity Verlet.
#[derive(Default)]
pub struct VelocityVerletStep {
    work: Splitting,
}

impl OneStep for VelocityVerletStep {
    fn step(&mut self, flow: &mut dyn Flow, start: Start, length: f64, change: &mut [f64]) {
        let mut making = self.work.begin(flow, start, change);
        making.kick(length / 2.0);
        making.drift(length / 2.0);
        making.own(length);
        making.drift(length / 2.0);
        making.kick(length / 2.0);
    }
}

#[cfg(test)]
mod tests {
    use super::super::problems::{ELONGATION, KEPLER, OSCILLATOR};
    use super::super::trials::{TrialRun, demand_bounded_energy, demand_no_trend, demand_order, demand_reversible};
    use super::*;

    /// Law: order 2 on smooth motion, with velocities in the accelerations and states of models too. Symmetric methods
    /// have even order (theorem II.3.2 of the source). Tolerance: a quarter of an order.
    #[test]
    fn the_order_is_2() {
        demand_order(&mut VelocityVerletStep::default(), 2, 6.0, 1.37);
    }

    /// Law: a symplectic method keeps the energy near its value for exponentially long (section IX.8 of the source).
    #[test]
    fn energy_stays() {
        for (motion, steps) in [(OSCILLATOR, 20.3), (ELONGATION, 20.3), (KEPLER, 200.3)] {
            demand_bounded_energy(&mut VelocityVerletStep::default(), motion, steps);
        }
    }

    /// Law: the same on sharp ellipses with steps that resolve the passage. There the rate times the step is a third.
    #[test]
    fn energy_has_no_trend_in_ten_thousand_sharp_orbits() {
        demand_no_trend(&mut VelocityVerletStep::default(), 600);
    }

    /// Law: a symmetric method runs back to its start (section V.1 of the source). Tolerance: rounding.
    #[test]
    fn runs_backwards() {
        demand_reversible(&mut VelocityVerletStep::default(), 1.0);
    }

    /// Law: an oscillator keeps `v^2 + (1 - h^2/4) q^2`. So from rest its energy never rises, except for steps above 2.
    /// The same holds if the spring is a state of a model. Tolerance: rounding of the steps.
    #[test]
    fn stable_below_2() {
        for motion in [OSCILLATOR, ELONGATION] {
            for (length, stable) in [(1.99, true), (2.01, false)] {
                let mut run = TrialRun::of(motion);
                let mut most = 0.0_f64;
                for _ in 0..1000 {
                    run.step(&mut VelocityVerletStep::default(), length);
                    most = most.max(2.0 * (motion.energy)(&run.state));
                }
                let rounding = 1000.0 * 8.0 * f64::EPSILON;
                assert_eq!(most <= 1.0 + rounding, stable, "{}, {length}: energy up to {most}", motion.name);
            }
        }
    }

    #[test]
    fn one_evaluation() {
        for (motion, evaluations) in [(KEPLER, 1), (ELONGATION, 3)] {
            let mut run = TrialRun::of(motion);
            run.step(&mut VelocityVerletStep::default(), 0.1);
            assert_eq!(run.flow.evaluations, evaluations, "{}", motion.name);
        }
    }
}
