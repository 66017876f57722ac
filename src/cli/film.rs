//! Making one film: its frames, its camera, its file.

use std::io;

use super::aim::Aim;
use super::destination::Place;
use super::inputs::Inputs;
use super::interrupt;
use super::load::Request;
use super::progress_bar::Progress;
use super::projector::Projector;
use super::say::say;
use super::squeeze::Squeeze;
use super::wall_clock::WallClock;
use super::{Exit, colors};
use crate::output::{self, Film, FilmSettings, OutputError, WrittenFilm, sheet};
use crate::raster::{Camera, View};
use crate::record::Schedule;
use crate::record::follow_camera::Follower;
use crate::record::frame_spool::Spool;
use crate::record::layers::PictureHeight;
use crate::scene::Source;
use crate::simulation::Recorder;
use crate::simulation::{Overrides, Simulation};
use crate::tick::Failure;

/// The memory of all drawing threads together, in bytes.
const MEMORY: usize = 2 << 30;
/// The bytes of one thread for each pixel: a picture, those of its group, and the buffers of packing. It is a generous
/// measure.
const BYTES_PER_PIXEL: usize = 32;

/// The greatest width in pixels of a sheet without a given size.
const SHEET_WIDTH: u64 = 1920;

/// The kind of output.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shot {
    /// The film.
    Film,
    /// `--at`: one picture.
    At(f64),
    /// `--strip`: pictures of these moments side by side.
    Strip(Vec<f64>),
    /// `--sheet`: columns and rows of moments spread evenly over the film.
    Sheet((u32, u32)),
}

impl Shot {
    /// Whether it is a film, not a still.
    pub fn is_film(&self) -> bool {
        *self == Shot::Film
    }

    /// Columns and rows of a picture made of several frames.
    fn places(&self) -> Option<(u32, u32)> {
        match self {
            Shot::Strip(moments) => Some((moments.len() as u32, 1)),
            Shot::Sheet(places) => Some(*places),
            Shot::Film | Shot::At(_) => None,
        }
    }
}

/// The order of a film.
pub(super) struct FilmRequest<'a> {
    pub request: Request<'a>,
    pub source: &'a Source,
    pub overrides: &'a Overrides,
    pub place: &'a Place,
    pub shot: &'a Shot,
    pub size: Option<(u32, u32)>,
    pub frames_per_second: Option<f64>,
    pub threads: Option<usize>,
    /// `--theme`.
    pub theme: Option<&'a str>,
    /// `--max-size`, in bytes.
    pub most_bytes: Option<u64>,
    /// `--pace`.
    pub pace: bool,
    /// A film that a Ctrl-C ends is not kept, and its file stays as it was.
    pub whole: bool,
    /// No progress bar.
    pub silent: bool,
    /// Messages only if there is a mistake.
    pub quiet: bool,
}

/// A film, and the result of the run.
pub(super) struct Made {
    /// The report of the written film; `None` if the run failed before the first frame.
    pub written: Option<WrittenFilm>,
    pub failure: Option<Failure>,
}

/// Why a film was not made.
pub(super) enum Trouble {
    Run(Failure),
    /// Ctrl-C.
    Interrupted,
    Output(OutputError),
    /// The frames could not be kept aside.
    Spool(io::Error),
    /// The mistake was reported.
    Told,
}

impl From<OutputError> for Trouble {
    fn from(error: OutputError) -> Self {
        Self::Output(error)
    }
}

/// How pictures are made of frames.
struct Set<'a> {
    order: &'a FilmRequest<'a>,
    settings: FilmSettings,
    view: View,
}

impl FilmRequest<'_> {
    /// Runs and draws. A failing run still yields the film so far.
    pub fn make(&self, simulation: &mut Simulation) -> Result<Made, Exit> {
        let film = simulation.film();
        let frames_per_second = self.frames_per_second.unwrap_or_else(|| film.frames_per_second());
        let size = self.size.unwrap_or_else(|| self.size_within(film.size()));
        let step = film.speed() / frames_per_second;
        let threads = self.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into));
        let theme = colors::theme(self.request, self.source, simulation, self.theme)?;
        // A target that cannot be written is to be known before the first run, not after it.
        let (live, whole) = (self.pace, self.whole);
        let settings = FilmSettings { frames_per_second, threads: 1, live, whole, ..FilmSettings::default() };
        let view = View { camera: Camera::look(glam::DVec2::ZERO, 1.0, size), theme, frame_step: step, panel: None };
        let mut set = Set { order: self, settings, view };
        let theme = colors::file(self.source, simulation, self.theme);
        let inputs = Inputs::of(self.request, simulation).and(theme);
        if let Some(message) = inputs.objection(self.place.target.path()) {
            return Err(self.request.usage(&message));
        }
        if let Some(folder) = &self.place.folder {
            let made = std::fs::create_dir_all(folder);
            made.map_err(|cause| self.request.usage(&format!("`{}` cannot be made: {cause}", folder.display())))?;
        }
        set.open().map_err(|error| self.refuse(&error))?;
        let (schedule, step) = self.moments(simulation, frames_per_second)?;
        // A still shows the film at that moment, so its camera includes the whole run. It also includes the moments
        // between two frames of the film.
        let whole = whole_run(simulation, film_step(simulation, frames_per_second));
        let whole = schedule.times().fold(
            whole,
            |whole, time| {
                if self.shot.is_film() { whole } else { whole.standing_at(time, 1) }
            },
        );
        let looked_at = if self.shot.is_film() { &schedule } else { &whole };
        let Aim { camera, follower, panel } = self.aim(simulation, looked_at, size, 1.0 / frames_per_second)?;
        let view = camera.view();
        simulation.world_mut().insert_resource(PictureHeight(view.high.y - view.low.y));
        set.view = View { camera, frame_step: step, panel, ..set.view };
        set.settings.threads = threads.min(affordable_threads(size));
        if self.place.target.is_raw() && !self.quiet {
            let (width, height) = size;
            say(&format!(
                "raw pictures: {width} x {height} pixels, {frames_per_second} frames per second, 4 bytes each pixel (red, \
                 green, blue, 255). To watch them: ffplay -f rawvideo -pixel_format rgba -video_size {width}x{height} \
                 -framerate {frames_per_second} FILE"
            ));
        }
        set.shoot(simulation, &schedule, follower)
    }

    /// The size of a frame if only the scene gives one. A sheet of many frames must not exceed a screen.
    fn size_within(&self, (width, height): (u32, u32)) -> (u32, u32) {
        let Some((columns, _)) = self.shot.places() else { return (width, height) };
        let narrow = (SHEET_WIDTH / u64::from(columns)) as u32;
        if narrow >= width {
            return (width, height);
        }
        let side = |side: u32| (u64::from(side) * u64::from(narrow) / u64::from(width)).max(16) as u32;
        (side(width), side(height))
    }

    pub(super) fn refuse(&self, error: &OutputError) -> Exit {
        let remedy = match error {
            OutputError::Rate { .. } => ", use `--fps 50`, or write pictures: `-o DIR/`",
            _ => "",
        };
        self.request.usage(&format!("{error}{remedy}"))
    }

    fn refuse_spool(&self, error: &io::Error) -> Exit {
        self.request.usage(&format!(
            "the program could not keep the frames in `{}`: {error}. Free some space there, or set TMPDIR to another directory",
            Spool::folder().display()
        ))
    }
}

impl Set<'_> {
    fn open(&self) -> Result<Box<dyn Film>, OutputError> {
        let target = &self.order.place.target;
        match self.order.shot.places() {
            Some(places) => sheet::open(target, self.view.clone(), places),
            None => output::open(target, &self.settings, self.view.clone()),
        }
    }

    fn shoot(
        &self,
        simulation: &mut Simulation,
        schedule: &Schedule,
        follower: Option<Follower>,
    ) -> Result<Made, Exit> {
        let order = self.order;
        let backwards = order.shot.is_film() && simulation.film().is_backwards();
        let wall_clock = order.pace.then(WallClock::default);
        let mut projector = Projector::new(follower, wall_clock, 1.0 / self.settings.frames_per_second);
        let mut spool = match (backwards || order.most_bytes.is_some()).then(Spool::new).transpose() {
            Ok(spool) => spool,
            Err(error) => return Err(order.refuse_spool(&error)),
        };
        // A film that is kept aside first is opened when it is played.
        let mut film = if spool.is_none() { Some(self.open().map_err(|error| order.refuse(&error))?) } else { None };
        interrupt::arm();
        interrupt::reach_into(simulation);
        let progress = Progress::new(schedule.frames(), "frames", order.silent);
        let mut recorder = Recorder::default();
        let recorded = schedule.times().try_for_each(|time| {
            if interrupt::asked() {
                return Err(Trouble::Interrupted);
            }
            let frame = recorder.frame(simulation, time).map_err(Trouble::Run)?;
            match (&mut film, &mut spool) {
                (Some(film), _) => projector.show(film.as_mut(), frame)?,
                (None, Some(spool)) => spool.push(&frame).map_err(Trouble::Spool)?,
                (None, None) => (),
            }
            progress.step();
            Ok(())
        });
        drop(progress);
        if order.whole && interrupt::asked() {
            return Err(Exit::Interrupted);
        }
        let failure = match recorded {
            Err(Trouble::Output(error)) => return Err(order.refuse(&error)),
            Err(Trouble::Spool(error)) => return Err(order.refuse_spool(&error)),
            Err(Trouble::Told) => return Err(Exit::Usage),
            Err(Trouble::Run(failure)) => interrupt::unless_asked(failure),
            Err(Trouble::Interrupted) => None,
            // The rest of the run behind the last frame still counts for the card.
            Ok(()) if order.shot.is_film() => simulation.run_to_end().err().and_then(interrupt::unless_asked),
            Ok(()) => None,
        };
        let finished = match (film, spool) {
            (Some(film), _) => film.finish().map_err(Trouble::Output),
            (None, Some(mut spool)) => match order.most_bytes {
                Some(most) => {
                    let frames = spool.frames();
                    let squeeze = Squeeze { settings: self.settings, view: &self.view, most, frames };
                    squeeze.make(order, |film, every| projector.rewound(every).play(&mut spool, backwards, every, film))
                }
                None => self.open().map_err(Trouble::Output).and_then(|mut film| {
                    projector.play(&mut spool, backwards, 1, film.as_mut())?;
                    Ok(film.finish()?)
                }),
            },
            (None, None) => return Ok(Made { written: None, failure }),
        };
        if let Some(clock) = projector.wall_clock.filter(|_| !order.quiet) {
            clock.report("frame", "frames");
        }
        match finished {
            Ok(written) => Ok(Made { written: Some(written), failure }),
            Err(Trouble::Output(OutputError::NoFrames { .. })) if failure.is_some() || interrupt::asked() => {
                Ok(Made { written: None, failure })
            }
            Err(Trouble::Output(error)) => Err(order.refuse(&error)),
            Err(Trouble::Spool(error)) => Err(order.refuse_spool(&error)),
            Err(Trouble::Run(failure)) => Ok(Made { written: None, failure: Some(failure) }),
            // Keeping what was reached takes as long as it takes.
            Err(Trouble::Told | Trouble::Interrupted) => Err(Exit::Usage),
        }
    }
}

/// Frames of the whole run, `step` seconds apart, or a bounded number of them.
fn whole_run(simulation: &Simulation, step: f64) -> Schedule {
    const ENOUGH: f64 = 10_000.0;
    let end = simulation.ticks() as f64 * simulation.clock().dt;
    Schedule::new(0.0, end, step.max(end / ENOUGH), 1.0)
}

/// Seconds of physics from frame to frame of the film.
fn film_step(simulation: &Simulation, frames_per_second: f64) -> f64 {
    simulation.film().speed() / frames_per_second
}

/// The number of threads that may draw pictures of this size without taking all of the memory.
fn affordable_threads((width, height): (u32, u32)) -> usize {
    (MEMORY / (width as usize * height as usize * BYTES_PER_PIXEL)).max(1)
}

#[cfg(test)]
mod tests {
    use super::affordable_threads;

    #[test]
    fn large_pictures_are_drawn_by_few_threads() {
        assert!(affordable_threads((1280, 720)) >= 64);
        assert_eq!(affordable_threads((8192, 8192)), 1);
    }
}
