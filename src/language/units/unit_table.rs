//! The units a scene may use. One line per unit.

use std::f64::consts::PI;

use super::Powers;

/// A unit: its symbol, its size in SI units as `factor * 10^exponent`, its dimension, and whether it takes prefixes.
pub(crate) struct Unit {
    pub(crate) symbol: &'static str,
    pub(crate) factor: f64,
    pub(crate) exponent: i32,
    pub(crate) powers: Powers,
    prefixes: bool,
}

const fn unit(symbol: &'static str, factor: f64, exponent: i32, powers: [i8; 4], prefixes: bool) -> Unit {
    let [meter, kilogram, second, radian] = powers;
    Unit { symbol, factor, exponent, powers: Powers { meter, kilogram, second, radian }, prefixes }
}

const UNITS: &[Unit] = &[
    unit("m", 1.0, 0, [1, 0, 0, 0], true),
    unit("g", 1.0, -3, [0, 1, 0, 0], true),
    unit("t", 1.0, 3, [0, 1, 0, 0], false),
    unit("s", 1.0, 0, [0, 0, 1, 0], true),
    unit("min", 60.0, 0, [0, 0, 1, 0], false),
    unit("h", 3600.0, 0, [0, 0, 1, 0], false),
    unit("rad", 1.0, 0, [0, 0, 0, 1], true),
    unit("deg", PI / 180.0, 0, [0, 0, 0, 1], false),
    unit("°", PI / 180.0, 0, [0, 0, 0, 1], false),
    unit("turn", 2.0 * PI, 0, [0, 0, 0, 1], false),
    unit("rpm", PI / 30.0, 0, [0, 0, -1, 1], false),
    unit("Hz", 1.0, 0, [0, 0, -1, 0], true),
    unit("N", 1.0, 0, [1, 1, -2, 0], true),
    unit("J", 1.0, 0, [2, 1, -2, 0], true),
    unit("W", 1.0, 0, [2, 1, -3, 0], true),
    unit("%", 1.0, -2, [0, 0, 0, 0], false),
    unit("1", 1.0, 0, [0, 0, 0, 0], false),
];

const PREFIXES: &[(&str, i32)] =
    &[("G", 9), ("M", 6), ("k", 3), ("d", -1), ("c", -2), ("m", -3), ("u", -6), ("µ", -6), ("μ", -6), ("n", -9)];

/// Words that people write instead of a symbol.
const WORDS: &[(&str, &str)] = &[
    ("metre", "m"),
    ("meter", "m"),
    ("kilogram", "kg"),
    ("gram", "g"),
    ("second", "s"),
    ("sec", "s"),
    ("minute", "min"),
    ("hour", "h"),
    ("degree", "deg"),
    ("radian", "rad"),
    ("newton", "N"),
    ("hertz", "Hz"),
    ("percent", "%"),
    ("rev", "turn"),
];

/// The unit of a symbol with its prefix, as the unit and a further power of ten.
pub(crate) fn find(symbol: &str) -> Option<(&'static Unit, i32)> {
    let exact = UNITS.iter().find(|unit| unit.symbol == symbol).map(|unit| (unit, 0));
    exact.or_else(|| {
        PREFIXES.iter().find_map(|(prefix, power)| {
            let rest = symbol.strip_prefix(prefix)?;
            UNITS.iter().find(|unit| unit.prefixes && unit.symbol == rest).map(|unit| (unit, *power))
        })
    })
}

/// The symbol that was probably meant.
pub(crate) fn meant(symbol: &str) -> Option<String> {
    let lower = symbol.to_lowercase();
    let singular = lower.strip_suffix('s').filter(|stem| stem.len() > 1).unwrap_or(&lower);
    if let Some((_, symbol)) = WORDS.iter().find(|(word, _)| *word == lower || *word == singular) {
        return Some((*symbol).to_owned());
    }
    let fits = |unit: &&Unit| unit.symbol.to_lowercase() == lower;
    if let Some(unit) = UNITS.iter().find(fits) {
        return Some(unit.symbol.to_owned());
    }
    PREFIXES.iter().find_map(|(prefix, _)| {
        let rest = lower.strip_prefix(&prefix.to_lowercase())?;
        let unit = UNITS.iter().find(|unit| unit.prefixes && unit.symbol.to_lowercase() == rest)?;
        Some(format!("{prefix}{}", unit.symbol))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_symbol_has_two_meanings() {
        for unit in UNITS {
            let as_prefixed = PREFIXES.iter().any(|(prefix, _)| {
                unit.symbol
                    .strip_prefix(prefix)
                    .is_some_and(|rest| UNITS.iter().any(|other| other.prefixes && other.symbol == rest))
            });
            assert!(!as_prefixed, "{} could be a prefixed unit", unit.symbol);
        }
    }
}
