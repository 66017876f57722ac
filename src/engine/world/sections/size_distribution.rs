//! Distributions of radii, drawn by inverse transform (uniform, discrete) or by the transform of Box and Muller (1958).
//!
//! The random generator is the same on every machine, and functions come from `libm`. So the same seed gives the same radii to
//! the last bit.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::units::Length;
use crate::scene::{Diagnostics, exact};

/// Places and radii of a fill come from different streams of one seed.
const STREAM: u64 = 1;

/// The distribution of radii.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Radii {
    /// `Uniform(0.01, 0.02)`: every radius from the first to the second in m is as likely.
    Uniform(Length, Length),
    /// `LogNormal(mean: 0.01, deviation: 0.002)`: the logarithm of the radius is normally distributed.
    LogNormal {
        /// The mean of the radius in m. Above zero.
        mean: Length,
        /// Its standard deviation in m. Not negative.
        deviation: Length,
        /// The least radius in m. Chance draws smaller ones anew. Default: 0.
        #[serde(default)]
        least: Length,
        /// The greatest radius in m. Chance draws larger ones anew. Default: none.
        most: Option<Length>,
    },
    /// `Choice([0.01, 0.02])`: one of these radii in m, each as likely. A radius that stands twice is twice as likely.
    Choice(Vec<Length>),
}

/// A radius is drawn so often at most until one is within the limits.
const TRIES: usize = 100;

impl Radii {
    /// Reports radii that are not above zero, and limits in the wrong order. It also reports limits that leave too few of `count`
    /// radii.
    pub fn check(&self, count: usize, seed: u64, report: &mut Diagnostics) {
        match self {
            Self::Uniform(low, high) => {
                let good = report.positive("[0]", *low) && report.positive("[1]", *high);
                if good && low.si() > high.si() {
                    report
                        .error("", upside_down(*low, *high))
                        .help("give the least first, such as `Uniform(0.01, 0.02)`");
                }
            }
            Self::LogNormal { mean, deviation, least, most } => {
                let good = report.positive("mean", *mean)
                    && report.not_negative("deviation", *deviation)
                    && report.not_negative("least", *least)
                    && report.positive_if_given("most", *most);
                if let Some(most) = most.filter(|most| good && least.si() > most.si()) {
                    report
                        .error("", upside_down(*least, most))
                        .help("let `least` be at most `most`, or leave them out");
                    return;
                }
                let drawn = if good { self.draw(count, seed).len() } else { count };
                if drawn < count {
                    let message = format!(
                        "only {drawn} of {count} radii are from `least` to `most`: of {TRIES} that were drawn for the next, none is"
                    );
                    report
                        .error("", message)
                        .help("move `least` and `most` to both sides of `mean`, or leave them out");
                }
            }
            Self::Choice(radii) => {
                if radii.is_empty() {
                    report.error("", "there is no radius to choose").help("for example `Choice([0.01, 0.02])`");
                }
                for (index, radius) in radii.iter().enumerate() {
                    report.positive(&format!("[{index}]"), *radius);
                }
            }
        }
    }

    /// So many radii by chance, in m. They are fewer only if a check would refuse the distribution.
    pub fn draw(&self, count: usize, seed: u64) -> Vec<f64> {
        let mut chance = chance(seed);
        std::iter::from_fn(|| self.drawn(&mut chance)).take(count).collect()
    }

    /// One radius by chance, in m; `None` if the limits let none of many through.
    fn drawn(&self, chance: &mut impl FnMut() -> f64) -> Option<f64> {
        match self {
            Self::Uniform(low, high) => Some(low.si() + (high.si() - low.si()) * chance()),
            Self::Choice(radii) => {
                let index = (radii.len() as f64 * chance()) as usize;
                radii.get(index).or(radii.last()).map(|radius| radius.si())
            }
            Self::LogNormal { mean, deviation, least, most } => {
                let share = deviation.si() / mean.si();
                let variance = libm::log1p(share * share);
                let middle = libm::log(mean.si()) - 0.5 * variance;
                let limits = least.si()..=most.map_or(f64::INFINITY, Length::si);
                let mut radius = || libm::exp(middle + variance.sqrt() * normal(chance));
                (0..TRIES).map(|_| radius()).find(|radius| limits.contains(radius))
            }
        }
    }
}

fn upside_down(least: Length, most: Length) -> String {
    format!("the least radius, {} m, is above the greatest, {} m", exact(least.si()), exact(most.si()))
}

/// Numbers from 0 up to, not including, 1: the upper 53 bits.
fn chance(seed: u64) -> impl FnMut() -> f64 {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(STREAM);
    move || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// A number of the normal distribution with mean 0 and deviation 1.
fn normal(chance: &mut impl FnMut() -> f64) -> f64 {
    let radius = (-2.0 * libm::log1p(-chance())).sqrt();
    radius * libm::cos(std::f64::consts::TAU * chance())
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: usize = 10_000;

    /// Mean and standard deviation of some numbers.
    fn moments(numbers: &[f64]) -> (f64, f64) {
        let count = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / count;
        (mean, (numbers.iter().map(|number| (number - mean).powi(2)).sum::<f64>() / count).sqrt())
    }

    /// Laws: `Uniform(a, b)` has the mean `(a + b)/2` and the deviation `(b - a)/sqrt(12)`. `LogNormal` has those that it is
    /// given, `Choice` those of its list. Tolerance: five standard errors, `5 s/sqrt(n)` of the mean and
    /// `5 s sqrt((k - 1)/(4 n))` of the deviation. The kurtosis `k` is 1.8 for the uniform distribution and 1.5 for three equal
    /// steps. For the log-normal distribution with `s/m = 0.2` it is 3.7. By chance that fails once in a million seeds.
    #[test]
    fn radii_follow_their_distribution() {
        let length = Length::new;
        let lognormal =
            Radii::LogNormal { mean: length(0.01), deviation: length(0.002), least: length(0.0), most: None };
        let choice = Radii::Choice([0.01, 0.02, 0.03].map(length).to_vec());
        let third = (2.0_f64 / 3.0).sqrt();
        for (radii, mean, deviation, kurtosis) in [
            (Radii::Uniform(length(0.01), length(0.02)), 0.015, 0.01 / 12.0_f64.sqrt(), 1.8),
            (lognormal, 0.01, 0.002, 3.7),
            (choice, 0.02, 0.01 * third, 1.5),
        ] {
            for seed in [0, 7] {
                let drawn = radii.draw(COUNT, seed);
                let (found, spread) = moments(&drawn);
                let errors = 5.0 * deviation / (COUNT as f64).sqrt();
                assert!((found - mean).abs() < errors, "{radii:?}: mean {found}");
                let errors = errors * ((kurtosis - 1.0_f64) / 4.0).sqrt();
                assert!((spread - deviation).abs() < errors, "{radii:?}: deviation {spread}");
                assert_eq!(drawn, radii.draw(COUNT, seed), "the same seed gives the same radii");
            }
            assert_ne!(radii.draw(9, 0), radii.draw(9, 7));
        }
    }

    #[test]
    fn limits_are_kept() {
        let (mean, deviation) = (Length::new(1.0), Length::new(0.5));
        let radii = Radii::LogNormal { mean, deviation, least: Length::new(0.8), most: Some(Length::new(1.1)) };
        assert!(radii.draw(COUNT, 3).iter().all(|radius| (0.8..=1.1).contains(radius)));
    }
}
