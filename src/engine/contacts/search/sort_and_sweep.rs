//! Sort and sweep (Cohen, Lin, Manocha, Ponamgi 1995): boxes of bodies are sorted along the axis of their greatest
//! spread. Atoms of overlapping boxes are compared one by one.

use glam::DVec2;

use super::AtomPair;
use crate::tick::bounds::Bounds;
use crate::world::Bodies;

/// All pairs of atoms nearer than the margin, in canonical order.
pub(super) fn pairs(bodies: &Bodies, bounds: &Bounds) -> Vec<AtomPair> {
    let touching = |&body: &usize| bodies.collides[body] && !bodies.atoms_of(body).is_empty();
    let mut order: Vec<usize> = (0..bodies.len()).filter(touching).collect();
    let axis = wider_axis(bounds, &order);
    let across = 1 - axis;
    order.sort_by(|&a, &b| bounds.low[a][axis].total_cmp(&bounds.low[b][axis]));
    let mut pairs = Vec::new();
    for (rank, &first) in order.iter().enumerate() {
        for &second in &order[rank + 1..] {
            if bounds.low[second][axis] > bounds.high[first][axis] {
                break;
            }
            let apart = bounds.low[second][across] > bounds.high[first][across]
                || bounds.low[first][across] > bounds.high[second][across];
            if !apart && (bodies.dynamic[first] || bodies.dynamic[second]) {
                compare_atoms(bodies, bounds, first.min(second), first.max(second), &mut pairs);
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

/// The axis along which boxes spread farther: 0 for x, 1 for y. A tall pile swept along x would be compared each with
/// each. The list of pairs is sorted afterwards and does not depend on it.
fn wider_axis(bounds: &Bounds, bodies: &[usize]) -> usize {
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (low, high) =
        bodies.iter().fold(none, |(low, high), &body| (low.min(bounds.low[body]), high.max(bounds.low[body])));
    usize::from((high - low).y > (high - low).x)
}

fn compare_atoms(bodies: &Bodies, bounds: &Bounds, first: usize, second: usize, pairs: &mut Vec<AtomPair>) {
    for a in bodies.atoms_of(first) {
        let (position, radius) = (bodies.atom_place(a), bodies.atom_radius[a] + bounds.margin / 2.0);
        let outside = position.x + radius < bounds.low[second].x
            || position.x - radius > bounds.high[second].x
            || position.y + radius < bounds.low[second].y
            || position.y - radius > bounds.high[second].y;
        if outside {
            continue;
        }
        for b in bodies.atoms_of(second) {
            let reach = bodies.atom_radius[a] + bodies.atom_radius[b] + bounds.margin;
            if bodies.atom_place(b).distance_squared(position) < reach * reach {
                pairs.push(AtomPair { a: a as u32, b: b as u32 });
            }
        }
    }
}
