//! `Repose(name: "heap", of: "grain_*")`: the angle of repose of a heap, by least squares through its free surface.
//!
//! The angle of repose is that of the free surface against the horizontal. Source: Beakawi Al-Hashemi and Baghabra Al-Amoudi,
//! Powder Technology 330, 2018, section 1.2. The plane is cut into upright columns of equal width. In each column the highest
//! point of a body is a point of the surface. The highest of these is the summit, the lowest the base. On each side of the summit
//! least squares (Legendre 1805) fit a straight line to the points. Heights are the dependent variable. Only points between two
//! shares of the height count, because the toe spreads and the crest is round.
//!
//! Upwards is against gravity; without gravity it is along y.

use std::collections::BTreeMap;

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::group::{self, Group};
use super::named::Named;
use super::{Channel, SensorAppExt, add_found, declare};
use crate::scene::units::{Length, Scalar, Speed};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::State;
use crate::tick::kept::SnapshotAppExt;
use crate::world::Bodies;
use crate::world::sections::Region;

const QUANTITIES: &[&str] = &["repose", "repose.left", "repose.right"];

/// A line is fitted to at least this many points, because two points always have a line through both.
const FEWEST: usize = 3;

/// The angle of repose of a heap in rad. `heap.repose.left` and `heap.repose.right` are those of its two flanks,
/// `heap.repose` is their mean. The sensor cuts the heap into upright columns. In each of them the highest point of a body
/// is a point of the free surface. Least squares fit a straight line to the points of a flank. An angle is positive if the
/// flank rises to the summit. A flank with fewer than three points is NaN, and the mean is then that of the other flank.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Repose {
    /// Its name: that of its channels.
    name: String,
    /// The bodies of the heap. `*` stands for any letters.
    of: Names,
    /// Only bodies whose centre of mass is in this region count. It is two opposite corners of a box, or the corners of a polygon
    /// in order, in m. Default: everywhere.
    within: Option<Region>,
    /// Only bodies that are slower count, in m/s: bodies that still fall are no part of the heap. Above zero. Default:
    /// none.
    slower_than: Option<Speed>,
    /// The width of the columns in m. Above zero. Default: the width of the largest of the bodies.
    column: Option<Length>,
    /// Points between these shares of the height of the summit above the base count. From 0 to 1, the lower one first. Default: (0.2, 0.8).
    #[serde(default = "middle")]
    heights: (Scalar, Scalar),
}

fn middle() -> (Scalar, Scalar) {
    (Scalar::new(0.2), Scalar::new(0.8))
}

/// The sensors of the scene.
type Asked = Named<Heap>;

struct Heap {
    group: Group,
    /// In m/s.
    slower_than: f64,
    /// In m.
    column: Option<f64>,
    heights: (f64, f64),
}

impl Entry for Repose {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Repose";
    const EXAMPLE: &'static str =
        "Repose(name: \"heap\", of: \"grain_*\", within: ((-0.3, 0), (0.3, 0.3)), slower_than: 0.05)";

    fn declare(&self, outline: &mut Outline) {
        declare(&self.name, outline);
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        group::check(&self.of, self.within.as_ref(), outline, report);
        report.positive_if_given("slower_than", self.slower_than);
        report.positive_if_given("column", self.column);
        let (low, high) = (self.heights.0.si(), self.heights.1.si());
        let good = report.between("heights[0]", low, 0.0, 1.0) && report.between("heights[1]", high, 0.0, 1.0);
        if good && low >= high {
            let message = format!("the lower share, {low}, is not below the upper one, {high}");
            report.error("heights", message).help("give the lower share first, such as `heights: (0.2, 0.8)`");
        }
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        let world = app.world_mut();
        for WrittenEntry { value: Self { name, of, within, slower_than, column, heights }, .. } in entries {
            let heap = Heap {
                group: Group::new(&of, within, outline, world),
                slower_than: slower_than.map_or(f64::INFINITY, Speed::si),
                column: column.map(Length::si),
                heights: (heights.0.si(), heights.1.si()),
            };
            world.get_resource_or_init::<Asked>().push(&name, heap);
            add_found(world, QUANTITIES.iter().map(|quantity| format!("{name}.{quantity}")));
        }
    }
}

impl Heap {
    /// Angles of the left and of the right flank in rad.
    fn flanks(&self, world: &World) -> [f64; 2] {
        let state = world.resource::<State>();
        let (bodies, gravity) = (state.bodies(), state.gravity());
        let up = if gravity == DVec2::ZERO { DVec2::Y } else { -gravity.normalize() };
        let slow = |body: usize| bodies.velocity[body].length() < self.slower_than;
        let heap: Vec<usize> = self.group.present(world).map(|(_, body)| body).filter(|body| slow(*body)).collect();
        let widest = heap.iter().map(|body| 2.0 * bodies.extent(*body)).fold(0.0, f64::max);
        let tops = heap.iter().map(|body| top(bodies, *body, up)).collect();
        flanks(&surface(tops, self.column.unwrap_or(widest)), self.heights)
    }
}

/// The highest point of a body: how far it is to the right, and how high it is, in m.
fn top(bodies: &Bodies, body: usize, up: DVec2) -> DVec2 {
    let seen = |at: DVec2, radius: f64| DVec2::new(at.dot(-up.perp()), at.dot(up) + radius);
    let atoms = bodies.atoms_of(body).map(|atom| seen(bodies.atom_place(atom), bodies.atom_radius[atom]));
    atoms.reduce(|a, b| if b.y > a.y { b } else { a }).unwrap_or_else(|| seen(bodies.position[body], 0.0))
}

/// The highest point in each column, from left to right.
fn surface(tops: Vec<DVec2>, column: f64) -> Vec<DVec2> {
    let begin = tops.iter().map(|top| top.x).fold(f64::INFINITY, f64::min);
    let mut highest: BTreeMap<u64, DVec2> = BTreeMap::new();
    for top in tops {
        let found = highest.entry(((top.x - begin) / column) as u64).or_insert(top);
        if top.y > found.y {
            *found = top;
        }
    }
    highest.into_values().collect()
}

/// Angles in rad of the lines through the left and the right flank of a surface. Each is positive if the flank rises to the
/// summit.
fn flanks(surface: &[DVec2], shares: (f64, f64)) -> [f64; 2] {
    let Some(summit) = surface.iter().copied().reduce(|a, b| if b.y > a.y { b } else { a }) else {
        return [f64::NAN; 2];
    };
    let base = surface.iter().map(|point| point.y).fold(f64::INFINITY, f64::min);
    let height = summit.y - base;
    let band = base + shares.0 * height..=base + shares.1 * height;
    [1.0, -1.0].map(|side| {
        let is_of_flank = |point: &&DVec2| side * (summit.x - point.x) >= 0.0 && band.contains(&point.y);
        let points: Vec<DVec2> = surface.iter().filter(is_of_flank).copied().collect();
        libm::atan(side * slope(&points))
    })
}

/// The slope of the line of least squares; NaN if there are too few points.
fn slope(points: &[DVec2]) -> f64 {
    if points.len() < FEWEST {
        return f64::NAN;
    }
    let middle = points.iter().fold(DVec2::ZERO, |sum, point| sum + *point) / points.len() as f64;
    let add = |(both, square): (f64, f64), point: &DVec2| {
        let DVec2 { x, y } = *point - middle;
        (both + x * y, square + x * x)
    };
    let (both, square) = points.iter().fold((0.0, 0.0), add);
    both / square
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    let index = world.get_resource::<Asked>()?.place(owner)?;
    let read: fn([f64; 2]) -> f64 = match quantity {
        "repose" => |[left, right]| match (left.is_nan(), right.is_nan()) {
            (true, _) => right,
            (_, true) => left,
            _ => 0.5 * (left + right),
        },
        "repose.left" => |flanks| flanks[0],
        "repose.right" => |flanks| flanks[1],
        _ => return None,
    };
    let value = move |world: &World| {
        let heap = world.get_resource::<Asked>().and_then(|asked| asked.get(index));
        heap.map_or(f64::NAN, |heap| read(heap.flanks(world)))
    };
    Some(Channel::of_resources(format!("{owner}.{quantity}"), "rad", value))
}

pub(super) fn plugin(app: &mut App) {
    app.add_quantities(QUANTITIES, find);
    app.register_entry::<Repose>();
    app.follows_from_scene::<Asked>();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: least squares through `(0, 0), (1, 2), (2, 1)` has the slope 1/2. By hand: the middle is (1, 1), the products sum up
    /// to 1, the squares to 2.
    #[test]
    fn a_line_of_least_squares_by_hand() {
        assert_eq!(slope(&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)].map(DVec2::from)), 0.5);
        assert!(slope(&[(0.0, 0.0), (1.0, 2.0)].map(DVec2::from)).is_nan());
    }

    /// Bodies below the surface, and a body in flight that another column holds lower, do not count.
    #[test]
    fn the_surface_is_the_highest_of_each_column() {
        let tops = [(0.0, 0.5), (0.9, 0.7), (1.1, 0.2), (1.2, 3.0), (5.0, 1.0)].map(DVec2::from).to_vec();
        assert_eq!(surface(tops, 1.0), [(0.9, 0.7), (1.2, 3.0), (5.0, 1.0)].map(DVec2::from));
    }
}
