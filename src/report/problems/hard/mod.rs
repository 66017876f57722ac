//! Hard cases: scenes that break engines, each with its measured quantities and their thresholds. Physics or numerics
//! sets each threshold; it is derived and not tuned. Tests and `jostle report` run the same cases.
//!
//! A new case is one file plus its line in [`ALL`]. It becomes at once a test and a part of the report. No body is put
//! to sleep, clamped or damped for a case beyond the general rules of the engine. A failure is a failed reading.
//!
//! Hard cases of joints that are tests and not numbers. They are a motor against a limit and a break in the midst of a
//! step (`laws/joint_limits`). Others are a table on four jointed legs (`laws/joints_at_rest`) and a loop that cannot
//! close (`wrong_scenes/joints`).

pub mod column;
pub mod cut_chain;
pub mod dead_point;
pub mod deep_overlap;
pub mod far_away;
pub mod fast_limits;
pub mod gas;
pub mod heavy_load;
pub mod mass_ratio;
pub mod million_ticks;
pub mod pile;
pub mod pulled_apart;
pub mod sizes;
pub mod spin;
pub mod stiffness;
pub mod tick_limit;
pub mod tick_sweep;
pub mod upright_pendulum;

use crate::SimulationExt;
use std::error::Error;

use jostle_engine::Simulation;
use jostle_engine::scene::Source;
use jostle_engine::scene::number;
use jostle_engine::world::Bodies;

/// All cases.
pub const ALL: &[Case] = &[
    mass_ratio::CASE,
    stiffness::CASE,
    tick_limit::CASE,
    spin::CASE,
    far_away::CASE,
    sizes::CASE,
    deep_overlap::CASE,
    million_ticks::CASE,
    gas::CASE,
    column::CASE,
    pile::CASE,
    tick_sweep::CASE,
    heavy_load::CASE,
    upright_pendulum::CASE,
    cut_chain::CASE,
    dead_point::CASE,
    fast_limits::CASE,
    pulled_apart::CASE,
];

/// The two methods that go by whole ticks and follow contacts.
pub const METHODS: [&str; 2] = ["SemiImplicitEuler", "VelocityVerlet"];

/// How much of a case is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Runs of a few seconds at most.
    Short,
    /// All of it.
    Full,
}

impl Extent {
    /// One value or the other.
    pub fn pick<T>(self, short: T, full: T) -> T {
        match self {
            Self::Short => short,
            Self::Full => full,
        }
    }
}

/// The threshold of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Threshold {
    /// It is not larger.
    AtMost(f64),
    /// It is not smaller.
    AtLeast(f64),
}

impl std::fmt::Display for Threshold {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let (sign, bound) = match self {
            Self::AtMost(bound) => ("<=", bound),
            Self::AtLeast(bound) => (">=", bound),
        };
        write!(f, "{sign} {}", rounded(*bound))
    }
}

/// Three digits of a value.
pub fn rounded(value: f64) -> String {
    let three = format!("{value:.2e}").parse().unwrap_or(value);
    if three != 0.0 && !(1e-3..1e5).contains(&f64::abs(three)) { format!("{three:e}") } else { number(three) }
}

/// How a reading came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// The value keeps to the threshold.
    Passed,
    /// It does not, and the engine said so: it ended the run with a message, or warned.
    Told,
    /// It is not, and the engine did not report it; or the value is NaN.
    Failed,
}

/// One measured value.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The measured quantity, with its unit.
    pub what: String,
    /// The value.
    pub value: f64,
    /// Its threshold.
    pub threshold: Threshold,
    /// The origin of the threshold.
    pub why: &'static str,
    /// The message of the engine on the run, if it announces a value beyond the threshold.
    pub told: Option<String>,
}

impl Reading {
    /// Its outcome.
    pub fn verdict(&self) -> Judgement {
        let kept = match self.threshold {
            Threshold::AtMost(bound) => self.value <= bound,
            Threshold::AtLeast(bound) => self.value >= bound,
        };
        match (kept, &self.told) {
            (true, _) => Judgement::Passed,
            (false, Some(_)) => Judgement::Told,
            (false, None) => Judgement::Failed,
        }
    }
}

/// The readings of a case, as they come.
#[derive(Clone, Debug, Default)]
pub struct Readings(pub Vec<Reading>);

impl Readings {
    /// A value that may not be larger than a bound.
    pub fn at_most(&mut self, what: impl Into<String>, value: f64, bound: f64, why: &'static str) {
        self.0.push(Reading { what: what.into(), value, threshold: Threshold::AtMost(bound), why, told: None });
    }

    /// A value that may not be smaller than a bound.
    pub fn at_least(&mut self, what: impl Into<String>, value: f64, bound: f64, why: &'static str) {
        self.0.push(Reading { what: what.into(), value, threshold: Threshold::AtLeast(bound), why, told: None });
    }

    /// Runs to `time`, and then for `still` seconds. By then no body moves, and the state does not change by a bit.
    ///
    /// # Errors
    /// When the run fails.
    pub fn rests(
        &mut self,
        what: &str,
        simulation: &mut Simulation,
        time: f64,
        still: f64,
    ) -> Result<(), Box<dyn Error>> {
        run_to(simulation, time)?;
        let energy = kinetic(simulation.bodies());
        let seconds = number(time);
        self.at_most(
            format!("{what}: kinetic energy at {seconds} s, J"),
            energy,
            0.0,
            "contacts hold with any force that their law allows at rest, so what stands stands exactly",
        );
        let before = simulation.card().hash;
        run_to(simulation, time + still)?;
        let changed = f64::from(simulation.card().hash != before);
        self.at_most(
            format!("{what}: state hashes that differ after {} s more", number(still)),
            changed,
            0.0,
            "what is in balance stays to the last bit",
        );
        Ok(())
    }
}

/// How a case is run and measured.
pub type RunCase = fn(Extent, &mut Readings) -> Result<(), Box<dyn Error>>;

/// A case.
#[derive(Clone, Copy)]
pub struct Case {
    /// Name, like that of the file.
    pub name: &'static str,
    /// Its difficulty.
    pub what: &'static str,
    /// The source of its law.
    pub source: &'static str,
    /// Whether it takes less than a second in its short form.
    pub cheap: bool,
    /// The omissions of its short form; empty if there are none.
    pub short: &'static str,
    /// Runs and measures it.
    pub run: RunCase,
}

impl Case {
    /// All readings; an unexpected failure of a run is a failed reading.
    pub fn measure(&self, extent: Extent) -> Vec<Reading> {
        let mut readings = Readings::default();
        if let Err(error) = (self.run)(extent, &mut readings) {
            let first = error.to_string().lines().next().unwrap_or_default().to_owned();
            readings.at_most(format!("the run ends: {first}"), f64::NAN, 0.0, "it has to come to its end");
        }
        readings.0
    }
}

/// A scene, ready to run.
///
/// # Errors
/// When the scene is refused.
pub fn load(text: &str) -> Result<Simulation, Box<dyn Error>> {
    Simulation::load(&Source::new("hard.ron", text)).map_err(Into::into)
}

/// Runs on to `time` seconds.
///
/// # Errors
/// When the run fails.
pub fn run_to(simulation: &mut Simulation, time: f64) -> Result<(), Box<dyn Error>> {
    let tick = (time / simulation.clock().dt).round() as u64;
    simulation.run_to_tick(tick).map_err(Into::into)
}

/// Kinetic energy in J of all bodies that forces move, summed here and not by the engine.
pub fn kinetic(bodies: &Bodies) -> f64 {
    let of = |body: usize| {
        0.5 * bodies.mass[body] * bodies.velocity[body].length_squared()
            + 0.5 * bodies.inertia[body] * bodies.spin[body] * bodies.spin[body]
    };
    (0..bodies.len()).filter(|&body| bodies.dynamic[body]).map(of).sum()
}

/// Numbers between 0 and 1, the same each time: multiples of the golden section.
pub fn golden() -> impl Iterator<Item = f64> {
    (1..).map(|number: u32| (f64::from(number) * 0.618_033_988_749_894_9).fract())
}
