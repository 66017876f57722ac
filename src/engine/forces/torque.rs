//! A constant torque on a body.

use bevy_app::App;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Targets, check_targets};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry, units};
use crate::tick::snapshot::Memory;
use crate::tick::{Energies, Model, State, SteadySpring, TickAppExt};

/// A constant torque.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Torque {
    /// The bodies that the force moves. `*` stands for any letters.
    of: Names,
    /// Torque in N m, counter-clockwise.
    value: units::Torque,
}

impl Entry for Torque {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Torque";
    const EXAMPLE: &'static str = "Torque(of: \"flywheel\", value: 0.05)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        check_targets(Some(&self.of), outline, report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for WrittenEntry { value, .. } in entries {
            app.add_model(ConstantTorque { of: Targets::named(Some(&value.of), outline), value: value.value.si() });
        }
    }
}

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct ConstantTorque {
    /// The bodies it acts on.
    pub of: Targets,
    /// Torque in N m, counter-clockwise.
    pub value: f64,
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Torque>();
}

/// The torque does not depend on velocities, its power does.
impl Model for ConstantTorque {
    fn save(&self) -> Memory {
        Memory::Nothing
    }

    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn apply_forces(&mut self, state: &mut State) {
        let (bodies, rates) = state.bodies_and_rates();
        for body in self.of.indices(bodies) {
            bodies.torque[body] += self.value;
            rates.torque += self.value;
            rates.work += self.value * bodies.spin[body];
        }
    }
}
