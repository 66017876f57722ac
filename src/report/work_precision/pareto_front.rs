//! The choice of a setting: the cheapest for each wanted error, from the Pareto front of cost and error.

use super::{Setting, Settings};

/// Errors that advice is given for, with the names of their grades.
pub const TARGETS: [(&str, f64); 3] = [("bronze", 1e-2), ("silver", 1e-4), ("gold", 1e-8)];

/// Errors beyond this share of the motion are of no use.
pub(crate) const USELESS: f64 = 1.0;
/// ... and no larger error is advised.
const ADVISED: f64 = 0.1;

/// The setting for a wanted error.
#[derive(Clone, Copy, Debug)]
pub struct Advice<'a> {
    /// The error that is wanted.
    pub target: f64,
    /// The cheapest setting that reaches it.
    pub reached: Option<&'a Setting>,
    /// The most exact setting of all, if none reaches the error and it is useful.
    pub nearest: Option<&'a Setting>,
}

impl Settings {
    /// Claimed error and cost of the settings that have both.
    fn known(&self) -> impl Iterator<Item = (&Setting, f64, f64)> {
        self.all.iter().filter_map(|setting| Some((setting, self.claimed(setting)?, setting.cost(self.cost)?)))
    }

    /// The settings for each of [`TARGETS`].
    pub fn advice(&self) -> Vec<Advice<'_>> {
        TARGETS.into_iter().map(|(_, target)| self.advice_for(target)).collect()
    }

    fn advice_for(&self, target: f64) -> Advice<'_> {
        let good = self.known().filter(|(_, error, _)| *error <= target);
        let reached = good.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(setting, ..)| setting);
        let nearest = self.known().filter(|(_, error, _)| *error < ADVISED);
        let nearest = nearest.min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
        Advice { target, reached, nearest: nearest.map(|(setting, ..)| setting).filter(|_| reached.is_none()) }
    }

    /// Whether no other setting dominates it: none is as exact for less, or more exact for the same cost.
    pub fn is_best(&self, setting: &Setting) -> bool {
        let Some((error, cost)) = self.claimed(setting).zip(setting.cost(self.cost)) else { return false };
        let beats = |(_, other, price): (&Setting, f64, f64)| {
            (other <= error && price < cost) || (other < error && price <= cost)
        };
        error < USELESS && !self.known().any(beats)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Cost, Deviation, MethodChoice, Setting, SettingOutcome, Settings};

    fn settings() -> Settings {
        let measured = |method, tick, error, seconds| {
            let outcome = SettingOutcome::Measured(Deviation { error, apart: None });
            Setting { outcome, seconds: Some(seconds), ..Setting::new(MethodChoice::of(method), tick) }
        };
        let failed =
            Setting { outcome: SettingOutcome::Refused("no".to_owned()), ..Setting::new(MethodChoice::of("B"), 1.0) };
        let all = vec![
            measured("A", 0.1, 5e-3, 1e-4),
            measured("A", 0.01, 5e-5, 1e-3),
            failed,
            measured("B", 0.1, 1e-9, 5e-4),
        ];
        Settings { all, ends: Vec::new(), cost: Cost::Time, claim: Some(1e-12) }
    }

    #[test]
    fn the_cheapest_that_is_good_enough_is_found() {
        let settings = settings();
        let found: Vec<_> =
            settings.advice().iter().map(|advice| advice.reached.map(|s| (s.course.method, s.tick))).collect();
        assert_eq!(found, [Some(("A", 0.1)), Some(("B", 0.1)), Some(("B", 0.1))]);
        assert_eq!(settings.advice_for(1e-10).reached.map(|s| s.tick), None);
        assert_eq!(settings.advice_for(1e-10).nearest.map(|s| s.course.method), Some("B"));
        assert_eq!(settings.courses().len(), 2);
        // The second is beaten by the last, which is more exact for less.
        let best: Vec<bool> = settings.all.iter().map(|setting| settings.is_best(setting)).collect();
        assert_eq!(best, [true, false, false, true]);
    }
}
