//! Quantities: numbers with a physical dimension.
//!
//! In a scene a quantity is a number in SI units (angles in radians) or a text with its unit. Examples are `0.3`, `"30 cm"`,
//! `"1 kN/m"` and `"90 deg/s"`. The dimension of the unit is checked, so that a mass is never read as a length. Powers of ten are
//! exact: `"57 cm"` is the same `f64` as `0.57`.
//!
//! A plugin may add its own dimension:
//!
//! ```
//! use jostle_language::units::{Dimension, Powers, Quantity};
//!
//! struct AngularStiffness;
//! impl Dimension for AngularStiffness {
//!     const NAME: &'static str = "an angular stiffness";
//!     const POWERS: Powers = Powers { meter: 2, kilogram: 1, second: -2, radian: -1 };
//!     const EXAMPLE: &'static str = "`2.5` or \"2.5 N m/rad\"";
//! }
//! let stiffness = Quantity::<AngularStiffness>::parse("3 kN mm/rad").unwrap();
//! assert_eq!(stiffness.si(), 3.0);
//! ```

mod either;
mod read;
mod unit_table;

use std::fmt;
use std::marker::PhantomData;

use glam::DVec2;

pub use either::{Either, Said};
pub use read::parse_si;
pub(crate) use read::{base_units, is_quantity, is_unit, name_of, named_as_written, number_length, value_in};

/// The powers of the base units meter, kilogram, second and radian in a unit.
///
/// The radian counts, although it is a number, so that a spin is not taken for a rate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Powers {
    /// Power of the meter.
    pub meter: i8,
    /// Power of the kilogram.
    pub kilogram: i8,
    /// Power of the second.
    pub second: i8,
    /// Power of the radian.
    pub radian: i8,
}

/// The physical dimension of a quantity.
pub trait Dimension: Send + Sync + 'static {
    /// The name with its article, for messages: `"a length"`.
    const NAME: &'static str;
    /// The powers of the base units.
    const POWERS: Powers;
    /// The SI unit of a bare number, for the manual. Default: the product of base units that the powers give.
    const UNIT: &'static str = "";
    /// Its two forms, for messages: a bare number and a text with a unit.
    const EXAMPLE: &'static str;
}

/// A number of a given dimension, kept in SI units.
pub struct Quantity<D> {
    si: f64,
    dimension: PhantomData<fn() -> D>,
}

/// The name of a dimension without its article.
pub fn plain_name<D: Dimension>() -> &'static str {
    let name = D::NAME.split_once(' ').map_or(D::NAME, |(_, name)| name);
    if name == "plain number" { "number" } else { name }
}

impl<D> Quantity<D> {
    /// A quantity from its value in SI units.
    pub const fn new(si: f64) -> Self {
        Self { si, dimension: PhantomData }
    }

    /// The value in SI units.
    pub const fn si(self) -> f64 {
        self.si
    }
}

impl<D: Dimension> Quantity<D> {
    /// Reads a text with a unit, such as `30 cm`.
    ///
    /// # Errors
    /// The error names the expected and the found value, in one sentence.
    pub fn parse(text: &str) -> Result<Self, String> {
        parse_si(text, D::NAME, D::POWERS, D::EXAMPLE).map(Self::new)
    }
}

impl<D> Clone for Quantity<D> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<D> Copy for Quantity<D> {}

impl<D> Default for Quantity<D> {
    fn default() -> Self {
        Self::new(0.0)
    }
}

impl<D> PartialEq for Quantity<D> {
    fn eq(&self, other: &Self) -> bool {
        self.si == other.si
    }
}

impl<D> fmt::Debug for Quantity<D> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.si, formatter)
    }
}

impl<D> From<Quantity<D>> for f64 {
    fn from(quantity: Quantity<D>) -> Self {
        quantity.si
    }
}

/// Two quantities of one dimension, written `(x, y)`; each may have its own unit.
pub struct QuantityPair<D> {
    /// The first.
    pub x: Quantity<D>,
    /// The second.
    pub y: Quantity<D>,
}

impl<D> QuantityPair<D> {
    /// A pair from its values in SI units.
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x: Quantity::new(x), y: Quantity::new(y) }
    }

    /// The values in SI units.
    pub const fn si(self) -> DVec2 {
        DVec2::new(self.x.si, self.y.si)
    }
}

impl<D> Clone for QuantityPair<D> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<D> Copy for QuantityPair<D> {}

impl<D> Default for QuantityPair<D> {
    fn default() -> Self {
        Self::new(0.0, 0.0)
    }
}

impl<D> PartialEq for QuantityPair<D> {
    fn eq(&self, other: &Self) -> bool {
        self.x == other.x && self.y == other.y
    }
}

impl<D> fmt::Debug for QuantityPair<D> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&(self.x, self.y), formatter)
    }
}

/// The SI unit of a dimension, such as `kg m2`; empty for plain numbers.
pub fn unit_of<D: Dimension>() -> String {
    match D::UNIT {
        "1" => String::new(),
        "" => read::base_units(D::POWERS),
        unit => unit.to_owned(),
    }
}

macro_rules! dimensions {
    ($($alias:ident = $marker:ident $name:literal [$meter:literal $kilogram:literal $second:literal $radian:literal] $example:literal $unit:literal;)*) => {
        /// The dimensions that come with the engine, as types without values.
        pub mod dimension {
            use super::{Dimension, Powers};
            $(
                #[doc = concat!($name, ", in ", $unit, ".")]
                pub enum $marker {}
                impl Dimension for $marker {
                    const NAME: &'static str = $name;
                    const POWERS: Powers =
                        Powers { meter: $meter, kilogram: $kilogram, second: $second, radian: $radian };
                    const EXAMPLE: &'static str = $example;
                    const UNIT: &'static str = $unit;
                }
            )*
        }
        $(
            #[doc = concat!($name, ", in ", $unit, ".")]
            pub type $alias = Quantity<dimension::$marker>;
        )*
        /// Names of dimensions for messages; the first that fits is used.
        pub(crate) const KNOWN: &[(&str, Powers)] = &[
            $(($name, Powers { meter: $meter, kilogram: $kilogram, second: $second, radian: $radian }),)*
        ];
    };
}

dimensions! {
    Scalar = OfNumber "a plain number" [0 0 0 0] "`0.3` or \"30 %\"" "1";
    Length = OfLength "a length" [1 0 0 0] "`0.3` or \"30 cm\"" "m";
    Area = OfArea "an area" [2 0 0 0] "`0.5` or \"50 cm2\"" "m2";
    Mass = OfMass "a mass" [0 1 0 0] "`0.0025` or \"2.5 g\"" "kg";
    Time = OfTime "a time" [0 0 1 0] "`0.001` or \"1 ms\"" "s";
    Rate = OfRate "a rate" [0 0 -1 0] "`250` or \"250 Hz\"" "Hz";
    Angle = OfAngle "an angle" [0 0 0 1] "`0.7` (radians) or \"40 deg\"" "rad";
    Speed = OfSpeed "a speed" [1 0 -1 0] "`0.2` or \"20 cm/s\"" "m/s";
    Spin = OfSpin "a spin" [0 0 -1 1] "`0.5` (rad/s), \"90 deg/s\" or \"3 rpm\"" "rad/s";
    Acceleration = OfAcceleration "an acceleration" [1 0 -2 0] "`9.81` or \"9.81 m/s2\"" "m/s2";
    Force = OfForce "a force" [1 1 -2 0] "`2` or \"2 N\"" "N";
    Torque = OfTorque "a torque" [2 1 -2 0] "`0.05` or \"0.05 N m\"" "N m";
    Energy = OfEnergy "an energy" [2 1 -2 0] "`0.05` or \"50 mJ\"" "J";
    Power = OfPower "a power" [2 1 -3 0] "`5` or \"5 W\"" "W";
    Stiffness = OfStiffness "a stiffness" [0 1 -2 0] "`1000` or \"1 kN/m\"" "N/m";
    Damping = OfDamping "a damping" [0 1 -1 0] "`0.1` or \"0.1 N s/m\"" "N s/m";
    QuadraticDamping = OfQuadraticDamping "a quadratic damping" [-1 1 0 0] "`0.02` or \"0.02 N s2/m2\"" "N s2/m2";
    Density = OfDensity "a density" [-2 1 0 0] "`2.5` or \"2.5 kg/m2\"" "kg/m2";
    Inertia = OfInertia "a moment of inertia" [2 1 0 0] "`0.2` or \"0.2 kg m2\"" "kg m2";
}

/// A place or distance `(x, y)`, in m.
pub type LengthPair = QuantityPair<dimension::OfLength>;
/// A velocity `(x, y)`, in m/s.
pub type SpeedPair = QuantityPair<dimension::OfSpeed>;
/// An acceleration `(x, y)`, in m/s2.
pub type AccelerationPair = QuantityPair<dimension::OfAcceleration>;
/// A force `(x, y)`, in N.
pub type ForcePair = QuantityPair<dimension::OfForce>;
