//! Linkages at dead points, at which two bars are in line. A motor drives a rocker into one, beyond which the loop
//! cannot move. A parallelogram runs through one, at which it could continue as another linkage. SI units.
//!
//! The base of the rocker of 0.3 m is 0.4 m long. Crank and coupler of 0.1 and 0.35 m reach 0.45 m. The parallelogram
//! continues in its form, because bodies keep their velocities. At a distance `s` from the dead point in rad, errors of
//! velocities are rounding over `s^2`.

use std::error::Error;

use crate::SimulationExt;
use glam::DVec2;

use super::{Case, Extent, Reading, Readings, Threshold, load};
use crate::problems::linkage::bar;
use crate::problems::{EventTiming, ProblemSetting, methods};

/// The case.
pub const CASE: Case = Case {
    name: "dead_point",
    what: "a motor drives a four-bar into its dead point; a parallelogram runs through one",
    source: "geometry of the loop",
    cheap: true,
    short: "",
    run,
};

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    for method in ["VelocityVerlet", "RungeKutta4", "Dop853"] {
        driven(method, readings)?;
    }
    for method in methods().into_iter().filter(|method| method.stability_limit > 0.0) {
        passes(method.name, readings)?;
    }
    Ok(())
}

/// The rocker is turned at 1 rad/s towards the place where crank and coupler are in line.
fn driven(method: &str, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let (crank, base) = (DVec2::new(0.1, 0.0), DVec2::new(0.4, 0.0));
    let along = 0.1225 / 0.6;
    let top = crank + DVec2::new(along, (0.1225 - along * along).sqrt());
    let bodies =
        [bar("crank", DVec2::ZERO, crank, 1.0), bar("coupler", crank, top, 1.0), bar("rocker", base, top, 1.0)]
            .concat();
    let tick = 1e-3;
    let clock = ProblemSetting { method, tick, ..ProblemSetting::default() }.clock(1.0);
    let mut simulation = load(&format!(
        "Scene({clock}, contacts: None, bodies: [{bodies}],
        joints: [Revolute(a: World, anchor_a: (0, 0), b: \"crank\", anchor_b: (-0.05, 0)),
                 Revolute(a: \"crank\", anchor_a: (0.05, 0), b: \"coupler\", anchor_b: (-0.175, 0)),
                 Revolute(a: \"coupler\", anchor_a: (0.175, 0), b: \"rocker\", anchor_b: (0.15, 0)),
                 Revolute(name: \"hub\", a: World, anchor_a: (0.4, 0), b: \"rocker\", anchor_b: (-0.15, 0))],
        controllers: [Motor(of: \"hub\", speed: -1)])"
    ))?;
    // Law of cosines, with the angle of the rocker to the x axis.
    let begun = libm::atan2(top.y, top.x - base.x);
    let dead = begun - libm::acos((0.2025 - 0.25) / 0.24);
    let ended = simulation.run_to_end().err();
    let time = ended.as_ref().map_or(f64::INFINITY, |failure| failure.time);
    readings.at_least(
        format!("{method}: when the run ends, s"),
        time,
        dead - tick,
        "until its dead point the linkage can move",
    );
    readings.at_most(
        format!("{method}: runs that come to their end without a message"),
        f64::from(ended.is_none()),
        0.0,
        "the loop has no motion beyond",
    );
    Ok(())
}

/// Two cranks of 1 m and a coupler turn steadily at 6 rad/s, through the dead point at 90 degrees.
fn passes(method: &str, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let (spin, tick, ticks) = (6.0, 1.3e-3, 300);
    let crank = |name: &str, x: f64| {
        let bar = bar(name, DVec2::new(x, 0.0), DVec2::new(x, 1.0), 1.0);
        bar.replace("angle:", &format!("velocity: ({:?}, 0), spin: {spin:?}, angle:", -0.5 * spin))
    };
    let coupler = bar("coupler", DVec2::new(0.0, 1.0), DVec2::new(1.0, 1.0), 1.0);
    let coupler = coupler.replace("angle:", &format!("velocity: ({:?}, 0), angle:", -spin));
    let setting = ProblemSetting { method, tick, events: EventTiming::Auto, ..ProblemSetting::default() };
    let clock = setting.clock(tick * f64::from(ticks));
    let mut simulation = load(&format!(
        "Scene({clock}, contacts: None, bodies: [{} {} {coupler}],
        joints: [Revolute(a: World, anchor_a: (0, 0), b: \"left\", anchor_b: (-0.5, 0)),
                 Revolute(a: World, anchor_a: (1, 0), b: \"right\", anchor_b: (-0.5, 0)),
                 Revolute(a: \"left\", anchor_a: (0.5, 0), b: \"coupler\", anchor_b: (-0.5, 0)),
                 Revolute(a: \"right\", anchor_a: (0.5, 0), b: \"coupler\", anchor_b: (0.5, 0))])",
        crank("left", 0.0),
        crank("right", 1.0)
    ))?;
    let told = simulation.run_to_end().err().map(|failure| failure.to_string());
    let said = |text: &str| text.contains("dead point");
    let silent = match &told {
        Some(failure) => !said(failure),
        None => !simulation.card().notes.iter().any(|note| said(note)),
    };
    readings.at_most(
        format!("parallelogram, {method}: runs that do not say that they met a dead point"),
        f64::from(silent),
        0.0,
        "rows depend on each other where bars are in line",
    );
    // The distance of the end of a tick from the dead point.
    let quarter = std::f64::consts::FRAC_PI_2 / (spin * tick);
    let nearest = (quarter - quarter.round()).abs() * spin * tick;
    let bodies = simulation.bodies();
    let apart = (bodies.angle[0] - bodies.angle[1]).abs().max(bodies.angle[2].abs());
    readings.0.push(Reading {
        what: format!("parallelogram, {method}: how far cranks and coupler turn apart, rad"),
        value: if told.is_some() { f64::NAN } else { apart },
        threshold: Threshold::AtMost(64.0 * f64::EPSILON / (nearest * nearest)),
        why: "bodies keep their velocities: rounding over the square of the least distance, and a few",
        told,
    });
    Ok(())
}
