//! Making one film: its frames, its camera, its file.

use super::Exit;
use super::load::Request;
use super::progress::Progress;
use super::say::number;
use super::target::Place;
use crate::output::{self, Film, FilmSettings, OutputError, Written};
use crate::raster::{Bounds, Camera, Theme, View};
use crate::record::{Recorder, Schedule};
use crate::scene::Source;
use crate::scene::sections::{CameraChoice, FitCamera};
use crate::simulation::{Overrides, Simulation};
use crate::tick::Failure;

/// More frames than anybody watches: nine hours at 30 frames per second.
const MOST_FRAMES: f64 = 1e6;

/// What the threads that draw may take together, in bytes.
const MEMORY: usize = 2 << 30;
/// What one of them takes for each pixel: a picture, its colours by place of the palette for each frame of its
/// group, and what packing needs. Measured generously.
const BYTES_PER_PIXEL: usize = 24;

/// How large the picture may grow, in its size at the beginning, when the run is known to go wrong: a body that
/// leaves at enormous speed must not shrink all others to a point.
const WILDEST_GROWTH: f64 = 100.0;

/// What is to be filmed.
pub(super) struct Order<'a> {
    pub request: Request<'a>,
    pub source: &'a Source,
    pub overrides: &'a Overrides,
    pub place: &'a Place,
    /// `--at`: one picture, at this time.
    pub at: Option<f64>,
    pub size: Option<(u32, u32)>,
    pub frames_per_second: Option<f64>,
    pub threads: Option<usize>,
    /// No progress bar.
    pub silent: bool,
}

/// A film, and how the run went.
pub(super) struct Made {
    /// What was written; nothing if the run went wrong before the first frame.
    pub written: Option<Written>,
    pub failure: Option<Failure>,
}

enum Trouble {
    Run(Failure),
    Output(OutputError),
}

impl Order<'_> {
    /// Runs and draws. A run that goes wrong still yields the film so far.
    pub fn make(&self, simulation: &mut Simulation) -> Result<Made, Exit> {
        let film = simulation.film();
        let frames_per_second = self.frames_per_second.unwrap_or_else(|| film.frames_per_second());
        let size = self.size.unwrap_or_else(|| film.size());
        let schedule = self.schedule(simulation, frames_per_second)?;
        let theme = Theme::names()
            .first()
            .and_then(|name| Theme::named(name))
            .expect("a program without a theme fails its tests");
        let settings = |threads| FilmSettings { frames_per_second, threads };
        let view = |camera| View { camera, theme: theme.clone(), frame_step: schedule.step };
        // A target that cannot be written is to be known before the first run, not after it.
        let trial = Camera::look(glam::DVec2::ZERO, 1.0, size);
        if let Some(folder) = &self.place.folder {
            let made = std::fs::create_dir_all(folder);
            made.map_err(|cause| self.request.usage(&format!("`{}` cannot be made: {cause}", folder.display())))?;
        }
        let target = &self.place.target;
        output::open(target, &settings(1), view(trial)).map_err(|error| self.refuse(&error))?;
        // A still shows what the film shows at that moment, so its camera looks at the whole run too.
        let looked_at = if self.at.is_some() { whole_run(simulation, schedule.step) } else { schedule };
        let camera = self.camera(simulation, &looked_at, size)?;
        let threads = self.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into));
        let settings = settings(threads.min(affordable_threads(size)));
        let mut film = output::open(target, &settings, view(camera)).map_err(|error| self.refuse(&error))?;
        let recorded = self.record(film.as_mut(), simulation, &schedule);
        let failure = match recorded {
            Err(Trouble::Output(error)) => return Err(self.refuse(&error)),
            Err(Trouble::Run(failure)) => Some(failure),
            // What follows the last frame still counts for the card.
            Ok(()) if self.at.is_none() => simulation.run_to_end().err(),
            Ok(()) => None,
        };
        match film.finish() {
            Ok(written) => Ok(Made { written: Some(written), failure }),
            Err(OutputError::NoFrames { .. }) if failure.is_some() => Ok(Made { written: None, failure }),
            Err(error) => Err(self.refuse(&error)),
        }
    }

    /// The moments to draw.
    fn schedule(&self, simulation: &Simulation, frames_per_second: f64) -> Result<Schedule, Exit> {
        let film = simulation.film();
        let end = simulation.ticks() as f64 * simulation.clock().dt;
        // The last moment of a run is a product of ticks; what people write differs in the last digits.
        let beyond = |time: f64| time > end * (1.0 + 1e-9);
        if let Some(at) = self.at {
            let step = film.speed() / frames_per_second;
            return if beyond(at) {
                Err(self.request.usage(&format!(
                    "--at {} s is after the end: the run lasts {} s",
                    number(at),
                    number(end)
                )))
            } else {
                Ok(Schedule { from: at.min(end), step, frames: 1 })
            };
        }
        let (from, exit) = (film.begin(), if self.is_overridden() { Exit::Usage } else { Exit::SceneWrong });
        if beyond(from) {
            let message = format!("the film begins at {} s, but the run ends at {} s", number(from), number(end));
            let help = "begin earlier, or let the run last longer: `clock: (duration: ..)` or `--duration`";
            return Err(self.request.refuse(exit, "film.from", &message, help));
        }
        let to = film.end().min(end);
        let frames = (to - from) / film.speed() * frames_per_second;
        if frames > MOST_FRAMES {
            let (seconds, frames) = (number(to - from), number(frames.round()));
            let message = format!("{seconds} s of physics would be {frames} frames, more than {MOST_FRAMES}");
            let help = "choose fewer frames per second (`fps`), a higher `speed`, or an earlier end (`to`)";
            return Err(self.request.refuse(exit, "film", &message, help));
        }
        Ok(Schedule::new(from, to, film.speed(), frames_per_second))
    }

    /// Whether the command line, not the scene, says how long the run and the film are.
    fn is_overridden(&self) -> bool {
        self.frames_per_second.is_some() || self.overrides.duration.is_some()
    }

    fn refuse(&self, error: &OutputError) -> Exit {
        let remedy = match error {
            OutputError::Rate { .. } => ", use `--fps 50`, or write pictures: `-o DIR/`",
            _ => "",
        };
        self.request.usage(&format!("{error}{remedy}"))
    }

    fn record(&self, film: &mut dyn Film, simulation: &mut Simulation, schedule: &Schedule) -> Result<(), Trouble> {
        let progress = Progress::new(schedule.frames, "frames", self.silent);
        let mut recorder = Recorder::default();
        for frame in 0..schedule.frames {
            let frame = recorder.frame(simulation, schedule.time(frame)).map_err(Trouble::Run)?;
            film.push(frame).map_err(Trouble::Output)?;
            progress.step();
        }
        Ok(())
    }

    /// The camera that the scene asks for. One that fits everything has to know the whole motion beforehand, so the
    /// scene is run once without being drawn: time is spent, memory is not.
    fn camera(&self, simulation: &Simulation, schedule: &Schedule, size: (u32, u32)) -> Result<Camera, Exit> {
        let margin = match simulation.world().get_resource::<CameraChoice>() {
            Some(CameraChoice::Look(look)) => return Ok(Camera::look(look.center.si(), look.height.si(), size)),
            Some(CameraChoice::Fit(fit)) => fit.margin.si(),
            None => FitCamera::default().margin.si(),
        };
        let again = Simulation::load_with(self.source, self.overrides, |_| {});
        let mut ahead = again.map_err(|errors| self.request.refuse_scene(&errors))?;
        let progress = Progress::new(schedule.frames, "frames looked ahead", self.silent);
        let mut recorder = Recorder::default();
        // The bounds of all frames, and of those before anything leaves at enormous speed.
        let (mut all, mut tame) = (None, None);
        let mut room = f64::INFINITY;
        for frame in 0..schedule.frames {
            let Ok(frame) = recorder.frame(&mut ahead, schedule.time(frame)) else {
                // What goes wrong is told by the run that is drawn.
                all = tame;
                break;
            };
            if let Some(now) = Bounds::of_frame(&frame) {
                all = Some(all.map_or(now, |before: Bounds| before.union(now)));
                if tame.is_none() {
                    room = WILDEST_GROWTH * extent(now);
                }
                if extent(now) <= room {
                    tame = all;
                } else {
                    room = f64::NEG_INFINITY;
                }
            }
            progress.step();
        }
        let nothing = Bounds { low: glam::DVec2::NEG_ONE, high: glam::DVec2::ONE };
        Ok(Camera::fit(all.unwrap_or(nothing), margin, size))
    }
}

/// Frames of the whole run, `step` seconds apart or so many that nobody waits for them.
fn whole_run(simulation: &Simulation, step: f64) -> Schedule {
    const ENOUGH: f64 = 10_000.0;
    let end = simulation.ticks() as f64 * simulation.clock().dt;
    Schedule::new(0.0, end, step.max(end / ENOUGH), 1.0)
}

fn extent(bounds: Bounds) -> f64 {
    (bounds.high - bounds.low).max_element()
}

/// How many threads may draw pictures of this size without taking all of the memory.
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
