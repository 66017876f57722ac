//! Integrators: each file one, its order of accuracy stated.
//!
//! An integrator advances the state by one tick. Forces of the state at the beginning are there when it is called;
//! forces of the state at the end must be there when it returns.

mod semi_implicit_euler;
pub mod steps;
mod velocity_verlet;

use bevy_app::App;
use bevy_ecs::prelude::*;

pub use semi_implicit_euler::SemiImplicitEuler;
pub use velocity_verlet::VelocityVerlet;

use crate::scene::SceneAppExt;
use crate::scene::sections::ClockSection;
use crate::tick::Tick;

/// A method that advances the state by one tick.
pub trait Integrator: Send + Sync + 'static {
    /// Advances the state by `tick.dt`.
    fn advance(&mut self, tick: &mut Tick);
}

/// The integrator of a run.
pub struct Method(pub Box<dyn Integrator>);

impl Default for Method {
    fn default() -> Self {
        Self(Box::new(VelocityVerlet))
    }
}

/// What is known of a method, and how it is made.
#[derive(Clone, Copy)]
pub struct Description {
    /// Its name in the scene and on the command line.
    pub name: &'static str,
    /// Its order of accuracy on smooth motion.
    pub order: u32,
    /// Largest stable product of tick and angular frequency.
    pub stability_limit: f64,
    /// Largest stable product of tick and damping over mass, without a spring.
    pub damping_limit: f64,
    /// Makes one.
    pub make: fn() -> Method,
}

/// The methods that may be named. Plugins add their own.
#[derive(Resource, Default)]
pub struct Methods(pub Vec<Description>);

impl Methods {
    /// The method called `name`.
    pub fn named(&self, name: &str) -> Option<&Description> {
        self.0.iter().find(|method| method.name == name)
    }
}

/// Registers the methods of this folder.
pub fn plugin(app: &mut App) {
    for description in [semi_implicit_euler::DESCRIPTION, velocity_verlet::DESCRIPTION] {
        app.register_method(description);
    }
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
