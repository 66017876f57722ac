//! Stability: the responses of the springs of a run, against the limit of its method. Models add functions for their
//! springs, and the error card and the guard of energy call them. The values before the first tick decide the length of
//! a tick that the scene does not name.

use std::f64::consts::PI;
use std::fmt;

use bevy_ecs::prelude::*;

use serde::{Deserialize, Serialize};
/// The limit of the method, and the predicted responses before the first tick.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Stability {
    /// Largest stable product of tick and angular frequency of the method.
    pub limit: f64,
    /// Largest stable product of tick and damping over mass. With a spring in parallel `(omega dt/limit)^2 + c/m
    /// dt/damping_limit` has to stay below 1.
    pub damping_limit: f64,
    /// The predictions of models before the first tick. Each model adds its own after the whole scene is built.
    pub foreseen: Vec<Foreseen>,
}

/// The holder of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Holder {
    /// Contacts, or contacts and springs together.
    Contacts,
    /// Springs of the scene.
    Springs,
}

impl fmt::Display for Holder {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Contacts => "contacts",
            Self::Springs => "springs",
        })
    }
}

/// The predicted response of a model before the first tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Foreseen {
    /// The greatest angular frequency in rad/s: of a single contact, or of all springs together.
    pub angular_frequency: f64,
    /// The holder that responds.
    pub holder: Holder,
}

impl Stability {
    /// The weight with which the method counts damping as stiffness. That stiffness is the weight times the damping in N s/m,
    /// times the limit over the tick in 1/s.
    pub fn weight_of_damping(&self) -> f64 {
        self.limit / self.damping_limit
    }

    /// The fastest of the predictions before the first tick.
    pub fn fastest_foreseen(&self) -> Option<Foreseen> {
        let known = self.foreseen.iter().copied().filter(|foreseen| foreseen.angular_frequency > 0.0);
        known.max_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency))
    }

    /// The greatest possible angular frequency in rad/s of a single contact, if contacts are possible.
    pub fn stiffest_contact(&self) -> Option<f64> {
        let contacts = self.foreseen.iter().filter(|foreseen| foreseen.holder == Holder::Contacts);
        contacts.map(|foreseen| foreseen.angular_frequency).filter(|frequency| *frequency > 0.0).reduce(f64::max)
    }
}

impl Default for Stability {
    /// No predictions, and a method that is stable up to 2, like velocity Verlet.
    fn default() -> Self {
        Self { limit: 2.0, damping_limit: 1.0, foreseen: Vec::new() }
    }
}

/// The fastest measured responses of a run so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TimeScales {
    /// Of everything that held bodies at once.
    pub fastest: Option<Fastest>,
    /// Of a single pair.
    pub briefest: Option<Briefest>,
    /// Whether contacts have begun since the start.
    pub some_began: bool,
}

/// The largest angular frequency of all that holds bodies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fastest {
    /// In rad/s.
    pub angular_frequency: f64,
    /// The body that was held most stiffly then.
    pub body: Entity,
    /// Its holder.
    pub holder: Holder,
    /// The time in seconds.
    pub time: f64,
}

/// Contacts that last fewer ticks are not resolved. Under velocity Verlet half a swing of `n` ticks errs by `(pi/n)^2/24` of its time. That is
/// less than a hundredth from seven ticks on (Hairer, Lubich and Wanner, *Acta Numerica* 12, 2003).
pub const FEWEST_TICKS_OF_CONTACT: f64 = 7.0;

/// The contact that lasts the shortest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Briefest {
    /// In rad/s; the contact lasts half a period.
    pub angular_frequency: f64,
    /// The two sides of the contact.
    pub between: (Entity, Entity),
    /// The time in seconds.
    pub time: f64,
}

impl TimeScales {
    /// The fastest of all.
    pub(super) fn of_all(all: impl Iterator<Item = Self>) -> Self {
        all.fold(Self::default(), |known, found| {
            let faster =
                |fastest: &Fastest| known.fastest.is_none_or(|k| k.angular_frequency < fastest.angular_frequency);
            let briefer =
                |brief: &Briefest| known.briefest.is_none_or(|k| k.angular_frequency < brief.angular_frequency);
            Self {
                fastest: found.fastest.filter(faster).or(known.fastest),
                briefest: found.briefest.filter(briefer).or(known.briefest),
                some_began: known.some_began || found.some_began,
            }
        })
    }
}

impl Fastest {
    /// The largest tick in seconds that a method bears then.
    pub fn critical_tick(&self, stability: &Stability) -> f64 {
        stability.limit / self.angular_frequency
    }
}

impl Briefest {
    /// The duration of the contact, in seconds.
    pub fn duration(&self) -> f64 {
        PI / self.angular_frequency
    }
}
