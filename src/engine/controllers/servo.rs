//! A PID controller: torque `kp (target - angle) + ki I + kd (rate of the target - rate)` with `I' = target - angle`.
//! The source is Astrom and Murray, Feedback Systems, section 10.1. Its output is bounded, and computed continuously or
//! at a sampling rate. Sampled outputs are held until the next one, and may be delayed (Astrom, Wittenmark,
//! Computer-Controlled Systems, section 3.2).
//!
//! A continuous output reaches and leaves its bounds at located events, if the method locates any.
//!
//! The integral is a state, which methods with stages advance like positions. Velocity Verlet advances it from tick to
//! tick.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

use super::driven::{self, Driven, DrivenForce, DrivenMotion};
use super::output::{self, Output};
use super::target::ControlTarget;
use crate::constraints::RowKind;
use crate::scene::units::dimension::{OfAngle, OfLength};
use crate::scene::units::{Rate, Scalar, Time};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};

use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::tick::{
    Bend, Departure, Energies, EvaluationMode, Events, ForceOn, Indicator, Model, Rhythm, State, SteadySpring,
    TickAppExt,
};

/// Drives a hinge to an angle, or a slide to a position. Its torque (force) has three terms: `kp (target - angle)`, `ki`
/// times the integral of that difference, and `kd (rate of the target - rate)`. The field `limit` bounds it.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Servo {
    /// Its name, for channels. Default: none.
    name: Option<String>,
    /// The joint.
    of: String,
    /// The angle in rad or with a unit. For a slide it is the travel in metres or with a unit.
    target: ControlTarget<OfAngle, OfLength>,
    /// The proportional gain in N m/rad, or N/m for a slide. Not negative.
    kp: Scalar,
    /// The integral gain in N m/(rad s), or N/(m s) for a slide. Not negative. Default: 0.
    #[serde(default)]
    ki: Scalar,
    /// The derivative gain in N m s/rad, or N s/m for a slide. Not negative. Default: 0.
    #[serde(default)]
    kd: Scalar,
    /// The greatest torque in N m, or force in N for a slide. Above zero. Default: none.
    limit: Option<DrivenForce>,
    /// The sampling rate in Hz. The servo holds its output between samples. Above zero. Default: all the time.
    rate: Option<Rate>,
    /// The time in seconds from each sample until its output takes effect. It may be longer than a period. Until the first
    /// sample takes effect, the output is zero. A delay needs a `rate`. Not negative. Default: 0.
    delay: Option<Time>,
}

impl Entry for Servo {
    const SECTION: &'static str = "controllers";
    const NAME: &'static str = "Servo";
    const EXAMPLE: &'static str = "Servo(of: \"hip\", target: \"40 deg\", kp: 20, kd: 5)";

    fn declare(&self, outline: &mut Outline) {
        output::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        driven::check(&self.of, outline, report);
        self.target.check("target", report);
        for (gain, path) in [(self.kp, "kp"), (self.ki, "ki"), (self.kd, "kd")] {
            report.not_negative(path, gain);
        }
        report.positive_if_given("limit", self.limit);
        report.positive_if_given("rate", self.rate);
        let Some(delay) = self.delay else { return };
        if report.not_negative("delay", delay) && self.rate.is_none() {
            report
                .error("delay", "only outputs that are sampled can be late, and this servo has no `rate`")
                .help("give it a `rate` such as `rate: \"100 Hz\"`, or remove `delay`");
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for (WrittenEntry { value, .. }, path) in entries.into_iter().zip(output::paths(Self::NAME, outline)) {
            app.add_model(ServoForce {
                output: Output::named(value.name, path),
                driven: Driven::named(value.of)
                    .given("target", value.target.said())
                    .given("limit", value.limit.and_then(DrivenForce::said)),
                target: value.target,
                gains: [value.kp, value.ki, value.kd].map(Scalar::si),
                limit: value.limit.map_or(f64::INFINITY, DrivenForce::si),
                sampling: value.rate.map(|rate| Sampling {
                    period: 1.0 / rate.si(),
                    delay: value.delay.unwrap_or_default().si(),
                    next: 0.0,
                    late: VecDeque::new(),
                    held: 0.0,
                }),
                integral: 0.0,
                mode: Mode::default(),
                inside: 0.0,
            });
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Servo>();
}

struct ServoForce {
    output: Output,
    driven: Driven,
    target: ControlTarget<OfAngle, OfLength>,
    gains: [f64; 3],
    limit: f64,
    /// Its sampled output, if it has a sampling rate.
    sampling: Option<Sampling>,
    integral: f64,
    mode: Mode,
    /// A time within the step under way, in s. It selects the piece of a table for the target.
    inside: f64,
}

/// Its output in a step, if the ends of modes are located.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
enum Mode {
    /// The output that it wants.
    #[default]
    Follows,
    /// Its bound: the sign of it.
    Bounded(f64),
}

/// Shares of the numbers from which an output is found: its rounding, and the margin within which a mode lasts.
const ROUNDING: f64 = 1e-14;
const LASTS: f64 = 1e-12;

/// An output without its bounds, in N m or N.
#[derive(Clone, Copy, Debug)]
struct Wanted {
    torque: f64,
    /// Its rate per second.
    slope: f64,
    /// The size of the numbers from which it is found.
    size: f64,
}

/// Times that differ by less than this share of a period are one.
const SAME: f64 = 1e-9;

/// An output that is sampled, and held in between.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Sampling {
    /// Seconds between two samples, and from a sample until it takes effect.
    period: f64,
    delay: f64,
    /// When the next sample is due, in s.
    next: f64,
    /// Samples that have not taken effect: when they do in s, and their outputs.
    late: VecDeque<(f64, f64)>,
    /// The output that is held.
    held: f64,
}

impl Sampling {
    /// The first sample in s after a time; a sample within rounding of it is over.
    fn sample_after(&self, time: f64) -> f64 {
        self.period * ((time / self.period + SAME).floor() + 1.0)
    }

    /// The first time in s after a time at which a sample is taken or takes effect.
    fn edge_after(&self, time: f64) -> f64 {
        // The first sample is that of the start.
        let effect = self.sample_after((time - self.delay).max(-0.5 * self.period)) + self.delay;
        self.sample_after(time).min(effect)
    }

    /// Takes a sample, if one is due, and holds the last output that takes effect. Returns the held output before it,
    /// if that has changed.
    fn advance(&mut self, time: f64, output: impl FnOnce() -> f64) -> Option<f64> {
        let now = time + SAME * self.period;
        if self.next <= now {
            self.late.push_back((time + self.delay, output()));
            self.next = self.sample_after(time);
        }
        let effective = self.late.partition_point(|(at, _)| *at <= now);
        let (_, held) = self.late.drain(..effective).next_back()?;
        Some(std::mem::replace(&mut self.held, held))
    }
}

impl ServoForce {
    /// The target and its rate.
    fn aim(&self, time: f64, mode: EvaluationMode) -> (f64, f64) {
        let inside = if mode.is_staged() { self.inside } else { time };
        (self.target.at(time), self.target.rate(time, inside))
    }

    /// The output without its bounds, in N m or N.
    fn free(&self, motion: &DrivenMotion, (target, rate): (f64, f64)) -> f64 {
        let [kp, ki, kd] = self.gains;
        kp * (target - motion.value) + ki * self.integral + kd * (rate - motion.rate)
    }

    fn bounded(&self, motion: &DrivenMotion, aim: (f64, f64)) -> f64 {
        self.free(motion, aim).clamp(-self.limit, self.limit)
    }

    /// Whether the output may jump at a kink of the target.
    fn jumps(&self) -> bool {
        self.gains[2] != 0.0 && self.target.next_point(f64::NEG_INFINITY).is_finite()
    }

    /// Whether it reaches its bounds and leaves them at events.
    fn has_events(&self) -> bool {
        self.limit.is_finite() && self.sampling.is_none()
    }

    /// The output that it wants in the state just evaluated.
    fn look(&self, state: &State) -> Option<Wanted> {
        let motion = self.driven.motion(&state.bodies).filter(|_| self.has_events())?;
        let [kp, ki, kd] = self.gains;
        let (time, mode) = (state.evaluation().time, state.evaluation().mode);
        let (target, rate) = self.aim(time, mode);
        let acceleration = motion.pair.row(&motion.along, RowKind::Velocity).acceleration(&state.bodies);
        let slope = kp * (rate - motion.rate)
            + ki * (target - motion.value)
            + kd * (self.target.acceleration(time) - acceleration);
        let size = kp * (target.abs() + motion.value.abs())
            + ki * self.integral.abs()
            + kd * (rate.abs() + motion.pair.speeds(&motion.along));
        Some(Wanted { torque: self.free(&motion, (target, rate)), slope, size: size + self.limit })
    }

    /// Chooses the mode of a state. Says whether that is another one.
    fn choose(&mut self, state: &State) -> bool {
        let Some(Wanted { torque, size, .. }) = self.look(state) else { return false };
        let lasts = LASTS * size;
        let mode = match self.mode {
            Mode::Follows if torque.abs() > self.limit + lasts => Mode::Bounded(torque.signum()),
            Mode::Bounded(sign) if sign * torque < self.limit - lasts => {
                if sign * torque < -self.limit - lasts {
                    Mode::Bounded(-sign)
                } else {
                    Mode::Follows
                }
            }
            mode => mode,
        };
        std::mem::replace(&mut self.mode, mode) != mode
    }
}

impl Model for ServoForce {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn force_on(&self, state: &State, body: usize) -> Option<ForceOn> {
        self.driven.force_on(state, body, self.output.values.0)
    }

    fn start(&mut self, world: &mut World) {
        let path = self.output.path.clone();
        self.driven.start(&path, world);
    }

    fn has_edges(&self) -> bool {
        true
    }

    fn rhythm(&self) -> Option<Rhythm> {
        Some(Rhythm { path: self.output.path.clone(), angular_frequency: self.target.rhythm() })
    }

    fn next_edge(&self, time: f64) -> f64 {
        // A step is planned before its sample is taken, so the sample of this moment counts as taken.
        let sample = self.sampling.as_ref().map_or(f64::INFINITY, |sampling| sampling.edge_after(time));
        self.target.next_point(time).min(sample)
    }

    /// Samples are taken at ticks of their own, so they see what they ask for.
    fn departures(&self, state: &State, mode: EvaluationMode) -> Vec<Departure> {
        let course = self.target.course().filter(|_| self.sampling.is_none());
        let path = &self.output.path;
        let of_place = course.and_then(|course| course.departure_of_target(path, state, mode));
        let of_rate = course.filter(|_| self.gains[2] != 0.0);
        let of_rate = of_rate.and_then(|course| course.departure_of_rate(path, state, mode));
        of_place.into_iter().chain(of_rate).collect()
    }

    fn has_modes(&self) -> bool {
        self.sampling.is_some() || self.gains[1] != 0.0 || self.jumps()
    }

    fn begin_step(&mut self, state: &mut State) {
        let span = state.span();
        let Some(motion) = self.driven.motion(&state.bodies) else { return };
        let mode = state.evaluation().mode;
        let staged = mode.is_staged();
        let now = span.begin;
        let before = std::mem::replace(&mut self.inside, span.middle());
        if staged && self.sampling.is_none() && self.jumps() {
            state.evaluation.stale |= self.target.rate(now, before) != self.target.rate(now, self.inside);
        }
        let mut sampling = self.sampling.take();
        if let Some(sampling) = &mut sampling
            && let Some(before) = sampling.advance(now, || self.bounded(&motion, self.aim(now, mode)))
        {
            // The forces of the state were those of the output before.
            if staged {
                state.evaluation.stale = true;
            } else {
                Driven::push(&motion, sampling.held - before, state);
            }
        }
        self.sampling = sampling;
        if !staged {
            self.integral += (self.target.at(span.begin) - motion.value) * span.length;
        }
    }

    fn apply_forces(&mut self, state: &mut State) {
        self.driven.refresh(&state.bodies);
        let Some(motion) = self.driven.motion(&state.bodies) else { return };
        let torque = match &self.sampling {
            Some(sampling) => sampling.held,
            None => {
                let (mode, time) = (state.evaluation().mode, state.evaluation().time);
                let aim = self.aim(time, mode);
                match self.mode {
                    Mode::Follows if mode == EvaluationMode::Frozen => self.free(&motion, aim),
                    Mode::Bounded(sign) if mode == EvaluationMode::Frozen => sign * self.limit,
                    _ => self.bounded(&motion, aim),
                }
            }
        };
        self.output.note(torque, torque * motion.rate);
        Driven::push(&motion, torque, state);
    }

    fn events(&mut self) -> Option<&mut dyn Events> {
        (self.gains[1] != 0.0 || self.has_events()).then_some(self)
    }

    fn after_blow(&mut self, state: &mut State) {
        self.choose(state);
    }

    fn inner(&self) -> Option<&dyn std::any::Any> {
        Some(&self.output)
    }

    fn save(&self) -> Memory {
        Memory::of(&(self.integral, self.mode, self.inside, &self.sampling, &self.output.values))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        (self.integral, self.mode, self.inside, self.sampling, self.output.values) = recall(bytes)?;
        Ok(())
    }
}

/// The integral, and the bounds of the output.
impl Events for ServoForce {
    fn length(&self) -> usize {
        usize::from(self.gains[1] != 0.0)
    }

    fn read(&self, numbers: &mut [f64]) {
        numbers.fill(self.integral);
    }

    fn measures(&self, numbers: &mut [f64]) {
        numbers.fill(self.integral.abs());
    }

    fn write(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|integral| self.integral = *integral);
    }

    fn rates(&self, state: &State, rates: &mut [f64]) {
        let error = |motion: DrivenMotion| self.target.at(state.evaluation().time) - motion.value;
        rates.fill(self.driven.motion(&state.bodies).map_or(0.0, error));
    }

    /// The distance of the output from both bounds, or beyond the one that it gives.
    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>) {
        let Some(Wanted { torque, slope, size }) = self.look(state) else { return };
        let told_of = |sign: f64, limit: f64| Indicator {
            rounding: ROUNDING * size,
            ..Indicator::new(limit + sign * torque, sign * slope, Bend::Fitted)
        };
        match self.mode {
            Mode::Follows => told.extend([-1.0, 1.0].map(|sign| told_of(sign, self.limit))),
            Mode::Bounded(sign) => told.push(told_of(sign, -self.limit)),
        }
    }

    fn switch(&mut self, _: &mut State, fired: &[usize]) {
        self.mode = match (self.mode, fired) {
            (Mode::Follows, [0, ..]) => Mode::Bounded(1.0),
            (Mode::Follows, _) => Mode::Bounded(-1.0),
            (Mode::Bounded(_), _) => Mode::Follows,
        };
    }

    fn settle(&mut self, state: &State) -> bool {
        self.choose(state)
    }

    fn take_stock(&mut self, state: &State) {
        self.choose(state);
    }

    fn hand_over(&mut self, state: &State, _: EvaluationMode) {
        self.choose(state);
    }
}
