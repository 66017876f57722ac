//! One run of a sweep.

use crate::SimulationExt;
use std::sync::Arc;

use crate::cli::author;
use crate::cli::flags::{OverrideFlags, StrictFlag};
use crate::cli::interrupt;
use crate::cli::pace::Ended;
use crate::cli::trial::Trial;
use crate::record::follow_camera::Follower;
use crate::record::frame::{Cast, Frame};
use crate::record::sections::CameraChoice;
use crate::report::Card;
use crate::scene::{SceneError, SceneErrors, Source};
use crate::sensors::Channels;
use crate::simulation::Recorder;
use crate::simulation::Simulation;

/// A channel over a run, read at the frames of the film and at the end.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Track {
    /// `name.quantity`.
    pub name: String,
    pub unit: &'static str,
    pub last: f64,
    pub least: f64,
    pub most: f64,
}

impl Track {
    fn see(&mut self, value: f64) {
        self.last = value;
        // A NaN stays a NaN.
        if value.is_nan() || value < self.least {
            self.least = value;
        }
        if value.is_nan() || value > self.most {
            self.most = value;
        }
    }
}

/// The result of a run.
pub(super) struct Attempt {
    pub trial: Trial,
    pub tracks: Vec<Track>,
    /// `None` if the scene was refused.
    pub card: Option<Card>,
    /// The last moment of a completed run and the camera of its scene, if a picture is wanted.
    pub picture: Option<(Frame, Option<CameraChoice>)>,
}

/// A scene that the values of a run cannot make.
pub(super) fn refused(source: &Source, message: String) -> Attempt {
    let errors = SceneErrors::new(source.clone(), vec![SceneError::new("", message)], Vec::new());
    Attempt { trial: Trial::refused(errors), tracks: Vec::new(), card: None, picture: None }
}

/// Runs a scene to its end. `title` is the title of its picture, if one is wanted. An interrupted run has no result.
pub(super) fn attempt(
    scene: &Source,
    flags: &OverrideFlags,
    strict: StrictFlag,
    title: Option<&str>,
) -> Option<Attempt> {
    let mut simulation = match Simulation::load_with(scene, &flags.overrides(), author::plugin) {
        Ok(simulation) => simulation,
        Err(errors) => {
            return Some(Attempt { trial: Trial::refused(errors), tracks: Vec::new(), card: None, picture: None });
        }
    };
    interrupt::reach_into(&mut simulation);
    let mut tracks = tracks_of(&simulation);
    let failure = match run(&mut simulation, &mut tracks) {
        Ok(()) => None,
        Err(Ended::Wrong(failure)) => Some(failure),
        Err(Ended::Interrupted) => return None,
    };
    // The end of a failed run is arbitrary.
    let picture = title.filter(|_| failure.is_none()).and_then(|title| {
        let camera = simulation.get_resource::<CameraChoice>().cloned();
        picture(&mut simulation, camera.as_ref(), title).map(|frame| (frame, camera))
    });
    let trial = Trial::of(&simulation, failure.as_ref(), strict.strict);
    Some(Attempt { trial, tracks, card: Some(simulation.card()), picture })
}

fn tracks_of(simulation: &Simulation) -> Vec<Track> {
    let channels = simulation.get_resource::<Channels>();
    let track = |channel: &crate::sensors::Channel| Track {
        name: channel.name.clone(),
        unit: channel.unit,
        last: f64::NAN,
        least: f64::INFINITY,
        most: f64::NEG_INFINITY,
    };
    channels.map_or_else(Vec::new, |channels| channels.iter().map(track).collect())
}

/// Runs to the end, with a look at the channels at the ticks that `jostle run -o` writes.
fn run(simulation: &mut Simulation, tracks: &mut [Track]) -> Result<(), Ended> {
    let every = ((simulation.frame_step() / simulation.clock().dt).round() as u64).max(1);
    loop {
        if let Some(channels) = simulation.get_resource::<Channels>() {
            let values = simulation.values(channels.iter());
            tracks.iter_mut().zip(values).for_each(|(track, value)| track.see(value));
        }
        let (done, end) = (simulation.clock().ticks, simulation.ticks());
        if done == end {
            return Ok(());
        }
        if interrupt::asked() {
            return Err(Ended::Interrupted);
        }
        simulation.run_to_tick(done.saturating_add(every).min(end)).map_err(Ended::of)?;
    }
}

/// The current moment with another title; `None` if it cannot be drawn.
fn picture(simulation: &mut Simulation, camera: Option<&CameraChoice>, title: &str) -> Option<Frame> {
    let now = simulation.clock().time();
    let mut frame = Recorder::default().frame(simulation, now).ok()?;
    frame.cast = Arc::new(Cast { title: title.to_owned(), ..(*frame.cast).clone() });
    if let Some(CameraChoice::Follow(follow)) = camera {
        Follower::new(&follow.of, 0.0, 1.0).aim(&mut frame);
    }
    Some(frame)
}
