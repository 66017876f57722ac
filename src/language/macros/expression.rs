//! Expressions such as `2 * r + 3 cm`: parsed and evaluated in one pass, with the place of every mistake.
//!
//! Trigonometry and powers come from `libm`, so that a scene is the same on every machine.

use std::ops::Range;

use super::quantity::{Number, Unsuited};
use crate::suggest;
use crate::units::{self, Powers};

/// The mistake in an expression, and its place in the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FormulaMistake {
    pub(super) range: Range<usize>,
    pub(super) message: String,
    pub(super) help: Option<String>,
}

type Outcome = Result<Number, FormulaMistake>;

/// Gives the value of a name, or the reason why it has none.
pub(super) type LookUp<'a> = &'a mut dyn FnMut(&str) -> Result<Number, (String, Option<String>)>;

/// Names of functions with their number of arguments; 0: one or more.
const FUNCTIONS: [(&str, usize); 21] = [
    ("abs", 1),
    ("acos", 1),
    ("asin", 1),
    ("atan", 1),
    ("atan2", 2),
    ("ceil", 1),
    ("cos", 1),
    ("exp", 1),
    ("floor", 1),
    ("hypot", 2),
    ("if", 3),
    ("ln", 1),
    ("max", 0),
    ("min", 0),
    ("mod", 2),
    ("pow", 2),
    ("round", 1),
    ("sign", 1),
    ("sin", 1),
    ("sqrt", 1),
    ("tan", 1),
];
/// Brackets and signs may be nested this deep.
const DEEPEST: usize = 60;

/// How names are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Names {
    /// Letters, digits and `_`.
    Plain,
    /// Also with dots, or any signs in single quotes.
    Dotted,
}

/// Whether units of numbers are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Units {
    /// They have to fit.
    Compared,
    /// They are dropped, because those of names are not known.
    Dropped,
}

/// Works out an expression that has a finite value.
pub(super) fn evaluate(text: &str, look_up: LookUp) -> Outcome {
    let value = work_out(text, Names::Plain, Units::Compared, look_up)?;
    if !value.si.is_finite() {
        return Err(wrong(0..text.len(), "this is not a finite number", Some("check for a division by zero".into())));
    }
    Ok(value)
}

/// Works out an expression.
pub(super) fn work_out(text: &str, names: Names, units: Units, look_up: LookUp) -> Outcome {
    let mut reader = Reader { text, at: 0, depth: 0, names, units, look_up };
    let value = reader.comparison()?;
    reader.blank();
    if reader.at < text.len() {
        let rest = &text[reader.at..];
        let length = name_length(rest).max(rest.chars().next().map_or(0, char::len_utf8));
        let help = slip(rest).unwrap_or("between two values stands one of `+ - * / ^`, as in `2 * r + gap`");
        return Err(wrong(reader.at..reader.at + length, "not expected here", Some(help.to_owned())));
    }
    Ok(value)
}

/// The length of a name at the beginning of a text: letters, digits and `_`, not beginning with a digit.
pub(super) fn name_length(text: &str) -> usize {
    let letter = |c: char| c == '_' || c.is_ascii_alphabetic();
    if !text.starts_with(letter) {
        return 0;
    }
    text.find(|c: char| !letter(c) && !c.is_ascii_digit()).unwrap_or(text.len())
}

fn wrong(range: Range<usize>, message: impl Into<String>, help: Option<String>) -> FormulaMistake {
    FormulaMistake { range, message: message.into(), help }
}

/// The meaning of an operator of other languages.
fn slip(rest: &str) -> Option<&'static str> {
    const SLIPS: [(&str, &str); 4] = [
        ("**", "a power is written `2 ^ i`"),
        ("=", "two values are compared by `==`, as in `if(mod(i, 2) == 0, 1, 2)`"),
        ("&", "to ask for two conditions, write `a * b`: comparisons are 1 or 0"),
        ("|", "to ask for one of two conditions, write `max(a, b)`: comparisons are 1 or 0"),
    ];
    SLIPS.into_iter().find(|(sign, _)| rest.starts_with(sign)).map(|(_, help)| help)
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    names: Names,
    units: Units,
    look_up: LookUp<'a>,
}

impl Reader<'_> {
    fn blank(&mut self) {
        self.at = self.text.len() - self.text[self.at..].trim_start().len();
    }

    /// Passes the first of some operators, if one is next.
    fn sign(&mut self, signs: &[&'static str]) -> Option<&'static str> {
        self.blank();
        let found = signs.iter().find(|sign| self.text[self.at..].starts_with(**sign))?;
        self.at += found.len();
        Some(found)
    }

    /// The length of a name at the beginning of a text.
    fn name_length(&self, text: &str) -> usize {
        let mut length = name_length(text);
        while self.names == Names::Dotted && length > 0 {
            let Some(part) = text[length..].strip_prefix('.').map(name_length).filter(|part| *part > 0) else { break };
            length += 1 + part;
        }
        length
    }

    fn comparison(&mut self) -> Outcome {
        self.depth += 1;
        self.blank();
        let start = self.at;
        if self.depth > DEEPEST {
            return Err(wrong(start..self.text.len(), "brackets are nested too deeply", None));
        }
        let left = self.sum()?;
        let sign = self.sign(&["<=", ">=", "==", "!=", "<", ">"]);
        let value = match sign {
            None => left,
            Some(sign) => {
                let right = self.sum()?;
                left.common(right, "compare").map_err(|why| self.since(start, why))?;
                let (a, b) = (left.si, right.si);
                let holds = match sign {
                    "<=" => a <= b,
                    ">=" => a >= b,
                    "==" => a == b,
                    "!=" => a != b,
                    "<" => a < b,
                    _ => a > b,
                };
                Number::plain(f64::from(u8::from(holds)))
            }
        };
        self.depth -= 1;
        Ok(value)
    }

    fn since(&self, start: usize, why: impl Into<Unsuited>) -> FormulaMistake {
        let end = self.text[..self.at].trim_end().len();
        let Unsuited { message, help } = why.into();
        wrong(start..end, message, help)
    }

    fn sum(&mut self) -> Outcome {
        self.blank();
        let start = self.at;
        let mut value = self.product()?;
        while let Some(sign) = self.sign(&["+", "-"]) {
            let right = self.product()?;
            let verb = if sign == "+" { "add" } else { "subtract" };
            let powers = value.common(right, verb).map_err(|why| self.since(start, why))?;
            value = Number::new(if sign == "+" { value.si + right.si } else { value.si - right.si }, powers);
        }
        Ok(value)
    }

    fn product(&mut self) -> Outcome {
        self.blank();
        let start = self.at;
        let mut value = self.signed()?;
        while let Some(sign) = self.sign(&["*", "/"]) {
            let right = self.signed()?;
            value = value.times(right, if sign == "/" { -1 } else { 1 }).map_err(|why| self.since(start, why))?;
        }
        Ok(value)
    }

    fn signed(&mut self) -> Outcome {
        let mut negative = false;
        while let Some(sign) = self.sign(&["-", "+"]) {
            negative ^= sign == "-";
        }
        let value = self.power()?;
        Ok(if negative { Number { si: -value.si, ..value } } else { value })
    }

    fn power(&mut self) -> Outcome {
        self.blank();
        let start = self.at;
        let base = self.atom()?;
        if self.sign(&["^"]).is_none() {
            return Ok(base);
        }
        self.depth += 1;
        if self.depth > DEEPEST {
            let message = format!("powers are nested too deeply: more than {DEEPEST}");
            return Err(wrong(start..self.text.len(), message, None));
        }
        let exponent = self.signed()?;
        self.depth -= 1;
        base.raised(exponent).map_err(|why| self.since(start, why))
    }

    fn atom(&mut self) -> Outcome {
        self.blank();
        let start = self.at;
        let rest = &self.text[start..];
        if self.sign(&["("]).is_some() {
            let value = self.comparison()?;
            return match self.sign(&[")"]) {
                Some(_) => Ok(value),
                None => self.unknown_sign().map_or_else(
                    || Err(wrong(start..start + 1, "this bracket is never closed", Some("close it with `)`".into()))),
                    Err,
                ),
            };
        }
        if let Some(quoted) = rest.strip_prefix('\'').filter(|_| self.names == Names::Dotted) {
            let unclosed = || wrong(start..start + 1, "this quote is never closed", Some("close it with `'`".into()));
            let length = quoted.find('\'').ok_or_else(unclosed)?;
            self.at += length + 2;
            let name = &quoted[..length];
            return (self.look_up)(name).map_err(|(message, help)| wrong(start..self.at, message, help));
        }
        let length = self.name_length(rest);
        if length > 0 {
            self.at += length;
            let name = &rest[..length];
            if self.sign(&["("]).is_some() {
                return self.function(name, start);
            }
            if name == "pi" {
                return Ok(Number::plain(std::f64::consts::PI));
            }
            return (self.look_up)(name).map_err(|(message, help)| wrong(start..start + length, message, help));
        }
        let length = units::number_length(rest);
        if length == 0 {
            let found = rest.chars().next();
            let message = found.map_or("a value is missing at the end".to_owned(), |c| format!("`{c}` is no value"));
            let end = start + found.map_or(0, char::len_utf8);
            let help = "a value is a number, a name, a function such as `sqrt(..)`, or an expression in brackets";
            let help =
                if self.text[..start].ends_with('*') { slip(&self.text[start - 1..]) } else { None }.unwrap_or(help);
            return Err(wrong(start..end, message, Some(help.to_owned())));
        }
        self.at += length;
        let end = self.at + self.unit_length();
        let unit = self.text[self.at..end].trim();
        self.at = end;
        if rest[..length].parse().is_ok_and(f64::is_infinite) {
            let help = format!("the largest number is {:e}", f64::MAX);
            return Err(wrong(start..end, "this number is too large", Some(help)));
        }
        let help = || format!("to multiply, write `{} * {unit}`", &rest[..length]);
        let (si, powers) =
            units::value_in(&rest[..length], unit).map_err(|why| wrong(start..end, why, Some(help())))?;
        Ok(if self.units == Units::Dropped { Number::plain(si) } else { Number::new(si, powers).named_by(unit) })
    }

    /// Units directly after a number: `cm`, `m/s2`, `N m`. A `/` belongs to them only without blanks around it.
    fn unit_length(&self) -> usize {
        let rest = &self.text[self.at..];
        let mut length = 0;
        loop {
            let more = &rest[length..];
            let blank = more.len() - more.trim_start().len();
            let slash = usize::from(length > 0 && blank == 0 && more.starts_with('/'));
            let symbol = &more[blank + slash..];
            let letters = symbol.find(|c: char| !(c.is_alphabetic() || matches!(c, '°' | '%'))).unwrap_or(symbol.len());
            let power = &symbol[letters..];
            let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
            let power = match power.strip_prefix('^') {
                Some(raised) if digits(raised) > 0 => 1 + digits(raised),
                _ if power.starts_with(['²', '³']) => '²'.len_utf8(),
                _ => digits(power),
            };
            let after = &symbol[letters + power..];
            let is_unit = letters > 0 && (length == 0 || units::is_unit(&symbol[..letters]));
            if !is_unit || after.starts_with(['(', '_']) {
                return length;
            }
            length += blank + slash + letters + power;
        }
    }

    /// An operator of another language, if it is next.
    fn unknown_sign(&self) -> Option<FormulaMistake> {
        let rest = self.text[self.at..].trim_start();
        let start = self.text.len() - rest.len();
        let help = slip(rest)?;
        let length = rest.find(|c: char| !"=&|*".contains(c)).unwrap_or(rest.len());
        Some(wrong(start..start + length, "not expected here", Some(help.to_owned())))
    }

    fn function(&mut self, name: &str, start: usize) -> Outcome {
        let mut values = Vec::new();
        loop {
            values.push(self.comparison()?);
            match self.sign(&[",", ")"]) {
                Some(",") => {}
                Some(_) => break,
                None => {
                    let missing = || self.since(start, format!("`)` is missing after the values of `{name}`"));
                    return Err(self.unknown_sign().unwrap_or_else(missing));
                }
            }
        }
        let span = start..start + name.len();
        let Some((_, count)) = FUNCTIONS.iter().find(|(known, _)| *known == name) else {
            let help = suggest::among(name, FUNCTIONS.iter().map(|(name, _)| *name), "functions", '`');
            return Err(wrong(span, format!("there is no function `{name}`"), Some(help)));
        };
        if *count > 0 && *count != values.len() {
            let message =
                format!("`{name}` takes {count} value{}, not {}", if *count == 1 { "" } else { "s" }, values.len());
            return Err(wrong(span, message, None));
        }
        apply(name, &values).map_err(|message| self.since(start, message))
    }
}

fn apply(name: &str, values: &[Number]) -> Result<Number, Unsuited> {
    let a = values[0];
    let b = values.get(1).copied().unwrap_or_default();
    let angle = || {
        let radian = Powers { radian: 1, ..Powers::default() };
        if a.is_plain() || a.powers == radian {
            Ok(a.si)
        } else {
            Err(format!("`{name}` takes an angle, not {}", a.kind()))
        }
    };
    let plain =
        || if a.is_plain() { Ok(a.si) } else { Err(format!("`{name}` takes a plain number, not {}", a.kind())) };
    let with = |si: f64| Ok(Number { si, ..a });
    match name {
        "sin" => Ok(Number::plain(libm::sin(angle()?))),
        "cos" => Ok(Number::plain(libm::cos(angle()?))),
        "tan" => Ok(Number::plain(libm::tan(angle()?))),
        "asin" => Ok(Number::plain(libm::asin(plain()?))),
        "acos" => Ok(Number::plain(libm::acos(plain()?))),
        "atan" => Ok(Number::plain(libm::atan(plain()?))),
        "exp" => Ok(Number::plain(libm::exp(plain()?))),
        "ln" => Ok(Number::plain(libm::log(plain()?))),
        "floor" => Ok(Number::plain(plain()?.floor())),
        "ceil" => Ok(Number::plain(plain()?.ceil())),
        "round" => Ok(Number::plain(plain()?.round())),
        "sign" => Ok(Number::plain(if a.si > 0.0 {
            1.0
        } else if a.si < 0.0 {
            -1.0
        } else {
            0.0
        })),
        "abs" => with(a.si.abs()),
        "sqrt" => Ok(a.root()?),
        "pow" => Ok(a.raised(b)?),
        "atan2" => a.common(b, "take the angle of").map(|_| Number::plain(libm::atan2(a.si, b.si))),
        "hypot" => a.common(b, "add").map(|powers| Number::new(libm::hypot(a.si, b.si), powers)),
        "mod" => a.common(b, "divide").map(|powers| Number::new(a.si - b.si * (a.si / b.si).floor(), powers)),
        "if" => b.common(values[2], "choose between").map(|powers| {
            let chosen = if a.si != 0.0 { b } else { values[2] };
            Number::new(chosen.si, powers)
        }),
        _ => values[1..].iter().try_fold(a, |best, &value| {
            let powers = best.common(value, "compare")?;
            let first = if name == "min" { best.si <= value.si } else { best.si >= value.si };
            Ok(Number::new(if first { best.si } else { value.si }, powers))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Outcome {
        evaluate(text, &mut |name| match name {
            "n" => Ok(Number::plain(5.0)),
            "gap" => Ok(Number::new(0.02, Powers { meter: 1, ..Powers::default() })),
            "mass" => Ok(Number::new(2.0, Powers { kilogram: 1, ..Powers::default() })),
            other => Err((format!("no `{other}`"), None)),
        })
    }

    /// By hand; each number is exact or rounded once.
    #[test]
    fn values_by_hand() {
        for (text, expected) in [
            ("1 + 2 * 3", "7"),
            ("(1 + 2) * 3", "9"),
            ("-2 ^ 2", "-4"),
            ("2 ^ 3 ^ 2", "512"),
            ("10 / 4 / 5", "0.5"),
            ("2 - -3", "5"),
            ("n * gap", "0.1 m"),
            ("gap + 3 cm", "0.05 m"),
            ("gap + 1", "1.02 m"),
            ("gap * gap", "0.0004 m2"),
            ("gap / (2 s)", "0.01 m s-1"),
            ("gap/n", "0.004 m"),
            ("4 m/s * 2 s", "8 m"),
            ("6 m/n", "1.2 m"),
            ("sqrt(gap * 2 cm)", "0.02 m"),
            ("if(n == 5, 3 cm, 1 kg * 0 m / 1 kg)", "0.03 m"),
            ("min(3, 2, n)", "2"),
            ("max(3, 2, n)", "5"),
            ("mod(-1, 4)", "3"),
            ("round(2.5) + floor(-0.5) + ceil(0.2)", "3"),
            ("sin(90 deg)", "1"),
            ("hypot(3, 4)", "5"),
            ("1e3 * 2", "2000"),
            ("30 % * 2", "0.6"),
            ("n >= 5", "1"),
            ("round(atan(1) / 1 deg)", "45"),
            ("asin(1) / 90 deg", "1"),
            ("2 rad * 3 rad + 2 rad ^ 2", "10"),
            ("2 * 3 rad", "6 rad"),
            ("6 rad / 2 s", "3 s-1 rad"),
        ] {
            assert_eq!(value(text).map(Number::shown), Ok(expected.to_owned()), "{text}");
        }
    }

    #[test]
    fn mistakes_have_their_place() {
        for (text, place, message) in [
            ("2 * rr", 4..6, "no `rr`"),
            ("gap + 1 + mass", 0..14, "cannot add a length and a mass"),
            ("gap + 2 kJ", 0..10, "cannot add a length and an energy"),
            ("gap + 2 N m", 0..11, "cannot add a length and a torque"),
            ("gap + 2 * 3 N m", 0..15, "cannot add a length and a torque"),
            ("gap + 2 N * 3 m", 0..15, "cannot add a length and a torque or an energy"),
            ("2 * (n + 1", 4..5, "this bracket is never closed"),
            ("2 n 3", 0..3, "unknown unit `n` (did you mean `N`?)"),
            ("n 3", 2..3, "not expected here"),
            ("n *", 3..3, "a value is missing at the end"),
            ("n * )", 4..5, "`)` is no value"),
            ("sine(n)", 0..4, "there is no function `sine`"),
            ("atan2(n)", 0..5, "`atan2` takes 2 values, not 1"),
            ("sin(gap)", 0..8, "`sin` takes an angle, not a length"),
            ("1 / 0", 0..5, "this is not a finite number"),
            ("2 ^ gap", 0..7, "an exponent is a plain number, not a length"),
            ("", 0..0, "a value is missing at the end"),
        ] {
            let found = value(text).expect_err(text);
            assert_eq!((found.range, found.message.as_str()), (place, message), "{text}");
        }
    }

    #[test]
    fn signs_of_other_languages_are_understood() {
        for (text, place, help) in [
            ("if(mod(n, 2) = 0, 1, 2)", 13..14, "compared by `==`"),
            ("(n = 5)", 3..4, "compared by `==`"),
            ("n = 5", 2..3, "compared by `==`"),
            ("2 ** n", 3..4, "`2 ^ i`"),
            ("max(n > 1 && n < 3, 0)", 10..12, "`a * b`"),
        ] {
            let found = value(text).expect_err(text);
            assert_eq!(found.range, place, "{text}");
            assert!(found.help.as_ref().is_some_and(|told| told.contains(help)), "{text}: {found:?}");
        }
        let huge = value("1e400").expect_err("1e400 is infinite");
        assert!(huge.message.contains("too large"), "{huge:?}");
    }

    #[test]
    fn depth_is_bounded() {
        for open in ["(", "abs(", "2 ^ "] {
            let found = value(&open.repeat(100_000)).expect_err(open);
            assert!(found.message.contains("too deeply"), "{open}: {found:?}");
        }
        assert_eq!(value(&format!("{}1", "-".repeat(100_000))).map(|value| value.si), Ok(1.0));
    }
}
