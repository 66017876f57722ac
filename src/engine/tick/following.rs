//! The transition from stages of steps to whole steps that follow one another, and back.

use super::{EvaluationMode, Tick};

impl Tick<'_> {
    /// From the state just evaluated at `time` seconds on, models with a history follow from state to state.
    pub fn begin_following(&mut self, time: f64) {
        self.change_mode(EvaluationMode::Following);
        let bodies = self.bodies();
        // An estimate of velocities belongs to its tick, and rounding remainders to the method before.
        bodies.estimated_velocity.clear();
        bodies.estimated_spin.clear();
        bodies.position_residual.fill(glam::DVec2::ZERO);
        bodies.angle_residual.fill(0.0);
        self.part(time, time, |tick| tick.evaluate(0.0));
    }

    /// From the beginning of the tick on, states are stages of steps again. Returns whether contacts and limits have found modes.
    pub fn begin_stages(&mut self, mode: EvaluationMode) -> bool {
        self.change_mode(mode);
        self.begin_anew();
        // The cost of the change is booked.
        self.end_step(&[], 0.0)
    }

    fn change_mode(&mut self, mode: EvaluationMode) {
        self.mode = mode;
        self.hand_over(mode);
    }

    /// A part of the tick as if it were a whole one.
    pub fn part<R>(&mut self, begin: f64, end: f64, step: impl FnOnce(&mut Self) -> R) -> R {
        let whole = (self.begin, self.end, self.dt);
        (self.begin, self.end, self.dt) = (begin, end, end - begin);
        let result = step(self);
        (self.begin, self.end, self.dt) = whole;
        result
    }
}
