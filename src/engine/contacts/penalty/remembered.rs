//! Temporal coherence of pairs of a probe and a hull. The memory is a separating line or the touched side, in the
//! hull's frame.
//!
//! A probe does not touch a hull on the other side of a line (Gottschalk, Lin and Manocha 1996). Bodies that move
//! together keep their line. So the earlier separating line dismisses most pairs that do not touch. If a probe comes
//! near to its line, the line is discarded, and the nearest point is searched.
//!
//! A probe outside a convex core and over a side is nearest to that side (`shapes/nearest.rs`). While it stays over the
//! side that it touches, no other side needs a check.

use jostle_shapes::{Feature, Hull, nearest};
use serde::{Deserialize, Serialize};

use crate::contacts::geometry::PairGeometry;
use crate::contacts::{Probe, Surface, SurfacePair};
use crate::world::Bodies;
use jostle_simd::Record;

/// A line is not trusted for gaps below this share of the hull's extent. The ends of a side are not trusted below this
/// share of its length. The share is far above rounding.
pub(super) const TRUSTED: f64 = 1e-6;

/// Sides whose normals have a greater cosine meet in a very flat corner. Rounded numbers then cannot decide which side
/// is nearer.
const FLATTEST: f64 = 1.0 - 1e-6;

/// The bodies of a hull and of an atom, and half the width in metres of the thinner.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Sides {
    pub bodies: [u32; 2],
    pub size: f64,
}

/// The memory of each pair in a list; empty without hulls.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Remembered {
    /// For a side: its unit normal, its beginning, the range of probes along it, the radii of hull and probe. For a line: its
    /// unit normal, zero, and the point of a touch along the normal; the range is empty. Lengths are in metres, in the frame of
    /// the hull.
    pub records: Vec<Record>,
    pub sides: Vec<Sides>,
}

/// A line; an infinite height means that there is none.
fn line(x: f64, y: f64, height: f64) -> Record {
    Record([x, y, 0.0, height, f64::INFINITY, f64::NEG_INFINITY, 0.0, 0.0])
}

impl Remembered {
    /// Makes room for so many pairs.
    pub fn resize(&mut self, len: usize) {
        self.records.resize(len, line(0.0, 0.0, f64::INFINITY));
        self.sides.resize(len, Sides::default());
    }

    /// Takes note of the bodies of a pair.
    pub fn name(&mut self, index: usize, bodies: &Bodies, pair: SurfacePair) {
        if let (Some(first), second) = pair.bodies(bodies) {
            self.sides[index] = Sides { bodies: [first as u32, second as u32], size: pair.size(bodies) };
        }
    }

    /// Takes over what an older list knew of a pair.
    pub fn carry(&mut self, index: usize, (old, from): (&Self, usize)) {
        (self.records[index], self.sides[index]) = (old.records[from], old.sides[from]);
    }

    /// By how many metres at least an atom is apart from the hull; not positive: not known.
    #[inline(always)]
    pub fn gap(&self, index: usize, bodies: &Bodies, atom: usize) -> f64 {
        let Record([x, y, _, height, from, ..]) = self.records[index];
        let at = bodies.pose_with_hulls(self.sides[index].bodies[0] as usize).point_to_local(bodies.atom_place(atom));
        if from == f64::INFINITY { x * at.x + y * at.y - height } else { f64::NEG_INFINITY }
    }

    /// Sets the line through the nearest point of a hull, perpendicular to the way to the probe. Ends of walls have
    /// none. If the `gap` in metres is too small, there is none either.
    pub fn part(&mut self, index: usize, bodies: &Bodies, pair: SurfacePair, (geometry, gap): (&PairGeometry, f64)) {
        let (Surface::Hull(hull), Probe::Atom(atom)) = (pair.surface(bodies), pair.probe(bodies)) else { return };
        let packed = &bodies.hulls[hull];
        let trusted = TRUSTED * packed.extent;
        self.records[index] = line(0.0, 0.0, f64::INFINITY);
        if gap > trusted {
            let (pose, b) = (bodies.pose_with_hulls(packed.body as usize), &geometry.pair.b);
            let normal = pose.direction_to_local(geometry.pair.normal);
            let at = pose.point_to_local(bodies.atom_place(atom));
            // A sharp corner that meets as a round one is not where its atom is.
            let center = pose.point_to_local(b.arm + bodies.position[b.body]);
            self.records[index] = line(normal.x, normal.y, normal.dot(at) - gap + at.distance(center) + trusted);
        }
    }

    /// Stores the side of a touched hull over which an atom is, if there is one.
    pub fn touch(&mut self, index: usize, bodies: &Bodies, pair: SurfacePair) {
        let (Surface::Hull(hull), Probe::Atom(atom)) = (pair.surface(bodies), pair.probe(bodies)) else { return };
        let (shape, at, radius) = bodies.meeting(hull, atom);
        let packed = &bodies.hulls[hull];
        // A rounded corner is not at the position of its atom.
        if !std::ptr::eq(shape, &packed.hull) {
            return;
        }
        let found = nearest(shape, bodies.pose_with_hulls(packed.body as usize).point_to_local(at));
        let Feature::Side(side) = found.feature else { return };
        if found.distance <= 0.0 || !shape.owns(&found) || is_flat(shape, side) {
            return;
        }
        let (corner, length) = (shape.corners()[side], shape.sides()[side].length);
        let (mut from, mut to) = (TRUSTED * length, length - TRUSTED * length);
        let mut begin = corner;
        if let &[first, _] = shape.corners() {
            // Both sides of a segment are measured from its first end.
            begin = first;
            if side == 1 {
                (from, to) = (-to, -from);
            }
        }
        let (normal, own) = (found.normal, shape.radius());
        self.records[index] = Record([normal.x, normal.y, begin.x, begin.y, from, to, own, radius]);
    }
}

/// Whether a side of a polygon meets a neighbour in a corner that is too flat.
fn is_flat(shape: &Hull, side: usize) -> bool {
    let (sides, count) = (shape.sides(), shape.sides().len());
    let meets = |other: usize| sides[side].normal.dot(sides[other % count].normal) > FLATTEST;
    count > 2 && (meets(side + 1) || meets(side + count - 1))
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use super::*;
    use crate::Simulation;
    use crate::contacts::penalty::PenaltyState;
    use crate::scene::Source;

    /// Law: the memory agrees with the geometry of the current state. A pair with a separating line is apart, by at
    /// least the distance that the line gives. A contact that follows a side in the kernel has the overlap of
    /// [`PairGeometry`] to the last bit. Round and sharp shapes of many kinds and discs tumble in a box of planks, far
    /// from the origin. Tolerance: none. It does not test how many pairs are dismissed.
    #[test]
    fn what_is_remembered_is_the_present_geometry() {
        let shapes = [
            "shape: Rectangle(width: 0.3, height: 0.16, rounding: 0.02)",
            "shape: Rectangle(width: 0.26, height: 0.2)",
            "shape: Capsule(from: (-0.1, 0), to: (0.12, 0.02), radius: 0.05)",
            "shape: Polygon(points: [(-0.12, -0.08), (0.12, -0.08), (0, 0.14)], rounding: 0.01)",
            "shape: Regular(sides: 6, radius: 0.11, rounding: 0.01)",
            "atoms: Disc(radius: 0.1)",
        ];
        let mut bodies = String::new();
        for (number, shape) in (0..120_i32).zip(shapes.iter().cycle()) {
            let (x, y) = (100.0 + 0.33 * f64::from(number % 10), 0.3 + 0.33 * f64::from(number / 10));
            let (angle, spin) = (0.7 * f64::from(number), f64::from(number % 7) - 3.0);
            writeln!(bodies, "(name: \"b{number}\", at: ({x}, {y}), angle: {angle}, spin: {spin}, {shape}),").unwrap();
        }
        for (name, x, y, width, height) in
            [("floor", 101.5, -0.1, 4.0, 0.2), ("left", 99.5, 2.0, 0.2, 4.2), ("right", 103.5, 2.0, 0.2, 4.2)]
        {
            let shape = format!("shape: Rectangle(width: {width}, height: {height})");
            writeln!(bodies, "(name: \"{name}\", at: ({x}, {y}), fixed: true, {shape}),").unwrap();
        }
        let text = format!(
            r#"Scene(
                format: 1,
                clock: (duration: 1, tick: "50 us", method: VelocityVerlet),
                gravity: (0, -9.81),
                contacts: Penalty(normal: Dashpot),
                materials: {{"default": (stiffness: 5e4, friction: 0.4, restitution: 0.3, density: 50)}},
                bodies: [{bodies}],
            )"#
        );
        let mut simulation =
            Simulation::load(&Source::new("tumble.ron", text)).unwrap_or_else(|error| panic!("{error}"));
        let (mut parted, mut touching) = (0, 0);
        for round in 1..=120 {
            simulation.run_to_tick(149 * round).unwrap();
            let state = simulation.state();
            let (contacts, pairs) = (&state.model::<PenaltyState>().unwrap().contacts, state.pairs.as_ref().unwrap());
            let (list, bodies) = (&contacts.surfaces, state.bodies());
            for (index, &pair) in pairs.surfaces.iter().enumerate() {
                let (geometry, apart) = PairGeometry::near(bodies, index, pair);
                let Probe::Atom(atom) = pair.probe(bodies) else { continue };
                if list.is_touching(index) {
                    let overlap = list.get(index).overlap;
                    assert_eq!(overlap.to_bits(), geometry.overlap.max(0.0).to_bits(), "overlap of pair {index}");
                    touching += 1;
                } else {
                    let gap = list.remembered.gap(index, bodies, atom);
                    assert!(gap <= 0.0 || geometry.overlap < 0.0 && gap <= apart, "{index}: {gap} m of {apart} m");
                    parted += usize::from(gap > 0.0);
                }
            }
        }
        assert!(touching > 2000 && parted > 2000, "only {touching} contacts and {parted} lines were compared");
    }
}
