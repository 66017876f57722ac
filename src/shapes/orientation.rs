//! The exact orientation of three points: the side of a line on which a point lies.
//!
//! The sign is that of (b - a) x (c - a), by the adaptive predicate of Shewchuk (1997). The title is "Adaptive
//! precision floating-point arithmetic and fast robust geometric predicates". The sign is right for all coordinates
//! that [`crate::hull`] admits.

use glam::DVec2;
use robust::{Coord, orient2d};

/// Positive if `c` lies left of the line from `a` to `b`, negative if right, zero if exactly on it. The size is near
/// (b - a) x (c - a), in m2.
pub(crate) fn orientation(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the sign is exact where the rounded cross product is zero. Source: the
    /// points are numbers of the binary grid, so that the side is known by hand.
    #[test]
    fn the_sign_is_exact_one_unit_in_the_last_place_beside_a_line() {
        let (a, b) = (DVec2::new(12.0, 12.0), DVec2::new(24.0, 24.0));
        for (place, sign) in [(0.5, 0.0), (0.5 + f64::EPSILON / 2.0, 1.0), (0.5 - f64::EPSILON / 4.0, -1.0)] {
            let found = orientation(a, b, DVec2::new(0.5, place));
            assert_eq!(if found == 0.0 { 0.0 } else { found.signum() }, sign, "{place}");
        }
    }
}
