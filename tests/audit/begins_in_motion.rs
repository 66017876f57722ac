//! Law: bodies that touch at the start, and that nothing holds, slide, roll or tip from the first moment on. The springs of their
//! contacts bear the rest of the loads, so they give no kick. Source: dynamics of rigid bodies.
//!
//! * A row of `n` boxes pushed by a force `F` slides with `F / (n m) - mu g`.
//! * A disc on a slope rolls with `g sin a / (1 + I / (m r^2))`. `r` is its radius without its overlap `m g cos a / k`. Above
//!   `tan a = 3 mu` it slides with `g (sin a - mu cos a)`.
//! * A block on a rough slope tips about its lower edge, as a pendulum.
//!
//! Tolerances: the search for the start may leave a share of 1e-7 of the forces. So the way is right to ten times that share. A block
//! that tips turns about an edge that goes up by `m g/k` on its way. That is a share of the size of the block, and ten times it are
//! allowed. Kicks of springs would be of the order of its root.
//!
//! Not tested: bodies that joints hold; they begin as the scene places them.

use std::fmt::Write;

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;

use super::begins_at_rest::{GRAVITY, on_slope, scene};

/// The share of forces that the search for the start may leave, ten times.
const SEARCH: f64 = 1e-6;

/// The default, a method of fixed ticks, and two ways with located events.
fn ways() -> [Overrides; 4] {
    let method =
        |name: &str, tick: Option<f64>| Overrides { method: Some(name.to_owned()), tick, ..Overrides::default() };
    [
        Overrides::default(),
        method("Dop853", Some(1e-3)),
        method("Reference", None),
        Overrides { tolerance: Some(1e-6), ..Overrides::default() },
    ]
}

/// Laws of contacts, stiffnesses in N/m, restitutions.
const LAWS: [(&str, f64, f64); 4] = [("", 1e5, 0.3), ("normal: Dashpot", 1e5, 0.5), ("", 1e7, 0.0), ("", 1e6, 1.0)];

/// Runs to the end. Returns the way of the first body from its place at the beginning, and its turn.
fn moved(text: &str, overrides: &Overrides) -> (f64, f64) {
    let load = Simulation::load_with(&Source::new("start.ron", text), overrides, |_| {});
    let mut simulation = load.unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    let (place, angle) = (simulation.bodies().position[0], simulation.bodies().angle[0]);
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{overrides:?}: {failure}\n{text}"));
    let bodies = simulation.bodies();
    (bodies.position[0].distance(place), bodies.angle[0] - angle)
}

#[test]
fn a_row_of_boxes_that_is_pushed_slides_at_once() {
    const TIME: f64 = 0.4;
    for (index, (law, stiffness, restitution)) in LAWS.into_iter().enumerate() {
        for (count, height, friction) in [(1, 0.2, 0.5), (2, 0.1, 0.4), (3, 0.3, 0.3), (5, 0.2, 0.2)] {
            let mut bodies = String::new();
            for number in 0..count {
                let (x, y) = (0.4 * f64::from(number), 0.5 * height);
                write!(
                    bodies,
                    "(name: \"b{number}\", at: ({x:?}, {y:?}), mass: 1, material: \"m\", \
                     shape: Rectangle(width: 0.4, height: {height:?})), "
                )
                .unwrap();
            }
            let mass = f64::from(count);
            let force = 1.7 * friction * mass * GRAVITY;
            let text = scene(
                law,
                &format!(
                    "stiffness: {stiffness:?}, restitution: {restitution:?}, friction: (static: {:?}, dynamic: {friction:?})",
                    1.2 * friction
                ),
                &format!(
                    "walls: [(name: \"floor\", left: (50, 0), right: (-50, 0), material: \"m\")], bodies: [{bodies}], \
                     forces: [Thrust(of: \"b0\", force: ({force:?}, 0))]"
                ),
                TIME,
            );
            let exact = 0.5 * (force / mass - friction * GRAVITY) * TIME * TIME;
            let (way, _) = moved(&text, &ways()[(index + count as usize) % 4]);
            assert!((way - exact).abs() <= SEARCH * exact, "{way} instead of {exact}\n{text}");
        }
    }
}

#[test]
fn a_disc_on_a_slope_rolls_or_slides_at_once() {
    const TIME: f64 = 0.5;
    const RADIUS: f64 = 0.1;
    for (index, (law, stiffness, restitution)) in LAWS.into_iter().enumerate() {
        for (turn, angle) in [0.1, 0.4, 0.9, 1.3].into_iter().enumerate() {
            let friction = 0.5;
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            let text = scene(
                law,
                &format!("stiffness: {stiffness:?}, restitution: {restitution:?}, friction: {friction:?}"),
                &on_slope(angle, RADIUS, &format!("atoms: Disc(radius: {RADIUS:?})")),
                TIME,
            );
            let arm = 1.0 - GRAVITY * cos / stiffness / RADIUS;
            let rolls = GRAVITY * sin / (1.0 + 0.5 / (arm * arm));
            let slides = GRAVITY * (sin - friction * cos);
            let exact = 0.5 * rolls.max(slides) * TIME * TIME;
            let (way, _) = moved(&text, &ways()[(index + turn) % 4]);
            assert!((way - exact).abs() <= SEARCH * exact, "{way} instead of {exact}\n{text}");
        }
    }
}

/// The turn in rad of a block of this width and height after a time, about its lower edge on a slope. The method is that of Runge
/// and Kutta with steps whose error is far below the tolerance.
fn tips(width: f64, height: f64, angle: f64, time: f64) -> f64 {
    const STEPS: usize = 2000;
    let moment = (width * width + height * height) / 3.0;
    let rate = |turn: f64| {
        let lever = 0.5 * (height * libm::sin(angle + turn) - width * libm::cos(angle + turn));
        GRAVITY * lever / moment
    };
    let (mut turn, mut spin, step) = (0.0, 0.0, time / STEPS as f64);
    for _ in 0..STEPS {
        let first = (spin, rate(turn));
        let second = (spin + 0.5 * step * first.1, rate(turn + 0.5 * step * first.0));
        let third = (spin + 0.5 * step * second.1, rate(turn + 0.5 * step * second.0));
        let fourth = (spin + step * third.1, rate(turn + step * third.0));
        turn += step / 6.0 * (first.0 + 2.0 * (second.0 + third.0) + fourth.0);
        spin += step / 6.0 * (first.1 + 2.0 * (second.1 + third.1) + fourth.1);
    }
    turn
}

#[test]
fn a_block_on_a_rough_slope_tips_at_once() {
    const TIME: f64 = 0.15;
    const ANGLE: f64 = 0.8;
    for (index, (law, _, restitution)) in LAWS.into_iter().enumerate() {
        for (width, height) in [(0.2, 0.6), (0.3, 0.5), (0.1, 0.4)] {
            for stiffness in [1e5, 1e7] {
                let text = scene(
                    law,
                    &format!("stiffness: {stiffness:?}, restitution: {restitution:?}, friction: 3"),
                    &on_slope(ANGLE, 0.5 * height, &format!("shape: Rectangle(width: {width:?}, height: {height:?})")),
                    TIME,
                );
                let exact = tips(width, height, ANGLE, TIME);
                let (_, turn) = moved(&text, &ways()[(index + 2) % 4]);
                let allowed = 10.0 * GRAVITY / stiffness / width;
                assert!((turn - exact).abs() <= allowed, "{turn} instead of {exact}, {allowed:e} allowed\n{text}");
            }
        }
    }
}
