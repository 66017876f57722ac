//! Probes near hulls: corners and discs of other bodies, and ends of walls. Boxes of bodies are swept along x.

use bevy_ecs::world::World;
use glam::DVec2;

use super::{SurfacePair, ordered};
use crate::scene::SceneError;
use crate::tick::{LoadErrors, Notes, State};
use crate::world::hull::ROUNDING;
use crate::world::{Bodies, Name, PackedHull, PackedWall};

/// Says on the card that sharp corners are rounded off where they meet sharp shapes, or strips without thickness, if they can.
pub(super) fn note_sharp(world: &mut World) {
    let bodies = world.resource::<State>().bodies();
    let sharp = |body: usize| bodies.collides[body] && bodies.hulls_of(body).any(|hull| hull.rounded.is_some());
    let among: Vec<usize> = (0..bodies.len()).filter(|&body| sharp(body)).collect();
    let is_thin = bodies.walls.iter().any(PackedWall::is_thin);
    let meets = match (among.len() > 1, is_thin) {
        (true, false) => "two sharp shapes meet, their corners are",
        (false, true) => "a sharp shape meets a strip without thickness, its corners are",
        (true, true) => "two sharp shapes meet, or one meets a strip without thickness, corners are",
        (false, false) => return,
    };
    if among.iter().any(|&body| bodies.dynamic[body]) {
        let percent = 100.0 * ROUNDING;
        world.resource_mut::<Notes>().0.push(format!(
            "where {meets} round, with {percent} % of half their width; give them `rounding` to choose it"
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
    let message = format!("`{body}` has sharp corners, and `{wall}` no thickness: they would pass through each other");
    let help =
        format!("give `{wall}` a `thickness`, or `sides: Left` or `Right`; or the parts of `{body}` a `rounding`");
    let error = SceneError::new("bodies", message).with_help(help);
    world.get_resource_or_init::<LoadErrors>().0.push(error);
}

/// The box about a body, grown by half the margin.
struct Boxed {
    body: usize,
    low: DVec2,
    high: DVec2,
}

/// For each body those whose boxes are nearer than the margin, in order. One of the two moves by forces.
fn near_bodies(bodies: &Bodies, margin: f64) -> Vec<Vec<usize>> {
    let mut boxes: Vec<Boxed> = (0..bodies.len())
        .filter(|&body| bodies.collides[body] && !bodies.atoms_of(body).is_empty())
        .map(|body| {
            let (low, high) =
                bodies.atoms_of(body).fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), atom| {
                    let (at, reach) = (bodies.atom_place(atom), DVec2::splat(bodies.atom_radius[atom] + 0.5 * margin));
                    (low.min(at - reach), high.max(at + reach))
                });
            Boxed { body, low, high }
        })
        .collect();
    boxes.sort_by(|a, b| a.low.x.total_cmp(&b.low.x).then(a.body.cmp(&b.body)));
    let mut near: Vec<Vec<usize>> = vec![Vec::new(); bodies.len()];
    for (rank, a) in boxes.iter().enumerate() {
        for b in boxes[rank + 1..].iter().take_while(|b| b.low.x <= a.high.x) {
            let across = b.low.y <= a.high.y && a.low.y <= b.high.y;
            if across && (bodies.dynamic[a.body] || bodies.dynamic[b.body]) {
                near[a.body].push(b.body);
                near[b.body].push(a.body);
            }
        }
    }
    near.iter_mut().for_each(|list| list.sort_unstable());
    near
}

/// Shows the hulls of different bodies whose circles overlap, each pair once.
pub(super) fn each_pair_of_hulls(bodies: &Bodies, apart: &[(usize, usize)], mut see: impl FnMut(usize, usize)) {
    if bodies.hulls.is_empty() {
        return;
    }
    let near = near_bodies(bodies, 0.0);
    let center = |packed: &PackedHull| bodies.pose_with_hulls(packed.body as usize).point_to_world(packed.circle.0);
    for (place, packed) in bodies.hulls.iter().enumerate() {
        let body = packed.body as usize;
        let others = near[body].iter().filter(|&&other| other > body && apart.binary_search(&(body, other)).is_err());
        for other in others.flat_map(|&other| bodies.places_of_hulls(other)) {
            let second = &bodies.hulls[other];
            if !is_far(center(packed), center(second), packed.circle.1 + second.circle.1) {
                see(place, other);
            }
        }
    }
}

/// Shows the probes that are nearer to hulls than the margin: hull by hull, for each in the order of the probes. Bodies `apart` do not touch
/// each other.
pub(super) fn each_pair(bodies: &Bodies, margin: f64, apart: &[(usize, usize)], mut see: impl FnMut(SurfacePair)) {
    if bodies.hulls.is_empty() {
        return;
    }
    let near = near_bodies(bodies, margin);
    let ends: Vec<(u32, DVec2, f64)> = bodies
        .single_walls()
        .filter(|&wall| bodies.walls[wall].ends.is_some())
        .flat_map(|wall| [false, true].map(|right| (2 * wall as u32 + u32::from(right), bodies.walls[wall].end(right))))
        .map(|(number, (center, half))| (number, center, half))
        .collect();
    let (walls, ends_from) = (bodies.walls.len() as u32, bodies.atom_count() as u32);
    for (place, packed) in bodies.hulls.iter().enumerate() {
        let body = packed.body as usize;
        if !bodies.collides[body] {
            continue;
        }
        let surface = walls + place as u32;
        let (center, circle) = (bodies.pose_with_hulls(body).point_to_world(packed.circle.0), packed.circle.1 + margin);
        let touches = |other: &&usize| apart.binary_search(&ordered(body, **other)).is_err();
        for &other in near[body].iter().filter(touches) {
            if is_far(center, bodies.position[other], circle + bodies.extent(other)) {
                continue;
            }
            for atom in bodies.atoms_of(other).filter(|&atom| bodies.probes(atom)) {
                let reach = bodies.atom_radius[atom] + bodies.spread(place, atom);
                let at = bodies.atom_place(atom);
                let near = || bodies.nearest_on_hull(place, at).distance < packed.hull.radius() + margin + reach;
                if !is_far(center, at, circle + reach) && near() {
                    see(SurfacePair::new(surface, atom as u32));
                }
            }
        }
        let mut near_ends = |(number, end, half): (u32, DVec2, f64)| {
            let near = || bodies.nearest_on_hull(place, end).distance < packed.hull.radius() + margin + half;
            if !is_far(center, end, circle + half) && near() {
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
}

/// Whether two places are farther apart than so many metres.
fn is_far(one: DVec2, other: DVec2, distance: f64) -> bool {
    one.distance_squared(other) > distance * distance
}
