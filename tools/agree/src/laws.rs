//! Trusted runs with located events beside the limit of velocity Verlet with ever finer ticks. All located methods share their laws of
//! switching, so they agree about a fault in these. The laws from tick to tick are others. Right ones differ from each other by
//! depths of springs.

use jostle::report::estimate::Effort;
use jostle::simulation::Overrides;

use crate::judge::{Find, GRAVE, Kind, ROUNDING, USUAL};
use crate::run::{Outcome, Ran, run_with};
use crate::ways::Way;

/// Ticks in one of the default tick. An error of first order falls to a quarter from one to the other.
const FINER: [f64; 2] = [8.0, 32.0];

/// Trusted runs that are farther from that limit than its own error and theirs explain.
pub fn apart(text: &str, tick: f64, most: u64, ran: &[(Way, Box<Ran>)]) -> Vec<Find> {
    let by_ticks = FINER.map(|finer| {
        let overrides =
            Overrides { method: Some("VelocityVerlet".to_owned()), tick: Some(tick / finer), ..Overrides::default() };
        match run_with(text, &overrides, most, Effort::None) {
            Outcome::Ran(run) => Some(run),
            _ => None,
        }
    });
    let [Some(coarse), Some(fine)] = by_ticks else { return Vec::new() };
    let own = coarse.apart(&fine);
    let located = ran.iter().filter(|(way, run)| way.name != "(default)" && run.is_trusted());
    let find = |(way, run): &(Way, Box<Ran>)| {
        let (apart, stated) = (run.apart(&fine), run.stated.unwrap_or_default());
        let how = format!(
            "{apart:.2e} m from the limit of velocity Verlet, which is known to {own:.1e}; {stated:.1e} stated"
        );
        let explained = GRAVE * own + USUAL * stated + ROUNDING;
        (apart > explained).then(|| Find { kind: Kind::Apart, way: way.name.clone(), how })
    };
    located.filter_map(find).collect()
}
