//! Runs as users make them: with an estimate of the error and a verdict.

use jostle::report::card::Card;
use jostle::report::estimate::{Effort, EstimateRequest, Repeated, estimate, watch};
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

/// A body at a moment: place in m, angle in rad, velocity in m/s.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    pub place: glam::DVec2,
    pub angle: f64,
    pub velocity: glam::DVec2,
}

/// What was seen of a run.
pub struct Ran {
    /// Times in s with the bodies then; the last is the end.
    pub seen: Vec<(f64, Vec<Pose>)>,
    /// Greatest distance of a point of each body from its centre, in m.
    pub extents: Vec<f64>,
    pub card: Card,
}

/// Runs a scene to its end, and estimates nothing.
pub fn end(text: &str) -> Result<Ran, String> {
    run_with(text, 1, Effort::None)
}

/// Runs a scene to its end, looks at it `looks` times, and estimates its error as `jostle run` does.
pub fn run(text: &str, looks: u64) -> Result<Ran, String> {
    run_with(text, looks, Effort::Little)
}

fn run_with(text: &str, looks: u64, effort: Effort) -> Result<Ran, String> {
    let source = Source::new("audit.ron", text);
    let load = |overrides: &Overrides| Simulation::load_with(&source, overrides, |_| {});
    let overrides = Overrides::default();
    let mut simulation = load(&overrides).map_err(|errors| errors.to_string())?;
    let wanted = EstimateRequest { effort, ..EstimateRequest::default() };
    watch(&mut simulation, wanted);
    let mut seen = Vec::new();
    for look in 1..=looks {
        simulation.run_to_tick(simulation.ticks() * look / looks).map_err(|failure| failure.to_string())?;
        let bodies = simulation.bodies();
        let pose = |body: usize| Pose {
            place: bodies.position[body],
            angle: bodies.angle[body],
            velocity: bodies.velocity[body],
        };
        seen.push((simulation.clock().time(), (0..bodies.len()).map(pose).collect()));
    }
    let repeated = Repeated { overrides: &overrides, load: &load, tell: None, interrupted: None };
    estimate(&mut simulation, wanted, &repeated).map_err(|errors| errors.to_string())?;
    Ok(Ran { seen, extents: simulation.bodies().extents().to_vec(), card: simulation.card() })
}

impl Ran {
    /// The stated error of places in m, and until when in s.
    pub fn stated(&self) -> Option<(f64, f64)> {
        let error = self.card.error?;
        Some((error.position.discretisation?, error.horizon.unwrap_or(f64::INFINITY)))
    }

    /// Whether the verdict is trust without a condition.
    pub fn is_trusted(&self) -> bool {
        self.card.verdict.starts_with("Trust it:")
    }

    /// Whether the verdict trusts the places of the end, though perhaps not to the digits asked for.
    pub fn trusts_places(&self) -> bool {
        let trusted = self.card.verdict.split("Do not trust").next().unwrap_or_default();
        trusted.contains("places to about")
    }

    /// The greatest distance in m of any point of a body from where it is in another run, at the end.
    pub fn apart(&self, other: &Self) -> f64 {
        let (Some((_, own)), Some((_, others))) = (self.seen.last(), other.seen.last()) else { return f64::INFINITY };
        let pairs = own.iter().zip(others).zip(&self.extents);
        let apart = pairs.map(|((a, b), extent)| (a.place - b.place).length() + (a.angle - b.angle).abs() * extent);
        apart.fold(0.0, f64::max)
    }
}

/// Rounding of places of some metres over thousands of steps, in m.
const ROUNDING: f64 = 1e-12;

/// All runs of a scene agree whose places are trusted, to three times what they state. At least `trusted` of them are.
pub fn demand_agreement(name: &str, clocks: &[&str], trusted: usize, scene: impl Fn(&str) -> String) {
    demand_agreement_within(3.0, name, clocks, trusted, scene);
}

/// The same, to so many `times` what they state.
pub fn demand_agreement_within(
    times: f64,
    name: &str,
    clocks: &[&str],
    trusted: usize,
    scene: impl Fn(&str) -> String,
) {
    let ran =
        |clock: &str| (run(&scene(clock), 1).unwrap_or_else(|why| panic!("{name}{clock}: {why}")), clock.to_owned());
    let runs: Vec<_> = clocks.iter().map(|clock| ran(clock)).filter(|(ran, _)| ran.trusts_places()).collect();
    assert!(runs.len() >= trusted, "{name}: only {} runs are trusted", runs.len());
    for (index, (one, clock)) in runs.iter().enumerate() {
        for (other, beside) in &runs[..index] {
            let stated = [one, other].into_iter().filter_map(|ran| ran.stated()).map(|stated| stated.0).sum::<f64>();
            let (apart, most) = (one.apart(other), times * stated + ROUNDING);
            assert!(apart <= most, "{name}:{clock} and{beside} are {apart:e} m apart and state {stated:e}");
        }
    }
}
