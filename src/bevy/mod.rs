//! A scene inside a Bevy app: [`PhysicsPlugin`] reads it into the app's world and runs its ticks in `FixedPostUpdate`.
//!
//! A tick always lasts the physics clock's `dt`, whatever the app's timestep. So the bits are those of a headless run. The app
//! decides only *when* ticks run, and [`Pace`] decides how many. Either the physics keeps to the clock of the game, or each fixed
//! timestep has one tick. The resource [`RunStatus`] tells how the run goes, and nothing panics.
//!
//! ```
//! use bevy_app::{App, FixedPostUpdate};
//! use jostle::bevy::{Pace, PhysicsPlugin, RunStatus};
//! use jostle::{scene::Source, tick::State};
//!
//! let scene = r#"Scene(
//!     format: 1,
//!     clock: (duration: 1, tick: "10 ms"),
//!     gravity: (0, -10),
//!     bodies: [(name: "ball", at: (0, 5), atoms: Disc(radius: 0.1))],
//! )"#;
//! let mut app = App::new();
//! app.add_plugins(PhysicsPlugin::new(Source::new("fall.ron", scene), Pace::Free));
//! // With Bevy's `TimePlugin`, the app does this by itself.
//! app.world_mut().run_schedule(FixedPostUpdate);
//! assert!(matches!(app.world().resource::<RunStatus>(), RunStatus::Running));
//! assert_eq!(app.world().resource::<State>().clock().ticks, 1);
//! ```

#[cfg(feature = "transform")]
mod transforms;

#[cfg(feature = "transform")]
pub use transforms::SyncTransforms;

use std::time::Duration;

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::prelude::*;

use crate::expect::observe_all;
use crate::scene::{SceneError, SceneErrors, Source};
use crate::simulation::{self, Overrides};
use crate::tick::{Failure, State, step};

/// The system set in `FixedPostUpdate` in which ticks run: order systems of the same schedule by it.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Physics;

/// How the app's fixed timestep and the physics clock's tick belong together.
#[derive(Clone, Copy, Debug)]
pub enum Pace {
    /// Each `FixedPostUpdate` runs the ticks that are due. So the physics is behind the game by less than a tick. The function
    /// says how long the app's timestep is; with Bevy's time: `|world| world.resource::<Time<Fixed>>().timestep()`.
    SameClock(fn(&World) -> Duration),
    /// A tick in each `FixedPostUpdate`, whose timestep is as long as a tick: the run stops if not. The function is that of
    /// [`Pace::SameClock`].
    Checked(fn(&World) -> Duration),
    /// A tick in each `FixedPostUpdate`, whatever its timestep: a film in slow motion, or an app that calls `FixedPostUpdate` itself.
    Free,
}

/// How the run of a scene in an app goes.
#[derive(Resource, Clone, Debug)]
pub enum RunStatus {
    /// Each `FixedPostUpdate` runs what is due.
    Running,
    /// The scene's duration is over. A run that shall not end overrides the duration: [`Overrides::duration`].
    Ended,
    /// The scene could not be read; nothing runs.
    Refused(SceneErrors),
    /// The run failed, because a number is infinite or NaN, for example. The state stays as the engine left it.
    Failed(Failure),
    /// The app's fixed timestep is not the clock's tick: with [`Pace::Checked`] nothing runs until that is mended.
    OutOfStep {
        /// The app's timestep.
        fixed: Duration,
        /// The clock's tick in seconds.
        tick: f64,
    },
}

impl RunStatus {
    /// The trouble of the run in words; `None` if there is none.
    pub fn trouble(&self) -> Option<String> {
        match self {
            Self::Running | Self::Ended => None,
            Self::Refused(errors) => Some(errors.to_string()),
            Self::Failed(failure) => Some(failure.to_string()),
            Self::OutOfStep { fixed, tick } => Some(format!(
                "the app's fixed timestep is {:?} s, and the scene's tick is {tick:?} s. With `Pace::SameClock`, the scene \
                 runs as many ticks as the app's time asks for. Or give the app the scene's tick (`jostle::bevy::timestep`), or drive the scene with `Pace::Free`",
                fixed.as_secs_f64()
            )),
        }
    }
}

/// Ticks after which the run is over.
#[derive(Resource, Clone, Copy, Debug)]
struct End(u64);

/// How long the app's clock has run with the scene.
#[derive(Resource, Clone, Copy, Debug, Default)]
struct Elapsed(Duration);

/// Reads a scene with the standard plugins into the app and runs it in `FixedPostUpdate`. One scene per app.
///
/// The resource [`RunStatus`] tells how the run goes. [`PhysicsPlugin::install`] does the same and returns the scene's mistakes.
#[derive(Clone, Debug)]
pub struct PhysicsPlugin {
    /// The scene.
    pub source: Source,
    /// Settings in place of those in the scene. Default: none.
    pub overrides: Overrides,
    /// Registers further forces, sensors ... before the scene is read. Default: none.
    pub plugins: fn(&mut App),
    /// The number of ticks in a timestep of the app.
    pub pace: Pace,
}

impl PhysicsPlugin {
    /// A scene with the standard plugins.
    pub fn new(source: Source, pace: Pace) -> Self {
        Self { source, overrides: Overrides::default(), plugins: |_| {}, pace }
    }

    /// Reads the scene into the app and adds the system that runs it.
    ///
    /// # Errors
    /// All mistakes of the scene, with their places; overrides that cannot be; a second scene for one app.
    pub fn install(&self, app: &mut App) -> Result<(), SceneErrors> {
        if app.world().contains_resource::<RunStatus>() {
            let error = SceneError::new("", "this app has a scene already, and takes only one");
            return Err(SceneErrors::new(self.source.clone(), vec![error], Vec::new()));
        }
        app.insert_resource(RunStatus::Running);
        let plugins = |app: &mut App| {
            crate::plugins::standard(app);
            (self.plugins)(app);
        };
        let ticks = simulation::read(app, &self.source, plugins)
            .and_then(|header| simulation::begin(app.world_mut(), &self.source, &header, &self.overrides));
        let ticks = ticks.inspect_err(|errors| {
            app.insert_resource(RunStatus::Refused(errors.clone()));
        })?;
        let pace = self.pace;
        app.insert_resource(End(ticks)).init_resource::<Elapsed>();
        app.add_systems(FixedPostUpdate, (move |world: &mut World| tick(world, pace)).in_set(Physics));
        Ok(())
    }
}

impl Plugin for PhysicsPlugin {
    fn build(&self, app: &mut App) {
        if let Err(errors) = self.install(app) {
            app.insert_resource(RunStatus::Refused(errors));
        }
    }

    /// A second scene is refused like other mistakes; Bevy would panic.
    fn is_unique(&self) -> bool {
        false
    }
}

/// The physics clock's tick as the app's fixed timestep should be, to the nanosecond.
pub fn timestep(world: &World) -> Duration {
    Duration::from_secs_f64(world.get_resource::<State>().map_or(0.0, |state| state.clock().dt))
}

fn tick(world: &mut World, pace: Pace) {
    let Some(run) = world.get_resource::<RunStatus>() else { return };
    let now = std::mem::discriminant(run);
    if !matches!(run, RunStatus::Running | RunStatus::OutOfStep { .. }) {
        return;
    }
    let (ticks, dt) = (world.resource::<State>().clock().ticks, world.resource::<State>().clock().dt);
    let left = world.resource::<End>().0.saturating_sub(ticks);
    let due = match pace {
        // Timesteps are whole nanoseconds.
        Pace::Checked(fixed) if fixed(world).abs_diff(timestep(world)) > Duration::from_nanos(1) => None,
        Pace::Checked(_) | Pace::Free => Some(1),
        Pace::SameClock(fixed) => {
            let step = fixed(world);
            let mut elapsed = world.resource_mut::<Elapsed>();
            // Durations are whole numbers: their sum is exact.
            elapsed.0 = elapsed.0.saturating_add(step);
            Some(ticks_in(elapsed.0, dt).saturating_sub(ticks))
        }
    };
    let next = match (due.map(|due| step(world, due.min(left))), pace) {
        (None, Pace::Checked(fixed) | Pace::SameClock(fixed)) => RunStatus::OutOfStep { fixed: fixed(world), tick: dt },
        (Some(Err(failure)), _) => RunStatus::Failed(failure),
        _ if world.resource::<State>().clock().ticks >= world.resource::<End>().0 => {
            observe_all(world);
            RunStatus::Ended
        }
        _ => RunStatus::Running,
    };
    // Systems that tell users about trouble look for changes of the resource, so it must not change in every tick.
    if std::mem::discriminant(&next) != now {
        world.insert_resource(next);
    }
}

/// Whole ticks in a time. A tick counts if it is reached to within rounding: time, tick and their ratio are rounded.
fn ticks_in(time: Duration, dt: f64) -> u64 {
    (time.as_secs_f64() / dt * (1.0 + 4.0 * f64::EPSILON)) as u64
}

#[cfg(test)]
mod tests {
    use super::ticks_in;
    use std::time::Duration;

    /// Law: for days the physics is behind the game by less than a tick. If ticks divide the timestep, it keeps up exactly.
    #[test]
    fn ticks_keep_to_the_clock_of_the_game() {
        for (step, dt, per_step) in
            [(15_625_000, 1.0 / 640.0, 10), (15_625_000, 0.015_625, 1), (20_000_000, 0.0004, 50)]
        {
            for steps in [1, 7, 1000, 999_999, 30_000_000] {
                assert_eq!(
                    ticks_in(Duration::from_nanos(step) * steps, dt),
                    u64::from(steps) * per_step,
                    "{steps} of {step}"
                );
            }
        }
        for steps in (1..1000).chain(10_000_000..10_000_100_u32) {
            let time = Duration::from_nanos(16_666_667) * steps;
            let behind = time.as_secs_f64() - ticks_in(time, 0.0007) as f64 * 0.0007;
            // Each of three roundings is one of the whole time.
            let rounding = 3.0 * f64::EPSILON * time.as_secs_f64();
            assert!(behind > -rounding && behind < 0.0007 + rounding, "{steps}: {behind}");
        }
    }
}
