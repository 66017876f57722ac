//! The camera of a film.

use super::Exit;
use super::film::Order;
use super::progress::Progress;
use crate::raster::{Bounds, Camera};
use crate::record::follow::Follower;
use crate::record::{Recorder, Schedule};
use crate::scene::sections::{CameraChoice, FitCamera};
use crate::simulation::Simulation;

/// How large the picture may grow, in its size at the beginning, when the run is known to go wrong: a body that
/// leaves at enormous speed must not shrink all others to a point.
const WILDEST_GROWTH: f64 = 100.0;

/// A camera, and whom it follows.
pub(super) struct Aim {
    pub camera: Camera,
    /// None: it stands.
    pub follower: Option<Follower>,
}

impl Order<'_> {
    /// The camera that the scene asks for; `step` is the time from frame to frame in seconds of film. One that fits
    /// everything has to know the whole motion beforehand, so the scene is run once without being drawn: time is spent,
    /// memory is not.
    pub(super) fn aim(
        &self,
        simulation: &Simulation,
        schedule: &Schedule,
        size: (u32, u32),
        step: f64,
    ) -> Result<Aim, Exit> {
        let standing = |camera| Aim { camera, follower: None };
        let margin = match simulation.world().get_resource::<CameraChoice>() {
            Some(CameraChoice::Look(look)) => {
                return Ok(standing(Camera::look(look.center.si(), look.height.si(), size)));
            }
            Some(CameraChoice::Follow(follow)) => {
                // Single pictures have no film before them that the camera could be behind.
                let smoothing = if self.shot.is_film() { follow.smoothing.si() } else { 0.0 };
                let camera = Camera::look(glam::DVec2::ZERO, follow.height.si(), size);
                return Ok(Aim { camera, follower: Some(Follower::new(&follow.of, smoothing, step)) });
            }
            Some(CameraChoice::Fit(fit)) => fit.margin.si(),
            None => FitCamera::default().margin.si(),
        };
        let mut ahead = self.again()?;
        let progress = Progress::new(schedule.frames(), "frames looked ahead", self.silent);
        let mut recorder = Recorder::bare();
        // The bounds of all frames, and of those before anything leaves at enormous speed.
        let (mut all, mut tame) = (None, None);
        let mut room = f64::INFINITY;
        for time in schedule.times() {
            let Ok(frame) = recorder.frame(&mut ahead, time) else {
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
        Ok(standing(Camera::fit(all.unwrap_or(nothing), margin, size)))
    }

    /// The scene once more, from its beginning.
    pub(super) fn again(&self) -> Result<Simulation, Exit> {
        let again = Simulation::load_with(self.source, self.overrides, |_| {});
        again.map_err(|errors| self.request.refuse_scene(&errors))
    }
}

fn extent(bounds: Bounds) -> f64 {
    (bounds.high - bounds.low).max_element()
}
