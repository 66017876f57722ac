//! A torsion spring and a damper between two bodies. Let `phi` be the angle of B relative to A, continuous over full
//! turns. Then B is turned by `M = -kappa (phi - phi0) - c dphi/dt` and A by its opposite, in N m. Elastic energy
//! `kappa (phi - phi0)^2/2`; the damper takes `c (dphi/dt)^2` watts, booked as `damping`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::link::{self, DAMPING, ForceLink, LinkEnd, Partner};
use crate::scene::units::{Angle, Dimension, Powers, Quantity};
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::critical_step;
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::tick::{Dependence, Energies, Loss, Model, State, SteadySpring, TickAppExt};
use crate::world::Bodies;

/// A spring with a parallel damper against the rotation of a body relative to another or to the world. Its torque is
/// `stiffness (phi - angle) + damping dphi/dt` against the angle `phi` of `b` relative to `a`. Angles count full turns.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TorsionSpring {
    /// The body on one side.
    #[serde(deserialize_with = "link::body_at_a")]
    a: String,
    /// The body on the other side, or `World`, which never turns.
    b: Partner,
    /// Torque over turn in N m/rad. Not negative.
    stiffness: Quantity<TorsionStiffness>,
    /// Torque over relative spin in N m s/rad. Not negative. Default: 0.
    #[serde(default)]
    damping: Quantity<TorsionDamping>,
    /// Angle of `b` relative to `a` without torque, in rad. Default: the angle at the start.
    angle: Option<Angle>,
}

/// Dimension of torque over turn.
struct TorsionStiffness;

impl Dimension for TorsionStiffness {
    const NAME: &'static str = "a torsion stiffness";
    const POWERS: Powers = Powers { meter: 2, kilogram: 1, second: -2, radian: -1 };
    const UNIT: &'static str = "N m/rad";
    const EXAMPLE: &'static str = "`2.5` or \"2.5 N m/rad\"";
}

/// Dimension of torque over spin.
struct TorsionDamping;

impl Dimension for TorsionDamping {
    const NAME: &'static str = "a torsion damping";
    const POWERS: Powers = Powers { meter: 2, kilogram: 1, second: -1, radian: -1 };
    const UNIT: &'static str = "N m s/rad";
    const EXAMPLE: &'static str = "`0.1` or \"0.1 N m s/rad\"";
}

impl Entry for TorsionSpring {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "TorsionSpring";
    const EXAMPLE: &'static str = "TorsionSpring(a: \"arm\", b: World, stiffness: 2, damping: 0.1)";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        link::check_ends(&self.a, &self.b, outline, report);
        link::check_holds(self.stiffness, self.damping, report);
        if let Some(angle) = self.angle {
            report.finite("angle", angle);
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for WrittenEntry { value, .. } in entries {
            app.add_model(TorsionSpringForce {
                link: ForceLink::named(&value.a, &value.b, outline),
                stiffness: value.stiffness.si(),
                damping: value.damping.si(),
                power: 0.0,
                angle: value.angle.map(Angle::si),
            });
        }
    }
}

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct TorsionSpringForce {
    /// Its sides.
    pub link: ForceLink,
    /// Stiffness in N m/rad.
    pub stiffness: f64,
    /// Damping in N m s/rad.
    pub damping: f64,
    /// Power that the damper took in the last evaluation, in watts.
    power: f64,
    /// Relative angle without torque in rad. `None`: the angle at the start, which then replaces it.
    pub angle: Option<f64>,
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<TorsionSpring>();
}

/// Angle in rad and spin in rad/s of B relative to A.
fn twist(a: &LinkEnd, b: &LinkEnd, bodies: &Bodies) -> (f64, f64) {
    let (a, b) = (a.turn(bodies), b.turn(bodies));
    (b.0 - a.0, b.1 - a.1)
}

impl TorsionSpringForce {
    fn turned(&self, angle: f64) -> f64 {
        angle - self.angle.unwrap_or(angle)
    }
}

impl Model for TorsionSpringForce {
    fn dependence(&self) -> Dependence {
        if self.damping > 0.0 { Dependence::Velocity } else { Dependence::Position }
    }

    /// Takes the angle at the start for one that the scene does not give.
    fn start(&mut self, world: &mut World) {
        let bodies = &world.resource::<State>().bodies;
        if let Some((a, b)) = self.link.ends(bodies) {
            self.angle.get_or_insert(twist(&a, &b, bodies).0);
        }
    }

    fn loss(&self) -> Option<Loss> {
        (self.damping > 0.0).then_some(Loss { account: DAMPING, power: self.power })
    }

    fn save(&self) -> Memory {
        Memory::of(&(self.power, self.angle))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        (self.power, self.angle) = recall(bytes)?;
        Ok(())
    }

    fn energies(&self, state: &State) -> Energies {
        let turned = self.link.ends(&state.bodies).map(|(a, b)| self.turned(twist(&a, &b, &state.bodies).0));
        Energies { potential: 0.0, elastic: 0.5 * self.stiffness * turned.unwrap_or(0.0).powi(2) }
    }

    fn stiffness(&self, state: &State, list: &mut Vec<SteadySpring>) {
        let Some((a, b)) = self.link.ends(&state.bodies) else { return };
        let Some((a, b)) = link::sides(&a, &b) else { return };
        let spring = critical_step::Spring {
            a,
            b,
            normal: DVec2::X,
            stiffness: (0.0, 0.0),
            damped: 0.0,
            turning: self.stiffness,
        };
        list.push(SteadySpring { spring, damping: 0.0, turning_damping: self.damping });
    }

    fn apply_forces(&mut self, state: &mut State) {
        let (bodies, rates) = state.bodies_and_rates();
        self.power = 0.0;
        self.link.refresh(bodies);
        let Some((a, b)) = self.link.ends(bodies) else { return };
        let (angle, spin) = twist(&a, &b, bodies);
        let torque = -self.stiffness * self.turned(angle) - self.damping * spin;
        self.power = self.damping * spin * spin;
        link::twist(&a, &b, torque, bodies, rates);
    }
}
