//! Changes the schema of Rust types by schemars into that of a scene.

use serde_json::{Value, json};

use super::Language;
use crate::outline::Words;

/// Brings every schema of a language into the form that both outputs need:
/// * an optional field is not called null, for it is absent and not written as null;
/// * open lists of words are filled in;
/// * descriptions are one line per paragraph and without links into the program's own documentation.
pub(super) fn tidy(language: &mut Language, words: &Words) {
    for schema in language.schemas() {
        visit(schema, &mut |schema| {
            drop_null(schema);
            fill_words(schema, words);
            clean_description(schema);
        });
    }
}

/// Calls a function for a schema and every schema in it, from the inside out.
pub(super) fn visit(schema: &mut Value, change: &mut impl FnMut(&mut Value)) {
    let Some(map) = schema.as_object_mut() else { return };
    for (key, value) in map.iter_mut() {
        match (key.as_str(), value) {
            ("items" | "additionalProperties", one) => visit(one, change),
            ("properties" | "$defs", Value::Object(several)) => {
                several.values_mut().for_each(|value| visit(value, change));
            }
            ("prefixItems" | "anyOf" | "oneOf" | "allOf", Value::Array(several)) => {
                several.iter_mut().for_each(|value| visit(value, change));
            }
            _ => {}
        }
    }
    change(schema);
}

fn drop_null(schema: &mut Value) {
    let Some(map) = schema.as_object_mut() else { return };
    if map.get("default").is_some_and(Value::is_null) {
        map.shift_remove("default");
    }
    if let Some(Value::Array(types)) = map.get_mut("type") {
        types.retain(|kind| kind != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            map.insert("type".to_owned(), only);
        }
    }
    for list in ["enum", "anyOf", "oneOf"] {
        if let Some(Value::Array(choices)) = map.get_mut(list) {
            choices.retain(|choice| !choice.is_null() && choice["type"] != "null");
            if let ("anyOf" | "oneOf", [only]) = (list, choices.as_slice()) {
                let only = only.clone();
                map.shift_remove(list);
                for (key, value) in only.as_object().into_iter().flatten() {
                    map.entry(key.clone()).or_insert_with(|| value.clone());
                }
            }
        }
    }
    // The bits of a number do not matter in scenes.
    if map.get("type").is_some_and(|kind| kind == "number" || kind == "integer") {
        map.shift_remove("format");
    }
}

/// `"x-words": "color"`: the words of the open list `color`; together with `"x-more"`, a pattern, others too.
fn fill_words(schema: &mut Value, words: &Words) {
    let Some(map) = schema.as_object_mut() else { return };
    let Some(list) = map.get("x-words").and_then(Value::as_str) else { return };
    let all = words.get(list).into_iter().flatten();
    let known: Vec<Value> = all.filter(|(_, here)| **here).map(|(word, _)| json!(word)).collect();
    let key = if map.contains_key("x-more") { "examples" } else { "enum" };
    map.insert(key.to_owned(), Value::Array(known));
}

fn clean_description(schema: &mut Value) {
    let Some(Value::String(text)) = schema.get_mut("description") else { return };
    let paragraphs: Vec<String> = text
        .split("\n\n")
        .map(|paragraph| {
            // A drawing keeps its lines.
            if paragraph.contains("```") { paragraph.to_owned() } else { without_links(&paragraph.replace('\n', " ")) }
        })
        .collect();
    *text = paragraphs.join("\n\n");
}

/// ``[`name`](place)`` and ``[`name`]`` as `` `name` ``.
fn without_links(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some(start) = rest.find("[`") {
        let Some(end) = rest[start..].find("`]").map(|end| start + end) else { break };
        plain.push_str(&rest[..start]);
        plain.push_str(&rest[start + 1..=end]);
        rest = &rest[end + 2..];
        if let (Some(link), Some(close)) = (rest.strip_prefix('('), rest.find(')')) {
            rest = &link[close..];
        }
    }
    plain.push_str(rest);
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_become_words() {
        assert_eq!(without_links("a [`b`](super::b) c, [`d`]: e [0, 1]"), "a `b` c, `d`: e [0, 1]");
        assert_eq!(without_links("`forces: [Drag(..)]`"), "`forces: [Drag(..)]`");
    }

    #[test]
    fn what_may_be_left_out_is_not_null() {
        let mut schema = json!({
            "type": ["string", "null"],
            "default": null,
            "properties": {"a": {"anyOf": [{"$ref": "#/$defs/length"}, {"type": "null"}], "description": "x"}},
        });
        visit(&mut schema, &mut drop_null);
        let wanted = json!({"type": "string", "properties": {"a": {"$ref": "#/$defs/length", "description": "x"}}});
        assert_eq!(schema, wanted);
    }
}
