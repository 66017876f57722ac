//! `jostle render`: runs scenes and draws them.

use std::path::{Path, PathBuf};

use clap::Args;

use super::Exit;
use super::progress::Progress;
use super::shared::{self, OverrideFlags};
use crate::output::{self, Film, FilmSettings, OutputError, Target, Written};
use crate::raster::{Bounds, Camera, Theme, View};
use crate::record::{Recorder, Schedule};
use crate::scene::sections::{CameraChoice, FitCamera};
use crate::simulation::{Overrides, Simulation};
use crate::tick::Failure;

/// The command `render`.
#[derive(Args, Debug)]
pub(super) struct Render {
    /// Scene files, or example:NAME
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Where to: a .gif, a .png (with --at), or a directory DIR/ (one scene: a PNG sequence; several: a GIF of each).
    /// Default: <scene>.gif in the current directory
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Draw only the picture at this time, in seconds of physics
    #[arg(long, value_name = "T")]
    at: Option<f64>,
    /// Several scenes into a directory: a PNG sequence of each, in DIR/<scene>/
    #[arg(long)]
    png: bool,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Frames per second of the film
    #[arg(long, value_name = "N", value_parser = rate)]
    fps: Option<f64>,
    #[command(flatten)]
    overrides: OverrideFlags,
    /// Threads that draw; the bytes do not depend on it. Default: as many as there are
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// No progress bar, and messages only if something is wrong
    #[arg(long)]
    quiet: bool,
    /// Print the results as JSON on standard output, one line per scene
    #[arg(long)]
    json: bool,
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    let allowed = 16..=crate::scene::sections::film::LARGEST_SIZE as u32;
    sides
        .filter(|(width, height)| allowed.contains(width) && allowed.contains(height))
        .ok_or_else(|| format!("expected width and height such as 1280x720, each from 16 to {}", allowed.end()))
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse::<f64>().ok().filter(|rate| (0.01..=1000.0).contains(rate));
    rate.ok_or_else(|| "expected frames per second, from 0.01 to 1000".to_owned())
}

enum Trouble {
    Load(Exit),
    Run(Failure),
    Output(OutputError),
}

impl From<OutputError> for Trouble {
    fn from(error: OutputError) -> Self {
        Self::Output(error)
    }
}

impl Render {
    pub(super) fn execute(self) -> Exit {
        let overrides = match self.overrides.overrides() {
            Ok(overrides) => overrides,
            Err(exit) => return exit,
        };
        if self.at.is_some_and(|at| !(at.is_finite() && at >= 0.0)) {
            return shared::usage("--at needs a time in seconds, zero or later");
        }
        let mut worst = Exit::Good;
        for scene in &self.scenes {
            let exit = match self.target(scene) {
                Ok(target) => self.render(scene, &target, &overrides),
                Err(exit) => exit,
            };
            worst = worst.worse(exit);
        }
        worst
    }

    /// Where the film of a scene goes.
    fn target(&self, scene: &str) -> Result<Target, Exit> {
        let stem = shared::stem(scene);
        let ending = if self.at.is_some() { "png" } else { "gif" };
        let path = match &self.output {
            None => PathBuf::from(format!("{stem}.{ending}")),
            Some(output) if self.scenes.len() == 1 && self.at.is_none() => output.clone(),
            Some(output) if is_directory(output) => {
                if let Err(error) = std::fs::create_dir_all(output) {
                    return Err(shared::usage(&format!("`{}` cannot be made: {error}", output.display())));
                }
                if self.png && self.at.is_none() {
                    output.join(format!("{stem}/"))
                } else {
                    output.join(format!("{stem}.{ending}"))
                }
            }
            Some(output) if self.scenes.len() == 1 => output.clone(),
            Some(output) => {
                let message = format!("several scenes need a directory: `-o {}/`", output.display());
                return Err(shared::usage(&message));
            }
        };
        let target = Target::new(path).map_err(|error| shared::usage(&error.to_string()))?;
        let still = target.path().extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
        if self.at.is_none() && still && !target.path().is_dir() {
            return Err(shared::usage("a .png holds one picture: add --at T, or write a film to a .gif"));
        }
        if self.at.is_some() && !still {
            return Err(shared::usage("--at makes one picture: write it to a .png"));
        }
        Ok(target)
    }

    fn render(&self, scene: &str, target: &Target, overrides: &Overrides) -> Exit {
        let mut simulation = match shared::load(scene, overrides, self.json) {
            Ok(simulation) => simulation,
            Err(exit) => return exit,
        };
        let mut exit = match self.film(scene, target, overrides, &mut simulation) {
            Ok((written, failure)) => {
                self.report(&written);
                match failure {
                    None => Exit::Good,
                    Some(failure) => {
                        eprintln!(
                            "error: the run went wrong: {failure}; the {} frames so far are kept",
                            written.frames
                        );
                        eprintln!("help: {}", shared::remedy(&simulation.card()));
                        Exit::RunWrong
                    }
                }
            }
            Err(Trouble::Load(exit)) => return exit,
            Err(Trouble::Output(error)) => return shared::usage(&error.to_string()),
            Err(Trouble::Run(failure)) => {
                eprintln!("error: the run went wrong before the first frame: {failure}");
                eprintln!("help: {}", shared::remedy(&simulation.card()));
                Exit::RunWrong
            }
        };
        let card = simulation.card();
        exit = exit.worse(if self.json {
            shared::print_json(scene, &simulation, &card)
        } else if self.quiet {
            shared::print_outcomes(&simulation.outcomes())
        } else {
            shared::print_card(scene, &simulation, &card)
        });
        exit
    }

    fn report(&self, written: &Written) {
        if self.quiet || self.json {
            return;
        }
        let size = if written.bytes < 1_000_000 {
            format!("{} kB", written.bytes.div_ceil(1000))
        } else {
            format!("{:.1} MB", written.bytes as f64 / 1e6)
        };
        let path = written.path.display();
        match written.frames {
            1 => eprintln!("{path}: one picture, {size}"),
            frames => eprintln!("{path}: {frames} frames, {:.2} s, {size}", written.seconds),
        }
        if written.left_over > 0 {
            eprintln!("note: {} pictures of an earlier, longer sequence are still there", written.left_over);
        }
    }

    /// Runs and draws. A run that goes wrong still yields the film so far, with the failure beside it.
    fn film(
        &self,
        scene: &str,
        target: &Target,
        overrides: &Overrides,
        simulation: &mut Simulation,
    ) -> Result<(Written, Option<Failure>), Trouble> {
        let film = simulation.film();
        let frames_per_second = self.fps.unwrap_or_else(|| film.frames_per_second());
        let size = self.size.unwrap_or_else(|| film.size());
        let end = simulation.ticks() as f64 * simulation.clock().dt;
        let schedule = match self.at {
            Some(at) if at > end * (1.0 + 1e-12) => {
                let exit = shared::usage(&format!("--at {at}: the run ends at {end} s"));
                return Err(Trouble::Load(exit));
            }
            Some(at) => Schedule { from: at, step: 1.0 / frames_per_second, frames: 1 },
            None => Schedule::new(film.begin(), film.end().min(end), film.speed(), frames_per_second),
        };
        let camera = camera(scene, overrides, simulation, &schedule, size).map_err(Trouble::Load)?;
        let theme = Theme::names().first().and_then(|name| Theme::named(name)).expect("the first theme exists");
        let threads = self.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into));
        let settings = FilmSettings { frames_per_second, threads };
        let view = View { camera, theme, frame_step: schedule.step };
        let mut film = output::open(target, &settings, view)?;
        let progress = Progress::new(schedule.frames, "frames", self.quiet || self.json);
        match record(film.as_mut(), simulation, &schedule, &progress) {
            Ok(()) => {
                // What follows the last frame still counts for the card.
                let failure = if self.at.is_none() { simulation.run_to_end().err() } else { None };
                Ok((film.finish()?, failure))
            }
            Err(Trouble::Run(failure)) => match film.finish() {
                Ok(written) => Ok((written, Some(failure))),
                Err(OutputError::NoFrames { .. }) => Err(Trouble::Run(failure)),
                Err(error) => Err(error.into()),
            },
            Err(trouble) => Err(trouble),
        }
    }
}

fn record(
    film: &mut dyn Film,
    simulation: &mut Simulation,
    schedule: &Schedule,
    progress: &Progress,
) -> Result<(), Trouble> {
    let mut recorder = Recorder::default();
    for frame in 0..schedule.frames {
        film.push(recorder.frame(simulation, schedule.time(frame)).map_err(Trouble::Run)?)?;
        progress.at(frame + 1);
    }
    Ok(())
}

/// The camera that the scene asks for. One that fits everything has to know the whole motion beforehand, so the
/// scene is run once without being drawn: time is spent, memory is not.
fn camera(
    scene: &str,
    overrides: &Overrides,
    simulation: &Simulation,
    schedule: &Schedule,
    size: (u32, u32),
) -> Result<Camera, Exit> {
    let margin = match simulation.world().get_resource::<CameraChoice>() {
        Some(CameraChoice::Look(look)) => return Ok(Camera::look(look.center.si(), look.height.si(), size)),
        Some(CameraChoice::Fit(fit)) => fit.margin.si(),
        None => FitCamera::default().margin.si(),
    };
    let mut ahead = shared::load(scene, overrides, false)?;
    let mut recorder = Recorder::default();
    let mut bounds: Option<Bounds> = None;
    for frame in 0..schedule.frames {
        // Whatever goes wrong is told by the run that is drawn.
        let Ok(frame) = recorder.frame(&mut ahead, schedule.time(frame)) else { break };
        bounds = Bounds::of_frame(&frame).map(|now| bounds.map_or(now, |before| before.union(now))).or(bounds);
    }
    let nothing = Bounds { low: glam::DVec2::NEG_ONE, high: glam::DVec2::ONE };
    Ok(Camera::fit(bounds.unwrap_or(nothing), margin, size))
}

fn is_directory(path: &Path) -> bool {
    path.is_dir() || path.as_os_str().to_string_lossy().ends_with('/')
}
