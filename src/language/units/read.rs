//! From text to SI: the number, the product of units, and the comparison of dimensions.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};

use super::{Dimension, KNOWN, Powers, Quantity, QuantityPair, unit_table};

/// Reads a number with a unit into SI units.
///
/// # Errors
/// The error names the expected dimension (`name`, `example`) and the found text.
pub fn parse_si(text: &str, name: &str, powers: Powers, example: &str) -> Result<f64, String> {
    let trimmed = text.trim();
    let length = number_length(trimmed);
    let (number, unit) = trimmed.split_at(length);
    let unit = unit.trim();
    if length == 0 {
        return Err(format!("expected {name} such as {example}, found the text {text:?}"));
    }
    if unit.is_empty() {
        return Err(format!("the text {text:?} has no unit; expected {name} such as {example}"));
    }
    let size = product(unit).map_err(|why| format!("{why} in {text:?}; expected {name} such as {example}"))?;
    if size.powers != powers {
        let found = name_of(size.powers);
        return Err(format!("expected {name} such as {example}, got {found} `{trimmed}`"));
    }
    let value = decimal(number, size.exponent).map(|value| value * size.factor);
    match value {
        Some(value) if value.is_finite() => Ok(value),
        _ => Err(format!("`{trimmed}` is infinite, above 1.8e308; expected {name} such as {example}")),
    }
}

/// A number with or without a unit, in SI units, with the powers of its units; as [`parse_si`] reads it.
pub(crate) fn value_in(number: &str, unit: &str) -> Result<(f64, Powers), String> {
    let size = if unit.is_empty() { Size::default() } else { product(unit)? };
    let value = decimal(number, size.exponent).map(|value| value * size.factor).filter(|value| value.is_finite());
    value.map(|value| (value, size.powers)).ok_or_else(|| format!("`{number} {unit}` is infinite, above 1.8e308"))
}

/// Whether a text is a number by itself, with or without a unit.
pub(crate) fn is_quantity(text: &str) -> bool {
    let (number, unit) = text.trim().split_at(number_length(text.trim()));
    !number.is_empty() && (unit.trim().is_empty() || product(unit.trim()).is_ok())
}

/// Whether a word is the symbol of a unit, with or without a prefix.
pub(crate) fn is_unit(symbol: &str) -> bool {
    unit_table::find(symbol).is_some()
}

/// The length of the number at the beginning of a text.
pub(crate) fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let mut at = sign;
    let whole = digits(at);
    at += whole;
    let mut count = whole;
    if bytes.get(at) == Some(&b'.') {
        let part = digits(at + 1);
        count += part;
        at += 1 + part;
    }
    if count == 0 {
        return 0;
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        let power = digits(at + 1 + sign);
        if power > 0 {
            at += 1 + sign + power;
        }
    }
    at
}

/// The number times a power of ten, rounded once.
fn decimal(number: &str, exponent: i32) -> Option<f64> {
    let (digits, power) = match number.find(['e', 'E']) {
        Some(index) => (&number[..index], number[index + 1..].parse::<i32>().ok()?),
        None => (number, 0),
    };
    format!("{digits}e{}", power.checked_add(exponent)?).parse().ok()
}

struct Size {
    factor: f64,
    exponent: i32,
    powers: Powers,
}

impl Default for Size {
    fn default() -> Self {
        Self { factor: 1.0, exponent: 0, powers: Powers::default() }
    }
}

/// `kN/m`, `N s/m`, `m/s2`, `m/s^2`, `kg*m²`: a product of units; `/` divides by the one unit after it.
fn product(text: &str) -> Result<Size, String> {
    let mut size = Size::default();
    let mut divided = false;
    let mut rest = text;
    let mut divides = false;
    let mut first = true;
    while !rest.is_empty() {
        if !first {
            let separator = rest.trim_start();
            let explicit = separator.chars().next().filter(|c| matches!(c, '/' | '*' | '·' | '⋅'));
            rest = explicit.map_or(separator, |c| separator[c.len_utf8()..].trim_start());
            divides = explicit == Some('/');
            if divided && !divides {
                return Err(format!("`{text}` reads two ways (put products before `/`)"));
            }
            divided |= divides;
        }
        let end = rest.find([' ', '/', '*', '·', '⋅']).unwrap_or(rest.len());
        let (factor, after) = rest.split_at(end);
        rest = after;
        if factor.is_empty() {
            return Err(format!("`{text}` is not a unit"));
        }
        multiply(&mut size, factor, divides)?;
        first = false;
    }
    Ok(size)
}

fn multiply(size: &mut Size, factor: &str, divides: bool) -> Result<(), String> {
    let (symbol, power) = split_power(factor).ok_or_else(|| format!("`{factor}` is not a unit"))?;
    let Some((unit, prefix)) = unit_table::find(symbol) else {
        let meant = unit_table::meant(symbol).map(|meant| format!(" (did you mean `{meant}`?)"));
        return Err(format!("unknown unit `{symbol}`{}", meant.unwrap_or_default()));
    };
    let power = if divides { -power } else { power };
    size.factor *= unit.factor.powi(power);
    size.exponent += (unit.exponent + prefix) * power;
    let add = |to: &mut i8, of: i8| {
        *to = i8::try_from(i32::from(*to) + i32::from(of) * power).ok()?;
        Some(())
    };
    let powers = &mut size.powers;
    add(&mut powers.meter, unit.powers.meter)
        .and_then(|()| add(&mut powers.kilogram, unit.powers.kilogram))
        .and_then(|()| add(&mut powers.second, unit.powers.second))
        .and_then(|()| add(&mut powers.radian, unit.powers.radian))
        .ok_or_else(|| format!("`{factor}` has too large a power"))
}

/// `s2`, `s^2`, `s²`, `s-1` into symbol and power.
fn split_power(factor: &str) -> Option<(&str, i32)> {
    if factor == "1" {
        return Some((factor, 1));
    }
    for (superscript, power) in [("²", 2), ("³", 3)] {
        if let Some(symbol) = factor.strip_suffix(superscript) {
            return Some((symbol, power));
        }
    }
    let end = factor.trim_end_matches(|c: char| c.is_ascii_digit());
    if end.len() == factor.len() {
        return Some((factor, 1));
    }
    let digits: i32 = factor[end.len()..].parse().ok().filter(|power| *power < 10)?;
    let (symbol, sign) = end.strip_suffix('-').map_or((end, 1), |symbol| (symbol, -1));
    Some((symbol.strip_suffix('^').unwrap_or(symbol), sign * digits))
}

/// The name of a dimension, or else its base units.
pub(crate) fn name_of(powers: Powers) -> String {
    match KNOWN.iter().find(|(_, known)| *known == powers) {
        Some((name, _)) => (*name).to_owned(),
        None => format!("something in `{}`:", base_units(powers)),
    }
}

/// The product of base units of a dimension, such as `kg m2 s-2`.
pub(crate) fn base_units(powers: Powers) -> String {
    let base = [("kg", powers.kilogram), ("m", powers.meter), ("s", powers.second), ("rad", powers.radian)];
    let parts: Vec<String> = base
        .iter()
        .filter(|(_, power)| *power != 0)
        .map(|(symbol, power)| if *power == 1 { (*symbol).to_owned() } else { format!("{symbol}{power}") })
        .collect();
    parts.join(" ")
}

struct One<D>(PhantomData<fn() -> D>);

impl<D: Dimension> Visitor<'_> for One<D> {
    type Value = Quantity<D>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} such as {}", D::NAME, D::EXAMPLE)
    }

    // A bare number that is NaN or infinite passes here. The walk over the text refuses it with its place. So the other
    // mistakes of the section are reported too.
    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Self::Value, E> {
        Ok(Quantity::new(value))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Self::Value, E> {
        Ok(Quantity::new(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Self::Value, E> {
        Ok(Quantity::new(value as f64))
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Self::Value, E> {
        Quantity::parse(text).map_err(E::custom)
    }
}

impl<'de, D: Dimension> Deserialize<'de> for Quantity<D> {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_any(One(PhantomData))
    }
}

struct Two<D>(PhantomData<fn() -> D>);

impl<'de, D: Dimension> Visitor<'de> for Two<D> {
    type Value = QuantityPair<D>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "two values `(x, y)`, each {} such as {}", D::NAME, D::EXAMPLE)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<QuantityPair<D>, A::Error> {
        let mut next = |count| values.next_element()?.ok_or_else(|| de::Error::invalid_length(count, &self));
        let pair = QuantityPair { x: next(0)?, y: next(1)? };
        if values.next_element::<de::IgnoredAny>()?.is_some() {
            return Err(de::Error::invalid_length(3, &self));
        }
        Ok(pair)
    }
}

impl<'de, D: Dimension> Deserialize<'de> for QuantityPair<D> {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_tuple(2, Two(PhantomData))
    }
}

#[cfg(test)]
mod tests {
    use super::super::*;

    fn si<D: Dimension>(text: &str) -> f64 {
        Quantity::<D>::parse(text).unwrap_or_else(|error| panic!("{error}")).si()
    }

    #[test]
    fn units_of_the_manual() {
        use dimension::*;
        assert_eq!(si::<OfLength>("30 cm"), 0.3);
        assert_eq!(si::<OfLength>("57cm"), 0.57);
        assert_eq!(si::<OfMass>("2.5 g"), 0.0025);
        assert_eq!(si::<OfMass>("2 kg"), 2.0);
        assert_eq!(si::<OfTime>("1 ms"), 0.001);
        assert_eq!(si::<OfTime>("1.5 min"), 90.0);
        assert_eq!(si::<OfAngle>("180 deg"), std::f64::consts::PI);
        assert_eq!(si::<OfAngle>("-90°"), -std::f64::consts::FRAC_PI_2);
        assert_eq!(si::<OfRate>("250 Hz"), 250.0);
        assert_eq!(si::<OfRate>("4 1/s"), 4.0);
        assert_eq!(si::<OfStiffness>("1 kN/m"), 1000.0);
        assert_eq!(si::<OfStiffness>("3 N/mm"), 3000.0);
        assert_eq!(si::<OfSpin>("30 rpm"), std::f64::consts::PI);
        assert_eq!(si::<OfSpin>("180 deg/s"), std::f64::consts::PI);
        for text in ["9.81 m/s2", "9.81 m/s^2", "9.81 m/s²", "9.81 m s-2", "9.81 m·s^-2", "981 cm/s/s"] {
            assert_eq!(si::<OfAcceleration>(text), 9.81, "{text}");
        }
        assert_eq!(si::<OfDamping>("1 N s/m"), 1.0);
        assert_eq!(si::<OfDensity>("2.5 kg/m2"), 2.5);
        assert_eq!(si::<OfDensity>("1 g/cm2"), 10.0);
        assert_eq!(si::<OfInertia>("2 g*mm2"), 2e-9);
        assert_eq!(si::<OfTorque>("5 mN m"), 0.005);
        assert_eq!(si::<OfNumber>("25 %"), 0.25);
        assert_eq!(si::<OfLength>("1e3 um"), 1e-3);
    }

    #[test]
    fn wrong_units_are_named() {
        let length = |text: &str| Length::parse(text).map_or_else(|error| error, |length| format!("{length:?}"));
        let such = "expected a length such as `0.3` or \"30 cm\"";
        assert_eq!(length("2.5 g"), format!("{such}, got a mass `2.5 g`"));
        assert_eq!(length("2 m2 s"), format!("{such}, got something in `m2 s`: `2 m2 s`"));
        assert_eq!(length("wide"), format!("{such}, found the text \"wide\""));
        assert_eq!(length(""), format!("{such}, found the text \"\""));
        assert_eq!(length("0.3"), format!("the text \"0.3\" has no unit; {such}"));
        assert_eq!(length("3 metres"), format!("unknown unit `metres` (did you mean `m`?) in \"3 metres\"; {such}"));
        assert_eq!(length("3 CM"), format!("unknown unit `CM` (did you mean `cm`?) in \"3 CM\"; {such}"));
        assert_eq!(length("3 furlong"), format!("unknown unit `furlong` in \"3 furlong\"; {such}"));
        assert_eq!(length("1e400 m"), format!("`1e400 m` is infinite, above 1.8e308; {such}"));
        assert_eq!(length("NaN m"), format!("{such}, found the text \"NaN m\""));
        assert_eq!(length("3 m//s"), format!("`m//s` is not a unit in \"3 m//s\"; {such}"));
        assert!(Damping::parse("1 N/m s").unwrap_err().contains("reads two ways"));
        assert_eq!(
            Spin::parse("3 Hz").unwrap_err(),
            "expected a spin such as `0.5` (rad/s), \"90 deg/s\" or \"3 rpm\", got a rate `3 Hz`"
        );
    }

    #[test]
    fn nothing_makes_it_stumble() {
        for text in [
            "+",
            "-.",
            ".",
            "1e",
            "1e+ m",
            "1 m^",
            "1 m^-",
            "1 /",
            "1 / m",
            "1 é",
            "1e99999999999 m",
            "9 m999",
            "1 m9 m9 m9 m9 m9 m9 m9 m9 m9 m9 m9 m9 m9 m9 m9",
        ] {
            let _ = Length::parse(text);
        }
    }
}
