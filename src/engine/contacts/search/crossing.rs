//! Atoms that pass through walls with ends, and corners that pass through hulls: the run ends, with both names.
//!
//! Such a wall is open on both sides, so an atom whose centre has passed the middle line would be pushed out on the other side. So would
//! one that has passed the middle line of a capsule, or lies in a hull deeper than half its width. Soft contacts let that happen, and
//! ticks in which a small atom goes farther than it is wide. A film would not show it.
//!
//! A line pushes what is behind it back to its open side. That ends where the centre of a disc, or a corner, lies so deep that it may have
//! come from elsewhere.

use bevy_ecs::world::World;
use glam::DVec2;
use jostle_shapes::{Feature, Hull, Pose, nearest};
use serde::{Deserialize, Serialize};

use crate::contacts::{Probe, Surface, SurfacePair};
use crate::tick::snapshot::{Memory, Unfit, recall};
use crate::tick::{Dependence, Energies, Model, State, SteadySpring, Wrong};
use crate::world::Bodies;

/// So deep a probe lies at the most, as a share of half the width of a hull: the side that is nearest is the one it came through. So deep
/// lies the centre of what is behind a line, as a share of half its own width.
const DEEPEST: f64 = 0.9;

/// What was where at the beginning of the present step.
#[derive(Default, Serialize, Deserialize)]
struct Crossings {
    /// Places of atoms in m, where there are walls with ends.
    before: Vec<DVec2>,
    /// Probes near hulls, and their places in the frames of those in m.
    near: Vec<(SurfacePair, DVec2)>,
}

/// Watches for what passes through walls with ends and hulls, if the scene has some.
pub(super) fn watch(world: &mut World) {
    let mut state = world.resource_mut::<State>();
    if has_ends(state.bodies()) || !state.bodies().hulls.is_empty() {
        state.add_model(Crossings::default());
    }
}

/// Moves nothing.
impl Model for Crossings {
    fn save(&self) -> Memory {
        Memory::of(self)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), Unfit> {
        *self = recall(bytes)?;
        Ok(())
    }

    fn dependence(&self) -> Dependence {
        Dependence::Nothing
    }

    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn has_modes(&self) -> bool {
        true
    }

    /// Between ticks others may have put bodies elsewhere.
    fn begin_step(&mut self, state: &mut State) {
        if state.span.begin > state.clock.time() {
            self.look(state);
        }
        let State { bodies, pairs: Some(pairs), .. } = state else { return };
        self.before.clear();
        if has_ends(bodies) {
            self.before.extend((0..bodies.atom_count()).map(|atom| bodies.atom_place(atom)));
        }
        self.near.clear();
        if !bodies.hulls.is_empty() {
            let near = pairs.surfaces.iter().filter_map(|pair| Some((*pair, place_at_hull(*pair, bodies)?.1)));
            self.near.extend(near);
        }
    }

    fn looks_at_ticks(&self) -> bool {
        true
    }

    fn end_tick(&mut self, state: &mut State) {
        self.look(state);
    }
}

impl Crossings {
    fn look(&self, state: &mut State) {
        if let Some((body, wall)) = self.first(&state.bodies) {
            state.end_run(body, Wrong::Crossed(state.bodies.walls[wall].entity));
        }
        let State { bodies, pairs: Some(pairs), .. } = &*state else { return };
        if bodies.hulls.is_empty() && bodies.lines.is_empty() {
            return;
        }
        let deep = pairs.surfaces.iter().copied().find(|pair| is_deep(*pair, bodies));
        let through = self.near.iter().find(|(pair, before)| has_crossed(*pair, *before, bodies));
        if let Some(pair) = deep.or(through.map(|(pair, _)| *pair)) {
            let (a, b) = pair.bodies(bodies);
            let other =
                a.map_or_else(|| pair.wall(bodies).map(|wall| bodies.walls[wall].entity), |a| Some(bodies.entity[a]));
            if let Some(other) = other {
                state.end_run(b, Wrong::Crossed(other));
            }
        }
    }

    /// The first body with an atom that has crossed a wall since, and the index of the wall.
    fn first(&self, bodies: &Bodies) -> Option<(usize, usize)> {
        let moves = |body: &usize| bodies.dynamic[*body] && bodies.collides[*body];
        let atoms =
            (0..bodies.len()).filter(moves).flat_map(|body| bodies.atoms_of(body).map(move |atom| (body, atom)));
        for (body, atom) in atoms {
            let (Some(&before), now) = (self.before.get(atom), bodies.atom_place(atom)) else { continue };
            let strip = bodies.single_walls().find(|wall| bodies.walls[*wall].is_crossed(before, now));
            if let Some(wall) = strip.or_else(|| crossed_line(bodies, atom, before, now)) {
                return Some((body, wall));
            }
        }
        None
    }
}

fn has_ends(bodies: &Bodies) -> bool {
    bodies.walls.iter().any(|wall| wall.ends.is_some())
}

/// Where a probe is, in m.
fn place(pair: SurfacePair, bodies: &Bodies) -> DVec2 {
    match pair.probe(bodies) {
        Probe::Atom(atom) => bodies.atom_place(atom),
        Probe::End(wall, right) => bodies.walls[wall].end(right).0,
    }
}

/// The hull that a probe is near to, and the place of the probe in its frame, in m.
fn place_at_hull(pair: SurfacePair, bodies: &Bodies) -> Option<(&Hull, DVec2)> {
    let Surface::Hull(hull) = pair.surface(bodies) else { return None };
    let packed = &bodies.hulls[hull];
    let body = packed.body as usize;
    let pose = Pose::new(bodies.position[body], bodies.angle[body]);
    Some((&packed.hull, pose.point_to_local(place(pair, bodies))))
}

/// Whether a probe has passed the middle line of a capsule since, or has gone through a polygon.
fn has_crossed(pair: SurfacePair, before: DVec2, bodies: &Bodies) -> bool {
    let Some((hull, now)) = place_at_hull(pair, bodies) else { return false };
    let &[from, to] = hull.corners() else { return has_gone_through(hull, before, now) };
    let along = to - from;
    let heights = [before, now].map(|at| along.perp_dot(at - from));
    if (heights[0] < 0.0) == (heights[1] < 0.0) {
        return false;
    }
    let crossing = before + (now - before) * (heights[0] / (heights[0] - heights[1]));
    (0.0..=along.length_squared()).contains(&(crossing - from).dot(along))
}

/// Whether the way from one place to another enters a polygon and leaves it, and is deep in it between (Cyrus and Beck 1978). A part of a
/// concave one may be left by a cut, so the depth at both ends counts too.
fn has_gone_through(hull: &Hull, before: DVec2, now: DVec2) -> bool {
    let (mut enters, mut leaves) = (f64::NEG_INFINITY, f64::INFINITY);
    for (side, corner) in hull.sides().iter().zip(hull.corners()) {
        let [first, last] = [before, now].map(|at| side.normal.dot(at - *corner));
        if first == last {
            if first > 0.0 {
                return false;
            }
            continue;
        }
        let crosses = first / (first - last);
        if first > last { enters = enters.max(crosses) } else { leaves = leaves.min(crosses) }
    }
    if !(0.0 < enters && enters < leaves && leaves < 1.0) {
        return false;
    }
    let is_deep = |share: f64| {
        let near = nearest(hull, before + (now - before) * share);
        -near.distance > 0.5 * (half_width_at(hull, near.feature) - hull.radius())
    };
    [enters, 0.5 * (enters + leaves), leaves].into_iter().any(is_deep)
}

/// Whether the centre of an atom is deeper behind a line than half the width of what it belongs to.
fn is_behind(bodies: &Bodies, wall: usize, atom: usize) -> bool {
    let half = bodies.walls[wall].ends.map_or(0.0, |ends| ends.half);
    let found = bodies.nearest_on_wall(wall, atom, bodies.atom_place(atom));
    found.height + half < -DEEPEST * bodies.size_of_atom(atom)
}

/// The piece of a line through which an atom went straight from one place to another, if it is now farther from it than half the width of
/// what it belongs to; or from behind, if it has a radius.
fn crossed_line(bodies: &Bodies, atom: usize, before: DVec2, now: DVec2) -> Option<usize> {
    let (middle, reach) = (0.5 * (before + now), 0.5 * before.distance(now));
    let mut crossed = None;
    for line in &bodies.lines {
        line.each_near(middle, reach, &mut |piece| {
            let wall = line.first as usize + piece;
            let packed = &bodies.walls[wall];
            let height = |at: DVec2| (at - packed.point).dot(packed.normal);
            let from_behind = height(before) < 0.0 && bodies.atom_radius[atom] > 0.0;
            let is_deep = height(now) < -DEEPEST * bodies.size_of_atom(atom);
            if crossed.is_none() && (from_behind || is_deep) && packed.is_crossed(before, now) {
                crossed = Some(wall);
            }
        });
    }
    crossed
}

/// Whether a probe lies in a polygon deeper than half its width, or as deep behind a line.
fn is_deep(pair: SurfacePair, bodies: &Bodies) -> bool {
    if let (Surface::Wall(wall), Probe::Atom(atom)) = (pair.surface(bodies), pair.probe(bodies)) {
        return bodies.walls[wall].line.is_some() && is_behind(bodies, wall, atom);
    }
    let Some((hull, at)) = place_at_hull(pair, bodies) else { return false };
    let near = nearest(hull, at);
    hull.corners().len() > 2 && near.distance < hull.radius() - half_width_at(hull, near.feature) * DEEPEST
}

/// Half the width in m of a polygon at a place of it: that of a concave one behind the side that is nearest.
fn half_width_at(hull: &Hull, feature: Feature) -> f64 {
    let thickness = match feature {
        Feature::OutlineSide(side) => hull.thickness(side),
        Feature::OutlineCorner(corner) => {
            let before = (corner + hull.outline().len() - 1) % hull.outline().len();
            hull.thickness(corner).min(hull.thickness(before))
        }
        Feature::Side(_) | Feature::Corner(_) => return hull.half_width(),
    };
    0.5 * thickness + hull.radius()
}
