//! Trusted runs with located events beside the limit of velocity Verlet with ever finer ticks. All located methods share their laws of
//! switching, so they agree about a fault in these. The laws from tick to tick are others. Right ones differ from each other by
//! depths of springs.

use jostle::report::estimate::Effort;
use jostle::simulation::Overrides;

use crate::judge::{Find, GRAVE, Kind, ROUNDING, USUAL};
use crate::run::{Outcome, Ran, run_with};
use crate::ways::Way;

/// Ticks in one of the default tick. An error of first order falls to a quarter from one to the next. The last confirm a find.
const FINER: [f64; 3] = [8.0, 32.0, 128.0];

/// Trusted runs that are farther from that limit than its own error and theirs explain.
pub fn apart(text: &str, tick: f64, most: u64, ran: &[(Way, Box<Ran>)]) -> Vec<Find> {
    let by_ticks = |finer: f64| {
        let overrides =
            Overrides { method: Some("VelocityVerlet".to_owned()), tick: Some(tick / finer), ..Overrides::default() };
        match run_with(text, &overrides, most, Effort::None) {
            Outcome::Ran(run) => Some(run),
            _ => None,
        }
    };
    let located = || ran.iter().filter(|(way, run)| way.name != "(default)" && run.is_trusted());
    let mut finds = Vec::new();
    let Some(mut coarse) = by_ticks(FINER[0]).filter(|_| located().next().is_some()) else { return finds };
    for finer in &FINER[1..] {
        let Some(fine) = by_ticks(*finer) else { break };
        let own = coarse.apart(&fine);
        let find = |(way, run): &(Way, Box<Ran>)| {
            let (apart, stated) = (run.apart(&fine), run.stated.unwrap_or_default());
            let how = format!(
                "{apart:.2e} m from the limit of velocity Verlet, which is known to {own:.1e}; {stated:.1e} stated"
            );
            let explained = GRAVE * own + USUAL * stated + ROUNDING;
            (apart > explained).then(|| Find { kind: Kind::Apart, way: way.name.clone(), how })
        };
        finds = located().filter_map(find).collect();
        if finds.is_empty() {
            break;
        }
        coarse = fine;
    }
    finds
}
