//! The description of the scene language as JSON schema ([`Language::json`]) and as the manual ([`Language::manual`]).
//!
//! Both have one source: the types that read the sections and entries, including those of plugins. Fields, words and
//! optional values come from serde's view, and units from the types of quantities. Meanings come from doc comments, and
//! defaults from the sentence `Default: ..` at their end. A run pays nothing for it: only functions are registered, and
//! [`Language::of`] calls them.

mod choices;
mod json;
mod json_instance;
mod kinds;
mod macro_forms;
mod manual;
mod tidy;

pub use choices::Choice;
pub use json_instance::as_json;
pub use manual::anchor;

use schemars::generate::{SchemaGenerator, SchemaSettings};
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value};

use super::registry::{Arity, Reader, Registry};

/// The function that gives the schema of a type.
pub type Describe = fn(&mut SchemaGenerator) -> Schema;

/// The scene language of a program with its plugins.
#[derive(Clone, Debug)]
pub struct Language {
    sections: Vec<Section>,
    /// `Repeat`, which is allowed in any list.
    repeat: Section,
    /// The types that sections and entries refer to, by name.
    definitions: Map<String, Value>,
}

#[derive(Clone, Debug)]
struct Section {
    name: String,
    example: &'static str,
    /// The meaning of a section of entries. A whole section has its own.
    meaning: String,
    content: Content,
}

#[derive(Clone, Debug)]
enum Content {
    /// A value of one type.
    Value(Value),
    Entries(Arity, Vec<Entry>),
}

#[derive(Clone, Debug)]
struct Entry {
    name: &'static str,
    example: &'static str,
    schema: Value,
}

/// The sections that the reader itself reads. The type is only described, never made.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "described, never made")]
struct Head {
    /// The version of the scene language: 1.
    #[schemars(range(min = 1, max = 1))]
    format: u64,
    /// The name of the scene, in the film's corner and on the card. Default: nothing is shown.
    title: Option<String>,
    /// The thing to look for, in a sentence or two. Default: none.
    notes: Option<String>,
}

const HEAD_EXAMPLES: [&str; 3] =
    ["format: 1", "title: \"Five balls\"", "notes: \"Look at the second ball: it hardly moves.\""];

impl Language {
    /// Asks everything that is registered for its schema.
    pub fn of<A>(registry: &Registry<A>) -> Self {
        let mut generator = SchemaSettings::draft2020_12().into_generator();
        let mut tell = |describe: Describe| Value::from(describe(&mut generator));
        let mut sections = Vec::new();
        for (name, section) in registry.readers() {
            let content = match &section.reader {
                Reader::Reserved => continue,
                Reader::Section(_, describe) => Content::Value(tell(*describe)),
                Reader::Entries(arity, entries) => {
                    let mut list: Vec<_> = entries.iter().filter(|(_, entry)| entry.make.is_some()).collect();
                    list.sort_unstable_by_key(|(_, entry)| entry.order);
                    let tell_entry = |(name, entry): (&&'static str, &super::registry::EntryReader<A>)| Entry {
                        name,
                        example: entry.example,
                        schema: tell(entry.describe),
                    };
                    Content::Entries(*arity, list.into_iter().map(tell_entry).collect())
                }
            };
            let meaning = section.meaning.to_owned();
            sections.push(Section { name: name.to_owned(), example: section.example, meaning, content });
        }
        let head = fields(&Value::from(generator.root_schema_for::<Head>()), &HEAD_EXAMPLES);
        let made = fields(&Value::from(generator.root_schema_for::<macro_forms::Made>()), &macro_forms::EXAMPLES);
        let repeat = Section {
            name: "Repeat".to_owned(),
            example: macro_forms::REPEAT_EXAMPLE,
            meaning: String::new(),
            content: Content::Value(generator.subschema_for::<macro_forms::Repeat>().into()),
        };
        let sections = head.into_iter().chain(sections).chain(made).collect();
        let mut language = Self { sections, repeat, definitions: generator.take_definitions(true) };
        tidy::tidy(&mut language, &registry.words);
        language.lead_to_lists_inside();
        language
    }

    /// The sections that no plugin brings, and `Repeat`, each with an example.
    pub fn unregistered<A>(&self, registry: &Registry<A>) -> Vec<(&str, &'static str)> {
        let registered = registry.readers();
        let own = self.sections.iter().filter(|section| registered.iter().all(|(name, _)| *name != section.name));
        own.chain([&self.repeat]).map(|section| (&*section.name, section.example)).collect()
    }

    /// Sections inside sections that are lists of entries, such as `look.layers`, follow the sections that lead to
    /// them.
    fn lead_to_lists_inside(&mut self) {
        let (inside, mut sections): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.sections).into_iter().partition(|section| section.name.contains('.'));
        for list in inside {
            let parent = list.name.split('.').next();
            let index = sections.iter().position(|section| Some(&*section.name) == parent);
            sections.insert(index.map_or(sections.len(), |index| index + 1), list);
        }
        self.sections = sections;
        let inside = self.sections.iter().map(|section| section.name.clone()).filter(|name| name.contains('.'));
        for list in inside.collect::<Vec<_>>() {
            let Some((definition, field)) = self.field_of(&list) else { continue };
            let cell = format!("list of [`{list}`](#{})", manual::anchor(&list));
            self.definitions[&definition]["properties"][field]["x-value"] = cell.into();
        }
    }

    /// The definition, and the field in it, of a list such as `look.layers`.
    fn field_of(&self, list: &str) -> Option<(String, String)> {
        let (section, field) = list.split_once('.')?;
        let section = self.sections.iter().find(|other| other.name == section)?;
        let Content::Value(schema) = &section.content else { return None };
        let (definition, about) = self.resolve(schema);
        about["properties"][field].is_object().then_some((definition?.to_owned(), field.to_owned()))
    }

    /// The definition that `{"$ref": "#/$defs/NAME"}` names, with its name.
    fn resolve<'a>(&'a self, schema: &'a Value) -> (Option<&'a str>, &'a Value) {
        let name = schema["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/"));
        match name.and_then(|name| self.definitions.get(name)) {
            Some(definition) => (name, definition),
            None => (None, schema),
        }
    }

    /// Each schema of a section or entry, and each definition, to be changed.
    fn schemas(&mut self) -> impl Iterator<Item = &mut Value> {
        let sections = self.sections.iter_mut().chain([&mut self.repeat]);
        let of_sections = sections.flat_map(|section| match &mut section.content {
            Content::Value(schema) => vec![schema],
            Content::Entries(_, entries) => entries.iter_mut().map(|entry| &mut entry.schema).collect(),
        });
        of_sections.chain(self.definitions.values_mut())
    }
}

/// The fields of a type as sections.
fn fields(schema: &Value, examples: &[&'static str]) -> Vec<Section> {
    let fields = schema["properties"].as_object().into_iter().flatten().zip(examples);
    let section = |((name, schema), example): ((&String, &Value), &&'static str)| Section {
        name: name.clone(),
        example,
        meaning: String::new(),
        content: Content::Value(schema.clone()),
    };
    fields.map(section).collect()
}
