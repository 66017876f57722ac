//! Substepping: a step of equal parts of another method. The steps from event to event stay the same, with a smaller
//! error.
//!
//! A run estimates its own error by such steps. If two events lie in one tick, the step between them is the same with
//! any tick. Its error would be the same too.

use super::{OneStep, Start};
use crate::tick::Flow;

/// A method whose steps are so many of another one.
pub struct Divided {
    method: Box<dyn OneStep>,
    parts: u32,
    state: Vec<f64>,
    rates: Vec<f64>,
    part: Vec<f64>,
}

impl Divided {
    /// Steps of `method` in `parts` parts; two or more.
    pub fn new(method: Box<dyn OneStep>, parts: u32) -> Self {
        Self { method, parts, state: Vec::new(), rates: Vec::new(), part: Vec::new() }
    }
}

impl OneStep for Divided {
    fn step(&mut self, flow: &mut dyn Flow, start: Start, length: f64, change: &mut [f64]) {
        let h = length / f64::from(self.parts);
        self.method.step(flow, start, h, change);
        for number in 1..self.parts {
            let time = start.time + f64::from(number) * h;
            self.state.clear();
            self.state.extend(start.state.iter().zip(&*change).map(|(state, change)| state + change));
            self.rates.resize(self.state.len(), 0.0);
            self.part.resize(self.state.len(), 0.0);
            flow.rates(time, &self.state, &mut self.rates);
            let part = Start { time, state: &self.state, rates: &self.rates };
            self.method.step(flow, part, h, &mut self.part);
            change.iter_mut().zip(&self.part).for_each(|(change, part)| *change += part);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::problems::KEPLER;
    use super::super::trials::TrialRun;
    use super::super::{RungeKutta4, trials};
    use super::*;

    /// Promise: a step in two parts equals two steps of half the length, up to the rounding of one sum.
    #[test]
    fn parts_are_steps() {
        let (mut whole, mut parts) = (TrialRun::of(KEPLER), TrialRun::of(KEPLER));
        whole.step(&mut Divided::new(Box::new(RungeKutta4::default()), 3), 0.3);
        for _ in 0..3 {
            parts.step(&mut RungeKutta4::default(), 0.3 / 3.0);
        }
        for (whole, part) in whole.state.iter().zip(&parts.state) {
            assert!((whole - part).abs() < 1e-15, "{whole} {part}");
        }
    }

    /// Law: the order stays that of the parts.
    #[test]
    fn the_order_stays() {
        trials::demand_order(&mut Divided::new(Box::new(RungeKutta4::default()), 2), 4, 1.0, 1.37);
    }
}
