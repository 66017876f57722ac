//! A scene inside a Bevy app: [`PhysicsPlugin`] reads it into the app's world and runs one tick in each
//! `FixedPostUpdate`.
//!
//! A tick always lasts the physics clock's `dt`, whatever the app believes: the bits are those of a headless run. The
//! app decides only *when* a tick runs, and for that its fixed timestep should be `dt` too. [`Pace`] says so: the
//! driver compares before each tick, and stops if they differ. How it goes stands in the resource [`Run`], and nothing
//! panics.
//!
//! ```
//! use bevy_app::{App, FixedPostUpdate};
//! use jostle::bevy::{Pace, PhysicsPlugin, Run};
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
//! assert!(matches!(app.world().resource::<Run>(), Run::Running));
//! assert_eq!(app.world().resource::<State>().clock().ticks, 1);
//! ```

use std::time::Duration;

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::prelude::*;

use crate::expect::observe_all;
use crate::scene::{SceneError, SceneErrors, Source};
use crate::simulation::{self, Overrides};
use crate::tick::{Failure, State, step};

/// The system set in `FixedPostUpdate` in which the tick runs: order systems of the same schedule by it.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Physics;

/// How the app's fixed timestep and the physics clock's tick belong together.
#[derive(Clone, Copy, Debug)]
pub enum Pace {
    /// They are the same, and the run stops if not. The function says how long the app's timestep is; with Bevy's time:
    /// `|world| world.resource::<Time<Fixed>>().timestep()`.
    Checked(fn(&World) -> Duration),
    /// They need not be the same: a film in slow motion, or an app that calls `FixedPostUpdate` itself.
    Free,
}

/// How the run of a scene in an app goes.
#[derive(Resource, Clone, Debug)]
pub enum Run {
    /// Each `FixedPostUpdate` runs a tick.
    Running,
    /// The scene's duration is over. A run that shall not end overrides the duration: [`Overrides::duration`].
    Ended,
    /// The scene could not be read; nothing runs.
    Refused(SceneErrors),
    /// A number stopped being finite; the state stays as it was found then.
    Failed(Failure),
    /// The app's fixed timestep is not the clock's tick: with [`Pace::Checked`] nothing runs until that is mended.
    OutOfStep {
        /// The app's timestep.
        fixed: Duration,
        /// The clock's tick in seconds.
        tick: f64,
    },
}

impl Run {
    /// What went wrong, in words; nothing if all is well.
    pub fn trouble(&self) -> Option<String> {
        match self {
            Self::Running | Self::Ended => None,
            Self::Refused(errors) => Some(errors.to_string()),
            Self::Failed(failure) => Some(failure.to_string()),
            Self::OutOfStep { fixed, tick } => Some(format!(
                "the app's fixed timestep is {:?} s, the scene's tick {tick:?} s: give the app the scene's \
                 (`jostle::bevy::timestep`), or drive the scene with `Pace::Free`",
                fixed.as_secs_f64()
            )),
        }
    }
}

/// Ticks after which the run is over.
#[derive(Resource, Clone, Copy, Debug)]
struct End(u64);

/// Reads a scene with the standard plugins into the app and runs it in `FixedPostUpdate`. One scene per app.
///
/// Look into [`Run`] for how it goes. [`PhysicsPlugin::install`] does the same and returns the scene's mistakes.
#[derive(Clone, Debug)]
pub struct PhysicsPlugin {
    /// The scene.
    pub source: Source,
    /// What is wanted otherwise than the scene says. Default: nothing.
    pub overrides: Overrides,
    /// Registers further forces, sensors ... before the scene is read. Default: none.
    pub plugins: fn(&mut App),
    /// Whether the app's timestep is checked.
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
        if app.world().contains_resource::<Run>() {
            let error = SceneError::new("", "this app has been given a scene already, and takes only one");
            return Err(SceneErrors::new(self.source.clone(), vec![error], Vec::new()));
        }
        app.insert_resource(Run::Running);
        let plugins = |app: &mut App| {
            crate::plugins::standard(app);
            (self.plugins)(app);
        };
        let ticks = simulation::read(app, &self.source, plugins)
            .and_then(|header| simulation::begin(app.world_mut(), &self.source, &header, &self.overrides));
        let ticks = ticks.inspect_err(|errors| {
            app.insert_resource(Run::Refused(errors.clone()));
        })?;
        let pace = self.pace;
        app.insert_resource(End(ticks));
        app.add_systems(FixedPostUpdate, (move |world: &mut World| tick(world, pace)).in_set(Physics));
        Ok(())
    }
}

impl Plugin for PhysicsPlugin {
    fn build(&self, app: &mut App) {
        if let Err(errors) = self.install(app) {
            app.insert_resource(Run::Refused(errors));
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
    let Some(run) = world.get_resource::<Run>() else { return };
    let now = std::mem::discriminant(run);
    if !matches!(run, Run::Running | Run::OutOfStep { .. }) {
        return;
    }
    let next = match pace {
        // Timesteps are whole nanoseconds.
        Pace::Checked(fixed) if fixed(world).abs_diff(timestep(world)) > Duration::from_nanos(1) => {
            Run::OutOfStep { fixed: fixed(world), tick: world.resource::<State>().clock().dt }
        }
        _ => match step(world, 1) {
            Err(failure) => Run::Failed(failure),
            Ok(()) if world.resource::<State>().clock().ticks >= world.resource::<End>().0 => {
                observe_all(world);
                Run::Ended
            }
            Ok(()) => Run::Running,
        },
    };
    // Whoever tells the user asks whether the resource has changed: not in every tick.
    if std::mem::discriminant(&next) != now {
        world.insert_resource(next);
    }
}
