//! Semi-implicit (symplectic) Euler: `v' = v + h a(t, q, v, z)`, then `q' = q + h v'`.
//!
//! Order 1, symplectic for accelerations without velocities, stable for `omega h < 2`. With damping alone it is stable
//! for `h c/m < 2`. Sources: Hairer, Lubich, Wanner, Geometric Numerical Integration, 2nd ed. 2006, section I.1.2; de
//! Vogelaere 1956. It takes one evaluation per step, at the beginning, and one more if there are states of models.
//!
//! If joints hold coordinates, the second half is a drift along them ([`Flow::drift`]), as in RATTLE.
//!
//! States of models, `z' = z + h r(t, q, v', z)`, use the new velocities. The elongation of a spring is a coordinate in
//! disguise, and has to be advanced like one. With the rates of the beginning its oscillation would be that of explicit
//! Euler, which gains energy with each step.

use super::{OneStep, Start};
use crate::tick::Flow;

/// Semi-implicit Euler.
#[derive(Default)]
pub struct SemiImplicitEulerStep {
    state: Vec<f64>,
    rates: Vec<f64>,
}

impl OneStep for SemiImplicitEulerStep {
    fn step(&mut self, flow: &mut dyn Flow, start: Start, length: f64, change: &mut [f64]) {
        let velocities = flow.velocities();
        let coordinates = velocities.start;
        let own = velocities.end..flow.dimension() - flow.accounts();
        for index in velocities.clone().chain(own.end..change.len()) {
            change[index] = length * start.rates[index];
        }
        let held = flow.is_held();
        if !held {
            for index in 0..coordinates {
                change[index] = length * (start.state[index + coordinates] + change[index + coordinates]);
            }
        }
        if own.is_empty() && !held {
            return;
        }
        self.state.clear();
        self.state.extend_from_slice(start.state);
        for index in velocities {
            self.state[index] += change[index];
        }
        if !own.is_empty() {
            self.rates.resize(start.state.len(), 0.0);
            flow.rates(start.time, &self.state, &mut self.rates);
            for index in own {
                change[index] = length * self.rates[index];
            }
        }
        if held {
            change[..coordinates].fill(0.0);
            flow.drift(start.time, length, &mut self.state, change);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::problems::{ELONGATION, KEPLER, OSCILLATOR};
    use super::super::trials::{TrialRun, demand_bounded_energy, demand_order};
    use super::*;

    /// Law: order 1 on smooth motion (section I.1.2 of the source). Tolerance: a quarter of an order.
    #[test]
    fn the_order_is_1() {
        demand_order(&mut SemiImplicitEulerStep::default(), 1, 40.0, 1.37);
    }

    /// Law: a symplectic method keeps the energy near its value for exponentially long (section IX.8 of the source).
    #[test]
    fn energy_stays() {
        for (motion, steps) in [(OSCILLATOR, 20.3), (ELONGATION, 20.3), (KEPLER, 400.3)] {
            demand_bounded_energy(&mut SemiImplicitEulerStep::default(), motion, steps);
        }
    }

    /// Law: an oscillator keeps `q^2 + v^2 - h q v`. So its energy swings between bounds for a step of 1.9 and grows
    /// for one of 2.1. The same holds if the spring is a state of a model. Tolerance: the bounds follow from the
    /// invariant.
    #[test]
    fn stable_below_2() {
        for motion in [OSCILLATOR, ELONGATION] {
            for (length, stable) in [(1.9, true), (2.1, false)] {
                let mut run = TrialRun::of(motion);
                let mut most = 0.0_f64;
                for _ in 0..1000 {
                    run.step(&mut SemiImplicitEulerStep::default(), length);
                    most = most.max(2.0 * (motion.energy)(&run.state));
                }
                let bound: f64 = 1.0 / (1.0 - length / 2.0);
                assert_eq!(most <= 1.01 * bound.abs(), stable, "{}, {length}: energy up to {most}", motion.name);
            }
        }
    }

    #[test]
    fn evaluates_only_for_states_of_models() {
        for (motion, evaluations) in [(OSCILLATOR, 0), (ELONGATION, 1)] {
            let mut run = TrialRun::of(motion);
            run.step(&mut SemiImplicitEulerStep::default(), 0.1);
            assert_eq!(run.flow.evaluations, evaluations, "{}", motion.name);
        }
    }
}
