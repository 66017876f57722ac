//! The data of a path: commands become closed contours of curves.

use glam::DVec2;
use svgtypes::{PathParser, PathSegment};

use super::MOST_POINTS;
use super::curve::{Affine, Curve};

/// A contour: its beginning and its curves. If it does not end at its beginning, a line closes it.
#[derive(Clone, Debug, Default)]
pub(super) struct Contour {
    pub start: DVec2,
    pub curves: Vec<Curve>,
}

impl Contour {
    pub fn end(&self) -> DVec2 {
        self.curves.last().map_or(self.start, Curve::end)
    }

    pub fn mapped(&self, map: Affine) -> Self {
        let curves = self.curves.iter().map(|curve| curve.mapped(map)).collect();
        Self { start: map.of(self.start), curves }
    }

    /// A polygon.
    pub fn polygon(points: &[DVec2]) -> Self {
        let curves = points.windows(2).map(|two| Curve::line(two[0], two[1])).collect();
        Self { start: points.first().copied().unwrap_or_default(), curves }
    }
}

/// The contours of a path while it is read.
#[derive(Default)]
struct Pen {
    contours: Vec<Contour>,
    contour: Contour,
    /// The number of all curves.
    curves: usize,
    /// The last control point and the degree of its curve, for smooth curves.
    control: Option<(DVec2, usize)>,
}

impl Pen {
    fn at(&self) -> DVec2 {
        self.contour.end()
    }

    fn lift(&mut self, start: DVec2) {
        let done = std::mem::replace(&mut self.contour, Contour { start, curves: Vec::new() });
        if !done.curves.is_empty() {
            self.contours.push(done);
        }
    }

    fn draw(&mut self, curve: Curve) {
        self.contour.curves.push(curve);
        self.curves += 1;
    }

    fn line(&mut self, to: DVec2) {
        self.draw(Curve::line(self.at(), to));
    }

    /// A curve with control points. If the first one is absent, it mirrors the last one of the curve before.
    fn bezier(&mut self, controls: &[DVec2], first: Option<DVec2>, to: DVec2) {
        let (from, degree) = (self.at(), controls.len() + 1 + usize::from(first.is_none()));
        let mirrored =
            self.control.filter(|(_, before)| *before == degree).map_or(from, |(control, _)| 2.0 * from - control);
        let mut points = vec![from];
        points.push(first.unwrap_or(mirrored));
        points.extend_from_slice(if first.is_some() { &controls[1..] } else { controls });
        let last = points.last().copied().unwrap_or(from);
        points.push(to);
        let degree = points.len() - 1;
        self.draw(Curve::Bezier(points));
        self.control = Some((last, degree));
    }

    fn segment(&mut self, segment: PathSegment) {
        let control = self.control.take();
        let from = self.at();
        let place = |abs: bool, x: f64, y: f64| DVec2::new(x, y) + if abs { DVec2::ZERO } else { from };
        match segment {
            PathSegment::MoveTo { abs, x, y } => self.lift(place(abs, x, y)),
            PathSegment::LineTo { abs, x, y } => self.line(place(abs, x, y)),
            PathSegment::HorizontalLineTo { abs, x } => self.line(DVec2::new(place(abs, x, 0.0).x, from.y)),
            PathSegment::VerticalLineTo { abs, y } => self.line(DVec2::new(from.x, place(abs, 0.0, y).y)),
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                let controls = [place(abs, x1, y1), place(abs, x2, y2)];
                self.bezier(&controls, Some(controls[0]), place(abs, x, y));
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                self.control = control;
                self.bezier(&[place(abs, x2, y2)], None, place(abs, x, y));
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                let control = place(abs, x1, y1);
                self.bezier(&[control], Some(control), place(abs, x, y));
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                self.control = control;
                self.bezier(&[], None, place(abs, x, y));
            }
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                let (tilt, flags) = (x_axis_rotation.to_radians(), (large_arc, sweep));
                self.draw(Curve::arc(from, place(abs, x, y), DVec2::new(rx, ry), tilt, flags));
            }
            // The next command begins at the start of the contour.
            PathSegment::ClosePath { .. } => self.lift(self.contour.start),
        }
    }
}

/// The contours of a path.
///
/// # Errors
/// Data that is no path.
pub(super) fn contours(data: &str) -> Result<Vec<Contour>, String> {
    let mut pen = Pen::default();
    for segment in PathParser::from(data) {
        pen.segment(segment.map_err(|error| error.to_string())?);
        if pen.curves > MOST_POINTS {
            // The drawing has too many of them, whatever follows.
            break;
        }
    }
    pen.lift(DVec2::ZERO);
    Ok(pen.contours)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Commands in the frame of the drawing and commands relative to the pen draw the same. So do smooth curves with
    /// mirrored control points.
    #[test]
    fn relative_and_smooth_commands_are_the_absolute_ones() {
        let ends = |data: &str| {
            let contours = contours(data).unwrap();
            let each = contours.iter().flat_map(|contour| contour.curves.iter().flat_map(|curve| curve.ends(7)));
            each.collect::<Vec<DVec2>>()
        };
        let absolute = "M1 1 H4 V3 C4 5 2 5 2 3 C2 1 0 1 0 3 Q1 4 0 5 Q-1 6 0 7 A1 2 0 0 1 1 9 Z M5 5 L6 5 L6 6 Z";
        let relative = "m1 1 h3 v2 c0 2-2 2-2 0 s-2-2-2 0 q1 1 0 2 t0 2 a1 2 0 011 2z m4 4 l1 0 0 1z";
        let (first, second) = (ends(absolute), ends(relative));
        assert_eq!(first.len(), second.len());
        assert!(first.iter().zip(&second).all(|(a, b)| a.distance(*b) < 1e-14), "{first:?} {second:?}");
        assert!(contours("M1 1 L2 x").is_err());
    }
}
