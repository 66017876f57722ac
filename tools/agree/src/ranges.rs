//! Plausible numbers, by their dimension and by the bounds that their descriptions tell. If neither tells enough, the
//! example of the entry does.
//!
//! Scenes are as large as a table. Bodies have decimetres and kilograms, forces are like their weights, and times like
//! those of their falls. Then all that acts matters.

use crate::chance::Chance;

/// A number to be drawn.
pub struct Wanted<'a> {
    /// The name of its dimension, such as `length`.
    pub dimension: &'a str,
    /// The description of its field.
    pub told: &'a str,
    /// Its value in the example of its entry.
    pub example: Option<f64>,
    /// Whether it is one of two values with directions, such as the parts of a vector.
    pub directed: bool,
}

/// Dimensions with the range of their sizes. The test of the generator fails for a dimension without one.
const RANGES: [(&str, f64, f64); 22] = [
    ("length", 0.05, 0.3),
    ("angle", 0.05, 1.2),
    ("time", 0.02, 0.2),
    ("rate", 1.0, 12.0),
    ("speed", 0.05, 2.0),
    ("spin", 0.1, 8.0),
    ("acceleration", 1.0, 12.0),
    ("mass", 0.2, 5.0),
    ("density", 10.0, 150.0),
    ("moment_of_inertia", 2e-3, 0.1),
    ("force", 0.5, 40.0),
    ("torque", 0.05, 4.0),
    ("stiffness", 1e4, 1e6),
    ("damping", 0.05, 5.0),
    ("quadratic_damping", 0.02, 1.0),
    ("torsion_stiffness", 0.5, 20.0),
    ("torsion_damping", 0.01, 0.5),
    ("gravitational_constant", 0.01, 1.0),
    ("spin_or_speed", 0.1, 4.0),
    ("torque_or_force", 0.5, 40.0),
    ("number", 0.1, 1.5),
    ("whole", 3.0, 8.0),
];

/// A length whose absence means zero is a detail, such as a rounding.
const DETAIL: (f64, f64) = (1e-3, 1e-2);
/// Numbers lie within this factor of the example of their entry.
const AROUND: f64 = 4.0;

/// Dimensions of which sizes differ too much from entry to entry for one range.
const BY_EXAMPLE: [&str; 5] = ["number", "length", "stiffness", "torsion_stiffness", "whole"];

/// Whether numbers of a dimension have a range.
pub fn is_known(dimension: &str) -> bool {
    RANGES.iter().any(|(name, ..)| *name == dimension)
}

/// A number.
pub fn draw(wanted: &Wanted, chance: &mut Chance) -> f64 {
    let (_, low, high) = RANGES.into_iter().find(|(name, ..)| *name == wanted.dimension).unwrap_or(("", 0.1, 1.0));
    let told = wanted.told.to_lowercase();
    let share = ["0 to 1", "from 0 (", "from 0 to 1"].iter().any(|bound| told.contains(bound));
    if wanted.dimension == "number" && share {
        return if chance.happens(0.2) { 0.0 } else { chance.between(0.0, 1.0) };
    }
    let is_detail = wanted.dimension == "length" && told.contains("default: 0.");
    let (low, high) = match wanted.example {
        _ if wanted.directed => (low, high),
        Some(example) if example != 0.0 && BY_EXAMPLE.contains(&wanted.dimension) => {
            (example.abs() / AROUND, example.abs() * AROUND)
        }
        _ if is_detail => DETAIL,
        _ => (low, high),
    };
    let size = chance.scale(low, high);
    if wanted.directed {
        // A part of a vector is often zero.
        return if chance.happens(0.3) { 0.0 } else { chance.sign() * size };
    }
    let positive = ["above zero", "not negative", "not below zero", "over", "stiffness", "coefficient", "greatest"];
    let signed = ["angle", "spin", "torque", "spin_or_speed", "force"].contains(&wanted.dimension)
        || told.contains("not zero")
        || told.contains("a negative one");
    let bounded = positive.iter().any(|bound| told.contains(bound)) && !told.contains("negative for");
    if signed && !bounded { chance.sign() * size } else { size }
}

/// The size of a number that a text with a unit gives.
pub fn with_unit(text: &str) -> Option<f64> {
    let (number, unit) = text.split_once(' ')?;
    let number: f64 = number.parse().ok()?;
    let units = [
        ("mm", 1e-3),
        ("cm", 1e-2),
        ("ms", 1e-3),
        ("deg", std::f64::consts::PI / 180.0),
        ("rpm", std::f64::consts::PI / 30.0),
        ("Hz", 1.0),
    ];
    units.into_iter().find(|(name, _)| *name == unit).map(|(_, factor)| number * factor)
}
