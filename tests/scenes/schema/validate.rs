//! As much of JSON schema, draft 2020-12, as the schema of scenes uses. A keyword that is not known here stops the test:
//! nothing is passed over.

use serde_json::Value;

/// What is wrong with a value, each with its place; nothing if it fits.
pub(super) fn complaints(value: &Value, schema: &Value) -> Vec<String> {
    let mut told = Vec::new();
    check(value, schema, schema, "", &mut told);
    told
}

/// Where a schema is none: keywords with a value of another type than theirs, and references that lead nowhere.
pub(super) fn misshapen(schema: &Value) -> Vec<String> {
    let mut told = Vec::new();
    look(schema, schema, "", &mut told);
    told
}

fn look(schema: &Value, root: &Value, place: &str, told: &mut Vec<String>) {
    let keywords = match schema {
        Value::Bool(_) => return,
        Value::Object(keywords) => keywords,
        other => return told.push(format!("{place}: {other} is no schema")),
    };
    let text = |rule: &Value| rule.is_string();
    let several = |rule: &Value| rule.as_array().is_some_and(|list| !list.is_empty());
    for (keyword, rule) in keywords {
        let place = format!("{place}/{keyword}");
        let good = match keyword.as_str() {
            "$schema" | "title" | "description" | "pattern" => text(rule),
            "$ref" => rule.as_str().and_then(|to| root.pointer(to.strip_prefix('#')?)).is_some(),
            "default" | "const" => true,
            "examples" => rule.is_array(),
            "enum" => several(rule),
            "required" => rule.as_array().is_some_and(|list| list.iter().all(text)),
            "type" => match rule {
                Value::Array(kinds) => several(rule) && kinds.iter().all(is_kind),
                kind => is_kind(kind),
            },
            "minimum" | "maximum" | "exclusiveMinimum" | "exclusiveMaximum" => rule.is_number(),
            "minItems" | "maxItems" | "minProperties" | "maxProperties" | "minLength" => rule.is_u64(),
            "items" | "additionalProperties" => {
                look(rule, root, &place, told);
                true
            }
            "properties" | "$defs" => {
                for (name, inner) in rule.as_object().into_iter().flatten() {
                    look(inner, root, &format!("{place}/{name}"), told);
                }
                rule.is_object()
            }
            "prefixItems" | "anyOf" | "oneOf" | "allOf" => {
                for (index, inner) in rule.as_array().into_iter().flatten().enumerate() {
                    look(inner, root, &format!("{place}/{index}"), told);
                }
                several(rule)
            }
            _ => panic!("the keyword `{keyword}` is not known here"),
        };
        if !good {
            told.push(format!("{place}: {rule}"));
        }
    }
}

fn is_kind(kind: &Value) -> bool {
    let kinds = ["null", "boolean", "object", "array", "number", "integer", "string"];
    kind.as_str().is_some_and(|kind| kinds.contains(&kind))
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
