//! Walls: everything behind a half-plane is ground, with a band along the border of the open room. Strips are drawn
//! with their thickness, and `lines.rs` draws lines.

use glam::DVec2;
use tiny_skia::Pixmap;

use super::labels::Room;
use super::lines;
use crate::raster::camera::Camera;
use crate::raster::canvas::{Canvas, Ink, blend, fill};
use crate::raster::theme::Theme;
use jostle_frames::frame::WallLook;

/// A wall in the picture: the half-plane behind a line.
struct HalfPlane {
    /// A point of the line, in pixels.
    point: DVec2,
    /// Points to the open side; length 1, y down.
    normal: DVec2,
    ink: Ink,
}

impl HalfPlane {
    /// The number of pixels that `place` lies behind the line; negative on the open side.
    fn depth(&self, place: DVec2) -> f64 {
        (self.point - place).dot(self.normal)
    }
}

/// The direction of a wall's open side in the world (y up), of length 1. For an observer there who looks at the wall,
/// `left` is on the left. `None` if the two points coincide.
pub(in crate::raster) fn open_side(left: DVec2, right: DVec2) -> Option<DVec2> {
    (-(right - left).perp()).try_normalize()
}

/// Draws all walls. `band` and `line` are the widths of the band and of the line at its edge, in pixels.
///
/// The distance to the open room is the largest of the depths. So bands of neighbouring walls meet in a mitre and never
/// continue behind each other.
pub(in crate::raster) fn draw(
    pixmap: &mut Pixmap,
    walls: &[WallLook],
    camera: &Camera,
    theme: &Theme,
    band: f32,
    line: f32,
) {
    draw_strips(pixmap, walls, camera, theme, line);
    lines::draw(pixmap, walls, camera, theme, band, line);
    let planes = half_planes(walls, camera, theme, line);
    if planes.is_empty() {
        return;
    }
    let mut canvas = Canvas::new(pixmap);
    for row in 0..canvas.height() {
        for (column, pixel) in canvas.row(row).chunks_exact_mut(4).enumerate() {
            let place = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
            let depths = planes.iter().map(|plane| (plane.depth(place) as f32, &plane.ink));
            let Some((depth, ink)) = depths.reduce(|a, b| if b.0 > a.0 { b } else { a }) else { continue };
            if depth <= -0.5 {
                continue;
            }
            let (color, coverage) = ink.at(-depth);
            if depth < band - 0.5 {
                blend(pixel, color, coverage);
            } else {
                fill(pixel, ink.fill);
                blend(pixel, theme.ground, (depth - band + 0.5).min(1.0));
            }
        }
    }
}

/// Draws walls with ends. They are at least a line wide, because a strip without thickness would be invisible.
fn draw_strips(pixmap: &mut Pixmap, walls: &[WallLook], camera: &Camera, theme: &Theme, line: f32) {
    let strips: Vec<_> = walls.iter().filter_map(|wall| Some((wall, wall.thickness?))).collect();
    if strips.is_empty() {
        return;
    }
    let mut canvas = Canvas::new(pixmap);
    let size = (canvas.width() as f64, canvas.height() as f64);
    for (wall, thickness) in strips {
        let (from, to) = (camera.to_picture(wall.left), camera.to_picture(wall.right));
        let half = (0.5 * thickness * camera.pixels_per_meter()).max(0.75 * f64::from(line));
        let fill = wall.color.as_deref().and_then(|name| theme.color(name)).unwrap_or(theme.wall);
        let ink = Ink { fill, outline: theme.outline.of(fill), width: line };
        let along = to - from;
        let (low, high) = (from.min(to) - half - 1.0, from.max(to) + half + 1.0);
        let range =
            |low: f64, high: f64, size: f64| low.clamp(0.0, size) as usize..high.ceil().clamp(0.0, size) as usize;
        for row in range(low.y, high.y, size.1) {
            let pixels = canvas.row(row);
            for column in range(low.x, high.x, size.0) {
                let place = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) - from;
                let share = (place.dot(along) / along.length_squared()).clamp(0.0, 1.0);
                let height = place.distance(along * share) - half;
                if height < 0.5 {
                    let (color, coverage) = ink.at(height as f32);
                    blend(&mut pixels[4 * column..4 * column + 4], color, coverage);
                }
            }
        }
    }
}

/// The part of the picture that no wall covers.
pub(in crate::raster) fn room(walls: &[WallLook], camera: &Camera, theme: &Theme) -> Room {
    let (width, height) = (f64::from(camera.size().0), f64::from(camera.size().1));
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    let picture = corners.into_iter().map(|(x, y)| DVec2::new(x, y)).collect();
    let open = half_planes(walls, camera, theme, 0.0).iter().fold(picture, cut);
    let bounds = crate::raster::camera::WorldRectangle::of_points(open);
    bounds.map_or(Room { low: DVec2::ZERO, high: DVec2::new(width, height) }, |bounds| Room {
        low: bounds.low,
        high: bounds.high,
    })
}

fn half_planes(walls: &[WallLook], camera: &Camera, theme: &Theme, line: f32) -> Vec<HalfPlane> {
    let plane = |wall: &WallLook| {
        let normal = open_side(wall.left, wall.right)?;
        let fill = wall.color.as_deref().and_then(|name| theme.color(name)).unwrap_or(theme.wall);
        let ink = Ink { fill, outline: theme.outline.of(fill), width: line };
        Some(HalfPlane { point: camera.to_picture(wall.left), normal: DVec2::new(normal.x, -normal.y), ink })
    };
    walls.iter().filter(|wall| wall.thickness.is_none() && wall.points.is_empty()).filter_map(plane).collect()
}

/// The part of a convex polygon on the open side.
fn cut(polygon: Vec<DVec2>, plane: &HalfPlane) -> Vec<DVec2> {
    let mut left = Vec::with_capacity(polygon.len() + 1);
    for (index, &here) in polygon.iter().enumerate() {
        let next = polygon[(index + 1) % polygon.len()];
        let (depth, next_depth) = (plane.depth(here), plane.depth(next));
        if depth <= 0.0 {
            left.push(here);
        }
        if (depth <= 0.0) != (next_depth <= 0.0) {
            left.push(here + (next - here) * (depth / (depth - next_depth)));
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use jostle_frames::frame::Rgb;

    fn wall(left: (f64, f64), right: (f64, f64)) -> WallLook {
        WallLook {
            name: String::new(),
            left: left.into(),
            right: right.into(),
            thickness: None,
            points: Vec::new(),
            color: None,
        }
    }

    fn box_of_six() -> Vec<WallLook> {
        vec![
            wall((6.0, 0.0), (0.0, 0.0)),
            wall((0.0, 6.0), (1.0, 6.0)),
            wall((6.0, 1.0), (6.0, 0.0)),
            wall((0.0, 0.0), (0.0, 1.0)),
        ]
    }

    #[test]
    fn the_open_sides_of_a_box_point_inwards() {
        let inwards = [DVec2::Y, DVec2::NEG_Y, DVec2::NEG_X, DVec2::X];
        for (wall, inwards) in box_of_six().iter().zip(inwards) {
            assert_eq!(open_side(wall.left, wall.right), Some(inwards));
        }
        assert_eq!(open_side(DVec2::ONE, DVec2::ONE), None);
    }

    #[test]
    fn a_box_shows_its_room_a_band_and_the_ground() {
        let theme = Theme::named("paper").expect("shipped");
        let camera = Camera::look(DVec2::splat(3.0), 8.0, (120, 80));
        let mut pixmap = Pixmap::new(120, 80).expect("small");
        fill(pixmap.data_mut(), theme.background);
        draw(&mut pixmap, &box_of_six(), &camera, &theme, 4.0, 0.0);
        let seen = |x: u32, y: u32| {
            let pixel = pixmap.pixel(x, y).expect("inside");
            Rgb(pixel.red(), pixel.green(), pixel.blue())
        };
        // The room spans the pixels 30 to 90 and 10 to 70.
        assert_eq!(seen(60, 40), theme.background);
        for (x, y) in [(60, 71), (60, 8), (91, 40), (28, 40), (28, 8), (91, 71)] {
            assert_eq!(seen(x, y), theme.wall, "band at {x}, {y}");
        }
        for (x, y) in [(60, 78), (60, 1), (110, 40), (5, 40), (5, 72), (28, 78)] {
            assert_eq!(seen(x, y), theme.ground, "ground at {x}, {y}");
        }
        let room = room(&box_of_six(), &camera, &theme);
        assert!(
            (room.low - DVec2::new(30.0, 10.0)).length() < 1e-9 && (room.high - DVec2::new(90.0, 70.0)).length() < 1e-9
        );
    }
}
