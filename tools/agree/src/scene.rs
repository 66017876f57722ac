//! Random scenes: a ground, bodies on it or above it, and loads. Values come from the schema (`walk.rs`); only places
//! are chosen here, so that bodies touch and do not overlap.
//!
//! Half of the bodies begin at rest on the things below them. Forces, joints and controllers then load them.

use std::collections::{BTreeMap, BTreeSet};

use jostle::Simulation;
use jostle::scene::Source;
use jostle::sensors;
use jostle::simulation::Overrides;

use crate::chance::Chance;
use crate::language::Language;
use crate::walk::{Names, Walk, possible};
use crate::written::{Written, scene as written_scene};

/// Draws of an entry until the reader accepts one.
const TRIES: usize = 10;
/// Moments at which runs are compared are this far apart, in s: a whole number of usual ticks.
pub const MOMENT: f64 = 0.01;
/// The gap in m at which bodies touch.
const TOUCH: f64 = 1e-12;
/// Steps of a body that is put down, at most.
const STEPS: usize = 20;

/// A body for a scene that has none yet.
const PROBE: &str = "bodies: [(name: \"probe\", at: (0, 1), atoms: Disc(radius: 0.1))], ";

/// The sections from which scenes are drawn.
pub const SECTIONS: [&str; 9] =
    ["gravity", "contacts", "materials", "pairs", "walls", "bodies", "forces", "joints", "controllers"];

/// Sections that take no part, and the reason.
pub const LEFT_OUT: [(&str, &str); 14] = [
    ("format", "the version of the language"),
    ("title", "no physics"),
    ("notes", "no physics"),
    ("clock", "the ways in which a scene runs"),
    ("film", "no physics"),
    ("look", "no physics"),
    ("plots", "no physics"),
    ("camera", "no physics"),
    ("sensors", "no physics"),
    ("expect", "no physics"),
    ("packings", "a file with many bodies"),
    ("fill", "many bodies, whose places no two runs share for long"),
    ("include", "text of other sections"),
    ("params", "text of other sections"),
];
/// The same for sections that make text of other sections.
pub const MADE: [&str; 2] = ["templates", "instances"];

/// A scene, and how it was drawn.
pub struct Drawn {
    /// Its sections in order.
    pub sections: Vec<(String, Written)>,
    /// The fields and choices in it.
    pub fields: BTreeSet<String>,
    /// Draws of items and refusals, by section.
    pub counts: BTreeMap<&'static str, (u64, u64)>,
}

impl Drawn {
    /// Its text.
    pub fn text(&self) -> String {
        written_scene(&self.sections)
    }
}

/// Whether the reader accepts a scene.
pub fn accepts(sections: &[(String, Written)]) -> bool {
    let untried = Overrides { untried: true, ..Overrides::default() };
    let mut text = written_scene(sections);
    if !sections.iter().any(|(name, _)| name == "bodies") {
        // No scene is without bodies.
        text.insert_str("Scene(".len(), PROBE);
    }
    Simulation::load_with(&Source::new("drawn.ron", &text), &untried, |_| {}).is_ok()
}

/// Scene `number` of a seed. It takes at most `longest` seconds.
pub fn scene(language: &Language, (seed, number): (u64, u64), longest: f64) -> Drawn {
    let mut chance = Chance::new(seed, number);
    let moments = (chance.scale(0.1, longest.max(0.1)) / (8.0 * MOMENT)).floor().max(1.0) * 8.0;
    let duration = moments * MOMENT;
    let duration = (duration * 100.0).round() / 100.0;
    let clock = Written::Fields(vec![("duration".to_owned(), Written::exactly(duration))]);
    let film = Written::Fields(vec![("fps".to_owned(), Written::exactly(1.0 / MOMENT))]);
    let sections = [("format", Written::Bare("1".to_owned())), ("clock", clock), ("film", film)];
    let sections = sections.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    let drawn = Drawn { sections, fields: BTreeSet::new(), counts: BTreeMap::new() };
    let mut maker = Maker { language, chance, drawn, names: Names::default(), duration };
    maker.everywhere();
    let grounded = maker.ground();
    let bodies = 1 + maker.chance.below(4).min(maker.chance.below(4));
    for _ in 0..bodies {
        maker.body(grounded);
    }
    let (forces, joints) = (1 + maker.chance.below(2), maker.chance.below(8).saturating_sub(4));
    for _ in 0..joints {
        maker.entry("joints");
    }
    for _ in 0..forces {
        maker.entry("forces");
    }
    if !maker.names.joints.is_empty() {
        for _ in 0..maker.chance.below(3) {
            maker.entry("controllers");
        }
    }
    maker.drawn
}

struct Maker<'a> {
    language: &'a Language,
    chance: Chance,
    drawn: Drawn,
    names: Names,
    duration: f64,
}

impl Maker<'_> {
    /// Draws a value by the schema; the fields in it stand beside it.
    fn walk(
        &mut self,
        own_name: &str,
        draw: impl FnOnce(&mut Walk) -> Option<Written>,
    ) -> Option<(Written, BTreeSet<String>)> {
        let mut walk = Walk {
            language: self.language,
            chance: &mut self.chance,
            names: &self.names,
            own_name: own_name.to_owned(),
            duration: self.duration,
            drawn: BTreeSet::new(),
        };
        let value = draw(&mut walk)?;
        Some((value, walk.drawn))
    }

    fn example(&self, section: &str) -> serde_json::Value {
        let example = self.language.examples.get(section).cloned().unwrap_or_default();
        example.as_object().and_then(|map| map.values().next().cloned()).unwrap_or_else(|| example[0].clone())
    }

    /// The scene with one more item in a section.
    fn with(&self, section: &str, item: &Written) -> Vec<(String, Written)> {
        let mut sections = self.drawn.sections.clone();
        match sections.iter_mut().find(|(name, _)| name == section) {
            Some((_, Written::List(items))) => items.push(item.clone()),
            _ => sections.push((section.to_owned(), Written::List(vec![item.clone()]))),
        }
        sections
    }

    /// Adds what the reader accepts; says whether it does.
    fn add(&mut self, section: &'static str, sections: Vec<(String, Written)>, fields: BTreeSet<String>) -> bool {
        let count = self.drawn.counts.entry(section).or_default();
        count.0 += 1;
        let good = accepts(&sections);
        if good {
            self.drawn.sections = sections;
            self.drawn.fields.extend(fields);
        } else {
            count.1 += 1;
        }
        good
    }

    fn set(&mut self, section: &'static str, value: Written, fields: BTreeSet<String>) -> bool {
        let mut sections = self.drawn.sections.clone();
        sections.push((section.to_owned(), value));
        self.add(section, sections, fields)
    }

    /// Gravity, the laws of contacts, and materials.
    fn everywhere(&mut self) {
        if self.chance.happens(0.85) {
            self.set("gravity", Written::pair(0.0, -9.81), BTreeSet::new());
        } else if let Some((gravity, fields)) =
            self.walk("", |walk| walk.definition("GravitySection", serde_json::Value::Null))
        {
            self.set("gravity", gravity, fields);
        }
        if self.chance.happens(0.4) {
            for _ in 0..TRIES {
                let kinds = self.kinds("contacts");
                let Some(kind) = self.chance.pick(&kinds).cloned() else { break };
                let law = self.walk("", |walk| walk.entry("contacts", &kind));
                if law.is_some_and(|(law, fields)| self.set("contacts", law, fields)) {
                    break;
                }
            }
        }
        let mut materials = Vec::new();
        for name in ["m", "n"].into_iter().take(1 + self.chance.below(2)) {
            let example = self.example("materials");
            let Some((mut material, fields)) = self.walk("", |walk| walk.definition("Material", example)) else {
                continue;
            };
            if material.field("friction").is_none() && self.chance.happens(0.8) {
                material.set("friction", Written::rounded(self.chance.scale(0.1, 1.2)));
            }
            if material.field("stiffness").is_none() {
                material.set("stiffness", Written::rounded(self.chance.scale(1e4, 1e6)));
            }
            if material.field("density").is_none() {
                material.set("density", Written::rounded(self.chance.scale(10.0, 150.0)));
            }
            if material.field("inelasticity").is_none() && self.chance.happens(0.7) {
                material.set("restitution", Written::rounded(self.chance.between(0.0, 0.9)));
            }
            let mut more = materials.clone();
            more.push((name.to_owned(), material));
            let mut sections = self.drawn.sections.clone();
            sections.retain(|(name, _)| name != "materials");
            sections.push(("materials".to_owned(), Written::Map(more.clone())));
            if self.add("materials", sections, fields) {
                materials = more;
                self.names.materials.push(name.to_owned());
            }
        }
        if self.names.materials.is_empty() {
            self.names.materials.push("default".to_owned());
        }
        if self.chance.happens(0.3) {
            let pair = self.walk("", |walk| walk.definition("Pair", serde_json::Value::Null));
            if let Some((pair, fields)) = pair {
                let sections = self.with("pairs", &pair);
                self.add("pairs", sections, fields);
            }
        }
    }

    /// The names of the entries of a section.
    fn kinds(&self, section: &str) -> Vec<String> {
        let prefix = format!("{section}.");
        self.language.examples.keys().filter_map(|name| name.strip_prefix(&prefix).map(str::to_owned)).collect()
    }

    /// Makes the ground of the bodies: a wall, a table that moves, or nothing.
    fn ground(&mut self) -> bool {
        let share = self.chance.between(0.0, 1.0);
        if share < 0.1 {
            return false;
        }
        if share < 0.3 {
            return self.table();
        }
        let walls = if self.chance.happens(0.3) { 2 } else { 1 };
        (0..walls).map(|index| self.wall(index)).fold(false, |any, wall| wall | any)
    }

    fn wall(&mut self, index: usize) -> bool {
        let name = format!("wall{index}");
        for _ in 0..TRIES {
            let Some((all, mut fields)) = self.whole_wall(&name) else { continue };
            let tilt = if self.chance.happens(0.6) { 0.0 } else { self.chance.between(-0.5, 0.5) };
            // A second half-plane is a wall to the side.
            let tilt = if index > 0 { self.chance.between(0.8, 1.6) } else { tilt };
            let (x, y) = (tilt.cos(), tilt.sin());
            let place = if index > 0 { 0.8 } else { 0.0 };
            let forms: [&[&str]; 5] = [
                &["left", "right"],
                &["left", "right", "surface_velocity"],
                &["from", "to", "thickness", "sides"],
                &["line"],
                &["heights"],
            ];
            let form = forms[self.chance.below(8).saturating_sub(3)];
            let mut wall = all.clone();
            let own = ["name", "material"];
            if let Some(kept) = wall.fields_mut() {
                kept.retain(|(field, _)| own.contains(&&**field) || form.contains(&&**field));
            }
            fields.retain(|path| {
                path.strip_prefix("Wall.").is_none_or(|field| form.contains(&field) || own.contains(&field))
            });
            let width = 1.0;
            for (field, value) in [
                ("left", Written::pair(place + width * x, width * y)),
                ("right", Written::pair(place, 0.0)),
                ("from", Written::pair(place - width * x, -width * y)),
                ("to", Written::pair(place + width * x, width * y)),
            ] {
                if form.contains(&field) {
                    wall.set(field, value);
                }
            }
            if let Some((speed, _)) = wall.field("surface_velocity").and_then(Written::numbers) {
                wall.set("surface_velocity", Written::pair(speed * x, speed * y));
            }
            for field in ["line", "heights"] {
                if let Some(Written::List(points)) = wall.field(field).cloned() {
                    // As wide as a table, and as high as a step.
                    let wide = |point: &Written| {
                        point.numbers().map_or_else(|| point.clone(), |(x, y)| Written::pair(5.0 * x, 0.5 * y))
                    };
                    wall.set(field, Written::List(points.iter().map(wide).collect()));
                }
            }
            let sections = self.with("walls", &wall);
            if self.add("walls", sections, fields) {
                self.names.walls.push(name);
                return true;
            }
        }
        false
    }

    /// A wall with all fields that a wall may have.
    fn whole_wall(&mut self, name: &str) -> Option<(Written, BTreeSet<String>)> {
        let example = self.example("walls");
        let (mut whole, mut fields) = self.walk(name, |walk| walk.definition("Wall", example.clone()))?;
        for _ in 0..6 {
            let (more, others) = self.walk(name, |walk| walk.definition("Wall", example.clone()))?;
            let Written::Fields(more) = more else { return None };
            for (field, value) in more {
                if whole.field(&field).is_none() {
                    whole.set(&field, value);
                }
            }
            fields.extend(others);
        }
        Some((whole, fields))
    }

    /// A wide box that moves by itself, below all others.
    fn table(&mut self) -> bool {
        for _ in 0..TRIES {
            let Some((motion, fields)) = self.walk("", |walk| walk.definition("Kinematic", serde_json::Value::Null))
            else {
                continue;
            };
            let Some(material) = self.chance.pick(&self.names.materials).cloned() else { return false };
            let shape = Written::Fields(vec![
                ("width".to_owned(), Written::exactly(20.0)),
                ("height".to_owned(), Written::exactly(1.0)),
            ]);
            let table = Written::Fields(vec![
                ("name".to_owned(), Written::text("table")),
                ("at".to_owned(), Written::pair(0.0, -0.5)),
                ("kinematic".to_owned(), motion),
                ("material".to_owned(), Written::text(&material)),
                ("shape".to_owned(), Written::Named("Rectangle".to_owned(), Box::new(shape))),
            ]);
            let sections = self.with("bodies", &table);
            if self.add("bodies", sections, fields) {
                self.names.bodies.push("table".to_owned());
                return true;
            }
        }
        false
    }

    /// A body: put down on the others, or above them.
    fn body(&mut self, grounded: bool) {
        let name = format!("b{}", self.names.bodies.len());
        for _ in 0..TRIES {
            let example = self.example("bodies");
            let Some((mut body, mut fields)) = self.walk(&name, |walk| walk.definition("Body", example)) else {
                continue;
            };
            let lie = grounded && self.chance.happens(0.8);
            if let Some(material) = self.chance.pick(&self.names.materials).cloned() {
                body.set("material", Written::text(&material));
            }
            if body.field("atoms").is_none() && body.field("shape").is_none() {
                let form = if self.chance.happens(0.3) { "Atoms" } else { "Shape" };
                let Some((shape, more)) = self.walk("", |walk| walk.definition(form, serde_json::Value::Null)) else {
                    continue;
                };
                body.set(if form == "Atoms" { "atoms" } else { "shape" }, shape);
                fields.extend(more);
                fields.insert(format!("Body.{}", form.to_lowercase()));
            }
            if lie {
                // Most things lie flat and at rest.
                if self.chance.happens(0.75) {
                    body.remove("angle");
                }
                if self.chance.happens(0.75) {
                    body.remove("velocity");
                    body.remove("spin");
                }
            }
            // Bodies that touch nothing are no load on anything.
            if self.chance.happens(0.7) {
                body.remove("collides");
            }
            for rare in ["fixed", "ignores"] {
                if self.chance.happens(0.6) {
                    body.remove(rare);
                }
            }
            let x = self.chance.between(-0.45, 0.45);
            let Some(at) = self.place(&body, &name, x, lie) else { continue };
            body.set("at", at);
            fields.insert("Body.at".to_owned());
            let kept = |path: &String| path.strip_prefix("Body.").is_none_or(|field| body.field(field).is_some());
            fields.retain(kept);
            let sections = self.with("bodies", &body);
            if self.add("bodies", sections, fields) {
                self.names.bodies.push(name);
                return;
            }
        }
    }

    /// The place of a body above or on all others.
    fn place(&mut self, body: &Written, name: &str, x: f64, lie: bool) -> Option<Written> {
        let others: Vec<String> = self.names.bodies.iter().chain(&self.names.walls).cloned().collect();
        let mut height = if lie { 2.0 } else { self.chance.between(0.1, 0.7) };
        // The height before and its gap, for steps of a secant.
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..STEPS {
            let mut body = body.clone();
            body.set("at", Written::pair(x, height));
            let gap = self.gap(&body, name, &others)?;
            if !lie {
                return (gap > 0.0).then(|| Written::pair(x, height));
            }
            if gap.abs() < TOUCH {
                return Some(Written::pair(x, height));
            }
            let slope = before.map_or(1.0, |(above, other)| (above - height) / (other - gap));
            before = Some((height, gap));
            height -= gap * if slope.is_finite() { slope.clamp(1.0, 10.0) } else { 1.0 };
            if !(height > -2.0 && height.is_finite()) {
                return None;
            }
        }
        None
    }

    /// The least distance of a body from all others, in m; `None` if the reader refuses the scene.
    fn gap(&self, body: &Written, name: &str, others: &[String]) -> Option<f64> {
        let mut sections = self.with("bodies", body);
        let clearance = |(index, other): (usize, &String)| {
            let fields = [("name", format!("gap{index}")), ("a", name.to_owned()), ("b", other.clone())];
            let fields = fields.into_iter().map(|(field, text)| (field.to_owned(), Written::Text(text))).collect();
            Written::Named("Clearance".to_owned(), Box::new(Written::Fields(fields)))
        };
        sections.push(("sensors".to_owned(), Written::List(others.iter().enumerate().map(clearance).collect())));
        let untried = Overrides { untried: true, ..Overrides::default() };
        let source = Source::new("drawn.ron", written_scene(&sections));
        let mut simulation = Simulation::load_with(&source, &untried, |_| {}).ok()?;
        let mut least = f64::INFINITY;
        for index in 0..others.len() {
            let channel = sensors::find(simulation.world_mut(), &format!("gap{index}.clearance"))?;
            least = least.min(simulation.value(&channel));
        }
        Some(if least == f64::INFINITY { 1.0 } else { least })
    }

    /// A force, a joint or a controller.
    fn entry(&mut self, section: &'static str) {
        let mut kinds = self.kinds(section);
        // Loads that change are the harder ones.
        if section == "forces" && self.chance.happens(0.6) {
            kinds.retain(|kind| self.changes(section, kind));
        }
        // Gears between joints need two of them.
        if section == "joints" && self.names.joints.len() > 1 && self.chance.happens(0.7) {
            kinds.retain(|kind| !self.has(section, kind, "a"));
        }
        for _ in 0..TRIES {
            let Some(kind) = self.chance.pick(&kinds).cloned() else { return };
            let name = format!("{section}{}", self.items(section));
            let Some((mut entry, mut fields)) = self.walk(&name, |walk| walk.entry(section, &kind)) else { continue };
            let anchors = fields.iter().any(|path| path.ends_with(".anchor_a"));
            if self.has(section, &kind, "length") {
                self.hang(&mut entry, &kind, &mut fields);
            } else if anchors || section == "joints" && self.chance.happens(0.5) {
                self.close(&mut entry, &kind, &mut fields);
            }
            let sections = self.with(section, &entry);
            if self.add(section, sections, fields) {
                if section == "joints" && entry.field("name").is_some() {
                    self.names.joints.push(name);
                }
                return;
            }
        }
    }

    /// Whether an entry has a field.
    fn has(&self, section: &str, kind: &str, field: &str) -> bool {
        let schema = self.language.kind(section, kind);
        self.language.resolve(schema).1["properties"].get(field).is_some()
    }

    /// Lets what has a length end at a place of the world away from its body.
    fn hang(&mut self, entry: &mut Written, kind: &str, fields: &mut BTreeSet<String>) {
        for (end, other, anchor) in [("a", "b", "anchor_a"), ("b", "a", "anchor_b")] {
            let is_world = entry.field(end).and_then(Written::word) == Some("World");
            let body = entry.field(other).and_then(Written::word).and_then(|body| self.pose(body));
            if let (true, Some((x, y, _))) = (is_world, body) {
                let (dx, dy) = (self.chance.between(-0.4, 0.4), self.chance.between(0.1, 0.6));
                entry.set(anchor, Written::pair(x + dx, y + dy));
                fields.insert(format!("{kind}.{anchor}"));
            }
        }
    }

    /// Whether an entry has times or a course in time.
    fn changes(&self, section: &str, kind: &str) -> bool {
        let mut fields = BTreeSet::new();
        possible(self.language, self.language.kind(section, kind), kind, &mut fields);
        fields.iter().any(|path| path.starts_with("Course|") || path.ends_with(".from") || path.ends_with(".to"))
    }

    fn items(&self, section: &str) -> usize {
        match self.drawn.sections.iter().find(|(name, _)| name == section) {
            Some((_, Written::List(items))) => items.len(),
            _ => 0,
        }
    }

    /// Puts both anchors of a joint at one place of the world. So it is closed at the start.
    fn close(&mut self, entry: &mut Written, kind: &str, fields: &mut BTreeSet<String>) {
        let ends = ["a", "b"].map(|end| entry.field(end).and_then(Written::word).map(str::to_owned));
        let [Some(a), Some(b)] = ends else { return };
        let Some(pose) = self.pose(&b).or_else(|| self.pose(&a)) else { return };
        let reach = [self.chance.between(-0.2, 0.2), self.chance.between(-0.2, 0.2)];
        let pin = (pose.0 + reach[0], pose.1 + reach[1]);
        for (end, anchor) in [(a, "anchor_a"), (b, "anchor_b")] {
            let (x, y, angle) = self.pose(&end).unwrap_or_default();
            let (dx, dy) = (pin.0 - x, pin.1 - y);
            let (cos, sin) = (angle.cos(), angle.sin());
            entry.set(anchor, Written::pair(dx * cos + dy * sin, dy * cos - dx * sin));
            fields.insert(format!("{kind}.{anchor}"));
        }
    }

    /// Place and angle of a body at the start.
    fn pose(&self, name: &str) -> Option<(f64, f64, f64)> {
        let (_, bodies) = self.drawn.sections.iter().find(|(name, _)| name == "bodies")?;
        let Written::List(bodies) = bodies else { return None };
        let body = bodies.iter().find(|body| body.field("name").and_then(Written::word) == Some(name))?;
        let (x, y) = body.field("at")?.numbers()?;
        Some((x, y, body.field("angle").and_then(Written::number).unwrap_or_default()))
    }
}
