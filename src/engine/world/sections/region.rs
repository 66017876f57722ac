//! A region of the plane: a box or a polygon. `fill` puts bodies into one, sensors look at one.

use std::fmt;

use glam::DVec2;
use jostle_shapes::MOST_CORNERS;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, SeqAccess, Visitor};

use crate::scene::units::LengthPair;
use crate::scene::{Diagnostics, exact};

/// Two points are opposite corners of a box; three or more are the corners of a polygon, in order.
///
/// A point is inside if a ray from it crosses the outline an odd number of times (even-odd rule). So outlines may cross
/// themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// As they are written.
    given: Vec<DVec2>,
    /// Of the polygon; of a box the lower left one, then counter-clockwise.
    corners: Vec<DVec2>,
}

struct Corners;

impl<'de> Visitor<'de> for Corners {
    type Value = Region;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("two corners of a box `((0, 0), (6, 6))`, or three or more of a polygon")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Region, A::Error> {
        let mut points: Vec<LengthPair> = Vec::new();
        while let Some(point) = values.next_element()? {
            points.push(point);
        }
        Ok(points.into())
    }
}

impl<'de> Deserialize<'de> for Region {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_tuple(2, Corners)
    }
}

impl JsonSchema for Region {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Region".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": ["array", "string"],
            "items": generator.subschema_for::<LengthPair>(),
            "minItems": 2,
            "maxItems": MOST_CORNERS,
            "x-value": "`((x, y), (x, y), ..)`",
            "x-unit": "m",
        })
    }
}

impl From<Vec<LengthPair>> for Region {
    fn from(points: Vec<LengthPair>) -> Self {
        let given: Vec<DVec2> = points.into_iter().map(LengthPair::si).collect();
        let corners = match given[..] {
            [a, b] => {
                let (low, high) = (a.min(b), a.max(b));
                vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
            }
            _ => given.clone(),
        };
        Self { given, corners }
    }
}

impl Region {
    fn is_box(&self) -> bool {
        self.given.len() == 2
    }

    /// Its word in messages.
    pub fn noun(&self) -> &'static str {
        if self.is_box() { "box" } else { "polygon" }
    }

    /// Reports too few or too many corners, and a region without area; paths are relative to the region.
    pub fn check(&self, report: &mut Diagnostics) {
        let count = self.given.len();
        let finite = self.given.iter().enumerate();
        let finite = finite.fold(true, |good, (index, point)| report.finite_pair(&format!("[{index}]"), *point) & good);
        if !finite {
            return;
        }
        if count < 2 {
            let message = format!("expected two corners of a box or three or more of a polygon, found {count}");
            report.error("", message).help("for example: within: ((0, 0), (6, 6))");
        } else if count > MOST_CORNERS {
            let message = format!("a polygon may have {MOST_CORNERS} corners, got {count}");
            report.error("", message).help("leave out corners that hardly turn the outline");
        } else if self.is_box() {
            let (low, high) = self.bounds();
            let size = high - low;
            if !(size.x > 0.0 && size.y > 0.0 && size.is_finite()) {
                let message =
                    format!("the box must have width and height, got {} m by {} m", exact(size.x), exact(size.y));
                report.error("", message).help("give two opposite corners: `within: ((0, 0), (6, 6))`");
            }
        } else if !(self.area() > 0.0 && self.area().is_finite()) {
            let message = format!("the polygon must have an area, got {} m2", exact(self.area()));
            report.error("", message).help("give its corners in order, such as `((0, 0), (4, 0), (2, 3))`");
        }
    }

    /// The lower left and upper right corner of the box around it.
    pub(super) fn bounds(&self) -> (DVec2, DVec2) {
        let low = self.corners.iter().fold(DVec2::INFINITY, |low, corner| low.min(*corner));
        (low, self.corners.iter().fold(DVec2::NEG_INFINITY, |high, corner| high.max(*corner)))
    }

    fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> {
        self.corners.iter().copied().zip(self.corners.iter().copied().cycle().skip(1))
    }

    /// The number of corners that it has.
    pub(super) fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// The area inside its outline, in m2.
    pub(super) fn area(&self) -> f64 {
        // Counted from a corner, so that a polygon far from the origin keeps its digits.
        let origin = self.corners[0];
        (self.edges().map(|(a, b)| (a - origin).perp_dot(b - origin)).sum::<f64>() / 2.0).abs()
    }

    /// Whether a circle lies inside.
    pub fn holds(&self, center: DVec2, radius: f64) -> bool {
        if self.is_box() {
            let (low, high) = (self.corners[0] + radius, self.corners[2] - radius);
            return center.cmpge(low).all() && center.cmple(high).all();
        }
        let mut inside = false;
        for (a, b) in self.edges() {
            if (a.y > center.y) != (b.y > center.y) {
                let across = a.x + (center.y - a.y) / (b.y - a.y) * (b.x - a.x);
                inside ^= center.x < across;
            }
            let along = b - a;
            let square = along.length_squared();
            let share = if square > 0.0 { ((center - a).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
            if center.distance(a + share * along) < radius {
                return false;
            }
        }
        inside
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region(points: &[(f64, f64)]) -> Region {
        points.iter().map(|&(x, y)| LengthPair::new(x, y)).collect::<Vec<_>>().into()
    }

    #[test]
    fn a_box_is_the_polygon_of_its_corners() {
        let as_box = region(&[(2.0, 3.0), (0.0, 1.0)]);
        let polygon = region(&[(0.0, 1.0), (2.0, 1.0), (2.0, 3.0), (0.0, 3.0)]);
        assert_eq!((as_box.area(), polygon.area()), (4.0, 4.0));
        for x in -2..12 {
            for y in -2..18 {
                // Off the grid of the corners, so that no circle just touches an edge.
                let center = DVec2::new(f64::from(x) * 0.25 + 0.03, f64::from(y) * 0.25 + 0.03);
                assert_eq!(as_box.holds(center, 0.2), polygon.holds(center, 0.2), "{center}");
            }
        }
    }

    /// A funnel: the notch at its side and the way a circle must keep from slanted edges.
    #[test]
    fn circles_keep_away_from_all_edges() {
        let funnel = region(&[(-2.0, 2.0), (-0.5, 0.0), (0.5, 0.0), (2.0, 2.0)]);
        assert_eq!(funnel.area(), 5.0);
        assert!(funnel.holds(DVec2::new(0.0, 0.5), 0.5));
        assert!(!funnel.holds(DVec2::new(0.0, 0.5), 0.51));
        // The slanted edge through (0.5, 0) and (2, 2) is 0.8 x - 0.6 y = 0.4. The point (1, 1) is 0.2 from it.
        assert!(funnel.holds(DVec2::new(1.0, 1.0), 0.19));
        assert!(!funnel.holds(DVec2::new(1.0, 1.0), 0.21));
        assert!(!funnel.holds(DVec2::new(1.9, 0.2), 0.0));
    }
}
