//! Law: velocity Verlet and semi-implicit Euler are stable up to the tick `2/w_max`: for a disc on the floor
//! `2 sqrt(m/k)`, for a pair `2 sqrt(m*/k)`, 0.637 of its contact time, for a free chain of `n` touching discs
//! `w_max = 2 sqrt(k/m) cos(pi/(2 n))`. Source: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, I.5.
//!
//! Each is pressed together by steady forces, so that contacts never part, and pushed a little. Below the limit, at 0.99 of
//! it, swings stay within `1/sqrt(1 - 0.99^2)`, seven times what they are in small ticks; above, at 1.01, the highest mode
//! grows by `exp(0.28)` per tick, which is far beyond all bounds after 500 ticks, whatever it began with.
//!
//! Not tested: the limits of packings with rotation.

use std::f64::consts::PI;
use std::fmt::Write;

use super::support::{METHODS, assert_near, load};

const RADIUS: f64 = 0.5;
const MASS: f64 = PI / 4.0;
/// Of a pair, in N/m.
const STIFFNESS: f64 = 1e5;
/// With which the chain is pressed together, in N: an overlap of a hundredth of the radius.
const PRESS: f64 = 500.0;
/// Speed of the push in m/s: a ten thousandth of the overlap.
const PUSH: f64 = 1e-4;

/// A chain of discs under pressure; the greatest displacement from balance after `ticks` ticks over the one that the push
/// makes in a slow swing of one disc.
fn swing(method: &str, count: usize, tick: f64, ticks: u64) -> f64 {
    let (stiffness, spacing) = (2.0 * STIFFNESS, 2.0 * RADIUS - PRESS / STIFFNESS);
    let mut bodies = String::new();
    for index in 0..count {
        let (x, speed) = (spacing * index as f64, if index % 2 == 0 { PUSH } else { -PUSH });
        let _ = write!(
            bodies,
            "(name: \"disc_{index}\", at: ({x:?}, 0), velocity: ({speed:?}, 0), material: \"m\",
              atoms: Disc(radius: {RADIUS:?}, mass: {MASS:?})),"
        );
    }
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: {method}),
        materials: {{ \"m\": (stiffness: {stiffness:?}) }},
        forces: [Thrust(of: \"disc_0\", force: ({PRESS:?}, 0)), Thrust(of: \"disc_{}\", force: (-{PRESS:?}, 0))],
        bodies: [{bodies}])",
        count - 1
    ));
    let mut greatest = 0.0_f64;
    for tick in 1..=ticks {
        if simulation.run_to_tick(tick).is_err() {
            return f64::INFINITY;
        }
        let found = &simulation.bodies().position;
        let overlap = |pair: &[glam::DVec2]| (spacing - (pair[1].x - pair[0].x)).abs();
        greatest = greatest.max(found.windows(2).map(overlap).fold(0.0, f64::max));
    }
    greatest / (PUSH * (MASS / STIFFNESS).sqrt())
}

#[test]
fn chains_are_stable_up_to_their_limit() {
    for (count, what) in [(2, "pair"), (5, "five"), (30, "thirty")] {
        let greatest = 2.0 * (STIFFNESS / MASS).sqrt() * (PI / (2 * count) as f64).cos();
        let limit = 2.0 / greatest;
        if count == 30 {
            assert_near("rate of the catalogue", greatest, 712.671_61, 1e-5);
            assert_near("limit of the catalogue", limit, 2.806_341_6e-3, 1e-10);
        }
        if count == 2 {
            let contact_time = PI * (MASS / 2.0 / STIFFNESS).sqrt();
            assert_near("share of the contact time", limit / contact_time, 0.637, 1e-3);
        }
        for method in METHODS {
            let (below, above) = (swing(method, count, 0.99 * limit, 500), swing(method, count, 1.01 * limit, 500));
            let slow = swing(method, count, 0.05 * limit, 10_000);
            println!("{method}, {what}: {slow:.2} slow, {below:.2} below, {above:.2e} above");
            // As many modes as contacts; each may add up with the others.
            assert!(below <= 7.2 * slow, "{method}, {what}: {below} below the limit");
            assert!(above > 1e3, "{method}, {what}: {above} above the limit");
        }
    }
}
