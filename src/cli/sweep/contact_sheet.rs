//! The contact sheet of a sweep: the last moment of each run, with the varied values as its title.

use std::path::Path;

use super::attempt::Attempt;
use crate::output::{OutputError, OutputTarget, sheet};
use crate::raster::{Camera, Theme, View, WorldRectangle};
use crate::record::sections::{CameraChoice, FitCamera};

/// The most pictures on one sheet that can be distinguished.
pub(super) const MOST_PICTURES: usize = 100;

/// Width of one picture in pixels.
const WIDTH: u32 = 360;

/// Writes the sheet. One camera shows all pictures, so that they can be compared. A camera that fits includes the ends
/// of all runs. `proportions` are those of the film.
pub(super) fn write(
    path: &Path,
    attempts: &[Attempt],
    proportions: (u32, u32),
    theme: Theme,
) -> Result<(), OutputError> {
    let pictures: Vec<_> = attempts.iter().filter_map(|attempt| attempt.picture.as_ref()).collect();
    let Some((_, choice)) = pictures.first() else { return Ok(()) };
    let size = (WIDTH, (WIDTH * proportions.1 / proportions.0.max(1)).max(16));
    let camera = match choice {
        Some(CameraChoice::Look(look)) => Camera::look(look.center.si(), look.height.si(), size),
        Some(CameraChoice::Follow(follow)) => Camera::look(glam::DVec2::ZERO, follow.height.si(), size),
        Some(CameraChoice::Fit(fit)) => fitting(&pictures, fit.margin.si(), size),
        None => fitting(&pictures, FitCamera::default().margin.si(), size),
    };
    let view = View { camera, theme, frame_step: 0.01, panel: None };
    let columns = (pictures.len() as f64).sqrt().ceil() as u32;
    let rows = (pictures.len() as u32).div_ceil(columns);
    let target = OutputTarget::new(path)?;
    let mut film = sheet::open(&target, view, (columns, rows))?;
    for (frame, _) in &pictures {
        film.push(frame.clone())?;
    }
    film.finish().map(|_| ())
}

type Picture = (crate::record::frame::Frame, Option<CameraChoice>);

fn fitting(pictures: &[&Picture], margin: f64, size: (u32, u32)) -> Camera {
    let all = pictures.iter().filter_map(|(frame, _)| WorldRectangle::of_frame(frame)).reduce(WorldRectangle::union);
    let nothing = WorldRectangle { low: glam::DVec2::NEG_ONE, high: glam::DVec2::ONE };
    Camera::fit(all.unwrap_or(nothing), margin, size)
}
