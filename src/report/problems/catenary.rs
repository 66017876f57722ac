//! A chain of twenty links between two pins of one height. It keeps the shape whose links point along their forces,
//! `tan phi = V/H`. SI units.
//!
//! It is a loop of forces. A chain in balance stays at rest under every method.

use std::fmt::Write;

use glam::DVec2;

use super::linkage::{bar, greatest};
use super::{Class, Problem, ProblemSetting, Truth};
use jostle_engine::Simulation;

/// The problem.
pub const PROBLEM: Problem = Problem {
    name: "catenary",
    law: "a chain hangs where its links point along the forces in it",
    source: "statics; truth file J09",
    class: Class::Free,
    tick: 1.0 / 512.0,
    samples: &[0.125, 0.25],
    unit: "1",
    always_located: false,
    scene,
    error,
    leading_error: None,
    constants: &[],
    // Positions are known to 1.2e-15 m, so directions of links to 1.2e-14. So the pull of 5.4 N is known to 6.5e-14 N across. The
    // slowest swing of the chain of 1 kg, at 3 rad/s, goes as far as `2 F/(m w^2)`. Under explicit Euler the fastest, at 114
    // rad/s, grows by `exp(w^2 dt t/2)`.
    rounding: |tick| 2.0 * 6.5e-14 / 9.0 * libm::exp(0.5 * 114.0 * 114.0 * tick * 0.25),
};

/// The reference values.
pub const TRUTH: &str = include_str!("../../../assets/truths/J09_catenary.json");
/// Number of links.
pub const COUNT: usize = 20;
/// Length of a link in m.
const LENGTH: f64 = 0.1;
/// Mass of a link in kg.
const MASS: f64 = 0.05;
/// Distance of both pins in m.
const SPAN: f64 = 1.4;

/// The joints of links, in m.
fn nodes() -> Vec<DVec2> {
    let numbers = Truth::read(TRUTH).numbers("node positions");
    numbers.chunks_exact(2).map(|place| DVec2::new(place[0], place[1])).collect()
}

fn scene(setting: &ProblemSetting, duration: f64) -> String {
    let clock = setting.clock(duration);
    let (nodes, mut bodies, mut joints) = (nodes(), String::new(), String::new());
    let half = 0.5 * LENGTH;
    for link in 0..COUNT {
        bodies += &bar(&format!("link_{link}"), nodes[link], nodes[link + 1], MASS);
        let left = match link.checked_sub(1) {
            None => "a: World, anchor_a: (0, 0)".to_owned(),
            Some(before) => format!("a: \"link_{before}\", anchor_a: ({half:?}, 0)"),
        };
        let _ = write!(joints, "Revolute(name: \"pin_{link}\", {left}, b: \"link_{link}\", anchor_b: (-{half:?}, 0)),");
    }
    let last = COUNT - 1;
    format!(
        "Scene({clock}, gravity: (0, -9.81), contacts: None, bodies: [{bodies}],
        joints: [{joints} Revolute(name: \"pin_{COUNT}\", a: World, anchor_a: ({SPAN:?}, 0), b: \"link_{last}\", anchor_b: ({half:?}, 0))])"
    )
}

/// The greatest distance of a link from its place, over the span.
fn error(simulation: &Simulation, _: f64, _: f64) -> f64 {
    let nodes = nodes();
    let middles = nodes.windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
    greatest(simulation.bodies().position.iter().zip(middles).map(|(found, exact)| found.distance(exact) / SPAN))
}
