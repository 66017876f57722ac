//! Formulas: expressions of named values that change, such as `a.position.x - 2 * b.position.x`, worked out anew for each reading.
//!
//! They are written as other expressions of scenes are. Names may have dots in them; a name with other signs stands in single quotes.

use std::borrow::Cow;

use super::expression::{self, FormulaMistake, Names};
use super::quantity::Number;
use crate::units::{self, Powers};

/// An expression of named values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formula(String);

/// The reason for which a formula has no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// The mistake in words.
    pub message: String,
    /// The remedy, if one is known.
    pub help: Option<String>,
}

/// The value of a name, and the symbol of its unit.
pub type NamedValue<'a> = (f64, &'a str);

impl Formula {
    /// A formula as it is written. It is looked at when it is asked for its value.
    pub fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }

    /// The names that stand in it, in order, each as often as it stands there.
    ///
    /// # Errors
    /// Its first mistake that does not depend on the meanings of names.
    pub fn names(&self) -> Result<Vec<String>, Mistake> {
        let mut names = Vec::new();
        let value = expression::work_out(&self.0, Names::Dotted, &mut |name| {
            names.push(name.to_owned());
            // Without a unit a number fits everywhere.
            Ok(Number::plain(f64::NAN))
        });
        value.map(|_| names).map_err(|wrong| self.mistake(wrong))
    }

    /// The formula with other names of channels, in single quotes. `None` if the text is no formula, or keeps all names. A formula has a
    /// blank, a bracket or a quote: `finger/tip` is the name of a body.
    pub(super) fn renamed(&self, other: impl Fn(&str) -> Option<String>) -> Option<String> {
        let names = self.names().ok().filter(|_| self.0.contains([' ', '(', '\'']))?;
        let (mut text, mut rest, mut changed) = (String::new(), &*self.0, false);
        for name in names {
            let part_of_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
            let stands = |at: &usize| {
                let (before, after) = (&rest[..*at], &rest[at + name.len()..]);
                !before.ends_with(part_of_name) && !after.starts_with(part_of_name)
            };
            let at = rest.match_indices(&*name).map(|(at, _)| at).find(stands)?;
            let quoted = rest[..at].ends_with('\'');
            let full = if name.contains('.') { other(&name) } else { None };
            changed |= full.is_some();
            text.push_str(&rest[..at]);
            match full {
                Some(full) if !quoted => text.push_str(&format!("'{full}'")),
                full => text.push_str(&full.unwrap_or_else(|| name.clone())),
            }
            rest = &rest[at + name.len()..];
        }
        changed.then(|| text + rest)
    }

    /// Its value in SI units, and their powers. `value` gives that of a name.
    ///
    /// # Errors
    /// Its first mistake.
    pub fn value<'a>(&self, mut value: impl FnMut(&str) -> Option<NamedValue<'a>>) -> Result<(f64, Powers), Mistake> {
        let number = expression::work_out(&self.0, Names::Dotted, &mut |name| {
            let (value, unit) = value(name).ok_or_else(|| (format!("`{name}` has no value"), None))?;
            let (factor, powers) = units::value_in("1", unit).map_err(|why| (why, None))?;
            Ok(Number { si: value * factor, powers })
        });
        number.map(|number| (number.si, number.powers)).map_err(|wrong| self.mistake(wrong))
    }

    /// The symbol of a unit with these powers. It is the first of `wanted` that has them, else the product of base units.
    pub fn symbol(powers: Powers, wanted: &[&'static str]) -> Cow<'static, str> {
        let has = |symbol: &&&str| units::value_in("1", symbol) == Ok((1.0, powers));
        wanted.iter().find(has).map_or_else(|| units::base_units(powers).into(), |symbol| (*symbol).into())
    }

    fn mistake(&self, FormulaMistake { range, message, help }: FormulaMistake) -> Mistake {
        let part = self.0.get(range).filter(|part| !part.is_empty() && *part != self.0);
        let message = part.map_or(message.clone(), |part| format!("in `{part}`: {message}"));
        Mistake { message, help }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_a_formula_get_their_prefix_one_by_one() {
        let prefixed = |text: &str| Formula::new(text).renamed(|name| (name != "g.x").then(|| format!("p/{name}")));
        assert_eq!(prefixed("heap.repose / 1 deg").as_deref(), Some("'p/heap.repose' / 1 deg"));
        assert_eq!(prefixed("max(a.x, 2 * 'b c.x') - g.x").as_deref(), Some("max('p/a.x', 2 * 'p/b c.x') - g.x"));
        assert_eq!(prefixed("aa.x - a.x").as_deref(), Some("'p/aa.x' - 'p/a.x'"));
        assert_eq!(prefixed("g.x + 1 m"), None);
        assert_eq!(prefixed("ball.position.x"), None);
        assert_eq!(prefixed("finger/tip"), None);
        assert_eq!(prefixed("gas_*"), None);
    }
}
