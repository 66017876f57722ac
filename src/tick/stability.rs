//! How fast the springs of a run respond, against what its method bears. Models that know add a function; the error card
//! and the guard of energy ask.

use std::f64::consts::PI;

use bevy_ecs::prelude::*;

/// What the method bears, and who knows how fast the run responds.
#[derive(Resource, Clone, Debug)]
pub struct Stability {
    /// Largest stable product of tick and angular frequency of the method.
    pub limit: f64,
    /// Largest stable product of tick and damping over mass. With a spring beside it `(omega dt/limit)^2 + c/m
    /// dt/damping_limit` is to stay below 1.
    pub damping_limit: f64,
    /// Models that measure how fast they respond.
    pub sources: Vec<fn(&World) -> Responses>,
}

impl Stability {
    /// What damping adds to the stiffness, both as the method feels them: times damping in N s/m and the limit over the
    /// tick, in 1/s.
    pub fn weight_of_damping(&self) -> f64 {
        self.limit / self.damping_limit
    }
}

impl Default for Stability {
    /// Nobody knows anything, under a method that is stable up to 2, as velocity Verlet is.
    fn default() -> Self {
        Self { limit: 2.0, damping_limit: 1.0, sources: Vec::new() }
    }
}

/// The fastest responses of a run so far, as far as they were measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Responses {
    /// Of everything that touched at once.
    pub fastest: Option<Fastest>,
    /// Of a single pair.
    pub briefest: Option<Briefest>,
}

/// The largest angular frequency of all contacts together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fastest {
    /// In rad/s.
    pub angular_frequency: f64,
    /// The body that was held most stiffly then.
    pub body: Entity,
    /// When, in seconds.
    pub time: f64,
}

/// The contact that lasts the shortest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Briefest {
    /// In rad/s; the contact lasts half a period.
    pub angular_frequency: f64,
    /// Whose contact it is.
    pub between: (Entity, Entity),
    /// When, in seconds.
    pub time: f64,
}

impl Responses {
    /// What all models know together.
    pub fn of(world: &World) -> Self {
        let all = world.resource::<Stability>().sources.iter().map(|source| source(world));
        all.fold(Self::default(), |known, found| {
            let faster =
                |fastest: &Fastest| known.fastest.is_none_or(|k| k.angular_frequency < fastest.angular_frequency);
            let briefer =
                |brief: &Briefest| known.briefest.is_none_or(|k| k.angular_frequency < brief.angular_frequency);
            Self {
                fastest: found.fastest.filter(faster).or(known.fastest),
                briefest: found.briefest.filter(briefer).or(known.briefest),
            }
        })
    }
}

impl Fastest {
    /// The largest tick in seconds that a method bears then.
    pub fn critical_tick(&self, world: &World) -> f64 {
        world.resource::<Stability>().limit / self.angular_frequency
    }
}

impl Briefest {
    /// How long the contact lasts, in seconds.
    pub fn duration(&self) -> f64 {
        PI / self.angular_frequency
    }
}
