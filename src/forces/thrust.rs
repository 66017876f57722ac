//! Thrust: a force at a point of a body, constant in the body's frame or in the world's, between two times.
//!
//! It acts in a whole tick or not at all: in those whose middle lies between the two times. So a schedule on the grid
//! of ticks gives force times time to the last digit, and rounding of the times decides nothing.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};

use super::{Targets, check_targets};
use crate::scene::units::{ForcePair, Position, Time};
use crate::scene::values::Names;
use crate::scene::{Entry, Outline, Report, SceneAppExt, Written};
use crate::tick::{Balance, Dependence, EvaluateStage, Models, Modes, Span, TickAppExt};
use crate::world::Bodies;

/// A force at a point of a body, between two times. It acts in whole ticks: in those whose middle lies between the two
/// times.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Thrust {
    /// The bodies it acts on, `*` matches.
    of: Names,
    /// Where it acts, in the body's frame from its centre of mass, in metres. Default: (0, 0), the centre of mass.
    #[serde(default)]
    at: Position,
    /// Force in newtons.
    force: ForcePair,
    /// Whether the force turns with the body. Default: `World`.
    #[serde(default)]
    frame: ThrustFrame,
    /// It acts from this time on, in seconds. Default: 0.
    #[serde(default)]
    from: Time,
    /// It no longer acts at this time, in seconds. Default: it never ends.
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

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        check_targets(Some(&self.of), outline, report);
        if self.to.is_some_and(|to| to.si() <= self.from.si()) {
            report.error("to", format!("must be later than `from`, {} s", self.from.si()));
        }
    }

    fn install(entries: Vec<Written<Self>>, outline: &Outline, app: &mut App) {
        let thrust = |Written { value, .. }: Written<Self>| ThrustForce {
            of: Targets::named(Some(&value.of), outline),
            at: value.at.si(),
            force: value.force.si(),
            turns: value.frame == ThrustFrame::Body,
            from: value.from.si(),
            to: value.to.map_or(f64::INFINITY, Time::si),
            acts: false,
        };
        install(entries.into_iter().map(thrust).collect(), app);
    }
}

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct ThrustForce {
    /// The bodies it acts on.
    pub of: Targets,
    /// Where it acts, in the body's frame from its centre of mass, in metres.
    pub at: DVec2,
    /// Force in newtons.
    pub force: DVec2,
    /// Whether the force turns with the body.
    pub turns: bool,
    /// It acts from this time on, in seconds.
    pub from: f64,
    /// It no longer acts at this time, in seconds.
    pub to: f64,
    /// Whether it acts in the present tick; false at the beginning.
    pub acts: bool,
}

#[derive(Resource)]
struct Thrusts(Vec<ThrustForce>);

/// Installs thrust.
pub fn install(thrusts: Vec<ThrustForce>, app: &mut App) {
    app.insert_resource(Thrusts(thrusts));
    // The force does not depend on velocities, its power does.
    app.add_packed_force(Dependence::Velocity, apply_thrust);
    app.add_systems(Modes, switch_thrust.in_set(EvaluateStage::Forces));
    app.world_mut().get_resource_or_init::<Models>().edges.push(next_edge);
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Thrust>();
}

fn apply_thrust(mut thrusts: ResMut<Thrusts>, mut bodies: ResMut<Bodies>, mut balance: ResMut<Balance>) {
    for thrust in thrusts.0.iter_mut().filter(|thrust| thrust.acts) {
        thrust.push(&mut bodies, &mut balance, 1.0);
    }
}

/// Before a tick: what begins or ends with it is added to or taken from the sums of its beginning.
fn switch_thrust(
    mut thrusts: ResMut<Thrusts>,
    mut bodies: ResMut<Bodies>,
    mut balance: ResMut<Balance>,
    span: Res<Span>,
) {
    let middle = span.middle();
    for thrust in &mut thrusts.0 {
        let acts = (thrust.from..thrust.to).contains(&middle);
        if acts != thrust.acts {
            thrust.acts = acts;
            thrust.push(&mut bodies, &mut balance, if acts { 1.0 } else { -1.0 });
        }
    }
}

/// The first time after `time` at which a thrust begins or ends.
fn next_edge(world: &World, time: f64) -> f64 {
    let edges = world.resource::<Thrusts>().0.iter().flat_map(|thrust| [thrust.from, thrust.to]);
    edges.filter(|edge| *edge > time).fold(f64::INFINITY, f64::min)
}

impl ThrustForce {
    fn push(&mut self, bodies: &mut Bodies, balance: &mut Balance, times: f64) {
        for body in self.of.places(bodies) {
            let (sin, cos) = libm::sincos(bodies.angle[body]);
            let rotation = DVec2::new(cos, sin);
            let force = times * if self.turns { rotation.rotate(self.force) } else { self.force };
            let arm = rotation.rotate(self.at);
            bodies.push(body, arm, force);
            balance.outside(bodies.position[body], force, arm.perp_dot(force));
            balance.work += force.dot(bodies.velocity_at(body, arm));
        }
    }
}
