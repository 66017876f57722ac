//! Benchmark of a scene: its ticks are timed in rounds. A plain loop does the same work without an engine.
//!
//! Both begin at the same state, and the springs of the plain loop are slack. They run by turns, round by round, so
//! that a slow phase of the computer affects both. The first round is not timed. A separate run measures the parts of a
//! tick, because measuring takes time.

mod grid;
mod memory;
mod plain_loop;
mod spread;

use crate::SimulationExt;
use std::time::{Duration, Instant};

pub use memory::resident;
pub use plain_loop::Plain;
pub use spread::Spread;

use jostle_engine::scene::SceneErrors;
use jostle_engine::simulation::{Plan, Simulation};
use jostle_engine::tick::stopwatch::{self, Stopwatch, TickPart};
use jostle_engine::tick::{Failure, State};

/// Ticks times atoms of a round: a fifth of a second, about.
const WORK: u64 = 2_000_000;
/// The same for quick measurements.
const QUICK_WORK: u64 = 100_000;
/// The least ticks of a round, unless it is quick. A round begins and ends with the state in components. To read it and
/// to write it back takes as long as some five ticks of a million sparse discs.
const LEAST: u64 = 50;

/// The order of a measurement.
#[derive(Clone, Copy, Debug)]
pub struct BenchRequest {
    /// Ticks of a round. `None`: a fifth of a second, but at least 50 ticks, within the duration of the scene.
    pub ticks: Option<u64>,
    /// The number of rounds that are timed.
    pub rounds: u32,
    /// Whether rounds are to be short.
    pub quick: bool,
    /// Seconds of physics that go ahead of everything.
    pub from: f64,
}

impl BenchRequest {
    /// Ticks of a round of a scene. They do not depend on how fast the computer is, so the state in the end does not either.
    pub fn ticks_of(&self, simulation: &Simulation) -> u64 {
        let (work, least) = if self.quick { (QUICK_WORK, 1) } else { (WORK, LEAST) };
        let cheap = (work / simulation.bodies().atom_count().max(1) as u64).max(least);
        let within = simulation.ticks().saturating_sub(self.first_tick(simulation)) / (u64::from(self.rounds) + 1);
        self.ticks.unwrap_or(cheap.min(within)).max(1)
    }

    /// Ticks that go ahead of everything.
    fn first_tick(&self, simulation: &Simulation) -> u64 {
        (self.from / simulation.clock().dt).round() as u64
    }

    /// The number of steps of a progress bar that one scene takes.
    pub fn steps(&self) -> u64 {
        u64::from(self.rounds) + 3
    }
}

/// The plain loop beside the engine.
#[derive(Clone, Copy, Debug)]
pub struct Beside {
    /// Nanoseconds of the plain loop per atom and tick.
    pub ns_per_atom_tick: Spread,
    /// Time of the engine over that of the plain loop, in each round.
    pub ratio: Spread,
    /// Kinetic energy of the plain loop at the end over that of the engine.
    pub kinetic_energy: f64,
}

/// The measurement of a scene.
#[derive(Clone, Debug)]
pub struct BenchResult {
    /// Bodies in the end.
    pub bodies: usize,
    /// Atoms in the end.
    pub atoms: usize,
    /// Ticks of a round.
    pub ticks: u64,
    /// Ticks in all, those ahead included.
    pub ticks_in_all: u64,
    /// Seconds of a tick.
    pub tick: f64,
    /// The method.
    pub method: String,
    /// Pairs of atoms, and of atoms and walls, that are near each other in the end.
    pub near: usize,
    /// Those of them that touch.
    pub touching: usize,
    /// Microseconds per tick.
    pub us_per_tick: Spread,
    /// Nanoseconds per atom and tick.
    pub ns_per_atom_tick: Spread,
    /// The plain loop, or the reason for its absence.
    pub plain: Result<Beside, &'static str>,
    /// Parts of the tick and their shares of it.
    pub stages: Vec<(&'static str, f64)>,
    /// Energy residual in J.
    pub residual: f64,
    /// The same as a share of the energy turnover.
    pub residual_share: f64,
    /// Hash of the state in the end.
    pub hash: String,
}

/// Why nothing was measured.
#[derive(Debug)]
pub enum Stopped {
    /// The scene is wrong.
    Scene(SceneErrors),
    /// The run failed.
    Run(Failure),
    /// The scene ends before anything is measured: after so many seconds.
    Ended(f64),
}

impl From<SceneErrors> for Stopped {
    fn from(errors: SceneErrors) -> Self {
        Self::Scene(errors)
    }
}

impl From<Failure> for Stopped {
    fn from(failure: Failure) -> Self {
        Self::Run(failure)
    }
}

/// Measures a scene. `load` reads it, and runs it by a plan if one is given. `step` is called after each step.
///
/// # Errors
/// When the scene is wrong, its run fails, or it ends before the measurement.
pub fn measure(
    load: impl Fn(Option<Plan>) -> Result<Simulation, SceneErrors>,
    order: BenchRequest,
    step: impl Fn(),
) -> Result<BenchResult, Stopped> {
    let mut engine = load(None)?;
    let ticks = order.ticks_of(&engine);
    let first = order.first_tick(&engine);
    if first > 0 && first >= engine.ticks() {
        return Err(Stopped::Ended(engine.ticks() as f64 * engine.clock().dt));
    }
    engine.run_to_tick(first)?;
    step();
    let atoms = engine.bodies().atom_count();
    let mut plain = Plain::of(&engine);
    let mut round = |plain: &mut Result<Plain, &'static str>| -> Result<(f64, f64), Failure> {
        let until = engine.clock().ticks + ticks;
        let spent = timed(|| engine.run_to_tick(until));
        spent.1?;
        let beside = plain.as_mut().map_or(Duration::ZERO, |plain| timed(|| plain.run(ticks)).0);
        step();
        Ok((spent.0.as_secs_f64(), beside.as_secs_f64()))
    };
    round(&mut plain)?;
    let rounds = (0..order.rounds).map(|_| round(&mut plain)).collect::<Result<Vec<_>, _>>()?;
    let of = |value: &dyn Fn(&(f64, f64)) -> f64| Spread::of(rounds.iter().map(value).collect());
    let per_tick = 1.0 / ticks as f64;
    let per_atom = 1e9 * per_tick / atoms.max(1) as f64;
    let card = engine.card();
    let (near, touching) = engine.resource::<State>().pairs().map_or((0, 0), |pairs| pairs.count(engine.bodies()));
    let beside = plain.map(|plain| Beside {
        ns_per_atom_tick: of(&|(_, plain)| plain * per_atom),
        ratio: of(&|(engine, plain)| engine / plain.max(1e-9)),
        kinetic_energy: plain.kinetic_energy() / card.energy.kinetic,
    });
    let measured = BenchResult {
        bodies: engine.bodies().len(),
        atoms,
        ticks,
        ticks_in_all: engine.clock().ticks,
        tick: card.tick,
        near,
        touching,
        us_per_tick: of(&|(engine, _)| engine * 1e6 * per_tick),
        ns_per_atom_tick: of(&|(engine, _)| engine * per_atom),
        plain: beside,
        stages: Vec::new(),
        residual: card.energy.residual,
        residual_share: card.energy_error(),
        hash: card.hash,
        method: card.method,
    };
    let plan = engine.plan().cloned();
    drop(engine);
    let mut watched = load(plan)?;
    stopwatch::watch(watched.world_mut());
    watched.run_to_tick(first + ticks)?;
    let before = watched.resource::<State>().stopwatch().cloned();
    watched.run_to_tick(first + 2 * ticks)?;
    step();
    Ok(BenchResult { stages: stages(before.as_ref(), watched.resource::<State>().stopwatch()), ..measured })
}

fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let start = Instant::now();
    let done = work();
    (start.elapsed(), done)
}

/// Shares of the time that was spent between two looks at a stopwatch.
fn stages(before: Option<&Stopwatch>, after: Option<&Stopwatch>) -> Vec<(&'static str, f64)> {
    let Some((before, after)) = before.zip(after) else { return Vec::new() };
    let parts = TickPart::ALL.into_iter().filter(|part| *part != TickPart::Between);
    let spent = |part| (after.spent(part) - before.spent(part)).as_secs_f64();
    let spent: Vec<_> = parts.map(|part| (part.name(), spent(part))).collect();
    let all: f64 = spent.iter().map(|(_, spent)| spent).sum();
    let counts = spent.into_iter().filter(|(_, spent)| *spent > 0.0);
    counts.map(|(name, spent)| (name, spent / all)).collect()
}
