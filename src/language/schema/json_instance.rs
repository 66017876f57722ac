//! A scene in JSON, in the form of the schema.

use serde_json::{Map, Value};

use crate::SceneError;
use crate::lexer::lex;
use crate::syntax::{Form, Id, Tree};

/// A scene in JSON that fits its schema: see [`Language::json`](super::Language::json).
///
/// # Errors
/// The mistake of syntax that hides the rest of the text.
pub fn as_json(text: &str) -> Result<Value, Box<SceneError>> {
    let found = lex(text);
    match found.fault {
        Some(fault) => Err(Box::new(fault)),
        None => Ok(in_json(&found.tree, text, 0)),
    }
}

/// A value of a scene in JSON. `(a: 1)` is `{"a": 1}`, `(1, 2)` is `[1, 2]`, and `Drag(linear: 1)` is `{"Drag":
/// {"linear": 1}}`. The outermost `Scene(..)` becomes the content of its brackets.
fn in_json(tree: &Tree, text: &str, id: Id) -> Value {
    let written = &text[tree.span(id)];
    match tree.node(id).form {
        Form::Number => ron::from_str::<f64>(written).unwrap().into(),
        Form::Text | Form::Character => ron::from_str::<String>(written).unwrap().into(),
        Form::Word => match written {
            "true" => true.into(),
            "false" => false.into(),
            word => word.into(),
        },
        Form::List => items(tree, text, id).into(),
        Form::Braces => fields(tree, text, id, |key| ron::from_str(key).unwrap()),
        Form::Round => {
            let named = |id: &Id| !tree.key(*id).is_empty();
            let content = match tree.children(id) {
                [] => Value::Object(Map::new()),
                [first, ..] if named(first) => fields(tree, text, id, str::to_owned),
                [only] if !tree.name(id, text).is_empty() => in_json(tree, text, *only),
                _ => items(tree, text, id).into(),
            };
            match tree.name(id, text) {
                "" | "Scene" => content,
                name => Value::Object(Map::from_iter([(name.to_owned(), content)])),
            }
        }
    }
}

fn items(tree: &Tree, text: &str, id: Id) -> Vec<Value> {
    tree.children(id).iter().map(|&item| in_json(tree, text, item)).collect()
}

fn fields(tree: &Tree, text: &str, id: Id, name: impl Fn(&str) -> String) -> Value {
    let field = |&child: &Id| (name(&text[tree.key(child)]), in_json(tree, text, child));
    Value::Object(tree.children(id).iter().map(field).collect())
}
