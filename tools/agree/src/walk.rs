//! Values drawn from a schema. Numbers follow from their dimension (`ranges.rs`), names are those of the scene so far.
//!
//! A drawn value has the form that the schema asks for. The schema does not tell all conditions, such as two fields that
//! exclude each other. The reader then refuses, and the caller draws again.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::chance::Chance;
use crate::language::{Language, alternatives, example_of_choice, item};
use crate::ranges::{self, Wanted};
use crate::written::Written;

/// Share of optional fields that are drawn.
const OPTIONAL: f64 = 0.25;
/// The share of ends at the world, where the world may be an end.
const WORLD: f64 = 0.4;
/// Values within values, at most: a compound may hold a compound.
const DEEPEST: usize = 12;

/// Names that a scene has so far.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Bodies, in the order in which they were put into the scene.
    pub bodies: Vec<String>,
    /// Walls.
    pub walls: Vec<String>,
    /// Materials.
    pub materials: Vec<String>,
    /// Joints.
    pub joints: Vec<String>,
}

/// Draws values.
pub struct Walk<'a> {
    /// The language.
    pub language: &'a Language,
    /// The chance of the scene.
    pub chance: &'a mut Chance,
    /// Names to refer to.
    pub names: &'a Names,
    /// The name of the value itself, if it has one.
    pub own_name: String,
    /// The length of the run in s: times lie inside.
    pub duration: f64,
    /// The fields that were drawn, as `Definition.field`, and choices, as `Definition|Choice`.
    pub drawn: BTreeSet<String>,
}

/// The place of a value.
#[derive(Clone)]
struct Place {
    /// The definition, or the section and entry, to whose fields it belongs.
    within: String,
    /// The name of the field.
    field: String,
    /// The description of the field.
    told: String,
    /// Its value in an example.
    example: Value,
    /// Whether it is one of two values with directions.
    directed: bool,
    /// The moment in s that a time has to exceed, in a list of moments.
    after: Option<f64>,
    depth: usize,
}

/// The fields that are not drawn, and the reason.
const NOT_DRAWN: [(&str, &str); 8] = [
    ("Material.color", "no physics"),
    ("Atoms|Png", "needs a file"),
    ("Shape|Svg", "needs a file"),
    ("Course|Csv", "needs a file"),
    ("heights|file", "needs a file"),
    ("Body.name", "the scene gives names"),
    ("Wall.name", "the scene gives names"),
    ("Body.datum", "places of anchors count from another point then"),
];

/// Whether a field or choice is left out of scenes.
pub fn is_left_out(path: &str) -> bool {
    NOT_DRAWN.iter().any(|(left_out, _)| *left_out == path)
}

impl Walk<'_> {
    /// An entry of a section that takes several kinds, such as a force: `Drag(..)`. `None` if the scene has nothing to
    /// which it could refer.
    pub fn entry(&mut self, section: &str, name: &str) -> Option<Written> {
        let schema = self.language.kind(section, name);
        let example = self.language.examples.get(&format!("{section}.{name}")).cloned().unwrap_or_default();
        self.drawn.insert(format!("{section}|{name}"));
        let inner = self.value(schema, &Place::new(section, name, example))?;
        Some(Written::Named(name.to_owned(), Box::new(inner)))
    }

    /// A value of a definition, such as a body.
    pub fn definition(&mut self, name: &str, example: Value) -> Option<Written> {
        let schema = serde_json::json!({ "$ref": format!("#/$defs/{name}") });
        self.value(&schema, &Place::new(name, "", example))
    }

    /// A whole section that takes no kinds of entries.
    pub fn section(&mut self, name: &str) -> Option<Written> {
        let example = self.language.examples.get(name).cloned().unwrap_or_default();
        self.value(self.language.section(name), &Place::new(name, "", example))
    }

    fn value(&mut self, schema: &Value, place: &Place) -> Option<Written> {
        let language = self.language;
        let (name, about) = language.resolve(schema);
        let mut place = Place { depth: place.depth + 1, ..place.clone() };
        if place.depth > DEEPEST {
            return None;
        }
        if let Some(told) =
            schema["description"].as_str().or_else(|| about["description"].as_str().filter(|_| place.told.is_empty()))
        {
            place.told = told.to_owned();
        }
        if let Some(name) = name.filter(|_| about["properties"].is_object() || about["oneOf"].is_array()) {
            name.clone_into(&mut place.within);
        }
        if about["oneOf"].is_array() {
            return self.choice(about, &place);
        }
        if about["anyOf"].is_array() {
            let several: Vec<&Value> = alternatives(about).into_iter().filter(|part| !needs_file(part)).collect();
            let chosen = *self.chance.pick(&several)?;
            return self.value(chosen, &place);
        }
        if let Some(words) = about["enum"].as_array() {
            return Some(Written::Bare(self.chance.pick(words)?.as_str()?.to_owned()));
        }
        if let Some(word) = about["const"].as_str() {
            return Some(Written::Bare(word.to_owned()));
        }
        if about["minProperties"] == 1 && about["maxProperties"] == 1 {
            let kinds: Vec<String> = about["properties"].as_object()?.keys().cloned().collect();
            let kind = self.chance.pick(&kinds)?.clone();
            let inner = self.value(&about["properties"][&kind], &place)?;
            return Some(Written::Named(kind, Box::new(inner)));
        }
        if about["properties"].is_object() {
            return self.fields(about, &place);
        }
        if let Some(parts) = about["prefixItems"].as_array() {
            return self.tuple(parts, &place);
        }
        if about["additionalProperties"].is_object() {
            let value = self.value(&about["additionalProperties"], &place)?;
            return Some(Written::Map(vec![("m".to_owned(), value)]));
        }
        match type_of(about) {
            "array" => self.list(about, &place),
            "boolean" => Some(Written::Bare(self.chance.happens(0.5).to_string())),
            "string" => self.name(about, &place),
            "number" => Some(self.number(dimension(name, about), &place)),
            "integer" => Some(Written::Bare(format!("{}", self.plain("whole", &place).round()))),
            // The value of a controller: the schema leaves it open, because it is a number or a course.
            _ if self.chance.happens(0.5) => Some(self.number("number", &place)),
            _ => self.definition("Course", Value::Null),
        }
    }

    fn choice(&mut self, about: &Value, place: &Place) -> Option<Written> {
        let all = about["oneOf"].as_array()?;
        let path = |choice: &Value| format!("{}|{}", place.within, name_of(choice).unwrap_or_default());
        let several: Vec<&Value> = all.iter().filter(|choice| !is_left_out(&path(choice))).collect();
        let chosen = *self.chance.pick(&several)?;
        self.drawn.insert(path(chosen));
        let name = name_of(chosen)?.to_owned();
        if chosen["const"].is_string() {
            return Some(Written::Bare(name));
        }
        let example = example_of_choice(chosen).map_or(Value::Null, |example| example[&name].clone());
        let within = format!("{}|{name}", place.within);
        let inner = Place { within, field: name.clone(), example, told: String::new(), ..place.clone() };
        Some(Written::Named(name.clone(), Box::new(self.value(&chosen["properties"][&name], &inner)?)))
    }

    fn fields(&mut self, about: &Value, place: &Place) -> Option<Written> {
        let needed = |name: &str| about["required"].as_array().is_some_and(|all| all.iter().any(|one| one == name));
        let mut fields = Vec::new();
        for (name, schema) in about["properties"].as_object()? {
            let path = format!("{}.{name}", place.within);
            if name == "name" && !self.own_name.is_empty() {
                fields.push((name.clone(), Written::text(&self.own_name)));
                self.drawn.insert(path);
                continue;
            }
            if is_left_out(&path) || !needed(name) && !self.chance.happens(OPTIONAL) {
                continue;
            }
            let inner = Place {
                field: name.clone(),
                example: place.example[name].clone(),
                told: String::new(),
                ..place.clone()
            };
            match self.value(schema, &inner) {
                Some(value) => fields.push((name.clone(), value)),
                None if needed(name) => return None,
                None => continue,
            }
            self.drawn.insert(path);
        }
        Some(Written::Fields(fields))
    }

    /// Parts of a vector have directions, and least and greatest values stand around zero.
    fn tuple(&mut self, parts: &[Value], place: &Place) -> Option<Written> {
        let is_range = place.told.contains("Least and greatest");
        let same = parts.windows(2).all(|pair| pair[0] == pair[1]);
        let mut written = Vec::new();
        for (index, part) in parts.iter().enumerate() {
            let example = place.example[index].clone();
            let told = if same { place.told.clone() } else { String::new() };
            let inner = Place { example, told, directed: same && !is_range, ..place.clone() };
            let mut value = self.value(part, &inner)?;
            // A vector of length zero does nothing.
            while inner.directed
                && index > 0
                && [written.last(), Some(&value)].iter().all(|part| part.and_then(Written::number) == Some(0.0))
            {
                value = self.value(part, &inner)?;
            }
            if let (true, Some(number)) = (is_range, value.number()) {
                value = Written::exactly(if index == 0 { -number.abs() } else { number.abs() });
            }
            written.push(value);
        }
        Some(Written::Tuple(written))
    }

    /// A list of two to four items; times in it ascend, and so do places from left to right.
    fn list(&mut self, about: &Value, place: &Place) -> Option<Written> {
        if type_of(item(about)) == "string" && about["type"].is_array() && self.chance.happens(0.5) {
            return self.name(about, place);
        }
        let count = 2 + self.chance.below(3);
        let mut written: Vec<Written> = Vec::new();
        let mut after = Some(0.0);
        for index in 0..count {
            let inner = Place { example: place.example[index].clone(), after, ..place.clone() };
            let value = self.value(item(about), &inner)?;
            let time = value.field("time").cloned().or_else(|| match &value {
                Written::Tuple(items) => items.first().cloned(),
                _ => None,
            });
            after = time.and_then(|time| time.number()).or(after);
            if !(matches!(value, Written::Text(_)) && written.contains(&value)) {
                written.push(value);
            }
        }
        if place.told.contains("from left to right") || place.told.contains("open to the left") {
            written.sort_by(|a, b| a.numbers().partial_cmp(&b.numbers()).unwrap_or(std::cmp::Ordering::Equal));
        }
        Some(Written::List(written))
    }

    fn number(&mut self, dimension: &str, place: &Place) -> Written {
        if dimension == "time" {
            let step = if place.told.contains("Default: 0.") { 0.1 } else { 0.3 };
            let (after, step) = place.after.map_or((0.0, 2.0 * step), |after| (after, step));
            return Written::rounded(after + self.chance.between(0.02, step) * self.duration);
        }
        Written::rounded(self.plain(dimension, place))
    }

    fn plain(&mut self, dimension: &str, place: &Place) -> f64 {
        let example = place.example.as_f64().or_else(|| ranges::with_unit(place.example.as_str()?));
        let wanted = Wanted { dimension, told: &place.told, example, directed: place.directed };
        ranges::draw(&wanted, self.chance)
    }

    /// A name of the kind that the description tells, or the text of the example.
    fn name(&mut self, about: &Value, place: &Place) -> Option<Written> {
        let told = place.told.to_lowercase();
        let fields = ["joint", "hinge"];
        if place.field == "name" {
            return None;
        }
        if told.contains("group") {
            return Some(Written::text(self.chance.pick(&["left", "right"])?));
        }
        if told.contains("material") {
            return Some(Written::text(self.chance.pick(&self.names.materials)?));
        }
        if fields.iter().any(|kind| told.contains(kind)) {
            return Some(Written::text(self.chance.pick(&self.names.joints)?));
        }
        if told.contains("`world`") && self.chance.happens(WORLD) {
            return Some(Written::Bare("World".to_owned()));
        }
        if told.contains("bod") {
            if about["type"].is_array() && self.chance.happens(0.1) {
                return Some(Written::text("*"));
            }
            return Some(Written::text(self.chance.pick(&self.names.bodies)?));
        }
        // Such as the rows of a picture.
        place.example.as_str().map(Written::text)
    }
}

impl Place {
    fn new(within: &str, field: &str, example: Value) -> Self {
        let (within, field, told) = (within.to_owned(), field.to_owned(), String::new());
        Self { within, field, told, example, directed: false, after: None, depth: 0 }
    }
}

/// The first of the types that a schema allows: beside it, numbers may be texts.
fn type_of(about: &Value) -> &str {
    let kind = &about["type"];
    let several = kind.as_array();
    match several {
        Some(several) if several.iter().any(|kind| kind == "array") => "array",
        Some(several) => several.first().and_then(Value::as_str).unwrap_or_default(),
        None => kind.as_str().unwrap_or_default(),
    }
}

/// The dimension of a number: the name of its definition.
fn dimension<'a>(name: Option<&'a str>, _: &Value) -> &'a str {
    name.unwrap_or("number")
}

/// The name of a choice.
fn name_of(choice: &Value) -> Option<&str> {
    choice["const"].as_str().or_else(|| choice["required"][0].as_str())
}

/// Whether a value names a file, or a function of a place, which scenes of chance do not have.
fn needs_file(schema: &Value) -> bool {
    let has = |name: &str| schema["properties"].get(name).is_some();
    has("file") || has("of") && has("pieces")
}

/// All fields and choices that the generator may draw below a schema, as in [`Walk::drawn`].
pub fn possible(language: &Language, schema: &Value, within: &str, found: &mut BTreeSet<String>) {
    let (name, about) = language.resolve(schema);
    let within = name.unwrap_or(within).to_owned();
    if let Some(choices) = about["oneOf"].as_array() {
        for choice in choices {
            let name = name_of(choice).unwrap_or_default();
            let path = format!("{within}|{name}");
            if is_left_out(&path) || !found.insert(path.clone()) {
                continue;
            }
            if choice["properties"].is_object() {
                possible(language, &choice["properties"][name], &path, found);
            }
        }
        return;
    }
    for part in alternatives(about).into_iter().filter(|part| about["anyOf"].is_array() && !needs_file(part)) {
        possible(language, part, &within, found);
    }
    for (field, schema) in about["properties"].as_object().into_iter().flatten() {
        let path = format!("{within}.{field}");
        if !is_left_out(&path) && found.insert(path) {
            possible(language, schema, &within, found);
        }
    }
    for part in about["prefixItems"].as_array().into_iter().flatten() {
        possible(language, part, &within, found);
    }
    if about["items"].is_object() {
        possible(language, item(about), &within, found);
    }
    if about["additionalProperties"].is_object() {
        possible(language, &about["additionalProperties"], &within, found);
    }
}
