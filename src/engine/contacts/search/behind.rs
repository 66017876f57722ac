//! Signed distances before the first tick find walls with all bodies behind them. The points of such a wall may be in the
//! wrong order, so the card notes it.

use bevy_ecs::prelude::*;

use crate::tick::{Notes, State};
use crate::world::{Bodies, Name, PackedWall, Wall};

/// Places that are compared with walls for the note, at most: a second is enough.
const MOST_LOOKS: usize = 1 << 27;

/// The walls with all bodies behind them that move by forces, at the start.
#[derive(Resource, Debug, Default)]
pub struct TurnedWalls(pub Vec<Entity>);

/// Says on the card which walls have all bodies behind them that move by forces.
pub(super) fn note_behind(world: &mut World) {
    let bodies = &world.resource::<State>().bodies;
    let turned: Vec<Entity> = turned_lines(bodies).chain(turned_half_planes(bodies)).map(|wall| wall.entity).collect();
    world.insert_resource(TurnedWalls(turned.clone()));
    for entity in turned {
        let name = world.get::<Name>(entity).map_or_else(|| "(unnamed)".to_owned(), Name::to_string);
        let has_thickness = world.get::<Wall>(entity).is_some_and(|wall| wall.thickness.is_some());
        let bodies = world.resource::<State>().bodies();
        let is_line = bodies.walls.iter().any(|wall| wall.entity == entity && wall.line.is_some());
        let cause = match (is_line, has_thickness) {
            (false, _) => "It pushes them out at once. Perhaps its `left` and `right` are swapped",
            (true, true) => "They enter it without a force. Perhaps `Left` and `Right` are swapped in its `sides`",
            (true, false) => {
                "They enter it without a force. It is open to the left of the way from its first point to its last. Perhaps \
                 its points stand in the wrong order"
            }
        };
        let note = format!("all bodies that move by forces are behind `{name}`. {cause}");
        world.resource_mut::<Notes>().0.push(note);
    }
}

/// Bodies that move by forces and touch others.
fn touching(bodies: &Bodies) -> Vec<usize> {
    (0..bodies.len()).filter(|&body| bodies.dynamic[body] && bodies.collides[body]).collect()
}

/// The first pieces of lines with all bodies behind them.
fn turned_lines(bodies: &Bodies) -> impl Iterator<Item = &PackedWall> {
    let touching = touching(bodies);
    let lines = bodies.lines.iter().filter(move |line| {
        !touching.is_empty()
            && touching.len().saturating_mul(line.pieces().len()) <= MOST_LOOKS
            && touching.iter().all(|&body| bodies.is_behind_line(line, bodies.position[body]))
    });
    lines.map(|line| &bodies.walls[line.first as usize])
}

/// Half-planes in which all centres of mass lie.
fn turned_half_planes(bodies: &Bodies) -> impl Iterator<Item = &PackedWall> {
    let touching = touching(bodies);
    let few = touching.len().saturating_mul(bodies.walls.len()) <= MOST_LOOKS && !touching.is_empty();
    let half_planes = bodies.walls.iter().filter(move |wall| few && wall.ends.is_none());
    half_planes.filter(move |wall| touching.iter().all(|&body| wall.nearest(bodies.position[body]).height < 0.0))
}
