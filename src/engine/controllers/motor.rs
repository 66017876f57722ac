//! A motor: it holds the rate of a joint exactly, as a row of the equations, with the necessary torque. Bounded, it
//! gives its greatest torque until the rate is reached.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::driven::{self, Driven, DrivenForce, DrivenMotion, DrivenSpeed};
use super::output::{self, Output};
use crate::constraints::{Row, RowKind, Rows};
use crate::joints::bounded::Bounded;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::snapshot::{Memory, UnfitSnapshot, demand, recall};
use crate::tick::{Blow, Energies, EvaluationMode, Events, ForceOn, Indicator, Model, State, SteadySpring, TickAppExt};
use crate::world::Bodies;

/// Turns a hinge or moves a slide at a constant rate, with the necessary torque or force.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Motor {
    /// Its name, for channels. Default: none.
    name: Option<String>,
    /// The joint.
    of: String,
    /// The rate in rad/s or with a unit such as "30 rpm". For a slide it is the speed in m/s or with a unit such as "20
    /// cm/s". Without `limit` the scene begins at this rate.
    speed: DrivenSpeed,
    /// The greatest torque in N m, or force in N for a slide. Above zero. Default: none.
    limit: Option<DrivenForce>,
}

impl Entry for Motor {
    const SECTION: &'static str = "controllers";
    const NAME: &'static str = "Motor";
    const EXAMPLE: &'static str = "Motor(name: \"drive\", of: \"hip\", speed: \"30 rpm\", limit: 10)";

    fn declare(&self, outline: &mut Outline) {
        output::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        driven::check(&self.of, outline, report);
        report.finite("speed", self.speed);
        report.positive_if_given("limit", self.limit);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for (WrittenEntry { value, .. }, path) in entries.into_iter().zip(output::paths(Self::NAME, outline)) {
            app.add_model(MotorRow {
                output: Output::named(value.name, path),
                driven: Driven::named(value.of)
                    .given("speed", value.speed.said())
                    .given("limit", value.limit.and_then(DrivenForce::said)),
                held: Bounded::new(value.speed.si(), value.limit.map_or(f64::INFINITY, DrivenForce::si)),
                row: None,
            });
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Motor>();
}

struct MotorRow {
    output: Output,
    driven: Driven,
    held: Bounded,
    /// The index of its row in the present evaluation.
    row: Option<usize>,
}

impl Model for MotorRow {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn force_on(&self, state: &State, body: usize) -> Option<ForceOn> {
        self.driven.force_on(state, body, self.output.values.0)
    }

    fn has_rows(&self) -> bool {
        true
    }

    fn start(&mut self, world: &mut World) {
        let path = self.output.path.clone();
        self.driven.start(&path, world);
        if !self.held.is_bounded() {
            self.driven.refuse_limits(&path, world);
        }
        if let Some(motion) = self.driven.motion(&world.resource::<State>().bodies) {
            self.held.choose(&motion.pair, &motion.along);
        }
    }

    fn has_modes(&self) -> bool {
        self.held.is_bounded()
    }

    /// Between ticks the torque of the last evaluation decides, and the rate that is reached.
    fn begin_step(&mut self, state: &mut State) {
        let Some(motion) = self.driven.motion(&state.bodies) else { return };
        self.held.accept(&motion.pair, &motion.along);
        if state.evaluation().mode == EvaluationMode::Frozen {
            return;
        }
        let DrivenMotion { pair, along, .. } = &motion;
        let acceleration = pair.row(along, RowKind::Velocity).acceleration(&state.bodies);
        if self.held.follow(pair, along) || self.held.reaches(pair, along, (acceleration, state.span().length)) {
            state.change_rows();
            if self.held.given().is_none() {
                state.strike(Blow::Grips);
            }
        }
    }

    fn after_blow(&mut self, state: &mut State) {
        if let Some(motion) = self.driven.motion(&state.bodies) {
            self.held.after_blow(&motion.pair, &motion.along);
        }
    }

    fn add_rows(&mut self, bodies: &Bodies, _: f64, rows: &mut Rows) {
        self.driven.refresh(bodies);
        let row = self.driven.motion(bodies).and_then(|motion| self.held.row(&motion.pair, &motion.along));
        self.row = row.map(|row| {
            rows.add(Row { yields: self.held.is_bounded(), ..row });
            rows.len() - 1
        });
    }

    fn apply_forces(&mut self, state: &mut State) {
        let Some(torque) = self.held.given() else { return };
        self.driven.refresh(&state.bodies);
        let Some(motion) = self.driven.motion(&state.bodies) else { return };
        self.output.note(torque, torque * motion.rate);
        Driven::push(&motion, torque, state);
    }

    fn take_rows(&mut self, state: &mut State) {
        let Some(row) = self.row else { return };
        let Some(motion) = self.driven.motion(&state.bodies) else { return };
        let torque = state.rows().force(row);
        state.apply_rows(row..row + 1);
        let power = torque * motion.rate;
        state.bodies_and_rates().1.work += power;
        if state.rows().gives_its_bound(row) {
            self.held.give(torque);
        } else {
            self.held.note(torque);
        }
        self.output.note(torque, power);
    }

    fn events(&mut self) -> Option<&mut dyn Events> {
        self.held.is_bounded().then_some(self)
    }

    fn inner(&self) -> Option<&dyn std::any::Any> {
        Some(&self.output)
    }

    fn save(&self) -> Memory {
        Memory::of(&(self.held, &self.output.values))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        let (held, values): (Bounded, _) = recall(bytes)?;
        demand(self.held.has_parameters_of(&held), "the speed and bound of a motor")?;
        (self.held, self.output.values) = (held, values);
        Ok(())
    }
}

/// Its torque reaches its bounds, or the joint its rate.
impl Events for MotorRow {
    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>) {
        if let Some(motion) = self.driven.motion(state.bodies()) {
            self.held.tell(&motion.pair, &motion.along, state, told);
        }
    }

    fn switch(&mut self, _: &mut State, fired: &[usize]) {
        fired.iter().take(1).for_each(|index| self.held.switch(*index));
    }

    fn look_again(&mut self) -> bool {
        self.held.look_again()
    }

    fn settle(&mut self, state: &State) -> bool {
        let Some(motion) = self.driven.motion(state.bodies()) else { return false };
        self.held.settle(&motion.pair, &motion.along, state)
    }
}
