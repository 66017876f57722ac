//! The memory of a method with steps, and whether that of a file belongs together.

use serde::{Deserialize, Serialize};

use super::super::control::Control;
use super::super::event_overload::EventOverload;
use super::{EventStepper, Made, Work};
use crate::tick::State;
use crate::tick::snapshot::{UnfitSnapshot, demand};

/// The memory of a method with steps from tick to tick.
#[derive(Serialize, Deserialize)]
pub(super) struct Remembered {
    pub state: Vec<f64>,
    pub rest: Vec<f64>,
    pub under_way: Option<Made>,
    pub steps: u64,
    pub looked: f64,
    pub work: Work,
    pub overload: EventOverload,
    pub control: Option<Control>,
    pub whole: Option<(bool, f64, Option<u64>)>,
    pub method: Option<Vec<u8>>,
}

impl EventStepper {
    /// Demands that a step under way has all its numbers, and ends within the reach of the clock.
    pub(super) fn demand_fit(&self, state: &State) -> Result<(), UnfitSnapshot> {
        let bodies = state.bodies();
        let finite = |list: &[f64]| list.iter().all(|number| number.is_finite());
        let own = finite(&self.state) && finite(&self.rest) && self.looked.is_finite();
        demand(own && self.rest.len() == self.state.len(), "the numbers of the method")?;
        demand(self.control.as_ref().is_none_or(|control| control.fits(bodies.len())), "the lengths of steps")?;
        let Some(Made { from, until, length, shown, .. }) = &self.under_way else { return Ok(()) };
        let count = self.state.len();
        let time = state.clock().time();
        let times = *from <= time && time <= *until && until.is_finite() && length.is_finite();
        let shown = shown.as_ref().is_none_or(|shown| {
            let lengths = shown.state.len() == count && shown.change.len() == count;
            lengths && finite(&shown.state) && finite(&shown.change)
        });
        let work = self.work.change.len() == count && finite(&self.work.change);
        demand(times && shown && work, "the numbers of the step under way")
    }
}
