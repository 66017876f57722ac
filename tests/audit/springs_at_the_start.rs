//! Law: a spring that is drawn at the start moves its body from there. The body may stand on a floor. Source: a body of mass `m` on
//! a spring `k` that is drawn by `d` swings by `d (1 - cos w t)`. Here `w^2 = k/m` for a box without friction, and `2 k/(3 m)` for a disc
//! that rolls. With friction a box slides if `k d > mu_s m g`. It slides by `2 (k d - mu_d m g)/k`. There it stays if the spring
//! pulls with less than `mu_s m g`. A plate on a spring goes down by `(m + M) g/k (1 - cos w t)` under a box.
//!
//! Tolerance: contacts give by `m g/k_n` across and by `mu m g/k_t` along. Each law is right to a few of these ways, beside the error of
//! velocity Verlet in the default run.

use glam::DVec2;
use jostle::simulation::Overrides;

use super::begins_at_rest::{GRAVITY, load, scene, ways};

const FLOOR: &str = "walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")]";
const BOX: &str = "(name: \"a\", at: (0, 0.05), mass: 1, material: \"m\", shape: Rectangle(width: 0.3, height: 0.1, rounding: 0.005))";
const DISC: &str = "(name: \"a\", at: (0, 0.05), mass: 1, material: \"m\", atoms: Disc(radius: 0.05))";
/// In N/m.
const CONTACT: f64 = 1e6;
/// In N/m.
const SPRING: f64 = 10.0;
/// The ways in metres by which a contact gives: `m g/k_n` across, and less along.
const GIVES: f64 = GRAVITY / CONTACT;

/// A body whose spring is drawn by `drawn` metres.
fn pulled(friction: &str, body: &str, drawn: f64, duration: f64) -> String {
    let material = format!("stiffness: {CONTACT:?}, restitution: 0.2, friction: {friction}");
    let length = 2.0 - drawn;
    let things = format!(
        "{FLOOR}, bodies: [{body}], forces: [Spring(a: \"a\", b: World, anchor_b: (2, 0.05), stiffness: {SPRING:?}, length: {length:?})]"
    );
    scene("", &material, &things, duration)
}

/// The way of the first body at the end.
fn way(text: &str, begin: DVec2, overrides: &Overrides) -> DVec2 {
    let mut simulation = load(text, overrides);
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
    simulation.bodies().position[0] - begin
}

/// The error of the default run is that of its tick. Its estimate says some 1e-3 m behind a slip.
fn allowed(name: &str) -> f64 {
    if name == "default" { 2e-3 } else { 10.0 * GIVES }
}

#[test]
fn a_drawn_spring_slides_a_box_as_far_as_friction_lets_it() {
    let begin = DVec2::new(0.0, 0.05);
    for (name, overrides) in ways() {
        for (of_static, of_dynamic, drawn) in [(0.5, 0.3, 0.4925), (0.5, 0.3, 0.505), (0.2, 0.2, 0.21), (0.9, 0.5, 0.9)]
        {
            let friction = format!("(static: {of_static:?}, dynamic: {of_dynamic:?})");
            let moved = way(&pulled(&friction, BOX, drawn, 2.0), begin, &overrides).x;
            let exact = 2.0 * (drawn - of_dynamic * GRAVITY / SPRING);
            let error = (moved - exact).abs();
            assert!(error < allowed(name), "{name}, friction {friction}, drawn by {drawn} m: {moved} m for {exact} m");
        }
        // Friction holds a spring that pulls with less.
        let moved = way(&pulled("(static: 0.5, dynamic: 0.3)", BOX, 0.48, 2.0), begin, &overrides);
        assert!(moved.length() < 10.0 * GIVES, "{name}: held, and moved by {} m", moved.length());
    }
}

#[test]
fn bodies_that_no_friction_holds_swing_on_their_springs() {
    let begin = DVec2::new(0.0, 0.05);
    for (name, overrides) in ways() {
        for drawn in [0.01, 0.3] {
            for (what, friction, body, inertia) in [("box", "0", BOX, 1.0), ("disc", "0.8", DISC, 1.5)] {
                let duration = 1.2;
                let moved = way(&pulled(friction, body, drawn, duration), begin, &overrides).x;
                let exact = drawn * (1.0 - libm::cos((SPRING / inertia).sqrt() * duration));
                let error = (moved - exact).abs();
                assert!(error < allowed(name), "{name}, {what} drawn by {drawn} m: {moved} m for {exact} m");
            }
        }
    }
}

#[test]
fn a_plate_on_a_spring_goes_down_under_a_box() {
    const UNDER: f64 = 200.0;
    let duration = 0.4;
    let things = format!(
        "bodies: [(name: \"plate\", at: (0, 0), mass: 2, material: \"m\", shape: Rectangle(width: 0.4, height: 0.02, rounding: 0.002)), \
         (name: \"box\", at: (0, 0.06), mass: 1, material: \"m\", shape: Rectangle(width: 0.2, height: 0.1, rounding: 0.005))], \
         forces: [Spring(a: \"plate\", b: World, anchor_b: (0, -1), stiffness: {UNDER:?}, length: 1)]"
    );
    let material = format!("stiffness: {CONTACT:?}, restitution: 0.2, friction: 0.5");
    let text = scene("", &material, &things, duration);
    let exact = -3.0 * GRAVITY / UNDER * (1.0 - libm::cos((UNDER / 3.0).sqrt() * duration));
    for (name, overrides) in ways() {
        let moved = way(&text, DVec2::ZERO, &overrides).y;
        assert!((moved - exact).abs() < allowed(name), "{name}: {moved} m for {exact} m");
    }
}
