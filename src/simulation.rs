//! A scene, ready to run: the door through which programs use the engine.

use std::time::{Duration, Instant};

use bevy_app::App;
use bevy_ecs::prelude::*;

use crate::contacts::{self, ContactLaw};
use crate::expect::{Expectations, Outcome, observe_all};
use crate::integrate::Methods;
use crate::record::layers::{self, WantedLayers};
use crate::report::Card;
use crate::report::card::{ChosenMethod, Notes};
use crate::scene::sections::{ClockSection, FilmSection};
use crate::scene::{self, SceneError, SceneErrors, SceneHeader, Source};
use crate::tick::{Clock, Failure, Foreseen, Holder, Models, Stability, TickAppExt, step};
use crate::world::{Name, packed};

/// What a caller wants otherwise than the scene says. Each is named on the card.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Length of a tick in seconds.
    pub tick: Option<f64>,
    /// Name of the integration method.
    pub method: Option<String>,
    /// Length of the run in seconds.
    pub duration: Option<f64>,
    /// Layers of the film beside those of the scene, by the words of [`crate::record::layers::WORDS`]; an empty list: no
    /// layers at all. They change nothing of the run.
    pub layers: Option<Vec<String>>,
}

/// Work to be done once when the whole scene stands: plugins add functions that need bodies and contacts.
#[derive(Resource, Default)]
pub struct Finishers(pub Vec<fn(&mut World)>);

/// Mistakes of the scene that show only when the whole scene stands: [`Finishers`] write them down, with their paths, and
/// the scene is refused.
#[derive(Resource, Default)]
pub struct LateErrors(pub Vec<SceneError>);

/// A scene, ready to run.
///
/// ```
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
    app: App,
    header: SceneHeader,
    film: FilmSection,
    ticks: u64,
    spent: Duration,
}

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
        plugins: impl FnOnce(&mut App),
    ) -> Result<Self, SceneErrors> {
        Self::load_only(source, overrides, |app| {
            crate::plugins::standard(app);
            plugins(app);
        })
    }

    /// Reads a scene with nothing but the plugins given: what they do not register, the scene cannot name.
    ///
    /// # Errors
    /// All mistakes of the scene, with their places; overrides that cannot be.
    pub fn load_only(
        source: &Source,
        overrides: &Overrides,
        plugins: impl FnOnce(&mut App),
    ) -> Result<Self, SceneErrors> {
        let mut app = App::empty();
        app.insert_resource(WantedLayers(overrides.layers.clone()));
        let header = read(&mut app, source, plugins)?;
        app.finish();
        app.cleanup();
        let world = app.world_mut();
        let ticks = begin(world, source, &header, overrides)?;
        let film = world.remove_resource::<FilmSection>().unwrap_or_default();
        Ok(Self { app, header, film, ticks, spent: Duration::ZERO })
    }

    /// The world, for whoever wants to look at everything.
    pub fn world(&self) -> &World {
        self.app.world()
    }

    /// The world, to change it between ticks. Components count: the packed state follows them.
    pub fn world_mut(&mut self) -> &mut World {
        self.app.world_mut()
    }

    /// The packed bodies in canonical order.
    pub fn bodies(&self) -> &crate::world::Bodies {
        self.world().resource()
    }

    /// What the scene says about itself.
    pub fn header(&self) -> &SceneHeader {
        &self.header
    }

    /// What is to be drawn.
    pub fn film(&self) -> &FilmSection {
        &self.film
    }

    /// The clock.
    pub fn clock(&self) -> Clock {
        *self.world().resource()
    }

    /// Ticks that the whole run takes.
    pub fn ticks(&self) -> u64 {
        self.ticks
    }

    /// Runs until `tick` ticks are done in all; does nothing if they are.
    ///
    /// # Errors
    /// When a number stops being finite, or energy comes out of nowhere.
    pub fn run_to_tick(&mut self, tick: u64) -> Result<(), Failure> {
        let missing = tick.saturating_sub(self.clock().ticks);
        if missing == 0 {
            return Ok(());
        }
        let start = Instant::now();
        let result = step(self.app.world_mut(), missing);
        self.spent += start.elapsed();
        if self.clock().ticks == self.ticks {
            observe_all(self.app.world_mut());
        }
        result
    }

    /// Runs until the end of the scene's duration.
    ///
    /// # Errors
    /// When a number stops being finite, or energy comes out of nowhere.
    pub fn run_to_end(&mut self) -> Result<(), Failure> {
        self.run_to_tick(self.ticks)
    }

    /// The error card of the present state.
    pub fn card(&self) -> Card {
        Card::of(self.world(), self.spent.as_secs_f64())
    }

    /// Seconds spent computing so far.
    pub fn seconds_spent(&self) -> f64 {
        self.spent.as_secs_f64()
    }

    /// Name of the body at `place`; empty for a body spawned without one.
    pub fn name(&self, place: usize) -> &str {
        let entity = self.bodies().entity[place];
        self.world().get::<Name>(entity).map_or("", |name| &name.0)
    }

    /// Seconds of physics from frame to frame of the film, by default 1/30.
    pub fn frame_step(&self) -> f64 {
        self.film.speed() / self.film.frames_per_second()
    }

    /// How the scene's expectations went so far.
    pub fn outcomes(&self) -> Vec<Outcome> {
        self.world().get_resource::<Expectations>().map_or_else(Vec::new, Expectations::outcomes)
    }
}

/// Reads a scene into an app: afterwards everything in it is installed.
pub(crate) fn read(app: &mut App, source: &Source, plugins: impl FnOnce(&mut App)) -> Result<SceneHeader, SceneErrors> {
    app.add_tick();
    app.init_resource::<Notes>().init_resource::<Finishers>();
    plugins(app);
    let header = scene::load(app, source)?;
    contacts::install_default(&header.outline, app);
    layers::install_wanted(&header.outline, app);
    Ok(header)
}

/// Makes a scene that was read ready for its first tick; returns the number of ticks it is to run.
pub(crate) fn begin(
    world: &mut World,
    source: &Source,
    header: &SceneHeader,
    overrides: &Overrides,
) -> Result<u64, SceneErrors> {
    world.resource_mut::<Notes>().0.extend(header.remarks.iter().cloned());
    packed::rebuild(world);
    for finish in std::mem::take(&mut world.resource_mut::<Finishers>().0) {
        finish(world);
    }
    let late = world.remove_resource::<LateErrors>().unwrap_or_default().0;
    if !late.is_empty() {
        return Err(scene::found_later(source, late));
    }
    let ticks = set_clock(world, overrides).map_err(|error| scene::found_later(source, vec![*error]))?;
    observe_all(world);
    Ok(ticks)
}

/// Ticks per half period of the fastest contact or spring when the engine chooses the tick.
const TICKS_PER_HALF_PERIOD: f64 = 40.0;
/// The tick in seconds when nothing in the scene asks for a finer one.
const COARSEST_TICK: f64 = 1e-3;

fn set_clock(world: &mut World, overrides: &Overrides) -> Result<u64, Box<SceneError>> {
    let clock = world
        .remove_resource::<ClockSection>()
        .ok_or_else(|| Box::new(SceneError::new("clock", "`clock` is missing")))?;
    let mut notes = Vec::new();
    let duration = match overrides.duration {
        Some(duration) => {
            notes.push(format!("duration {duration:?} s from the command line"));
            positive("--duration", duration)?
        }
        None => clock.duration.si(),
    };
    let dt = match (overrides.tick, clock.tick) {
        (Some(tick), _) => {
            notes.push(format!("tick {tick:?} s from the command line"));
            positive("--tick", tick)?
        }
        (None, Some(tick)) => tick.si(),
        (None, None) => {
            let (tick, why) = chosen_tick(world.resource())?;
            let tick = tick.min(duration);
            notes.push(format!("tick {tick} s chosen: {why}"));
            tick
        }
    };
    if dt > duration {
        let message = format!("the tick of {dt:?} s is longer than the whole run of {duration:?} s");
        return Err(Box::new(SceneError::new(if overrides.tick.is_some() { "--tick" } else { "--duration" }, message)));
    }
    let methods = world.resource::<Methods>();
    let mut name = clock.method.0;
    if let Some(method) = &overrides.method {
        notes.push(format!("method {method} from the command line"));
        name.clone_from(method);
    }
    if name == ClockSection::AUTO {
        name = "VelocityVerlet".to_owned();
        notes.push("method VelocityVerlet chosen: order 2 and symplectic at one evaluation per tick".to_owned());
    }
    let Some(method) = methods.named(&name).copied() else {
        let known: Vec<&str> = methods.0.iter().map(|method| method.name).collect();
        let reserved = ClockSection::RESERVED_METHODS.contains(&name.as_str());
        let why = if reserved { "is not available yet" } else { "is not a method" };
        let error = SceneError::new("--method", format!("`{name}` {why}"));
        return Err(Box::new(error.with_help(format!("known methods: Auto, {}", known.join(", ")))));
    };
    let exact = duration / dt;
    if exact > MOST_TICKS {
        // Behind the largest number a quotient is no number to show.
        let many = if exact.is_finite() { format!("{exact:.1e} ticks") } else { "beyond counting".to_owned() };
        let path = match (overrides.duration, overrides.tick) {
            (Some(_), _) => "--duration",
            (None, Some(_)) => "--tick",
            (None, None) if clock.tick.is_some() => "clock.tick",
            (None, None) => "clock.duration",
        };
        let error = SceneError::new(path, format!("{duration:?} s in ticks of {dt:?} s are {many}"));
        return Err(Box::new(
            error.with_help("a run takes at most 1e15 ticks; choose a longer tick or a shorter duration"),
        ));
    }
    // A quotient that is whole but for rounding is whole.
    let ticks =
        if (exact - exact.round()).abs() < 1e-9 * exact.max(1.0) { exact.round() } else { exact.ceil() }.max(1.0);
    if (ticks * dt - duration).abs() > 1e-9 * duration {
        notes.push(format!("{duration} s are not a whole number of ticks: the run ends at {} s", ticks * dt));
    }
    world.insert_resource(Clock { dt, ticks: 0 });
    world.insert_resource(ChosenMethod(method.name));
    let mut stability = world.resource_mut::<Stability>();
    (stability.limit, stability.damping_limit) = (method.stability_limit, method.damping_limit);
    let Some((made, located)) = method.make(clock.events) else {
        let message = format!("`{}` goes from tick to tick: it cannot locate events inside one", method.name);
        return Err(Box::new(
            SceneError::new("clock.events", message).with_help("write `events: Auto`, or leave it out"),
        ));
    };
    let style = made.0.style();
    let objections = world.resource::<Models>().objections.clone();
    if let Some(objection) = objections.iter().find_map(|object| object(world, style)) {
        let error = SceneError::new(objection.path, objection.message);
        return Err(Box::new(error.with_help(objection.help)));
    }
    if located && world.contains_resource::<ContactLaw>() {
        notes.push("events located: forces jump at the moment itself, inside ticks".to_owned());
    }
    crate::tick::set_method(world, made);
    world.resource_mut::<Notes>().0.extend(notes);
    Ok(ticks as u64)
}

/// More ticks than anybody can wait for, and still counted exactly.
const MOST_TICKS: f64 = 1e15;

fn positive(flag: &str, value: f64) -> Result<f64, Box<SceneError>> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Box::new(SceneError::new(flag, format!("must be a finite number above zero, got {value:?}"))))
    }
}

/// Forty ticks per half period of whatever responds fastest, rounded down to 1, 2 or 5 times a power of ten.
fn chosen_tick(stability: &Stability) -> Result<(f64, &'static str), Box<SceneError>> {
    let coarsest = (COARSEST_TICK, "nothing in the scene asks for a finer one");
    let Some(Foreseen { angular_frequency: omega, holder }) = stability.fastest_foreseen() else { return Ok(coarsest) };
    let wanted = std::f64::consts::PI / (TICKS_PER_HALF_PERIOD * omega);
    if wanted >= COARSEST_TICK {
        return Ok(coarsest);
    }
    if !wanted.is_normal() {
        let error = SceneError::new(
            "clock",
            format!(
                "no tick is short enough for the stiffest {}, which vibrates at {omega:?} rad/s",
                match holder {
                    Holder::Contacts => "contact",
                    Holder::Springs => "spring",
                }
            ),
        );
        return Err(Box::new(error.with_help("give the bodies less `stiffness` or more mass, or give a `tick`")));
    }
    let exponent = wanted.log10().floor() as i32;
    let decade = libm::exp10(f64::from(exponent));
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * decade <= wanted).unwrap_or(1.0);
    // Read back from decimal digits, so that 2e-4 is the same number as in a scene.
    let why = match holder {
        Holder::Contacts => "the stiffest contact lasts at least 40 of them",
        Holder::Springs => "half a swing of the fastest springs lasts at least 40 of them",
    };
    Ok((format!("{step}e{exponent}").parse().unwrap_or(step * decade), why))
}
