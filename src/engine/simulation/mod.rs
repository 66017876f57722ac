//! A scene that is ready to run: the interface for programs that use the engine.

pub mod accuracy;
mod choice;
mod default_stiffness;
pub mod error;
mod recorder;
mod sampler;
mod snapshot;

pub use choice::{Goal, Plan};
pub use recorder::Recorder;
pub use sampler::{Missing, Sampler};
pub use snapshot::{ForkError, Snapshot};

use std::sync::Arc;
use std::time::{Duration, Instant};

use bevy_app::App;
use bevy_ecs::prelude::*;

use crate::contacts;
use crate::expect::{ExpectationOutcome, Expectations, observe_all};
use crate::record::layers::{self, WantedLayers};
use crate::record::sections::FilmSection;
use crate::scene::{self, SceneError, SceneErrors, SceneHeader, Source};
use crate::sensors::{self, Channel};
use crate::threads::Threads;
use crate::tick::{
    AfterLoad, Clock, Failure, FailureKind, LoadErrors, Notes, State, TickAppExt, advance, foresee_components,
    look_inside, open, rebuild, refuse_far_anchors, refuse_least_inertia, refuse_not_finite,
};
use crate::world::hull::MendedShapes;
use crate::world::{Name, atom};
use accuracy::Tell;
use jostle_language::numbers::number;
use jostle_simd::{Level, give_back};

/// Requests of a caller that replace those of the scene. The card names each.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Length of a tick in seconds.
    pub tick: Option<f64>,
    /// Name of the integration method.
    pub method: Option<String>,
    /// Error allowed, as a share of the scene's motion, in place of a tick.
    pub tolerance: Option<f64>,
    /// Length of the run in seconds.
    pub duration: Option<f64>,
    /// Ticks per second, where an error that is asked for leaves their length free. Default: the frames of the film.
    pub rate: Option<f64>,
    /// Layers of the film beside those of the scene, by the words of [`crate::record::layers::WORDS`]. An empty list means no
    /// layers at all. They change nothing of the run.
    pub layers: Option<Vec<String>>,
    /// Vector instructions to use, which the processor must have. Default: the best it has. All give the same results to the
    /// bit.
    pub level: Option<Level>,
    /// Threads for work on many bodies or contacts. Default: one. Any number gives the same results to the bit.
    pub threads: Option<usize>,
    /// Factor of the stiffness of all contacts, to see the effect of harder ones. Default: one.
    pub stiffness: Option<f64>,
    /// The plan of the run, from an earlier run of the scene ([`Simulation::plan`]). No trials are made then.
    pub plan: Option<Plan>,
    /// Whether the scene is only read and not run. A tolerance is then not tried, and its first plan stays.
    pub untried: bool,
    /// Told of each trial run that a tolerance or a reference run needs.
    pub tell: Option<Tell>,
}

/// A scene, ready to run.
///
/// ```
/// # extern crate jostle_engine as jostle;
/// use jostle::{Simulation, scene::Source};
///
/// let scene = r#"Scene(
///     format: 1,
///     clock: (duration: 1),
///     gravity: (0, -10),
///     bodies: [(name: "ball", at: (0, 5), atoms: Disc(radius: 0.1))],
/// )"#;
/// let mut simulation = Simulation::load(&Source::new("fall.ron", scene))?;
/// simulation.run_to_end()?;
/// let height = simulation.bodies().position[0].y;
/// assert!((height - 0.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Simulation {
    world: World,
    header: SceneHeader,
    film: FilmSection,
    ticks: u64,
    spent: Duration,
    /// Ticks of the next batch, if a user may end the run.
    batch: u64,
    failure: Option<Failure>,
    origin: Arc<Origin>,
}

/// All that a simulation is read from.
struct Origin {
    source: Source,
    overrides: Overrides,
    plugins: Plugins,
}

type Plugins = Box<dyn Fn(&mut App) + Send + Sync>;

/// The time on the wall between two questions whether a run goes on. Users notice a wait from a tenth of a second on. A tick may
/// take longer.
const ASKED_AFTER: Duration = Duration::from_millis(40);

/// Bodies of a scene whose reading took memory worth giving back.
const LARGE: usize = 10_000;

impl Simulation {
    /// Reads a scene with the standard plugins.
    ///
    /// # Errors
    /// All mistakes of the scene, with their places.
    pub fn load(source: &Source) -> Result<Self, SceneErrors> {
        Self::load_with(source, &Overrides::default(), |_| {})
    }

    /// Reads a scene with the standard plugins and whatever `plugins` adds, and with some values overridden.
    ///
    /// # Errors
    /// All mistakes of the scene, with their places; overrides that cannot be.
    pub fn load_with(
        source: &Source,
        overrides: &Overrides,
        plugins: impl Fn(&mut App) + Send + Sync + 'static,
    ) -> Result<Self, SceneErrors> {
        Self::load_only(source, overrides, move |app| {
            crate::plugins::standard(app);
            plugins(app);
        })
    }

    /// Reads a scene with the given plugins alone. The scene cannot name anything that they do not register.
    ///
    /// # Errors
    /// All mistakes of the scene, with their places; overrides that cannot be.
    pub fn load_only(
        source: &Source,
        overrides: &Overrides,
        plugins: impl Fn(&mut App) + Send + Sync + 'static,
    ) -> Result<Self, SceneErrors> {
        let origin = Origin { source: source.clone(), overrides: overrides.clone(), plugins: Box::new(plugins) };
        Self::of_origin(origin)
    }

    fn of_origin(origin: Origin) -> Result<Self, SceneErrors> {
        let overrides = origin.overrides.clone();
        let origin = Arc::new(origin);
        let first = Self::read(&origin, &overrides)?;
        let world = first.unpublished_world();
        let (Some(goal), Some(plan)) = (world.get_resource::<Goal>(), world.get_resource::<Plan>()) else {
            return Ok(first);
        };
        if overrides.untried || overrides.plan.is_some() || plan.error.is_some() {
            return Ok(first);
        }
        let begin = (plan.clone(), choice::order(world, plan), choice::steps_per_tick(world, plan));
        let mut again = |plan: &Plan| Self::read(&origin, &Overrides { plan: Some(plan.clone()), ..overrides.clone() });
        let found = accuracy::find(*goal, begin, &mut again, overrides.tell)?;
        again(&found)
    }

    /// Reads a scene once, ready to run.
    fn read(origin: &Arc<Origin>, overrides: &Overrides) -> Result<Self, SceneErrors> {
        let Origin { source, plugins, .. } = &**origin;
        let mut app = App::empty();
        app.insert_resource(WantedLayers(overrides.layers.clone()));
        let header = read(&mut app, source, plugins)?;
        app.finish();
        app.cleanup();
        let world = app.world_mut();
        let ticks = begin(world, source, &header, overrides)?;
        let bodies = &mut world.resource_mut::<State>().into_inner().bodies;
        bodies.level = overrides.level.unwrap_or_default();
        bodies.threads = Threads::new(overrides.threads.unwrap_or(1));
        if bodies.len() >= LARGE {
            give_back();
        }
        let film = world.remove_resource::<FilmSection>().unwrap_or_default();
        let world = std::mem::take(app.world_mut());
        Ok(Self { world, header, film, ticks, spent: Duration::ZERO, batch: 1, failure: None, origin: origin.clone() })
    }

    /// A mistake of the scene that turned out after reading, with its place in the text.
    pub fn refused(&self, error: SceneError) -> SceneErrors {
        scene::found_later(&self.world, &self.origin.source, vec![error])
    }

    /// The plan of its run. With [`Overrides::plan`] another run of the scene is like it, and needs no trials.
    pub fn plan(&self) -> Option<&Plan> {
        self.unpublished_world().get_resource()
    }

    /// The world with components brought up to date, for queries. Resources alone are had with [`Self::resource`].
    pub fn world(&mut self) -> &World {
        self.world_mut()
    }

    /// The world, to change it between ticks. Components count: the state follows them.
    pub fn world_mut(&mut self) -> &mut World {
        let world = &mut self.world;
        open(world);
        world
    }

    /// The world whose components may hold the poses and velocities of an earlier tick.
    pub fn unpublished_world(&self) -> &World {
        &self.world
    }

    /// A resource of the world. Between ticks the schedules of the tick are there after [`Self::world`] only.
    ///
    /// # Panics
    /// If there is no resource of this type.
    pub fn resource<R: Resource>(&self) -> &R {
        self.unpublished_world().resource()
    }

    /// A resource of the world, or `None`.
    pub fn get_resource<R: Resource>(&self) -> Option<&R> {
        self.unpublished_world().get_resource()
    }

    /// Whether the world has a resource of a type.
    pub fn contains_resource<R: Resource>(&self) -> bool {
        self.unpublished_world().contains_resource::<R>()
    }

    /// The present value of a channel.
    ///
    /// # Panics
    /// If a resource that the channel reads was removed from the world.
    pub fn value(&self, channel: &Channel) -> f64 {
        channel.value(self.unpublished_world())
    }

    /// The present values of channels, in their order. This is cheaper than one by one if expressions name each other.
    ///
    /// # Panics
    /// If a resource that a channel reads was removed from the world.
    pub fn values<'a>(&self, channels: impl IntoIterator<Item = &'a Channel>) -> Vec<f64> {
        sensors::read_all(self.unpublished_world(), channels)
    }

    /// The state of the run.
    ///
    /// # Panics
    /// If the resource [`State`] was removed from the world; so does all that reads the state through it.
    pub fn state(&self) -> &State {
        self.unpublished_world().resource()
    }

    /// The packed bodies in canonical order.
    ///
    /// # Panics
    /// As [`Self::state`].
    pub fn bodies(&self) -> &crate::world::Bodies {
        self.state().bodies()
    }

    /// The title, notes and names of the scene.
    pub fn header(&self) -> &SceneHeader {
        &self.header
    }

    /// The choices and notes of the engine so far. The card adds those of the end.
    pub fn notes(&self) -> &[String] {
        self.unpublished_world().get_resource::<Notes>().map_or(&[], |notes| &notes.0)
    }

    /// The section `film`.
    pub fn film(&self) -> &FilmSection {
        &self.film
    }

    /// The clock.
    ///
    /// # Panics
    /// As [`Self::state`].
    pub fn clock(&self) -> Clock {
        self.state().clock()
    }

    /// Ticks that the whole run takes.
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    /// Seconds of physics that the scene or the command line asks for. The run ends at the tick that reaches it.
    pub fn duration(&self) -> f64 {
        self.unpublished_world().get_resource::<choice::Duration>().map_or(0.0, |duration| duration.0)
    }

    /// From now on `goes_on` is asked at each step inside a tick, with the time in s of that step. Once it answers `false`, the
    /// run ends there with [`FailureKind::Stopped`], and its state is that of the step. It cannot be continued. Between ticks it is
    /// asked every some hundredths of a second.
    pub fn ask_inside_ticks(&mut self, goes_on: fn(f64) -> bool) {
        self.world.resource_mut::<State>().bypass_change_detection().ask_inside_ticks(goes_on);
    }

    /// From now on the run may take so much work more, in the unit of [`work_of_an_evaluation`](crate::tick::work_of_an_evaluation). Then
    /// it ends at the next step inside a tick, with [`FailureKind::Stopped`], and cannot be continued. From tick to tick it does not end.
    pub fn end_after(&mut self, work: f64) {
        self.world.resource_mut::<State>().bypass_change_detection().end_after(work);
    }

    /// Runs until `tick` ticks are done in all; does nothing if they are.
    ///
    /// # Errors
    /// When a number becomes NaN or infinite, or energy is created. When there are too many contacts. When a part that
    /// ticks need was removed from the world, or put into an impossible state.
    pub fn run_to_tick(&mut self, tick: u64) -> Result<(), Failure> {
        let ticks = self.get_resource::<State>().map_or(0, |state| state.clock.ticks);
        let missing = tick.saturating_sub(ticks);
        if missing == 0 {
            return Ok(());
        }
        let start = Instant::now();
        let result = self.advance_while_asked(missing);
        self.spent += start.elapsed();
        if self.get_resource::<State>().is_some_and(|state| state.clock.ticks == self.ticks) {
            observe_all(&mut self.world);
        }
        self.failure = result.as_ref().err().filter(|failure| failure.wrong != FailureKind::Stopped).cloned();
        result
    }

    /// Advances by so many ticks. If a user may end the run, it goes by batches and asks behind each. Their sizes follow the clock
    /// on the wall, and change no result.
    fn advance_while_asked(&mut self, mut missing: u64) -> Result<(), Failure> {
        let Some(goes_on) = self.get_resource::<State>().and_then(State::asks) else {
            return advance(&mut self.world, missing);
        };
        loop {
            let (start, batch) = (Instant::now(), self.batch.min(missing));
            advance(&mut self.world, batch)?;
            let took = start.elapsed();
            if took > ASKED_AFTER {
                self.batch = (batch / 2).max(1);
            } else if took < ASKED_AFTER / 2 && batch == self.batch {
                self.batch = batch.saturating_mul(2);
            }
            missing -= batch;
            if missing == 0 {
                return Ok(());
            }
            let clock = self.clock();
            if !goes_on(clock.time()) {
                return Err(Failure::stopped(&clock));
            }
        }
    }

    /// Runs until the end of the scene's duration.
    ///
    /// # Errors
    /// As [`Self::run_to_tick`].
    pub fn run_to_end(&mut self) -> Result<(), Failure> {
        self.run_to_tick(self.ticks)
    }

    /// The failure of the run, if it failed.
    pub fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    /// Seconds spent computing so far.
    pub fn seconds_spent(&self) -> f64 {
        self.spent.as_secs_f64()
    }

    /// Name of the body with index `place`. It is empty if the body has no name or does not exist.
    ///
    /// # Panics
    /// As [`Self::state`].
    pub fn name(&self, index: usize) -> String {
        let name = self.bodies().entity.get(index).and_then(|&entity| self.unpublished_world().get::<Name>(entity));
        name.map(Name::to_string).unwrap_or_default()
    }

    /// Seconds of physics from frame to frame of the film, by default 1/30.
    pub fn frame_step(&self) -> f64 {
        self.film.speed() / self.film.frames_per_second()
    }

    /// The outcomes of the scene's expectations so far.
    pub fn outcomes(&self) -> Vec<ExpectationOutcome> {
        self.unpublished_world().get_resource::<Expectations>().map_or_else(Vec::new, Expectations::outcomes)
    }
}

/// Reads a scene into an app: afterwards everything in it is installed.
pub fn read(app: &mut App, source: &Source, plugins: impl Fn(&mut App)) -> Result<SceneHeader, SceneErrors> {
    app.add_tick();
    app.init_resource::<Notes>().init_resource::<AfterLoad>();
    plugins(app);
    foresee_components(app.world_mut());
    let header = scene::load(app, source)?;
    contacts::install_default(&header.outline, app);
    layers::install_wanted(&header.outline, app);
    Ok(header)
}

/// Makes a scene that was read ready for its first tick; returns the number of ticks it is to run.
pub fn begin(
    world: &mut World,
    source: &Source,
    header: &SceneHeader,
    overrides: &Overrides,
) -> Result<u64, SceneErrors> {
    world.resource_mut::<Notes>().0.extend(header.remarks.iter().cloned());
    if let Some(mended) = world.remove_resource::<MendedShapes>() {
        world.resource_mut::<Notes>().0.extend(mended.notes());
    }
    let stiffness = default_stiffness::choose(world);
    if let Some(factor) = overrides.stiffness {
        atom::stiffen(world, factor);
    }
    rebuild(world);
    State::start_models(world);
    for finish in std::mem::take(&mut world.resource_mut::<AfterLoad>().0) {
        finish(world);
    }
    sensors::forget_names(world);
    world.resource_mut::<Notes>().0.extend(stiffness);
    refuse_far_anchors(world);
    refuse_least_inertia(world);
    refuse_not_finite(world);
    world.resource_mut::<State>().foresee_springs();
    let late = world.remove_resource::<LoadErrors>().unwrap_or_default().0;
    if !late.is_empty() {
        return Err(scene::found_later(world, source, late));
    }
    if let Some(level) = overrides.level.filter(|level| *level > Level::best()) {
        let error = SceneError::new("--simd", format!("this processor has no {level}"));
        let error = error.with_help(format!("its best is `{}`", Level::best()));
        return Err(scene::found_later(world, source, vec![error]));
    }
    let ticks = choice::set_clock(world, overrides).map_err(|error| scene::found_later(world, source, vec![*error]))?;
    if world.contains_resource::<Goal>() {
        look_inside(world, true);
        look_at_frames(world);
    }
    observe_all(world);
    Ok(ticks)
}

/// Ticks are the frames of the film. Expectations check each, and the card states the gaps.
fn look_at_frames(world: &mut World) {
    let spacing = number(world.resource::<State>().clock.dt);
    let Some(mut expectations) = world.get_resource_mut::<Expectations>() else { return };
    expectations.look_at_all_ticks();
    if expectations.sample() {
        let note = format!("expectations look every {spacing} s, at each frame. They do not see the time between");
        world.resource_mut::<Notes>().0.push(note);
    }
}
