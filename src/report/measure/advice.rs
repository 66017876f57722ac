//! Which setting to take: the cheapest for each wanted error, among those that nothing else beats.

use super::{Cost, Measured, Setting};

/// Errors that advice is given for, as shares of the motion.
pub const TARGETS: [f64; 3] = [1e-2, 1e-4, 1e-8];

/// Errors beyond this are of no use: they are as large as the motion.
pub(super) const USELESS: f64 = 1.0;

/// What to take for a wanted error.
#[derive(Clone, Copy, Debug)]
pub struct Advice<'a> {
    /// The error that is wanted.
    pub target: f64,
    /// The cheapest setting that reaches it.
    pub reached: Option<&'a Setting>,
    /// The most exact setting of all, where none does and it is of any use.
    pub nearest: Option<&'a Setting>,
}

impl Setting {
    /// What it costs per second of physics.
    pub fn cost(&self, cost: Cost) -> Option<f64> {
        match cost {
            Cost::Time => self.seconds,
            Cost::Evaluations => Some(self.evaluations),
        }
    }
}

impl Measured {
    /// The error that may be claimed of a setting: none below a few times what the reference run itself errs by.
    pub fn claimed(&self, setting: &Setting) -> Option<f64> {
        let least = self.reference.as_ref().ok()?.claim();
        setting.error().map(|error| error.max(least))
    }

    /// Claimed error and cost of the settings that have both.
    fn known(&self) -> impl Iterator<Item = (&Setting, f64, f64)> {
        self.settings.iter().filter_map(|setting| Some((setting, self.claimed(setting)?, setting.cost(self.cost)?)))
    }

    /// What to take for each of [`TARGETS`].
    pub fn advice(&self) -> Vec<Advice<'_>> {
        let for_target = |target: f64| {
            let good = self.known().filter(|(_, error, _)| *error <= target);
            let reached = good.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(setting, ..)| setting);
            let nearest = self.known().filter(|(_, error, _)| *error < USELESS);
            let nearest = nearest.min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
            Advice { target, reached, nearest: nearest.map(|(setting, ..)| setting).filter(|_| reached.is_none()) }
        };
        TARGETS.into_iter().map(for_target).collect()
    }
}

/// Whether a setting is beaten by no other: none is as exact for less, or more exact for as little.
pub fn is_best(measured: &Measured, setting: &Setting) -> bool {
    let Some((error, cost)) = measured.claimed(setting).zip(setting.cost(measured.cost)) else { return false };
    let beats =
        |(_, other, price): (&Setting, f64, f64)| (other <= error && price < cost) || (other < error && price <= cost);
    error < USELESS && !measured.known().any(beats)
}
