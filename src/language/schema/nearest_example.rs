//! The example of a choice, such as `radius: Uniform(0.01, 0.02)`, that is nearest to a mistake.

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

use super::Describe;
use super::choices::choice;
use crate::explain::Walked;
use crate::syntax::{Form, Id};

/// The example of the innermost field between two values that holds one of several choices, with its name. It is that of the choice in
/// the text, or of the first one. `None` if no such field with an example is on the way.
pub(crate) fn nearest_example(describe: Describe, walked: Walked<'_>, from: Id, to: Id) -> Option<String> {
    let mut way = vec![to];
    while way[way.len() - 1] != from {
        let last = way[way.len() - 1];
        if last == 0 {
            return None;
        }
        way.push(walked.tree.node(last).parent);
    }
    let mut generator = SchemaSettings::draft2020_12().into_generator();
    let whole = Value::from(describe(&mut generator));
    let definitions = generator.take_definitions(true);
    let mut schemas = vec![&whole];
    let mut found = None;
    for &id in way.iter().rev() {
        if id != from {
            schemas = schemas.into_iter().filter_map(|schema| step(walked, schema, id)).collect();
        }
        schemas = schemas.into_iter().flat_map(|schema| alternatives(schema, &definitions)).collect();
        let choices = || schemas.iter().filter_map(|schema| schema["oneOf"].as_array()).flatten();
        let name = walked.tree.name(id, walked.text);
        let key = &walked.text[walked.tree.key(id)];
        let told: Vec<_> = choices().filter_map(choice).filter(|choice| choice.example != choice.name).collect();
        let nearest = told.iter().find(|choice| choice.name == name).or(told.first());
        if let (Some(choice), false) = (nearest, key.is_empty()) {
            found = Some(format!("{key}: {}", choice.example));
        }
        let fields: Vec<&Value> = choices().filter_map(|choice| choice["properties"].get(name)).collect();
        schemas.extend(fields.into_iter().flat_map(|schema| alternatives(schema, &definitions)));
    }
    found
}

/// The schema of a value inside another one.
fn step<'a>(walked: Walked<'_>, schema: &'a Value, id: Id) -> Option<&'a Value> {
    let node = walked.tree.node(id);
    let key = &walked.text[walked.tree.key(id)];
    if key.is_empty() {
        // `Name(value)` is described as the value.
        let items = schema["prefixItems"].get(node.index as usize).or_else(|| schema.get("items"));
        return items.filter(|_| !walked.tree.is_wrapper(node.parent)).or(Some(schema));
    }
    if walked.tree.node(node.parent).form == Form::Braces {
        return schema.get("additionalProperties");
    }
    schema["properties"].get(key)
}

/// A schema without references: itself, or each of those that it leaves open.
fn alternatives<'a>(schema: &'a Value, definitions: &'a Map<String, Value>) -> Vec<&'a Value> {
    let name = schema["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/"));
    let schema = name.and_then(|name| definitions.get(name)).unwrap_or(schema);
    match schema["anyOf"].as_array() {
        Some(several) => several.iter().flat_map(|schema| alternatives(schema, definitions)).collect(),
        None => vec![schema],
    }
}
