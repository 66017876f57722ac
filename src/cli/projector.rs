//! Gives frames to a film, directly or from a spool.

use std::io;

use super::film::Trouble;
use super::wall_clock::WallClock;
use crate::output::Film;
use crate::record::follow_camera::Follower;
use crate::record::frame::Frame;
use crate::record::frame_spool::Spool;

/// Aims the camera and keeps to the clock.
pub(super) struct Projector {
    follower: Option<Follower>,
    pub wall_clock: Option<WallClock>,
    /// Seconds of film from frame to frame.
    step: f64,
    frames: u64,
}

impl Projector {
    /// At the beginning of a film whose frames are `step` seconds of film apart.
    pub fn new(follower: Option<Follower>, wall_clock: Option<WallClock>, step: f64) -> Projector {
        Projector { follower, wall_clock, step, frames: 0 }
    }

    /// Shows the next frame when it is due.
    pub fn show(&mut self, film: &mut dyn Film, mut frame: Frame) -> Result<(), Trouble> {
        if let Some(follower) = &mut self.follower {
            follower.aim(&mut frame);
        }
        if let Some(clock) = &mut self.wall_clock {
            clock.wait(self.frames as f64 * self.step);
        }
        self.frames += 1;
        Ok(film.push(frame)?)
    }

    /// At the beginning once more, to show every so manieth frame.
    pub fn rewound(&self, every: u64) -> Projector {
        let step = self.step * every as f64;
        let follower = self.follower.as_ref().map(|follower| follower.rewound(step));
        Projector::new(follower, None, step)
    }

    /// Plays every so manieth of the frames that were kept aside.
    pub fn play(&mut self, spool: &mut Spool, backwards: bool, every: u64, film: &mut dyn Film) -> Result<(), Trouble> {
        let mut show = |frame: io::Result<Frame>| self.show(film, frame.map_err(Trouble::Spool)?);
        if backwards {
            spool.backwards().map_err(Trouble::Spool)?.step_by(every as usize).try_for_each(&mut show)
        } else {
            spool.forwards().map_err(Trouble::Spool)?.step_by(every as usize).try_for_each(&mut show)
        }
    }
}
