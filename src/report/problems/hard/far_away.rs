//! A ball that bounces, and a cluster that turns, 1e6 m from the origin. SI units.
//!
//! At `X` coordinates are rounded to `ulp(X)`. So overlaps are off by half of it, and forces by `k ulp(X)/2`.
//! Velocities are off by that times the contact time over the mass.

use std::error::Error;

use glam::DVec2;

use super::{Case, Extent, Readings, load, run_to, sizes};
use crate::problems::{ProblemSetting, Truth, cluster_rotation, elastic_bounce};

/// The case.
pub const CASE: Case = Case {
    name: "far_away",
    what: "a ball bounces and a cluster turns 1e6 m from the origin as they do there",
    source: "physics knows no origin; truth file H03",
    cheap: true,
    short: "",
    run,
};

/// In m.
const FAR: f64 = 1e6;

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let ulp = Truth::read(sizes::TRUTH).number("ulp of the coordinate at X (f64)");
    let mut here = load(&sizes::bounce(1.0, DVec2::ZERO, 4000.0))?;
    let mut beside = load(&sizes::bounce(1.0, DVec2::new(FAR, 0.0), 4000.0))?;
    let mut there = load(&sizes::bounce(1.0, DVec2::new(FAR, FAR), 4000.0))?;
    let (mut aside, mut worst) = (0.0_f64, 0.0_f64);
    for quarter in 1..=20 {
        for simulation in [&mut here, &mut beside, &mut there] {
            simulation.run_to_tick(1000 * quarter)?;
        }
        let height = here.bodies().position[0].y;
        aside += f64::from(beside.bodies().position[0].y != height);
        // The start is off by half an ulp of height more. A velocity error u puts the ball off by 4 h u/v a period
        // later.
        let contacts = (quarter as f64 / 4.0).ceil();
        let speed = elastic_bounce::OMEGA.powi(2) * 0.5 * ulp * 0.032 + 9.81 * ulp / 3.1;
        let allowed = 4.0 * 0.5 / 3.1 * speed * contacts * (contacts + 1.0) / 2.0 + 2.0 * ulp;
        worst = worst.max((there.bodies().position[0].y - FAR - height).abs() / allowed);
    }
    readings.at_most(
        "bounce 1e6 m beside: heights of 20 that differ",
        aside,
        0.0,
        "the other coordinate is not touched by it",
    );
    readings.at_most(
        "bounce 1e6 m beside and above: error of the height, over what half an ulp of overlap makes of it",
        worst,
        1.0,
        "each contact of 32 ms changes the velocity by up to k ulp/2 t/m, and flights make places of it",
    );

    let setting = ProblemSetting { method: "VelocityVerlet", tick: 1e-4, ..ProblemSetting::default() };
    let text = (cluster_rotation::PROBLEM.scene)(&setting, 1.0);
    let mut here = load(&text)?;
    let mut there = load(&text.replace("at: (0, 0), velocity", &format!("at: ({FAR:?}, {FAR:?}), velocity")))?;
    run_to(&mut here, 1.0)?;
    run_to(&mut there, 1.0)?;
    let differ = f64::from(here.bodies().angle != there.bodies().angle);
    readings.at_most("cluster: angles that differ", differ, 0.0, "angles do not know where they are");
    let off = (0..here.bodies().atom_count())
        .map(|atom| (here.bodies().atom_place(atom), there.bodies().atom_place(atom)))
        .map(|(a, b)| (b - DVec2::splat(FAR) - a).abs().max_element())
        .fold(0.0, f64::max);
    readings.at_most(
        "cluster: greatest error of the place of an atom, ulps of 1e6 m",
        off / ulp,
        1.5,
        "the centre and the sum of centre and offset are rounded once each",
    );
    readings.at_least(
        "cluster: the same, to see that it is far away",
        off / ulp,
        1e-6,
        "1e6 m has a coarser grid than 1 m",
    );
    Ok(())
}
