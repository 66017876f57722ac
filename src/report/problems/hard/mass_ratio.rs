//! A heavy disc on a light one, and the reverse; and a heavy disc that runs into a light one. Ratios of masses of up to 10 000. SI units.
//!
//! Contact forces at rest are those of statics for every ratio. In an elastic collision the light disc leaves with `2 v
//! M/(M + m)`, and the heavy one continues with `v (M - m)/(M + m)`.

use std::error::Error;

use super::{Case, Extent, Readings, column, load};

/// The case.
pub const CASE: Case = Case {
    name: "mass_ratio",
    what: "ratios of masses of up to 10 000: one disc on another, and in a collision",
    source: "statics and the conservation of momentum and energy; truth file H01",
    cheap: false,
    short: "at rest only the ratio of 10 000",
    run,
};

/// The reference values.
pub const TRUTH: &str = include_str!("../../../../assets/truths/H01_mass_ratio_stack.json");
const GRAVITY: f64 = 9.81;

fn run(extent: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    for ratio in extent.pick(&[1e4][..], &[1e1, 1e2, 1e3, 1e4][..]) {
        let (light, heavy) = ((0.5, 1.0, 2e7), (0.5, *ratio, 2e7));
        let both = (1.0 + ratio) * GRAVITY;
        let what = |order: &str| format!("{order}, {ratio}");
        column::stands(&what("heavy on light"), &[light, heavy], 1e-4, &[both, ratio * GRAVITY], readings)?;
        column::stands(&what("light on heavy"), &[heavy, light], 1e-4, &[both, GRAVITY], readings)?;
    }
    for ratio in [1e1, 1e2, 1e3, 1e4] {
        collide(ratio, readings)?;
    }
    Ok(())
}

/// The heavy disc comes in at 1 m/s.
fn collide(ratio: f64, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let (radius, stiffness) = (0.1, 1e4_f64);
    // The reduced mass is hardly that of the light disc.
    let omega = (stiffness * (1.0 + 1.0 / ratio)).sqrt();
    let tick = 0.6 / omega;
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: Dop853, events: Located),
        materials: {{ \"rubber\": (stiffness: {:?}) }},
        bodies: [
            (name: \"heavy\", at: (-0.213, 0), velocity: (1, 0), material: \"rubber\", atoms: Disc(radius: {radius:?}, mass: {ratio:?})),
            (name: \"light\", at: (0, 0), material: \"rubber\", atoms: Disc(radius: {radius:?}, mass: 1))])",
        30.0 * tick,
        2.0 * stiffness
    ))?;
    simulation.run_to_end()?;
    let velocity = &simulation.bodies().velocity;
    let light = velocity[1].x / (2.0 * ratio / (ratio + 1.0)) - 1.0;
    let heavy = velocity[0].x / ((ratio - 1.0) / (ratio + 1.0)) - 1.0;
    readings.at_most(
        format!("collision, {ratio}: greatest error of a velocity, of itself"),
        light.abs().max(heavy.abs()),
        1e-8,
        "half a period at omega dt = 0.6 with a method of order 8 whose constant is below 1e-6",
    );
    let momentum = (velocity[0].x * ratio + velocity[1].x) / ratio - 1.0;
    readings.at_most(
        format!("collision, {ratio}: error of the momentum, of itself"),
        momentum.abs(),
        64.0 * f64::EPSILON,
        "opposite forces: each of 30 ticks rounds each momentum once",
    );
    Ok(())
}
