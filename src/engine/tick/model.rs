//! What acts in a run: every force, spring, drive and contact law is a [`Model`], with its parameters captured, and a run has as
//! many of them as its scene names.

use std::any::Any;

use bevy_ecs::prelude::World;
use glam::DVec2;

use super::snapshot::{Memory, Unfit};
use super::touch::ContactPoint;
use super::{Responses, State, SteadySpring, Style};
use crate::constraints::Rows;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// What a force, or the power that it books, depends on. An integrator that keeps velocities at half steps provides whole-step velocities to
/// those who need them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dependence {
    /// Nothing: the force is the same always. Bodies that are asleep ([`Bodies::asleep`](crate::world::Bodies::asleep)) are
    /// to be left out, and so is what they would bring to the rates.
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

/// A part of all forces on a body, as sensors tell them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForcePart {
    /// Forces of springs and dampers.
    Spring,
    /// Forces of joints, and of what drives them.
    Joint,
}

/// The force of a model on a body, as sensors and pictures tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceOn {
    /// The part of all forces to which it counts.
    pub part: ForcePart,
    /// In newtons.
    pub force: DVec2,
    /// Where it acts on the body, in metres.
    pub point: DVec2,
}

impl ForceOn {
    /// That on `body` of something with two ends, each with its body, the point at which it acts and the force there. `None`: neither
    /// end is on the body. Where both are, the point is that of the first.
    pub fn of_ends(part: ForcePart, body: usize, ends: [(Option<usize>, DVec2, DVec2); 2]) -> Option<Self> {
        let own = ends.into_iter().filter(|(of, ..)| *of == Some(body));
        let forces = own.map(|(_, point, force)| Self { part, force, point });
        forces.reduce(|first, second| Self { force: first.force + second.force, ..first })
    }
}

/// A physical model: what it does in each stage of a step, and what it owes the card.
///
/// Models act in the order in which they were added. Required is what must not be left out in silence: energies and stiffness. A
/// model that has none says so with a default value and an empty body.
pub trait Model: Any + Send + Sync {
    /// What it is called where the systems of a scene are listed. Default: the name of its type.
    fn name(&self) -> &'static str {
        std::any::type_name::<Self>()
    }

    /// The energies in J that it holds in the present state.
    fn energies(&self, state: &State) -> Energies;

    /// For sensors and pictures: its force on the body of this index in the present state. Default: they hear of no force.
    fn force_on(&self, _: &State, _: usize) -> Option<ForceOn> {
        None
    }

    /// The power that it took in the evaluation just made, if that goes to an account of its own; drag, friction and inelasticity
    /// have theirs in [`Balance`](super::Balance). Default: it has no such account.
    fn loss(&self) -> Option<Loss> {
        None
    }

    /// Adds its springs in their present state: the critical tick follows from them. Contact laws tell
    /// [`Model::responses`] instead.
    fn stiffness(&self, state: &State, springs: &mut Vec<SteadySpring>);

    /// What its force depends on. Default: positions and velocities.
    fn dependence(&self) -> Dependence {
        Dependence::Velocity
    }

    /// Whether its force does not depend on the places of bodies that touch nothing, nor on their velocities: discs may then fly
    /// along parabolas while nothing else acts on them. Default: no.
    fn flies(&self) -> bool {
        false
    }

    /// The name of the contact law, as scenes write it, if it is one. Default: it is none.
    fn contact_law(&self) -> Option<&'static str> {
        None
    }

    /// Once, when the whole scene stands and before the first tick.
    fn start(&mut self, _: &mut World) {}

    /// Stage Pairs of an evaluation: who may touch whom.
    fn find_pairs(&mut self, _: &mut State) {}

    /// Stage Forces of an evaluation: adds to the forces and torques of bodies, and to the rates of the ledger.
    fn apply_forces(&mut self, _: &mut State) {}

    /// Adds the rows of what it holds in place or in velocity, for these bodies at a time in seconds: their gaps, rates and
    /// directions. The engine asks in each evaluation, and where it brings states back onto joints: the rows are always as many, in
    /// the same order. See [`Model::has_rows`].
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

    /// Before a step over [`State::span`]: chooses the modes that stay as they are in it. In [`Style::Frozen`] events alone change the modes of
    /// a model that has [`Model::events`]: it leaves them. See [`Model::has_modes`].
    fn begin_step(&mut self, _: &mut State) {}

    /// Whether [`Model::begin_step`] does anything. Default: no.
    fn has_modes(&self) -> bool {
        false
    }

    /// Whether [`Model::find_pairs`] does anything. Default: no.
    fn finds_pairs(&self) -> bool {
        false
    }

    /// At the end of a tick: looks at the state, and may note what the card has to know. See [`Model::looks_at_ticks`].
    fn end_tick(&mut self, _: &mut State) {}

    /// Whether [`Model::end_tick`] does anything. Default: no.
    fn looks_at_ticks(&self) -> bool {
        false
    }

    /// How fast it responds, as far as it measured that itself. Default: it measured nothing.
    fn responses(&self) -> Responses {
        Responses::default()
    }

    /// State of its own and events, for methods with several stages. Default: none.
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

    /// Why it cannot be evaluated in a style, if so.
    fn objection(&self, _: Style) -> Option<Objection> {
        None
    }

    /// What it did otherwise in a style than the scene asks.
    fn departures(&self, _: &State, _: Style) -> Vec<Departure> {
        Vec::new()
    }

    /// What swings by the clock: a tick that the scene does not name is short enough for it.
    fn rhythm(&self) -> Option<Rhythm> {
        None
    }

    /// What it has to say of a run at its end, a sentence each for the notes of the card.
    fn remarks(&self, _: &State) -> Vec<String> {
        Vec::new()
    }

    /// All contacts of the present state in canonical order, if it is a contact law that tells them.
    fn contact_points(&self, _: &State) -> Option<Vec<ContactPoint>> {
        None
    }

    /// What it remembers beside its parameters. Default: it does not say, and snapshots refuse with its name.
    fn save(&self) -> Memory {
        Memory::Untold
    }

    /// Remembers what [`Model::save`] gave. Called only if that gave bytes.
    ///
    /// # Errors
    /// If the bytes are not its own.
    fn load(&mut self, _: &[u8]) -> Result<(), Unfit> {
        Ok(())
    }

    /// A part of it that [`State::model`] finds too. Default: none.
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
    /// The account of the ledger: `damping` stands on the card and is the channel `energy.damping`. Models may share one.
    pub account: &'static str,
    /// Power in watts.
    pub power: f64,
}

/// State of a model's own and its events, for methods that take several stages per step.
pub trait Events {
    /// How many numbers of its own the integrator advances by the same method as positions: elongations of springs, integrals of
    /// controllers. It may change when modes do, never inside a step. Default: none.
    fn length(&self) -> usize {
        0
    }

    /// Model -> state. Default: a model without numbers has nothing to copy.
    fn read(&self, _: &mut [f64]) {}

    /// What errors of its numbers are measured by, where that is more than the way of bodies: an integral grows while nothing moves. All are
    /// zero before. Default: nothing.
    fn measures(&self, _: &mut [f64]) {}

    /// State -> model, before an evaluation. Default: likewise.
    fn write(&mut self, _: &[f64]) {}

    /// Their rates per second, after an evaluation. Default: likewise.
    fn rates(&self, _: &State, _: &mut [f64]) {}

    /// Adds the indicators of the state just evaluated to the list. Their number and order change only where modes do.
    fn tell(&mut self, state: &State, told: &mut Vec<Indicator>);

    /// Changes the modes whose indicators vanished, given by their places in the model's own list of the present modes.
    fn switch(&mut self, state: &mut State, fired: &[usize]);

    /// At an event: tries another of its modes if that did not matter before, because others held what it holds. Says whether it does.
    /// Default: it does not.
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

    /// The state is one that others have made, and the ledger takes its energy as it is: the model books nothing that it took to choose the
    /// modes. Default: it has nothing to book.
    fn begin_account(&mut self, _: &State) {}

    /// After a step was accepted: takes rounding out of what must not drift. Says whether it changed velocities.
    /// Default: nothing drifts.
    fn tidy(&mut self, _: &mut State) -> bool {
        false
    }

    /// Adapts modes when states become stages of steps, or follow one another from then on. Default: they stay.
    fn hand_over(&mut self, _: &State, _: Style) {}

    /// Whether it holds more than can be resolved exactly in steps from event to event. Default: it does not.
    fn is_crowded(&self) -> bool {
        false
    }
}

/// An indicator of an event: it is positive while a mode holds, and the event is where it vanishes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Indicator {
    /// Its value in the state just evaluated.
    pub value: f64,
    /// Its rate per second there; NaN if the model does not know.
    pub slope: f64,
    /// How strongly it may bend downwards there: its second derivative, per second squared, is not below minus this.
    pub bend: f64,
    /// What rounding makes of its value: above minus this it has not vanished. Default: nothing.
    pub rounding: f64,
    /// Angular frequency in rad/s with which springs swing in this mode: steps resolve it. Default: zero, no spring acts.
    pub swings: f64,
}

/// Something that a model did otherwise than the scene asks.
#[derive(Clone, Debug, PartialEq)]
pub struct Departure {
    /// A clause that names the entry.
    pub what: String,
    /// What would help, without the word `use`.
    pub remedy: &'static str,
    /// How much of what was asked is missing or too much, as a share.
    pub share: f64,
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
