//! The world as a system of ordinary differential equations. `q` are positions and angles of the dynamic bodies, and
//! `v` their velocities. `z` are the states of models, and the accounts of energy and momentum.

use glam::DVec2;

use super::model::Events;
use super::{FromOutside, Indicator, Rates, State, Tick};
use crate::tick::Flow;

/// Accounts at the end of a state, behind those of models: drag, work, friction, inelasticity, impulse (2), angular impulse.
const ACCOUNTS: usize = 7;
/// Those that depend on no velocity if forces do not.
const IMPULSES: usize = 3;
/// The place of friction among accounts, counted from the end.
const FRICTION: usize = IMPULSES + 2;

/// How far bodies can get within a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Greatest speed of any point of a dynamic body, in m/s.
    pub speed: f64,
    /// Greatest acceleration of any such point by what acts on its body, in m/s2.
    pub acceleration: f64,
}

/// The world as seen by a method that takes several stages per step.
pub struct WorldFlow<'t, 'w> {
    /// The tick under way.
    pub tick: &'t mut Tick<'w>,
    dynamic: Vec<usize>,
    /// Lengths of what models keep of their own, and all together.
    blocks: Vec<usize>,
    own: usize,
    /// Accounts of models.
    others: usize,
    dimension: usize,
    velocity_dependent: bool,
    watched: bool,
    held: bool,
    /// The values of all indicators at each evaluation, if they are recorded: times in s.
    stages: Option<Vec<(f64, Vec<f64>)>>,
    /// The end of the present step in s.
    end: f64,
}

/// The greatest distance between a time and the sum that stands for it, in units of its rounding. A method adds the lengths of its
/// parts to the beginning, at most seven. The length of the step is a rounded difference.
const ROUNDINGS_OF_A_SUM: f64 = 8.0;

impl<'t, 'w> WorldFlow<'t, 'w> {
    /// The world in this tick. It is made again after modes have changed.
    pub fn new(tick: &'t mut Tick<'w>) -> Self {
        let bodies = &tick.state.bodies;
        let dynamic: Vec<usize> = (0..bodies.len()).filter(|&body| bodies.dynamic[body]).collect();
        let mut blocks = Vec::new();
        tick.state.each_with_events(|model, _| blocks.push(model.length()));
        let own = blocks.iter().sum();
        let others = tick.state.ledger.accounts.len();
        let dimension = 6 * dynamic.len() + own + others + ACCOUNTS;
        let watched = tick.state.has_events();
        let held = tick.state.is_only_held();
        let velocity_dependent =
            if held { tick.state.depends_on_velocity_beside_joints() } else { tick.velocity_dependent };
        Self {
            tick,
            dynamic,
            blocks,
            own,
            others,
            dimension,
            velocity_dependent,
            watched,
            held,
            stages: None,
            end: f64::NAN,
        }
    }

    /// The present step ends at this time in s, and none does at NaN. A stage at its end sees forces of that time exactly. Within the
    /// rounding of a time a steep course may change by much. Returns the end before.
    pub fn ends_at(&mut self, time: f64) -> f64 {
        std::mem::replace(&mut self.end, time)
    }

    /// The time that the sum of a beginning and a length stands for.
    fn exact(&self, time: f64) -> f64 {
        let rounding = ROUNDINGS_OF_A_SUM * f64::EPSILON * self.end.abs();
        if (time - self.end).abs() <= rounding { self.end } else { time }
    }

    /// From here on the values of all indicators at each evaluation are recorded, or not.
    pub fn record_stages(&mut self, records: bool) {
        self.stages = records.then(Vec::new);
    }

    /// Ends the record. Returns the time in s of each evaluation, and the values of all indicators there. Those of a known rate
    /// are NaN.
    pub fn recorded_stages(&mut self) -> Vec<(f64, Vec<f64>)> {
        self.stages.take().unwrap_or_default()
    }

    fn record(&mut self, time: f64) {
        let Some(stages) = &mut self.stages else { return };
        let mut told = Vec::new();
        self.tick.tell(&mut told);
        // Others last at this stage.
        let value = |told: &Indicator| if told.is_sampled() { told.value } else { f64::NAN };
        stages.push((time, told.iter().map(value).collect()));
    }

    /// Places of the accounts in a state.
    pub fn indices_of_accounts(&self) -> std::ops::Range<usize> {
        self.dimension - ACCOUNTS - self.others..self.dimension
    }

    /// Places of what models keep of their own.
    fn indices_of_own(&self) -> std::ops::Range<usize> {
        let begin = 6 * self.dynamic.len();
        begin..begin + self.own
    }

    /// Shows each model's own state with its numbers, all of which are given.
    fn each_own(&mut self, mut own: &mut [f64], mut see: impl FnMut(&mut dyn Events, &State, &mut [f64])) {
        let mut lengths = self.blocks.iter();
        self.tick.state.each_with_events(|model, state| {
            let (numbers, others) = std::mem::take(&mut own).split_at_mut(next_length(&mut lengths));
            see(model, state, numbers);
            own = others;
        });
    }

    /// The present state. Accounts begin at zero.
    pub fn read(&mut self, state: &mut Vec<f64>) {
        state.clear();
        let bodies = &self.tick.state.bodies;
        for &body in &self.dynamic {
            state.extend([bodies.position[body].x, bodies.position[body].y, bodies.angle[body]]);
        }
        for &body in &self.dynamic {
            state.extend([bodies.velocity[body].x, bodies.velocity[body].y, bodies.spin[body]]);
        }
        state.resize(self.dimension, 0.0);
        let own = self.indices_of_own();
        self.each_own(&mut state[own], |model, _, numbers| model.read(numbers));
    }

    /// Makes `state` the present one.
    pub fn write(&mut self, state: &[f64]) {
        let bodies = self.tick.bodies();
        let velocities = 3 * self.dynamic.len();
        for (index, &body) in self.dynamic.iter().enumerate() {
            let (q, v) = (&state[3 * index..], &state[velocities + 3 * index..]);
            bodies.position[body] = DVec2::new(q[0], q[1]);
            bodies.angle[body] = q[2];
            bodies.velocity[body] = DVec2::new(v[0], v[1]);
            bodies.spin[body] = v[2];
        }
        let (mut lengths, mut own) = (self.blocks.iter(), &state[self.indices_of_own()]);
        self.tick.state.each_with_events(|model, _| {
            let (numbers, others) = own.split_at(next_length(&mut lengths));
            model.write(numbers);
            own = others;
        });
    }

    /// The rates of the state that was evaluated last.
    pub fn read_rates(&mut self, rates: &mut [f64]) {
        let bodies = &self.tick.state.bodies;
        let velocities = 3 * self.dynamic.len();
        for (index, &body) in self.dynamic.iter().enumerate() {
            let (velocity, force) = (bodies.velocity[body], bodies.force[body] * bodies.inverse_mass(body));
            let turning = bodies.torque[body] * bodies.inverse_inertia(body);
            rates[3 * index..3 * index + 3].copy_from_slice(&[velocity.x, velocity.y, bodies.spin[body]]);
            rates[velocities + 3 * index..velocities + 3 * index + 3].copy_from_slice(&[force.x, force.y, turning]);
        }
        let own = self.indices_of_own();
        self.each_own(&mut rates[own], |model, state, rates| model.rates(state, rates));
        let Rates { force, torque, drag, work, friction, inelasticity, .. } = self.tick.state.rates;
        let (others, accounts) = rates[self.indices_of_accounts()].split_at_mut(self.others);
        others.fill(0.0);
        self.tick.state.add_losses(others);
        accounts.copy_from_slice(&[drag, work, friction, inelasticity, force.x, force.y, torque]);
    }

    /// Positions and angles of the dynamic bodies.
    pub fn places(&self) -> Vec<(DVec2, f64)> {
        let bodies = &self.tick.state.bodies;
        self.dynamic.iter().map(|&body| (bodies.position[body], bodies.angle[body])).collect()
    }

    /// The greatest distance of any point of a dynamic body from its position in `places` (m), and its speed (m/s). A
    /// turn counts as at most one radian.
    pub fn sizes_since(&self, places: &[(DVec2, f64)]) -> (f64, f64) {
        let bodies = &self.tick.state.bodies;
        let far = |(&body, &(position, angle)): (&usize, &(DVec2, f64))| {
            let turn = (bodies.angle[body] - angle).abs().min(1.0);
            (bodies.position[body] - position).length() + turn * bodies.extent(body)
        };
        (self.dynamic.iter().zip(places).map(far).fold(0.0, f64::max), self.reach().speed)
    }

    /// The greatest displacement in m and gain of speed in m/s that a change of the state makes. Any point of a dynamic body
    /// counts.
    pub fn sizes_of(&self, change: &[f64]) -> (f64, f64) {
        let bodies = &self.tick.state.bodies;
        let size = |changes: &[f64]| {
            let each = self.dynamic.iter().zip(changes.chunks_exact(3));
            let size = each.map(|(&body, by)| DVec2::new(by[0], by[1]).length() + by[2].abs() * bodies.extent(body));
            size.fold(0.0, f64::max)
        };
        let coordinates = 3 * self.dynamic.len();
        (size(&change[..coordinates]), size(&change[coordinates..2 * coordinates]))
    }

    /// The greatest distance of a dynamic body from the origin along an axis, in m.
    pub fn farthest(&self) -> f64 {
        let bodies = &self.tick.state.bodies;
        self.dynamic.iter().map(|&body| bodies.position[body].abs().max_element()).fold(0.0, f64::max)
    }

    /// The greatest distance of bodies from the state of the last evaluation.
    pub fn reach(&self) -> Reach {
        let bodies = &self.tick.state.bodies;
        self.dynamic.iter().fold(Reach::default(), |reach, &body| {
            let speed = bodies.velocity[body].length() + bodies.spin[body].abs() * bodies.extent(body);
            let turning = bodies.torque[body].abs() * bodies.inverse_inertia(body) * bodies.extent(body);
            let acceleration = bodies.force[body].length() * bodies.inverse_mass(body) + turning;
            Reach { speed: reach.speed.max(speed), acceleration: reach.acceleration.max(acceleration) }
        })
    }

    /// The unit of errors for each number of a state, from a distance (m) and a speed (m/s). Angles are measured at the
    /// farthest point of their body, and states of models as positions. Accounts have no unit.
    pub fn measures(&self, distance: f64, speed: f64, sizes: &mut Vec<f64>) {
        let bodies = &self.tick.state.bodies;
        let turns = |size: f64, body: usize| size / bodies.extent(body).max(f64::MIN_POSITIVE);
        sizes.clear();
        sizes.extend(self.dynamic.iter().flat_map(|&body| [distance, distance, turns(distance, body)]));
        sizes.extend(self.dynamic.iter().flat_map(|&body| [speed, speed, turns(speed, body)]));
        sizes.resize(self.indices_of_accounts().start, distance);
        sizes.resize(self.dimension, f64::INFINITY);
    }

    /// The same for states of models that have their own units of errors. At least this share of them is allowed.
    pub fn measure_own(&mut self, share: f64, sizes: &mut [f64]) {
        let indices = self.indices_of_own();
        if indices.is_empty() {
            return;
        }
        let mut own = vec![0.0; indices.len()];
        self.each_own(&mut own, |model, _, numbers| model.measures(numbers));
        sizes[indices].iter_mut().zip(own).for_each(|(size, own)| *size = size.max(share * own));
    }

    /// Brings the state just written back onto the joints; `change` and `state` follow, with the impulse from outside.
    pub fn hold(&mut self, time: f64, change: &mut [f64], state: &mut [f64]) -> bool {
        if !self.tick.has_joints() {
            return false;
        }
        let outside = self.tick.project(time);
        self.follow(outside, change, state);
        true
    }

    /// `change` and `state` follow the bodies, which have been brought back onto joints with an impulse from outside.
    fn follow(&self, FromOutside { impulse, angular, .. }: FromOutside, change: &mut [f64], state: &mut [f64]) {
        let bodies = &self.tick.state.bodies;
        let coordinates = 3 * self.dynamic.len();
        let mut set = |index: usize, held: f64| {
            change[index] += held - state[index];
            state[index] = held;
        };
        for (index, &body) in self.dynamic.iter().enumerate() {
            let (position, velocity) = (bodies.position[body], bodies.velocity[body]);
            let numbers = [position.x, position.y, bodies.angle[body], velocity.x, velocity.y, bodies.spin[body]];
            for (number, held) in numbers.into_iter().enumerate() {
                set(3 * index + number % 3 + if number < 3 { 0 } else { coordinates }, held);
            }
        }
        let impulses = self.dimension - IMPULSES;
        change[impulses..].iter_mut().zip([impulse.x, impulse.y, angular]).for_each(|(sum, more)| *sum += more);
    }

    /// Adds to the change of the accounts the friction that models book at the end of a step alone.
    pub fn count_unbooked(&mut self, change: &mut [f64]) {
        let friction = self.dimension - FRICTION;
        self.tick.state.each_with_events(|model, state| change[friction] += model.unbooked(state));
    }

    /// Books the change of the accounts by a step.
    pub fn book(&mut self, change: &[f64]) {
        let (others, accounts) = change[self.indices_of_accounts()].split_at(self.others);
        let &[drag, work, friction, inelasticity, x, y, angular] = accounts else { return };
        let ledger = &mut self.tick.state.ledger;
        ledger.accounts.iter_mut().zip(others).for_each(|((_, sum), lost)| sum.add(*lost));
        ledger.impulse[0].add(x);
        ledger.impulse[1].add(y);
        ledger.angular_impulse.add(angular);
        ledger.drag.add(drag);
        ledger.book_work(work);
        ledger.friction.add(friction);
        ledger.inelasticity.add(inelasticity);
    }
}

/// The number of blocks is that at the creation of the flow.
fn next_length(lengths: &mut std::slice::Iter<usize>) -> usize {
    lengths.next().copied().unwrap_or_default()
}

impl Flow for WorldFlow<'_, '_> {
    fn coordinates(&self) -> usize {
        3 * self.dynamic.len()
    }

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn accounts(&self) -> usize {
        // Powers of contacts depend on velocities where their forces do not.
        if self.velocity_dependent || self.watched { IMPULSES } else { ACCOUNTS + self.others }
    }

    fn velocity_dependent(&self) -> bool {
        self.velocity_dependent
    }

    fn rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]) {
        let time = self.exact(time);
        self.write(state);
        self.tick.evaluate_stage(time);
        self.read_rates(rates);
        self.record(time);
    }

    fn is_held(&self) -> bool {
        self.held
    }

    fn kick_rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]) {
        let time = self.exact(time);
        self.write(state);
        self.tick.evaluate_kick(time);
        self.read_rates(rates);
        self.record(time);
    }

    fn drift(&mut self, time: f64, length: f64, state: &mut [f64], change: &mut [f64]) {
        if length == 0.0 {
            return;
        }
        self.write(state);
        self.tick.bodies();
        let outside = self.tick.state.slide(time, length, self.velocity_dependent || self.watched);
        self.follow(outside, change, state);
    }
}
