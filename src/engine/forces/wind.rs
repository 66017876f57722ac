//! Wind: drag against uniformly moving air, `F = -(c1 + c2 |w|) w` with `w = v - u` and `u` the wind's velocity.
//!
//! The motion of the air drives the body. Of the power `F . v`, `F . w` is lost as heat and `F . u` is work of the
//! wind.

use bevy_app::App;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::ballistics::Air;
use super::{Targets, check_targets};
use crate::scene::units::{Damping, QuadraticDamping, SpeedPair};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::snapshot::Memory;
use crate::tick::{Energies, Model, State, SteadySpring, TickAppExt};

/// Resistance of air that moves evenly: `F = -(c1 + c2 |w|) w`, with `w` the velocity against the air.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Wind {
    /// Velocity of the air in m/s.
    velocity: SpeedPair,
    /// Linear coefficient in N s/m. Default: 0.
    #[serde(default)]
    linear: Damping,
    /// Quadratic coefficient in N s2/m2. Default: 0.
    #[serde(default)]
    quadratic: QuadraticDamping,
    /// The bodies that the force moves. `*` stands for any letters. Default: all bodies.
    of: Option<Names>,
}

impl Entry for Wind {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Wind";
    const EXAMPLE: &'static str = "Wind(velocity: (3, 0), linear: 0.1)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        report.not_negative("linear", self.linear);
        report.not_negative("quadratic", self.quadratic);
        if self.linear.si() == 0.0 && self.quadratic.si() == 0.0 {
            report.error("", "this wind pushes nothing").help("give `linear` or `quadratic`");
        }
        check_targets(self.of.as_ref(), outline, report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for WrittenEntry { value, .. } in entries {
            app.add_model(Gust {
                velocity: value.velocity.si(),
                linear: value.linear.si(),
                quadratic: value.quadratic.si(),
                of: Targets::named(value.of.as_ref(), outline),
            });
        }
    }
}

/// One entry, ready to be applied.
pub(super) struct Gust {
    velocity: DVec2,
    linear: f64,
    quadratic: f64,
    of: Targets,
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Wind>();
}

/// The resistances that move with the air at the body of a key.
pub(super) fn resistance(state: &State, key: u64) -> Vec<Air> {
    let air = |gust: &Gust| Air { linear: gust.linear, quadratic: gust.quadratic, velocity: gust.velocity };
    state.models_of::<Gust>().filter(|gust| gust.of.include(key)).map(air).collect()
}

impl Model for Gust {
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
            let relative = bodies.velocity[body] - self.velocity;
            let force = relative * -(self.linear + self.quadratic * relative.length());
            bodies.force[body] += force;
            rates.outside(bodies.position[body], force, 0.0);
            rates.drag -= force.dot(relative);
            rates.work += force.dot(self.velocity);
        }
    }
}
