//! Lines: a band behind the surface. If a line runs from left to right, everything below it is ground.

use glam::DVec2;
use tiny_skia::Pixmap;

use crate::raster::camera::Camera;
use crate::raster::canvas::{Canvas, Ink, blend, fill};
use crate::raster::theme::Theme;
use jostle_frames::frame::WallLook;

/// The distance of a pixel outside a surface, in pixels, negative behind it; and the distance from the nearest piece.
#[derive(Clone, Copy)]
struct Seen {
    height: f64,
    distance: f64,
}

const FAR: Seen = Seen { height: f64::INFINITY, distance: f64::INFINITY };

/// Draws all lines. `band` and `line` are the widths of the band and of the line at its edge, in pixels.
pub(super) fn draw(pixmap: &mut Pixmap, walls: &[WallLook], camera: &Camera, theme: &Theme, band: f32, line: f32) {
    for wall in walls.iter().filter(|wall| wall.points.len() > 1) {
        let color = wall.color.as_deref().and_then(|name| theme.color(name)).unwrap_or(theme.wall);
        let ink = Ink { fill: color, outline: theme.outline.of(color), width: line };
        let points: Vec<DVec2> = wall.points.iter().map(|point| camera.to_picture(*point)).collect();
        let mut canvas = Canvas::new(pixmap);
        let seen = look(&points, f64::from(band), (canvas.width(), canvas.height()));
        for row in 0..canvas.height() {
            let heights = &seen[row * canvas.width()..];
            for (pixel, Seen { height, .. }) in canvas.row(row).chunks_exact_mut(4).zip(heights) {
                let height = *height as f32;
                if height >= 0.5 {
                    continue;
                }
                let (color, coverage) = ink.at(height);
                if -height < band - 0.5 {
                    blend(pixel, color, coverage);
                } else {
                    fill(pixel, ink.fill);
                    blend(pixel, theme.ground, (0.5 - height - band).min(1.0));
                }
            }
        }
    }
}

/// The distances of each pixel of a picture from a line that is given in pixels.
fn look(points: &[DVec2], band: f64, (width, height): (usize, usize)) -> Vec<Seen> {
    let mut seen = vec![FAR; width * height];
    let is_ground = points.windows(2).all(|two| two[0].x < two[1].x);
    let reach = band + 1.0;
    let range = |low: f64, high: f64, size: usize| {
        low.clamp(0.0, size as f64) as usize..high.ceil().clamp(0.0, size as f64) as usize
    };
    for two in points.windows(2) {
        let along = two[1] - two[0];
        // To the open side, which is to the left of the way where y points up.
        let normal = DVec2::new(along.y, -along.x).normalize_or_zero();
        let (low, high) = (two[0].min(two[1]) - reach, two[0].max(two[1]) + reach);
        for row in range(low.y, high.y, height) {
            for column in range(low.x, high.x, width) {
                let place = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let from = place - two[0];
                let share = (from.dot(along) / along.length_squared()).clamp(0.0, 1.0);
                let distance = from.distance(along * share);
                let across = from.dot(normal);
                let known = &mut seen[row * width + column];
                // At a joint both pieces are equally near. The piece that faces the pixel more directly decides the
                // side.
                let nearer = distance < known.distance - 1e-9
                    || distance < known.distance + 1e-9 && across.abs() > known.height.abs();
                if nearer && distance <= reach {
                    *known = Seen { height: distance.copysign(across), distance };
                }
            }
        }
        if is_ground {
            for column in range(two[0].x - 0.5, two[1].x - 0.5, width) {
                let level = two[0].y + along.y * ((column as f64 + 0.5 - two[0].x) / along.x);
                for row in range(level + reach, height as f64, height) {
                    let known = &mut seen[row * width + column];
                    if known.distance >= reach {
                        *known = Seen { height: -reach, distance: reach };
                    }
                }
            }
        }
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ground_is_filled_below_and_a_line_has_a_band_behind_it() {
        let height = |points: &[(f64, f64)], column: usize, row: usize| {
            let points: Vec<DVec2> = points.iter().map(|point| (*point).into()).collect();
            look(&points, 3.0, (20, 20))[20 * row + column].height
        };
        let ground = [(2.0, 10.0), (10.0, 8.0), (18.0, 10.0)];
        assert!(height(&ground, 10, 5) > 0.0 && height(&ground, 10, 9) < 0.0);
        assert!(height(&ground, 10, 18) < -3.0 && height(&ground, 0, 18) == f64::INFINITY);
        let wall = [(10.0, 15.0), (10.0, 5.0)];
        assert!((height(&wall, 11, 10) + 1.5).abs() < 1e-12 && (height(&wall, 8, 10) - 1.5).abs() < 1e-12);
        assert_eq!(height(&wall, 16, 10), f64::INFINITY);
    }
}
