//! A force or torque that follows a course in time: `F(t) = F0 s(t)`. The course `s` is a sine, or a table with linear
//! interpolation.
//!
//! It is sampled at the time of each evaluation. So an integrator with stages sees it at its stages, and keeps its
//! order. A table has kinks at its points. A method with steps inside ticks ends a step at each point. One that goes
//! from tick to tick ignores points between two ticks.

use std::f64::consts::TAU;

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use std::borrow::Cow;

use super::between_ticks::{REMEDY, clock_of_whole_ticks, is_between, paths, percent};
use super::thrust::ThrustFrame;
use super::{AppliedAt, Targets, check_targets};
use crate::scene::units::{self, Angle, ForcePair, LengthPair, Rate, Scalar, Spin, Time};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, Entry, Outline, SceneAppExt, WrittenEntry, exact};
use crate::tick::snapshot::Memory;
use crate::tick::{Clock, Departure, Energies, EvaluationMode, Model, Rhythm, State, SteadySpring, TickAppExt};

/// A force or torque that follows a course in time. The course is a factor on the values of this entry.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Drive {
    /// The bodies that the force moves. `*` stands for any letters.
    of: Names,
    /// Force in newtons if the course is 1. A drive has a force, a torque or both. Default: none.
    force: Option<ForcePair>,
    /// Torque in N m, counter-clockwise, if the course is 1. Default: none.
    torque: Option<units::Torque>,
    /// The point at which the force acts, in the body's frame, in metres. It counts from the centre of mass, or from the origin
    /// with `datum: Origin`. Default: the centre of mass.
    at: Option<LengthPair>,
    /// Whether the force turns with the body. Default: `World`.
    #[serde(default)]
    frame: ThrustFrame,
    /// The course in time.
    course: Course,
}

/// A number that depends on time.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Course {
    /// `amplitude sin(2 pi frequency t + phase)`.
    Sine {
        /// The largest value. Default: 1.
        #[serde(default = "one")]
        amplitude: Scalar,
        /// Periods per second, in Hz. Not negative. Write this or `angular_frequency`. Default: from `angular_frequency`.
        frequency: Option<Rate>,
        /// `2 pi` times that, in rad/s. Not negative. Default: from `frequency`.
        angular_frequency: Option<Spin>,
        /// The phase at the start of the run, in rad. A quarter of a turn makes a cosine. Default: 0.
        #[serde(default)]
        phase: Angle,
    },
    /// Times in seconds, ascending, and values: linear between them. Before the first and after the last point it keeps
    /// their values. Steps inside ticks end at the points. `VelocityVerlet` and `SemiImplicitEuler` without located
    /// events see the course at ticks only. The card warns if that changes the impulse.
    Piecewise(Vec<(Time, Scalar)>),
    /// The same from a file of two columns, time in seconds and value, with or without a line of names. The path begins in
    /// the folder of the file with this entry. `Csv(file: "arm.csv", time: "t", column: "angle")` reads two of its columns
    /// by name. Without `time` the first column holds it. The line of names may hold units, as in `angle [rad]`.
    Csv(#[schemars(with = "CsvFile")] String),
}

/// The content of `Csv(..)`, for the schema: scenes are read with the points of the file in its place.
struct CsvFile;

impl JsonSchema for CsvFile {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "csv".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let text = |about: &str| json_schema!({ "type": "string", "description": about });
        json_schema!({
            "anyOf": [text("The file of two columns."), {
                "type": "object",
                "properties": {
                    "file": text("The file."),
                    "column": text("The name of the column of values."),
                    "time": text("The name of the column of times. Default: the first column."),
                },
                "required": ["file", "column"],
                "additionalProperties": false,
            }],
            "x-value": "text, or `file: .., time: .., column: ..`",
        })
    }
}

fn one() -> Scalar {
    Scalar::new(1.0)
}

impl Entry for Drive {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Drive";
    const EXAMPLE: &'static str = "Drive(of: \"T\", force: (2, 0), course: Sine(frequency: \"1.5 Hz\"))";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        check_targets(Some(&self.of), outline, report);
        if self.force.is_none() && self.torque.is_none() {
            report.error("", "this drive pushes nothing").help("give `force: (2, 0)`, `torque: 0.05` or both");
        }
        if self.force.is_none() && self.at.is_some() {
            report
                .error("at", "`at` is the point of action of a force, and this drive has no force")
                .help("give `force`, or remove `at`");
        }
        report.within("course", |report| self.course.check(report));
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for (WrittenEntry { value, .. }, path) in entries.into_iter().zip(paths(Self::NAME, outline)) {
            app.add_model(DriveForce {
                path,
                of: Targets::named(Some(&value.of), outline),
                at: AppliedAt::new(value.at.map(LengthPair::si)),
                force: value.force.map_or(DVec2::ZERO, ForcePair::si),
                torque: value.torque.map_or(0.0, units::Torque::si),
                turns: value.frame == ThrustFrame::Body,
                course: value.course,
            });
        }
    }
}

impl Course {
    pub(crate) fn check(&self, report: &mut Diagnostics) {
        match self {
            Self::Sine { frequency, angular_frequency, .. } => {
                if let Some(frequency) = frequency {
                    report.not_negative("frequency", *frequency);
                }
                if let Some(angular_frequency) = angular_frequency {
                    report.not_negative("angular_frequency", *angular_frequency);
                }
                if frequency.is_some() == angular_frequency.is_some() {
                    let message = "a sine has either `frequency` or `angular_frequency`";
                    report.error("", message).help("for example `Sine(frequency: \"1.5 Hz\")`");
                }
            }
            Self::Piecewise(points) => {
                if points.is_empty() {
                    let help = "for example `Piecewise([(0, 0), (\"0.5 s\", 1)])`";
                    report.error("[0]", "must hold at least one point").help(help);
                }
                for (index, pair) in points.windows(2).enumerate() {
                    let (before, time) = (pair[0].0.si(), pair[1].0.si());
                    if time <= before {
                        let message =
                            format!("must be above the time before it, {} s, got {} s", exact(before), exact(time));
                        report
                            .error(&format!("[0][{}]", index + 1), message)
                            .help("the points stand in the order of their times; a jump takes a short time");
                    }
                }
            }
            Self::Csv(file) => {
                report
                    .error("", format!("`{file}` was not read"))
                    .help("`Csv` stands in `course`, `target` or `force` of a scene");
            }
        }
    }

    /// The value at `time` seconds.
    pub fn at(&self, time: f64) -> f64 {
        match self {
            Self::Sine { amplitude, phase, .. } => amplitude.si() * libm::sin(self.rhythm() * time + phase.si()),
            Self::Piecewise(points) => {
                let next = points.partition_point(|point| point.0.si() <= time);
                let point = |index: usize| (points[index].0.si(), points[index].1.si());
                match (next.checked_sub(1), next < points.len()) {
                    (Some(before), true) => {
                        let ((begin, from), (end, to)) = (point(before), point(next));
                        from + (to - from) * ((time - begin) / (end - begin))
                    }
                    (Some(before), false) => point(before).1,
                    (None, true) => point(next).1,
                    (None, false) => 0.0,
                }
            }
            // A check refuses it.
            Self::Csv(_) => 0.0,
        }
    }

    /// Its rate per second at `time` seconds. At a point of a table two pieces meet, and the one with `inside` counts.
    pub fn rate(&self, time: f64, inside: f64) -> f64 {
        match self {
            Self::Sine { amplitude, phase, .. } => {
                amplitude.si() * self.rhythm() * libm::cos(self.rhythm() * time + phase.si())
            }
            Self::Piecewise(points) => {
                let next = points.partition_point(|point| point.0.si() <= inside);
                let pair = next.checked_sub(1).and_then(|before| points.get(before..=next));
                pair.map_or(0.0, |pair| (pair[1].1.si() - pair[0].1.si()) / (pair[1].0.si() - pair[0].0.si()))
            }
            // A check refuses it.
            Self::Csv(_) => 0.0,
        }
    }

    /// Its second derivative at `time` seconds, per second squared. It is zero between the points of a table.
    pub fn acceleration(&self, time: f64) -> f64 {
        -self.rhythm() * self.rhythm() * self.at(time)
    }

    /// The angular frequency of a sine in rad/s; zero for other courses.
    pub fn rhythm(&self) -> f64 {
        let Self::Sine { frequency, angular_frequency, .. } = self else { return 0.0 };
        frequency.map_or(0.0, |rate| TAU * rate.si()) + angular_frequency.map_or(0.0, Spin::si)
    }

    /// The area that a table loses and gains if only its values at ticks count. The result is the difference between
    /// the area below the line from tick to tick and that below the table. Both are shares of its whole area so far.
    /// `None`: no point lies between ticks.
    fn lost_and_gained(&self, clock: &Clock) -> Option<(f64, f64)> {
        let Self::Piecewise(points) = self else { return None };
        let end = clock.time();
        let inside = points.iter().map(|point| point.0.si()).filter(|time| (0.0..end).contains(time));
        let times: Vec<f64> = inside.collect();
        let mut ticks: Vec<u64> =
            times.iter().filter(|time| is_between(clock, **time)).map(|t| (t / clock.dt) as u64).collect();
        ticks.dedup();
        let area = |from: f64, to: f64| {
            let mut bends = vec![from];
            bends.extend(times.iter().filter(|time| (from..to).contains(*time)));
            bends.push(to);
            let pieces =
                bends.windows(2).map(|piece| (piece[1] - piece[0]) * 0.5 * (self.at(piece[0]) + self.at(piece[1])));
            pieces.fold((0.0, 0.0), |(sum, size), piece| (sum + piece, size + piece.abs()))
        };
        let (_, whole) = area(0.0, end);
        let mut shares = (0.0, 0.0);
        for tick in &ticks {
            let (from, to) = (clock.time_of(*tick), clock.time_of(tick + 1));
            let seen = clock.dt * 0.5 * (self.at(from) + self.at(to)).abs();
            let missing = area(from, to).0.abs() - seen;
            if missing > 0.0 { shares.0 += missing / whole } else { shares.1 -= missing / whole }
        }
        (!ticks.is_empty() && whole > 0.0).then_some(shares)
    }

    /// The effect on an impulse of points between two ticks, for the entry at `path`.
    pub(crate) fn departure(&self, path: &str, state: &State, mode: EvaluationMode) -> Option<Departure> {
        self.departure_of(path, "impulse", state, mode)
    }

    /// The same for the sum of a target over time.
    pub(crate) fn departure_of_target(&self, path: &str, state: &State, mode: EvaluationMode) -> Option<Departure> {
        self.departure_of(path, "target", state, mode)
    }

    fn departure_of(&self, path: &str, effect: &str, state: &State, mode: EvaluationMode) -> Option<Departure> {
        let shares = self.lost_and_gained(&clock_of_whole_ticks(state, mode)?)?;
        departure(path, effect, shares)
    }

    /// The effect of points between two ticks on the way of a target, whose rate counts at ticks only.
    pub(crate) fn departure_of_rate(&self, path: &str, state: &State, mode: EvaluationMode) -> Option<Departure> {
        let clock = clock_of_whole_ticks(state, mode)?;
        let Self::Piecewise(points) = self else { return None };
        let (end, mut seen, mut whole, mut shares) = (clock.time(), 0.0, 0.0, (0.0_f64, 0.0_f64));
        for piece in points.windows(2) {
            let (from, to) = (piece[0].0.si().clamp(0.0, end), piece[1].0.si().clamp(0.0, end));
            if from < to {
                let ticks = first_tick(&clock, to) - first_tick(&clock, from);
                let (slope, change) = (self.rate(from, from), self.at(to) - self.at(from));
                seen += slope * ticks * clock.dt - change;
                whole += change.abs();
                let beyond = seen * change.signum();
                shares = (shares.0.max(-beyond), shares.1.max(beyond));
            }
        }
        let (lost, gained) = shares;
        (whole > 0.0).then(|| departure(path, "way", (lost / whole, gained / whole)))?
    }

    /// The first point of a table after `time` seconds, where the course has a kink; infinity if there is none.
    pub fn next_point(&self, time: f64) -> f64 {
        let Self::Piecewise(points) = self else { return f64::INFINITY };
        let next = points.partition_point(|point| point.0.si() <= time);
        points.get(next).map_or(f64::INFINITY, |point| point.0.si())
    }
}

/// The number of the first tick that does not begin before a time in seconds.
fn first_tick(clock: &Clock, time: f64) -> f64 {
    let ticks = time / clock.dt;
    if is_between(clock, time) { ticks.ceil() } else { ticks.round() }
}

/// A course of which the run lost and gained these shares. Effects below a thousandth are not reported, because the card claims no
/// better accuracy of energies.
fn departure(path: &str, effect: &str, (lost, gained): (f64, f64)) -> Option<Departure> {
    let shares = [(lost, "lost"), (gained, "gained")].into_iter().filter(|(share, _)| *share >= 1e-3);
    let shares: Vec<String> = shares.map(|(share, what)| format!("{what} {}", percent(share))).collect();
    let what = format!(
        "points of the course of `{path}` lie between ticks, which do not see them. Of its {effect}, the run {}",
        shares.join(" and ")
    );
    (!shares.is_empty()).then(|| Departure { what, remedy: REMEDY, share: lost.max(gained) })
}

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct DriveForce {
    /// Its path in the scene, such as `forces[0]`.
    pub path: String,
    /// The bodies it acts on.
    pub of: Targets,
    /// The point at which the force acts.
    pub at: AppliedAt,
    /// Force in newtons where the course is 1.
    pub force: DVec2,
    /// Torque in N m if the course is 1.
    pub torque: f64,
    /// Whether the force turns with the body.
    pub turns: bool,
    /// The course in time.
    pub course: Course,
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Drive>();
}

/// The force does not depend on velocities, its power does.
impl Model for DriveForce {
    fn start(&mut self, world: &mut World) {
        self.at.start(&mut self.of, &self.path, world);
    }

    fn save(&self) -> Memory {
        Memory::Nothing
    }

    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn has_edges(&self) -> bool {
        true
    }

    fn next_edge(&self, time: f64) -> f64 {
        self.course.next_point(time)
    }

    fn rhythm(&self) -> Option<Rhythm> {
        Some(Rhythm { path: self.path.clone(), angular_frequency: self.course.rhythm() })
    }

    fn departures(&self, state: &State, mode: EvaluationMode) -> Vec<Departure> {
        self.course.departure(&self.path, state, mode).into_iter().collect()
    }

    fn apply_forces(&mut self, state: &mut State) {
        let value = self.course.at(state.evaluation.time);
        let (bodies, rates) = state.bodies_and_rates();
        let (push, torque) = (self.force * value, self.torque * value);
        for body in self.of.indices(bodies) {
            let (mut force, mut arm) = (push, self.at.on(bodies.key.at(body)));
            if self.turns || arm != DVec2::ZERO {
                let (sin, cos) = libm::sincos(bodies.angle[body]);
                let rotation = DVec2::new(cos, sin);
                arm = rotation.rotate(arm);
                force = if self.turns { rotation.rotate(force) } else { force };
            }
            bodies.push(body, arm, force);
            bodies.torque[body] += torque;
            rates.outside(bodies.position[body], force, arm.perp_dot(force) + torque);
            rates.work += force.dot(bodies.velocity_at(body, arm)) + torque * bodies.spin[body];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_between_its_points_and_keeps_its_ends() {
        let points = [(1.0, 2.0), (3.0, -2.0), (3.5, 0.0)];
        let course = Course::Piecewise(points.map(|(time, value)| (Time::new(time), Scalar::new(value))).to_vec());
        for (time, value) in [(-5.0, 2.0), (1.0, 2.0), (1.5, 1.0), (2.0, 0.0), (3.0, -2.0), (3.25, -1.0), (9.0, 0.0)] {
            assert_eq!(course.at(time), value, "{time}");
        }
    }
}
