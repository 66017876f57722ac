//! The target of a controller: a number, or a course in time.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer};
use std::borrow::Cow;
use std::marker::PhantomData;

use crate::forces::drive::Course;
use crate::scene::read_value;
use crate::scene::units::{Dimension, Either, Said, plain_name};

/// A number with or without a unit of one of two dimensions, or a course in time in SI units.
pub struct ControlTarget<A, B> {
    value: Value,
    said: Option<Said>,
    dimensions: PhantomData<fn() -> (A, B)>,
}

#[derive(Clone, Debug, PartialEq)]
enum Value {
    /// The same always.
    Constant(f64),
    /// A course in time.
    Course(Course),
}

impl<'de, A: Dimension, B: Dimension> Deserialize<'de> for ControlTarget<A, B> {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        let written = Box::<ron::value::RawValue>::deserialize(reader)?;
        let text = written.trim().get_ron();
        let course = text.strip_prefix("Course").map(|points| format!("Piecewise{points}"));
        let course = course.or_else(|| text.starts_with(char::is_alphabetic).then(|| text.to_owned()));
        match course {
            Some(course) => {
                let value = read_value(&course).map(Value::Course).map_err(de::Error::custom)?;
                Ok(Self { value, said: None, dimensions: PhantomData })
            }
            None => match ron::from_str::<Either<A, B>>(text) {
                Ok(either) => {
                    Ok(Self { value: Value::Constant(either.si()), said: either.said(), dimensions: PhantomData })
                }
                Err(_) => {
                    let (first, second) = (A::NAME, A::EXAMPLE);
                    let courses = "`Course([(0, 0), (1, 0.5)])`, `Csv(\"course.csv\")` or `Sine(frequency: 2)`";
                    Err(de::Error::custom(format!("expected {first} such as {second}, {courses}, found {text}")))
                }
            },
        }
    }
}

impl<A: Dimension, B: Dimension> JsonSchema for ControlTarget<A, B> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "target".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let (first, second) = (plain_name::<A>(), plain_name::<B>());
        json_schema!({ "x-value": format!("{first} or {second}, Course([(time, value), ..]), Csv(..) or Sine(..)") })
    }
}

impl<A, B> ControlTarget<A, B> {
    /// The dimension of its unit; `None` without one.
    pub fn said(&self) -> Option<Said> {
        self.said
    }

    /// Reports a course that cannot be.
    pub fn check(&self, path: &str, report: &mut crate::scene::Diagnostics) {
        match &self.value {
            Value::Constant(value) => _ = report.finite(path, *value),
            Value::Course(course) => report.within(path, |report| course.check(report)),
        }
    }

    /// The value at `time` seconds.
    pub fn at(&self, time: f64) -> f64 {
        match &self.value {
            Value::Constant(value) => *value,
            Value::Course(course) => course.at(time),
        }
    }

    /// Its rate per second at `time` seconds, on the piece of a table on which `inside` lies.
    pub fn rate(&self, time: f64, inside: f64) -> f64 {
        match &self.value {
            Value::Constant(_) => 0.0,
            Value::Course(course) => course.rate(time, inside),
        }
    }

    /// Its second derivative at `time` seconds, per second squared.
    pub fn acceleration(&self, time: f64) -> f64 {
        match &self.value {
            Value::Constant(_) => 0.0,
            Value::Course(course) => course.acceleration(time),
        }
    }

    /// The angular frequency in rad/s of a sine; zero for other targets.
    pub fn rhythm(&self) -> f64 {
        match &self.value {
            Value::Constant(_) => 0.0,
            Value::Course(course) => course.rhythm(),
        }
    }

    /// The course, if it is one.
    pub(crate) fn course(&self) -> Option<&Course> {
        match &self.value {
            Value::Constant(_) => None,
            Value::Course(course) => Some(course),
        }
    }

    /// The time in seconds of the first kink after `time`; infinity if there is none.
    pub fn next_point(&self, time: f64) -> f64 {
        match &self.value {
            Value::Constant(_) => f64::INFINITY,
            Value::Course(course) => course.next_point(time),
        }
    }
}
