//! Shapes as rounded convex hulls: the corners' convex hull, grown by a radius on all sides.
//!
//! The hull of the corners is the *core*. Discs, capsules, polygons and gears become one hull or several; concave
//! shapes become several. Lengths are in metres, angles in radians, y points up, corners run counter-clockwise.

mod boundary;
mod box_tree;
mod clipping;
mod compound;
mod convex_parts;
mod error;
mod gear;
mod half_planes;
mod hull;
mod hull_distance;
mod moments;
mod nearest;
mod orientation;
mod pose;
mod rack;
mod ray;
mod rounded_corners;
mod shape;
mod simple_polygon;
mod time_of_impact;
mod voronoi_region;

pub use compound::{has_more_near_pairs, mark_inner};
pub use error::{Mended, ShapeError};
pub use gear::Gear;
pub use hull::{Free, Hull, HullSide};
pub use hull_distance::{Separation, distance, separation};
pub use moments::AreaMoments;
pub use nearest::{Feature, Nearest, distance_to, may_be_nearer, nearest};
pub use pose::{BoundingBox, Pose};
pub use rack::Rack;
pub use ray::ray;
pub use rounded_corners::Rounded;
pub use shape::{MOST_CORNERS, Shape, capsule, compound, disc, polygon, rectangle, regular};
pub use time_of_impact::{RigidMotion, time_of_impact};
pub use voronoi_region::beyond;

/// The settings of the property tests: the same cases in each run, and no files of failures.
#[cfg(test)]
pub(crate) fn cases(seed: u64, cases: u32) -> proptest::prelude::ProptestConfig {
    let rng_seed = proptest::test_runner::RngSeed::Fixed(seed);
    proptest::prelude::ProptestConfig { cases, rng_seed, failure_persistence: None, ..Default::default() }
}

/// The work of making shapes, for tests that bound it: pairs of parts, pieces and corners that were looked at.
#[cfg(test)]
pub(crate) mod work {
    use std::cell::Cell;

    thread_local!(static WORK: Cell<u64> = const { Cell::new(0) });

    pub(crate) fn count() {
        WORK.set(WORK.get() + 1);
    }

    /// The work of a function.
    pub(crate) fn of<T>(act: impl FnOnce() -> T) -> u64 {
        let before = WORK.get();
        act();
        WORK.get() - before
    }
}
