//! Error estimation by repeated runs: a scene is run in several ways, and the differences give the error.

mod fineness;
pub mod reference;
mod tolerance;
pub mod trajectory;

use crate::Simulation;
use crate::scene::SceneErrors;
use crate::simulation::error::COMPARE_TICKS;
use crate::simulation::{Goal, Plan};
use fineness::Trials;

/// A callback during trials, with the number of the current trial, counted from one, and its purpose.
pub type Tell = fn(u32, &str);

/// Runs located too few of their events to tell an error.
fn alike_by_events() -> String {
    format!(
        "some ticks had too many events to locate them all. The compared runs are alike there, so their error is not known. \
         {COMPARE_TICKS}"
    )
}

/// Finds the plan that reaches a goal. It begins with `first`: a plan, its method's order, and the steps of a tick that
/// suit the fastest response. `make` gives the scene at its beginning, ready to run by a plan.
///
/// # Errors
/// Those of `make`.
pub fn find(
    goal: Goal,
    first: (Plan, u32, u32),
    make: &mut dyn FnMut(&Plan) -> Result<Simulation, SceneErrors>,
    tell: Option<Tell>,
) -> Result<Plan, SceneErrors> {
    let mut trials = Trials::new(first, make, tell);
    match goal {
        Goal::Tolerance(tolerance) => tolerance::find(tolerance, &mut trials),
        Goal::Reference => reference::find(&mut trials),
    }
}
