//! Problems with known answers: one law per file, with its scene, its exact answer and its error norm.
//!
//! Tests, the report of speed against error and the gallery draw from this one list. A new problem is one file plus its
//! line in [`ALL`]. It becomes at once a test at a stated tick and a line in the convergence test.
//!
//! ```
//! use jostle_report::problems::{ProblemSetting, linear_drag};
//!
//! let problem = linear_drag::PROBLEM;
//! let setting = ProblemSetting { method: "VelocityVerlet", tick: problem.tick, shift: 0.0, ..ProblemSetting::default() };
//! assert!(Some(problem.measure(&setting)?) <= problem.bound(2, problem.tick));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod catenary;
pub mod cluster_rotation;
pub mod compound_pendulum;
pub mod constant_acceleration;
pub mod corner_impact;
pub mod coulomb_oscillator;
pub mod cradle;
pub mod damped_oscillator;
pub mod dashpot_impact;
pub mod double_pendulum;
pub mod driven_oscillator;
pub mod elastic_bounce;
pub mod falling_chain;
pub mod falling_ladder;
pub mod falling_rod;
pub mod figure_eight;
pub mod firing;
pub mod four_bar;
pub mod free_flight;
pub mod frictional_collision;
pub mod hard;
pub mod incline;
pub mod inelastic_impact;
pub mod jamming_rod;
pub mod kepler;
pub mod leaving_cylinder;
pub mod linear_drag;
pub mod linkage;
pub mod loaded_rope;
pub mod oblique_collision;
pub mod overlap_release;
pub mod parallelogram;
pub mod pendulum;
pub mod plank;
pub mod quadratic_drag;
pub mod rigid_ring;
pub mod rocking_block;
pub mod rotating_ring;
pub mod servo_wheel;
pub mod settling_bounce;
pub mod slide_to_roll;
pub mod slider_crank;
pub mod sliding_stop;
pub mod spool;
pub mod spring_mass;
pub mod stick_slip;
pub mod tangential_impact;
pub mod tilted_box;
pub mod triple_pendulum;
pub mod truth;
pub mod two_link_arm;
pub mod wedge;

use std::error::Error;

use jostle_engine::Simulation;
use jostle_engine::integrate::ClockSection;
use jostle_engine::integrate::{Description, Methods};
use jostle_engine::scene::Source;
use jostle_engine::tick::Failure;

pub use jostle_engine::integrate::clock_section::EventTiming;
pub use truth::Truth;

/// All problems.
pub const ALL: &[Problem] = &[
    free_flight::PROBLEM,
    constant_acceleration::PROBLEM,
    linear_drag::PROBLEM,
    quadratic_drag::PROBLEM,
    cluster_rotation::PROBLEM,
    kepler::PROBLEM,
    figure_eight::PROBLEM,
    firing::PROBLEM,
    spring_mass::PROBLEM,
    damped_oscillator::PROBLEM,
    driven_oscillator::PROBLEM,
    rotating_ring::PROBLEM,
    elastic_bounce::PROBLEM,
    inelastic_impact::PROBLEM,
    oblique_collision::PROBLEM,
    settling_bounce::PROBLEM,
    coulomb_oscillator::PROBLEM,
    tangential_impact::PROBLEM,
    cradle::PROBLEM,
    overlap_release::PROBLEM,
    sliding_stop::PROBLEM,
    slide_to_roll::PROBLEM,
    dashpot_impact::PROBLEM,
    frictional_collision::PROBLEM,
    incline::PROBLEM,
    stick_slip::PROBLEM,
    pendulum::PROBLEM,
    compound_pendulum::PROBLEM,
    double_pendulum::PROBLEM,
    triple_pendulum::PROBLEM,
    two_link_arm::PROBLEM,
    servo_wheel::PROBLEM,
    four_bar::PROBLEM,
    slider_crank::PROBLEM,
    catenary::PROBLEM,
    falling_rod::PROBLEM,
    falling_chain::PROBLEM,
    parallelogram::PROBLEM,
    loaded_rope::PROBLEM,
    rigid_ring::PROBLEM,
    falling_ladder::PROBLEM,
    leaving_cylinder::PROBLEM,
    corner_impact::PROBLEM,
    rocking_block::PROBLEM,
    jamming_rod::PROBLEM,
    spool::PROBLEM,
    wedge::PROBLEM,
    tilted_box::PROBLEM,
    plank::PROBLEM,
];

/// How smooth the forces of a problem are: it decides which order a method of order p can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// No force, or forces in balance in the end: the error of every method is rounding.
    Free,
    /// Constant acceleration: methods of order 2 and more are exact up to rounding.
    ConstantAcceleration,
    /// Forces are smooth functions of positions: order p.
    Smooth,
    /// Forces are smooth functions of velocities too: order p.
    VelocityDependent,
    /// Forces are continuous with a kink: at most order 2 if the kink is not located inside the tick. Errors depend on
    /// the phase of the kink in the tick, so averages over many phases count.
    Kink,
    /// Forces jump: order 1 if the jump is not located inside the tick, averaged over phases.
    Jump,
}

/// The expected order of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// The error is rounding.
    Exact,
    /// The error falls with this power of the tick.
    Order(u32),
}

impl Class {
    /// The possible result of a method of order `order` that does not locate events.
    pub fn expected(self, order: u32) -> Expected {
        self.expected_located(order, false)
    }

    /// The possible result of a method of order `order`, for `located` events or not.
    pub fn expected_located(self, order: u32, located: bool) -> Expected {
        match self {
            Self::Free => Expected::Exact,
            Self::ConstantAcceleration if order >= 2 => Expected::Exact,
            Self::ConstantAcceleration | Self::Smooth | Self::VelocityDependent => Expected::Order(order),
            Self::Kink | Self::Jump if located => Expected::Order(order),
            Self::Kink => Expected::Order(order.min(2)),
            Self::Jump => Expected::Order(order.min(1)),
        }
    }

    /// Whether errors depend on where in a tick something happens.
    pub fn depends_on_phase(self) -> bool {
        matches!(self, Self::Kink | Self::Jump)
    }
}

/// How a problem is to be run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProblemSetting<'a> {
    /// Name of the method.
    pub method: &'a str,
    /// Length of a tick in seconds.
    pub tick: f64,
    /// Seconds by which events are moved against the ticks. Problems that do not depend on the phase ignore it.
    pub shift: f64,
    /// The moments at which forces jump.
    pub events: EventTiming,
}

impl Default for ProblemSetting<'_> {
    /// The engine chooses.
    fn default() -> Self {
        Self { method: ClockSection::AUTO, tick: 1e-3, shift: 0.0, events: EventTiming::Auto }
    }
}

impl ProblemSetting<'_> {
    /// The section `clock` of a scene that lasts `duration` seconds.
    pub fn clock(&self, duration: f64) -> String {
        let Self { method, tick, events, .. } = self;
        format!("format: 1, clock: (duration: {duration:?}, tick: {tick:?}, method: {method}, events: {events:?})")
    }
}

/// The error of a method on a problem: `constant dt^order` for small ticks `dt`. If the class depends on phases, it is
/// a root mean square over them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant {
    /// Name of the method.
    pub method: &'static str,
    /// The moments at which forces jump.
    pub events: EventTiming,
    /// The order that the method shows, which the class may limit.
    pub order: u32,
    /// In units of the error over seconds to the power of the order.
    pub constant: f64,
}

impl Constant {
    /// For events at the ends of ticks.
    pub const fn per_tick(method: &'static str, order: u32, constant: f64) -> Self {
        Self { method, events: EventTiming::PerTick, order, constant }
    }

    /// For located events.
    pub const fn located(method: &'static str, order: u32, constant: f64) -> Self {
        Self { method, events: EventTiming::Located, order, constant }
    }
}

/// A scene whose answer is known.
#[derive(Clone, Copy)]
pub struct Problem {
    /// Name, like that of the file.
    pub name: &'static str,
    /// The law in words.
    pub law: &'static str,
    /// The source of the law.
    pub source: &'static str,
    /// The smoothness of the forces.
    pub class: Class,
    /// A tick in seconds from which on the error falls as expected. Samples are whole multiples of it, unless the class
    /// depends on the phase. Then any tick will do, and the state nearest to the sample is compared.
    pub tick: f64,
    /// Times in seconds at which the state is compared. The last is the length of the run.
    pub samples: &'static [f64],
    /// Unit of the error: "1" or "m".
    pub unit: &'static str,
    /// Whether events are located under every method: the scene's friction sticks without any give.
    pub always_located: bool,
    /// The scene as RON text, of a given length in seconds.
    pub scene: fn(&ProblemSetting, f64) -> String,
    /// The error of a state, given time and shift in seconds.
    pub error: fn(&Simulation, f64, f64) -> f64,
    /// Bound of the leading error term at a tick, for a method by whole ticks that shows an order. `None` if no bound
    /// is derived.
    pub leading_error: Option<fn(u32, f64) -> f64>,
    /// Leading error constants of the methods.
    pub constants: &'static [Constant],
    /// Bound of what rounding does at a tick.
    pub rounding: fn(f64) -> f64,
}

impl Problem {
    /// Length of the run in seconds.
    pub fn duration(&self) -> f64 {
        self.samples.last().copied().unwrap_or_default()
    }

    /// The same with those samples only that lie within so many of its ticks, at least the first.
    pub fn within_ticks(&self, ticks: f64) -> Self {
        let within = self.samples.iter().take_while(|time| **time <= ticks * self.tick).count();
        Self { samples: &self.samples[..within.max(1)], ..*self }
    }

    /// The ways in which a method can go through the events of the problem.
    pub fn timings(&self, method: &Description) -> Vec<EventTiming> {
        let whole = method.whole_ticks.filter(|_| !self.always_located).map(|_| EventTiming::PerTick);
        let located = method.one_step.map(|_| EventTiming::Located);
        whole.into_iter().chain(located).collect()
    }

    /// The scene, ready to run.
    ///
    /// # Errors
    /// When the scene is refused: an unknown method, a tick that cannot be.
    pub fn load(&self, setting: &ProblemSetting) -> Result<Simulation, Box<dyn Error>> {
        let text = (self.scene)(setting, self.duration());
        Simulation::load(&Source::new(format!("{}.ron", self.name), text)).map_err(Into::into)
    }

    /// The greatest error at the samples.
    ///
    /// # Errors
    /// When the scene is refused or a number stops being finite.
    pub fn measure(&self, setting: &ProblemSetting) -> Result<f64, Box<dyn Error>> {
        self.run(&mut self.load(setting)?, setting).map_err(Into::into)
    }

    /// The same of a scene that is loaded already.
    ///
    /// # Errors
    /// When a number stops being finite.
    pub fn run(&self, simulation: &mut Simulation, setting: &ProblemSetting) -> Result<f64, Failure> {
        let mut greatest = 0.0_f64;
        for &time in self.samples {
            simulation.run_to_tick((time / setting.tick).round() as u64)?;
            // If a sample is not a whole number of ticks, the nearest tick counts.
            let reached = simulation.clock().time();
            let time = if (reached - time).abs() > 1e-9 * time { reached } else { time };
            let error = (self.error)(simulation, time, setting.shift);
            greatest = if error.is_nan() { f64::NAN } else { greatest.max(error) };
        }
        Ok(greatest)
    }

    /// The leading error constant of a method, if it is tabulated. Otherwise its errors are rounding.
    pub fn constant(&self, method: &str, events: EventTiming) -> Option<&Constant> {
        self.constants.iter().find(|constant| constant.method == method && constant.events == events)
    }

    /// The allowed error at a tick of a method of order `order` by whole ticks: leading error term and rounding.
    /// `None`: no bound is derived.
    pub fn bound(&self, order: u32, tick: f64) -> Option<f64> {
        let leading = match self.class.expected(order) {
            Expected::Exact => 0.0,
            Expected::Order(order) => self.leading_error?(order, tick),
        };
        Some(leading + (self.rounding)(tick))
    }
}

/// All methods that a scene may name.
///
/// # Panics
/// Never: the scene it reads is part of the engine.
pub fn methods() -> Vec<Description> {
    let setting = ProblemSetting { tick: 1.0, ..ProblemSetting::default() };
    let simulation = constant_acceleration::PROBLEM.load(&setting).expect("the scene is correct");
    simulation.resource::<Methods>().0.clone()
}

/// Worst case of rounding in `ticks` additions to a number of size `scale`. Each is off by half a unit in the last place.
pub fn rounding_of(ticks: f64, scale: f64) -> f64 {
    (ticks + 8.0) * f64::EPSILON * scale
}
