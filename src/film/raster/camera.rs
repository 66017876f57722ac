//! The camera: an affine map from the world (metres, y up) to the picture (pixels, y down).

use glam::DVec2;

use jostle_frames::frame::Frame;

/// An upright rectangle of the world, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldRectangle {
    /// Lower left corner.
    pub low: DVec2,
    /// Upper right corner.
    pub high: DVec2,
}

impl WorldRectangle {
    /// The smallest rectangle that holds all points; `None` without a finite point.
    pub fn of_points(points: impl IntoIterator<Item = DVec2>) -> Option<WorldRectangle> {
        let finite = points.into_iter().filter(|point| point.is_finite());
        finite.map(|point| WorldRectangle { low: point, high: point }).reduce(WorldRectangle::union)
    }

    /// The smallest rectangle that holds all discs and hulls of bodies in a frame, and the defining points of walls.
    /// `None` for an empty frame.
    pub fn of_frame(frame: &Frame) -> Option<WorldRectangle> {
        let walls = frame
            .cast
            .walls
            .iter()
            .flat_map(|wall| [wall.left, wall.right].into_iter().chain(wall.points.iter().copied()));
        let bodies = frame.cast.bodies.iter().zip(&frame.poses).flat_map(|(body, pose)| {
            let turn = DVec2::new(libm::cos(pose.angle), libm::sin(pose.angle));
            let corners = body.hulls.iter().flat_map(|hull| hull.corners.iter().map(|corner| (*corner, hull.radius)));
            let round = body.discs.iter().map(|disc| (disc.offset, disc.radius)).chain(corners);
            round.flat_map(move |(offset, radius)| {
                let center = pose.position + turn.rotate(offset);
                [center - DVec2::splat(radius), center + DVec2::splat(radius)]
            })
        });
        WorldRectangle::of_points(walls.chain(bodies))
    }

    /// The smallest rectangle that holds both.
    pub fn union(self, other: WorldRectangle) -> WorldRectangle {
        WorldRectangle { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// The position of the camera and the size of its picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    center: DVec2,
    pixels_per_meter: f64,
    size: (u32, u32),
}

impl Camera {
    /// The camera that shows all of `bounds` with at least `margin` of free space on every side. The margin is a share
    /// of the picture's shorter side, such as 0.05, and is clamped to 0 to 0.45. `size` in pixels, width first.
    ///
    /// Walls fill the area behind them. So in a closed room the margin is the strip of wall at the picture's border.
    pub fn fit(bounds: WorldRectangle, margin: f64, size: (u32, u32)) -> Camera {
        let picture = DVec2::new(f64::from(size.0), f64::from(size.1));
        let margin = if margin.is_finite() { margin.clamp(0.0, 0.45) } else { 0.0 };
        let room = picture - 2.0 * margin * picture.min_element();
        let extent = bounds.high - bounds.low;
        let scale = (room.x / extent.x).min(room.y / extent.y);
        // A single point has no extent: it gets a metre of height.
        let pixels_per_meter = if scale.is_finite() && scale > 0.0 { scale } else { picture.y.max(1.0) };
        Camera { center: 0.5 * (bounds.low + bounds.high), pixels_per_meter, size }
    }

    /// The camera that looks at `center` (m) and shows `height` metres from bottom to top. The width follows from the
    /// picture. A height that is NaN, infinite or not positive counts as one metre.
    pub fn look(center: DVec2, height: f64, size: (u32, u32)) -> Camera {
        let height = if height.is_finite() && height > 0.0 { height } else { 1.0 };
        Camera { center, pixels_per_meter: f64::from(size.1) / height, size }
    }

    /// The same camera, looking at another place (m).
    #[must_use]
    pub fn moved_to(self, center: DVec2) -> Camera {
        Camera { center, ..self }
    }

    /// The same view in a picture of another size. The shown height stays, and so does the width if the picture has the
    /// same proportions.
    #[must_use]
    pub fn resized(self, size: (u32, u32)) -> Camera {
        let pixels_per_meter = self.pixels_per_meter * f64::from(size.1) / f64::from(self.size.1.max(1));
        Camera { pixels_per_meter, size, ..self }
    }

    /// Width and height of the picture in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The number of pixels that a metre takes.
    pub fn pixels_per_meter(&self) -> f64 {
        self.pixels_per_meter
    }

    /// The place of a point of the world (m) in the picture, in pixels from the upper left corner. Pixel (0, 0) has
    /// its centre at (0.5, 0.5).
    pub fn to_picture(&self, point: DVec2) -> DVec2 {
        let middle = 0.5 * DVec2::new(f64::from(self.size.0), f64::from(self.size.1));
        let from_center = (point - self.center) * self.pixels_per_meter;
        DVec2::new(middle.x + from_center.x, middle.y - from_center.y)
    }

    /// The part of the world in the picture, in metres.
    pub fn view(&self) -> WorldRectangle {
        let half = 0.5 * DVec2::new(f64::from(self.size.0), f64::from(self.size.1)) / self.pixels_per_meter;
        WorldRectangle { low: self.center - half, high: self.center + half }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: DVec2, b: DVec2) -> bool {
        (a - b).length() < 1e-9
    }

    #[test]
    fn fit_centres_the_bounds_and_leaves_the_margin() {
        let bounds = WorldRectangle { low: DVec2::ZERO, high: DVec2::new(6.0, 6.0) };
        let camera = Camera::fit(bounds, 0.05, (1280, 720));
        assert!(close(camera.to_picture(DVec2::new(3.0, 3.0)), DVec2::new(640.0, 360.0)));
        // A margin of 36 of 720 pixels above and below; the y axis turns over.
        assert!(close(camera.to_picture(DVec2::new(3.0, 6.0)), DVec2::new(640.0, 36.0)));
        assert!(close(camera.to_picture(DVec2::new(3.0, 0.0)), DVec2::new(640.0, 684.0)));
        let wide = Camera::fit(WorldRectangle { low: DVec2::ZERO, high: DVec2::new(100.0, 1.0) }, 0.1, (1000, 500));
        assert!(close(wide.to_picture(DVec2::ZERO), DVec2::new(50.0, 254.5)));
    }

    #[test]
    fn look_shows_the_height_asked_for() {
        let camera = Camera::look(DVec2::new(1.0, 2.0), 4.0, (640, 360));
        assert!(close(camera.to_picture(DVec2::new(1.0, 4.0)), DVec2::new(320.0, 0.0)));
        assert!(close(camera.to_picture(DVec2::new(2.0, 2.0)), DVec2::new(410.0, 180.0)));
        assert!(close(camera.view().low, DVec2::new(1.0 - 320.0 / 90.0, 0.0)));
    }

    #[test]
    fn a_point_or_a_wild_margin_still_gives_a_picture() {
        let point = WorldRectangle { low: DVec2::ONE, high: DVec2::ONE };
        for margin in [0.0, 0.9, f64::NAN, -1.0] {
            let camera = Camera::fit(point, margin, (100, 50));
            assert!(close(camera.to_picture(DVec2::ONE), DVec2::new(50.0, 25.0)));
            assert!(camera.pixels_per_meter().is_finite());
        }
    }

    #[test]
    fn bounds_skip_what_is_not_finite() {
        let points = [DVec2::new(f64::NAN, 0.0), DVec2::new(1.0, 2.0), DVec2::new(-1.0, 5.0)];
        let bounds = WorldRectangle::of_points(points).expect("two finite points");
        assert_eq!((bounds.low, bounds.high), (DVec2::new(-1.0, 2.0), DVec2::new(1.0, 5.0)));
        assert_eq!(WorldRectangle::of_points([DVec2::INFINITY]), None);
    }
}
