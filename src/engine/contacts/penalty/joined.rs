//! Joints of bodies with contacts, for the search for rest.

use crate::constraints::islands::{IslandLink, Members};
use crate::constraints::rest_solver::{JointRow, JointRowSide, Mover};
use crate::constraints::{Row, RowKind, Rows};
use crate::world::Bodies;
use glam::DVec2;

/// A row of a joint between the bodies whose islands it joins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joined {
    /// The index of the row.
    pub row: usize,
    own: usize,
    other: Option<usize>,
}

impl IslandLink for Joined {
    fn other_body(&self) -> Option<usize> {
        self.other
    }

    fn own_body(&self) -> usize {
        self.own
    }
}

/// Finds the rows of joints that hold a body which moves by forces.
pub(super) fn find_joined(rows: &Rows, bodies: &Bodies, joined: &mut Vec<Joined>) {
    joined.clear();
    if !rows.has_joints() {
        return;
    }
    let holds = |index: usize, row: &Row| row.kind != RowKind::Acceleration && !rows.gives_its_bound(index);
    for (index, row) in rows.all().iter().enumerate().filter(|(index, row)| holds(*index, row)) {
        let [a, b] = row.sides.map(|side| side.map(|side| side.body));
        let moves = [a, b].into_iter().flatten().any(|body| bodies.dynamic[body]);
        if let (Some(own), true) = (b.or(a), moves) {
            joined.push(Joined { row: index, own, other: b.and(a) });
        }
    }
}

/// A row as the search for rest solves it, with its present force.
pub(super) fn joint_row(
    index: usize,
    rows: &Rows,
    bodies: &Bodies,
    members: &Members,
    movers: &[Mover],
) -> Option<JointRow> {
    let row = rows.row(index);
    let sides = row.sides.map(|side| {
        side.map_or(JointRowSide::default(), |side| {
            let extent = bodies.extent(side.body);
            let turns = side.direction == DVec2::ZERO && extent > 0.0;
            let load = if turns { side.lever.abs() / extent } else { side.direction.length() };
            JointRowSide { mover: members.index(side.body), direction: side.direction, lever: side.lever, load }
        })
    });
    JointRow::new(sides, movers, (row.rate, rows.force(index)))
}
