//! The error card: it ends every run and states how far to trust it.

use std::f64::consts::PI;
use std::fmt;

use bevy_ecs::prelude::*;
use serde::Serialize;

use super::advice::{Remedy, RunScales, rounded_down};
use super::at_rest;
use super::estimate::EstimatedError;
use super::verdict::{DISTRUST, Evidence};
use super::warnings::warnings;
use jostle_engine::contacts::search::OverlapAtStart;
use jostle_engine::contacts::{DeepestOverlap, Overlap};
use jostle_engine::integrate::ChosenMethod;
use jostle_engine::integrate::StepCount;
use jostle_engine::joints::Joint;
use jostle_engine::simulation::error::{ErrorEstimate, KnownError};
use jostle_engine::simulation::{Plan, Simulation};
use jostle_engine::tick::Notes;
use jostle_engine::tick::energy::EnergyLedger;
use jostle_engine::tick::{Failure, State, largest_travel, stands};
use jostle_engine::world::Name;
use jostle_engine::world::hash::state_hash;
use jostle_language::numbers::{number, percent, percentage};

/// The deepest overlap of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LargestOverlap {
    /// In metres.
    pub meters: f64,
    /// As a share of the smaller radius.
    pub share_of_radius: f64,
    /// The two bodies, or the body and the wall.
    pub bodies: Vec<String>,
    /// The time in seconds.
    pub time: f64,
}

impl fmt::Display for LargestOverlap {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (meters, share, time) = (number(self.meters), percentage(self.share_of_radius), number(self.time));
        write!(f, "{meters} m, {share} of the smaller radius, {} at t = {time} s", self.bodies.join(" and "))
    }
}

/// The largest gap between the two bodies of a joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LargestDrift {
    /// In metres.
    pub meters: f64,
    /// The joint.
    pub joint: String,
    /// The time in seconds.
    pub time: f64,
}

/// A residual of less than this share of the potential energy is rounding of sums.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The error card.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Card {
    /// Integration method.
    pub method: String,
    /// Length of a tick in seconds.
    pub tick: f64,
    /// Largest stable tick in seconds. It is the smallest measured on contacts of the run. If no bodies touched, it is
    /// the possible one of a single contact. `null` without contacts.
    pub critical_tick: Option<f64>,
    /// Events that were located inside ticks.
    pub events_located: u64,
    /// The energy ledger in J.
    pub energy: EnergyLedger,
    /// Momentum that is missing, in N s, per axis.
    pub momentum_residual: [f64; 2],
    /// Angular momentum about the origin that is missing, in N m s.
    pub angular_momentum_residual: f64,
    /// The deepest overlap in metres.
    pub largest_overlap: LargestOverlap,
    /// The deepest overlap as a share of the smaller radius.
    pub largest_overlap_share: LargestOverlap,
    /// The largest drift of a joint; nothing without joints.
    pub largest_joint_drift: Option<LargestDrift>,
    /// Greatest travel of any point in one tick over the smallest radius.
    pub largest_travel_share: f64,
    /// Simulated over spent time.
    pub real_time_factor: f64,
    /// Nanoseconds per atom and tick.
    pub ns_per_atom_tick: f64,
    /// Hash of the final state.
    pub hash: String,
    /// One plain line: how far to trust the result, and what would help.
    pub verdict: String,
    /// Every choice the engine made and every limit it applied.
    pub notes: Vec<String>,
    /// The estimated error; `null` until it is estimated.
    pub error: Option<ErrorEstimate>,
    /// The warnings of the run, which are among the notes too.
    #[serde(skip)]
    pub warnings: Vec<String>,
    #[serde(skip)]
    pub(super) shortest_contact: Option<f64>,
    /// The likely cause of a failed run, and a remedy.
    #[serde(skip)]
    pub why: Option<String>,
    #[serde(skip)]
    pub(super) missed: Option<String>,
    #[serde(skip)]
    pub(super) located: bool,
    #[serde(skip)]
    steps: StepCount,
    #[serde(skip)]
    ticks: u64,
    #[serde(skip)]
    pub(super) time: f64,
    #[serde(skip)]
    seconds_spent: f64,
    #[serde(skip)]
    pub(super) energy_scale: f64,
    #[serde(skip)]
    pub(super) given_back: f64,
    /// Whether nothing moves in it.
    #[serde(skip)]
    pub(super) stands: bool,
    /// Whether its steps were chosen for an error, and which that was.
    #[serde(skip)]
    asked: Option<Option<f64>>,
    /// The error that its steps may make, if their length follows from that.
    #[serde(skip)]
    allowed: Option<f64>,
}

/// The error card of a simulation, as a method.
pub trait SimulationExt {
    /// The error card of the present state.
    fn card(&self) -> Card;
}

impl SimulationExt for Simulation {
    fn card(&self) -> Card {
        Card::of(self.unpublished_world(), self.seconds_spent(), self.failure())
    }
}

impl Card {
    /// The card of the current state, after `seconds_spent` seconds of computing, with the failure of the run if it
    /// failed.
    pub fn of(world: &World, seconds_spent: f64, failure: Option<&Failure>) -> Self {
        let state = world.resource::<State>();
        let (bodies, clock, stability, ledger) = (state.bodies(), state.clock(), state.stability(), state.ledger());
        let method = world.get_resource::<ChosenMethod>().map_or("VelocityVerlet", |method| method.name);
        let time_scales = state.time_scales();
        let foreseen = stability.fastest_foreseen();
        let critical_tick = time_scales.fastest.map(|fastest| fastest.critical_tick(stability));
        let critical_tick = critical_tick.or(foreseen.map(|fastest| stability.limit / fastest.angular_frequency));
        let shortest_contact = time_scales.briefest.map(|brief| brief.duration());
        let shortest_contact = shortest_contact.or(stability.stiffest_contact().map(|frequency| PI / frequency));
        let energy = EnergyLedger::of(state);
        let (energy_scale, given_back) = (energy.turned_over(state), energy.given_back(state));
        let now = state.totals();
        let start = ledger.start.unwrap_or(now);
        let momentum = now.momentum - start.momentum;
        let atoms = bodies.atom_count().max(1) as f64 * clock.ticks.max(1) as f64;
        let smallest = bodies.smallest_radius;
        let share = |length: f64| if smallest.is_finite() { length / smallest } else { 0.0 };
        let estimated = world.get_resource::<EstimatedError>().cloned().unwrap_or_default();
        let known = KnownError::of(world);
        let known = known.as_ref();
        let mut card = Self {
            method: method.to_owned(),
            tick: clock.dt,
            critical_tick,
            events_located: state.located().count,
            energy,
            momentum_residual: [momentum.x - ledger.impulse[0].value(), momentum.y - ledger.impulse[1].value()],
            angular_momentum_residual: now.angular_momentum - start.angular_momentum - ledger.angular_impulse.value(),
            largest_overlap: told_overlap(world, |deepest| deepest.in_meters),
            largest_overlap_share: told_overlap(world, |deepest| deepest.in_share),
            largest_joint_drift: largest_joint_drift(state),
            largest_travel_share: share(largest_travel(state)),
            real_time_factor: if seconds_spent > 0.0 { clock.time() / seconds_spent } else { 0.0 },
            ns_per_atom_tick: seconds_spent * 1e9 / atoms,
            hash: format!("{:016x}", state_hash(bodies)),
            verdict: String::new(),
            notes: world.get_resource::<Notes>().map_or_else(Vec::new, |notes| notes.0.clone()),
            warnings: Vec::new(),
            error: estimated.estimate.or(known.filter(|_| failure.is_none()).and_then(|known| known.estimate)),
            shortest_contact,
            why: None,
            missed: known.and_then(|known| known.warning.clone()),
            located: ChosenMethod::locates(world),
            steps: state.steps(),
            ticks: clock.ticks,
            time: state.reached(),
            seconds_spent,
            energy_scale,
            given_back,
            stands: stands(state),
            asked: known.map(|known| known.tolerance),
            allowed: world.get_resource::<Plan>().and_then(Plan::allowed),
        };
        card.notes.extend(estimated.notes);
        card.notes.extend(state.models().flat_map(|model| model.remarks(state)));
        card.notes.extend(at_rest::notes(world));
        card.warnings = warnings(world, card.remedy());
        let evidence = Evidence { world, card: &card };
        let (missing, why) = (evidence.missing_energy(), failure.map(|failure| evidence.why(failure)));
        let verdict = match failure.zip(why.as_ref()) {
            Some((failure, why)) => format!("{DISTRUST}: the run went wrong: {failure}. {}.", crate::capital(why)),
            None => evidence.verdict(),
        };
        card.warnings.extend(missing);
        card.notes.extend(card.warnings.iter().map(|warning| format!("warning: {warning}")));
        (card.verdict, card.why) = (verdict, why);
        card
    }

    /// Whether the verdict is that nothing of the run is to be trusted.
    pub fn is_distrusted(&self) -> bool {
        self.verdict.starts_with(DISTRUST)
    }

    /// Energy residual over the energy turnover. It is zero if the residual is rounding of the energies, or if no body
    /// moves.
    pub fn energy_error(&self) -> f64 {
        if self.stands || self.energy.residual.abs() <= ROUNDING * self.energy.potential.abs() {
            return 0.0;
        }
        if self.energy_scale > 0.0 { self.energy.residual.abs() / self.energy_scale } else { 0.0 }
    }

    /// The next setting that this run should try; `None` if no finer one is possible.
    pub fn remedy(&self) -> Option<Remedy> {
        match self.asked {
            Some(tolerance) => tolerance.map(|tolerance| Remedy::Tolerance(tolerance / 10.0)),
            None if self.allowed.is_some() => self.allowed.map(Remedy::Tolerance),
            None if self.critical_tick == Some(0.0) => Some(Remedy::Method),
            None => Some(Remedy::Tick(self.known().advised_tick())),
        }
    }

    /// Whether its steps were chosen for an error that was asked for.
    pub(super) fn has_tolerance(&self) -> bool {
        self.tolerance().is_some()
    }

    /// The error that its user allows, as a share of how far and how fast bodies go.
    pub(super) fn tolerance(&self) -> Option<f64> {
        self.asked.flatten()
    }

    /// Whether its steps are its ticks, of the requested length.
    pub(super) fn by_ticks(&self) -> bool {
        self.asked.is_none() && self.allowed.is_none()
    }

    /// Whether its error is known from trials before it, and not from runs after it.
    pub(super) fn has_trials(&self) -> bool {
        self.asked.is_some()
    }

    /// The tick with which an error that falls with this power of it becomes `wanted`, rounded as people write it.
    pub(super) fn tick_for(&self, error: f64, wanted: f64, order: f64) -> f64 {
        rounded_down(self.tick * libm::pow(wanted / error, 1.0 / order).min(0.5))
    }

    fn known(&self) -> RunScales {
        let Self { tick, critical_tick: critical, shortest_contact, largest_travel_share: travel, .. } = *self;
        RunScales { tick, critical, shortest_contact, travel }
    }
}

/// The name of a body or wall.
pub(super) fn name(world: &World, entity: Entity) -> String {
    world.get::<Name>(entity).map_or_else(|| "(gone)".to_owned(), Name::to_string)
}

fn largest_joint_drift(state: &State) -> Option<LargestDrift> {
    let (drift, model) = state.joint_drift()?;
    let any: &dyn std::any::Any = model;
    let joint = any.downcast_ref::<Joint>().map_or_else(|| model.name().to_owned(), |joint| joint.name.clone());
    Some(LargestDrift { meters: drift.meters, joint, time: drift.time })
}

pub(super) fn told_overlap(world: &World, which: fn(&DeepestOverlap) -> Overlap) -> LargestOverlap {
    let mut deepest = DeepestOverlap::default();
    deepest.merge(world.resource::<State>().deepest_overlap());
    // Contacts do not see bars that cross each other.
    if let Some(&OverlapAtStart { overlap, share, between }) = world.get_resource() {
        deepest.merge(&DeepestOverlap::of(Overlap { overlap, share, between: Some(between), time: 0.0 }));
    }
    let deepest = which(&deepest);
    let name = |entity| name(world, entity);
    LargestOverlap {
        meters: deepest.overlap,
        share_of_radius: deepest.share,
        bodies: deepest.between.map_or_else(Vec::new, |(a, b)| vec![name(a), name(b)]),
        time: deepest.time,
    }
}

impl fmt::Display for Card {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let energy = &self.energy;
        let mut row = |label: &str, text: String| writeln!(f, "  {label:<18}{text}");
        let critical = self.critical_tick.map_or_else(
            || "no contacts".to_owned(),
            |critical| match critical {
                0.0 => "none is stable".to_owned(),
                _ => format!("critical {} s, used {}", number(critical), percentage(self.tick / critical)),
            },
        );
        row("method", format!("{}, tick {} s ({critical})", self.method, number(self.tick)))?;
        let StepCount { rejected, longest, shortened, .. } = self.steps;
        let accepted = self.steps.until(self.ticks);
        if accepted > 0 {
            let told = |many: u64, what: &str| if many > 0 { format!(", {many} {what}") } else { String::new() };
            let again = told(rejected, "made again") + &told(shortened, "shortened to resolve contacts");
            let events = self.events_located;
            row("steps", format!("{accepted} of up to {} s{again}; {events} events located", number(longest)))?;
        }
        row(
            "time",
            format!(
                "{} s in {} ticks, {:.3} s spent: {} x real time, {:.1} ns per atom and tick",
                number(self.time),
                self.ticks,
                self.seconds_spent,
                factor(self.real_time_factor),
                self.ns_per_atom_tick
            ),
        )?;
        row(
            "energy",
            parts(&[("kinetic", energy.kinetic), ("potential", energy.potential), ("elastic", energy.elastic)]),
        )?;
        row("energy lost", parts(&energy.losses().collect::<Vec<_>>()))?;
        row("work of drives", parts(&[("", energy.work)]))?;
        row(
            "energy residual",
            format!("{} J, {} of the energy that changed form", number(energy.residual), percent(self.energy_error())),
        )?;
        let [x, y] = self.momentum_residual;
        row(
            "momentum residual",
            format!("({x:.1e}, {y:.1e}) N s, angular {:.1e} N m s", self.angular_momentum_residual),
        )?;
        let overlap = &self.largest_overlap;
        let share = Some(&self.largest_overlap_share).filter(|share| share.share_of_radius > overlap.share_of_radius);
        for (label, told) in [("largest overlap", Some(overlap)), ("largest share", share)] {
            if let Some(told) = told.filter(|told| told.meters > 0.0) {
                row(label, told.to_string())?;
            }
        }
        if let Some(LargestDrift { meters, joint, time }) = &self.largest_joint_drift {
            let when = if *meters > 0.0 { format!(", `{joint}` at t = {} s", number(*time)) } else { String::new() };
            row("joint drift", format!("{meters:.1e} m at most{when}"))?;
        }
        row("largest travel", format!("{} of the smallest radius per tick", percentage(self.largest_travel_share)))?;
        if let Some(error) = &self.error {
            // The growth of chaos gives a horizon even beyond the end of the run.
            let horizon = error.horizon.filter(|horizon| *horizon < self.time);
            row("error", ErrorEstimate { horizon, ..*error }.to_string())?;
        }
        row("state hash", self.hash.clone())?;
        for note in &self.notes {
            row("note", note.clone())?;
        }
        write!(f, "  {}", self.verdict)
    }
}

/// A factor in whole numbers, or in two digits where these say more.
fn factor(value: f64) -> String {
    if value < 10.0 { number(format!("{value:.1e}").parse().unwrap_or(value)) } else { format!("{value:.0}") }
}

/// Energies with their names; those that are zero are left out, and nothing at all is `0 J`.
fn parts(parts: &[(&str, f64)]) -> String {
    let there: Vec<String> = parts
        .iter()
        .filter(|(_, value)| *value != 0.0)
        .map(|(name, value)| format!("{name} {} J", number(*value)))
        .collect();
    if there.is_empty() { "0 J".to_owned() } else { there.join(", ").trim_start().to_owned() }
}

#[cfg(test)]
mod tests {
    use super::factor;

    #[test]
    fn slow_runs_have_a_factor_too() {
        for (value, told) in [(0.000_321, "0.00032"), (0.4567, "0.46"), (1.04, "1"), (9.87, "9.9"), (12_345.6, "12346")]
        {
            assert_eq!(factor(value), told);
        }
    }
}
