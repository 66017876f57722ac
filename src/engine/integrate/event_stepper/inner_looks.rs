//! States within a step for sensors that count from look to look.

use super::{EventStepper, Made, add};
use crate::integrate::steps::Start;
use crate::tick::{Flow, Tick, WorldFlow};

impl EventStepper {
    /// Prepares the evaluation of states inside the step.
    pub(super) fn make_dense(&mut self, flow: &mut WorldFlow, made: &mut Made) {
        if !std::mem::replace(&mut made.dense, true) {
            let start = Start { time: made.from, state: &self.state, rates: &self.work.rates };
            self.method.make_dense(flow, start, made.length);
        }
    }

    /// Shows states of the step from `now` seconds on, inside the tick. If the step ends in the tick, its end is the present state
    /// afterwards.
    pub(super) fn look_inside(&mut self, tick: &mut Tick, made: &mut Made, now: f64) {
        let (end, until) = (tick.end, made.until.min(tick.end));
        let mut flow = WorldFlow::new(tick);
        let noted = flow.tick.noted();
        // A step that was shown at the end of the last tick has left the present state there.
        let mut is_inside = made.shown.is_some();
        if self.control.is_some() {
            let looks = flow.tick.looks_in(made.until - made.from);
            let apart = (made.until - made.from) / looks;
            // The ends of ticks and steps are looked at too. Two looks at once would leave rounding of their difference.
            let moments = (1..looks as u64).map(|number| made.from + apart * number as f64);
            let moments = moments.filter(|at| at - now > 0.5 * apart && until - at > 0.5 * apart);
            for moment in moments.collect::<Vec<f64>>() {
                self.make_dense(&mut flow, made);
                self.show_inside(&mut flow, made, moment);
                is_inside = true;
            }
        }
        if is_inside {
            if made.until <= end {
                add(&self.state, &self.rest, &self.work.change, &mut self.work.trial);
                flow.write(&self.work.trial);
                flow.tick.evaluate_stage(made.until);
            }
            flow.tick.forget_trial(noted);
            flow.tick.recall_bounds();
        }
        if made.until < end {
            look(&mut flow, made, made.until, &self.work.change);
        }
    }

    fn show_inside(&self, flow: &mut WorldFlow, made: &Made, moment: f64) {
        let (mut change, mut state) = (vec![0.0; flow.dimension()], Vec::new());
        self.method.dense((moment - made.from) / made.length, &mut change);
        add(&self.state, &self.rest, &change, &mut state);
        flow.write(&state);
        flow.hold(moment, &mut change, &mut state);
        flow.tick.evaluate_stage(moment);
        look(flow, made, moment, &change);
    }
}

/// Lets sensors look at the present state. The step has made this change until then, of accounts too.
fn look(flow: &mut WorldFlow, made: &Made, moment: f64, change: &[f64]) {
    let mut booked = change.to_vec();
    if let Some(before) = &made.shown {
        booked.iter_mut().zip(&before.change).for_each(|(change, before)| *change -= before);
    }
    flow.count_unbooked(&mut booked);
    let ledger = flow.tick.state().ledger().clone();
    flow.book(&booked);
    flow.tick.look(moment);
    flow.tick.restore_ledger(ledger);
}
