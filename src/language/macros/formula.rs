//! Formulas: expressions of named values that change, such as `a.position.x - 2 * b.position.x`, worked out anew for each reading.
//!
//! They are written as other expressions of scenes are. Names may have dots in them; a name with other signs stands in single quotes.

use std::borrow::Cow;

use super::expression::{self, Names, Wrong};
use super::quantity::Number;
use crate::units::{self, Powers};

/// An expression of named values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formula(String);

/// Why a formula has no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// What is wrong.
    pub message: String,
    /// What helps.
    pub help: Option<String>,
}

/// The value of a name, and the symbol of its unit.
pub type Known<'a> = (f64, &'a str);

impl Formula {
    /// A formula as it is written. It is looked at when it is asked for its value.
    pub fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }

    /// The names that stand in it, in order, each as often as it stands there.
    ///
    /// # Errors
    /// What is wrong with it, whatever the names mean.
    pub fn names(&self) -> Result<Vec<String>, Mistake> {
        let mut names = Vec::new();
        let value = expression::work_out(&self.0, Names::Dotted, &mut |name| {
            names.push(name.to_owned());
            // Without a unit a number fits everywhere.
            Ok(Number::plain(f64::NAN))
        });
        value.map(|_| names).map_err(|wrong| self.mistake(wrong))
    }

    /// Its value in SI units, and their powers. `value` gives that of a name.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn value<'a>(&self, mut value: impl FnMut(&str) -> Option<Known<'a>>) -> Result<(f64, Powers), Mistake> {
        let number = expression::work_out(&self.0, Names::Dotted, &mut |name| {
            let (value, unit) = value(name).ok_or_else(|| (format!("`{name}` has no value"), None))?;
            let (factor, powers) = units::value_in("1", unit).map_err(|why| (why, None))?;
            Ok(Number { si: value * factor, powers })
        });
        number.map(|number| (number.si, number.powers)).map_err(|wrong| self.mistake(wrong))
    }

    /// The symbol of a unit with these powers: the first of `wanted` that has them, else the product of base units.
    pub fn symbol(powers: Powers, wanted: &[&'static str]) -> Cow<'static, str> {
        let has = |symbol: &&&str| units::value_in("1", symbol) == Ok((1.0, powers));
        wanted.iter().find(has).map_or_else(|| units::base_units(powers).into(), |symbol| (*symbol).into())
    }

    fn mistake(&self, Wrong { range, message, help }: Wrong) -> Mistake {
        let index = self.0.get(range).filter(|index| !index.is_empty() && *index != self.0);
        let message = index.map_or(message.clone(), |index| format!("in `{index}`: {message}"));
        Mistake { message, help }
    }
}
