//! Failures of runs.

use bevy_ecs::prelude::Entity;

use super::Clock;
use super::guard::Created;
use crate::scene::number;

/// A failed run.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Name of the first body that failed, or of the one with most of the energy.
    pub body: String,
    /// Name of the other body or wall in it, or the place of a force in the scene. It may be empty.
    pub other: String,
    /// The failure.
    pub wrong: FailureKind,
    /// The tick that made it.
    pub tick: u64,
    /// Its time in seconds.
    pub time: f64,
}

/// A failure before it has names: of the body with an index in canonical order, if it concerns a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trouble {
    pub body: Option<usize>,
    /// The body itself, if it has no index yet.
    pub entity: Option<Entity>,
    pub wrong: FailureKind,
    pub tick: u64,
    pub time: f64,
}

impl Trouble {
    /// At the end of the last tick.
    pub fn at(clock: &Clock, body: Option<usize>, wrong: FailureKind) -> Self {
        Self { body, entity: None, wrong, tick: clock.ticks, time: clock.time() }
    }
}

/// The kinds of failures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FailureKind {
    /// This quantity has become NaN or infinite.
    NotFinite(&'static str),
    /// Energy came out of nowhere.
    Energy(Created),
    /// The error would require steps of this many seconds, which would never end.
    Steps(f64),
    /// Steps that end where a force jumps would never end.
    Jumps {
        /// The length of the last step, in s.
        step: f64,
        /// The index of the model whose force jumps, if it is not a prescribed motion.
        model: Option<usize>,
    },
    /// A joint could not be closed: so many metres are left.
    Joint {
        /// The largest gap.
        meters: f64,
        /// Whether a loop is near a dead point, where its bars are in line.
        dead: bool,
    },
    /// The centre of an atom has passed the middle line of the wall with this entity.
    Crossed(Entity),
    /// The centre of an atom has come from behind through the line with this entity, at an open end.
    Behind(Entity),
    /// A sharp corner is so deep in the body with this entity that its side of entry is unknown.
    Sunk(Entity),
    /// Motors and joints ask for different motions of a body.
    Contradiction,
    /// More pairs of atoms lie near each other than so many: their contacts would not fit into memory.
    Pairs(usize),
    /// Its user has ended it. See [`State::ask_inside_ticks`](super::State::ask_inside_ticks).
    Stopped,
    /// A system has changed the length of this packed list, or put another value into it that does not fit. Bodies were read from
    /// their components again.
    Torn(&'static str),
    /// A body has lost this component, which each body has.
    Lost(&'static str),
    /// This is gone, without which there are no ticks.
    Gone(&'static str),
}

impl FailureKind {
    /// Whether the run can continue after its author has removed the cause.
    pub(super) fn can_be_mended(&self) -> bool {
        matches!(self, Self::Torn(_) | Self::Lost(_) | Self::Gone(_))
    }
}

impl Failure {
    /// The end of a run on request, behind a tick.
    pub(crate) fn stopped(clock: &Clock) -> Self {
        let (body, other) = (String::new(), String::new());
        Self { body, other, wrong: FailureKind::Stopped, tick: clock.ticks, time: clock.time() }
    }

    /// A part of the world without which no tick runs is gone.
    pub(super) fn gone(name: &'static str) -> Self {
        Self { body: String::new(), other: String::new(), wrong: FailureKind::Gone(name), tick: 0, time: 0.0 }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { body, other, wrong, tick, time } = self;
        let why = match wrong {
            FailureKind::Gone(name) => {
                return write!(
                    f,
                    "{name} is gone, and no tick runs without it. Put it back as it was, or load the scene again"
                );
            }
            FailureKind::Pairs(most) => {
                write!(f, "more than {most} pairs of atoms lie near each other, most of them of `{body}`,")?;
                ": so many contacts do not fit into memory".to_owned()
            }
            FailureKind::Stopped => {
                f.write_str("the run was ended on request")?;
                String::new()
            }
            FailureKind::Torn(list) => {
                write!(
                    f,
                    "a system has left the packed list `{list}` of bodies in a state that does not fit the others"
                )?;
                ": change items alone; spawn or despawn entities to change lengths".to_owned()
            }
            FailureKind::Lost(component) => {
                write!(f, "`{body}` has lost its component `{component}`")?;
                ": put it back, or despawn the body".to_owned()
            }
            FailureKind::NotFinite(quantity) => {
                write!(f, "the {quantity} of `{body}` is infinite or NaN")?;
                String::new()
            }
            FailureKind::Steps(step) => {
                let short =
                    if *step > 0.0 { format!("as short as {step:.1e} s") } else { "too short to pass time".to_owned() };
                write!(f, "steps have become {short}")?;
                format!(": the acceleration of `{body}` grows beyond all bounds")
            }
            FailureKind::Jumps { step, .. } => {
                write!(f, "steps have become as short as {step:.1e} s")?;
                let what = if other.is_empty() { "a load of the scene".to_owned() } else { format!("`{other}`") };
                format!(": {what} jumps as often as that, and a step ends at each jump")
            }
            FailureKind::Joint { meters, dead } => {
                write!(f, "a joint of `{body}` does not close, {} m are left,", number(*meters))?;
                match dead {
                    true => ": its loop is at a dead point, where bars are in line and the way on is not determined"
                        .to_owned(),
                    false => ": its bodies turn too far in a step".to_owned(),
                }
            }
            FailureKind::Crossed(_) => {
                write!(f, "`{body}` has passed through `{other}`")?;
                ": its contact is too soft for that speed, or the tick is too long. Give it more `stiffness`, a strip more \
                 `thickness`, or a shorter `tick`"
                    .to_owned()
            }
            FailureKind::Behind(_) => {
                write!(f, "`{body}` has come through `{other}` from behind, where it is open,")?;
                format!(
                    ": only its other side holds bodies. Let `{body}` begin on that side, reverse the points of `{other}`, or \
                     give a strip `sides: Both`"
                )
            }
            FailureKind::Sunk(_) => {
                write!(f, "a sharp corner has sunk too deep between `{body}` and `{other}`")?;
                ": the side that it came through is not known. Give them a `rounding` of some hundredths of their size, or \
                 more `stiffness`"
                    .to_owned()
            }
            FailureKind::Contradiction => {
                write!(f, "motors and joints ask for different motions of `{body}`")?;
                ": no velocity suits them all. Give a motor a `limit`".to_owned()
            }
            FailureKind::Energy(Created { energy, put_in }) => {
                write!(
                    f,
                    "energy came out of nowhere, {energy:.1e} J beside {put_in:.1e} J that were put in, most of it in `{body}`,"
                )?;
                String::new()
            }
        };
        write!(f, " at t = {} s (tick {tick}){why}", number(*time))
    }
}

impl std::error::Error for Failure {}
