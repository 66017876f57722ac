//! An actuator: a torque or force in a joint that follows a course in time and ignores the joint's motion.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::driven::{self, Driven};
use super::output::{self, Output};
use super::target::ControlTarget;
use crate::scene::units::dimension::{OfForce, OfTorque};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::tick::{Departure, Energies, EvaluationMode, ForceOn, Model, Rhythm, State, SteadySpring, TickAppExt};

/// Turns a hinge by a torque, or pushes a slide by a force, that follows a course in time.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Actuator {
    /// Its name, for channels. Default: none.
    name: Option<String>,
    /// The joint.
    of: String,
    /// Torque in N m on `b`, counter-clockwise. For a slide it is the force in N along its axis.
    force: ControlTarget<OfTorque, OfForce>,
}

impl Entry for Actuator {
    const SECTION: &'static str = "controllers";
    const NAME: &'static str = "Actuator";
    const EXAMPLE: &'static str = "Actuator(of: \"piston\", force: Sine(amplitude: 3, frequency: 2))";

    fn declare(&self, outline: &mut Outline) {
        output::declare(self.name.as_deref(), outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        driven::check(&self.of, outline, report);
        self.force.check("force", report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for (WrittenEntry { value, .. }, path) in entries.into_iter().zip(output::paths(Self::NAME, outline)) {
            let output = Output::named(value.name, path);
            app.add_model(ActuatorForce {
                output,
                driven: Driven::named(value.of).given("force", value.force.said()),
                force: value.force,
            });
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Actuator>();
}

struct ActuatorForce {
    output: Output,
    driven: Driven,
    force: ControlTarget<OfTorque, OfForce>,
}

impl Model for ActuatorForce {
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
        Some(Rhythm { path: self.output.path.clone(), angular_frequency: self.force.rhythm() })
    }

    fn next_edge(&self, time: f64) -> f64 {
        self.force.next_point(time)
    }

    fn departures(&self, state: &State, mode: EvaluationMode) -> Vec<Departure> {
        let course = self.force.course();
        course.and_then(|course| course.departure(&self.output.path, state, mode)).into_iter().collect()
    }

    fn apply_forces(&mut self, state: &mut State) {
        self.driven.refresh(&state.bodies);
        let Some(motion) = self.driven.motion(&state.bodies) else { return };
        let force = self.force.at(state.evaluation().time);
        self.output.note(force, force * motion.rate);
        Driven::push(&motion, force, state);
    }

    fn inner(&self) -> Option<&dyn std::any::Any> {
        Some(&self.output)
    }

    fn save(&self) -> Memory {
        Memory::of(&self.output.values)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        self.output.values = recall(bytes)?;
        Ok(())
    }
}
