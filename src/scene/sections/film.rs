//! `film`: what is drawn of the run. It never changes the physics.

use bevy_app::App;
use bevy_ecs::resource::Resource;
use serde::Deserialize;

use crate::scene::units::{Rate, Scalar, Time};
use crate::scene::values::WholeNumber;
use crate::scene::{Outline, Report, Section};

/// The largest width and height of a film, in pixels.
pub const LARGEST_SIZE: u64 = 8192;

/// The section `film`.
#[derive(Resource, Clone, Debug, Default, Deserialize)]
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
    /// Frames per second of the film. Default: 30.
    pub fn frames_per_second(&self) -> f64 {
        self.fps.map_or(30.0, Rate::si)
    }

    /// Width and height in pixels. Default: 1280 x 720.
    pub fn size(&self) -> (u32, u32) {
        self.size.map_or((1280, 720), |(width, height)| (width.0 as u32, height.0 as u32))
    }

    /// Seconds of physics per second of film. Default: 1.
    pub fn speed(&self) -> f64 {
        self.speed.map_or(1.0, Scalar::si)
    }

    /// First moment drawn, in seconds of physics. Default: 0.
    pub fn begin(&self) -> f64 {
        self.from.unwrap_or_default().si()
    }

    /// Last moment drawn, in seconds of physics. Default: infinity, which means the end of the run.
    pub fn end(&self) -> f64 {
        self.to.map_or(f64::INFINITY, Time::si)
    }
}

impl Section for FilmSection {
    const NAME: &'static str = "film";
    const EXAMPLE: &'static str = "film: (fps: 30, size: (1280, 720), speed: 0.5)";

    /// Reports rates, sizes and moments that give no film.
    fn check(&self, _: &Outline, report: &mut Report) {
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

    fn install(self, _: &Outline, app: &mut App) {
        app.insert_resource(self);
    }
}
