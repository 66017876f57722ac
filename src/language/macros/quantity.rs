//! Numbers of expressions with their units (dimensional analysis), so that a length is never added to a mass.

use crate::units::{self, Powers};

/// Why an operation suits no such numbers, and perhaps a remedy.
pub(super) struct Unsuited {
    pub(super) message: String,
    pub(super) help: Option<String>,
}

impl From<String> for Unsuited {
    fn from(message: String) -> Self {
        Self { message, help: None }
    }
}

/// A number with the powers of its units. A number without units fits every quantity. It is then in SI units, as
/// everywhere in a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Number {
    pub(super) si: f64,
    pub(super) powers: Powers,
    /// The dimension that its unit names, if others have the same powers: joules are an energy, newton metres a torque.
    pub(super) named: Option<&'static str>,
}

impl Number {
    pub(super) const fn new(si: f64, powers: Powers) -> Self {
        Self { si, powers, named: None }
    }

    pub(super) const fn plain(si: f64) -> Self {
        Self::new(si, Powers { meter: 0, kilogram: 0, second: 0, radian: 0 })
    }

    /// The same with the dimension that a unit names.
    pub(super) fn named_by(self, unit: &str) -> Self {
        Self { named: units::named_as_written(unit, self.powers), ..self }
    }

    pub(super) fn is_plain(self) -> bool {
        self.powers == Powers::default()
    }

    /// The common units of two numbers that are added, subtracted or compared. Both have the same units, or one has
    /// none.
    pub(super) fn common(self, other: Self, verb: &str) -> Result<Powers, Unsuited> {
        if self.powers == other.powers || other.is_plain() {
            Ok(self.powers)
        } else if self.is_plain() {
            Ok(other.powers)
        } else {
            let message = format!("cannot {verb} {} and {}", self.kind(), other.kind());
            Err(Unsuited { message, help: self.without_angles(other) })
        }
    }

    /// The remedy for two numbers whose units differ only in radians, as those of `r omega^2` and an acceleration do.
    fn without_angles(self, other: Self) -> Option<String> {
        let more = combined(self.powers, other.powers, |a, b| (a - b).abs()).ok()?;
        (more == Powers { radian: more.radian, ..Powers::default() }).then(|| {
            format!(
                "they differ only in `{}`. An angle is a ratio of lengths: divide each angle by `1 rad`, as in `(ball.spin / 1 \
                 rad)^2`",
                units::base_units(more)
            )
        })
    }

    /// The product, or with `power` -1 the quotient.
    pub(super) fn times(self, other: Self, power: i32) -> Result<Self, String> {
        let si = if power < 0 { self.si / other.si } else { self.si * other.si };
        // A multiple of an energy is an energy.
        let named = if other.is_plain() { self.named } else { other.named.filter(|_| self.is_plain() && power == 1) };
        let other = combined(other.powers, Powers::default(), |a, _| a * power)?;
        let product = Self::new(si, combined(self.powers, other, |a, b| a + b)?).without_powers_of_angles();
        Ok(Self { named, ..product })
    }

    /// Angles are ratios of lengths. So a plain number over an angle is a plain number, as is the square of an angle.
    fn without_powers_of_angles(self) -> Self {
        let Powers { radian, .. } = self.powers;
        let only_angles = self.powers == Powers { radian, ..Powers::default() };
        if only_angles && radian != 1 { Self::plain(self.si) } else { self }
    }

    pub(super) fn raised(self, exponent: Self) -> Result<Self, String> {
        if !exponent.is_plain() {
            return Err(format!("an exponent is a plain number, not {}", exponent.kind()));
        }
        if self.is_plain() {
            return Ok(Self::plain(libm::pow(self.si, exponent.si)));
        }
        if exponent.si.fract() != 0.0 || exponent.si.abs() > 8.0 {
            return Err(format!("{} can only be raised to a whole power up to 8", self.kind()));
        }
        let power = exponent.si as i32;
        let powers = combined(self.powers, Powers::default(), |a, _| a * power)?;
        Ok(Self::new(libm::pow(self.si, exponent.si), powers).without_powers_of_angles())
    }

    pub(super) fn root(self) -> Result<Self, String> {
        let Powers { meter, kilogram, second, radian } = self.powers;
        if [meter, kilogram, second, radian].iter().any(|power| power % 2 != 0) {
            return Err(format!("{} has no square root in whole units", self.kind()));
        }
        Ok(Self::new(libm::sqrt(self.si), combined(self.powers, Powers::default(), |a, _| a / 2)?))
    }

    /// The quantity that it measures, for messages.
    pub(super) fn kind(self) -> String {
        self.named.map_or_else(|| units::name_of(self.powers).trim_end_matches(':').to_owned(), str::to_owned)
    }

    /// The text for a number or quantity in a scene, with every digit.
    pub(super) fn written(self) -> String {
        if self.is_plain() { self.digits() } else { format!("\"{}\"", self.shown()) }
    }

    /// The text within another text.
    pub(super) fn shown(self) -> String {
        if self.is_plain() { self.digits() } else { format!("{} {}", self.digits(), units::base_units(self.powers)) }
    }

    fn digits(self) -> String {
        const EXACT: f64 = (1_u64 << 53) as f64;
        let whole = self.si.fract() == 0.0 && self.si.abs() < EXACT && (self.si != 0.0 || self.si.is_sign_positive());
        if whole { format!("{}", self.si as i64) } else { format!("{:?}", self.si) }
    }
}

fn combined(a: Powers, b: Powers, with: impl Fn(i32, i32) -> i32) -> Result<Powers, String> {
    let of = |a: i8, b: i8| i8::try_from(with(a.into(), b.into())).ok().filter(|power| power.abs() < 10);
    let powers = || {
        Some(Powers {
            meter: of(a.meter, b.meter)?,
            kilogram: of(a.kilogram, b.kilogram)?,
            second: of(a.second, b.second)?,
            radian: of(a.radian, b.radian)?,
        })
    };
    powers().ok_or_else(|| "the powers of its units grow too large".to_owned())
}
