//! A tree of bounding boxes, halved at the middle of the longer axis (Goldsmith and Salmon 1987).
//!
//! It finds the boxes that touch another one, without a look at all others.

use glam::DVec2;

use crate::pose::BoundingBox;

/// So many boxes are looked at one by one.
const LEAF: usize = 4;

/// Boxes by their places in a list.
pub(crate) struct BoxTree {
    nodes: Vec<Node>,
    /// The boxes with their places, in the order of the leaves.
    boxes: Vec<(usize, BoundingBox)>,
}

/// A box around some of the boxes, and their range. Its first half is the next node.
struct Node {
    bounds: BoundingBox,
    from: usize,
    to: usize,
    /// The node behind its own ones.
    after: usize,
}

impl BoxTree {
    pub fn new(boxes: impl IntoIterator<Item = BoundingBox>) -> Self {
        let boxes: Vec<(usize, BoundingBox)> = boxes.into_iter().enumerate().collect();
        let mut tree = Self { nodes: Vec::new(), boxes };
        if !tree.boxes.is_empty() {
            tree.divide(0, tree.boxes.len());
        }
        tree
    }

    fn divide(&mut self, from: usize, to: usize) {
        let empty = BoundingBox { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };
        let bounds = self.boxes[from..to].iter().fold(empty, |bounds, (_, one)| bounds.with(one));
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, from, to, after: 0 });
        if to - from > LEAF {
            let size = bounds.high - bounds.low;
            let middle = |(place, one): &(usize, BoundingBox)| {
                let sum = one.low / 2.0 + one.high / 2.0;
                (if size.x > size.y { sum.x } else { sum.y }, *place)
            };
            let half = (to - from) / 2;
            let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
            self.boxes[from..to].select_nth_unstable_by(half, |a, b| order(&middle(a), &middle(b)));
            self.divide(from, from + half);
            self.divide(from + half, to);
        }
        self.nodes[node].after = self.nodes.len();
    }

    /// The places of the boxes that touch a box, ascending.
    pub fn touching(&self, bounds: &BoundingBox) -> Vec<usize> {
        let (mut found, mut node) = (Vec::new(), 0);
        while let Some(Node { bounds: all, from, to, after }) = self.nodes.get(node) {
            let (touches, is_leaf) = (all.touches(bounds), to - from <= LEAF);
            if touches && is_leaf {
                let near = self.boxes[*from..*to].iter().filter(|(_, one)| one.touches(bounds));
                found.extend(near.map(|(place, _)| *place));
            }
            node = if touches && !is_leaf { node + 1 } else { *after };
        }
        found.sort_unstable();
        found
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(crate::cases(9, 200))]

        /// Law: the tree finds those that a look at all finds, in their order. Boxes lie on a grid, so that edges touch.
        #[test]
        fn the_tree_finds_what_a_look_at_all_finds(
            places in prop::collection::vec((0..20, 0..20, 0..6, 0..6), 0..60), at in (0..20, 0..20, 0..9, 0..9),
        ) {
            let bounds = |(x, y, w, h): (i32, i32, i32, i32)| {
                let low = DVec2::new(x.into(), y.into());
                BoundingBox { low, high: low + DVec2::new(w.into(), h.into()) }
            };
            let (boxes, asked): (Vec<BoundingBox>, _) = (places.into_iter().map(bounds).collect(), bounds(at));
            let expected: Vec<usize> = (0..boxes.len()).filter(|at| boxes[*at].touches(&asked)).collect();
            prop_assert_eq!(BoxTree::new(boxes).touching(&asked), expected);
        }
    }
}
