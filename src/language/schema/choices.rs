//! The possible values of a field, such as the shapes of a body, from their definition in the schema.

use serde_json::Value;

use super::Language;

/// One value that may be chosen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Its name.
    pub name: String,
    /// One as it stands in a scene.
    pub example: String,
    /// Its meaning.
    pub meaning: String,
}

impl Language {
    /// The values of a definition, in its order; none if there is no such definition. Their descriptions begin with an example:
    /// `Disc(radius: 0.2)`, a colon and the meaning.
    pub fn choices(&self, definition: &str) -> Vec<Choice> {
        let one_of = self.definitions.get(definition).and_then(|about| about["oneOf"].as_array());
        one_of.into_iter().flatten().filter_map(choice).collect()
    }
}

pub(super) fn choice(about: &Value) -> Option<Choice> {
    let name = about["required"][0].as_str().or_else(|| about["const"].as_str())?;
    let told = about["description"].as_str().unwrap_or_default();
    let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
    let (example, meaning) = told.strip_prefix('`').and_then(|rest| rest.split_once("`: ")).unwrap_or((name, &told));
    Some(Choice { name: name.to_owned(), example: example.to_owned(), meaning: meaning.to_owned() })
}
