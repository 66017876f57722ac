//! Tunnelling: atoms that pass through walls with ends, and corners that pass through hulls. The run ends, with both
//! names.
//!
//! Such a wall is open on both sides. So it would push out an atom on the other side if its centre has passed the middle line.
//! The same holds for the middle line of a capsule, and for half the width of a hull. Soft contacts allow that. So do ticks in
//! which a small atom goes farther than its width. A film would not show it.
//!
//! A line pushes atoms behind it back to its open side. That ends if the centre of a disc, or a corner, may have come
//! from elsewhere because of its depth.
//!
//! Two sharp hulls meet in rounded form. If the core of a corner has entered the other core, the nearest side need not
//! be its entry. The run ends if a contact would thus change from one side to another.
//!
//! Bodies that sleep stand where the last look found them. No look returns to them until they wake.

use bevy_ecs::entity::Entity;
use bevy_ecs::world::World;
use glam::DVec2;
use jostle_shapes::{Feature, Hull, Nearest, Pose, nearest};
use serde::{Deserialize, Serialize};

use super::clearance::Clearances;
use super::slept::{Slept, pair_sleeps};
use crate::contacts::{Probe, Surface, SurfacePair};
use crate::tick::snapshot::{Memory, UnfitSnapshot, demand, recall};
use crate::tick::{Dependence, Energies, FailureKind, Model, State, SteadySpring};
use crate::world::{Bodies, PackedHull};

/// A probe that passes through a hull reaches this share of half its width.
const THROUGH: f64 = 0.5;

/// The greatest depth, as a share of half the hull's width, at which a probe's nearest side is its entry. It is also the greatest
/// depth of a centre behind a line, as a share of half its owner's width.
const DEEPEST: f64 = 0.9;

/// The positions at the beginning of the current step.
#[derive(Default, Serialize, Deserialize)]
struct Crossings {
    /// Positions of atoms in m, if there are walls with ends.
    before: Vec<DVec2>,
    /// The same for strips without thickness, if there are shapes with sides.
    before_round: Vec<DVec2>,
    /// Probes near hulls and lines, of the lists of this version.
    near: Vec<Watched>,
    /// Each stays outside up to this [`Crossings::path`]; infinite while both bodies sleep.
    until: Vec<f64>,
    version: u64,
    /// The generation of the bodies at which those lists were made.
    generation: u64,
    /// Places in m and angles in rad of all bodies when they were last looked at.
    seen: Vec<(DVec2, f64)>,
    /// The bodies asleep then.
    slept: Slept,
    /// The bodies asleep at the beginning of the last step.
    slept_before: Slept,
    /// The sum of the greatest ways in m between those looks.
    path: f64,
    /// They are found again in a run that goes on from a snapshot.
    #[serde(skip)]
    clearances: Clearances,
}

/// A probe near a hull or a line, at its last check.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Watched {
    pair: SurfacePair,
    /// Its position in the frame of the hull, in m.
    place: DVec2,
    /// For a sharp corner near a sharp hull, in the forms in which they meet. It holds the normal of the side and the
    /// corner's position, in that frame.
    touched: Option<(DVec2, DVec2)>,
    /// The way in m, relative to the hull, that it has to go before it needs a check.
    left: f64,
}

/// Watches walls with ends and hulls, if the scene has some, for atoms that pass through.
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

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        *self = recall(bytes)?;
        Ok(())
    }

    fn fits(&self, state: &State) -> Result<(), UnfitSnapshot> {
        let Self { before, before_round, near, until, seen, slept, slept_before, .. } = self;
        let bodies = state.bodies();
        let whole = |len: usize, of: usize| len == 0 || len == of;
        let known = near.iter().all(|watched| watched.pair.is_among(bodies));
        let atoms = bodies.atom_count();
        let lengths = near.len() == until.len() && whole(before.len(), atoms) && whole(before_round.len(), atoms);
        let told = whole(seen.len(), bodies.len()) && slept.fits(bodies) && slept_before.fits(bodies);
        demand(known && lengths && told, "the probes watched near hulls and lines")
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

    fn begins_with_velocities(&self) -> bool {
        false
    }

    /// Between ticks others may have put bodies elsewhere.
    fn begin_step(&mut self, state: &mut State) {
        if state.span.begin > state.clock.time() {
            self.look(state);
        }
        let State { bodies, pairs: Some(pairs), .. } = state else { return };
        self.follow(bodies, self.way(bodies));
        let Self { before, before_round, slept_before, .. } = &mut *self;
        if has_ends(bodies) {
            note(before, slept_before, bodies, |atom| bodies.atom_place(atom));
        } else {
            before.clear();
        }
        if let Some(thin) = bodies.walls.iter().find(|wall| wall.is_thin() && !bodies.hulls.is_empty()) {
            note(before_round, slept_before, bodies, |atom| bodies.meeting_wall(thin, atom).0);
        } else {
            before_round.clear();
        }
        slept_before.note(bodies);
        if self.version != pairs.version {
            self.version = pairs.version;
            self.take_up(&pairs.surfaces, bodies);
        }
        let path = self.path;
        for (until, watched) in self.until.iter_mut().zip(&mut self.near).filter(|(until, _)| **until <= path) {
            (*watched, *until) = Watched::at(watched.pair, bodies, path).unwrap_or((*watched, *until));
            if pair_sleeps(watched.pair.bodies(bodies), bodies) {
                *until = f64::INFINITY;
            }
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
    fn look(&mut self, state: &mut State) {
        if self.slept.all_on(&state.bodies) {
            return;
        }
        let way = self.way(&state.bodies);
        if let Some((body, wrong)) = self.first(&state.bodies, self.path + way) {
            state.end_run(body, wrong);
        }
        let bodies = &state.bodies;
        if bodies.hulls.is_empty() && bodies.lines.is_empty() {
            return self.follow(bodies, way);
        }
        let margin = state.bounds.as_ref().map_or(f64::INFINITY, |bounds| bounds.margin);
        if let Some((body, hull)) = self.passed_unlisted(bodies, margin, way) {
            let other = bodies.entity[bodies.hulls[hull].body as usize];
            state.end_run(body, FailureKind::Crossed(other));
        }
        let bodies = &state.bodies;
        self.follow(bodies, way);
        let path = self.path;
        let mut due = self.until.iter_mut().zip(&self.near).filter(|(until, _)| **until <= path);
        let wrong = due.find_map(|(until, watched)| {
            let left = watched.left_now(bodies);
            // A probe that has gone farther is due when the next step begins.
            if left > 0.5 * watched.left {
                let sleeps = pair_sleeps(watched.pair.bodies(bodies), bodies);
                *until = if sleeps { f64::INFINITY } else { path + 0.5 * left };
            }
            if left > 0.0 { None } else { Some((watched.pair, watched.wrong(bodies)?)) }
        });
        if let Some((pair, wrong)) = wrong {
            let (a, b) = pair.bodies(bodies);
            let other =
                a.map_or_else(|| pair.wall(bodies).map(|wall| bodies.walls[wall].entity), |a| Some(bodies.entity[a]));
            if let Some(other) = other {
                state.end_run(b, wrong(other));
            }
        }
    }

    /// A body with an atom that went straight through a hull, and that hull. It serves steps in which bodies went
    /// farther than lists of pairs reach.
    #[cold]
    fn through_any_hull(&self, bodies: &Bodies) -> Option<(usize, usize)> {
        let pose = |body: usize| Pose::new(self.seen[body].0, self.seen[body].1);
        let touches = |body: usize| bodies.collides[body];
        let went = |body: usize| self.seen[body] != (bodies.position[body], bodies.angle[body]);
        for (index, packed) in bodies.hulls.iter().enumerate().filter(|(_, packed)| touches(packed.body as usize)) {
            let own = packed.body as usize;
            let (began, ends) = (pose(own), bodies.pose_with_hulls(own));
            let others =
                (0..self.seen.len()).filter(|other| *other != own && touches(*other) && (went(*other) || went(own)));
            for (body, atom) in others.flat_map(|body| bodies.atoms_of(body).map(move |atom| (body, atom))) {
                let offset = bodies.atom_offset(atom);
                let before = began.point_to_local(pose(body).point_to_world(offset));
                let now = ends.point_to_local(bodies.atom_place(atom));
                if has_passed(packed, before, now) {
                    return Some((body, index));
                }
            }
        }
        None
    }

    fn passed_unlisted(&self, bodies: &Bodies, margin: f64, way: f64) -> Option<(usize, usize)> {
        let far = self.seen.len() == bodies.len() && way > 0.5 * margin;
        if far { self.through_any_hull(bodies) } else { None }
    }

    /// The greatest way in m of any point of a body since the last check.
    fn way(&self, bodies: &Bodies) -> f64 {
        let farther = |greatest: f64, (body, (place, turned)): (usize, &(DVec2, f64))| {
            let (moved, turn) =
                (bodies.position[body] - place, (bodies.angle[body] - turned).abs() * bodies.extent(body));
            // No way is longer than along both axes: roots only of those that may be the longest so far.
            let bound = moved.x.abs() + moved.y.abs() + turn;
            if bound > greatest { greatest.max(moved.length() + turn) } else { greatest }
        };
        let known = self.slept.others(bodies).filter_map(|body| Some((body, self.seen.get(body)?)));
        known.fold(0.0, farther)
    }

    /// Watches the pairs of a new list. Those that were in the old one are looked at when they are due.
    fn take_up(&mut self, pairs: &[SurfacePair], bodies: &Bodies) {
        // Places on lines move on to other pieces, and other bodies have other names.
        let goes_on = bodies.lines.is_empty() && self.generation == bodies.generation;
        self.generation = bodies.generation;
        let known = std::mem::take(&mut self.near).into_iter().zip(std::mem::take(&mut self.until));
        let mut known = known.filter(|_| goes_on).peekable();
        for &pair in pairs {
            while known.next_if(|(old, _)| old.pair.names() < pair.names()).is_some() {}
            let same = known.next_if(|(old, _)| old.pair.names() == pair.names());
            if let Some((watched, until)) = same.or_else(|| Watched::at(pair, bodies, self.path)) {
                self.near.push(Watched { pair, ..watched });
                self.until.push(until);
            }
        }
    }

    /// Adds the greatest way in m of any point of a body since the last check.
    fn follow(&mut self, bodies: &Bodies, way: f64) {
        self.path += way;
        if self.slept.roused(bodies) {
            self.until.iter_mut().filter(|until| **until == f64::INFINITY).for_each(|until| *until = self.path);
        }
        self.seen.resize(bodies.len(), Default::default());
        let see = |body: usize| self.seen[body] = (bodies.position[body], bodies.angle[body]);
        self.slept.others(bodies).for_each(see);
        self.slept.note(bodies);
    }

    /// Whether an atom was near a line as the step began, or that is unknown. Atoms that come from behind were in no
    /// list before.
    fn knows(&self, bodies: &Bodies, atom: usize, wall: usize) -> bool {
        self.version == 0 || self.near.iter().any(|near| near.is_near_line(bodies, atom, wall))
    }

    /// The first body with an atom that has crossed a wall since, and how.
    /// `path` is the sum of ways at present, in m.
    fn first(&mut self, bodies: &Bodies, path: f64) -> Option<(usize, FailureKind)> {
        // Without walls with ends no places were noted.
        if self.before.is_empty() {
            return None;
        }
        let mut clearances = std::mem::take(&mut self.clearances);
        clearances.keep_of(bodies);
        let found = self.first_of(bodies, &mut clearances, path);
        self.clearances = clearances;
        found
    }

    fn first_of(&self, bodies: &Bodies, clearances: &mut Clearances, path: f64) -> Option<(usize, FailureKind)> {
        let moves = |body: &usize| bodies.dynamic[*body] && bodies.collides[*body];
        let atoms = self
            .slept
            .others(bodies)
            .filter(moves)
            .flat_map(|body| bodies.atoms_of(body).map(move |atom| (body, atom)));
        for (body, atom) in atoms.filter(|(_, atom)| bodies.probes(*atom)) {
            if clearances.hold(atom, path) {
                continue;
            }
            clearances.look(bodies, atom, path);
            let (Some(&before), now) = (self.before.get(atom), bodies.atom_place(atom)) else { continue };
            let is_crossed = |wall: &usize| {
                let wall = &bodies.walls[*wall];
                let round = self.before_round.get(atom).filter(|_| wall.is_thin());
                wall.is_crossed(*round.unwrap_or(&before), bodies.meeting_wall(wall, atom).0)
            };
            if let Some(wall) = bodies.single_walls().find(is_crossed) {
                return Some((body, FailureKind::Crossed(bodies.walls[wall].entity)));
            }
            let crossed = crossed_line(bodies, atom, before, now);
            // A centre is pressed behind a line and comes back: then they were known to be near.
            let is_known = |from_behind: &(usize, bool)| from_behind.1 && self.knows(bodies, atom, from_behind.0);
            if let Some((wall, from_behind)) = crossed.filter(|crossed| !is_known(crossed)) {
                let entity = bodies.walls[wall].entity;
                return Some((
                    body,
                    if from_behind { FailureKind::Behind(entity) } else { FailureKind::Crossed(entity) },
                ));
            }
        }
        None
    }
}

impl Watched {
    /// Whether it is an atom near any piece of the line to which a wall belongs.
    fn is_near_line(&self, bodies: &Bodies, atom: usize, wall: usize) -> bool {
        let near = self.pair.wall(bodies) == Some(bodies.whole_wall(wall));
        near && self.pair.probe(bodies) == Probe::Atom(atom)
    }

    /// With the [`Crossings::path`] up to which it stays outside. `None`: it is near a wall that cannot be crossed in
    /// this way.
    fn at(pair: SurfacePair, bodies: &Bodies, path: f64) -> Option<(Self, f64)> {
        let (place, left) = if let Some((packed, place)) = place_at_hull(pair, bodies) {
            (place, left_to_cross(packed, nearest(&packed.hull, place).distance))
        } else if let (Surface::Wall(wall), Probe::Atom(atom)) = (pair.surface(bodies), pair.probe(bodies)) {
            let half = bodies.walls[wall].line.and(bodies.walls[wall].ends).map_or(0.0, |ends| ends.half);
            bodies.walls[wall].line?;
            let height = bodies.nearest_on_wall(wall, atom, bodies.atom_place(atom)).height;
            (DVec2::ZERO, height + half + DEEPEST * bodies.size_of_atom(atom))
        } else {
            return None;
        };
        let met = met_sharp(pair, bodies);
        // Before the centre of a corner enters the core, the side that it touches is noted.
        let left = met.as_ref().map_or(left, |met| left.min(met.nearest.distance - met.radius)).max(0.0);
        // Both sides may move.
        Some((Self { pair, place, touched: met.map(|met| (met.nearest.normal, met.place)), left }, path + 0.5 * left))
    }

    /// The rest of its way in m, or `None` if that is not known.
    fn left_now(&self, bodies: &Bodies) -> f64 {
        let Some((_, now)) = place_at_hull(self.pair, bodies) else { return 0.0 };
        let moved = now.distance(self.place);
        let met = self.touched.zip(meeting_sharp(self.pair, bodies));
        self.left - met.map_or(moved, |((_, before), (_, place, _))| place.distance(before).max(moved))
    }

    /// The failure that happened to it since.
    fn wrong(&self, bodies: &Bodies) -> Option<fn(Entity) -> FailureKind> {
        if is_deep(self.pair, bodies) || has_crossed(self.pair, self.place, bodies) {
            return Some(FailureKind::Crossed);
        }
        self.touched.is_some_and(|(before, _)| has_jumped(self.pair, before, bodies)).then_some(FailureKind::Sunk)
    }
}

/// Notes the places of all atoms in m. Those of bodies that sleep on are known.
fn note(places: &mut Vec<DVec2>, slept: &Slept, bodies: &Bodies, place: impl Fn(usize) -> DVec2) {
    places.resize(bodies.atom_count(), DVec2::ZERO);
    slept.others(bodies).flat_map(|body| bodies.atoms_of(body)).for_each(|atom| places[atom] = place(atom));
}

fn has_ends(bodies: &Bodies) -> bool {
    bodies.walls.iter().any(|wall| wall.ends.is_some())
}

/// The position of a probe, in m.
fn place(pair: SurfacePair, bodies: &Bodies) -> DVec2 {
    match pair.probe(bodies) {
        Probe::Atom(atom) => bodies.atom_place(atom),
        Probe::End(wall, right) => bodies.walls[wall].end(right).0,
    }
}

/// The hull that a probe is near to, and the place of the probe in its frame, in m.
fn place_at_hull(pair: SurfacePair, bodies: &Bodies) -> Option<(&PackedHull, DVec2)> {
    let Surface::Hull(hull) = pair.surface(bodies) else { return None };
    let packed = &bodies.hulls[hull];
    let pose = bodies.pose_with_hulls(packed.body as usize);
    Some((packed, pose.point_to_local(place(pair, bodies))))
}

/// A sharp corner near a sharp hull, both rounded off.
struct Met {
    /// The nearest place of the hull.
    nearest: Nearest,
    /// The position of the centre of the corner in the frame of the hull, in m.
    place: DVec2,
    /// Of the corner, in m.
    radius: f64,
}

/// The form in which a sharp hull meets a sharp corner. Then the corner's position in its frame and its radius, in m.
fn meeting_sharp(pair: SurfacePair, bodies: &Bodies) -> Option<(&Hull, DVec2, f64)> {
    let (Surface::Hull(hull), Probe::Atom(atom)) = (pair.surface(bodies), pair.probe(bodies)) else { return None };
    let (shape, place, radius) = bodies.meeting(hull, atom);
    if bodies.hulls[hull].rounded.is_none() || radius == bodies.atom_radius[atom] {
        return None;
    }
    Some((shape, bodies.pose_with_hulls(bodies.hulls[hull].body as usize).point_to_local(place), radius))
}

fn met_sharp(pair: SurfacePair, bodies: &Bodies) -> Option<Met> {
    let (shape, place, radius) = meeting_sharp(pair, bodies)?;
    Some(Met { nearest: nearest(shape, place), place, radius })
}

/// The cosine of the greatest angle between two sides that may hand over a corner in a hull's core.
const LEAST_COSINE: f64 = 0.7;

/// Whether a corner in the core of a hull touches another side than before.
fn has_jumped(pair: SurfacePair, before: DVec2, bodies: &Bodies) -> bool {
    met_sharp(pair, bodies)
        .is_some_and(|Met { nearest: now, .. }| now.distance < 0.0 && now.normal.dot(before) < LEAST_COSINE)
}

/// Whether a probe has passed the middle line of a capsule since, or has gone through a polygon.
fn has_crossed(pair: SurfacePair, before: DVec2, bodies: &Bodies) -> bool {
    place_at_hull(pair, bodies).is_some_and(|(packed, now)| has_passed(packed, before, now))
}

/// The same for its places in the frame of a hull.
fn has_passed(packed: &PackedHull, before: DVec2, now: DVec2) -> bool {
    let &[from, to] = packed.hull.corners() else {
        return has_turned_over(packed, before, now) || has_gone_through(packed, before, now);
    };
    let along = to - from;
    let heights = [before, now].map(|at| along.perp_dot(at - from));
    if (heights[0] < 0.0) == (heights[1] < 0.0) {
        return false;
    }
    let crossing = before + (now - before) * (heights[0] / (heights[0] - heights[1]));
    (0.0..=along.length_squared()).contains(&(crossing - from).dot(along))
}

/// Whether a probe in the core of a polygon is nearer to the far side than to its entry.
fn has_turned_over(packed: &PackedHull, before: DVec2, now: DVec2) -> bool {
    let [came, found] = [before, now].map(|at| nearest(&packed.hull, at));
    let owned = packed.hull.owns(&came) && packed.hull.owns(&found);
    owned && came.normal.dot(found.normal) < -LEAST_COSINE && way_in_core(packed, before, now).is_some()
}

/// Clips a segment by the core of a polygon (Cyrus and Beck 1978). Returns both ends as shares of its length.
fn way_in_core(packed: &PackedHull, before: DVec2, now: DVec2) -> Option<(f64, f64)> {
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (side, corner) in packed.hull.sides().iter().zip(packed.hull.corners()) {
        let [first, last] = [before, now].map(|at| side.normal.dot(at - *corner));
        if first > 0.0 && last >= first {
            return None;
        }
        let crosses = first / (first - last);
        if first > last {
            enters = enters.max(crosses);
        } else if last > first {
            leaves = leaves.min(crosses);
        }
    }
    (enters < leaves).then_some((enters, leaves))
}

/// The least way in m after which a probe is deep in a hull or through it, from this distance.
fn left_to_cross(packed: &PackedHull, distance: f64) -> f64 {
    if packed.hull.corners().len() == 2 {
        return distance;
    }
    let core = packed.half_width - packed.hull.radius();
    distance + (THROUGH * core).min(DEEPEST * packed.half_width - packed.hull.radius())
}

/// Whether the way from one place to another enters a polygon and leaves it, and is deep in it between. A part of a concave one may be left by
/// a cut, so the depth at both ends counts too.
fn has_gone_through(packed: &PackedHull, before: DVec2, now: DVec2) -> bool {
    let hull = &packed.hull;
    let Some((enters, leaves)) =
        way_in_core(packed, before, now).filter(|(enters, leaves)| *enters > 0.0 && *leaves < 1.0)
    else {
        return false;
    };
    let is_deep = |share: f64| {
        let near = nearest(hull, before + (now - before) * share);
        -near.distance > THROUGH * (half_width_at(packed, near.feature) - hull.radius())
    };
    [enters, 0.5 * (enters + leaves), leaves].into_iter().any(is_deep)
}

/// Whether the centre of an atom is deeper behind a line than half the width of its owner.
fn is_behind(bodies: &Bodies, wall: usize, atom: usize) -> bool {
    let half = bodies.walls[wall].ends.map_or(0.0, |ends| ends.half);
    let found = bodies.nearest_on_wall(wall, atom, bodies.atom_place(atom));
    found.height + half < -DEEPEST * bodies.size_of_atom(atom)
}

/// The piece of a line that an atom crossed on a straight way between two positions. The atom must have come from
/// behind, or be deeper behind it than half the width of its owner. The second value is true if it came from behind.
fn crossed_line(bodies: &Bodies, atom: usize, before: DVec2, now: DVec2) -> Option<(usize, bool)> {
    let (middle, reach) = (0.5 * (before + now), 0.5 * before.distance(now));
    let mut crossed = None;
    for line in &bodies.lines {
        line.each_near(middle, reach, &mut |piece| {
            let wall = line.first as usize + piece;
            let packed = &bodies.walls[wall];
            let height = |at: DVec2| (at - packed.point).dot(packed.normal);
            let from_behind = height(before) < 0.0;
            let is_deep = height(now) < -DEEPEST * bodies.size_of_atom(atom);
            if crossed.is_none() && (from_behind || is_deep) && packed.is_crossed(before, now) {
                crossed = Some((wall, from_behind));
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
    let Some((packed, at)) = place_at_hull(pair, bodies) else { return false };
    let near = nearest(&packed.hull, at);
    let polygon = packed.hull.corners().len() > 2;
    polygon && near.distance < packed.hull.radius() - half_width_at(packed, near.feature) * DEEPEST
}

/// Half the width in m of a polygon at a feature. For a concave polygon it is that behind the nearest side.
fn half_width_at(packed: &PackedHull, feature: Feature) -> f64 {
    let hull = &packed.hull;
    let thickness = match feature {
        Feature::OutlineSide(side) => hull.thickness(side),
        Feature::OutlineCorner(corner) => {
            let before = (corner + hull.outline().len() - 1) % hull.outline().len();
            hull.thickness(corner).min(hull.thickness(before))
        }
        Feature::Side(_) | Feature::Corner(_) => return packed.half_width,
    };
    0.5 * thickness + hull.radius()
}
