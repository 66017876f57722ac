//! Outlines of a drawing (SVG) as polygons.
//!
//! Paths, polygons, rectangles and ellipses of the file become closed contours. Chords replace their curves, within a
//! tolerance. In the drawing y points down; here it points up.

mod curve;
mod drawing;
mod embed;
mod path;
mod size;

pub(crate) use embed::EMBEDDING;

use glam::DVec2;

use drawing::Drawing;
use path::Contour;

/// How large a drawing becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Size {
    /// Its height in m.
    Height(f64),
    /// The length in m of one unit of the drawing.
    Unit(f64),
}

/// The outlines of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Outlines {
    /// Polygons, counter-clockwise, in m. The origin is the middle of the lower side of the box around them.
    pub polygons: Vec<Vec<DVec2>>,
    /// The tolerance in m.
    pub tolerance: f64,
    /// The difference between the areas of polygons and curves, as a share.
    pub lost: f64,
    /// Elements that are seen but have no outline.
    pub left_out: Vec<String>,
}

/// The most points of all outlines. Two larger bodies would take seconds on contact.
pub(crate) const MOST_POINTS: usize = 2000;
/// Chords of a curve from which the height of a drawing is known.
const FINE: usize = 256;
/// A width below this share of a drawing's places is rounding: some units in their last place.
const NO_WIDTH: f64 = 16.0 * f64::EPSILON;
/// The default tolerance, as a share of the height.
const TOLERANCE: f64 = 1e-3;
/// Points that are nearer than this share of the tolerance are one.
const SAME: f64 = 0.01;

/// A mistake: its words, what to do, and the field it is about.
type Wrong = (String, String, &'static str);

impl Outlines {
    /// Reads a file, or the element of it with an id. `tolerance` is in m.
    ///
    /// # Errors
    /// A file without outlines, or with outlines of which no shape can be made.
    pub fn read(bytes: &[u8], id: Option<&str>, size: Size, tolerance: Option<f64>) -> Result<Self, Wrong> {
        let field = if id.is_some() { "id" } else { "file" };
        let Drawing { mut contours, mut left_out, .. } =
            Drawing::read(bytes, id).map_err(|(message, help)| (message, help, "file"))?;
        let fine = |contour: &Contour| chained(contour, |_| FINE, 0.0);
        let all = contours.len();
        contours.retain(|contour| has_area(&fine(contour)));
        if contours.len() < all {
            left_out.push("line without area".to_owned());
        }
        let rough: Vec<DVec2> = contours.iter().flat_map(fine).collect();
        let low = rough.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = rough.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let drawn = high.y - low.y;
        if !(drawn > 0.0 && drawn.is_finite()) {
            let seen = if left_out.is_empty() { String::new() } else { format!(", only {}", left_out.join(", ")) };
            let help = "draw a closed outline as a path; programs for drawing turn texts and copies into paths";
            return Err((format!("has no outline{seen}"), help.to_owned(), field));
        }
        let unit = match size {
            Size::Height(height) => height / drawn,
            Size::Unit(unit) => unit,
        };
        let tolerance = tolerance.unwrap_or(TOLERANCE * drawn * unit);
        let origin = DVec2::new(0.5 * (low.x + high.x), high.y);
        let placed = |at: DVec2| DVec2::new(at.x - origin.x, origin.y - at.y) * unit;
        let flattened = |tolerance: f64| -> Vec<Vec<DVec2>> {
            let chords = |curve: &curve::Curve| curve.chords(tolerance / unit);
            let rings = contours.iter().map(|contour| chained(contour, chords, SAME * tolerance / unit));
            rings.map(|ring| ring.into_iter().map(placed).collect()).collect()
        };
        let few = |curve: &curve::Curve| curve.chords(tolerance / unit).min(MOST_POINTS + 1);
        let count: usize = contours.iter().flat_map(|contour| &contour.curves).map(few).sum();
        if count > MOST_POINTS {
            let message = format!(
                "more than {MOST_POINTS} points are needed for a tolerance of {} m",
                crate::scene::exact(tolerance)
            );
            return Err((message, "a larger `tolerance`, or a simpler drawing".to_owned(), "tolerance"));
        }
        let mut polygons = flattened(tolerance);
        let area = |rings: &[Vec<DVec2>]| rings.iter().map(|ring| twice_area(ring).abs()).sum::<f64>();
        let (found, exact) = (area(&polygons), area(&flattened(0.01 * tolerance)));
        for ring in &mut polygons {
            if twice_area(ring) < 0.0 {
                ring.reverse();
            }
        }
        if let Some((inner, outer)) = nested(&polygons) {
            let message = format!("outline {} lies inside outline {}: shapes have no holes", inner + 1, outer + 1);
            let help = "cut a ring open, or into parts that lie side by side; or choose one element with `id`";
            return Err((message, help.to_owned(), field));
        }
        Ok(Self { polygons, tolerance, lost: (exact - found) / exact, left_out })
    }
}

/// The points of a contour, each farther than `apart` from the one before.
fn chained(contour: &Contour, chords: impl Fn(&curve::Curve) -> usize, apart: f64) -> Vec<DVec2> {
    let mut points = vec![contour.start];
    for at in contour.curves.iter().flat_map(|curve| curve.ends(chords(curve))) {
        if points.last().is_none_or(|last| last.distance(at) > apart) {
            points.push(at);
        }
    }
    while points.len() > 1 && points[points.len() - 1].distance(points[0]) <= apart {
        points.pop();
    }
    points
}

/// Whether the points of a contour lie on no line, beyond the rounding of their places.
fn has_area(ring: &[DVec2]) -> bool {
    let Some(&first) = ring.first() else { return false };
    let farther = |a: &DVec2, b: &DVec2| first.distance(*a).total_cmp(&first.distance(*b));
    let along = ring.iter().copied().max_by(farther).map_or(DVec2::ZERO, |far| far - first);
    let places = ring.iter().fold(0.0, |farthest: f64, at| farthest.max(at.abs().max_element()));
    let rounding = NO_WIDTH * places * along.length();
    // The reader refuses infinite places elsewhere.
    !rounding.is_finite() || ring.iter().any(|at| along.perp_dot(*at - first).abs() > rounding)
}

/// Twice the area of a polygon; negative if it runs clockwise.
fn twice_area(ring: &[DVec2]) -> f64 {
    let origin = ring.first().copied().unwrap_or_default();
    ring.windows(2).map(|two| (two[0] - origin).perp_dot(two[1] - origin)).sum()
}

/// The first outline that lies as a whole in another one, and that one.
fn nested(rings: &[Vec<DVec2>]) -> Option<(usize, usize)> {
    let lies_in = |inner: &[DVec2], outer: &[DVec2]| inner.iter().all(|at| holds(outer, *at));
    let pairs = (0..rings.len()).flat_map(|inner| (0..rings.len()).map(move |outer| (inner, outer)));
    pairs.into_iter().find(|&(inner, outer)| inner != outer && lies_in(&rings[inner], &rings[outer]))
}

/// Whether a polygon holds a place: a ray to the right meets its sides an odd number of times.
fn holds(ring: &[DVec2], at: DVec2) -> bool {
    let sides = ring.iter().zip(ring.iter().cycle().skip(1));
    let meets = sides.filter(|(from, to)| {
        (from.y > at.y) != (to.y > at.y) && at.x < from.x + (at.y - from.y) / (to.y - from.y) * (to.x - from.x)
    });
    meets.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(body: &str, id: Option<&str>) -> Result<Outlines, Wrong> {
        let text = format!("<svg xmlns=\"http://www.w3.org/2000/svg\">{body}</svg>");
        Outlines::read(text.as_bytes(), id, Size::Unit(0.5), None)
    }

    /// Law: several ways to draw an L give one L, upright, with its origin below its middle. Transforms apply from the
    /// inside out.
    #[test]
    fn an_l_is_drawn_in_several_ways() {
        let corners = [(-1.0, 0.0), (1.0, 0.0), (1.0, 0.5), (-0.5, 0.5), (-0.5, 1.5), (-1.0, 1.5)];
        let exact: Vec<DVec2> = corners.iter().map(|(x, y)| DVec2::new(*x, *y)).collect();
        for body in [
            "<path d=\"M0 3H4V2H1V0H0Z\"/>",
            "<polygon points=\"0,3 4,3 4,2 1,2 1,0 0,0\"/><text>L</text>",
            "<g transform=\"translate(7 9) scale(2)\"><path transform=\"rotate(90)\" d=\"m3 0 v-4 h-1 v3 h-2 v1 z\"/></g>",
        ] {
            let found = read(body, None).unwrap();
            let ring = &found.polygons[0];
            assert_eq!(ring.len(), 6, "{body}: {found:?}");
            let scale = if body.contains("scale") { 2.0 } else { 1.0 };
            let is_corner = |at: &DVec2| ring.iter().any(|found| found.distance(*at * scale) < 1e-14);
            assert!(exact.iter().all(is_corner) && twice_area(ring) > 0.0, "{body}: {ring:?}");
            assert!(found.lost.abs() < 1e-15 && found.left_out.len() == usize::from(body.contains("text")));
        }
    }

    /// Law: the polygon in a circle has an area less by `1 - sin(a)/a` with `a` the angle of a chord. The same holds
    /// for a rectangle with round corners.
    #[test]
    fn the_area_that_chords_lose_is_told() {
        let found = read("<circle cx=\"2\" cy=\"2\" r=\"2\"/>", None).unwrap();
        let angle = std::f64::consts::TAU / found.polygons[0].len() as f64;
        let exact = 1.0 - libm::sin(angle) / angle;
        assert!((found.lost / exact - 1.0).abs() < 0.011, "{} of {exact}", found.lost);
        assert!(
            found.tolerance == 2e-3 && found.polygons[0].iter().all(|at| (at.distance(DVec2::Y) - 1.0).abs() < 1e-15)
        );
        let rounded = read("<rect width=\"6\" height=\"4\" rx=\"1\"/>", None).unwrap();
        let area = 0.5 * twice_area(&rounded.polygons[0]);
        let exact = 0.25 * (24.0 - (4.0 - std::f64::consts::PI));
        assert!((area / (1.0 - rounded.lost) / exact - 1.0).abs() < 1e-5, "{area} of {exact}");
    }

    #[test]
    fn lines_without_area_are_left_out() {
        for line in ["M9 9 L9 12", "M0.1 0.1 L0.3 0.3 L0.7 0.7", "M9 9 L10 9 H9 Z"] {
            let found = read(&format!("<path d=\"M0 0 H4 V3 Z {line}\"/>"), None).unwrap();
            assert_eq!((found.polygons.len(), found.left_out), (1, vec!["line without area".to_owned()]), "{line}");
        }
    }

    #[test]
    fn mistakes_are_told() {
        for (body, id, words) in [
            ("<text>L</text>", None, "has no outline, only text"),
            ("<path d=\"M0 0 L1\"/>", None, "has a wrong `path`"),
            ("<rect width=\"3mm\" height=\"1\"/>", None, "`width` is `3mm`"),
            ("<circle r=\"3\"/><circle r=\"1\"/>", None, "outline 2 lies inside outline 1"),
            ("<circle r=\"3\"/>", Some("rim"), "no element with the id `rim`"),
            ("<path d=\"M0 0 L1 0\"/>", None, "has no outline"),
            ("<path d=\"M0 0 L0 1\"/><line x1=\"3\"/>", None, "has no outline, only line, line without area"),
            ("<g transform=\"turn(3)\"><circle r=\"3\"/></g>", None, "`transform` means nothing"),
            ("<g>", None, "is no SVG file"),
            (&"<path d=\"M0 0h1v1z\"/>".repeat(1001), None, "more than 2000 lines and curves"),
            (&format!("<path d=\"M0 0{}z\"/>", "h1v1".repeat(1001)), None, "more than 2000 lines and curves"),
            ("<path d=\"M0 0 L1e300 0 C1e308 1e308 -1e308 1e308 0 1e300 Z\"/>", None, "more than 2000 points"),
        ] {
            let (message, ..) = read(body, id).unwrap_err();
            assert!(message.contains(words), "{body}: {message}");
        }
        assert!(read("<circle r=\"3\"/><circle id=\"rim\" r=\"1\"/>", Some("rim")).is_ok());
    }
}
