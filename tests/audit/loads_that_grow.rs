//! Law: friction holds a body at rest as long as its load lies within the static cone, whatever the normal force does meanwhile. The
//! load and the normal force of a box grow together, so their ratio does not change. The springs of its corners are compressed by the
//! growing load, and their friction goes on. Source: Coulomb.
//!
//! Tolerances: each corner sinks by no more than the spring of all the load, and the box turns by the difference of two corners over its
//! width. The boxes are at most half as high as wide. So no box moves by more than four times the greatest load over the stiffness. It
//! would slide by centimetres.
//!
//! Not tested: loads that change so quickly that the springs of the corners swing; loads near all that several contacts can hold.

use std::f64::consts::PI;

use super::begins_at_rest::{GRAVITY, load, on_slope, scene, ways};

/// The mass of the box of [`on_slope`] is 1 kg.
const WEIGHT: f64 = GRAVITY;

/// Slopes with coefficients that hold at rest: angle in degrees, static and dynamic.
const SLOPES: [(f64, f64, f64); 3] = [(24.0, 0.5, 0.4), (24.0, 0.48, 0.48), (11.0, 0.25, 0.15)];

/// Restitution and stiffness.
const MATERIALS: [(f64, f64); 4] = [(0.1, 1e5), (0.2, 1e6), (0.5, 3e5), (0.7, 1e6)];

/// Laws, and whether they need located events.
const LAWS: [(&str, bool); 3] =
    [("tangential: Exact", true), ("normal: Dashpot", false), ("normal: Inelasticity", false)];

/// The course of the load as a share of its greatest value.
const COURSES: [&str; 2] = ["Piecewise([(0, 0), (0.1, 0), (0.5, 1)])", "Sine(amplitude: 1, frequency: 1.2)"];

#[test]
fn a_box_holds_while_its_load_grows_along_gravity() {
    for (number, (restitution, stiffness)) in MATERIALS.into_iter().enumerate() {
        for (degrees, held, slips) in SLOPES {
            let grows = COURSES[number % COURSES.len()];
            let greatest = if number % COURSES.len() == 0 { 3.0 * WEIGHT } else { 0.8 * WEIGHT };
            let shape = format!("shape: Rectangle(width: {:?}, height: 0.1)", 0.2 + 0.1 * number as f64);
            let things = format!(
                "{}, forces: [Drive(of: \"a\", force: (0, {:?}), course: {grows})]",
                on_slope(degrees / 180.0 * PI, 0.05, &shape),
                -greatest
            );
            let material = format!(
                "stiffness: {stiffness:?}, restitution: {restitution:?}, friction: (static: {held:?}, dynamic: {slips:?})"
            );
            for (law, located) in LAWS {
                let text = scene(law, &material, &things, 0.6);
                for (name, overrides) in &ways()[usize::from(located)..] {
                    let mut simulation = load(&text, overrides);
                    let begin = simulation.bodies().position[0];
                    simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
                    let moved = simulation.bodies().position[0].distance(begin);
                    let allowed = 4.0 * (WEIGHT + greatest) / stiffness;
                    assert!(moved < allowed, "{name}: {moved:e} m, {allowed:e} m allowed\n{text}");
                }
            }
        }
    }
}
