//! Shapes that begin with a corner too deep behind a line for a contact. The scene is refused, with both names.

use bevy_ecs::prelude::*;

use crate::scene::SceneError;
use crate::tick::{LoadErrors, State};
use crate::world::line::{BEHIND, PackedLine};
use crate::world::{Bodies, Name};
use jostle_language::numbers::number;

/// Reports the first body with a corner too deep behind a line and its centre of mass before the line. The depth is
/// below half the corner's width.
pub(super) fn refuse_sunk(world: &mut World) {
    let bodies = &world.resource::<State>().bodies;
    let Some((body, wall, depth)) = bodies.lines.iter().find_map(|line| sunk_in(bodies, line)) else { return };
    let name = |entity| world.get::<Name>(entity).map_or_else(|| "(unnamed)".to_owned(), Name::to_string);
    let (body, wall) = (name(bodies.entity[body]), name(bodies.walls[wall].entity));
    let message = format!(
        "`{body}` begins with a corner {} m behind `{wall}`. A line makes no contact so deep behind it, and the body would \
         fall through",
        number(depth)
    );
    let help = "move it to the open side, or let a wall with `left` and `right` hold it";
    world.get_resource_or_init::<LoadErrors>().0.push(SceneError::new("bodies", message).with_help(help));
}

/// The body, the first piece of the line, and how deep in m the centre of the corner lies.
fn sunk_in(bodies: &Bodies, line: &PackedLine) -> Option<(usize, usize, f64)> {
    let half = bodies.walls[line.first as usize].ends.map_or(0.0, |ends| ends.half);
    let near = |&body: &usize| {
        let mut is_near = bodies.dynamic[body] && bodies.collides[body];
        if is_near {
            is_near = false;
            line.each_near(bodies.position[body], bodies.extent(body), &mut |_| is_near = true);
        }
        is_near && !bodies.is_behind_line(line, bodies.position[body])
    };
    let mut corners =
        (0..bodies.len()).filter(near).flat_map(|body| bodies.atoms_of(body).map(move |atom| (body, atom)));
    corners.find_map(|(body, atom)| {
        let size = bodies.size_of_atom(atom);
        let depth = -half - bodies.height_over_line(line, bodies.atom_place(atom));
        let sunk = bodies.is_corner(atom) && bodies.probes(atom) && depth >= BEHIND * size && depth < size;
        sunk.then_some((body, line.first as usize, depth))
    })
}
