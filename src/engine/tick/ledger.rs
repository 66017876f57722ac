//! The accounts of energy, momentum and angular momentum: the amounts that enter and leave the bodies.
//!
//! Forces write the rates of the current evaluation into [`Rates`]. The integrator books them in the [`Ledger`] with
//! the weights with which it applies the forces. A momentum residual is then rounding, except for joints that are put
//! back onto their limits. An energy residual is the error of the integration.

use glam::DVec2;

use super::State;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// Rates of the present evaluation. Cleared before each; every force adds its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// Force from outside the bodies in newtons: fields, walls, fixed bodies, drag, drives.
    pub force: DVec2,
    /// Its torque about the origin in N m.
    pub torque: f64,
    /// Power that drag takes, in watts.
    pub drag: f64,
    /// Power that drives (thrust, torque, forces of plugins) bring, in watts.
    pub work: f64,
    /// Power that friction takes, in watts. It includes that of contacts only if they are evaluated in stages of a
    /// step. Otherwise their losses are booked at once.
    pub friction: f64,
    /// Power that the inelasticity of contacts takes, in watts, likewise.
    pub inelasticity: f64,
    /// Set by a model that responds nearly as fast as the tick allows. From then on energy is checked after each tick.
    pub alert: bool,
}

impl Rates {
    /// Adds the rates of another.
    pub fn add(&mut self, other: &Self) {
        self.force += other.force;
        self.torque += other.torque;
        self.drag += other.drag;
        self.work += other.work;
        self.friction += other.friction;
        self.inelasticity += other.inelasticity;
        self.alert |= other.alert;
    }

    /// Books an external force on a body at `position`, with its torque about the centre of mass.
    #[inline]
    pub fn outside(&mut self, position: DVec2, force: DVec2, torque: f64) {
        self.force += force;
        self.torque += position.perp_dot(force) + torque;
    }
}

/// A sum that keeps what rounding leaves over (Neumaier 1974): a million ticks add up like one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sum {
    sum: f64,
    rest: f64,
}

impl Sum {
    /// Adds a term.
    #[inline]
    pub fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        let (large, small) = if self.sum.abs() >= term.abs() { (self.sum, term) } else { (term, self.sum) };
        self.rest += (large - sum) + small;
        self.sum = sum;
    }

    /// The sum.
    pub fn value(&self) -> f64 {
        self.sum + self.rest
    }
}

/// The sums since the beginning.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Energy lost to friction in J.
    pub friction: Sum,
    /// Energy lost to the inelasticity of contacts in J.
    pub inelasticity: Sum,
    /// Energy lost to drag in J.
    pub drag: Sum,
    /// Energy lost to accounts of models in J, in the order in which models name them.
    #[serde(with = "sums")]
    pub accounts: Vec<(&'static str, Sum)>,
    /// Work done by drives in J.
    pub work: Sum,
    /// The same, but power that a drive takes counts positive too. So a drive that swings to and fro has work, even if
    /// its net work is zero. Added up without compensation.
    pub gross_work: f64,
    /// Impulse from outside in N s, per axis.
    pub impulse: [Sum; 2],
    /// Angular impulse from outside about the origin in N m s.
    pub angular_impulse: Sum,
    /// The state at the beginning.
    pub start: Option<Totals>,
}

/// Accounts of models in snapshots: sums in the order of the accounts, whose names follow from the scene.
mod sums {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::Sum;

    pub fn serialize<S: Serializer>(accounts: &[(&'static str, Sum)], to: S) -> Result<S::Ok, S::Error> {
        accounts.iter().map(|account| account.1).collect::<Vec<Sum>>().serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(&'static str, Sum)>, D::Error> {
        Ok(Vec::<Sum>::deserialize(from)?.into_iter().map(|sum| ("", sum)).collect())
    }
}

/// Entries of the ledger and channels of energy that no account of a model may be called by.
const OWN_ACCOUNTS: [&str; 9] =
    ["kinetic", "potential", "elastic", "friction", "inelasticity", "drag", "work", "residual", "total"];

impl Ledger {
    /// Books the rates of an evaluation over `dt` seconds.
    pub fn book(&mut self, rates: &Rates, dt: f64) {
        self.impulse[0].add(rates.force.x * dt);
        self.impulse[1].add(rates.force.y * dt);
        self.angular_impulse.add(rates.torque * dt);
        self.drag.add(rates.drag * dt);
        if rates.friction != 0.0 {
            self.friction.add(rates.friction * dt);
        }
        self.book_work(rates.work * dt);
    }

    /// The energy lost to an account of models in J; `None` if no model has it.
    pub fn lost(&self, account: &str) -> Option<f64> {
        self.accounts.iter().find(|(name, _)| *name == account).map(|(_, lost)| lost.value())
    }

    /// The index of an account, which is opened if it is new.
    ///
    /// # Panics
    /// If the name is empty or one of the engine's: cards and JSON would have two entries of one name.
    pub(super) fn account(&mut self, account: &'static str) -> usize {
        assert!(
            !account.is_empty() && !OWN_ACCOUNTS.contains(&account),
            "`Model::loss`: an account cannot be called `{account}`, the ledger has its own entries: {OWN_ACCOUNTS:?}"
        );
        let known = self.accounts.iter().position(|(name, _)| *name == account);
        known.unwrap_or_else(|| {
            self.accounts.push((account, Sum::default()));
            self.accounts.len() - 1
        })
    }

    /// Books work of drives.
    #[inline]
    pub fn book_work(&mut self, work: f64) {
        self.work.add(work);
        self.gross_work += work.abs();
    }

    /// The positive work of drives, in J.
    pub fn put_in(&self) -> f64 {
        0.5 * (self.gross_work + self.work.value())
    }
}

impl State {
    /// Books what others changed between two ticks (bodies spawned, velocities set ...) as work and impulse. The first
    /// state of all becomes the start.
    pub(super) fn book_exchange(&mut self, before: Totals) {
        let after = self.totals();
        let ledger = &mut self.ledger;
        if ledger.start.is_none() {
            ledger.start = Some(after);
            return;
        }
        ledger.book_work(after.energy() - before.energy());
        ledger.impulse[0].add(after.momentum.x - before.momentum.x);
        ledger.impulse[1].add(after.momentum.y - before.momentum.y);
        ledger.angular_impulse.add(after.angular_momentum - before.angular_momentum);
    }
}

/// Energy and momentum of a state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// Kinetic energy in J.
    pub kinetic: f64,
    /// Energy in fields in J.
    pub potential: f64,
    /// Energy in springs and contacts in J.
    pub elastic: f64,
    /// Momentum in N s.
    pub momentum: DVec2,
    /// Angular momentum about the origin in N m s.
    pub angular_momentum: f64,
}

impl Totals {
    /// Those of bodies that have so much energy in fields, and in springs and contacts.
    pub(super) fn with(bodies: &Bodies, potential: f64, elastic: f64) -> Self {
        Self {
            kinetic: kinetic_energy(bodies),
            potential,
            elastic,
            momentum: momentum(bodies),
            angular_momentum: angular_momentum(bodies),
        }
    }

    /// Kinetic, potential and elastic energy together, in J.
    pub fn energy(&self) -> f64 {
        self.kinetic + self.potential + self.elastic
    }
}

/// Momentum of all dynamic bodies in N s.
pub fn momentum(bodies: &Bodies) -> DVec2 {
    dynamic(bodies).map(|b| bodies.velocity[b] * bodies.mass[b]).sum()
}

/// Angular momentum of all dynamic bodies about the origin in N m s.
pub fn angular_momentum(bodies: &Bodies) -> f64 {
    let of = |b: usize| {
        bodies.mass[b] * bodies.position[b].perp_dot(bodies.velocity[b]) + bodies.inertia[b] * bodies.spin[b]
    };
    dynamic(bodies).map(of).fold(0.0, |sum, term| sum + term)
}

/// Kinetic energy of all dynamic bodies in J.
pub fn kinetic_energy(bodies: &Bodies) -> f64 {
    (0..bodies.len()).map(|body| bodies.kinetic_energy(body)).fold(0.0, |sum, term| sum + term)
}

fn dynamic(bodies: &Bodies) -> impl Iterator<Item = usize> + '_ {
    (0..bodies.len()).filter(|&b| bodies.dynamic[b])
}

#[cfg(test)]
mod tests {
    use super::Sum;

    #[test]
    fn a_sum_keeps_what_rounding_leaves_over() {
        let mut sum = Sum::default();
        let mut plain = 0.0_f64;
        for _ in 0..10_000_000 {
            sum.add(0.1);
            plain += 0.1;
        }
        // 0.1 is not representable. The exact sum of the terms is 1e7 x fl(0.1), within half a unit of 1e6.
        assert!((sum.value() - 1e6).abs() <= 1e6 * f64::EPSILON, "{}", sum.value());
        assert!((plain - 1e6).abs() > 1e-5, "the plain sum should be visibly off: {plain}");
    }
}
