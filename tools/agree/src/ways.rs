//! The ways in which a scene runs.

use jostle::simulation::Overrides;

/// A way to run a scene.
#[derive(Clone, Debug)]
pub struct Way {
    /// Its flags on the command line.
    pub name: String,
    /// The same for the library.
    pub overrides: Overrides,
}

/// Tolerances, from coarse to fine.
const TOLERANCES: [f64; 3] = [1e-3, 1e-6, 1e-9];
/// Methods with located events, which run at two ticks each.
const METHODS: [&str; 2] = ["Dop853", "RungeKutta4"];

/// All ways of a scene, whose default tick is so long in s.
pub fn all(tick: f64) -> Vec<Way> {
    let plain = Way { name: "(default)".to_owned(), overrides: Overrides::default() };
    let tolerance = |tolerance: f64| Way {
        name: format!("--tolerance {tolerance:e}"),
        overrides: Overrides { tolerance: Some(tolerance), ..Overrides::default() },
    };
    let reference = Way {
        name: "--method Reference".to_owned(),
        overrides: Overrides { method: Some("Reference".to_owned()), ..Overrides::default() },
    };
    // Twice and half of a tick of 1, 2 or 5 units divide the time between two moments.
    let ticks = [2.0 * tick, 0.5 * tick];
    let located = METHODS.into_iter().flat_map(|method| {
        ticks.map(|tick| Way {
            name: format!("--method {method} --tick {tick:?}"),
            overrides: Overrides { method: Some(method.to_owned()), tick: Some(tick), ..Overrides::default() },
        })
    });
    [plain].into_iter().chain(TOLERANCES.map(tolerance)).chain([reference]).chain(located).collect()
}
