//! Law: a stack of 20 boxes bears its weight from face to face, stands exactly still, and sways slowly as a whole. Each face has two
//! points of contact of stiffness `k`: it sinks by `F/(2 k)` and resists a tilt with `k w^2/2`. The weight of the boxes above helps the
//! tilt. Source: statics and linear stability; truth file S05.
//!
//! Scene: every second box is longer, so that a face has the two corners of the shorter box. The centres of these round corners are as
//! far apart as the points of the truth. Two equal boxes in series have half the stiffness of one.
//!
//! Tolerances: at each test. Not tested: the least stiffness at which a stack stands (see `hulls`).

use std::fmt::Write;

use jostle::Simulation;
use jostle::contacts::Other;
use jostle::problems::Truth;

use super::support::{METHODS, assert_near, assert_rest, load, run_to};

const TRUTH: &str = include_str!("../../assets/truths/S05_box_stack.json");
const BOXES: usize = 20;
const GRAVITY: f64 = 9.81;
/// Of a point of contact, in N/m.
const STIFFNESS: f64 = 1e6;
/// Height of a box, and distance of the points of a face, in m.
const SIZE: f64 = 0.5;
/// In kg m2, of a square of 1 kg.
const INERTIA: f64 = SIZE * SIZE / 6.0;

/// The height of the middle of a box under its load, in m.
fn height(index: usize) -> f64 {
    let sunk: usize = (0..=index).map(|face| BOXES - face).sum();
    (index as f64 + 0.5) * SIZE - sunk as f64 * GRAVITY / (2.0 * STIFFNESS)
}

/// The stack, a gap in m higher than at rest. `motion` gives each box a velocity along the ground in m/s and a spin in rad/s.
fn stack(clock: &str, material: &str, contacts: &str, motion: &[(f64, f64)], gap: f64) -> Simulation {
    let mut boxes = String::new();
    for index in 0..BOXES {
        let width = if index % 2 == 0 { 0.52 } else { 0.6 };
        let (velocity, spin) = motion.get(index).copied().unwrap_or_default();
        let _ = write!(
            boxes,
            "(name: \"box_{index}\", at: (0, {:?}), velocity: ({velocity:?}, 0), spin: {spin:?}, mass: 1, inertia: {INERTIA:?},
              shape: Rectangle(width: {width:?}, height: {SIZE:?}, rounding: 0.01)),",
            height(index) + gap
        );
    }
    load(&format!(
        "Scene(format: 1, clock: (duration: 100, {clock}), gravity: (0, -{GRAVITY:?}), {contacts}
        materials: {{ \"default\": (stiffness: {:?}, {material}) }},
        bodies: [{boxes} (name: \"ground\", at: (0, -0.5), fixed: true, shape: Rectangle(width: 2, height: 1, rounding: 0.01))])",
        2.0 * STIFFNESS
    ))
}

/// The forces that the faces bear in N, from the ground up.
fn faces(simulation: &Simulation) -> Vec<f64> {
    let mut forces = vec![0.0; BOXES];
    for point in simulation.state().contact_points().expect("the contact law tells its points") {
        let Other::Body(other) = point.other else { panic!("the ground is a body") };
        // The ground is the last body, and below the first.
        let ends = [point.body, other];
        let upper = if ends.contains(&BOXES) { 0 } else { ends[0].max(ends[1]) };
        forces[upper] += point.force.y.abs();
    }
    forces
}

/// A stack that is a tenth of a millimetre too high comes to rest. Tolerance: none for rest; 1e-9 N for sums of rounded forces.
#[test]
fn a_stack_of_twenty_boxes_bears_its_weight_at_rest() {
    let exact = Truth::read(TRUTH).numbers("face forces from the floor up");
    let stepwise = METHODS.map(|method| format!("method: {method}, tick: \"0.1 ms\""));
    for clock in stepwise.iter().map(String::as_str).chain(["method: Dop853, tick: \"1 ms\""]) {
        let mut simulation = stack(clock, "restitution: 0.2, friction: 0.5", "", &[], 1e-4);
        assert_rest(clock, &mut simulation, 2.0, 1.0);
        for (face, (found, exact)) in faces(&simulation).into_iter().zip(&exact).enumerate() {
            assert_near(&format!("{clock}: face {face}"), found, *exact, 1e-9);
        }
    }
}

/// Only the balance of its springs holds an elastic stack. Tolerance: the sinking to nine digits.
#[test]
fn an_elastic_stack_stands_as_deep_as_statics_tell() {
    let sunk = Truth::read(TRUTH).number("sinking of the top face");
    let top = BOXES as f64 * SIZE;
    assert_near("sinking of the top", top - (height(BOXES - 1) + 0.5 * SIZE), sunk, 16.0 * f64::EPSILON * top);
    for clock in ["method: VelocityVerlet, tick: \"0.1 ms\"", "method: Dop853, tick: \"0.5 ms\""] {
        let mut simulation = stack(clock, "restitution: 1, friction: 0.5", "", &[], 0.0);
        run_to(&mut simulation, 1.0);
        let bodies = simulation.bodies();
        for index in 0..BOXES {
            assert_near(&format!("{clock}: box {index}"), bodies.position[index].y, height(index), 1e-9 * sunk);
        }
    }
}

/// The slowest sway of stiff boxes on soft faces: its frequency in rad/s, and the tilts of the boxes towards +x over that of the top.
/// Inverse iteration gains a factor of 30 each time.
fn sway() -> (f64, Vec<f64>) {
    let face = STIFFNESS * SIZE * SIZE / 2.0;
    let places = |tilts: &[f64]| {
        let below = tilts.iter().scan(0.0, |sum, tilt| Some(std::mem::replace(sum, *sum + SIZE * tilt)));
        below.zip(tilts).map(|(below, tilt)| below + 0.5 * SIZE * tilt).collect::<Vec<f64>>()
    };
    let momenta = |tilts: &[f64]| {
        let places = places(tilts);
        let above = |place: usize| SIZE * places[place + 1..].iter().sum::<f64>() + 0.5 * SIZE * places[place];
        tilts.iter().enumerate().map(|(place, tilt)| above(place) + INERTIA * tilt).collect::<Vec<f64>>()
    };
    let stiffness = |place: usize| {
        let above = (BOXES - 1 - place) as f64;
        let faces = if place + 1 < BOXES { 2.0 } else { 1.0 };
        faces * face - GRAVITY * SIZE * (above + 0.5)
    };
    let (mut tilts, mut square) = (vec![1.0; BOXES], 0.0);
    for _ in 0..20 {
        // Gauss elimination from the top down to the ground, and back up.
        let mut right = momenta(&tilts);
        let mut pivots: Vec<f64> = (0..BOXES).map(stiffness).collect();
        for place in (0..BOXES - 1).rev() {
            let share = face / pivots[place + 1];
            pivots[place] -= share * face;
            right[place] += share * right[place + 1];
        }
        let mut next = vec![right[0] / pivots[0]];
        for place in 1..BOXES {
            next.push((right[place] + face * next[place - 1]) / pivots[place]);
        }
        let top = next[BOXES - 1];
        square = tilts[BOXES - 1] / top;
        tilts = next.into_iter().map(|tilt| tilt / top).collect();
    }
    (square.sqrt(), tilts)
}

/// Springs of friction give way and slow the sway by a share that falls with their stiffness. Ten times that stiffness tells the
/// frequency without give. Tolerance: levers are shorter by the overlap, 2e-4 of a box at most, on both sides of a face.
#[test]
fn a_stack_sways_as_a_column_on_soft_faces() {
    let truth = Truth::read(TRUTH).number("lowest sway angular frequency (small, all contacts closed, no shear slip)");
    let (frequency, tilts) = sway();
    assert_near("frequency of the column", frequency, truth, 1e-9);
    let mut below = 0.0;
    let motion: Vec<(f64, f64)> = tilts
        .iter()
        .map(|tilt| {
            let middle = below + 0.5 * SIZE * tilt;
            below += SIZE * tilt;
            (1e-5 * middle, -1e-5 * tilt)
        })
        .collect();
    let found = [0.8, 8.0].map(|ratio| {
        let contacts = format!("contacts: Penalty(tangential: Spring(ratio: {ratio:?})),");
        let clock = "method: Dop853, tick: \"1 ms\"";
        let mut simulation = stack(clock, "restitution: 1, friction: 5", &contacts, &motion, 0.0);
        let (mut passes, mut last) = (Vec::new(), (0.0, 0.0));
        while passes.len() < 4 {
            simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
            let now = (simulation.clock().time(), simulation.bodies().position[BOXES - 1].x);
            if now.1 * last.1 < 0.0 {
                passes.push(last.0 + (now.0 - last.0) * last.1 / (last.1 - now.1));
            }
            last = now;
        }
        4.0 * std::f64::consts::PI / passes[3]
    });
    let rigid = (10.0 * found[1] - found[0]) / 9.0;
    println!("{found:?}, without give {rigid}, exact {truth}");
    let overlap = BOXES as f64 * GRAVITY / (2.0 * STIFFNESS);
    assert_near("frequency of the stack", rigid, truth, 2.0 * overlap / SIZE * truth);
}
