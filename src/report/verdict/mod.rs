//! The verdict: one plain line on how far a run can be trusted. It names the parts to trust, and the parts to doubt with the
//! place and time at which doubt begins. Then it names a remedy.
//!
//! Each cause is a function that looks at the evidence: the card and the world. A cause that leaves nothing to trust is told
//! alone. Causes stand in such an order that the first explains later ones. A tick above the critical one spoils all else too.

mod ahead;
mod asked;
mod contradiction;
mod energy;
mod far_places;
mod near;
mod overlap;
mod part;
mod softness;
mod ticks;
mod trajectory_error;
mod voice;

use bevy_ecs::prelude::*;

use super::card::{Card, name};
use crate::estimate::EstimatedError;
use jostle_engine::constraints::RowKind;
use jostle_engine::tick::{Failure, FailureKind, State};
use jostle_language::numbers::{number, percent, rough};
use part::VerdictPart;

/// The evidence from which a verdict follows.
pub(super) struct Evidence<'a> {
    pub world: &'a World,
    pub card: &'a Card,
}

/// How far a run can be trusted.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Trust {
    /// Not at all: the run is not the motion of the scene.
    Not,
    /// Except for a part.
    ButNot(VerdictPart),
}

/// A likely reason for which a run is wrong.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cause {
    pub trust: Trust,
    /// A description, with bodies and times.
    pub what: String,
    /// The change that would mend it.
    pub remedy: Option<String>,
}

/// A run of more bodies with a tolerance takes longer than its user would wait.
const FEW: usize = 30;

/// All causes, in such an order that the first explains later ones.
const CAUSES: [fn(&Evidence) -> Option<Cause>; 24] = [
    ticks::unstable,
    asked::otherwise,
    ahead::overlaps_at_the_start,
    ahead::drag,
    near::attraction,
    far_places::rounding,
    energy::not_finite,
    contradiction::held,
    ticks::unseen_swing,
    ticks::unseen_path,
    energy::unaccounted,
    energy::given_back,
    trajectory_error::contradicted,
    trajectory_error::restless,
    trajectory_error::finer_run_failed,
    trajectory_error::tolerance_not_reached,
    overlap::deep,
    ticks::brief_contact,
    ticks::far_travel_unseen,
    trajectory_error::soft_contacts,
    trajectory_error::chaos,
    trajectory_error::inexact,
    trajectory_error::not_run_again,
    trajectory_error::unknown,
];

impl Evidence<'_> {
    /// The remedy that the card advises, or a finer one.
    pub fn finer(&self) -> Option<String> {
        self.card.remedy().map(|remedy| remedy.or_finer())
    }

    /// Advises a tolerance beside a tick, if the run goes by ticks and has few bodies.
    pub fn or_tolerance(&self) -> &'static str {
        let few = self.world.resource::<State>().bodies().len() <= FEW;
        if few && self.card.by_ticks() { ", or `--tolerance 0.001`" } else { "" }
    }

    /// A warning of missing energy.
    pub fn missing_energy(&self) -> Option<String> {
        let Cause { what, remedy, .. } = energy::unaccounted(self)?;
        Some(remedy.map_or_else(|| what.clone(), |remedy| format!("{what}. Use {remedy}")))
    }

    /// The likely cause of a failed run, and a remedy to try.
    pub fn why(&self, failure: &Failure) -> String {
        if matches!(failure.wrong, FailureKind::Steps(_)) {
            return near::of_endless_steps(self);
        }
        if matches!(failure.wrong, FailureKind::Jumps { .. }) {
            return "let it jump less often: a servo by a lower `rate`, a table or path by points that are farther apart".to_owned();
        }
        if matches!(failure.wrong, FailureKind::Pairs(_)) {
            return "use fewer bodies, keep them apart, or take a finer tick if they go far in one. Bodies that are not to touch \
                    take `collides: false`"
                .to_owned();
        }
        if failure.wrong == FailureKind::Contradiction {
            return "give the motor a `limit`, move the limits of the joint that stops it, or remove one of them"
                .to_owned();
        }
        let rows = self.world.resource::<State>().rows().all();
        let driven = rows.iter().any(|row| row.kind == RowKind::Velocity && !row.gives_way());
        if matches!(failure.wrong, FailureKind::Joint { .. }) && driven {
            return "a motor without a `limit` drives on with any force, also into a dead point, where bars are in line. Give it a \
                    `limit`, or reverse it before that"
                .to_owned();
        }
        if matches!(failure.wrong, FailureKind::Torn(_) | FailureKind::Lost(_) | FailureKind::Gone(_)) {
            return "look at the changes that a plugin makes to the world".to_owned();
        }
        if matches!(failure.wrong, FailureKind::Behind(_)) {
            return "stiffness and tick do not matter here: the wall is open on the side that the body hit".to_owned();
        }
        let deep = matches!(failure.wrong, FailureKind::Crossed(_) | FailureKind::Sunk(_));
        let known = [
            ahead::overlaps_at_the_start,
            ticks::unstable,
            asked::otherwise,
            ahead::drag,
            near::attraction,
            far_places::rounding,
        ];
        let Some(Cause { what, remedy, .. }) = known.into_iter().find_map(|cause| cause(self)) else {
            if deep {
                return "a stiffer contact bears more, and a finer tick sees bodies before they are deep in each other"
                    .to_owned();
            }
            return energy::of_unknown_cause(self);
        };
        remedy.map_or_else(|| what.clone(), |remedy| format!("{what}: try {remedy}"))
    }

    /// The time in s until which the run was repeated with finer steps, if not to its end. The error of the rest is not known.
    fn known_until(&self) -> Option<f64> {
        self.world.get_resource::<EstimatedError>().and_then(|estimated| estimated.known_until)
    }

    /// The name of a body or wall.
    pub fn name(&self, entity: Entity) -> String {
        name(self.world, entity)
    }

    /// The verdict of a run that reached its end.
    pub fn verdict(&self) -> String {
        let causes = CAUSES.iter().filter_map(|cause| cause(self)).collect();
        match voice::doubts(causes) {
            Ok(doubts) => voice::told(self, &doubts),
            Err(Cause { what, remedy, .. }) => {
                let help = remedy.map_or_else(String::new, |remedy| format!(" Use {remedy}."));
                format!("{DISTRUST}: {what}.{help}")
            }
        }
    }
}

/// The beginning of a verdict that leaves nothing to trust.
pub(super) const DISTRUST: &str = "Do not trust it";

/// A share of how far bodies go.
fn of_the_way(share: f64) -> String {
    format!("{} of how far bodies go", percent(share))
}

/// Places and velocities in words.
fn places(card: &Card) -> Option<String> {
    let error = card.error.as_ref()?;
    let (position, velocity) = error.position.sum().zip(error.velocity.sum())?;
    Some(format!("places to about {} m, velocities to about {} m/s", rough(position), rough(velocity)))
}

/// A time in s.
fn at(time: f64) -> String {
    format!("t = {} s", number(time))
}
