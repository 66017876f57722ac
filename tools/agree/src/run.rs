//! A run of a scene as users make it: with an estimate of its error and a verdict.

use jostle::report::estimate::{Effort, EstimateRequest, Repeated, estimate, watch};
use jostle::scene::Source;
use jostle::simulation::{Overrides, Snapshot};
use jostle::{Simulation, SimulationExt};

use crate::scene::MOMENT;

/// A body at a moment: place in m, angle in rad.
type Pose = (f64, f64, f64);

/// The outcome of a run.
pub struct Ran {
    /// Numbers of moments of [`MOMENT`], with the bodies then; the last is the end.
    pub seen: Vec<(u64, Vec<Pose>)>,
    /// Greatest distance of any point of each body from its centre, in m.
    pub extents: Vec<f64>,
    /// The stated error of places in m.
    pub stated: Option<f64>,
    /// The time in s until which it holds.
    pub until: f64,
    /// The verdict of the card.
    pub verdict: String,
    /// The hash of the last state.
    pub hash: String,
    /// Evaluations of all forces, without trials and estimates.
    pub evaluations: u64,
}

/// The end of a run.
pub enum Outcome {
    /// It reached its end.
    Ran(Box<Ran>),
    /// The engine refuses the scene this way.
    Refused(String),
    /// The run failed, and says so.
    Failed(String),
    /// It took more evaluations than allowed.
    Long,
    /// A number was not finite, and the run said nothing.
    NotFinite,
}

/// Runs a scene, for at most so many evaluations of all forces.
pub fn run(text: &str, overrides: &Overrides, most: u64) -> Outcome {
    run_with(text, overrides, most, Effort::Little)
}

/// The same with another effort for the estimate of its error.
pub fn run_with(text: &str, overrides: &Overrides, most: u64, effort: Effort) -> Outcome {
    let source = Source::new("drawn.ron", text);
    let load = |overrides: &Overrides| Simulation::load_with(&source, overrides, |_| {});
    let mut simulation = match load(overrides) {
        Ok(simulation) => simulation,
        Err(errors) => return Outcome::Refused(errors.to_string()),
    };
    let wanted = EstimateRequest { effort, ..EstimateRequest::default() };
    watch(&mut simulation, wanted);
    let dt = simulation.clock().dt;
    let moments = (simulation.duration() / MOMENT).round() as u64;
    let mut seen = Vec::new();
    for moment in 1..=moments {
        let tick = (moment as f64 * MOMENT / dt).round();
        let met = (tick * dt - moment as f64 * MOMENT).abs() < 1e-12;
        let tick = if moment == moments { simulation.ticks() } else { tick as u64 };
        if let Err(failure) = simulation.run_to_tick(tick) {
            return Outcome::Failed(failure.to_string());
        }
        if met || moment == moments {
            let bodies = simulation.bodies();
            let pose = |body: usize| (bodies.position[body].x, bodies.position[body].y, bodies.angle[body]);
            let poses: Vec<Pose> = (0..bodies.len()).map(pose).collect();
            if poses.iter().any(|(x, y, angle)| !(x.is_finite() && y.is_finite() && angle.is_finite())) {
                return Outcome::NotFinite;
            }
            seen.push((moment, poses));
        }
        if simulation.state().evaluation().count > most {
            return Outcome::Long;
        }
    }
    let evaluations = simulation.state().evaluation().count;
    if let Err(errors) =
        estimate(&mut simulation, wanted, &Repeated { overrides, load: &load, tell: None, interrupted: None })
    {
        return Outcome::Refused(errors.to_string());
    }
    let card = simulation.card();
    let stated = card.error.and_then(|error| error.position.discretisation);
    let until = card.error.and_then(|error| error.horizon).unwrap_or(f64::INFINITY);
    let extents = simulation.bodies().extents().to_vec();
    Outcome::Ran(Box::new(Ran { seen, extents, stated, until, verdict: card.verdict, hash: card.hash, evaluations }))
}

/// Why a run in pieces, or from a snapshot, is another run; `None` if it is the same.
pub fn in_pieces(text: &str, overrides: &Overrides, whole: &str, mut piece: impl FnMut() -> u64) -> Option<String> {
    let source = Source::new("drawn.ron", text);
    let mut simulation = Simulation::load_with(&source, overrides, |_| {}).ok()?;
    let own = Overrides { plan: simulation.plan().cloned(), ..overrides.clone() };
    let saved_at = piece() % simulation.ticks().max(1);
    let mut saved = None;
    while simulation.clock().ticks < simulation.ticks() {
        let ticks = simulation.clock().ticks;
        if saved.is_none() && ticks >= saved_at {
            saved = simulation.snapshot().ok().map(|snapshot| snapshot.to_bytes());
        }
        let next = (ticks + 1 + piece() % 97).min(simulation.ticks());
        if let Err(failure) = simulation.run_to_tick(next) {
            return Some(format!("in pieces it fails: {failure}"));
        }
    }
    if simulation.card().hash != whole {
        return Some("in pieces it ends in another state".to_owned());
    }
    let snapshot = Snapshot::from_bytes(&saved?).ok()?;
    let mut resumed = Simulation::load_with(&source, &own, |_| {}).ok()?;
    if let Err(unfit) = resumed.restore(&snapshot) {
        return Some(format!("its snapshot does not fit: {unfit}"));
    }
    if let Err(failure) = resumed.run_to_end() {
        return Some(format!("from a snapshot it fails: {failure}"));
    }
    (resumed.card().hash != whole).then(|| "from a snapshot it ends in another state".to_owned())
}

impl Ran {
    /// Whether the verdict trusts all of it.
    pub fn is_trusted(&self) -> bool {
        self.verdict.starts_with("Trust it")
    }

    /// Whether it states an error of places that its verdict does not withdraw.
    pub fn states(&self) -> bool {
        let withdrawn = ["Do not trust it", "Do not trust places:", "Do not trust the places"];
        self.stated.is_some() && !withdrawn.iter().any(|words| self.verdict.contains(words))
    }

    /// The greatest distance in m of any point of a body from its place in another run, while both hold.
    pub fn apart(&self, other: &Self) -> f64 {
        let until = self.until.min(other.until) / MOMENT * (1.0 + 1e-9);
        let mut apart = 0.0_f64;
        for (moment, own) in self.seen.iter().filter(|(moment, _)| *moment as f64 <= until) {
            let Some((_, others)) = other.seen.iter().find(|(same, _)| same == moment) else { continue };
            for ((a, b), extent) in own.iter().zip(others).zip(&self.extents) {
                apart = apart.max((a.0 - b.0).hypot(a.1 - b.1) + (a.2 - b.2).abs() * extent);
            }
        }
        apart
    }
}
