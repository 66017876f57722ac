//! The scene language as the registry tells it: the JSON schema of scenes, and one correct use of each name.

use std::collections::BTreeMap;

use bevy_app::App;
use jostle::scene::SceneRegistry;
use jostle::scene::schema::{Language as Told, as_json};
use serde_json::Value;

/// The language of the standard program.
pub struct Language {
    /// The JSON schema that `jostle schema` prints.
    pub schema: Value,
    /// A correct use of each section and entry, in the form of the schema, by `section` or `section.Entry`.
    pub examples: BTreeMap<String, Value>,
}

impl Language {
    /// Asks all standard plugins.
    pub fn standard() -> Self {
        let mut app = App::empty();
        jostle::plugins::standard(&mut app);
        let registry = app.world().resource::<SceneRegistry>();
        let schema = Told::of(registry).json();
        let mut examples = BTreeMap::new();
        for section in registry.sections() {
            // `walls: [..]` is a field of a scene.
            if let Ok(scene) = as_json(&format!("Scene({})", section.example)) {
                examples.insert(section.name.to_owned(), scene[section.name].clone());
            }
            for entry in registry.entries(section.name) {
                if let Ok(example) = as_json(entry.example) {
                    examples.insert(format!("{}.{}", section.name, entry.name), example[entry.name].clone());
                }
            }
        }
        Self { schema, examples }
    }

    /// The definition that a schema refers to, with its name.
    pub fn resolve<'a>(&'a self, schema: &'a Value) -> (Option<&'a str>, &'a Value) {
        let name = schema["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/"));
        let definition = name.and_then(|name| self.schema["$defs"].get(name));
        definition.map_or((None, schema), |definition| (name, definition))
    }

    /// The schema of a section.
    pub fn section(&self, name: &str) -> &Value {
        &self.schema["properties"][name]
    }

    /// The schema of an entry of a section that takes several kinds.
    pub fn kind(&self, section: &str, kind: &str) -> &Value {
        let (_, about) = self.resolve(self.section(section));
        let kinds = if about["type"] == "array" { item(about) } else { alternatives(about)[0] };
        &kinds["properties"][kind]
    }
}

/// The alternatives of a schema that scenes write out: neither repetitions nor names of parameters.
pub fn alternatives(schema: &Value) -> Vec<&Value> {
    let Some(several) = schema["anyOf"].as_array() else { return vec![schema] };
    let is_made = |part: &Value| part["$ref"] == "#/$defs/Repeated";
    let is_text = |part: &Value| part["type"] == "string";
    let written: Vec<&Value> = several.iter().filter(|part| !is_made(part)).collect();
    let structures = written.iter().any(|part| !is_text(part));
    written.into_iter().filter(|part| !(structures && is_text(part))).collect()
}

/// The schema of the items of a list.
pub fn item(list: &Value) -> &Value {
    alternatives(&list["items"]).first().copied().unwrap_or(&Value::Null)
}

/// The first sentence-like piece of a description in backquotes, if it is a value: the example of a choice.
pub fn example_of_choice(choice: &Value) -> Option<Value> {
    let told = choice["description"].as_str()?.strip_prefix('`')?;
    as_json(told.split_once("`: ")?.0).ok()
}
