//! The form of the sections that macros replace, and of `Repeat`. They are read as text
//! ([`expand`](super::super::macros)); the types here only describe them.

use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::Value;

use crate::units::{Angle, Length, LengthPair};
use crate::values::WholeNumber;

/// One correct use of each field of [`Made`], in their order.
pub(super) const EXAMPLES: [&str; 4] = [
    "include: [(file: \"parts/arm.ron\", prefix: \"a\", with: (size: \"20 cm\"))]",
    "params: { \"n\": 5, \"gap\": \"2 cm\", \"r\": \"0.5 * gap\", \"start\": (0, 4) }",
    "templates: { \"bob\": (args: [\"x\"], bodies: [(name: \"ball\", at: (\"x\", 0), atoms: Disc(radius: 0.1))]) }",
    "instances: [(of: \"bob\", name: \"left\", with: (x: -1), set: { \"ball.velocity\": (1, 0) })]",
];
pub(super) const REPEAT_EXAMPLE: &str = "\
bodies: [
    Repeat(count: 6, circle: (center: (0, 0), radius: 2), make:
        (name: \"ball_{i}\", at: (\"x\", \"y\"), atoms: Disc(radius: 0.1))),
]";

/// The sections that make others.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "described, never made")]
pub(super) struct Made {
    /// Other files whose lists and maps come into this scene. Default: none.
    include: Option<Vec<Include>>,
    /// Values with names, for expressions in quotes. `--set n=9` gives one of them another value. A value may depend on
    /// others, in any order, and may have any form that a scene allows. Default: none.
    #[schemars(extend("x-value" = "`{ \"name\": value }`"))]
    params: Option<BTreeMap<String, Value>>,
    /// Parts of scenes that instances make, by name. Default: none.
    templates: Option<BTreeMap<String, Template>>,
    /// Copies of templates. The ball of the instance `left` is called `left/ball`. Default: none.
    instances: Option<Vec<Instance>>,
}

/// A file to take in.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "described, never made")]
struct Include {
    /// The file, from the folder of the file that includes it.
    file: String,
    /// Its names begin with this and `/`. Default: none.
    prefix: Option<String>,
    /// Other values for its `params`. Default: the values in the file.
    #[schemars(extend("x-value" = "`(name: value)`"))]
    with: Option<BTreeMap<String, Value>>,
}

/// Beside these fields a template holds any sections that are lists or maps, such as `bodies`.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "described, never made")]
pub(super) struct Template {
    /// The arguments that each instance must give. Default: none.
    args: Option<Vec<String>>,
    /// Arguments with the value they have if an instance gives none, and values made from others. Default: none.
    #[schemars(extend("x-value" = "`{ \"name\": value }`"))]
    params: Option<BTreeMap<String, Value>>,
}

/// One copy of a template.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "described, never made")]
struct Instance {
    /// The name of the template.
    of: String,
    /// The prefix of the names of its things.
    name: String,
    /// The arguments, `(x: 1)`. Default: none.
    #[schemars(extend("x-value" = "`(name: value)`"))]
    with: Option<BTreeMap<String, Value>>,
    /// Other values for fields of its things, by path, such as `"ball.atoms.radius"`. Default: none.
    #[schemars(extend("x-value" = "`{ \"path\": value }`"))]
    set: Option<BTreeMap<String, Value>>,
}

/// In any list, in place of an item: one item several times. In `make` the count has a name, `i` from 0 on. With two
/// counts, `j` counts rows.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "described, never made")]
pub(super) struct Repeat {
    /// The number of items. For a grid it is columns and rows.
    #[schemars(schema_with = "count")]
    count: (),
    /// The names of the indices in expressions. Default: `i`, and `j` for rows.
    #[schemars(default, schema_with = "index")]
    r#as: Option<()>,
    /// Places along a line, with both ends. They give `x` and `y`. Default: none.
    line: Option<Line>,
    /// Places in columns and rows. They give `x` and `y`. Default: none.
    grid: Option<Grid>,
    /// Places around a circle. They give `x`, `y` and `angle`. Default: none.
    circle: Option<Circle>,
    /// The item to repeat, or a list of items. Items may be `Repeat` too.
    make: Value,
}

/// Both ends of a line.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "described, never made")]
struct Line {
    /// The place of the first.
    from: LengthPair,
    /// The place of the last.
    to: LengthPair,
}

/// The beginning of a grid, and its spacing.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "described, never made")]
struct Grid {
    /// The place of the first.
    from: LengthPair,
    /// The steps from one column to the next, and from one row to the next.
    step: LengthPair,
}

/// A circle.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "described, never made")]
struct Circle {
    /// Its middle.
    center: LengthPair,
    /// Its radius.
    radius: Length,
    /// The angle of the first item, counter-clockwise from the right. Default: 0.
    start: Option<Angle>,
}

fn count(generator: &mut SchemaGenerator) -> Schema {
    let one = generator.subschema_for::<WholeNumber>();
    json_schema!({
        "anyOf": [one, { "type": "array", "prefixItems": [one, one], "minItems": 2, "maxItems": 2 }],
        "x-value": "whole number, or two `(columns, rows)`",
    })
}

fn index(_: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "type": ["string", "array"],
        "items": { "type": "string" },
        "x-value": "name, or two `(\"i\", \"j\")`",
    })
}
