//! As much of JSON schema, draft 2020-12, as the schema of scenes uses. A keyword that is not known here stops the test:
//! nothing is passed over.

use serde_json::Value;

/// What is wrong with a value, each with its place; nothing if it fits.
pub(super) fn complaints(value: &Value, schema: &Value) -> Vec<String> {
    let mut told = Vec::new();
    check(value, schema, schema, "", &mut told);
    told
}

fn fits(value: &Value, schema: &Value, root: &Value) -> bool {
    let mut told = Vec::new();
    check(value, schema, root, "", &mut told);
    told.is_empty()
}

fn check(value: &Value, schema: &Value, root: &Value, place: &str, told: &mut Vec<String>) {
    let keywords = match schema {
        Value::Bool(true) => return,
        Value::Bool(false) => return told.push(format!("{place}: nothing belongs here")),
        Value::Object(keywords) => keywords,
        other => panic!("{other} is no schema"),
    };
    for (keyword, rule) in keywords {
        let number = rule.as_f64().unwrap_or(f64::NAN);
        let list = value.as_array();
        let object = value.as_object();
        let good = match keyword.as_str() {
            "$schema" | "$defs" | "title" | "description" | "default" | "examples" => true,
            "$ref" => {
                let target = root.pointer(rule.as_str().unwrap().strip_prefix('#').unwrap()).unwrap();
                check(value, target, root, place, told);
                true
            }
            "type" => match rule {
                Value::Array(kinds) => kinds.iter().any(|kind| is_of(value, kind)),
                kind => is_of(value, kind),
            },
            "const" => value == rule,
            "enum" => rule.as_array().unwrap().contains(value),
            "anyOf" => rule.as_array().unwrap().iter().any(|choice| fits(value, choice, root)),
            "oneOf" => rule.as_array().unwrap().iter().filter(|choice| fits(value, choice, root)).count() == 1,
            "minimum" => value.as_f64().is_none_or(|value| value >= number),
            "maximum" => value.as_f64().is_none_or(|value| value <= number),
            "minItems" => list.is_none_or(|list| list.len() as f64 >= number),
            "maxItems" => list.is_none_or(|list| list.len() as f64 <= number),
            "minProperties" => object.is_none_or(|object| object.len() as f64 >= number),
            "maxProperties" => object.is_none_or(|object| object.len() as f64 <= number),
            "required" => {
                let there = |name: &Value| object.is_none_or(|object| object.contains_key(name.as_str().unwrap()));
                rule.as_array().unwrap().iter().all(there)
            }
            "prefixItems" => {
                for (index, (item, rule)) in list.into_iter().flatten().zip(rule.as_array().unwrap()).enumerate() {
                    check(item, rule, root, &format!("{place}[{index}]"), told);
                }
                true
            }
            "items" => {
                let first = keywords.get("prefixItems").and_then(Value::as_array).map_or(0, Vec::len);
                for (index, item) in list.into_iter().flatten().enumerate().skip(first) {
                    check(item, rule, root, &format!("{place}[{index}]"), told);
                }
                true
            }
            "properties" => {
                for (name, value) in object.into_iter().flatten() {
                    if let Some(rule) = rule.get(name) {
                        check(value, rule, root, &format!("{place}.{name}"), told);
                    }
                }
                true
            }
            "additionalProperties" => {
                for (name, value) in object.into_iter().flatten() {
                    if schema["properties"].get(name).is_none() {
                        check(value, rule, root, &format!("{place}.{name}"), told);
                    }
                }
                true
            }
            other => panic!("the keyword {other} is not known here"),
        };
        if !good {
            told.push(format!("{place}: {value} is not {keyword} {rule}"));
        }
    }
}

fn is_of(value: &Value, kind: &Value) -> bool {
    match kind.as_str().unwrap() {
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|value| value.fract() == 0.0),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("the type {other} is not known here"),
    }
}
