//! The schemas of the kinds of values that sections share: quantities, pairs, words, names, whole numbers, maps.
//!
//! Besides the keywords of JSON schema they carry two extensions, which other programs ignore. `x-unit` is the SI unit,
//! and `x-value` is the manual's name for the value.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::ser::{Serialize, SerializeTuple, Serializer};

use crate::units::{Dimension, Quantity, QuantityPair, plain_name, unit_of};
use crate::values::{Elsewhere, Names, OrderedMap, WholeNumber, Word};

/// `a moment of inertia` as `moment_of_inertia`.
fn identifier<D: Dimension>() -> String {
    plain_name::<D>().replace(' ', "_")
}

/// Written as a bare number in SI units.
impl<D> Serialize for Quantity<D> {
    fn serialize<S: Serializer>(&self, writer: S) -> Result<S::Ok, S::Error> {
        writer.serialize_f64(self.si())
    }
}

impl<D> Serialize for QuantityPair<D> {
    fn serialize<S: Serializer>(&self, writer: S) -> Result<S::Ok, S::Error> {
        let mut pair = writer.serialize_tuple(2)?;
        pair.serialize_element(&self.x)?;
        pair.serialize_element(&self.y)?;
        pair.end()
    }
}

impl<D: Dimension> JsonSchema for Quantity<D> {
    fn schema_name() -> Cow<'static, str> {
        identifier::<D>().into()
    }

    fn schema_id() -> Cow<'static, str> {
        format!("jostle quantity {} {:?}", D::NAME, D::POWERS).into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let unit = unit_of::<D>();
        let bare = if unit.is_empty() { "as it is".to_owned() } else { format!("in {unit}") };
        json_schema!({
            "type": ["number", "string"],
            "description": format!(
                "{}: a number {bare}, a text with its unit, such as {}, or an expression in quotes.",
                D::NAME, D::EXAMPLE
            ),
            "x-value": plain_name::<D>(),
            "x-unit": unit,
        })
    }
}

impl<D: Dimension> JsonSchema for QuantityPair<D> {
    fn schema_name() -> Cow<'static, str> {
        format!("{}_pair", identifier::<D>()).into()
    }

    fn schema_id() -> Cow<'static, str> {
        format!("jostle pair {} {:?}", D::NAME, D::POWERS).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<Quantity<D>>();
        json_schema!({
            "type": ["array", "string"],
            "description": format!("Two values `(x, y)`, each {}; or the name of a parameter.", D::NAME),
            "prefixItems": [one, one],
            "minItems": 2,
            "maxItems": 2,
            "x-value": "`(x, y)`",
            "x-unit": unit_of::<D>(),
        })
    }
}

impl Serialize for WholeNumber {
    fn serialize<S: Serializer>(&self, writer: S) -> Result<S::Ok, S::Error> {
        writer.serialize_u64(self.0)
    }
}

impl JsonSchema for WholeNumber {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "whole_number".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["integer", "string"], "minimum": 0, "x-value": "whole number" })
    }
}

impl Serialize for Word {
    fn serialize<S: Serializer>(&self, writer: S) -> Result<S::Ok, S::Error> {
        writer.serialize_str(&self.0)
    }
}

/// A field names the open list of its words with `#[schemars(extend("x-words" = "method"))]`.
impl JsonSchema for Word {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "word".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "x-value": "a word" })
    }
}

impl JsonSchema for Names {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "names".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": ["string", "array"],
            "items": { "type": "string" },
            "x-value": "name, or list of names",
        })
    }
}

impl JsonSchema for Elsewhere {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "elsewhere".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "x-value": "list of entries" })
    }
}

impl<T: JsonSchema> JsonSchema for OrderedMap<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("map_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "object", "additionalProperties": generator.subschema_for::<T>() })
    }
}
