//! Four balls meet a wall with springs and dashpots that never pull, `N = max(0, k d - c v_n)`. Damping ratios `zeta =
//! c/(2 sqrt(k m))` run from small to nearly critical. SI units, no gravity.
//!
//! During contact `d = (v/w) e^(-b t) sin(w t)`, with `b = zeta w0`, `w^2 = w0^2 - b^2`. A contact that does not pull
//! ends with its force, before its overlap is gone (Schwager and Poeschel 2007). That is at `w t = atan2(2 b w, b^2 -
//! w^2)`, with `e = exp(-b t)`. A contact that pulls would last `pi/w`. The force jumps to `c v` at the first touch, so
//! a method that does not locate it has order 1.

use std::f64::consts::PI;
use std::fmt::Write;

use super::{Class, Constant, Problem, ProblemSetting, rounding_of};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "dashpot_impact",
    law: "restitution of a spring and a dashpot that never pull, whatever the speed",
    source: "closed form (Schwager and Poeschel, Granular Matter 9, 2007); truth file C03",
    class: Class::Jump,
    tick: 5e-4,
    samples: &[0.03, 0.045, 0.06],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: Some(leading_error),
    constants: CONSTANTS,
    rounding: |tick| rounding_of(0.06 / tick, 10.0),
};

/// Measured at finer ticks.
const CONSTANTS: &[Constant] = &[
    Constant::located("ExplicitEuler", 1, 3.987e1),
    Constant::per_tick("SemiImplicitEuler", 1, 1.188e1),
    Constant::located("SemiImplicitEuler", 1, 2.027e1),
    Constant::per_tick("VelocityVerlet", 1, 5.846e0),
    Constant::located("VelocityVerlet", 2, 3.855e2),
    Constant::located("ImplicitMidpoint", 2, 6.211e2),
    Constant::located("RungeKutta4", 4, 5.561e5),
    Constant::located("Symplectic4", 4, 7.296e3),
];

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/C03_spring_dashpot.json");
/// Damping ratios of the balls.
pub const RATIOS: [f64; 4] = [0.05, 0.2, 0.5, 0.9];
/// Speed before the impact in m/s.
const SPEED: f64 = 2.0;
/// Gap at the start in m.
const GAP: f64 = 0.04;
/// `sqrt(k/m)` in 1/s; the mass is 1 kg.
pub const OMEGA: f64 = 100.0;
/// In m.
const RADIUS: f64 = 0.1;

/// The duration of a contact in s, and its restitution. If it `pulls`, it lasts until the overlap is gone, otherwise
/// until its force is zero.
pub fn contact(ratio: f64, pulls: bool) -> (f64, f64) {
    let decay = ratio * OMEGA;
    let rate = (OMEGA * OMEGA - decay * decay).sqrt();
    let lasts = if pulls { PI / rate } else { libm::atan2(2.0 * decay * rate, decay * decay - rate * rate) / rate };
    (lasts, libm::exp(-decay * lasts))
}

/// Gap in m at `time`, with the first touch at `GAP / SPEED`.
fn gap(time: f64, ratio: f64) -> f64 {
    let touching = time - GAP / SPEED;
    if touching <= 0.0 {
        return -SPEED * touching;
    }
    let decay = ratio * OMEGA;
    let rate = (OMEGA * OMEGA - decay * decay).sqrt();
    let overlap = |time: f64| SPEED / rate * libm::exp(-decay * time) * libm::sin(rate * time);
    let (lasts, restitution) = contact(ratio, false);
    if touching <= lasts { -overlap(touching) } else { restitution * SPEED * (touching - lasts) - overlap(lasts) }
}

/// A shift moves the start along the approach. The restitution of each pair asks for the damping.
fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (height, stiffness) = (RADIUS + GAP - SPEED * setting.shift, OMEGA * OMEGA);
    let (mut bodies, mut materials, mut pairs) = (String::new(), String::new(), String::new());
    for (index, ratio) in RATIOS.into_iter().enumerate() {
        let restitution = contact(ratio, false).1;
        let _ = write!(materials, "\"rubber_{index}\": (stiffness: {stiffness:?}),");
        let _ = write!(pairs, "(between: (\"rubber_{index}\", \"floor\"), restitution: {restitution:?}),");
        let _ = write!(
            bodies,
            "(name: \"ball_{index}\", at: ({index}, {height:?}), velocity: (0, -{SPEED:?}), material: \"rubber_{index}\",
              atoms: Disc(radius: {RADIUS:?}, mass: 1)),"
        );
    }
    format!(
        "Scene({clock}, contacts: Penalty(normal: Dashpot), materials: {{ {materials} \"floor\": () }}, pairs: [{pairs}],
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"floor\")], bodies: [{bodies}])"
    )
}

/// The greatest, over the way that a ball would have made in half a period without damping.
fn error(simulation: &Simulation, time: f64, shift: f64) -> f64 {
    let of = |(index, ratio): (usize, f64)| {
        let found = simulation.bodies().position[index].y - RADIUS;
        (found - gap(time + shift, ratio)).abs() / (SPEED * PI / OMEGA)
    };
    RATIOS.into_iter().enumerate().map(of).fold(0.0, |most, error| if error <= most { most } else { error })
}

/// The jump to `c v` comes up to half a tick too early or too late. So the speed is off by a share `zeta w0 dt` in
/// touch. The ball's way is off by that in as many seconds as it flies after it. Kicks of whole ticks use the velocity
/// of half a tick before, which doubles it. Terms of order 2 (see the law of dashpots) are `(1/2 + zeta + 6.5
/// zeta^2)(w0 dt)^2`, and twice that for kicks of whole ticks. Semi-implicit Euler is ahead by half a tick of the way.
fn leading_error(_: u32, tick: f64) -> f64 {
    let step = OMEGA * tick;
    let of = |ratio: f64| 2.0 * ratio * step + 2.0 * (0.5 + ratio + 6.5 * ratio * ratio) * step * step;
    let way = SPEED * (0.06 - GAP / SPEED) * RATIOS.into_iter().map(of).fold(0.0, f64::max) + SPEED * tick / 2.0;
    way / (SPEED * PI / OMEGA)
}
