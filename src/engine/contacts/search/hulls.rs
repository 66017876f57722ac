//! Probes near hulls: corners and discs of other bodies, and ends of walls. Circles about hulls and discs are sorted into cells
//! ([`super::cells`]).

use bevy_ecs::world::World;
use glam::DVec2;
use jostle_shapes::may_be_nearer;

use super::cells::{Entry, Sorted};
use super::{SurfacePair, ordered};
use crate::scene::SceneError;
use crate::tick::{LoadErrors, Notes, State};
use crate::world::hull::ROUNDING;
use crate::world::{Bodies, Name, PackedHull, PackedWall};

/// Notes on the card that sharp corners are rounded off in contacts with sharp shapes, or with strips without
/// thickness. The note appears if such contacts are possible.
pub(super) fn note_sharp(world: &mut World) {
    let bodies = world.resource::<State>().bodies();
    let sharp = |body: usize| bodies.collides[body] && bodies.hulls_of(body).any(|hull| hull.rounded.is_some());
    let among: Vec<usize> = (0..bodies.len()).filter(|&body| sharp(body)).collect();
    let is_thin = bodies.walls.iter().any(PackedWall::is_thin);
    let meets = match (among.len() > 1, is_thin) {
        (true, false) => "if two sharp shapes meet, their corners are",
        (false, true) => "if a sharp shape meets a strip without thickness, its corners are",
        (true, true) => "if two sharp shapes meet, or one meets a strip without thickness, their corners are",
        (false, false) => return,
    };
    if among.iter().any(|&body| bodies.dynamic[body]) {
        let percent = 100.0 * ROUNDING;
        world.resource_mut::<Notes>().0.push(format!(
            "{meets} round, with {percent} % of half their width. Give shapes a `rounding` to choose another"
        ));
    }
}

/// Refuses sharp corners that cannot be rounded off beside strips without thickness: they would pass through.
pub(super) fn refuse_pointed(world: &mut World) {
    let bodies = world.resource::<State>().bodies();
    let Some(thin) = bodies.walls.iter().find(|wall| wall.is_thin()) else { return };
    let is_pointed = |atom: usize| {
        bodies.is_corner(atom)
            && bodies.probes(atom)
            && bodies.atom_radius[atom] == 0.0
            && bodies.round_corner(atom).is_none()
    };
    let mut moving = (0..bodies.len()).filter(|&body| bodies.dynamic[body] && bodies.collides[body]);
    let Some(body) = moving.find(|&body| bodies.atoms_of(body).any(is_pointed)) else { return };
    let name = |entity| world.get::<Name>(entity).map_or_else(|| "(unnamed)".to_owned(), Name::to_string);
    let (body, wall) = (name(bodies.entity[body]), name(thin.entity));
    let message =
        format!("`{body}` has sharp corners, and `{wall}` has no thickness: they would pass through each other");
    let help =
        format!("give `{wall}` a `thickness`, or `sides: Left` or `Right`. Or give the parts of `{body}` a `rounding`");
    let error = SceneError::new("bodies", message).with_help(help);
    world.get_resource_or_init::<LoadErrors>().0.push(error);
}

/// The bound of checks over the greatest number of candidate pairs. A check is of two hulls, or of a hull and a disc.
const LOOKS: usize = 8;

/// A hull as the search sees it, with half of the margin around it.
fn entry(bodies: &Bodies, margin: f64, packed: &PackedHull) -> Entry {
    let (middle, radius) = packed.circle;
    let spread = packed.rounded.as_ref().map_or(0.0, |rounded| rounded.spread);
    Entry {
        center: bodies.pose_with_hulls(packed.body as usize).point_to_world(middle),
        reach: radius + spread + margin / 2.0,
        atom: packed.first_atom,
        body: packed.body,
    }
}

/// For each atom that is a disc, or the first corner of a hull, its near neighbours.
struct Neighbours {
    /// The index of the first neighbour of each atom, and the total number at the end.
    first: Vec<u32>,
    /// The neighbours of each atom, in order.
    others: Vec<u32>,
    /// Whether these are all.
    complete: bool,
}

impl Neighbours {
    /// From pairs in order. `most` bounds the candidate pairs of each hull and disc.
    fn of(bodies: &Bodies, margin: f64, apart: &[(usize, usize)], most: usize) -> Self {
        let most = most.saturating_mul(LOOKS);
        let discs = (0..bodies.atom_count()).filter(|&atom| !bodies.is_corner(atom) && bodies.probes(atom));
        let discs = discs.map(|atom| Entry::atom(bodies, margin, atom));
        let hulls = bodies.hulls.iter().map(|packed| entry(bodies, margin, packed));
        let mut pairs = Sorted::entries(bodies, hulls.chain(discs)).pairs(bodies, most);
        let complete = pairs.len() <= most;
        if !apart.is_empty() {
            let body = |atom: u32| bodies.atom_body(atom as usize);
            pairs.retain(|pair| apart.binary_search(&ordered(body(pair.a), body(pair.b))).is_err());
        }
        let mut first = vec![0; bodies.atom_count() + 2];
        // Two places ahead, so that filling in leaves each where its atom begins.
        pairs.iter().flat_map(|pair| [pair.a, pair.b]).for_each(|atom| first[atom as usize + 2] += 1);
        for atom in 2..first.len() {
            first[atom] += first[atom - 1];
        }
        let mut others = vec![0; 2 * pairs.len()];
        // Neighbours before an atom come first, because pairs are in order.
        for pair in &pairs {
            for (atom, other) in [(pair.a, pair.b), (pair.b, pair.a)] {
                let next = &mut first[atom as usize + 1];
                others[*next as usize] = other;
                *next += 1;
            }
        }
        Self { first, others, complete }
    }

    fn of_hull(&self, packed: &PackedHull) -> &[u32] {
        let atom = packed.first_atom as usize;
        &self.others[self.first[atom] as usize..self.first[atom + 1] as usize]
    }
}

/// Shows the hulls of different bodies whose circles overlap, each pair once.
pub(super) fn each_pair_of_hulls(
    bodies: &Bodies,
    apart: &[(usize, usize)],
    most: usize,
    mut see: impl FnMut(usize, usize),
) {
    if bodies.hulls.is_empty() {
        return;
    }
    let near = Neighbours::of(bodies, 0.0, apart, most);
    for (index, packed) in bodies.hulls.iter().enumerate() {
        let others = near.of_hull(packed).iter().filter_map(|&other| bodies.hull_of(other as usize));
        others.filter(|other| *other > index).for_each(|other| see(index, other));
    }
}

/// Gives the probes that are nearer to hulls than the margin, and few others. The order is hull by hull, and then that
/// of the probes. Bodies `apart` do not touch each other. Returns whether these are all; if not, there are more than
/// `most` pairs.
pub(super) fn each_pair(
    bodies: &Bodies,
    margin: f64,
    (apart, most): (&[(usize, usize)], usize),
    mut see: impl FnMut(SurfacePair),
) -> bool {
    if bodies.hulls.is_empty() {
        return true;
    }
    let near = Neighbours::of(bodies, margin, apart, most);
    let ends: Vec<(u32, DVec2, f64)> = bodies
        .single_walls()
        .filter(|&wall| bodies.walls[wall].ends.is_some())
        .flat_map(|wall| [false, true].map(|right| (2 * wall as u32 + u32::from(right), bodies.walls[wall].end(right))))
        .map(|(number, (center, half))| (number, center, half))
        .collect();
    let (walls, ends_from) = (bodies.walls.len() as u32, bodies.atom_count() as u32);
    for (index, packed) in bodies.hulls.iter().enumerate() {
        let body = packed.body as usize;
        if !bodies.collides[body] {
            continue;
        }
        let surface = walls + index as u32;
        let pose = bodies.pose_with_hulls(body);
        let (center, circle) = (pose.point_to_world(packed.circle.0), packed.circle.1 + margin);
        let is_near = |at: DVec2, reach: f64| {
            let apart = packed.hull.radius() + margin + reach;
            !is_far(center, at, circle + reach) && may_be_nearer(&packed.hull, pose.point_to_local(at), apart)
        };
        for &other in near.of_hull(packed) {
            let other = other as usize;
            let atoms = bodies.hull_of(other).map_or(other..other + 1, |hull| bodies.hulls[hull].corners());
            for atom in atoms.filter(|&atom| bodies.probes(atom)) {
                if is_near(bodies.atom_place(atom), bodies.atom_radius[atom] + bodies.spread(index, atom)) {
                    see(SurfacePair::new(surface, atom as u32));
                }
            }
        }
        let mut near_ends = |(number, end, half): (u32, DVec2, f64)| {
            if is_near(end, half) {
                see(SurfacePair::new(surface, ends_from + number));
            }
        };
        if bodies.dynamic[body] {
            ends.iter().copied().for_each(&mut near_ends);
            for line in &bodies.lines {
                bodies.each_edge_of_line(line, bodies.position[body], packed.extent + margin, |number| {
                    let (end, half) = bodies.walls[number as usize / 2].end(number % 2 == 1);
                    near_ends((number, end, half));
                });
            }
        }
    }
    near.complete
}

/// Whether two places are farther apart than so many metres.
fn is_far(one: DVec2, other: DVec2, distance: f64) -> bool {
    one.distance_squared(other) > distance * distance
}
