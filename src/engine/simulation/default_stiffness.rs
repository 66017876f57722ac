//! The stiffness of materials that give none. It grows with the weights and speeds of the scene. The contacts to expect then give
//! way by little of a radius.
//!
//! A body of mass `m` meets a wall with the speed `v`. Then it bears the load `L` of other bodies. It presses a contact spring
//! in by `d`: `k d^2/2 = m v^2/2 + L d`. The bound is `d <= s`, with the share [`DEEPEST`] of the smallest radius that can touch. So
//! `k = (m v^2 + 2 L s)/s^2`. The load alone then rests at most half as deep, because `k (s/2) = L` if nothing moves. Between two bodies,
//! both springs are in series, and their masses count as one: `m_a m_b/(m_a + m_b)`.
//!
//! The scene at its start tells:
//! * the mass of all bodies that joints hold together, and the weight of all bodies in one column along gravity;
//! * speeds: those given, those of paths, and those of a fall to the lowest place. That is the lowest point of all half-planes, and
//!   without one that of strips, fixed parts and bodies. A body that others meet may come back from there by the greatest restitution.
//!
//! A tick that the scene itself gives bounds the stiffness: a contact of the lightest body lasts at least [`TICKS`]. A tick of the
//! command line does not, because runs with finer ticks are to have the same contacts.
//!
//! The scene at its start does not tell the work of motors and forces. The verdict tells if overlaps become large.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::choice::is_crowd;
use crate::contacts::penalty::{inelasticity_of, restitution_of};
use crate::integrate::ClockSection;
use crate::joints::Joint;
use crate::tick::{State, rebuild};
use crate::world::material::LEAST_STIFFNESS;
use crate::world::{Bodies, MaterialIndex, Materials, Name, PackedWall, atom};
use jostle_language::numbers::number;

/// Overlaps to expect, as a share of the smallest radius. It is a hundredth of a diameter, as in simulations of grains
/// (Cleary and Sawley, *Applied Mathematical Modelling* 26, 2002). Twice the speeds foreseen still give less than a verdict mentions.
const DEEPEST: f64 = 0.02;

/// The same among many bodies, from where on a verdict mentions overlaps. The speeds foreseen are those of a fall from the top of a
/// heap to its bottom. Few bodies reach them.
const DEEPEST_IN_A_CROWD: f64 = 0.05;

/// A contact that lasts so many ticks is resolved to about a thousandth (`FEWEST_TICKS_OF_CONTACT`).
const TICKS: f64 = 20.0;

/// A wall whose normal is nearer to the vertical than this has its lowest point everywhere.
const LEVEL: f64 = 1e-9;

/// The bodies that joints hold together.
#[derive(Clone, Copy)]
struct Unit {
    /// The heaviest of them, by its index.
    heaviest: usize,
    mass: f64,
    /// The mass in kg of all bodies in its column, with its own.
    load: f64,
    /// The smallest size in m of what can touch; infinite if nothing can.
    size: f64,
    /// Its two ends across gravity, in m.
    across: [f64; 2],
    /// The height in m of its lowest part.
    bottom: f64,
    /// The greatest distance in m to the surface of a wall below it.
    above_walls: f64,
    /// Speed in m/s that the scene gives it.
    speed: f64,
}

/// The unit that sets the stiffness.
struct Cause {
    /// Its heaviest body, by its index.
    body: usize,
    /// In kg.
    mass: f64,
    /// In m/s.
    speed: f64,
    /// In N.
    load: f64,
}

/// Gives a stiffness to all atoms whose material has none, before the run begins. Returns a note if it is not the least one, or too
/// small.
pub(super) fn choose(world: &mut World) -> Option<String> {
    if !atom::any_without_stiffness(world) {
        return None;
    }
    // If bodies are incomplete, the run says so.
    let touches = rebuild(world) && world.resource::<State>().contact_law().is_some();
    let (mut stiffness, mut told) = (LEAST_STIFFNESS, None);
    if touches {
        let (wanted, cause) = Expected::of(world).stiffness();
        stiffness = wanted.min(most_for_tick(world)).max(LEAST_STIFFNESS);
        told = cause.map(|cause| note(world, stiffness, wanted, &cause));
    }
    atom::give_stiffness(world, stiffness);
    world.resource_mut::<Materials>().give_stiffness(stiffness);
    told
}

/// The greatest stiffness in N/m for the tick of the scene: a contact of the lightest body lasts long enough.
fn most_for_tick(world: &World) -> f64 {
    let Some(tick) = world.get_resource::<ClockSection>().and_then(|clock| clock.tick) else { return f64::INFINITY };
    let bodies = world.resource::<State>().bodies();
    let touching = (0..bodies.len()).filter(|&body| bodies.dynamic[body] && bodies.collides[body]);
    let lightest = touching.map(|body| bodies.mass[body]).fold(f64::INFINITY, f64::min);
    let frequency = PI / (TICKS * tick.si());
    rounded_up(lightest * frequency * frequency)
}

fn note(world: &World, stiffness: f64, wanted: f64, cause: &Cause) -> String {
    let chosen = format!("stiffness {} N/m for bodies whose material gives none", number(stiffness));
    let &Cause { body, mass, speed, load } = cause;
    let entity = world.resource::<State>().bodies().entity[body];
    let name = world.get::<Name>(entity).map_or_else(|| "(unnamed)".to_owned(), Name::to_string);
    let [mass, speed, load] = [mass, speed, load].map(|value| number(two_digits(value)));
    // An overlap falls with the root of the stiffness in impacts, and with the stiffness itself at rest.
    let share = number(two_digits(100.0 * deepest(world.resource()) * (wanted / stiffness).sqrt()));
    let with = format!("{mass} kg at up to {speed} m/s and a load of {load} N");
    if stiffness < wanted {
        return format!(
            "{chosen}. `{name}` asks for {} N/m, with {with}, and the tick of the scene is too long for that. Overlaps of {share} % of a \
             radius and more are to be expected. Leave out `tick`, or give a `stiffness`",
            number(wanted)
        );
    }
    format!("{chosen}. `{name}` asks for it, with {with}: overlaps of up to {share} % of a radius are to be expected")
}

/// The touches to expect.
struct Expected {
    units: Vec<Unit>,
    /// In m/s2.
    gravity: f64,
    /// The greatest restitution of two materials.
    restitution: f64,
    /// The height in m of the lowest place to which bodies can fall; `None`: nowhere.
    lowest: Option<f64>,
    /// The result of [`held`].
    held: Option<(f64, f64)>,
    /// The overlaps that are allowed, as a share of the smallest radius.
    deepest: f64,
}

impl Expected {
    fn of(world: &World) -> Self {
        let state = world.resource::<State>();
        let (bodies, gravity) = (state.bodies(), state.gravity());
        let up = -gravity.normalize_or_zero();
        let units = units(state, up);
        let used = materials_of(bodies);
        let rebounds = world.get_resource::<Materials>().into_iter().flat_map(|materials| materials.rebounds_of(&used));
        let restitution = rebounds.map(|rebound| restitution_of(inelasticity_of(rebound))).fold(0.0, f64::max);
        let lowest = lowest_of_half_planes(bodies, up).or_else(|| lowest_thing(bodies, &units, up));
        Self { units, gravity: gravity.length(), restitution, lowest, held: held(bodies), deepest: deepest(state) }
    }

    /// The square of the speed in m/s that a unit gains in the longest fall.
    fn squared_fall(&self, unit: &Unit) -> f64 {
        let fall = self.lowest.map_or(0.0, |lowest| unit.bottom - lowest).max(unit.above_walls).max(0.0);
        2.0 * self.gravity * fall
    }

    /// The stiffness in N/m that is enough for all touches, and the cause if it is not the least one.
    fn stiffness(&self) -> (f64, Option<Cause>) {
        let touching: Vec<&Unit> = self.units.iter().filter(|unit| unit.size.is_finite()).collect();
        let back = |unit: &&Unit| unit.speed + self.restitution * self.squared_fall(unit).sqrt();
        let masses = GreatestTwo::of(touching.iter().map(|unit| unit.mass));
        let speeds = GreatestTwo::of(touching.iter().map(back));
        // A wall is infinitely stiff. Between bodies two springs are in series.
        let most_springs = if touching.len() == 1 && self.held.is_none() { 1.0 } else { 2.0 };
        let (mut most, mut cause) = (LEAST_STIFFNESS, None);
        for (place, &&unit) in touching.iter().enumerate() {
            let speed = (unit.speed * unit.speed + self.squared_fall(&unit)).sqrt();
            let load = self.gravity * unit.load;
            let on_wall = (unit.mass, speed, unit.size, 1.0);
            let on_held = self.held.map(|(size, fastest)| (unit.mass, speed + fastest, unit.size.min(size), 2.0));
            let other = masses.beside(place).zip(speeds.beside(place));
            let on_other =
                other.map(|(mass, fastest)| (unit.mass * mass / (unit.mass + mass), speed + fastest, unit.size, 2.0));
            for (mass, speed, size, springs) in [Some(on_wall), on_held, on_other].into_iter().flatten() {
                let deepest = self.deepest * size;
                let energy = springs * mass * speed * speed + most_springs * 2.0 * load * deepest;
                let stiffness = rounded_up(energy / (deepest * deepest));
                if stiffness > most && stiffness.is_finite() {
                    (most, cause) = (stiffness, Some(Cause { body: unit.heaviest, mass, speed, load }));
                }
            }
        }
        (most, cause)
    }
}

fn deepest(state: &State) -> f64 {
    if is_crowd(state) { DEEPEST_IN_A_CROWD } else { DEEPEST }
}

/// The materials of all that may touch.
fn materials_of(bodies: &Bodies) -> BTreeSet<MaterialIndex> {
    let touching = (0..bodies.len()).filter(|&body| bodies.collides[body]);
    let of_atoms = touching.flat_map(|body| bodies.atoms_of(body)).map(|atom| bodies.atom_material(atom));
    of_atoms.chain(bodies.walls.iter().map(|wall| wall.material)).collect()
}

/// The greatest two of a list of numbers.
struct GreatestTwo {
    greatest: Option<(usize, f64)>,
    second: Option<f64>,
}

impl GreatestTwo {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut two = Self { greatest: None, second: None };
        for (place, value) in values.enumerate() {
            match two.greatest {
                Some((_, greatest)) if value <= greatest => {
                    two.second = Some(two.second.map_or(value, |s| s.max(value)))
                }
                greatest => (two.second, two.greatest) = (greatest.map(|(_, value)| value), Some((place, value))),
            }
        }
        two
    }

    /// The greatest of all but that of one place.
    fn beside(&self, place: usize) -> Option<f64> {
        self.greatest.and_then(|(of, greatest)| if of == place { self.second } else { Some(greatest) })
    }
}

/// The smallest size in m of bodies that touch and that no force moves. The other number is the speed of the fastest in m/s.
fn held(bodies: &Bodies) -> Option<(f64, f64)> {
    let held = || (0..bodies.len()).filter(|&body| !bodies.dynamic[body] && bodies.collides[body]);
    let sizes = held().flat_map(|body| bodies.atoms_of(body)).map(|atom| bodies.size_of_atom(atom));
    let paths = bodies.prescribed.motions.iter().filter(|(body, _)| bodies.collides[*body]);
    let speeds = paths.map(|(body, motion)| {
        let (speed, spin) = motion.path.fastest();
        speed + spin * (motion.center.length() + bodies.extent(*body))
    });
    sizes.reduce(f64::min).map(|size| (size, speeds.fold(0.0, f64::max)))
}

/// The units of a scene, in the order of their first bodies.
fn units(state: &State, up: DVec2) -> Vec<Unit> {
    let bodies = state.bodies();
    let mut root: Vec<usize> = (0..bodies.len()).collect();
    for joint in state.models_of::<Joint>() {
        let [a, b] = joint.ends.keys.map(|key| key.and_then(|key| bodies.key.find(key)));
        if let (Some(a), Some(b)) = (a.filter(|a| bodies.dynamic[*a]), b.filter(|b| bodies.dynamic[*b])) {
            let (a, b) = (root_of(&mut root, a), root_of(&mut root, b));
            root[a.max(b)] = a.min(b);
        }
    }
    let mut units: Vec<Unit> = Vec::new();
    let mut unit_of = vec![usize::MAX; bodies.len()];
    for body in (0..bodies.len()).filter(|body| bodies.dynamic[*body]) {
        let first = root_of(&mut root, body);
        let own = Unit::of(bodies, body, up);
        if unit_of[first] == usize::MAX {
            unit_of[first] = units.len();
            units.push(own);
        } else {
            let unit = &mut units[unit_of[first]];
            *unit = unit.with(own, bodies);
        }
    }
    add_loads(&mut units);
    units
}

fn root_of(root: &mut [usize], mut body: usize) -> usize {
    while root[body] != body {
        root[body] = root[root[body]];
        body = root[body];
    }
    body
}

impl Unit {
    fn of(bodies: &Bodies, body: usize, up: DVec2) -> Self {
        let (at, mass, extent) = (bodies.position[body], bodies.mass[body], bodies.extent(body));
        let sizes = bodies.atoms_of(body).map(|atom| bodies.size_of_atom(atom)).filter(|_| bodies.collides[body]);
        let size = sizes.fold(f64::INFINITY, f64::min);
        let (middle, low) = (at.dot(up.perp()), if size.is_finite() { size } else { 0.0 });
        let below = |wall: &PackedWall| {
            let slope = wall.normal.dot(up);
            (slope > LEVEL).then(|| (wall.nearest(at).height - low) / slope)
        };
        Self {
            heaviest: body,
            mass,
            load: mass,
            size,
            across: [middle - extent, middle + extent],
            bottom: at.dot(up) - low,
            above_walls: half_planes(bodies).filter_map(below).fold(0.0, f64::max),
            speed: bodies.velocity[body].length() + bodies.spin[body].abs() * extent,
        }
    }

    /// Both together.
    fn with(&self, other: Self, bodies: &Bodies) -> Self {
        let heavier = bodies.mass[other.heaviest] > bodies.mass[self.heaviest];
        Self {
            heaviest: if heavier { other.heaviest } else { self.heaviest },
            mass: self.mass + other.mass,
            load: self.load + other.load,
            size: self.size.min(other.size),
            across: [self.across[0].min(other.across[0]), self.across[1].max(other.across[1])],
            bottom: self.bottom.min(other.bottom),
            above_walls: self.above_walls.min(other.above_walls),
            speed: self.speed.max(other.speed),
        }
    }
}

/// Adds the masses of other units in the column of each.
fn add_loads(units: &mut [Unit]) {
    let sums = |edge: usize| {
        let mut edges: Vec<(f64, f64)> = units.iter().map(|unit| (unit.across[edge], unit.mass)).collect();
        edges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut sum = 0.0;
        edges.iter_mut().for_each(|(_, mass)| {
            sum += *mass;
            *mass = sum;
        });
        edges
    };
    // Masses of units that begin before a place, and of those that end before it.
    let [begun, ended] = [sums(0), sums(1)];
    let until = |sums: &[(f64, f64)], end: f64| {
        let place = sums.partition_point(|(edge, _)| *edge < end);
        place.checked_sub(1).map_or(0.0, |last| sums[last].1)
    };
    for unit in units {
        let [from, to] = unit.across;
        unit.load = unit.mass.max(until(&begun, to) - until(&ended, from));
    }
}

fn half_planes(bodies: &Bodies) -> impl Iterator<Item = &PackedWall> {
    bodies.walls.iter().filter(|wall| wall.ends.is_none() && wall.line.is_none())
}

/// The height in m of the lowest point inside all half-planes, if there is one. By the duality of linear programs it is the greatest
/// height that one or two of them give. Upwards lies between the normals of the two.
fn lowest_of_half_planes(bodies: &Bodies, up: DVec2) -> Option<f64> {
    let walls: Vec<_> = half_planes(bodies).filter(|_| up != DVec2::ZERO).collect();
    let level = walls.iter().filter(|wall| wall.normal.dot(up) > 0.0 && wall.normal.perp_dot(up).abs() < LEVEL);
    let mut heights: Vec<f64> = level.map(|wall| wall.point.dot(up)).collect();
    for (number, first) in walls.iter().enumerate() {
        for second in &walls[number + 1..] {
            let area = first.normal.perp_dot(second.normal);
            let (a, b) = (up.perp_dot(second.normal) / area, first.normal.perp_dot(up) / area);
            if area.abs() > LEVEL && a >= 0.0 && b >= 0.0 {
                heights.push(a * first.normal.dot(first.point) + b * second.normal.dot(second.point));
            }
        }
    }
    heights.into_iter().reduce(f64::max)
}

/// The height in m of the lowest strip, line, part of a held body, or body.
fn lowest_thing(bodies: &Bodies, units: &[Unit], up: DVec2) -> Option<f64> {
    let surfaces = bodies.walls.iter().filter(|wall| wall.ends.is_some() || wall.line.is_some());
    let ends = surfaces.flat_map(|wall| [wall.point, wall.end(true).0]).map(|end| end.dot(up));
    let held = || (0..bodies.len()).filter(|&body| !bodies.dynamic[body] && bodies.collides[body]);
    let place = |atom: usize, body: usize| {
        let (sin, cos) = libm::sincos(bodies.angle[body]);
        bodies.position[body] + DVec2::new(cos, sin).rotate(bodies.atom_offset(atom))
    };
    let discs = held().flat_map(|body| bodies.atoms_of(body).map(move |atom| (body, atom)));
    let discs = discs.filter(|(_, atom)| !bodies.is_corner(*atom));
    let tops = discs.map(|(body, atom)| place(atom, body).dot(up) + bodies.atom_radius[atom]);
    let hulls = bodies.hulls.iter().filter(|hull| !bodies.dynamic[hull.body as usize]);
    let hulls = hulls.filter_map(|hull| {
        let corners = hull.first_atom as usize..hull.first_atom as usize + hull.hull.corners().len();
        let heights = corners.map(|atom| place(atom, hull.body as usize).dot(up) + bodies.atom_radius[atom]);
        heights.reduce(f64::max)
    });
    let touching = units.iter().filter(|unit| unit.size.is_finite()).map(|unit| unit.bottom);
    ends.chain(tops).chain(hulls).chain(touching).reduce(f64::min)
}

/// The least number of few digits that is not below a value.
fn rounded_up(value: f64) -> f64 {
    if !value.is_finite() || value <= 0.0 {
        return value;
    }
    let exponent = libm::log10(value).floor() as i32 - 1;
    let digits = (value / libm::exp10(f64::from(exponent)) * (1.0 - 1e-12)).ceil();
    // Read back from decimal digits, so that it is the number that the card shows.
    format!("{digits}e{exponent}").parse().unwrap_or(value)
}

fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
