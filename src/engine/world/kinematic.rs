//! Bodies with prescribed motion: uniform, or along a path. They push others, and no body pushes them.
//!
//! The state is a function of time. It is evaluated for each state and never summed up, so a million ticks are as exact
//! as one. A path is a cubic Hermite spline through its points, whose positions and velocities it has. The velocity is
//! the derivative of the position everywhere. A point without a velocity is a stop. After its last point a path
//! continues uniformly with its velocity there, or begins again from its position there.

use bevy_ecs::prelude::*;
use glam::DVec2;

use super::body::mark_changed;
use serde::{Deserialize, Serialize};

/// A point of a path, or the motion at any time, relative to the beginning of the path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PathPoint {
    /// Seconds since the path began.
    pub time: f64,
    /// Displacement in metres.
    pub by: DVec2,
    /// Turn in radians, counter-clockwise.
    pub turn: f64,
    /// Velocity in m/s.
    pub velocity: DVec2,
    /// Spin in rad/s.
    pub spin: f64,
}

/// A motion as a function of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Path {
    points: Vec<PathPoint>,
    repeat: bool,
}

impl Path {
    /// A motion that begins with `velocity` in m/s and `spin` in rad/s. It leads through `points`, at ascending times
    /// above zero. Without points it is uniform. With `repeat` it begins again at the last point, from its position
    /// there.
    pub fn new(velocity: DVec2, spin: f64, points: &[PathPoint], repeat: bool) -> Self {
        let start = PathPoint { velocity, spin, ..PathPoint::default() };
        Self { points: std::iter::once(start).chain(points.iter().copied()).collect(), repeat }
    }

    /// The motion `time` seconds after the beginning.
    pub fn at(&self, time: f64) -> PathPoint {
        let last = self.points[self.points.len() - 1];
        if time < last.time {
            return self.within(time);
        }
        if !self.repeat || last.time == 0.0 {
            return uniform(&last, time);
        }
        let rounds = (time / last.time).floor();
        let within = self.within((time - rounds * last.time).max(0.0));
        PathPoint { time, by: within.by + last.by * rounds, turn: within.turn + last.turn * rounds, ..within }
    }

    fn within(&self, time: f64) -> PathPoint {
        // A NaN time counts as before all points.
        let next = self.points.partition_point(|point| point.time <= time).max(1);
        match self.points.get(next) {
            Some(to) => between(&self.points[next - 1], to, time),
            None => uniform(&self.points[next - 1], time),
        }
    }
}

impl Path {
    /// Acceleration in m/s2 and rate of the spin in rad/s2, `time` seconds after the beginning. The piece is the one at
    /// `middle` seconds, because two pieces meet at a point of the path.
    pub fn acceleration(&self, time: f64, middle: f64) -> (DVec2, f64) {
        let last = self.points[self.points.len() - 1];
        if middle >= last.time && (!self.repeat || last.time == 0.0) {
            return (DVec2::ZERO, 0.0);
        }
        let began = if middle >= last.time { (middle / last.time).floor() * last.time } else { 0.0 };
        let next = self.points.partition_point(|point| point.time <= middle - began).max(1);
        match self.points.get(next) {
            Some(to) => bending(&self.points[next - 1], to, time - began),
            None => (DVec2::ZERO, 0.0),
        }
    }

    /// The time in seconds of the first point after `time`, at which acceleration may jump; infinity if there is none.
    pub fn next_point(&self, time: f64) -> f64 {
        let last = self.points[self.points.len() - 1].time;
        let rounds = if self.repeat && last > 0.0 && time > 0.0 { (time / last).floor() } else { 0.0 };
        // Rounding may put a point into the round before or behind.
        let times = (0..3).flat_map(|round| {
            let began = (rounds + f64::from(round) - 1.0) * last;
            self.points.iter().map(move |point| began + point.time)
        });
        let times = times.filter(|&point| point > time && (self.repeat || point <= last));
        times.fold(f64::INFINITY, f64::min)
    }
}

impl Path {
    /// The shortest time in seconds from a stop to the next one. A point where it turns back counts as a stop. Infinity: there is
    /// none. A round that never stops swings twice.
    pub fn shortest_swing(&self) -> f64 {
        let pieces = || self.points.windows(2).map(|ends| (ends[0], ends[1], way(&ends[0], &ends[1])));
        let (mut shortest, mut began, mut stops) = (f64::INFINITY, 0.0, false);
        let next = pieces().skip(1).map(|(.., way)| Some(way)).chain([None]);
        for ((from, to, moved), next) in pieces().zip(next) {
            let turns = next.is_some_and(|next| next.0.dot(moved.0) < 0.0 || next.1 * moved.1 < 0.0);
            let goes = moved != (DVec2::ZERO, 0.0) || from.goes() || to.goes();
            if goes && !to.goes() || turns {
                shortest = shortest.min(to.time - began);
            }
            if !to.goes() || turns {
                (began, stops) = (to.time, true);
            }
        }
        let [first, last] = [self.points[0], self.points[self.points.len() - 1]];
        let jumps = (first.velocity, first.spin) != (last.velocity, last.spin);
        match self.repeat && last.time > 0.0 {
            true if stops && jumps && last.time > began => shortest.min(last.time - began),
            true if !stops && (jumps || self.bends()) => last.time / 2.0,
            _ => shortest,
        }
    }

    /// Bounds of its greatest speed in m/s and spin in rad/s. Between points at rest, a cubic is half as fast again as its mean.
    pub fn fastest(&self) -> (f64, f64) {
        let ends = self.points.iter().map(|point| (point.velocity.length(), point.spin.abs()));
        let means = self.points.windows(2).map(|ends| {
            let ((by, turn), length) = (way(&ends[0], &ends[1]), ends[1].time - ends[0].time);
            let beside = ends.iter().fold((0.0, 0.0), |(v, w), end| (v + end.velocity.length(), w + end.spin.abs()));
            (1.5 * by.length() / length + 0.5 * beside.0, 1.5 * turn.abs() / length + 0.5 * beside.1)
        });
        ends.chain(means).fold((0.0, 0.0), |(v, w), (speed, spin)| (f64::max(v, speed), f64::max(w, spin)))
    }

    /// Whether its velocity changes.
    fn bends(&self) -> bool {
        let straight = |ends: &[PathPoint]| {
            let (by, turn) = way(&ends[0], &ends[1]);
            let length = ends[1].time - ends[0].time;
            ends.iter().all(|end| end.velocity * length == by && end.spin * length == turn)
        };
        !self.points.windows(2).all(straight)
    }
}

impl PathPoint {
    fn goes(&self) -> bool {
        self.velocity != DVec2::ZERO || self.spin != 0.0
    }
}

/// The way and the turn from one point to another.
fn way(from: &PathPoint, to: &PathPoint) -> (DVec2, f64) {
    (to.by - from.by, to.turn - from.turn)
}

/// Second derivatives of the cubic.
fn bending(from: &PathPoint, to: &PathPoint, time: f64) -> (DVec2, f64) {
    let length = to.time - from.time;
    let s = (time - from.time) / length;
    let (way, first, second) = (6.0 * (1.0 - 2.0 * s) / length, 6.0 * s - 4.0, 6.0 * s - 2.0);
    let (by, turn) = (to.by - from.by, to.turn - from.turn);
    (
        (by * way + from.velocity * first + to.velocity * second) / length,
        (turn * way + from.spin * first + to.spin * second) / length,
    )
}

fn uniform(from: &PathPoint, time: f64) -> PathPoint {
    let passed = time - from.time;
    PathPoint { time, by: from.by + from.velocity * passed, turn: from.turn + from.spin * passed, ..*from }
}

/// The cubic through two points with their velocities (Hermite).
fn between(from: &PathPoint, to: &PathPoint, time: f64) -> PathPoint {
    let length = to.time - from.time;
    let s = (time - from.time) / length;
    let rest = 1.0 - s;
    // Weights of the way, and of both velocities: for the place, and for the velocity.
    let (way, first, second) = (s * s * (3.0 - 2.0 * s), length * s * rest * rest, -length * s * s * rest);
    let (speed, at_first, at_second) = (6.0 * s * rest / length, rest * (1.0 - 3.0 * s), s * (3.0 * s - 2.0));
    let (by, turn) = (to.by - from.by, to.turn - from.turn);
    PathPoint {
        time,
        by: from.by + by * way + from.velocity * first + to.velocity * second,
        turn: from.turn + turn * way + from.spin * first + to.spin * second,
        velocity: by * speed + from.velocity * at_first + to.velocity * at_second,
        spin: turn * speed + from.spin * at_first + to.spin * at_second,
    }
}

/// Prescribes the motion of a body. Its position, angle, velocity and spin follow from time alone. To change the
/// motion, insert another `Kinematic`; changes of those components have no effect.
#[derive(Component, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[component(immutable, on_insert = mark_changed, on_remove = mark_changed)]
pub struct Kinematic {
    /// When the path begins, in seconds.
    pub since: f64,
    /// The beginning of the path, in metres: the initial position of the guided point.
    pub position: DVec2,
    /// The angle there in radians.
    pub angle: f64,
    /// The body's centre of mass from that point, in the body's frame, in metres.
    pub center: DVec2,
    /// The motion of that point, and the turn of the body about it.
    pub path: Path,
}

/// State of a body that moves as prescribed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrescribedState {
    /// Centre of mass in metres.
    pub position: DVec2,
    /// Angle in radians.
    pub angle: f64,
    /// Velocity of the centre of mass in m/s.
    pub velocity: DVec2,
    /// Spin in rad/s.
    pub spin: f64,
}

impl Kinematic {
    /// The state at `time` seconds.
    pub fn state(&self, time: f64) -> PrescribedState {
        let point = self.path.at(time - self.since);
        let angle = self.angle + point.turn;
        let led = self.position + point.by;
        if self.center == DVec2::ZERO {
            return PrescribedState { position: led, angle, velocity: point.velocity, spin: point.spin };
        }
        let (sin, cos) = libm::sincos(angle);
        let arm = DVec2::new(cos, sin).rotate(self.center);
        let velocity = point.velocity + arm.perp() * point.spin;
        PrescribedState { position: led + arm, angle, velocity, spin: point.spin }
    }
}

impl Kinematic {
    /// Acceleration of the centre of mass in m/s2 and rate of the spin in rad/s2 at `time` seconds. The piece of the
    /// path is that at `middle` seconds.
    pub fn acceleration(&self, time: f64, middle: f64) -> (DVec2, f64) {
        let (led, turning) = self.path.acceleration(time - self.since, middle - self.since);
        if self.center == DVec2::ZERO {
            return (led, turning);
        }
        let point = self.path.at(time - self.since);
        let (sin, cos) = libm::sincos(self.angle + point.turn);
        let arm = DVec2::new(cos, sin).rotate(self.center);
        (led + arm.perp() * turning - arm * (point.spin * point.spin), turning)
    }
}

/// The prescribed bodies of the packed state.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Prescribed {
    /// Places of the bodies, ascending, and their motions.
    pub motions: Vec<(usize, Kinematic)>,
    /// Time in seconds of the state they were last put in.
    pub time: f64,
    /// A time in seconds inside the step under way. Accelerations belong to the piece of a path that contains it.
    pub middle: f64,
}

impl Prescribed {
    /// Acceleration in m/s2 and rate of the spin in rad/s2 of body `body`. Zero if its motion is not prescribed.
    pub fn acceleration(&self, body: usize) -> (DVec2, f64) {
        match self.motions.binary_search_by_key(&body, |motion| motion.0) {
            Ok(index) => self.motions[index].1.acceleration(self.time, self.middle),
            Err(_) => (DVec2::ZERO, 0.0),
        }
    }

    /// The time in seconds of the first point of a path after `time`; infinity if there is none. Acceleration may jump
    /// there.
    pub fn next_point(&self, time: f64) -> f64 {
        let next = |(_, motion): &(usize, Kinematic)| motion.path.next_point(time - motion.since) + motion.since;
        self.motions.iter().map(next).filter(|&point| point > time).fold(f64::INFINITY, f64::min)
    }

    /// Whether the path of body `body` leads on: its motion is prescribed, and changes now or later.
    pub fn leads_on(&self, body: usize) -> bool {
        let index = self.motions.binary_search_by_key(&body, |motion| motion.0);
        index.is_ok_and(|index| {
            let motion = &self.motions[index].1;
            motion.path.next_point(self.time - motion.since).is_finite()
        })
    }

    /// The body with the shortest swing ([`Path::shortest_swing`]), by its index, and that time in seconds.
    pub fn fastest_swing(&self) -> Option<(usize, f64)> {
        let swings = self.motions.iter().map(|(body, motion)| (*body, motion.path.shortest_swing()));
        swings.filter(|(_, swing)| swing.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The state of body `body` in `ahead` seconds, if its motion is prescribed.
    pub fn ahead(&self, body: usize, ahead: f64) -> Option<PrescribedState> {
        let index = self.motions.binary_search_by_key(&body, |motion| motion.0).ok()?;
        Some(self.motions[index].1.state(self.time + ahead))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stop(time: f64, x: f64, turn: f64) -> PathPoint {
        PathPoint { time, by: DVec2::new(x, 0.0), turn, ..PathPoint::default() }
    }

    #[test]
    fn a_path_goes_through_its_points_and_stops_there() {
        let path = Path::new(DVec2::ZERO, 0.0, &[stop(1.0, 2.0, 0.5), stop(3.0, -1.0, 0.0)], false);
        for (time, x, turn) in [(0.0, 0.0, 0.0), (1.0, 2.0, 0.5), (3.0, -1.0, 0.0), (7.0, -1.0, 0.0)] {
            let point = path.at(time);
            assert_eq!((point.by.x, point.turn, point.velocity, point.spin), (x, turn, DVec2::ZERO, 0.0), "{time}");
        }
        assert_eq!(path.at(0.5).by.x, 1.0);
    }

    /// A cubic is met exactly, so motion under constant acceleration is.
    #[test]
    fn constant_acceleration_is_a_path_with_velocities() {
        let end =
            PathPoint { time: 2.0, by: DVec2::new(3.0, 4.0), velocity: DVec2::new(2.5, 4.0), ..stop(2.0, 0.0, 0.0) };
        let path = Path::new(DVec2::new(0.5, 0.0), 0.0, &[end], false);
        for step in 0..=20 {
            let t = f64::from(step) / 10.0;
            let (point, a) = (path.at(t), DVec2::new(1.0, 2.0));
            let exact = DVec2::new(0.5 * t, 0.0) + a * (t * t / 2.0);
            assert!((point.by - exact).length() < 1e-14, "{t}: {:?}", point.by);
            assert!((point.velocity - DVec2::new(0.5, 0.0) - a * t).length() < 1e-14, "{t}: {:?}", point.velocity);
        }
    }

    /// Central differences of the place, error h^2/6 of the third derivative (at most 12 x 3 here).
    #[test]
    fn the_velocity_is_the_derivative_of_the_place() {
        let path = Path::new(DVec2::X, -1.0, &[stop(1.0, 2.0, 0.5), stop(2.0, -1.0, 3.0)], true);
        let motion = Kinematic { since: 0.25, position: DVec2::ONE, angle: 0.3, center: DVec2::new(0.2, 0.1), path };
        let h = 1e-5;
        for step in 1..600 {
            let t = 0.2503 + f64::from(step) * 0.01;
            let (before, now, after) = (motion.state(t - h), motion.state(t), motion.state(t + h));
            let velocity = (after.position - before.position) / (2.0 * h);
            assert!((velocity - now.velocity).length() < 1e-7, "{t}: {velocity} {}", now.velocity);
            assert!(((after.angle - before.angle) / (2.0 * h) - now.spin).abs() < 1e-7, "{t}");
        }
    }

    /// Law: a path swings from stop to stop, or from one turn back to the next. A point that it passes ends no swing, nor does a
    /// rest.
    #[test]
    fn a_path_swings_from_stop_to_stop() {
        let still = DVec2::ZERO;
        let passed = |time, x, v| PathPoint { velocity: DVec2::new(v, 0.0), ..stop(time, x, 0.0) };
        let swing = |velocity, points: &[PathPoint], repeat| Path::new(velocity, 0.0, points, repeat).shortest_swing();
        for repeat in [false, true] {
            assert_eq!(swing(still, &[stop(0.5, 0.5, 0.0), stop(2.0, 0.0, 0.0)], repeat), 0.5);
            assert_eq!(swing(still, &[stop(3.0, 0.0, 0.0), stop(4.0, 1.0, 0.0), stop(6.0, 0.0, 0.0)], repeat), 1.0);
            assert_eq!(swing(still, &[passed(1.0, 1.0, 2.0), stop(3.0, 3.0, 0.0), stop(9.0, 0.0, 0.0)], repeat), 3.0);
            assert_eq!(swing(still, &[stop(1.5, 0.0, 0.4), stop(2.0, 0.0, 0.0)], repeat), 0.5);
            assert_eq!(swing(DVec2::X, &[], repeat), f64::INFINITY);
            assert_eq!(swing(DVec2::X, &[passed(2.0, 2.0, 1.0)], repeat), f64::INFINITY);
        }
        let there = [passed(1.0, 0.0, 1.0), passed(2.0, 2.0, -1.0)];
        assert_eq!(swing(-DVec2::X, &there, false), f64::INFINITY);
        assert_eq!(swing(-DVec2::X, &there, true), 1.0);
    }

    #[test]
    fn a_repeated_path_goes_on_from_where_it_stands() {
        let path = Path::new(DVec2::ZERO, 0.0, &[stop(0.5, 1.0, 2.0)], true);
        for rounds in 0..1000 {
            let point = path.at(0.5 * f64::from(rounds));
            assert_eq!((point.by.x, point.turn), (f64::from(rounds), 2.0 * f64::from(rounds)));
        }
        assert!((path.at(7.25).by.x - 14.5).abs() < 1e-14);
    }
}
