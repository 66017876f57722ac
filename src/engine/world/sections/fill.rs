//! `fill`: random sequential addition (Widom 1966) with a seed. It puts many bodies of a kind in a box or polygon, and none
//! touches another.

use bevy_app::App;
use glam::DVec2;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::units::{Length, Speed};
use crate::scene::values::WholeNumber;
use crate::scene::{Diagnostics, NameKind, Obstacle, Outline, Section, number};
use crate::shapes::mass_properties::{self, InertiaRule, MassProperties};
use crate::shapes::outline::OutlineShape;
use crate::shapes::{AtomShape, AtomSpec};
use crate::world::sections::MOST_ATOMS;
use crate::world::sections::Region;
use crate::world::sections::size_distribution::Radii;
use crate::world::sections::taken::TakenPlaces;
use crate::world::{material, sections};

/// The largest number of bodies of all entries together. A body of one atom takes some 0.6 kB while a scene is read. A
/// film reads its scene twice.
pub const LARGEST_COUNT: u64 = 1_000_000;
/// The number of times that a place is tried for one body before the region counts as full.
const TRIES: usize = 20_000;
/// Bodies that would take a smaller share of their region do not fill it.
const SPARSE: f64 = 0.3;
/// The limit of work for the tries of one entry, in checks of a position against four corners. That takes seconds.
const MOST_WORK: usize = 100_000_000;
/// After so many entries without room the others are not tried: each costs all its tries.
const MOST_FULL: usize = 10;
/// The number of corners that take as long as the other work of a try.
const CORNERS: usize = 16;
/// Cells of the search grid along one side, at most.
const CELLS: usize = 512;

/// Many bodies of a kind.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Fill")]
pub struct FillEntry {
    /// The prefix of their names.
    pub name: String,
    /// The atoms of each body. Without them it has a `shape`. Default: none.
    #[serde(default)]
    pub atoms: Option<AtomShape>,
    /// The shape with sides of each body. Default: none.
    #[serde(default)]
    pub shape: Option<OutlineShape>,
    /// The distribution of radii, in place of `atoms` and `shape`. Each body is then a disc of another radius, by the same
    /// seed. Default: all are equal.
    #[serde(default)]
    pub radius: Option<Radii>,
    /// The name of their material. Default: `default`.
    #[serde(default)]
    pub material: Option<String>,
    /// The number of bodies, from 1 to 1 000 000 in all.
    pub count: WholeNumber,
    /// Two opposite corners of a box, or the corners of a polygon in order, in m.
    pub within: Region,
    /// The speed of each body at the start, in m/s. Default: 0.
    #[serde(default)]
    pub speed: Speed,
    /// The seed of chance. Default: 0.
    #[serde(default)]
    pub seed: WholeNumber,
    /// The least distance of those circles from each other and from other bodies, in m. Default: 0.
    #[serde(default)]
    pub gap: Length,
}

/// One body of a fill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Centre of mass, in m.
    pub position: DVec2,
    /// Angle in rad, from 0 to 2 pi.
    pub angle: f64,
    /// Velocity, in m/s.
    pub velocity: DVec2,
    /// The radius of a circle about the centre of mass that holds the body, in m.
    pub radius: f64,
}

/// Many bodies of a kind in a box or polygon, none touching another, by seeded chance. The bodies of `gas` are called `gas_0`,
/// `gas_1` and so on.
///
/// Each stands at a random place in the region at a random angle, and moves in a random direction. A circle about the
/// centre of mass of each body holds all its atoms and shapes. These circles do not touch each other, other bodies, walls
/// or the region's border. The same seed gives the same places on every machine. If radii are distributed, the largest are
/// placed first. Names go by the order in which radii were drawn.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub struct FillSection(pub Vec<FillEntry>);

impl FillSection {
    /// The positions of all bodies, one list for each entry. A list is shorter than the entry's `count` only if the
    /// region is full, or too narrow for random tries. `check` reports that. Lists end after ten that are too short.
    /// The outline knows the occupied places.
    pub fn place(&self, outline: &Outline) -> Vec<Vec<Placed>> {
        let mut taken = TakenPlaces::new(self.0.iter().map(|entry| entry.within.bounds()));
        outline.obstacles().iter().for_each(|obstacle| taken.add(*obstacle));
        let (mut all, mut full) = (Vec::new(), 0);
        for entry in &self.0 {
            if full == MOST_FULL {
                break;
            }
            let placed = entry.place(&taken);
            for body in &placed {
                taken.add(Obstacle::Disc { center: body.position, radius: body.radius });
            }
            full += usize::from((placed.len() as u64) < entry.count.0);
            all.push(placed);
        }
        all
    }
}

impl Section for FillSection {
    const NAME: &'static str = "fill";
    const EXAMPLE: &'static str =
        "fill: [(name: \"gas\", atoms: Disc(radius: 0.02), count: 500, within: ((0, 0), (6, 6)), speed: 1, seed: 7)]";

    /// Declares the bodies' names.
    fn declare(&self, outline: &mut Outline) {
        // Names of more than there may be in all are of no use, and take memory.
        let mut left = LARGEST_COUNT;
        for (index, entry) in self.0.iter().enumerate() {
            let count = entry.count.0.min(left);
            left -= count;
            outline.declare_series(NameKind::BODY, &entry.name, count, &format!("[{index}].name"));
        }
    }

    /// Reports wrong atoms, counts and boxes, unknown materials, and boxes that lack room for all bodies.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        let mut good = true;
        for (index, entry) in self.0.iter().enumerate() {
            good &=
                report.all_good(|report| report.within(&format!("[{index}]"), |report| entry.check(outline, report)));
        }
        let all: u64 = self.0.iter().map(|entry| entry.count.0).fold(0, u64::saturating_add);
        if good && all > LARGEST_COUNT {
            report.error("", format!("must be at most {LARGEST_COUNT} bodies in all, got {all}"));
            return;
        }
        if !good || !outline.is_complete() {
            return;
        }
        let size = |entry: &FillEntry| sections::size(entry.atoms.as_ref(), entry.shape.as_ref()).max(1);
        let atoms = self.0.iter().map(|entry| size(entry).saturating_mul(entry.count.0)).fold(0, u64::saturating_add);
        if atoms > MOST_ATOMS {
            report
                .error("", format!("must be at most {MOST_ATOMS} atoms and corners in all, got {atoms}"))
                .help("use fewer bodies, or simpler ones");
            return;
        }
        for (index, (entry, placed)) in self.0.iter().zip(self.place(outline)).enumerate() {
            if (placed.len() as u64) < entry.count.0 {
                let gap = entry.gap.si();
                let (apart, smaller) = if gap > 0.0 {
                    (format!("{} m apart from any other", number(gap)), "`gap`")
                } else {
                    ("without touching anything".to_owned(), if entry.shape.is_some() { "shapes" } else { "atoms" })
                };
                let square = |radius: f64| (radius + gap / 2.0) * (radius + gap / 2.0);
                let area = std::f64::consts::PI * entry.sum_over_radii(square);
                let share = area / entry.within.area();
                let message = format!(
                    "only {} of {} bodies {} room in the {} {apart}. All would take {} % of its area",
                    placed.len(),
                    entry.count.0,
                    if placed.len() == 1 { "finds" } else { "find" },
                    entry.within.noun(),
                    number((100.0 * share).round()),
                );
                let narrow =
                    if share < SPARSE { ". Chance hardly meets so narrow a region: use a wider one" } else { "" };
                let help = format!(
                    "a larger `within`, a smaller `count` or smaller {smaller} would fit. Chance fills about half the \
                     area{narrow}"
                );
                report.error(&format!("[{index}].count"), message).help(help);
            }
        }
    }

    fn install(self, outline: &Outline, app: &mut App) {
        sections::spawn_fill(self, outline, app.world_mut());
    }
}

impl FillEntry {
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        if let Some(atoms) = &self.atoms {
            report.within("atoms", |report| atoms.check(report));
        }
        if let Some(shape) = &self.shape {
            report.within("shape", |report| shape.check(report));
            if self.specs().iter().any(|atom| atom.mass.is_some()) {
                let message = "beside a `shape` discs have no masses of their own: all are of one area";
                report.error("atoms", message).help("remove the atoms' `mass`");
            }
        }
        if let Some(radii) = &self.radius {
            let count = self.count.0.min(LARGEST_COUNT) as usize;
            report.within("radius", |report| radii.check(count, self.seed.0, report));
            if self.atoms.is_some() || self.shape.is_some() {
                let message = "`radius` makes discs: they have neither `atoms` nor a `shape`";
                report.error("radius", message).help("remove `radius`, or the other");
            }
        } else if self.atoms.is_none() && self.shape.is_none() {
            report.missing("atoms", "say what they are made of: write `atoms: Disc(radius: 0.1)`, or a `shape`");
        }
        if report.is_clean() {
            self.mass_properties(1.0).check(report);
        }
        material::require(self.material.as_deref(), outline, report);
        if !(1..=LARGEST_COUNT).contains(&self.count.0) {
            report.error("count", format!("must be from 1 to {LARGEST_COUNT}, got {}", self.count.0));
        }
        report.within("within", |report| self.within.check(report));
        report.not_negative("speed", self.speed);
        report.not_negative("gap", self.gap);
    }

    /// Mass, centre of mass, inertia and atoms of each, given the density of their material in kg/m2. If radii are distributed,
    /// they are those of the disc that was drawn first.
    pub fn mass_properties(&self, density: f64) -> MassProperties {
        if let Some(radii) = &self.radius {
            return disc(radii.draw(1, self.seed.0).first().copied().unwrap_or(f64::NAN), density);
        }
        let (specs, rule) = (self.specs(), self.atoms.as_ref().map_or_else(InertiaRule::default, AtomShape::own_rule));
        match &self.shape {
            Some(shape) => mass_properties::of_parts(&specs, &shape.parts().parts, None, InertiaRule::Union, density),
            None => mass_properties::of(&specs, None, rule, density),
        }
    }

    /// Whether they touch others.
    pub fn touches(&self) -> bool {
        let parts = self.shape.as_ref().map_or_else(Vec::new, |shape| shape.parts().parts);
        self.atoms.is_some() || self.radius.is_some() || parts.iter().any(|part| part.collides)
    }

    /// The discs of each, without those of its shape.
    fn specs(&self) -> Vec<AtomSpec> {
        self.atoms.as_ref().map_or_else(Vec::new, AtomShape::specs)
    }

    /// The radius in m of a circle about the centre of mass that holds the whole body. It does not depend on the
    /// density.
    fn radius(&self) -> f64 {
        match (&self.atoms, &self.shape) {
            (_, Some(shape)) => mass_properties::reach_of_parts(&self.specs(), &shape.parts().parts),
            (Some(atoms), None) => mass_properties::reach(&atoms.specs(), atoms.own_rule()),
            (None, None) => 0.0,
        }
    }

    /// The radii of all in the order of their names, in m.
    fn radii(&self) -> Vec<f64> {
        let count = self.count.0.min(LARGEST_COUNT) as usize;
        let equal = || vec![self.radius(); count];
        self.radius.as_ref().map_or_else(equal, |radii| radii.draw(count, self.seed.0))
    }

    fn sum_over_radii(&self, of: impl Fn(f64) -> f64) -> f64 {
        self.radii().into_iter().fold(0.0, |sum, radius| sum + of(radius))
    }

    /// Places all that find room, the largest first; fewer than there are to be are in no order.
    fn place(&self, taken: &TakenPlaces) -> Vec<Placed> {
        let radii = self.radii();
        let mut order: Vec<u32> = (0..radii.len() as u32).collect();
        // Equal ones keep their order.
        order.sort_by(|a, b| radii[*b as usize].total_cmp(&radii[*a as usize]));
        let sizes = order.iter().map(|number| radii[*number as usize]);
        let mut placed = self.place_sizes(sizes, taken);
        if placed.len() == radii.len() {
            let mut named: Vec<(u32, Placed)> = order.into_iter().zip(placed).collect();
            named.sort_unstable_by_key(|(number, _)| *number);
            placed = named.into_iter().map(|(_, body)| body).collect();
        }
        placed
    }

    /// Places bodies of these radii, which descend, until one finds no room.
    fn place_sizes(&self, radii: impl DoubleEndedIterator<Item = f64> + Clone, taken: &TakenPlaces) -> Vec<Placed> {
        let mut placed = Vec::new();
        let (Some(largest), Some(least)) = (radii.clone().next(), radii.clone().next_back()) else { return placed };
        let bounds = self.within.bounds();
        let room = |radius: f64| (bounds.0 + radius, bounds.1 - radius);
        let (low, high) = room(largest);
        if !(low.x <= high.x && low.y <= high.y) {
            return placed;
        }
        let gap = self.gap.si();
        let near: Vec<Obstacle> = taken.near(bounds, largest + gap).collect();
        let standing = near.len() as u64 + self.count.0.min(LARGEST_COUNT);
        let mut grid = Grid::new(room(least), largest, gap, standing);
        near.into_iter().for_each(|obstacle| grid.insert(obstacle));
        let mut random = ChaCha8Rng::seed_from_u64(self.seed.0);
        // The upper 53 bits: a number from 0 up to, not including, 1, the same on every machine.
        let mut chance = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let mut left = MOST_WORK / (1 + self.within.corner_count() / CORNERS);
        for radius in radii {
            let (low, high) = room(radius);
            let free = (0..TRIES.min(left))
                .inspect(|_| left -= 1)
                .map(|_| low + (high - low) * DVec2::new(chance(), chance()))
                .find(|&at| self.within.holds(at, radius) && grid.is_free(at, radius));
            let Some(position) = free else { break };
            grid.insert(Obstacle::Disc { center: position, radius });
            let angle = chance() * std::f64::consts::TAU;
            let (sine, cosine) = libm::sincos(chance() * std::f64::consts::TAU);
            placed.push(Placed { position, angle, velocity: self.speed.si() * DVec2::new(cosine, sine), radius });
        }
        placed
    }
}

/// A disc of one atom, given the density of its material in kg/m2.
pub(super) fn disc(radius: f64, density: f64) -> MassProperties {
    let atom = AtomSpec { offset: DVec2::ZERO, radius, mass: None, stiffness: None };
    mass_properties::of(&[atom], None, InertiaRule::default(), density)
}

/// Cells over the box. Each cell knows the discs that are near enough to touch a body whose centre lies in it. All cells share a
/// few long lists, because memory in many small pieces stays with the program.
struct Grid {
    low: DVec2,
    high: DVec2,
    cell: DVec2,
    columns: usize,
    rows: usize,
    /// Of the largest body, in m.
    radius: f64,
    gap: f64,
    /// Discs of cells, those of each cell in bunches.
    near: Vec<Bunch>,
    /// For each cell the index of its last bunch.
    last: Vec<u32>,
    /// Walls, which affect every cell: two points each.
    walls: Vec<(DVec2, DVec2)>,
    /// Strips: both ends and half the thickness each.
    strips: Vec<(DVec2, DVec2, f64)>,
}

/// No bunch.
const NONE: u32 = u32::MAX;

/// A few discs of one cell side by side in memory: centre and radius of each.
#[derive(Default)]
struct Bunch {
    discs: [(DVec2, f64); 4],
    count: usize,
    /// The place of the next bunch of the cell.
    next: u32,
}

impl Grid {
    /// A grid for a box from its lower left to its upper right corner. At most `standing` bodies of this radius stand in it in
    /// the end. It has at most `2 sqrt(standing)` cells along a side, so at most four cells for each body.
    fn new((low, high): (DVec2, DVec2), radius: f64, gap: f64, standing: u64) -> Self {
        let size = high - low;
        let most = ((4.0 * standing as f64).sqrt() as usize).clamp(1, CELLS);
        let count = |length: f64| ((length / (2.0 * radius + gap)) as usize).clamp(1, most);
        let (columns, rows) = (count(size.x), count(size.y));
        let cell = size / DVec2::new(columns as f64, rows as f64);
        let last = vec![NONE; columns * rows];
        let (near, walls, strips) = Default::default();
        Self { low, high, cell, columns, rows, radius, gap, near, last, walls, strips }
    }

    fn column_and_row(&self, at: DVec2) -> (usize, usize) {
        let place = ((at - self.low) / self.cell).max(DVec2::ZERO);
        ((place.x as usize).min(self.columns - 1), (place.y as usize).min(self.rows - 1))
    }

    fn insert(&mut self, obstacle: Obstacle) {
        let (center, radius) = match obstacle {
            Obstacle::Disc { center, radius } => (center, radius),
            Obstacle::Wall { left, right } => return self.walls.push((left, right)),
            Obstacle::Strip { from, to, radius } => return self.strips.push((from, to, radius)),
        };
        let reach = radius + self.radius + self.gap;
        let (low, high) = (center - reach, center + reach);
        // A body far outside the box affects none of its cells.
        if low.x > self.high.x || low.y > self.high.y || high.x < self.low.x || high.y < self.low.y {
            return;
        }
        let ((first_column, first_row), (last_column, last_row)) =
            (self.column_and_row(low), self.column_and_row(high));
        for row in first_row..=last_row {
            for column in first_column..=last_column {
                let last = &mut self.last[row * self.columns + column];
                if self.near.get(*last as usize).is_none_or(|bunch| bunch.count == bunch.discs.len()) {
                    self.near.push(Bunch { next: *last, ..Bunch::default() });
                    *last = self.near.len() as u32 - 1;
                }
                let bunch = &mut self.near[*last as usize];
                bunch.discs[bunch.count] = (center, radius);
                bunch.count += 1;
            }
        }
    }

    /// Whether a body of this radius touches nothing at a place.
    fn is_free(&self, at: DVec2, own: f64) -> bool {
        let (column, row) = self.column_and_row(at);
        let clear_of_wall = |&(left, right): &(DVec2, DVec2)| {
            // The open side is on the left of the way from the right point to the left point.
            let along = left - right;
            // A wall without length is reported by its own check, and keeps no body away here.
            along.perp().dot(at - right) >= own * along.length()
        };
        let clear_of_strip = |&(from, to, radius): &(DVec2, DVec2, f64)| {
            let along = to - from;
            let share = ((at - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let gap = (from + along * share).distance(at);
            // A strip without length is reported by its own check, too. Its share is NaN.
            gap.is_nan() || gap >= radius + own
        };
        self.walls.iter().all(clear_of_wall)
            && self.strips.iter().all(clear_of_strip)
            && self
                .discs_of(row * self.columns + column)
                .all(|(center, radius)| center.distance(at) >= radius + own + self.gap)
    }

    fn discs_of(&self, cell: usize) -> impl Iterator<Item = (DVec2, f64)> {
        let first = self.near.get(self.last[cell] as usize);
        let bunches = std::iter::successors(first, |bunch| self.near.get(bunch.next as usize));
        bunches.flat_map(|bunch| bunch.discs[..bunch.count].iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::units::LengthPair;
    use crate::shapes::disc::OneDisc;

    fn gas(count: u64, radius: f64) -> FillSection {
        let disc = OneDisc { radius: Length::new(radius), mass: None, stiffness: None };
        FillSection(vec![FillEntry {
            name: "gas".into(),
            atoms: Some(AtomShape::Disc(disc)),
            shape: None,
            radius: None,
            material: None,
            count: WholeNumber(count),
            within: vec![LengthPair::new(0.0, 0.0), LengthPair::new(2.0, 1.0)].into(),
            speed: Speed::new(3.0),
            seed: WholeNumber(7),
            gap: Length::default(),
        }])
    }

    #[test]
    fn nothing_touches_anything() {
        let mut outline = Outline::new();
        outline.occupy(Obstacle::Disc { center: DVec2::new(1.0, 0.5), radius: 0.3 });
        outline.occupy(Obstacle::Wall { left: DVec2::new(2.0, 0.2), right: DVec2::new(0.0, 0.2) });
        let placed = gas(200, 0.02).place(&outline).remove(0);
        assert_eq!(placed.len(), 200);
        for (index, body) in placed.iter().enumerate() {
            let DVec2 { x, y } = body.position;
            assert!((0.02..=1.98).contains(&x) && (0.22..=0.98).contains(&y), "{body:?}");
            assert!(body.position.distance(DVec2::new(1.0, 0.5)) >= 0.32);
            assert!(placed[..index].iter().all(|other| other.position.distance(body.position) >= 0.04));
            assert!((body.velocity.length() - 3.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_gap_keeps_bodies_apart_but_not_from_walls() {
        let mut outline = Outline::new();
        outline.occupy(Obstacle::Disc { center: DVec2::new(1.0, 0.5), radius: 0.3 });
        let mut section = gas(100, 0.02);
        section.0[0].gap = Length::new(0.05);
        let placed = section.place(&outline).remove(0);
        assert_eq!(placed.len(), 100);
        for (index, body) in placed.iter().enumerate() {
            assert!(body.position.distance(DVec2::new(1.0, 0.5)) >= 0.37);
            assert!(placed[..index].iter().all(|other| other.position.distance(body.position) >= 0.09));
        }
        // If the room were 7 cm less on each side, the border would lack some bodies.
        assert!(placed.iter().any(|body| body.position.y < 0.07));
    }

    /// Neither many walls nor many entries may take memory and time for empty cells.
    #[test]
    fn a_grid_is_not_much_larger_than_what_stands_in_it() {
        let mut grid = Grid::new((DVec2::ZERO, DVec2::splat(1e3)), 1e-3, 0.0, 10);
        assert_eq!(grid.last.len(), 36);
        for _ in 0..1000 {
            grid.insert(Obstacle::Wall { left: DVec2::X, right: DVec2::ZERO });
        }
        assert!(grid.near.is_empty());
        assert!(grid.is_free(DVec2::new(5.0, 1e-3), 1e-3) && !grid.is_free(DVec2::new(5.0, 0.9e-3), 1e-3));
    }

    #[test]
    fn the_seed_decides() {
        let outline = Outline::new();
        let first = gas(50, 0.02).place(&outline);
        assert_eq!(first, gas(50, 0.02).place(&outline));
        let mut other = gas(50, 0.02);
        other.0[0].seed = WholeNumber(8);
        assert_ne!(first, other.place(&outline));
    }

    #[test]
    fn a_full_box_is_reported() {
        let mut report = Diagnostics::new();
        gas(100_000, 0.1).check(&Outline::new(), &mut report);
        let problem = &report.problems()[0];
        assert_eq!(problem.path, "[0].count");
        assert!(problem.message.starts_with("only ") && problem.message.contains(" of 100000 bodies find room"));
        let mut report = Diagnostics::new();
        gas(1, 0.51).check(&Outline::new(), &mut report);
        assert!(report.problems()[0].message.starts_with("only 0 of 1 bodies"));
    }
}
