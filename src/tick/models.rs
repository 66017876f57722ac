//! What models tell an integrator that takes several stages per step: state of their own, and where their forces jump.

use bevy_ecs::prelude::*;

use super::Style;

/// Models that have more to say than forces.
#[derive(Resource, Clone, Debug, Default)]
pub struct Models {
    /// State beside poses and velocities, in the order of registration.
    pub blocks: Vec<StateBlock>,
    /// What is watched for events, in the order of registration.
    pub watches: Vec<Watch>,
    /// Times at which forces or their rates are known to jump: each gives the first one after a time in seconds, or infinity.
    pub edges: Vec<fn(&World, f64) -> f64>,
    /// What changes in a model when states become stages of steps, or follow one another from then on.
    pub handovers: Vec<fn(&mut World, Style)>,
    /// Whether a model holds more than can be resolved exactly in steps from event to event.
    pub crowds: Vec<fn(&World) -> bool>,
    /// Models that cannot be evaluated in every style: each says why not, as the path of what is in the way, what is wrong
    /// and what would help.
    pub objections: Vec<fn(&World, Style) -> Option<Objection>>,
    /// What models did otherwise in a style than the scene asks: sentences for the card, each with the entry and a remedy.
    pub departures: Vec<fn(&World, Style) -> Vec<String>>,
    /// What swings by the clock: a tick that the scene does not name is short enough for it.
    pub rhythms: Vec<Rhythm>,
    /// What models have to say of a run at its end: a sentence each for the notes of the card.
    pub remarks: Vec<fn(&World) -> Option<String>>,
}

/// A force that swings by the clock.
#[derive(Clone, Debug, PartialEq)]
pub struct Rhythm {
    /// Where it stands in the scene, such as `forces[0]`.
    pub path: String,
    /// How fast it swings, in rad/s; zero if it does not.
    pub angular_frequency: f64,
}

/// Why a model cannot be evaluated in a style.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Objection {
    /// The path of what is in the way in the scene.
    pub path: &'static str,
    /// What is wrong.
    pub message: String,
    /// What would help.
    pub help: &'static str,
}

/// State that a model keeps of its own and the integrator advances by the same method as positions: the elongation of a
/// tangential spring, the integral of a controller.
#[derive(Clone, Copy, Debug)]
pub struct StateBlock {
    /// How many numbers; it may change when modes do, never inside a step.
    pub length: fn(&World) -> usize,
    /// Model -> state.
    pub read: fn(&World, &mut [f64]),
    /// State -> model, before an evaluation.
    pub write: fn(&mut World, &[f64]),
    /// Their rates, after an evaluation.
    pub rates: fn(&World, &mut [f64]),
}

/// An indicator of an event: it is positive while a mode holds, and the event is where it vanishes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Indicator {
    /// Its value in the state just evaluated.
    pub value: f64,
    /// Its rate per second there; not a number if the model does not know.
    pub slope: f64,
    /// How strongly it may bend downwards there: its second derivative, per second squared, is not below minus this.
    pub bend: f64,
    /// What rounding makes of its value: above minus this it has not vanished. Default: nothing.
    pub rounding: f64,
    /// Angular frequency in rad/s with which springs swing in this mode: steps resolve it. Default: zero, no spring acts.
    pub swings: f64,
}

/// A model whose forces jump, or whose modes end.
#[derive(Clone, Copy, Debug)]
pub struct Watch {
    /// Adds the indicators of the state just evaluated to the list. Their number and order change only where modes do.
    pub tell: fn(&mut World, &mut Vec<Indicator>),
    /// Changes the modes whose indicators vanished, given by their places in the model's own list of the present modes.
    pub switch: fn(&mut World, &[usize]),
    /// Looks at accelerations just evaluated in the present modes and corrects modes that cannot last; says whether it did.
    pub settle: fn(&mut World) -> bool,
    /// Chooses all modes of a state that did not follow from the one before.
    pub take_stock: fn(&mut World),
    /// After a step was accepted: takes rounding out of what must not drift. Says whether it changed velocities.
    pub tidy: fn(&mut World) -> bool,
}
