//! Trials of a scene with increasing fineness.

use super::Tell;
use super::trajectory::{MOST_MOMENTS, Trajectory};
use crate::Simulation;
use crate::integrate::clock_section::EventTiming;
use crate::integrate::{Allowance, StepPace};
use crate::scene::{SceneError, SceneErrors};
use crate::simulation::Plan;
use jostle_language::numbers::number;

/// The quantity that becomes finer from trial to trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ladder {
    /// The error allowed to a step.
    Allowed,
    /// The steps of a tick.
    Steps,
    /// The ticks of a tick of the plan: for methods that go by whole ticks.
    Ticks,
}

/// The steps between two readings of a trial. The steps are those that suit the fastest contact or spring: eight
/// readings to a contact.
const STEPS_BETWEEN_LOOKS: u32 = 5;

/// A hasty trial ends at this number of steps in a tick. For each step that suits the fastest contact or spring the
/// next constant is added.
const HASTY_STEPS: f64 = 1e4;
const STEPS_OF_A_SWING: f64 = 10.0;

/// Evaluations of all forces that no trial may need: an hour of the smallest scene, and much more of others.
const MOST_OF_A_RUN: f64 = 1e10;

fn endless(duration: f64, evaluations: f64) -> SceneError {
    let message = format!(
        "the search for steps that keep the tolerance runs these {} s several times. Each run takes {evaluations:.0e} \
         evaluations of all forces, which is more than hours",
        number(duration)
    );
    SceneError::new("clock.duration", message)
        .with_help("use a shorter duration, or give a `tick` in place of the tolerance")
}

/// The trials of a scene.
pub(super) struct Trials<'a> {
    /// The plan they follow.
    pub plan: Plan,
    pub ladder: Ladder,
    /// Order of accuracy of the method.
    pub order: u32,
    /// Steps of a tick that suit the fastest contact or spring.
    pub steps: u32,
    make: &'a mut dyn FnMut(&Plan) -> Result<Simulation, SceneErrors>,
    tell: Option<Tell>,
    /// Ticks of a trial in one of the plan, if its steps do not depend on ticks. So trials are compared at moments
    /// within contacts, and within swings of springs and drives.
    looks: u32,
    /// Whether the motion of some body is prescribed from tick to tick. Then no step goes beyond a tick.
    by_ticks: bool,
    /// Whether a trial ends if a tick takes many steps. Errors that let bodies meet in an impossible way would take
    /// most of them.
    pub hasty: bool,
    /// Whether the last one ended so.
    pub cut: bool,
    /// The fineness of the first.
    coarsest: f64,
    /// The number of trials so far.
    pub count: u32,
    /// The number of times that forces were evaluated in all of them, and the work of that.
    pub evaluations: u64,
    pub work: f64,
    /// The greatest distance and speed of bodies, from the last trial.
    sizes: (f64, f64),
}

impl<'a> Trials<'a> {
    pub fn new(
        (plan, order, steps): (Plan, u32, u32),
        make: &'a mut dyn FnMut(&Plan) -> Result<Simulation, SceneErrors>,
        tell: Option<Tell>,
    ) -> Self {
        let ladder = if matches!(plan.pace, StepPace::Allowed(_)) { Ladder::Allowed } else { Ladder::Steps };
        let looks = match plan.pace {
            StepPace::Allowed(Allowance { longest, .. }) => {
                let most = MOST_MOMENTS as f64 * plan.tick / longest;
                f64::from(steps.div_ceil(STEPS_BETWEEN_LOOKS)).min(most).max(1.0) as u32
            }
            StepPace::Even(_) => 1,
        };
        Self {
            plan,
            ladder,
            order,
            steps,
            make,
            tell,
            looks,
            by_ticks: false,
            hasty: false,
            cut: false,
            coarsest: 0.0,
            count: 0,
            evaluations: 0,
            work: 0.0,
            sizes: (0.0, 0.0),
        }
    }

    /// From here on ticks become finer, by velocity Verlet with events at their ends. Says whether the scene can be run so: some
    /// models need located events.
    pub fn go_by_ticks(&mut self) -> bool {
        let plan = Plan { method: "VelocityVerlet".to_owned(), events: EventTiming::PerTick, ..self.plan.clone() };
        let before = (self.ladder, std::mem::replace(&mut self.plan, plan));
        self.ladder = Ladder::Ticks;
        let plan = self.planned(1.0);
        let runs = (self.make)(&plan).is_ok();
        if !runs {
            (self.ladder, self.plan) = before;
        }
        runs
    }

    /// The plan of a trial. `fineness` is the share of error allowed to a step, or one over the number of steps.
    pub fn planned(&self, fineness: f64) -> Plan {
        let mut plan = self.plan.clone();
        let many = (1.0 / fineness).ceil().clamp(1.0, 1e9) as u32;
        match self.ladder {
            Ladder::Allowed => {
                if let StepPace::Allowed(allowance) = &mut plan.pace {
                    // Steps that no error bounds would be the same in two trials, which would not differ.
                    let first = Allowance { share: self.coarsest.max(fineness), ..*allowance };
                    *allowance = first.with_share(fineness);
                    if self.by_ticks {
                        plan.tick /= allowance.shorter.ceil();
                    }
                }
            }
            Ladder::Steps => plan.pace = StepPace::Even(many),
            Ladder::Ticks => (plan.pace, plan.tick) = (StepPace::Even(1), plan.tick / f64::from(many)),
        }
        plan
    }

    /// Runs the scene by a plan; `change` may change its beginning.
    pub fn run(
        &mut self,
        fineness: f64,
        what: &str,
        change: impl FnOnce(&mut Simulation),
    ) -> Result<Trajectory, SceneErrors> {
        self.coarsest = self.coarsest.max(fineness);
        if self.count == 0 && self.ladder == Ladder::Allowed {
            let plan = self.planned(fineness);
            self.by_ticks = !(self.make)(&plan)?.bodies().prescribed.motions.is_empty();
        }
        let mut plan = self.planned(fineness);
        let per_moment = (self.plan.tick / plan.tick).round() as u64;
        let looks = if self.ladder == Ladder::Allowed && !self.by_ticks { self.looks } else { 1 };
        plan.tick /= f64::from(looks);
        plan.detail.looks *= looks;
        let mut hastened = false;
        if let StepPace::Allowed(allowance) = &mut plan.pace
            && self.hasty
        {
            allowance.most_steps = HASTY_STEPS + STEPS_OF_A_SWING * f64::from(self.steps);
            hastened = true;
        }
        let mut simulation = (self.make)(&plan)?;
        self.count += 1;
        if let Some(tell) = self.tell {
            tell(self.count, what);
        }
        change(&mut simulation);
        let trajectory = Trajectory::record(&mut simulation, per_moment, MOST_OF_A_RUN)
            .map_err(|evaluations| simulation.refused(endless(simulation.duration(), evaluations)))?;
        self.evaluations += trajectory.evaluations;
        self.work += trajectory.work;
        self.cut = hastened && trajectory.failure.is_some();
        if trajectory.failure.is_none() {
            let (distance, speed) = trajectory.sizes();
            if distance > 0.0 || speed > 0.0 {
                self.sizes = (distance, speed);
            }
        }
        Ok(trajectory)
    }

    /// A plan in words.
    pub fn words(&self, plan: &Plan) -> String {
        match plan.pace {
            StepPace::Allowed(allowance) => {
                format!("{} with steps of an estimated error of {:.0e} each", plan.method, allowance.share)
            }
            StepPace::Even(1) => format!("{} with ticks of {} s", plan.method, number(plan.tick)),
            StepPace::Even(steps) => format!("{} with {steps} steps per tick", plan.method),
        }
    }

    /// The cost of the trials, in words.
    pub fn cost(&self) -> String {
        format!(
            "{} runs before this one, with {} evaluations of all forces, found these steps",
            self.count, self.evaluations
        )
    }

    /// The distance that bodies go in m, and their speed in m/s. Both are one if all bodies rest.
    pub fn sizes(&self) -> (f64, f64) {
        let or_one = |size: f64| if size > 0.0 { size } else { 1.0 };
        (or_one(self.sizes.0), or_one(self.sizes.1))
    }
}
