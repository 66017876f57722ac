//! The warnings of a completed run: limits that its tick exceeded.

use bevy_ecs::prelude::*;

use super::advice::Remedy;
use super::card::{name, told_overlap};
use super::estimate::EstimatedError;
use jostle_engine::integrate::ChosenMethod;
use jostle_engine::simulation::Plan;
use jostle_engine::simulation::error::KnownError;
use jostle_engine::tick::{EvaluationMode, FEWEST_TICKS_OF_CONTACT, State, TimeScales, far_travel, largest_travel};
use jostle_language::numbers::number;

/// Whether bodies have rested on each other from the start on. No contact began, and no body went far in a tick. An impact of few
/// ticks reaches its overlap within them, so its body goes far.
pub(super) fn only_rests(world: &World) -> bool {
    let state = world.resource::<State>();
    let deepest = told_overlap(world, |deepest| deepest.in_meters).meters;
    !state.time_scales().some_began && largest_travel(state) * FEWEST_TICKS_OF_CONTACT < deepest
}

/// The warnings of a run, one sentence each with body, time, likely cause and remedy.
///
/// `remedy` is what mends them all.
pub(super) fn warnings(world: &World, remedy: Option<Remedy>) -> Vec<String> {
    let name = |entity| name(world, entity);
    let state = world.resource::<State>();
    let (clock, stability) = (state.clock(), state.stability());
    let time_scales = state.time_scales();
    let advice = remedy.map_or_else(String::new, |remedy| format!(". Use {remedy}"));
    let mut warnings = Vec::new();
    let known = KnownError::of(world);
    let missed = known.as_ref().and_then(|known| known.warning.clone());
    warnings.extend(missed.or_else(|| EstimatedError::beyond_tolerance(world)));
    // If steps follow their error, ticks are only moments at which the run is read.
    let by_ticks = known.is_none_or(|known| known.estimate.is_none());
    let by_ticks = by_ticks && world.get_resource::<Plan>().and_then(Plan::allowed).is_none();
    let by_ticks = by_ticks && !EstimatedError::is_small(world);
    let time_scales = if by_ticks { time_scales } else { TimeScales::default() };
    let beyond = time_scales.fastest.filter(|fastest| clock.dt > fastest.critical_tick(stability));
    if let Some(fastest) = beyond {
        let critical = fastest.critical_tick(stability);
        let (holder, body, time) = (fastest.holder, name(fastest.body), number(fastest.time));
        let what = match critical {
            0.0 => format!("this method has no stable tick for the {holder} of `{body}` at t = {time} s. They"),
            _ => format!(
                "the tick of {} s is above the critical one of {} s. The {holder} of `{body}` set it at t = {time} s, and",
                number(clock.dt),
                number(critical),
            ),
        };
        warnings.push(format!("{what} can gain energy at each tick{advice}"));
    }
    let steps = state.steps();
    let known = state.time_scales().fastest.map(|fastest| fastest.angular_frequency);
    let critical = known.or(stability.stiffest_contact()).map(|fastest| stability.limit / fastest);
    if let Some(critical) = critical.filter(|critical| beyond.is_none() && steps.shortened > 0 && *critical < clock.dt)
    {
        warnings.push(format!(
            "the tick of {} s is above the critical one of {} s. The engine made {} shorter to resolve contacts. A shorter tick \
             resolves them better{advice}",
            number(clock.dt),
            number(critical),
            if steps.shortened == 1 { "one step".to_owned() } else { format!("{} steps", steps.shortened) },
        ));
    }
    // If the tick is above the critical one, this warning is superfluous.
    let brief =
        time_scales.briefest.filter(|brief| beyond.is_none() && brief.duration() / clock.dt < FEWEST_TICKS_OF_CONTACT);
    let brief = brief.filter(|_| !only_rests(world));
    if let Some(brief) = brief {
        let ticks = brief.duration() / clock.dt;
        warnings.push(format!(
            "the contact of `{}` and `{}` at t = {} s lasts {ticks:.1} ticks. The run does not resolve an impact of fewer than \
             {FEWEST_TICKS_OF_CONTACT}{advice}",
            name(brief.between.0),
            name(brief.between.1),
            number(brief.time),
        ));
    }
    let unseen = state.contact_law().is_some() && !ChosenMethod::locates(world);
    let far = far_travel(state).filter(|_| unseen);
    if let Some(far) = far {
        let radii = far.travel / state.bodies().smallest_radius;
        let often = if radii < 1e4 { format!("{radii:.2}") } else { format!("{radii:.1e}") };
        warnings.push(format!(
            "`{}` travelled {often} times the smallest radius in the tick before t = {} s. It may have passed through \
             others unseen{advice}",
            name(far.body),
            number(far.time),
        ));
    }
    let mode = world.get_resource::<ChosenMethod>().map_or_else(EvaluationMode::default, |method| method.mode);
    let departures = state.models().flat_map(|model| model.departures(state, mode));
    warnings.extend(departures.map(|departure| format!("{}. Use {}", departure.what, departure.remedy)));
    let located = state.located();
    if located.given_up > 0 {
        let excluded = match located.excluded {
            0 => String::new(),
            1 => ", or contacts excluded each other (once)".to_owned(),
            times => format!(", or contacts excluded each other ({times} times)"),
        };
        warnings.push(format!(
            "in {} of {} ticks there were too many events to locate them all{excluded}. Velocity Verlet made these ticks: its order is \
             2, and 1 if forces jump",
            located.given_up, clock.ticks,
        ));
    }
    warnings
}
