//! The recorded motion of a run, and the distance between two of them.

use bevy_ecs::prelude::*;
use glam::DVec2;

use crate::Simulation;
use crate::tick::{Clock, Failure, State, add_observer, look_at_ticks, look_inside, work_of_an_evaluation};
use crate::world::Bodies;

/// Moments at which runs are compared, at most.
pub(super) const MOST_MOMENTS: u64 = 20_000;
/// Parts of a run, after each of which the caller may stop it.
const PARTS: u64 = 100;
/// Numbers kept of one run, at most.
const MOST_NUMBERS: u64 = 4_000_000;

/// A body at a moment.
#[derive(Clone, Copy, Debug)]
struct Pose {
    position: DVec2,
    angle: f64,
    velocity: DVec2,
    spin: f64,
}

/// Bodies at moments of a run, behind each other.
#[derive(Clone, Debug, Default)]
struct Moments {
    /// Times in s, with the places behind their last poses.
    ends: Vec<(f64, usize)>,
    poses: Vec<Pose>,
}

impl Moments {
    fn add(&mut self, time: f64, poses: impl Iterator<Item = Pose>) {
        self.poses.extend(poses);
        self.ends.push((time, self.poses.len()));
    }

    fn len(&self) -> usize {
        self.ends.len()
    }

    fn iter(&self) -> impl Iterator<Item = (f64, &[Pose])> {
        let begins = std::iter::once(0).chain(self.ends.iter().map(|(_, end)| *end));
        self.ends.iter().zip(begins).map(|(&(time, end), begin)| (time, &self.poses[begin..end]))
    }

    fn first(&self) -> Option<&[Pose]> {
        self.iter().next().map(|(_, poses)| poses)
    }
}

/// The recorded motion of a run.
pub struct Trajectory {
    moments: Moments,
    /// Greatest distance of any point of each body from its centre of mass in m.
    extents: Vec<f64>,
    /// Its failure, if it failed before its end.
    pub failure: Option<Failure>,
    /// The number of times that forces were evaluated.
    pub evaluations: u64,
    /// The work of that, in the unit of [`work_of_an_evaluation`].
    pub work: f64,
    /// Whether more happened in a tick than is located.
    pub overloaded: bool,
    /// Whether rounding of places bounds its steps: two such runs are alike, whatever they are allowed.
    pub bounded: bool,
    /// Whether forces jumped at located events.
    pub jumped: bool,
}

/// The least distance for errors of a body, as a share of that of the farthest body.
const LEAST_SHARE: f64 = 1e-2;

/// Bodies stand that go no farther than this share of their distance from the origin. Rounding of places over many steps is as much.
const STANDS: f64 = 1e3 * f64::EPSILON;

/// How far two runs are apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrajectoryDistance {
    /// The greater of both as shares: of the distance of each body, and of its speed.
    pub share: f64,
    /// Greatest distance between the places of a point of a body, in m.
    pub distance: f64,
    /// Root of the mean square over time of the greatest difference of speed, in m/s.
    pub speed: f64,
}

impl TrajectoryDistance {
    /// The greater of both.
    pub fn max(self, other: Self) -> Self {
        Self {
            share: self.share.max(other.share),
            distance: self.distance.max(other.distance),
            speed: self.speed.max(other.speed),
        }
    }

    /// The same errors times a factor.
    pub fn times(self, factor: f64) -> Self {
        Self { share: self.share * factor, distance: self.distance * factor, speed: self.speed * factor }
    }
}

/// After this number of ticks, and after each doubling, the cost of the whole run is predicted.
const FORETOLD_FROM: u64 = 1 << 16;

/// Reads the bodies during a run and stores their states. It does not end a batch of ticks, after which forces would be
/// evaluated for other readers.
#[derive(Resource, Default)]
struct Lookout {
    /// The ticks at whose ends it looks, and how many of them are over.
    ticks: Vec<u64>,
    over: usize,
    moments: Moments,
}

fn look(state: Res<State>, mut lookout: ResMut<Lookout>) {
    lookout.look(&state.bodies, &state.clock);
}

impl Lookout {
    fn look(&mut self, bodies: &Bodies, clock: &Clock) {
        if self.ticks.get(self.over) == Some(&clock.ticks) {
            self.over += 1;
            self.moments.add(clock.time(), poses(bodies));
        }
    }
}

impl Trajectory {
    /// Runs a scene to its end. The run to be compared with has one tick for `per_moment` ticks of this one. If the
    /// prediction exceeds `budget` evaluations of all forces, it stops and returns that prediction.
    pub fn record(simulation: &mut Simulation, per_moment: u64, budget: f64) -> Result<Self, f64> {
        let ticks = simulation.ticks() / per_moment;
        let bodies = simulation.bodies().len() as u64;
        let most = MOST_MOMENTS.min(MOST_NUMBERS / (6 * bodies.max(1))).max(8);
        let stride = ticks.div_ceil(most).max(1) * per_moment;
        let (mut next, mut endless) = (FORETOLD_FROM, None);
        let trajectory = Self::seen(simulation, stride, |simulation| {
            while next < simulation.ticks() {
                if let Err(failure) = simulation.run_to_tick(next) {
                    return Some(failure);
                }
                let expected = simulation.state().evaluation.count as f64 * (simulation.ticks() as f64 / next as f64);
                if expected > budget {
                    endless = Some(expected);
                    return None;
                }
                next *= 2;
            }
            simulation.run_to_end().err()
        });
        endless.map_or(Ok(trajectory), Err)
    }

    /// Runs a scene to its end and reads it every `stride` ticks. `goes_on` is called a hundred times. If it is false,
    /// the result is the finished share of the run.
    pub fn while_it(simulation: &mut Simulation, stride: u64, goes_on: &dyn Fn() -> bool) -> Result<Self, f64> {
        let mut stopped = None;
        let part = (simulation.ticks() / PARTS).max(stride).max(1);
        let trajectory = Self::seen(simulation, stride, |simulation| {
            while simulation.clock().ticks < simulation.ticks() {
                if !goes_on() {
                    stopped = Some(simulation.clock().ticks as f64 / simulation.ticks() as f64);
                    return None;
                }
                let next = (simulation.clock().ticks + part).min(simulation.ticks());
                if let Err(failure) = simulation.run_to_tick(next) {
                    return Some(failure);
                }
            }
            None
        });
        stopped.map_or(Ok(trajectory), Err)
    }

    /// The states of a run by `run`, every `stride` ticks.
    fn seen(simulation: &mut Simulation, stride: u64, run: impl FnOnce(&mut Simulation) -> Option<Failure>) -> Self {
        let end = simulation.ticks();
        let last = (!end.is_multiple_of(stride)).then_some(end);
        // The run is made for its motion. Its sensors are not read.
        look_inside(simulation.world_mut(), false);
        Self::watch(simulation, (1..=end / stride).map(|index| index * stride).chain(last).collect());
        let failure = run(simulation);
        Self::watched(simulation, failure)
    }

    /// Looks at a run that begins, at the ends of these ticks, in ascending order. It may be run in any way.
    pub fn watch(simulation: &mut Simulation, ticks: Vec<u64>) {
        let mut moments = Moments::default();
        moments.add(simulation.clock().time(), poses(simulation.bodies()));
        let world = simulation.world_mut();
        look_at_ticks(world, &ticks);
        let lookout = Lookout { ticks, over: 0, moments };
        if let Some(mut there) = world.get_resource_mut::<Lookout>() {
            *there = lookout;
        } else {
            world.insert_resource(lookout);
            add_observer(world, look);
        }
    }

    /// The recorded motion of a watched run, and its failure if it failed. The watch ends.
    pub fn watched(simulation: &mut Simulation, failure: Option<Failure>) -> Self {
        let lookout = simulation.world_mut().get_resource_mut::<Lookout>();
        let moments = lookout.map_or_else(Moments::default, |mut lookout| {
            lookout.ticks.clear();
            std::mem::take(&mut lookout.moments)
        });
        let world = simulation.unpublished_world();
        let evaluations = world.resource::<State>().evaluation.count;
        Self {
            moments,
            extents: simulation.bodies().extents().to_vec(),
            failure,
            evaluations,
            work: evaluations as f64 * work_of_an_evaluation(world.resource()),
            overloaded: world.resource::<State>().located.given_up > 0,
            bounded: world.resource::<State>().steps.is_bounded(),
            jumped: world.resource::<State>().located.count > 0,
        }
    }

    /// The same without what comes after `time` seconds, and with each `every`th moment only.
    pub fn part(&self, time: f64, every: usize) -> Self {
        let seen = self.moments.iter().step_by(every);
        let mut moments = Moments::default();
        // A moment at the time itself may lie behind it by rounding.
        let seen = seen.take_while(|(at, _)| *at <= time * (1.0 + 1e-9));
        seen.for_each(|(at, poses)| moments.add(at, poses.iter().copied()));
        Self { moments, extents: self.extents.clone(), failure: self.failure.clone(), ..*self }
    }

    /// The same with those moments only whose times in s are wanted.
    pub fn at(&self, wanted: impl Fn(f64) -> bool) -> Self {
        let mut moments = Moments::default();
        let seen = self.moments.iter().filter(|(time, _)| wanted(*time));
        seen.for_each(|(time, poses)| moments.add(time, poses.iter().copied()));
        Self { moments, extents: self.extents.clone(), failure: self.failure.clone(), ..*self }
    }

    /// Places in m and velocities in m/s of all bodies at all moments after a time in s.
    pub fn states_after(&self, time: f64) -> impl Iterator<Item = (DVec2, DVec2)> {
        let after = self.moments.iter().filter(move |(at, _)| *at > time);
        after.flat_map(|(_, poses)| poses.iter().map(|pose| (pose.position, pose.velocity)))
    }

    /// The number of moments that were looked at after the beginning.
    pub fn moments(&self) -> usize {
        self.moments.len().saturating_sub(1)
    }

    /// The greatest distance of bodies from their beginning, in m, and their greatest speed, in m/s. A turn counts as
    /// at most one radian.
    pub fn sizes(&self) -> (f64, f64) {
        let Some(first) = self.moments.first() else { return (0.0, 0.0) };
        let (mut distance, mut speed) = (0.0_f64, 0.0_f64);
        for (_, poses) in self.moments.iter() {
            for ((pose, first), extent) in poses.iter().zip(first).zip(&self.extents) {
                let (far, fast) = size(pose, first, *extent);
                (distance, speed) = (distance.max(far), speed.max(fast));
            }
        }
        (distance, speed)
    }

    /// The greatest distance of any body from the origin, in m: rounding of places is a share of it.
    pub fn farthest(&self) -> f64 {
        let places = self.moments.iter().flat_map(|(_, poses)| poses).map(|pose| pose.position.length());
        places.fold(0.0, f64::max)
    }

    /// The greatest distance and speed of each body, as in [`Trajectory::sizes`]. If all bodies stand, they are 1 m and 1 m/s.
    pub fn measures(&self) -> Vec<(f64, f64)> {
        let (farthest, fastest) = self.sizes();
        let Some(first) = self.moments.first() else { return Vec::new() };
        let reach =
            first.iter().zip(&self.extents).map(|(pose, extent)| pose.position.length() + extent).fold(0.0, f64::max);
        if farthest <= STANDS * reach {
            return vec![(1.0, 1.0); first.len()];
        }
        let least = |size: f64, most: f64| if most > 0.0 { size.max(LEAST_SHARE * most) } else { 1.0 };
        let of = |(body, first): (usize, &Pose)| {
            let extent = self.extents[body];
            let sizes = self.moments.iter().map(|(_, poses)| size(&poses[body], first, extent));
            let (distance, speed) = sizes.fold((0.0, 0.0), |(a, b): (f64, f64), (c, d)| (a.max(c), b.max(d)));
            (least(distance, farthest), least(speed, fastest))
        };
        first.iter().enumerate().map(of).collect()
    }

    /// The distance of another run from this one. A failed run is infinitely far from any.
    pub fn apart(&self, other: &Self) -> TrajectoryDistance {
        self.apart_by(other, &other.measures())
    }

    /// The same, for known distances and speeds of each body.
    pub fn apart_by(&self, other: &Self, measures: &[(f64, f64)]) -> TrajectoryDistance {
        let infinite = TrajectoryDistance { share: f64::INFINITY, distance: f64::INFINITY, speed: f64::INFINITY };
        if self.failure.is_some() || other.failure.is_some() || self.moments.len() != other.moments.len() {
            return infinite;
        }
        let (mut distance, mut share, mut squares) = (0.0_f64, 0.0_f64, vec![0.0; measures.len()]);
        for ((_, own), (_, others)) in self.moments.iter().zip(other.moments.iter()) {
            for (body, (own, other)) in own.iter().zip(others).enumerate() {
                let (apart, faster) = difference(own, other, self.extents[body]);
                distance = greater(distance, apart);
                share = greater(share, apart / measures[body].0);
                squares[body] += faster * faster;
            }
        }
        let mean = |squares: f64| (squares / self.moments.len() as f64).sqrt();
        let speed = squares.iter().map(|&squares| mean(squares)).fold(0.0, greater);
        let shares = squares.iter().zip(measures).map(|(&squares, (_, speed))| mean(squares) / speed);
        let apart = TrajectoryDistance { share: shares.fold(share, greater), distance, speed };
        if apart.share.is_finite() && apart.distance.is_finite() && apart.speed.is_finite() { apart } else { infinite }
    }

    /// The distance of another run until both are more than `distance` metres apart. The time is the last moment in s
    /// before that; `None`: they stay nearer.
    pub fn apart_until(&self, other: &Self, distance: f64) -> (TrajectoryDistance, Option<f64>) {
        let Some(parting) = self.parts(other, distance) else { return (self.apart(other), None) };
        let before = self.differences(other).map(|(time, _)| time).take_while(|time| *time < parting);
        let last = before.last().unwrap_or_default();
        (self.part(last, 1).apart(&other.part(last, 1)), Some(last))
    }

    /// The first moment in s at which another run is farther away than `distance` metres.
    pub fn parts(&self, other: &Self, distance: f64) -> Option<f64> {
        self.differences(other).find(|(_, apart)| *apart > distance).map(|(time, _)| time)
    }

    /// Time, greatest difference of places in m and of velocities in m/s, at each moment that both have.
    pub fn errors<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = (f64, f64, f64)> + 'a {
        self.moments.iter().zip(other.moments.iter()).map(|((time, own), (_, others))| {
            let pairs = own.iter().zip(others).zip(&self.extents);
            let differences = pairs.map(|((own, other), extent)| difference(own, other, *extent));
            let (far, fast) = differences.fold((0.0, 0.0), |(a, b), (c, d)| (greater(a, c), greater(b, d)));
            (time, far, fast)
        })
    }

    /// The first body whose position differs by more than `distance` metres from that of another run. The moment is in
    /// s.
    pub fn first_apart(&self, other: &Self, distance: f64) -> Option<(usize, f64)> {
        self.moments.iter().zip(other.moments.iter()).find_map(|((time, own), (_, others))| {
            let apart = own.iter().zip(others).zip(&self.extents);
            let far = apart.map(|((own, other), extent)| difference(own, other, *extent).0);
            let farthest = far.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
            farthest.filter(|(_, far)| *far > distance).map(|(body, _)| (body, time))
        })
    }

    /// Time, and greatest difference of places in m, at each moment.
    pub fn differences<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = (f64, f64)> + 'a {
        self.errors(other).map(|(time, far, _)| (time, far))
    }
}

/// Greatest distance in m of any point of a body from its beginning, and its speed in m/s.
fn size(pose: &Pose, first: &Pose, extent: f64) -> (f64, f64) {
    let turn = (pose.angle - first.angle).abs().min(1.0);
    ((pose.position - first.position).length() + turn * extent, pose.velocity.length() + pose.spin.abs() * extent)
}

/// Distance in m and difference of velocities in m/s of any point of a body in two runs.
fn difference(a: &Pose, b: &Pose, extent: f64) -> (f64, f64) {
    let distance = (a.position - b.position).length() + (a.angle - b.angle).abs() * extent;
    (distance, (a.velocity - b.velocity).length() + (a.spin - b.spin).abs() * extent)
}

/// The greater of two numbers; NaN counts as the greatest.
fn greater(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b }
}

fn poses(bodies: &Bodies) -> impl Iterator<Item = Pose> {
    let pose = |body: usize| Pose {
        position: bodies.position[body],
        angle: bodies.angle[body],
        velocity: bodies.velocity[body],
        spin: bodies.spin[body],
    };
    (0..bodies.len()).map(pose)
}
