//! Runs that know their error: a scene is run in several ways, and what they differ by says how wrong they are.

mod fineness;
pub mod reference;
mod tolerance;
pub mod trajectory;

use crate::Simulation;
use crate::scene::SceneErrors;
use crate::simulation::{Goal, Plan};
use fineness::Trials;

/// What is told while trials are made: which one is under way, counted from one, and what it is for.
pub type Tell = fn(u32, &str);

/// Finds the plan that reaches a goal, beginning with `first`: a plan, the order of its method, and how many steps of a tick
/// suit the fastest contact or spring. `make` gives the scene at its beginning, ready to run by a plan.
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
