//! A quantity with one of two dimensions, such as a torque about a hinge or a force on a line.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer, Visitor};

use super::{Dimension, Quantity, plain_name, unit_of};

/// A number with the unit of one of two dimensions, or without a unit: then either is meant.
pub struct Either<A, B> {
    si: f64,
    said: Option<Said>,
    dimensions: PhantomData<fn() -> (A, B)>,
}

/// Which of two dimensions a unit has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Said {
    /// The first.
    First,
    /// The second.
    Second,
}

impl<A, B> Either<A, B> {
    /// The value in SI units.
    pub const fn si(self) -> f64 {
        self.si
    }

    /// The dimension of the unit; `None` without one.
    pub const fn said(self) -> Option<Said> {
        self.said
    }
}

impl<A, B> Clone for Either<A, B> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A, B> Copy for Either<A, B> {}

impl<A, B> From<Either<A, B>> for f64 {
    fn from(either: Either<A, B>) -> Self {
        either.si
    }
}

struct Reading<A, B>(PhantomData<fn() -> (A, B)>);

impl<A: Dimension, B: Dimension> Reading<A, B> {
    fn bare(si: f64) -> Either<A, B> {
        Either { si, said: None, dimensions: PhantomData }
    }
}

impl<A: Dimension, B: Dimension> Visitor<'_> for Reading<A, B> {
    type Value = Either<A, B>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} such as {}, or {} such as {}", A::NAME, A::EXAMPLE, B::NAME, B::EXAMPLE)
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Self::Value, E> {
        Ok(Self::bare(value))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Self::Value, E> {
        Ok(Self::bare(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Self::Value, E> {
        Ok(Self::bare(value as f64))
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Self::Value, E> {
        let with = |si: f64, said: Said| Either { si, said: Some(said), dimensions: PhantomData };
        match (Quantity::<A>::parse(text), Quantity::<B>::parse(text)) {
            (Ok(first), _) => Ok(with(first.si(), Said::First)),
            (_, Ok(second)) => Ok(with(second.si(), Said::Second)),
            (Err(why), Err(_)) => Err(E::custom(why)),
        }
    }
}

impl<'de, A: Dimension, B: Dimension> Deserialize<'de> for Either<A, B> {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_any(Reading(PhantomData))
    }
}

impl<A: Dimension, B: Dimension> JsonSchema for Either<A, B> {
    fn schema_name() -> Cow<'static, str> {
        format!("{} or {}", plain_name::<A>(), plain_name::<B>()).replace(' ', "_").into()
    }

    fn schema_id() -> Cow<'static, str> {
        format!("jostle quantity {} {:?} or {} {:?}", A::NAME, A::POWERS, B::NAME, B::POWERS).into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let (first, second) = (unit_of::<A>(), unit_of::<B>());
        json_schema!({
            "type": ["number", "string"],
            "description": format!(
                "{} or {}: a number in {first} or {second}, a text with its unit, such as {} and {}, or an expression in quotes.",
                A::NAME, B::NAME, A::EXAMPLE, B::EXAMPLE
            ),
            "x-value": format!("{} or {}", plain_name::<A>(), plain_name::<B>()),
            "x-unit": format!("{first} or {second}"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::dimension::{OfForce, OfTorque};
    use super::*;

    fn read(text: &str) -> Result<(f64, Option<Said>), String> {
        let read: Result<Either<OfTorque, OfForce>, _> = ron::from_str(text);
        read.map(|read| (read.si(), read.said())).map_err(|error| error.to_string())
    }

    #[test]
    fn the_unit_says_which_dimension_it_is() {
        assert_eq!(read("2"), Ok((2.0, None)));
        assert_eq!(read("2.5"), Ok((2.5, None)));
        assert_eq!(read("\"3 N m\""), Ok((3.0, Some(Said::First))));
        assert_eq!(read("\"3 kN\""), Ok((3000.0, Some(Said::Second))));
        assert!(read("\"3 kg\"").is_err_and(|why| why.contains("expected a torque")));
    }
}
