//! A camera that follows a body through a low-pass filter of first order. It lags behind the body, so that it starts
//! and stops softly.

use glam::DVec2;

use super::frame::Frame;

/// Aims frames at a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Follower {
    name: String,
    smoothing: f64,
    step: f64,
    /// The last positions of the body and of the camera.
    last: Option<(DVec2, DVec2)>,
}

impl Follower {
    /// Follows the body of that name, `smoothing` seconds of film behind; frames are `step` seconds of film apart. At a
    /// smoothing of zero the body is in the middle of every frame.
    pub fn new(name: impl Into<String>, smoothing: f64, step: f64) -> Self {
        Self { name: name.into(), smoothing, step, last: None }
    }

    /// The same at the beginning of a film with frames `step` seconds apart.
    #[must_use]
    pub fn rewound(&self, step: f64) -> Self {
        Self { step, last: None, ..self.clone() }
    }

    /// Sets the centre of the next frame. In the first frame it is the body. If the body is gone or its position is NaN
    /// or infinite, the camera stays.
    ///
    /// The camera obeys `d camera/dt = (body - camera)/smoothing`. The solution is exact if the body moves steadily
    /// from frame to frame. So the lag does not depend on the frames per second.
    pub fn aim(&mut self, frame: &mut Frame) {
        let body = frame.cast.bodies.iter().position(|body| body.name == self.name);
        let position = body.and_then(|index| frame.poses.get(index)).map(|pose| pose.position);
        self.last = match (position.filter(|position| position.is_finite()), self.last) {
            (None, last) => last,
            (Some(body), None) => Some((body, body)),
            (Some(body), Some(_)) if self.smoothing <= 0.0 => Some((body, body)),
            (Some(body), Some((before, camera))) => {
                let lag = (body - before) / self.step * self.smoothing;
                let left = libm::exp(-self.step / self.smoothing);
                Some((body, body - lag + (camera - before + lag) * left))
            }
        };
        frame.center = self.last.map(|(_, camera)| camera);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::frame::{BodyLook, BodyPose, Cast};

    /// The positions of a camera that follows a body along x, frame by frame.
    fn looks(smoothing: f64, step: f64, places: impl Iterator<Item = f64>) -> Vec<f64> {
        let look = BodyLook { name: "cart".into(), discs: Vec::new(), hulls: Vec::new(), color: None, fixed: false };
        let cast = Arc::new(Cast { bodies: vec![look], ..Cast::default() });
        let mut follower = Follower::new("cart", smoothing, step);
        let look = |x| {
            let poses = vec![BodyPose { position: DVec2::new(x, 1.0), angle: 0.0 }];
            let mut frame = Frame { time: 0.0, cast: cast.clone(), poses, marks: Vec::new(), center: None };
            follower.aim(&mut frame);
            frame.center.expect("a body to follow").x
        };
        places.map(look).collect()
    }

    /// Law: `c' = (x - c)/tau` with `x = v t` from `c = 0` is `c = v (t - tau (1 - exp(-t/tau)))`. The frames meet it to
    /// rounding (1e-12 of the way), at any frame rate. Left out: bodies that turn within a frame.
    #[test]
    fn a_steady_body_is_followed_as_the_law_says_at_any_rate() {
        let (speed, tau) = (3.0, 0.3);
        for step in [0.5, 1.0 / 30.0, 0.001] {
            let frames = (2.0 / step) as usize;
            let seen = looks(tau, step, (0..frames).map(|frame| speed * step * frame as f64));
            for (frame, seen) in seen.into_iter().enumerate() {
                let t = step * frame as f64;
                let law = speed * (t - tau * (1.0 - libm::exp(-t / tau)));
                assert!((seen - law).abs() < 1e-12 * speed * 2.0 * (frame + 1) as f64, "{seen} for {law} at {t}");
            }
        }
    }

    #[test]
    fn without_smoothing_the_body_is_in_the_middle() {
        assert_eq!(looks(0.0, 0.1, [0.0, 5.0, f64::NAN, 2.0].into_iter()), [0.0, 5.0, 5.0, 2.0]);
    }
}
