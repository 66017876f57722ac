//! Integrators, one per file, each with its order of accuracy.
//!
//! An integrator advances the state by one tick. Its caller provides the forces of the state at the beginning. It
//! provides the forces of the state at the end.

mod chosen;
pub mod clock_section;
mod control;
mod event_free_ticks;
mod event_overload;
mod event_stepper;
mod interior_events;
mod locate;
mod semi_implicit_euler;
mod step_bounds;
pub mod steps;
mod velocity_verlet;

use bevy_app::App;
use bevy_ecs::prelude::*;

pub use chosen::ChosenMethod;
pub use clock_section::{ClockSection, EventTiming};
pub use control::{Allowance, ORDER};
pub use event_stepper::{Detail, EventStepper, StepPace};
pub use semi_implicit_euler::SemiImplicitEuler;
pub use velocity_verlet::VelocityVerlet;

use crate::scene::SceneAppExt;
use crate::tick::set_method;
pub use crate::tick::{Integrator, LocatedEvents, Method, StepCount};
use steps::OneStep;

/// The properties of a method, and its constructors.
#[derive(Clone, Copy)]
pub struct Description {
    /// Its name in the scene and on the command line.
    pub name: &'static str,
    /// Its order of accuracy on smooth motion.
    pub order: u32,
    /// Whether it is symplectic, or keeps quadratic invariants such as angular momentum all the same.
    pub symplectic: bool,
    /// Whether it is made of kicks and drifts, of which the drifts follow joints.
    pub drifts: bool,
    /// Largest stable product of tick and angular frequency; zero if no product is stable.
    pub stability_limit: f64,
    /// Largest stable product of tick and damping over mass, without a spring.
    pub damping_limit: f64,
    /// Makes the form that goes from tick to tick, if there is one. Events then happen at the end of a tick.
    pub whole_ticks: Option<fn() -> Method>,
    /// Makes the form that steps from any state over any time, if there is one. Events are then located.
    pub one_step: Option<fn() -> Box<dyn OneStep>>,
}

impl Description {
    /// The method with the requested timing of events, and whether it locates them. `None` if it cannot.
    ///
    /// A pace other than one step per tick requires a method with steps inside ticks. Steps in parts require it too.
    pub fn make(&self, events: EventTiming, pace: StepPace, detail: Detail) -> Option<(Method, bool)> {
        let limit = if self.stability_limit.is_normal() { self.stability_limit } else { USUAL_LIMIT };
        let fine = Detail { swing: limit * detail.swing, ..detail };
        let stepper = |located: bool| {
            let stepper = EventStepper::new(self.one_step?(), located, pace, fine);
            let stepper = match self.whole_ticks.filter(|_| detail == Detail::default()) {
                Some(make) => stepper.with_whole_ticks(make().0),
                None => stepper,
            };
            Some((Method(Box::new(stepper)), located))
        };
        let whole = self
            .whole_ticks
            .filter(|_| pace == StepPace::Even(1) && detail == Detail::default())
            .map(|make| (make(), false));
        match events {
            EventTiming::Auto => whole.or_else(|| stepper(true)),
            EventTiming::Located => stepper(true),
            EventTiming::PerTick => whole.or_else(|| stepper(false)),
        }
    }
}

/// The replacement for the stability limit of methods that have none, or are never stable without losses.
const USUAL_LIMIT: f64 = 2.0;

/// The methods that may be named. Plugins add their own.
#[derive(Resource, Default)]
pub struct Methods(pub Vec<Description>);

impl Methods {
    /// The method called `name`.
    pub fn named(&self, name: &str) -> Option<&Description> {
        self.0.iter().find(|method| method.name == name)
    }
}

/// The methods of this folder.
const METHODS: [Description; 7] = [
    Description {
        name: "ExplicitEuler",
        order: 1,
        symplectic: false,
        drifts: false,
        stability_limit: 0.0,
        damping_limit: 2.0,
        whole_ticks: None,
        one_step: Some(|| Box::new(steps::ExplicitEuler)),
    },
    semi_implicit_euler::DESCRIPTION,
    velocity_verlet::DESCRIPTION,
    Description {
        name: "RungeKutta4",
        order: 4,
        symplectic: false,
        drifts: false,
        stability_limit: 2.828_427_124_746_19,
        damping_limit: 2.785_293_563_405_282,
        whole_ticks: None,
        one_step: Some(|| Box::new(steps::RungeKutta4::default())),
    },
    Description {
        name: "Dop853",
        order: 8,
        symplectic: false,
        drifts: false,
        stability_limit: 5.96,
        damping_limit: 6.39,
        whole_ticks: None,
        one_step: Some(|| Box::new(steps::Dop853::default())),
    },
    Description {
        name: "ImplicitMidpoint",
        order: 2,
        symplectic: true,
        drifts: false,
        stability_limit: f64::INFINITY,
        damping_limit: f64::INFINITY,
        whole_ticks: None,
        one_step: Some(|| Box::new(steps::ImplicitMidpoint::default())),
    },
    Description {
        name: "Symplectic4",
        order: 4,
        symplectic: true,
        drifts: true,
        stability_limit: 3.13,
        damping_limit: 5.4,
        whole_ticks: None,
        one_step: Some(|| Box::new(steps::Symplectic4::default())),
    },
];

/// Registers the methods of this folder.
pub fn plugin(app: &mut App) {
    for description in METHODS {
        app.register_method(description);
    }
    set_method(app.world_mut(), Method(Box::new(VelocityVerlet)));
}

/// How plugins add an integrator.
pub trait MethodAppExt {
    /// Makes a method known by its name.
    fn register_method(&mut self, description: Description) -> &mut Self;
}

impl MethodAppExt for App {
    fn register_method(&mut self, description: Description) -> &mut Self {
        self.world_mut().get_resource_or_init::<Methods>().0.push(description);
        self.register_word(ClockSection::METHODS, description.name)
    }
}
