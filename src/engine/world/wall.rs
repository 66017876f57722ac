//! A wall, infinitely stiff. It is the half-plane behind a line, one-sided, or a strip with two ends that is hit from
//! both sides.

use bevy_ecs::prelude::*;
use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::body::mark_changed;
use super::material::MaterialIndex;

/// A half-plane through two points. Seen from the open side `left` is on the left. With a thickness it is the strip about the line from
/// `left` to `right` instead, with round ends.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[component(immutable, on_insert = mark_changed, on_remove = mark_changed)]
pub struct Wall {
    /// Place in the canonical order of walls.
    pub key: u64,
    /// The left point in metres.
    pub left: DVec2,
    /// The right point in metres.
    pub right: DVec2,
    /// Thickness of a strip in metres, zero or more; `None`: a half-plane.
    pub thickness: Option<f64>,
    /// The index of its material.
    pub material: MaterialIndex,
    /// Velocity of its surface in m/s, along the wall: a belt. Zero: it is at rest.
    pub surface_velocity: DVec2,
}

impl Wall {
    /// Unit normal towards the open side: the direction from left to right, turned a quarter turn clockwise.
    ///
    /// A floor with its left point at x = 6 and its right point at x = 0 opens upward.
    pub fn normal(&self) -> DVec2 {
        let along = self.right - self.left;
        DVec2::new(along.y, -along.x).normalize()
    }

    /// The wall as contacts see it: a piece of a line, if it has a line number.
    pub(super) fn packed(&self, entity: Entity, line: Option<u32>) -> PackedWall {
        PackedWall { entity, point: self.left, normal: self.normal(), ends: self.ends(), line, material: self.material }
    }

    /// Its two ends, if it has ends.
    pub(super) fn ends(&self) -> Option<WallEnds> {
        let half = 0.5 * self.thickness?;
        Some(WallEnds { length: (self.right - self.left).length(), half })
    }
}

/// The ends of a wall.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallEnds {
    /// Length of its middle line in metres, from its point along the normal turned counter-clockwise.
    pub length: f64,
    /// Half its thickness in metres.
    pub half: f64,
}

/// A wall as contacts see it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackedWall {
    /// The wall's entity.
    pub entity: Entity,
    /// A point on the line, in metres: the left end if it has ends.
    pub point: DVec2,
    /// Unit normal towards the open side.
    pub normal: DVec2,
    /// Its ends, if it has ends: it is then open on both sides.
    pub ends: Option<WallEnds>,
    /// The number of its line, if it is a piece of one.
    pub line: Option<u32>,
    /// The index of its material.
    pub material: MaterialIndex,
}

/// The nearest point of the surface of a wall, as seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// Distance from the surface in metres, negative inside.
    pub height: f64,
    /// Unit normal of the surface at its nearest point, towards the viewer.
    pub normal: DVec2,
    /// Distance in metres from the centre of the nearest round end; infinite if the surface is flat. In the corner of a
    /// line it is negative. It counts from the point at which the viewer would touch both sides.
    pub distance: f64,
}

impl PackedWall {
    /// The nearest point of its surface.
    #[inline(always)]
    pub fn nearest(&self, at: DVec2) -> NearestPoint {
        let from = at - self.point;
        match self.ends {
            None => NearestPoint { height: from.dot(self.normal), normal: self.normal, distance: f64::INFINITY },
            Some(ends) => self.nearest_of_strip(from, ends),
        }
    }

    /// The same for a place from the left end.
    fn nearest_of_strip(&self, from: DVec2, WallEnds { length, half }: WallEnds) -> NearestPoint {
        let along = self.normal.perp();
        let way = from.dot(along);
        let end = way.clamp(0.0, length);
        if end == way {
            let height = from.dot(self.normal);
            let normal = if height < 0.0 { -self.normal } else { self.normal };
            return NearestPoint { height: height.abs() - half, normal, distance: f64::INFINITY };
        }
        let apart = from - along * end;
        let distance = apart.length();
        NearestPoint { height: distance - half, normal: apart / distance, distance }
    }

    /// Whether it is a strip without thickness that is hit from both sides. A corner without a radius would have no
    /// position in it.
    #[inline]
    pub fn is_thin(&self) -> bool {
        self.line.is_none() && self.ends.is_some_and(|ends| ends.half == 0.0)
    }

    /// Centre in metres and radius in metres of one of its round ends: of a wall with ends.
    pub fn end(&self, right: bool) -> (DVec2, f64) {
        let WallEnds { length, half } = self.ends.unwrap_or(WallEnds { length: 0.0, half: 0.0 });
        (self.point + self.normal.perp() * if right { length } else { 0.0 }, half)
    }

    /// Whether a point on a straight way between two positions has crossed the middle line of a wall with ends.
    pub fn is_crossed(&self, before: DVec2, now: DVec2) -> bool {
        let Some(WallEnds { length, .. }) = self.ends else { return false };
        let heights = [before, now].map(|at| (at - self.point).dot(self.normal));
        if (heights[0] < 0.0) == (heights[1] < 0.0) {
            return false;
        }
        let crossing = before + (now - before) * (heights[0] / (heights[0] - heights[1]));
        (0.0..=length).contains(&(crossing - self.point).dot(self.normal.perp()))
    }

    /// The distance in m of a point from the middle line of a wall with ends; infinite without ends.
    pub fn distance_to_middle(&self, at: DVec2) -> f64 {
        let Some(WallEnds { length, .. }) = self.ends else { return f64::INFINITY };
        let offset = at - self.point;
        let along = offset.dot(self.normal.perp());
        DVec2::new(along - along.clamp(0.0, length), offset.dot(self.normal)).length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_open_side_is_where_left_is_left() {
        let material = MaterialIndex::default();
        let wall = |left, right| Wall { key: 0, left, right, thickness: None, material, surface_velocity: DVec2::ZERO };
        let normal = |l: (f64, f64), r: (f64, f64)| wall(DVec2::new(l.0, l.1), DVec2::new(r.0, r.1)).normal();
        assert_eq!(normal((6.0, 0.0), (0.0, 0.0)), DVec2::Y);
        assert_eq!(normal((0.0, 6.0), (1.0, 6.0)), DVec2::NEG_Y);
        assert_eq!(normal((0.0, 0.0), (0.0, 1.0)), DVec2::X);
        assert_eq!(normal((6.0, 1.0), (6.0, 0.0)), DVec2::NEG_X);
    }

    /// Law: the nearest point of a strip is on its face, or on the circle about an end. Heights agree at the border
    /// between face and circle. Tolerance: roundings of numbers near 1.
    #[test]
    fn a_strip_has_two_faces_and_two_round_ends() {
        let wall = Wall {
            key: 0,
            left: DVec2::new(2.0, 0.0),
            right: DVec2::ZERO,
            thickness: Some(0.2),
            material: MaterialIndex::default(),
            surface_velocity: DVec2::ZERO,
        };
        let packed = wall.packed(Entity::PLACEHOLDER, None);
        for (at, height, normal, distance) in [
            ((1.0, 0.5), 0.4, (0.0, 1.0), f64::INFINITY),
            ((1.0, -0.5), 0.4, (0.0, -1.0), f64::INFINITY),
            ((2.3, 0.4), 0.4, (0.6, 0.8), 0.5),
            ((-0.4, -0.3), 0.4, (-0.8, -0.6), 0.5),
            ((2.0, 0.5), 0.4, (0.0, 1.0), f64::INFINITY),
        ] {
            let found = packed.nearest(at.into());
            assert!((found.height - height).abs() < 1e-15, "{at:?}: {found:?}");
            assert!((found.normal - DVec2::from(normal)).length() < 1e-15, "{at:?}: {found:?}");
            assert!(found.distance == distance || (found.distance - distance).abs() < 1e-15, "{at:?}: {found:?}");
        }
        let crossed = |a: (f64, f64), b: (f64, f64)| packed.is_crossed(a.into(), b.into());
        assert!(crossed((1.0, 0.5), (1.2, -0.5)) && crossed((1.0, -0.5), (1.0, 0.5)));
        assert!(!crossed((3.0, 0.5), (3.0, -0.5)) && !crossed((1.0, 0.5), (1.5, 0.1)));
    }
}
