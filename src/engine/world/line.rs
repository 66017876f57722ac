//! Polyline walls: surfaces of many pieces, open on one side, on which no body trips over a joint.
//!
//! An atom of radius `r` stays out of a region: the line moved by `r` to its open side. Its centre must not enter that
//! region. If the line bends away from the open side, the joint is the centre of an arc of that region. If it bends
//! towards the open side, both pieces end in one corner, `r tan(turn / 2)` before the joint. The overlap is the
//! distance from the region, which is once differentiable everywhere. So one contact moves from piece to piece with its
//! springs, and a joint needs no event.
//!
//! In a corner as sharp as [`SHARP`], or narrow beside the atom, one contact would have too little friction. There both
//! pieces continue behind the joint and push.

use bevy_ecs::prelude::*;
use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::Bodies;
use super::body::mark_changed;
use super::wall::{NearestPoint, PackedWall, Wall, WallEnds};

/// The points of a [`Wall`] that is a line, in metres. It is open to the left of the way from the first to the last
/// point. A line is closed if both are the same.
#[derive(Component, Clone, Debug, PartialEq)]
#[component(immutable, on_insert = mark_changed, on_remove = mark_changed)]
pub struct Line(pub Vec<DVec2>);

/// From this turn on, in rad, both pieces of a corner push. The friction of one contact would be less by the square of
/// the turn over 8.
pub const SHARP: f64 = 0.1;
/// The turn in rad, away from the open side, between two joints that push sides of hulls. In a line with short pieces
/// only a few joints push. So a hill is not stiffer if it has more pieces. A side overlaps a hill of radius `R` by up
/// to `R` times the square of this turn over 8.
const APART: f64 = 0.01;
/// The allowed depth of the centre of a disc or corner behind the line at the start. It is a share of half the width of
/// its owner. A deeper centre at a later time has come from behind.
pub(crate) const BEHIND: f64 = 0.1;
/// Pieces, or boxes, in a box of the tree.
const IN_BOX: usize = 8;

/// A joint of two pieces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Joint {
    /// Sine and cosine of the turn towards the open side.
    turn: DVec2,
    /// Tangent of half the turn.
    tangent: f64,
    /// From the joint to the corner of the room for a radius of 1 m.
    corner: DVec2,
    /// Half the length in metres of the shorter piece.
    half: f64,
    /// Whether it turns by [`SHARP`] or more.
    sharp: bool,
}

/// A line as contacts see it: its pieces are walls that follow one another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackedLine {
    /// Place of its first piece among the walls.
    pub first: u32,
    /// The number of pieces that it has.
    pub count: u32,
    /// The joint before each piece, and the one behind the last; `None` at an end of the line.
    joints: Vec<Option<Joint>>,
    /// Whether it is closed and open to the outside.
    is_block: bool,
    /// Of each joint, whether it pushes sides of hulls.
    sticks_out: Vec<bool>,
    /// Boxes about groups of pieces, then about groups of those, up to one box.
    boxes: Vec<Vec<(DVec2, DVec2)>>,
}

/// The position of an atom beside a piece.
enum Seat {
    /// Nearer to the piece before, or to the one behind.
    Before,
    Behind,
    Here(NearestPoint),
}

/// An atom as lines see it.
#[derive(Clone, Copy)]
struct Probe {
    at: DVec2,
    radius: f64,
    /// Half the width of its owner.
    size: f64,
}

impl PackedLine {
    /// Packs a line whose first piece becomes the wall at a place.
    fn of(pieces: &[PackedWall], first: usize, closed: bool) -> Self {
        let count = pieces.len();
        let joint = |before: &PackedWall, behind: &PackedWall| {
            let turn = DVec2::new(before.normal.dot(behind.normal), before.normal.perp_dot(behind.normal));
            let bend = 1.0 + turn.x;
            let half = 0.5 * length(before).min(length(behind));
            Joint {
                turn,
                tangent: turn.y / bend,
                corner: (before.normal + behind.normal) / bend,
                half,
                sharp: libm::atan2(turn.y, turn.x) >= SHARP,
            }
        };
        let mut joints = vec![None];
        joints.extend(pieces.windows(2).map(|two| Some(joint(&two[0], &two[1]))));
        joints.push(None);
        if closed {
            joints[0] = Some(joint(&pieces[count - 1], &pieces[0]));
            joints[count] = joints[0];
        }
        let origin = pieces[0].point;
        let twice_area: f64 =
            pieces.windows(2).map(|two| (two[0].point - origin).perp_dot(two[1].point - origin)).sum();
        let mut turned = 0.0_f64;
        let sticks_out = joints
            .iter()
            .map(|joint| {
                let Some(joint) = joint else { return true };
                turned = (turned - libm::atan2(joint.turn.y, joint.turn.x)).max(0.0);
                let reached = joint.tangent < 0.0 && turned >= APART;
                if reached {
                    turned = 0.0;
                }
                reached
            })
            .collect();
        let about = |group: &[(DVec2, DVec2)]| {
            group.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |all, one| (all.0.min(one.0), all.1.max(one.1)))
        };
        let mut level: Vec<_> = pieces
            .iter()
            .map(|piece| {
                let ([(left, half), (right, _)], grow) = (both_ends(piece), DVec2::splat);
                (left.min(right) - grow(half), left.max(right) + grow(half))
            })
            .collect();
        let mut boxes = Vec::new();
        while boxes.is_empty() || level.len() > 1 {
            level = level.chunks(IN_BOX).map(about).collect();
            boxes.push(level.clone());
        }
        Self {
            first: first as u32,
            count: count as u32,
            joints,
            is_block: closed && twice_area < 0.0,
            sticks_out,
            boxes,
        }
    }

    /// Whether it runs clockwise around a block of ground.
    pub(crate) fn is_block(&self) -> bool {
        self.is_block
    }

    /// Whether the round ends of a piece are parts of the surface, at the left and at the right point. They are not if the line
    /// bends towards its open side.
    pub(crate) fn round_ends(&self, wall: usize) -> [bool; 2] {
        let piece = wall - self.first as usize;
        [piece + 1, piece].map(|index| self.joints[index].is_none_or(|joint| joint.tangent < 0.0))
    }

    /// The places of its pieces among the walls.
    pub fn pieces(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }

    /// Shows the pieces, by their numbers in order, whose boxes may be nearer to a place than `reach` metres.
    pub fn each_near(&self, at: DVec2, reach: f64, see: &mut impl FnMut(usize)) {
        self.descend(self.boxes.len(), 0, (at, reach * reach), see);
    }

    fn descend(&self, level: usize, index: usize, (at, square): (DVec2, f64), see: &mut impl FnMut(usize)) {
        if level == 0 {
            return see(index);
        }
        let (low, high) = self.boxes[level - 1][index];
        if at.distance_squared(at.clamp(low, high)) > square {
            return;
        }
        let below = if level == 1 { self.count as usize } else { self.boxes[level - 2].len() };
        for child in IN_BOX * index..below.min(IN_BOX * (index + 1)) {
            self.descend(level - 1, child, (at, square), see);
        }
    }

    /// The number of the piece before or behind another one. The caller never asks beyond the ends of a line.
    fn next(&self, piece: usize, behind: bool) -> usize {
        let count = self.count as usize;
        if behind { (piece + 1) % count } else { (piece + count - 1) % count }
    }

    /// The end of a piece at a joint for an atom, in metres before the joint. If both pieces push, it is negative,
    /// which is behind the joint, and the second value is true.
    fn end(&self, joint: &Joint, other: &PackedWall, probe: Probe) -> (f64, bool) {
        let radius = probe.radius + half(other);
        let short = radius * joint.tangent;
        if joint.tangent <= 0.0 {
            (0.0, false)
        } else if joint.sharp || short > joint.half {
            (-(length(other) * joint.turn.x.max(0.0) + probe.size), true)
        } else {
            (short, false)
        }
    }

    /// The position of an atom beside a piece.
    fn seat(&self, walls: &[PackedWall], piece: usize, probe: Probe) -> Seat {
        let wall = &walls[self.first as usize + piece];
        let WallEnds { length, half } = wall.ends.unwrap_or(WallEnds { length: 0.0, half: 0.0 });
        let from = probe.at - wall.point;
        let back = from.dot(wall.normal.perp());
        let height = from.dot(wall.normal);
        // The wall runs backwards from its left point, at which the next piece begins.
        for (behind, beyond, joint) in
            [(true, -back, self.joints[piece + 1]), (false, back - length, self.joints[piece])]
        {
            let (short, stops) = joint.map_or((0.0, true), |joint| {
                self.end(&joint, &walls[self.first as usize + self.next(piece, behind)], probe)
            });
            if beyond <= -short {
                continue;
            }
            if !stops {
                return if behind { Seat::Behind } else { Seat::Before };
            }
            let along = if behind { -wall.normal.perp() } else { wall.normal.perp() };
            let end = wall.end(!behind).0 - along * short;
            return Seat::Here(round(probe.at - end, half, wall.normal));
        }
        Seat::Here(NearestPoint { height: height - half, normal: wall.normal, distance: f64::INFINITY })
    }

    /// The nearest place at a joint between two pieces, of which the first has this number.
    fn at_joint(&self, walls: &[PackedWall], piece: usize, probe: Probe) -> NearestPoint {
        let wall = &walls[self.first as usize + piece];
        let (point, half) = wall.end(false);
        let Some(joint) = self.joints[piece + 1].filter(|joint| joint.tangent > 0.0) else {
            return round(probe.at - point, half, wall.normal);
        };
        let inwards = point + joint.corner * (probe.radius + half) - probe.at;
        let depth = inwards.length();
        let normal = if depth > 0.0 { inwards / depth } else { wall.normal };
        NearestPoint {
            height: probe.radius - depth,
            normal,
            distance: if depth > 0.0 { -depth } else { f64::INFINITY },
        }
    }

    /// Follows a line from a piece to the point nearest to an atom. Returns the number of the piece, or of the one
    /// before the joint, and the point.
    fn walk(&self, walls: &[PackedWall], mut piece: usize, probe: Probe) -> (usize, NearestPoint) {
        let mut came = None;
        for _ in 0..=self.count {
            let behind = match self.seat(walls, piece, probe) {
                Seat::Here(found) => return (piece, found),
                Seat::Behind => true,
                Seat::Before => false,
            };
            let next = self.next(piece, behind);
            if came == Some(!behind) {
                let before = if behind { piece } else { next };
                return (before, self.at_joint(walls, before, probe));
            }
            (came, piece) = (Some(behind), next);
        }
        (piece, self.at_joint(walls, piece, probe))
    }

    /// The nearest point to an atom on a piece, or at the joint behind it. `None` if another piece is nearer.
    fn home(&self, walls: &[PackedWall], piece: usize, probe: Probe) -> Option<NearestPoint> {
        match self.seat(walls, piece, probe) {
            Seat::Here(found) => Some(found),
            Seat::Before => None,
            Seat::Behind => matches!(self.seat(walls, self.next(piece, true), probe), Seat::Before)
                .then(|| self.at_joint(walls, piece, probe)),
        }
    }
}

/// The nearest place of a round end whose centre is `apart` from an atom.
fn round(apart: DVec2, half: f64, otherwise: DVec2) -> NearestPoint {
    let distance = apart.length();
    let normal = if distance > 0.0 { apart / distance } else { otherwise };
    NearestPoint { height: distance - half, normal, distance }
}

fn length(wall: &PackedWall) -> f64 {
    wall.ends.map_or(0.0, |ends| ends.length)
}

fn half(wall: &PackedWall) -> f64 {
    wall.ends.map_or(0.0, |ends| ends.half)
}

fn both_ends(wall: &PackedWall) -> [(DVec2, f64); 2] {
    [false, true].map(|right| wall.end(right))
}

/// Packs walls in canonical order, each with its points if it is a line.
pub(super) fn pack(walls: &[(Entity, Wall, Option<Line>)]) -> (Vec<PackedWall>, Vec<PackedLine>) {
    let (mut packed, mut lines) = (Vec::new(), Vec::new());
    for (entity, wall, line) in walls {
        let Some(Line(points)) = line else {
            packed.push(wall.packed(*entity, None));
            continue;
        };
        let (first, number) = (packed.len(), lines.len() as u32);
        packed.extend(points.windows(2).map(|two| {
            let piece = Wall { left: two[1], right: two[0], thickness: wall.thickness.or(Some(0.0)), ..*wall };
            piece.packed(*entity, Some(number))
        }));
        let closed = points.len() > 3 && points.first() == points.last();
        lines.push(PackedLine::of(&packed[first..], first, closed));
    }
    (packed, lines)
}

impl Bodies {
    /// The nearest point of a wall to an atom at a position in metres. If the wall is a piece of a line, the whole line
    /// counts.
    #[inline(always)]
    pub fn nearest_on_wall(&self, wall: usize, atom: usize, at: DVec2) -> NearestPoint {
        let packed = &self.walls[wall];
        match packed.ends {
            None => packed.nearest(at),
            Some(_) => self.walk(wall, atom, at).1,
        }
    }

    /// The piece of a line that is nearest to an atom, if the atom was near to this piece. Another contact does not
    /// begin there. For other walls it is the wall itself.
    pub fn piece_now(&self, wall: usize, atom: usize) -> usize {
        if self.walls[wall].line.is_none() { wall } else { self.walk(wall, atom, self.atom_place(atom)).0 }
    }

    /// The wall that represents all pieces of a line. For other walls it is the wall itself.
    #[inline]
    pub fn whole_wall(&self, wall: usize) -> usize {
        if self.lines.is_empty() {
            return wall;
        }
        match self.walls[wall].line {
            None => wall,
            Some(line) => self.lines[line as usize].first as usize,
        }
    }

    /// The number of walls, each line counted once.
    pub fn wall_count(&self) -> usize {
        let pieces: u32 = self.lines.iter().map(|line| line.count).sum();
        self.walls.len() + self.lines.len() - pieces as usize
    }

    /// The places of walls that are no pieces of lines, in order.
    pub fn single_walls(&self) -> impl Iterator<Item = usize> + '_ {
        let begins = std::iter::once(0).chain(self.lines.iter().map(|line| line.pieces().end));
        let ends = self.lines.iter().map(|line| line.first as usize).chain(std::iter::once(self.walls.len()));
        begins.zip(ends).flat_map(|(begin, end)| begin..end)
    }

    fn probe(&self, atom: usize, at: DVec2) -> Probe {
        Probe { at, radius: self.atom_radius[atom], size: self.size_of_atom(atom) }
    }

    #[cold]
    #[inline(never)]
    fn walk(&self, wall: usize, atom: usize, at: DVec2) -> (usize, NearestPoint) {
        let Some(line) = self.walls[wall].line.map(|line| &self.lines[line as usize]) else {
            return (wall, self.walls[wall].nearest(at));
        };
        let first = line.first as usize;
        let (piece, found) = line.walk(&self.walls, wall - first, self.probe(atom, at));
        (first + piece, found)
    }

    /// Gives the local minima of the distance from a line to an atom that are nearer than `margin` metres. It gives the
    /// walls in which they lie, with the height of the atom. A point behind a line counts if it was `known`. It also
    /// counts if its depth is below the share `behind` of half the width of the atom's owner.
    pub(crate) fn each_place_on_line(
        &self,
        line: &PackedLine,
        (atom, margin, behind): (usize, f64, f64),
        known: impl Fn(usize) -> bool,
        mut see: impl FnMut(usize, f64),
    ) {
        let probe = self.probe(atom, self.atom_place(atom));
        let first = line.first as usize;
        // The depth behind the line is at most the size of the atom's owner.
        line.each_near(probe.at, probe.radius.max(probe.size) + margin, &mut |piece| {
            let Some(found) = line.home(&self.walls, piece, probe) else { return };
            let half = half(&self.walls[first + piece]);
            let seen = found.height + half > -behind * probe.size || known(first + piece);
            if seen && found.height < probe.radius + margin {
                see(first + piece, found.height);
            }
        });
    }

    /// The distance in m of a point from the middle of a line. It is negative if the point lies behind the nearest
    /// piece.
    pub(crate) fn height_over_line(&self, line: &PackedLine, at: DVec2) -> f64 {
        let mut nearest = (f64::INFINITY, 0.0_f64);
        for wall in &self.walls[line.pieces()] {
            let from = at - wall.point;
            let (back, height) = (from.dot(wall.normal.perp()), from.dot(wall.normal));
            let square = (back - back.clamp(0.0, length(wall))).powi(2) + height * height;
            // At a joint two pieces are as near: the one that is seen more from the front counts.
            let alike = (square - nearest.0).abs() <= 1e-12 * square;
            if !alike && square < nearest.0 || alike && height.abs() > nearest.1.abs() {
                nearest = (square, height);
            }
        }
        nearest.0.sqrt().copysign(nearest.1)
    }

    /// Whether a place in m lies behind a line: behind the piece that is nearest.
    pub(crate) fn is_behind_line(&self, line: &PackedLine, at: DVec2) -> bool {
        self.height_over_line(line, at) < 0.0
    }

    /// Gives the ends and joints of a line within `reach` metres of a point that may touch sides of hulls. They are
    /// numbers of ends of walls.
    pub(crate) fn each_edge_of_line(&self, line: &PackedLine, at: DVec2, reach: f64, mut see: impl FnMut(u32)) {
        line.each_near(at, reach, &mut |piece| {
            let wall = line.first + piece as u32;
            if line.sticks_out[piece + 1] {
                see(2 * wall);
            }
            if line.joints[piece].is_none() {
                see(2 * wall + 1);
            }
        });
    }
}
