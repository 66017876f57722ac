//! `film`: what is drawn of the run. It never changes the physics.

use serde::Deserialize;

use crate::scene::Report;
use crate::scene::units::{Rate, Scalar, Time};
use crate::scene::values::WholeNumber;

/// The largest width and height of a film, in pixels.
pub const LARGEST_SIZE: u64 = 8192;

/// The section `film`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename = "")]
pub struct FilmSection {
    /// Frames per second of the film, from 0.01 to 1000. Default: the program's.
    #[serde(default)]
    pub fps: Option<Rate>,
    /// Width and height in pixels, each from 16 to [`LARGEST_SIZE`]. Default: the program's.
    #[serde(default)]
    pub size: Option<(WholeNumber, WholeNumber)>,
    /// Seconds of physics per second of film, above zero. Default: 1.
    #[serde(default)]
    pub speed: Option<Scalar>,
    /// First moment drawn, in s of physics. Default: 0.
    #[serde(default)]
    pub from: Option<Time>,
    /// Last moment drawn, in s of physics, after `from`. Default: the end of the run; a later moment means the end.
    #[serde(default)]
    pub to: Option<Time>,
}

impl FilmSection {
    /// The section's name.
    pub const NAME: &'static str = "film";
    /// One correct use.
    pub const EXAMPLE: &'static str = "film: (fps: 30, size: (1280, 720), speed: 0.5)";

    /// Reports rates, sizes and moments that give no film.
    pub fn check(&self, report: &mut Report) {
        if let Some(fps) = self.fps {
            report.between("fps", fps, 0.01, 1000.0);
        }
        if let Some((width, height)) = self.size {
            for (path, pixels) in [("size[0]", width.0), ("size[1]", height.0)] {
                if !(16..=LARGEST_SIZE).contains(&pixels) {
                    report.error(path, format!("must be from 16 to {LARGEST_SIZE} pixels, got {pixels}"));
                }
            }
        }
        if let Some(speed) = self.speed {
            report.positive("speed", speed);
        }
        let from = self.from.unwrap_or_default();
        let begins = report.not_negative("from", from);
        if let Some(to) = self.to
            && report.positive("to", to)
            && begins
            && to.si() <= from.si()
        {
            report.error("to", format!("must be after `from`, which is {} s, got {} s", from.si(), to.si()));
        }
    }
}
