//! A controller: torque `kp (target - angle) + ki I + kd (rate of the target - rate)` with `I' = target - angle` (PD and PID control,
//! Astrom and Murray, Feedback Systems, section 10.1), bounded, computed all the time or at a rate of its own.
//!
//! The integral is state that methods with stages advance as they do positions; velocity Verlet advances it from tick to tick.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use super::driven::{self, Driven, DrivenForce, Motion};
use super::output::{self, Output};
use super::target::Target;
use crate::scene::units::dimension::{OfAngle, OfLength};
use crate::scene::units::{Rate, Scalar};
use crate::scene::{Entry, Outline, Report, SceneAppExt, Written};

use crate::tick::snapshot::{Memory, Unfit, recall};
use crate::tick::{Energies, Events, ForceOn, Indicator, Model, State, SteadySpring, Style, TickAppExt};

/// Drives a hinge to an angle, or a slide to a place: its torque (force) is `kp (target - angle) + ki` times the integral of that
/// `+ kd (rate of the target - rate)`, bounded by `limit`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Servo {
    /// Its name, for channels. Default: none.
    name: Option<String>,
    /// The joint.
    of: String,
    /// The angle in rad or with a unit; of a slide the travel in metres, likewise.
    target: Target<OfAngle, OfLength>,
    /// In N m/rad; of a slide in N/m. Not negative.
    kp: Scalar,
    /// In N m/(rad s); of a slide in N/(m s). Not negative. Default: 0.
    #[serde(default)]
    ki: Scalar,
    /// In N m s/rad; of a slide in N s/m. Not negative. Default: 0.
    #[serde(default)]
    kd: Scalar,
    /// The greatest torque in N m, of a slide force in N. Above zero. Default: none.
    limit: Option<DrivenForce>,
    /// How often it computes its output, which it holds in between, in Hz. Above zero. Default: all the time.
    rate: Option<Rate>,
}

impl Entry for Servo {
    const SECTION: &'static str = "controllers";
    const NAME: &'static str = "Servo";
    const EXAMPLE: &'static str = "Servo(of: \"hip\", target: \"40 deg\", kp: 20, kd: 5)";

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    fn declare(&self, outline: &mut Outline) {
        output::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        driven::check(&self.of, outline, report);
        self.target.check("target", report);
        for (gain, path) in [(self.kp, "kp"), (self.ki, "ki"), (self.kd, "kd")] {
            report.not_negative(path, gain);
        }
        report.positive_if_given("limit", self.limit);
        report.positive_if_given("rate", self.rate);
    }

    fn install(entries: Vec<Written<Self>>, outline: &Outline, app: &mut App) {
        for (Written { value, .. }, path) in entries.into_iter().zip(output::paths(Self::NAME, outline)) {
            app.add_model(ServoForce {
                output: Output::named(value.name, path),
                driven: Driven::named(value.of)
                    .given("target", value.target.said())
                    .given("limit", value.limit.and_then(DrivenForce::said)),
                target: value.target,
                gains: [value.kp, value.ki, value.kd].map(Scalar::si),
                limit: value.limit.map_or(f64::INFINITY, DrivenForce::si),
                period: value.rate.map(|rate| 1.0 / rate.si()),
                integral: 0.0,
                held: 0.0,
                next: 0.0,
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
    target: Target<OfAngle, OfLength>,
    gains: [f64; 3],
    limit: f64,
    /// Seconds between two outputs, if it computes them at a rate of its own.
    period: Option<f64>,
    integral: f64,
    /// The output that is held, and when the next one is computed.
    held: f64,
    next: f64,
}

/// The next sample in s after a time; a sample within rounding of it is over.
fn sample_after(time: f64, period: f64) -> f64 {
    period * ((time / period + 1e-9).floor() + 1.0)
}

impl ServoForce {
    fn wanted(&self, motion: &Motion, time: f64) -> f64 {
        let [kp, ki, kd] = self.gains;
        let (target, rate) = self.target.at(time);
        let torque = kp * (target - motion.value) + ki * self.integral + kd * (rate - motion.rate);
        torque.clamp(-self.limit, self.limit)
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

    fn next_edge(&self, time: f64) -> f64 {
        // A step is planned before its sample is taken: that of this moment counts as taken.
        let sample = self.period.map_or(f64::INFINITY, |period| sample_after(time, period));
        self.target.next_point(time).min(sample)
    }

    fn has_modes(&self) -> bool {
        self.period.is_some() || self.gains[1] != 0.0
    }

    fn begin_step(&mut self, state: &mut State) {
        let span = state.span();
        let Some(motion) = self.driven.motion(&state.bodies) else { return };
        let staged = state.evaluation().style.is_staged();
        if let Some(period) = self.period
            && span.begin >= self.next - 1e-9 * period
        {
            let before = self.held;
            self.held = self.wanted(&motion, span.begin);
            self.next = sample_after(span.begin, period);
            // The forces of the state were those of the output before.
            if staged {
                state.evaluation.stale = true;
            } else {
                Driven::push(&motion, self.held - before, state);
            }
        }
        if !staged {
            self.integral += (self.target.at(span.begin).0 - motion.value) * span.length;
        }
    }

    fn apply_forces(&mut self, state: &mut State) {
        self.driven.refresh(&state.bodies);
        let Some(motion) = self.driven.motion(&state.bodies) else { return };
        let torque = match self.period {
            Some(_) => self.held,
            None => self.wanted(&motion, state.evaluation().time),
        };
        self.output.note(torque, torque * motion.rate);
        Driven::push(&motion, torque, state);
    }

    fn events(&mut self) -> Option<&mut dyn Events> {
        (self.gains[1] != 0.0).then_some(self)
    }

    fn inner(&self) -> Option<&dyn std::any::Any> {
        Some(&self.output)
    }

    fn save(&self) -> Memory {
        Memory::of(&(self.integral, self.held, self.next, &self.output.values))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), Unfit> {
        (self.integral, self.held, self.next, self.output.values) = recall(bytes)?;
        Ok(())
    }
}

/// The integral.
impl Events for ServoForce {
    fn length(&self) -> usize {
        1
    }

    fn read(&self, numbers: &mut [f64]) {
        numbers[0] = self.integral;
    }

    fn write(&mut self, numbers: &[f64]) {
        self.integral = numbers[0];
    }

    fn rates(&self, state: &State, rates: &mut [f64]) {
        let error = |motion: Motion| self.target.at(state.evaluation().time).0 - motion.value;
        rates[0] = self.driven.motion(&state.bodies).map_or(0.0, error);
    }

    fn tell(&mut self, _: &State, _: &mut Vec<Indicator>) {}

    fn switch(&mut self, _: &mut State, _: &[usize]) {}

    fn settle(&mut self, _: &State) -> bool {
        false
    }

    fn take_stock(&mut self, _: &State) {}

    fn tidy(&mut self, _: &mut State) -> bool {
        false
    }

    fn hand_over(&mut self, _: &State, _: Style) {}

    fn is_crowded(&self) -> bool {
        false
    }
}
