//! Whole ticks: a tick without watched events is one step.
//!
//! A tick is quiet if no pair of bodies is near, no thrust changes, and no other event is watched. In a quiet tick the
//! form that goes from tick to tick makes the same step, but saves the checks. If bodies come near in such a tick, the
//! renewal of the candidate lists shows it. Then the tick is undone, and made again as a step that may end at an event.

use crate::tick::Integrator;
use crate::tick::{Indicator, Tick, Undo};

/// The tick-to-tick form of a method, beside the form that locates events.
pub(super) struct EventFreeTicks {
    method: Box<dyn Integrator>,
    undo: Undo,
    /// The last tick was made as a whole.
    lasts: bool,
    /// When forces jump next, in s.
    edge: f64,
    /// The candidate lists in which no pair was near, if there are any.
    lists: Option<u64>,
    told: Vec<Indicator>,
}

impl EventFreeTicks {
    pub fn new(method: Box<dyn Integrator>) -> Self {
        Self { method, undo: Undo::default(), lasts: false, edge: 0.0, lists: None, told: Vec::new() }
    }

    /// Makes the tick, if no event in it is watched. Returns whether it did; if not, the state is that of its
    /// beginning.
    pub fn advance(&mut self, tick: &mut Tick) -> bool {
        if tick.is_fresh() {
            self.end(tick);
        }
        if !self.lasts || self.edge < tick.end {
            self.edge = tick.next_edge(tick.begin);
            if self.edge < tick.end || !self.begin(tick) {
                self.end(tick);
                return false;
            }
        }
        tick.choose_modes(tick.begin, tick.end);
        if self.lists.is_some() {
            tick.remember(&mut self.undo);
        }
        self.method.advance(tick);
        let lists = self.lists.and_then(|_| version_of_lists(tick));
        if lists != self.lists {
            if may_have_passed(tick) || self.sees_something(tick) {
                tick.take_back(&self.undo);
                self.end(tick);
                return false;
            }
            self.lists = lists;
        }
        true
    }

    /// The memory from tick to tick.
    pub fn memory(&self) -> (bool, f64, Option<u64>) {
        (self.lasts, self.edge, self.lists)
    }

    /// Goes on from what another one knew.
    pub fn recall(&mut self, (lasts, edge, lists): (bool, f64, Option<u64>)) {
        (self.lasts, self.edge, self.lists) = (lasts, edge, lists);
    }

    fn sees_something(&mut self, tick: &mut Tick) -> bool {
        self.told.clear();
        tick.tell(&mut self.told);
        !self.told.is_empty()
    }

    /// Begins a stretch of such ticks, if no event is watched.
    fn begin(&mut self, tick: &mut Tick) -> bool {
        // Steps that look for events find velocities that forces depend on to rounding; whole ones estimate them.
        let unlike = tick.has_velocity_forces() || !tick.state().bodies.prescribed.motions.is_empty();
        if unlike || self.sees_something(tick) {
            return false;
        }
        if !self.lasts {
            let bodies = tick.bodies();
            bodies.position_residual.fill(glam::DVec2::ZERO);
            bodies.angle_residual.fill(0.0);
            self.allow_renewal(tick, true);
            let (ticks, dt) = (tick.state().clock.ticks, tick.dt);
            let count = tick.steps();
            count.whole_from = Some(ticks);
            count.longest = count.longest.max(dt);
            self.lists = version_of_lists(tick);
        }
        true
    }

    fn end(&mut self, tick: &mut Tick) {
        if self.lasts {
            self.allow_renewal(tick, false);
            let ticks = tick.state().clock.ticks;
            let count = tick.steps();
            (count.accepted, count.whole_from) = (count.until(ticks), None);
            // Forces were those of estimated velocities.
            tick.evaluate_stage(tick.begin);
        }
    }

    fn allow_renewal(&mut self, tick: &mut Tick, allowed: bool) {
        self.lasts = allowed;
        if let Some(bounds) = tick.bounds_mut() {
            bounds.renewed_in_steps = allowed;
        }
    }
}

fn version_of_lists(tick: &Tick) -> Option<u64> {
    tick.bounds().map(|bounds| bounds.version)
}

/// Whether a body went so far in the tick that it may have passed another. The lists at the end of the tick do not show
/// that.
fn may_have_passed(tick: &Tick) -> bool {
    tick.bounds().is_some_and(|bounds| tick.farthest() > bounds.margin / 2.0)
}
