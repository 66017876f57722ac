//! The joint that a controller drives.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use glam::DVec2;

use crate::joints::KnownJoints;
use crate::joints::ends::{Along, EndPair, JointEnd, JointEnds};
use crate::joints::law::JointLaw;
use crate::scene::units::dimension::{OfForce, OfSpeed, OfSpin, OfTorque};
use crate::scene::units::{Either, Said};
use crate::scene::{Diagnostics, NameKind, Outline, SceneError};
use crate::tick::{ForceOn, ForcePart, LoadErrors, State};
use crate::world::Bodies;

/// A rate that is driven: a spin of a hinge, a speed of a slide.
pub(super) type DrivenSpeed = Either<OfSpin, OfSpeed>;

/// The driving action: a torque in a hinge, a force in a slide.
pub(super) type DrivenForce = Either<OfTorque, OfForce>;

/// The joint of a controller, whose free motion is driven.
pub(super) struct Driven {
    name: String,
    /// Fields of the controller whose units require a hinge (first) or a slide (second).
    given: Vec<(&'static str, Said)>,
    found: Option<(JointEnds, Arc<dyn JointLaw>)>,
}

/// The motion that is driven, in the present state.
pub(super) struct DrivenMotion {
    pub pair: EndPair,
    pub along: Along,
    /// In rad or m.
    pub value: f64,
    /// In rad/s or m/s.
    pub rate: f64,
}

/// Reports a joint that is not there.
pub(super) fn check(of: &str, outline: &Outline, report: &mut Diagnostics) {
    outline.require(NameKind::JOINT, of, "of", report);
}

impl Driven {
    pub fn named(name: String) -> Self {
        Self { name, given: Vec::new(), found: None }
    }

    /// The unit of a field shows whether the joint is a hinge or a slide.
    pub fn given(mut self, field: &'static str, said: Option<Said>) -> Self {
        self.given.extend(said.map(|said| (field, said)));
        self
    }

    /// Finds the joint, when all joints of the scene have begun. `path` is that of the controller in the scene.
    pub fn start(&mut self, path: &str, world: &mut World) {
        let known = world.get_resource::<KnownJoints>().and_then(|known| known.named(&self.name));
        self.found = known.map(|known| (known.ends.clone(), known.law.clone()));
        let bodies = &world.resource::<State>().bodies;
        let rod = self.found.as_ref().is_some_and(|(_, law)| law.needs_distance());
        // Gears and racks leave nothing free either: they are not among the joints that are known.
        if rod || self.motion(bodies).is_none() {
            let message = format!("the joint `{}` leaves no motion free that could be driven", self.name);
            let error = SceneError::new(format!("{path}.of"), message)
                .with_help("drive a hinge (`Revolute`) or a slide (`Prismatic`)");
            world.get_resource_or_init::<LoadErrors>().0.push(error);
            return;
        }
        let Some((_, law)) = &self.found else { return };
        let turns = law.freedom_name().0 == "angle";
        let (is, example) = if turns {
            ("a hinge, which turns", "give a unit of turning, such as rad, rpm or N m, or a number without a unit")
        } else {
            (
                "a slide, which moves along a line",
                "give a unit of a line, such as m, m/s or N, or a number without a unit",
            )
        };
        for (field, said) in &self.given {
            if turns != (*said == Said::First) {
                let message = format!("the unit does not fit: `{}` is {is}", self.name);
                let error = SceneError::new(format!("{path}.{field}"), message).with_help(example);
                world.get_resource_or_init::<LoadErrors>().0.push(error);
            }
        }
    }

    /// Reports a joint with limits.
    pub fn refuse_limits(&self, path: &str, world: &mut World) {
        let known = world.get_resource::<KnownJoints>().and_then(|known| known.named(&self.name));
        if known.is_some_and(|known| known.limited) {
            let message = format!("the motor of `{}` may give any torque, and the joint has limits", self.name);
            let error =
                SceneError::new(path.to_owned(), message).with_help("give the motor its greatest torque: `limit: 10`");
            world.get_resource_or_init::<LoadErrors>().0.push(error);
        }
    }

    /// The motion in the present state; `None` if a body is gone.
    pub fn motion(&self, bodies: &Bodies) -> Option<DrivenMotion> {
        let (ends, law) = self.found.as_ref()?;
        let pair = ends.pair(bodies)?;
        let freedom = law.freedom(&pair)?;
        Some(DrivenMotion { rate: pair.rate(&freedom.along), value: freedom.value, along: freedom.along, pair })
    }

    /// Looks up the bodies again after some came or went.
    pub fn refresh(&mut self, bodies: &Bodies) {
        if let Some((ends, _)) = &mut self.found {
            ends.refresh(bodies);
        }
    }

    /// For sensors: the force on a body that `amount` N m or N along the motion gives.
    pub fn force_on(&self, state: &State, body: usize, amount: f64) -> Option<ForceOn> {
        let DrivenMotion { pair, along, .. } = self.motion(state.bodies())?;
        let end = |end: &JointEnd, side: (DVec2, f64)| (end.body, end.position, side.0 * amount);
        ForceOn::of_ends(ForcePart::Joint, body, [end(&pair.a, along.sides[0]), end(&pair.b, along.sides[1])])
    }

    /// Adds a torque in N m, or a force in N, along the motion. Its power is work.
    pub fn push(motion: &DrivenMotion, amount: f64, state: &mut State) {
        let power = motion.pair.push(&motion.along, amount, state);
        state.bodies_and_rates().1.work += power;
    }
}
