//! Drag: `F = -c v` (linear, Stokes) and `F = -c |v| v` (quadratic, Newton), on the centre of mass.

use bevy_app::App;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::ballistics::Air;
use super::{Targets, check_targets};
use crate::scene::units::{Damping, QuadraticDamping};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::snapshot::Memory;
use crate::tick::{Energies, Model, State, SteadySpring, TickAppExt};

/// Resistance of air that rests: `F = -(c1 + c2 |v|) v`, with `c1` linear (Stokes) and `c2` quadratic (Newton).
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Drag {
    /// Linear coefficient in N s/m. Default: 0.
    #[serde(default)]
    linear: Damping,
    /// Quadratic coefficient in N s2/m2. Default: 0.
    #[serde(default)]
    quadratic: QuadraticDamping,
    /// The bodies that the force moves. `*` stands for any letters. Default: all bodies.
    of: Option<Names>,
}

impl Entry for Drag {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Drag";
    const EXAMPLE: &'static str = "Drag(linear: 0.1, of: [\"ball\"])";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        report.not_negative("linear", self.linear);
        report.not_negative("quadratic", self.quadratic);
        if self.linear.si() == 0.0 && self.quadratic.si() == 0.0 {
            report.error("", "this drag slows nothing").help("give `linear` or `quadratic`, or remove it");
        }
        check_targets(self.of.as_ref(), outline, report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for WrittenEntry { value, .. } in entries {
            app.add_model(DragForce {
                linear: value.linear.si(),
                quadratic: value.quadratic.si(),
                of: Targets::named(value.of.as_ref(), outline),
            });
        }
    }
}

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct DragForce {
    /// Linear coefficient in N s/m.
    pub linear: f64,
    /// Quadratic coefficient in N s2/m2.
    pub quadratic: f64,
    /// The bodies it acts on.
    pub of: Targets,
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Drag>();
}

/// The resistances that act on the body of a key.
pub(super) fn resistance(state: &State, key: u64) -> Vec<Air> {
    let air = |drag: &DragForce| Air { linear: drag.linear, quadratic: drag.quadratic, velocity: DVec2::ZERO };
    state.models_of::<DragForce>().filter(|drag| drag.of.include(key)).map(air).collect()
}

impl Model for DragForce {
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
            let velocity = bodies.velocity[body];
            let force = velocity * -(self.linear + self.quadratic * velocity.length());
            bodies.force[body] += force;
            rates.outside(bodies.position[body], force, 0.0);
            rates.drag -= force.dot(velocity);
        }
    }
}
