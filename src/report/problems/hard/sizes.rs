//! The same scenes with lengths times `s`, times times `sqrt(s)` and stiffness over `s`, from 1e-6 to 1e6. Under the
//! same gravity the motion is the same. SI units.
//!
//! Scaling by a power of four changes no rounding, so all bits are the same. An absolute tolerance anywhere in the
//! contact laws would become visible.

use std::error::Error;
use std::fmt::Write;

use glam::DVec2;

use super::{Case, Extent, Readings, golden, kinetic, load};
use crate::problems::{Truth, elastic_bounce};

/// The case.
pub const CASE: Case = Case {
    name: "sizes",
    what: "sizes of 1e-6 to 1e6 m: the same motion",
    source: "dimensional analysis; truth file H03",
    cheap: false,
    short: "",
    run,
};

/// The reference values.
pub const TRUTH: &str = include_str!("../../../../assets/truths/H03_far_and_scaled.json");

/// Bodies of several atoms that fall into a bin, collide with friction and inelasticity, and come to rest.
pub fn bin(scale: f64) -> String {
    let time = scale.sqrt();
    let mut bodies = String::new();
    let mut chance = golden();
    let mut next = || chance.next().unwrap_or_default();
    for number in 0..8_usize {
        let (x, y) = ((0.3 + 0.4 * (number % 3) as f64) * scale, (0.4 + 0.4 * (number / 3) as f64) * scale);
        let (speed, spin, angle) = ((next() - 0.5) * time, (4.0 * next() - 2.0) / time, 6.0 * next());
        let atoms = if number % 2 == 0 {
            format!("Disc(radius: {:?}, mass: 0.3)", 0.1 * scale)
        } else {
            let (along, up, radius) = (0.12 * scale, 0.05 * scale, 0.08 * scale);
            format!(
                "List([(at: (0, 0), radius: {radius:?}, mass: 0.2), (at: ({along:?}, {up:?}), radius: {radius:?}, mass: 0.1)])"
            )
        };
        let _ = write!(
            bodies,
            "(name: \"b{number}\", at: ({x:?}, {y:?}), angle: {angle:?}, velocity: ({speed:?}, 0), spin: {spin:?},
              material: \"clay\", atoms: {atoms}),"
        );
    }
    let (tick, stiffness, width) = (time / 2048.0, 1e4 / scale, 1.4 * scale);
    format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{ \"clay\": (stiffness: {stiffness:?}, friction: (static: 0.5, dynamic: 0.4), inelasticity: 0.4) }},
        walls: [
            (name: \"floor\", left: ({scale:?}, 0), right: (0, 0), material: \"clay\"),
            (name: \"left\", left: (0, 0), right: (0, {scale:?}), material: \"clay\"),
            (name: \"right\", left: ({width:?}, {scale:?}), right: ({width:?}, 0), material: \"clay\"),
        ],
        bodies: [{bodies}])",
        100.0 * time
    )
}

/// The bounce of [`elastic_bounce`] at a size and a place, with so many ticks per period.
pub fn bounce(scale: f64, offset: DVec2, ticks: f64) -> String {
    let time = scale.sqrt();
    let period = elastic_bounce::PERIOD * time;
    let (radius, stiffness) = (elastic_bounce::RADIUS * scale, elastic_bounce::OMEGA.powi(2) / scale);
    let (x, floor) = (offset.x, offset.y);
    let height = floor + radius + elastic_bounce::HEIGHT * scale;
    format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {:?}, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{ \"rubber\": (stiffness: {stiffness:?}) }},
        walls: [(name: \"floor\", left: ({:?}, {floor:?}), right: ({x:?}, {floor:?}))],
        bodies: [(name: \"ball\", at: ({x:?}, {height:?}), material: \"rubber\", atoms: Disc(radius: {radius:?}, mass: 1))])",
        100.0 * period,
        period / ticks,
        x + scale.max(1.0),
    )
}

fn run(_: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let mut one = load(&bin(1.0))?;
    for tick in [100, 1000, 4000, 20_000] {
        one.run_to_tick(tick)?;
    }
    readings.at_most("bin: kinetic energy after 20 000 ticks, J", kinetic(one.bodies()), 0.0, "it comes to rest");
    for power in [-20, -10, 10, 20] {
        let (length, time) = (2.0_f64.powi(power), 2.0_f64.powi(power / 2));
        let (mut one, mut other) = (load(&bin(1.0))?, load(&bin(length))?);
        let mut differ = 0;
        for tick in [100, 1000, 4000, 20_000] {
            one.run_to_tick(tick)?;
            other.run_to_tick(tick)?;
            let (a, b) = (one.bodies(), other.bodies());
            differ += (0..a.len())
                .filter(|&body| {
                    a.position[body] * length != b.position[body]
                        || a.angle[body] != b.angle[body]
                        || a.velocity[body] * (length / time) != b.velocity[body]
                        || a.spin[body] / time != b.spin[body]
                })
                .count();
        }
        readings.at_most(
            format!("bin of 2^{power} m: bodies that differ by a bit at four moments"),
            differ as f64,
            0.0,
            "powers of four change no rounding",
        );
    }
    let truth = Truth::read(TRUTH);
    for (name, scale) in [("1.0e-6", 1e-6_f64), ("0.001", 1e-3), ("1.0e+3", 1e3), ("1.0e+6", 1e6)] {
        let period = truth.number(&format!("scale {name}: bounce period"));
        readings.at_most(
            format!("bounce at {scale:e} m: error of the closed form's period, of itself"),
            (elastic_bounce::PERIOD * scale.sqrt() / period - 1.0).abs(),
            4.0 * f64::EPSILON,
            "a few units in the last place",
        );
        let (mut one, mut other) =
            (load(&bounce(1.0, DVec2::ZERO, 4000.0))?, load(&bounce(scale, DVec2::ZERO, 4000.0))?);
        let mut worst = 0.0_f64;
        for quarter in 1..=40 {
            one.run_to_tick(1000 * quarter)?;
            other.run_to_tick(1000 * quarter)?;
            let (a, b) = (one.bodies().position[0].y, other.bodies().position[0].y / scale);
            // A share eps of the speed puts the ball off by 4 h eps a period later (see the problem). The errors of all
            // ticks before add up.
            let ticks = 1000.0 * quarter as f64;
            let allowed = 2.0 * ticks * f64::EPSILON * 4.0 * (quarter as f64 / 4.0 + 1.0);
            worst = worst.max((a - b).abs() / allowed);
        }
        readings.at_most(
            format!("bounce at {scale:e} m: difference to 1 m over ten periods, over what rounding makes of it"),
            worst,
            1.0,
            "velocities are rounded twice a tick, and each rounding moves the ball ever after",
        );
    }
    Ok(())
}
