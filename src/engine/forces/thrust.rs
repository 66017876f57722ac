//! Thrust: a force at a point of a body between two times. It is constant in the body's frame or in the world's.
//!
//! A run from tick to tick applies it in the ticks whose middle lies between the two times. So a schedule on the grid
//! of ticks gives the exact impulse, and the rounding of times has no effect. The card warns of a schedule off the
//! grid. Methods with steps inside ticks end a step at each of the two times.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::between_ticks::{REMEDY, clock_of_whole_ticks, is_between, paths, percent};
use super::{AppliedAt, Targets, check_targets};
use crate::scene::units::{ForcePair, LengthPair, Time};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry, exact};
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::tick::{Clock, Departure, Energies, EvaluationMode, Model, Rates, State, SteadySpring, TickAppExt};
use crate::world::Bodies;

/// A force at a point of a body, between two times. Under `VelocityVerlet` and `SemiImplicitEuler` without located
/// events it acts in whole ticks. These are the ticks whose middle lies between the two times. The card warns if that
/// differs from the given times.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Thrust {
    /// The bodies that the force moves. `*` stands for any letters.
    of: Names,
    /// The point at which the force acts, in the body's frame, in metres. It counts from the centre of mass, or from the origin
    /// with `datum: Origin`. Default: the centre of mass.
    at: Option<LengthPair>,
    /// Force in newtons.
    force: ForcePair,
    /// Whether the force turns with the body. Default: `World`.
    #[serde(default)]
    frame: ThrustFrame,
    /// The force acts from this time on, in seconds. Default: 0.
    #[serde(default)]
    from: Time,
    /// The time at which it ends, in seconds. Default: none.
    to: Option<Time>,
}

/// The frame in which a force is constant.
#[derive(Clone, Copy, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
pub(super) enum ThrustFrame {
    /// The force turns with the body.
    Body,
    /// It does not.
    #[default]
    World,
}

impl Entry for Thrust {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Thrust";
    const EXAMPLE: &'static str = "Thrust(of: \"T\", force: (0, 2), frame: Body, from: 1, to: 1.25)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        check_targets(Some(&self.of), outline, report);
        if self.to.is_some_and(|to| to.si() <= self.from.si()) {
            report.error("to", format!("must be later than `from`, {} s", exact(self.from.si())));
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for (WrittenEntry { value, .. }, path) in entries.into_iter().zip(paths(Self::NAME, outline)) {
            app.add_model(ThrustForce {
                path,
                of: Targets::named(Some(&value.of), outline),
                at: AppliedAt::new(value.at.map(LengthPair::si)),
                force: value.force.si(),
                turns: value.frame == ThrustFrame::Body,
                from: value.from.si(),
                to: value.to.map_or(f64::INFINITY, Time::si),
                acts: value.from.si() <= 0.0,
            });
        }
    }
}

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct ThrustForce {
    /// Its path in the scene, such as `forces[0]`.
    pub path: String,
    /// The bodies it acts on.
    pub of: Targets,
    /// The point at which it acts.
    pub at: AppliedAt,
    /// Force in newtons.
    pub force: DVec2,
    /// Whether the force turns with the body.
    pub turns: bool,
    /// The force acts from this time on, in seconds.
    pub from: f64,
    /// The time at which it ends, in seconds.
    pub to: f64,
    /// Whether it acts in the present tick. Before the first tick: whether it acts from the beginning on, so that contacts of the
    /// start bear it.
    pub acts: bool,
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Thrust>();
}

/// The force does not depend on velocities, its power does.
impl Model for ThrustForce {
    fn start(&mut self, world: &mut World) {
        self.at.start(&mut self.of, &self.path, world);
    }

    fn save(&self) -> Memory {
        Memory::of(&self.acts)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        self.acts = recall(bytes)?;
        Ok(())
    }

    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn apply_forces(&mut self, state: &mut State) {
        if self.acts {
            let (bodies, rates) = state.bodies_and_rates();
            self.push(bodies, rates, 1.0);
        }
    }

    fn has_modes(&self) -> bool {
        true
    }

    /// A force that begins or ends with a tick changes the sums of the tick's beginning.
    fn begin_step(&mut self, state: &mut State) {
        let acts = (self.from..self.to).contains(&state.span().middle());
        if acts != self.acts {
            self.acts = acts;
            state.evaluation.stale = true;
            let (bodies, rates) = state.bodies_and_rates();
            self.push(bodies, rates, if acts { 1.0 } else { -1.0 });
        }
    }

    fn has_edges(&self) -> bool {
        true
    }

    fn next_edge(&self, time: f64) -> f64 {
        [self.from, self.to].into_iter().filter(|edge| *edge > time).fold(f64::INFINITY, f64::min)
    }

    /// The effects of times between two ticks.
    fn departures(&self, state: &State, mode: EvaluationMode) -> Vec<Departure> {
        clock_of_whole_ticks(state, mode).and_then(|clock| self.departure(&clock)).into_iter().collect()
    }
}

impl ThrustForce {
    /// Its effect so far, if it begins or ends between two ticks.
    fn departure(&self, clock: &Clock) -> Option<Departure> {
        let between = |time: f64| time > 0.0 && time < clock.time() && is_between(clock, time);
        if !between(self.from) && !between(self.to) {
            return None;
        }
        // The first tick whose middle is not before a time.
        let first = |time: f64| (time / clock.dt - 0.5).ceil().clamp(0.0, clock.ticks as f64) as u64;
        let (begin, end) = (clock.time_of(first(self.from)), clock.time_of(first(self.to)));
        let asked = self.to.min(clock.time()) - self.from.max(0.0);
        let share = (end - begin) / asked - 1.0;
        // To the nanosecond: rounded further, both might read the same.
        let at = |time: f64| exact((time * 1e9).round() / 1e9);
        let times = match self.to {
            f64::INFINITY => format!("from {} s on", at(self.from)),
            to => format!("from {} s to {} s", at(self.from), at(to)),
        };
        let came = match share {
            -1.0 => "does not act at all. Its whole impulse is lost".to_owned(),
            _ => {
                let impulse = match share {
                    share if share <= -5e-4 => format!("{} of its impulse is lost", percent(-share)),
                    share if share >= 5e-4 => format!("its impulse is {} too large", percent(share)),
                    _ => "its impulse is right, but its time is not".to_owned(),
                };
                format!("acts from {} s to {} s: {impulse}", at(begin), at(end))
            }
        };
        let what = format!("`{}` ought to act {times}. In whole ticks it {came}", self.path);
        Some(Departure { what, remedy: REMEDY, share: share.abs() })
    }

    fn push(&mut self, bodies: &mut Bodies, rates: &mut Rates, times: f64) {
        for body in self.of.indices(bodies) {
            let (sin, cos) = libm::sincos(bodies.angle[body]);
            let rotation = DVec2::new(cos, sin);
            let force = times * if self.turns { rotation.rotate(self.force) } else { self.force };
            let arm = rotation.rotate(self.at.on(bodies.key.at(body)));
            bodies.push(body, arm, force);
            rates.outside(bodies.position[body], force, arm.perp_dot(force));
            rates.work += force.dot(bodies.velocity_at(body, arm));
        }
    }
}
