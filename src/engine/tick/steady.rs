//! The common response of permanent springs, such as those of the scene.
//!
//! Each model with springs lists them in their current state. Their largest angular frequency is computed before the
//! first tick, for the tick that the engine chooses. It is computed again every `PATIENCE` ticks for the error card,
//! because directions and lengths change. Measured contacts include them too, because they hold the same bodies.
//!
//! Damping counts as stiffness, in proportion to the unknown frequency (see [`Stability::weight_of_damping`]). So the
//! frequency is a fixed point. Each of `ROUNDS` rounds halves the remaining error at least.

use super::critical_step::{Spring, Springs};
use super::{Fastest, Foreseen, Holder, Stability, State, TimeScales};
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// Ticks after which the springs are looked at again.
const PATIENCE: u64 = 512;
/// Rounds of the search for the frequency with damping.
const ROUNDS: usize = 40;
/// Product of tick and angular frequency above which energy is watched at each tick; methods bear 2 and more.
const ALERT: f64 = 1.5;

/// A spring in its present state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SteadySpring {
    /// Without what damping adds.
    pub spring: Spring,
    /// Damping along the normal in N s/m.
    pub damping: f64,
    /// Damping against turning in N m s.
    pub turning_damping: f64,
}

/// The springs of all models, and how fast they respond.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct SteadySprings {
    list: Vec<SteadySpring>,
    springs: Springs,
    /// The tick after which they are looked at again.
    next: u64,
    alert: bool,
    found: TimeScales,
}

impl SteadySprings {
    /// Whether any of them is damped.
    pub fn damped(&self) -> bool {
        self.list.iter().any(|steady| steady.damping > 0.0 || steady.turning_damping > 0.0)
    }

    /// The springs in the state of the last measurement. Damping counts as stiffness, as `weight` newtons per metre for
    /// each N s/m.
    pub fn rows(&self, weight: f64) -> impl Iterator<Item = Spring> {
        self.list.iter().map(move |&SteadySpring { spring, damping, turning_damping }| Spring {
            damped: damping * weight,
            turning: spring.turning + turning_damping * weight,
            ..spring
        })
    }

    /// Their measured responses.
    pub fn found(&self) -> TimeScales {
        self.found
    }

    /// Models have changed: the springs are looked at after the next tick.
    pub(super) fn look_again(&mut self) {
        self.next = 0;
    }

    /// Whether energy is to be watched at each tick.
    pub(super) fn alert(&self) -> bool {
        self.alert
    }

    /// The largest angular frequency in rad/s in the current state, and the index of the most stiffly held body.
    fn measure(&mut self, bodies: &Bodies, stability: &Stability) -> Option<(f64, usize)> {
        if self.list.is_empty() {
            return None;
        }
        let mut springs = std::mem::take(&mut self.springs);
        let mut frequency = 0.0_f64;
        for _ in 0..if self.damped() { ROUNDS } else { 1 } {
            springs.gather([], self.rows(frequency * stability.weight_of_damping()), bodies);
            frequency = springs.largest().sqrt();
        }
        let body = springs.bound().body;
        self.springs = springs;
        Some((frequency, body))
    }
}

impl State {
    fn list_springs(&mut self) {
        let mut list = std::mem::take(&mut self.springs.list);
        list.clear();
        self.models().for_each(|model| model.stiffness(self, &mut list));
        self.springs.list = list;
    }

    /// Before the first tick, when the method is not known yet: damping counts as under the strictest.
    pub(crate) fn foresee_springs(&mut self) {
        self.list_springs();
        if let Some((angular_frequency, _)) = self.springs.measure(&self.bodies, &Stability::default()) {
            self.stability.foreseen.push(Foreseen { angular_frequency, holder: Holder::Springs });
        }
    }

    /// At the end of a tick: looks at the springs if it is time to.
    #[inline]
    pub(super) fn watch_springs(&mut self) {
        if self.clock.ticks >= self.springs.next {
            self.measure_springs();
        }
    }

    #[cold]
    fn measure_springs(&mut self) {
        self.springs.next = self.clock.ticks + PATIENCE;
        self.list_springs();
        let Self { springs, bodies, stability, clock, .. } = self;
        let Some((angular_frequency, body)) = springs.measure(bodies, stability) else { return };
        springs.alert |= clock.dt * angular_frequency > ALERT;
        if angular_frequency > springs.found.fastest.map_or(0.0, |fastest| fastest.angular_frequency) {
            let (body, time) = (bodies.entity[body], clock.time());
            springs.found.fastest = Some(Fastest { angular_frequency, body, holder: Holder::Springs, time });
        }
    }
}
