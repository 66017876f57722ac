//! Springs that are there all the time, as those of the scene are: how fast they respond together.
//!
//! Each model that has some lists them in their present state. Their largest angular frequency is worked out before the
//! first tick, for the tick that the engine chooses, and every `PATIENCE` ticks for the error card, as directions and
//! lengths change; contacts that are measured count them too, as they hold the same bodies.
//!
//! Damping counts as stiffness, in proportion to the frequency that is sought (see
//! [`Stability::weight_of_damping`]), so the frequency is a fixed point; each of `ROUNDS` rounds halves at least what is
//! missing.

use bevy_app::App;
use bevy_ecs::prelude::*;

use super::response::{Spring, Springs};
use super::{Balance, Clock, Fastest, Foreseen, Holder, Responses, SimTick, Stability, Stage, TickAppExt};
use crate::tick::AfterLoad;
use crate::world::Bodies;

/// Ticks after which the springs are looked at again.
const PATIENCE: u64 = 512;
/// Rounds in which the frequency is sought where there is damping.
const ROUNDS: usize = 40;
/// Product of tick and angular frequency above which energy is watched at each tick; methods bear 2 and more.
const ALERT: f64 = 1.5;

/// A spring in its present state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadySpring {
    /// Without what damping adds.
    pub spring: Spring,
    /// Damping along the normal in N s/m.
    pub damping: f64,
    /// Damping against turning in N m s.
    pub turning_damping: f64,
}

/// A function that adds the springs of one model in their present state.
pub type Lister = fn(&World, &mut Vec<SteadySpring>);

/// The springs of all models, and how fast they respond.
#[derive(Resource, Default)]
pub struct SteadySprings {
    list: Vec<SteadySpring>,
    listers: Vec<Lister>,
    springs: Springs,
    next: u64,
    alert: bool,
    found: Responses,
}

/// Lets the springs that `lister` knows count where stability is measured.
pub fn add_steady_springs(app: &mut App, lister: Lister) {
    if !app.world().contains_resource::<SteadySprings>() {
        app.init_resource::<SteadySprings>();
        app.add_packed_systems(SimTick, watch_springs.in_set(Stage::Observe));
        app.world_mut().get_resource_or_init::<AfterLoad>().0.push(foresee_springs);
        let sources = &mut app.world_mut().get_resource_or_init::<Stability>().into_inner().sources;
        sources.push(|world| world.resource::<SteadySprings>().found);
    }
    app.world_mut().resource_mut::<SteadySprings>().listers.push(lister);
}

impl SteadySprings {
    /// Whether any of them is damped.
    pub fn damped(&self) -> bool {
        self.list.iter().any(|steady| steady.damping > 0.0 || steady.turning_damping > 0.0)
    }

    /// The springs as they were when they were last looked at. Damping counts as stiffness, as `weight` newtons per metre
    /// for each N s/m.
    pub fn rows(&self, weight: f64) -> impl Iterator<Item = Spring> {
        self.list.iter().map(move |&SteadySpring { spring, damping, turning_damping }| Spring {
            damped: damping * weight,
            turning: spring.turning + turning_damping * weight,
            ..spring
        })
    }

    /// The largest angular frequency in rad/s and the place of the body that is held most stiffly, in the present state.
    fn measure(&mut self, world: &World, stability: &Stability) -> Option<(f64, usize)> {
        self.list.clear();
        for lister in &self.listers {
            lister(world, &mut self.list);
        }
        if self.list.is_empty() {
            return None;
        }
        let bodies = world.resource::<Bodies>();
        let mut springs = std::mem::take(&mut self.springs);
        let mut frequency = 0.0_f64;
        for _ in 0..if self.damped() { ROUNDS } else { 1 } {
            springs.gather([], self.rows(frequency * stability.weight_of_damping()), bodies);
            frequency = springs.largest().sqrt();
        }
        let body = springs.bound().body;
        self.springs = springs;
        Some((frequency, body))
    }
}

/// Before the first tick, when the method is not known yet: damping counts as under the strictest.
fn foresee_springs(world: &mut World) {
    world.resource_scope(|world, mut steady: Mut<SteadySprings>| {
        if let Some((angular_frequency, _)) = steady.measure(world, &Stability::default()) {
            let foreseen = Foreseen { angular_frequency, holder: Holder::Springs };
            world.resource_mut::<Stability>().foreseen.push(foreseen);
        }
    });
}

/// The system of [`Stage::Observe`].
fn watch_springs(world: &mut World) {
    let clock = *world.resource::<Clock>();
    if clock.ticks >= world.resource::<SteadySprings>().next {
        world.resource_scope(|world, mut steady: Mut<SteadySprings>| {
            steady.next = clock.ticks + PATIENCE;
            let found = steady.measure(world, world.resource::<Stability>());
            let Some((angular_frequency, body)) = found else { return };
            steady.alert |= clock.dt * angular_frequency > ALERT;
            let fastest = steady.found.fastest.map_or(0.0, |fastest| fastest.angular_frequency);
            if angular_frequency > fastest {
                let body = world.resource::<Bodies>().entity[body];
                let time = clock.time();
                steady.found.fastest = Some(Fastest { angular_frequency, body, holder: Holder::Springs, time });
            }
        });
    }
    if world.resource::<SteadySprings>().alert {
        world.resource_mut::<Balance>().alert = true;
    }
}
