//! Models: every force, spring, drive and contact law is a [`Model`] with its parameters. A run has all models that its
//! scene names.

use std::any::Any;

use bevy_ecs::prelude::World;
use glam::DVec2;

use super::snapshot::{Memory, UnfitSnapshot};
use super::touch::ContactPoint;
use super::{BlowAtJoint, EvaluationMode, State, SteadySpring, TimeScales};
use crate::constraints::Rows;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// The inputs of a force, or of the power that it books. An integrator that keeps velocities at half steps provides
/// whole-step velocities to forces that depend on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dependence {
    /// No input: the force is constant. The force must omit sleeping bodies
    /// ([`Bodies::asleep`](crate::world::Bodies::asleep)), and so must its rates.
    Nothing,
    /// Time and positions only.
    Position,
    /// Velocities too.
    Velocity,
}

/// Energies in J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// In fields.
    pub potential: f64,
    /// In springs and contacts.
    pub elastic: f64,
}

/// A part of all forces on a body, for sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForcePart {
    /// Forces of springs and dampers.
    Spring,
    /// Forces of joints, and of what drives them.
    Joint,
}

/// The force of a model on a body, for sensors and pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceOn {
    /// The part of all forces to which it counts.
    pub part: ForcePart,
    /// In newtons.
    pub force: DVec2,
    /// The point of the body at which it acts, in metres.
    pub point: DVec2,
}

impl ForceOn {
    /// The force on `body` of a model with two ends. Each end has its body, the point of action, and the force there.
    /// `None`: neither end is on the body. If both are, the point is that of the first.
    pub fn of_ends(part: ForcePart, body: usize, ends: [(Option<usize>, DVec2, DVec2); 2]) -> Option<Self> {
        let own = ends.into_iter().filter(|(of, ..)| *of == Some(body));
        let forces = own.map(|(_, point, force)| Self { part, force, point });
        forces.reduce(|first, second| Self { force: first.force + second.force, ..first })
    }
}

/// A physical model: its action in each stage of a step, and its contributions to the card.
///
/// Models act in the order in which they were added. Energies and stiffness are required, because their omission would
/// be silent. A model without them returns a default value or has an empty body.
pub trait Model: Any + Send + Sync {
    /// Its name in lists of the systems of a scene. Default: the name of its type.
    fn name(&self) -> &'static str {
        std::any::type_name::<Self>()
    }

    /// The energies in J that it holds in the present state.
    fn energies(&self, state: &State) -> Energies;

    /// For sensors and pictures: its force on the body of this index in the present state. Default: no force.
    fn force_on(&self, _: &State, _: usize) -> Option<ForceOn> {
        None
    }

    /// The power that it took in the last evaluation, if it has a separate account. Drag, friction and inelasticity
    /// have theirs in [`Rates`](super::Rates). Default: no separate account.
    fn loss(&self) -> Option<Loss> {
        None
    }

    /// Adds its springs in their present state: the critical tick follows from them. Contact laws provide
    /// [`Model::time_scales`] instead.
    fn stiffness(&self, state: &State, springs: &mut Vec<SteadySpring>);

    /// The inputs of its force. Default: positions and velocities.
    fn dependence(&self) -> Dependence {
        Dependence::Velocity
    }

    /// Whether its force is independent of the positions and velocities of bodies that touch nothing. If so, discs may
    /// fly along parabolas while no other force acts on them. Default: no.
    fn flies(&self) -> bool {
        false
    }

    /// The name of the contact law in scenes, if it is one. Default: it is not.
    fn contact_law(&self) -> Option<&'static str> {
        None
    }

    /// Called once, after the whole scene is built and before the first tick.
    fn start(&mut self, _: &mut World) {}

    /// Stage Pairs of an evaluation: finds the pairs that may touch.
    fn find_pairs(&mut self, _: &mut State) {}

    /// Stage Forces of an evaluation: adds to the forces and torques of bodies, and to the rates of the ledger.
    fn apply_forces(&mut self, _: &mut State) {}

    /// Adds the rows of its constraints on positions or velocities, with gaps, rates and directions. The bodies are
    /// those at a time in seconds. The engine calls it in each evaluation, and when it brings states back onto joints.
    /// Number and order of the rows never change. See [`Model::has_rows`].
    fn add_rows(&mut self, _: &Bodies, _: f64, _: &mut Rows) {}

    /// Stage Constraints of an evaluation: its rows, added to [`State::rows_mut`] in [`Model::apply_forces`], have been solved.
    /// It gives their forces to the bodies, for example by [`State::apply_rows`]. See [`Model::has_rows`].
    fn take_rows(&mut self, _: &mut State) {}

    /// Whether it may hold something exactly, by rows. Default: no.
    fn has_rows(&self) -> bool {
        false
    }

    /// Stage Settle of an evaluation, after all forces. See [`Model::settles`].
    fn settle(&mut self, _: &mut State) {}

    /// Whether [`Model::settle`] does anything. Default: no.
    fn settles(&self) -> bool {
        false
    }

    /// Velocities have jumped before the step ([`State::strike`]): what holds only as long as a bounded force suffices may give way.
    fn after_blow(&mut self, _: &mut State) {}

    /// The force in N at which its rows break. Default: they never do.
    fn break_force(&self) -> Option<f64> {
        None
    }

    /// A blow at its rows, which have a break force. `breaks`: they break by it and give no impulse.
    fn take_blow(&mut self, _: BlowAtJoint, _breaks: bool) {}

    /// Before a step over [`State::span`]: chooses the modes that stay fixed in it. In [`EvaluationMode::Frozen`] only events
    /// change the modes of a model that has [`Model::events`]. Such a model does nothing. See [`Model::has_modes`].
    fn begin_step(&mut self, _: &mut State) {}

    /// Whether [`Model::begin_step`] does anything. Default: no.
    fn has_modes(&self) -> bool {
        false
    }

    /// Whether [`Model::begin_step`] reads velocities or changes forces. The last kick of the tick before is then applied first. It
    /// may still wait to be applied together with the first one of this tick. Default: yes.
    fn begins_with_velocities(&self) -> bool {
        true
    }

    /// Whether [`Model::find_pairs`] does anything. Default: no.
    fn finds_pairs(&self) -> bool {
        false
    }

    /// At the end of a tick: reads the state, and may leave notes for the card. See [`Model::looks_at_ticks`].
    fn end_tick(&mut self, _: &mut State) {}

    /// Whether [`Model::end_tick`] does anything. Default: no.
    fn looks_at_ticks(&self) -> bool {
        false
    }

    /// Its measured responses. Default: none.
    fn time_scales(&self) -> TimeScales {
        TimeScales::default()
    }

    /// States of the model and events, for methods with several stages. Default: none.
    fn events(&mut self) -> Option<&mut dyn Events> {
        None
    }

    /// Whether it has times at which forces or their rates jump. Default: no.
    fn has_edges(&self) -> bool {
        false
    }

    /// The first of them after a time in seconds, or infinity.
    fn next_edge(&self, _: f64) -> f64 {
        f64::INFINITY
    }

    /// The reason why it cannot be evaluated in a style, if there is one.
    fn objection(&self, _: EvaluationMode) -> Option<Objection> {
        None
    }

    /// Its departures in a style from the request of the scene.
    fn departures(&self, _: &State, _: EvaluationMode) -> Vec<Departure> {
        Vec::new()
    }

    /// The oscillation of its force in time. If the scene names no tick, the tick is short enough for it.
    fn rhythm(&self) -> Option<Rhythm> {
        None
    }

    /// Its remarks on a run at the end, a sentence each for the notes of the card.
    fn remarks(&self, _: &State) -> Vec<String> {
        Vec::new()
    }

    /// All contacts of the current state in canonical order, if it is a contact law that provides them.
    fn contact_points(&self, _: &State) -> Option<Vec<ContactPoint>> {
        None
    }

    /// Its memory beside its parameters. Default: unknown, and snapshots refuse with its name.
    fn save(&self) -> Memory {
        Memory::Untold
    }

    /// Remembers what [`Model::save`] gave. Called only if that gave bytes.
    ///
    /// # Errors
    /// If the bytes are not its own.
    fn load(&mut self, _: &[u8]) -> Result<(), UnfitSnapshot> {
        Ok(())
    }

    /// Whether its memory fits the state of a snapshot, after both were loaded. A file may hold any indices, lengths and
    /// numbers, so a model checks those that it trusts. Default: it trusts none.
    ///
    /// # Errors
    /// If they do not fit, with the name of the part: see [`demand`](super::snapshot::demand).
    fn fits(&self, _: &State) -> Result<(), UnfitSnapshot> {
        Ok(())
    }

    /// A part of it that [`State::model`] also finds. Default: none.
    fn inner(&self) -> Option<&dyn Any> {
        None
    }

    /// The same, to be changed.
    fn inner_mut(&mut self) -> Option<&mut dyn Any> {
        None
    }
}

/// Energy that a model takes out of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// The account of the ledger: `damping` appears on the card and is the channel `energy.damping`. Models may share
    /// one.
    pub account: &'static str,
    /// Power in watts.
    pub power: f64,
}

/// State of a model's own and its events, for methods that take several stages per step.
pub trait Events {
    /// The number of own variables that the integrator advances with positions, such as elongations of springs or integrals of
    /// controllers. It may change when modes do, never inside a step. Default: none.
    fn length(&self) -> usize {
        0
    }

    /// Model -> state. Default: a model without numbers has nothing to copy.
    fn read(&self, _: &mut [f64]) {}

    /// The units of errors of its states, if they exceed the way of bodies. An integral grows while bodies are at rest. An infinite
    /// one asks for no accuracy. All are zero before. Default: no change.
    fn measures(&self, _: &mut [f64]) {}

    /// State -> model, before an evaluation. Default: likewise.
    fn write(&mut self, _: &[f64]) {}

    /// Their rates per second, after an evaluation. Default: likewise.
    fn rates(&self, _: &State, _: &mut [f64]) {}

    /// Adds the indicators of the state just evaluated to the list. Their number and order change only where modes do.
    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>);

    /// Changes the modes whose indicators vanished, given by their places in the model's own list of the present modes.
    fn switch(&mut self, state: &mut State, fired: &[usize]);

    /// At an event: tries another of its modes if that had no effect before, because others held the same motion.
    /// Returns whether it does. Default: it does not. Default: it does not.
    fn look_again(&mut self) -> bool {
        false
    }

    /// Looks at accelerations just evaluated in the present modes and corrects modes that cannot last; says whether it did.
    /// Default: modes change at their indicators alone.
    fn settle(&mut self, _: &State) -> bool {
        false
    }

    /// Chooses all modes of a state that did not follow from the one before. Default: they stay.
    fn take_stock(&mut self, _: &State) {}

    /// Others have made the state, and the ledger takes its energy as it is. The model books no loss of its choice of
    /// modes. Default: no action.
    fn begin_account(&mut self, _: &State) {}

    /// The loss in J to friction since the last [`Events::tidy`] that the model books there, and not as a rate. Asked in states inside a
    /// step. Default: none.
    fn unbooked(&mut self, _: &State) -> f64 {
        0.0
    }

    /// After a step was accepted: takes rounding out of what must not drift. Says whether it changed velocities.
    /// Default: nothing drifts.
    fn tidy(&mut self, _: &mut State) -> bool {
        false
    }

    /// Adapts modes when states become stages of steps, or follow one another from then on. Default: they stay.
    fn hand_over(&mut self, _: &State, _: EvaluationMode) {}

    /// Whether it holds more than can be resolved exactly in steps from event to event. Default: it does not.
    fn is_overloaded(&self) -> bool {
        false
    }
}

/// An indicator of an event: it is positive while a mode holds, and the event is its root.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Indicator {
    /// Its value in the state just evaluated.
    pub value: f64,
    /// Its rate per second there; NaN if the rate is unknown.
    pub slope: f64,
    /// The knowledge of its curvature, without which an event inside a step would pass unseen.
    pub bend: Bend,
    /// The rounding error of its value: above minus this it has not vanished. Zero for exact values.
    pub rounding: f64,
    /// Angular frequency in rad/s with which springs swing in this mode: steps resolve it. Zero if no spring acts.
    pub swings: f64,
}

/// The curvature of an indicator within a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Bend {
    /// Its second derivative, per second squared, is not below minus this number. If its rate is unknown, the absolute
    /// value is not above this number.
    AtMost(f64),
    /// As above, for a distance from a straight side. The bound grows by what lies across the side, as far as bodies turn.
    Turning(Turning),
    /// No bound is known. The integrator fits the curvature to values and rates at both ends of a step. If the rate is
    /// unknown, it fits the curvature to the values at the stages of the step.
    Fitted,
}

impl Indicator {
    /// An indicator with its rate per second, without rounding and without springs.
    pub fn new(value: f64, slope: f64, bend: Bend) -> Self {
        Self { value, slope, bend, rounding: 0.0, swings: 0.0 }
    }

    /// An indicator whose rate is unknown, such as that of the force of a row.
    pub fn of_value(value: f64, bend: Bend) -> Self {
        Self::new(value, f64::NAN, bend)
    }

    /// Of a mode that does not end by itself as long as others last.
    pub fn lasting(value: f64) -> Self {
        Self::new(value, 0.0, Bend::AtMost(0.0))
    }

    /// Whether its course within a step shows in its values at the stages of the step.
    pub fn is_sampled(&self) -> bool {
        self.slope.is_nan()
    }
}

impl Bend {
    /// The bound within the next `seconds`, per second squared; `None` if no bound is known.
    pub fn within(self, seconds: f64) -> Option<f64> {
        match self {
            Self::AtMost(bound) => Some(bound),
            Self::Turning(turning) => Some(turning.within(seconds)),
            Self::Fitted => None,
        }
    }
}

/// The acceleration of a place on one body relative to a straight side of another, and how fast both turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Turning {
    /// The greatest acceleration along the normal of the side, in m/s2.
    pub along: f64,
    /// The greatest acceleration along the side, in m/s2.
    pub across: f64,
    /// The sum of both spins in rad/s.
    pub spin: f64,
    /// The sum of both angular accelerations in rad/s2.
    pub acceleration: f64,
}

impl Turning {
    /// The greatest acceleration along the normal within some seconds, in m/s2. Angles bound their own sines.
    fn within(&self, seconds: f64) -> f64 {
        let angle = (self.spin + 0.5 * self.acceleration * seconds) * seconds;
        self.along + self.across * angle.min(1.0)
    }
}

/// Something that a model did otherwise than the scene asks.
#[derive(Clone, Debug, PartialEq)]
pub struct Departure {
    /// A clause that names the entry.
    pub what: String,
    /// The remedy, without the word `use`.
    pub remedy: &'static str,
    /// The missing or excess share of the request.
    pub share: f64,
}

/// A force that swings by the clock.
#[derive(Clone, Debug, PartialEq)]
pub struct Rhythm {
    /// Its path in the scene, such as `forces[0]`.
    pub path: String,
    /// Its angular frequency, in rad/s, or zero if it does not swing.
    pub angular_frequency: f64,
}

/// Why a model cannot be evaluated in a style.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Objection {
    /// The path of the obstacle in the scene.
    pub path: &'static str,
    /// The mistake.
    pub message: String,
    /// The remedy.
    pub help: &'static str,
}
