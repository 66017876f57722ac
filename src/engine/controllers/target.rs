//! What a controller follows: a number, or a course in time.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer};
use std::borrow::Cow;

use crate::forces::drive::Course;
use crate::scene::read_value;
use crate::scene::units::Angle;

/// A number, or a course in time. Angles in rad or with a unit; of a slide metres, forces in newtons, without unit.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// The same always.
    Constant(f64),
    /// A course in time.
    Course(Course),
}

impl<'de> Deserialize<'de> for Target {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        let written = Box::<ron::value::RawValue>::deserialize(reader)?;
        let text = written.trim().get_ron();
        let course = text.strip_prefix("Course").map(|points| format!("Piecewise{points}"));
        let course = course.or_else(|| text.starts_with(char::is_alphabetic).then(|| text.to_owned()));
        match course {
            Some(course) => {
                read_value(&course).map(Self::Course).map_err(de::Error::custom)
            }
            None => ron::from_str::<Angle>(text).map(|angle| Self::Constant(angle.si())).map_err(|_| {
                let expected = "expected a number, an angle such as \"40 deg\", `Course([(0, 0), (1, 0.5)])` or `Sine(frequency: 2)`";
                de::Error::custom(format!("{expected}, found {text}"))
            }),
        }
    }
}

impl JsonSchema for Target {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "target".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "x-value": "number, angle such as \"40 deg\", Course([(time, value), ..]) or Sine(..)" })
    }
}

impl Target {
    /// Reports a course that cannot be.
    pub fn check(&self, path: &str, report: &mut crate::scene::Report) {
        match self {
            Self::Constant(value) => _ = report.finite(path, *value),
            Self::Course(course) => report.within(path, |report| course.check(report)),
        }
    }

    /// The value at `time` seconds, and its rate per second.
    pub fn at(&self, time: f64) -> (f64, f64) {
        match self {
            Self::Constant(value) => (*value, 0.0),
            Self::Course(course) => (course.at(time), course.rate(time)),
        }
    }

    /// The first time after `time` seconds at which it has a kink; infinity if there is none.
    pub fn next_point(&self, time: f64) -> f64 {
        match self {
            Self::Constant(_) => f64::INFINITY,
            Self::Course(course) => course.next_point(time),
        }
    }
}
