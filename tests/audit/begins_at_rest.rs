//! Law: bodies that touch at the start and can rest stay where they are. The springs of their contacts bear the loads from the first
//! moment on, so no body drops and rebounds. Source: statics. On a slope with the angle `a` a box holds if the static coefficient
//! exceeds `tan a`, and a disc if its coefficient of rolling does too. Steeper ones slide with `g (sin a - mu_d cos a)` from the
//! first moment on.
//!
//! Tolerances: a body at rest keeps its place to the last bit under `Inelasticity`, and to 1e-6 of `m g/k` under `Dashpot`, whose
//! forces have one value at rest. The engine moves a body before the start by the compression of its springs. That is a few times
//! `m g/k`: a corner bears at most all, and a box that leans turns by the difference of two corners. The search for the start may
//! leave a share of 1e-7 of the forces. So the way of a slide is right to ten times that share, and to the last digits of its places.
//!
//! Not tested: bodies that joints hold, see `joined_at_the_start.rs`.

use std::f64::consts::PI;
use std::fmt::Write;

use glam::DVec2;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

pub(super) const GRAVITY: f64 = 9.81;

/// The default, and two ways with located events.
pub(super) fn ways() -> [(&'static str, Overrides); 3] {
    let located = Overrides { method: Some("Dop853".to_owned()), tick: Some(1e-3), ..Overrides::default() };
    let tolerance = Overrides { tolerance: Some(1e-6), ..Overrides::default() };
    [("default", Overrides::default()), ("Dop853", located), ("tolerance 1e-6", tolerance)]
}

pub(super) fn load(text: &str, overrides: &Overrides) -> Simulation {
    Simulation::load_with(&Source::new("start.ron", text), overrides, |_| {}).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// A scene of `duration` seconds with one material.
pub(super) fn scene(contacts: &str, material: &str, things: &str, duration: f64) -> String {
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}), gravity: (0, -{GRAVITY:?}), contacts: Penalty({contacts}), \
         materials: {{\"m\": ({material})}}, {things})"
    )
}

/// A wall through the origin that rises to the right with an angle, and a body of mass 1 that stands on it at 3 m.
pub(super) fn on_slope(angle: f64, half: f64, shape: &str) -> String {
    let along = DVec2::new(libm::cos(angle), libm::sin(angle));
    let (end, at) = (along * 100.0, along * 3.0 + along.perp() * half);
    format!(
        "walls: [(name: \"ramp\", left: ({:?}, {:?}), right: (0, 0), material: \"m\")], \
         bodies: [(name: \"a\", at: ({:?}, {:?}), angle: {angle:?}, mass: 1, material: \"m\", {shape})]",
        end.x, end.y, at.x, at.y
    )
}

fn starts(simulation: &Simulation) -> Vec<(DVec2, f64)> {
    let bodies = simulation.bodies();
    bodies.position.iter().copied().zip(bodies.angle.iter().copied()).collect()
}

/// Runs to the end, and demands that no body moves farther than `allowed` metres from where it began.
fn assert_stays(what: &str, text: &str, overrides: &Overrides, allowed: f64) -> Simulation {
    let mut simulation = load(text, overrides);
    let begin = starts(&simulation);
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{what}: {failure}"));
    for (body, (before, after)) in begin.iter().zip(starts(&simulation)).enumerate() {
        let moved = before.0.distance(after.0) + (before.1 - after.1).abs() * simulation.bodies().extents()[body];
        assert!(moved <= allowed, "{what}: body {body} moved by {moved:e} m, {allowed:e} allowed\n{text}");
    }
    simulation
}

/// Families of laws and materials: the name, the contacts, the stiffness, and how far a body may move as a share of `m g/k`.
fn families() -> Vec<(String, String, f64, f64, f64)> {
    let mut families = Vec::new();
    for (number, stiffness) in [1e4, 1e5, 1e6, 1e7, 1e8].into_iter().enumerate() {
        for (normal, share) in [("Inelasticity", 0.0), ("Dashpot", 1e-6)] {
            let restitution = [0.0, 0.2, 0.5, 0.9][(number + usize::from(share > 0.0)) % 4];
            // Damping of a restitution of zero has no end.
            let restitution = if share > 0.0 { f64::max(restitution, 0.1) } else { restitution };
            families.push((normal.to_owned(), format!("normal: {normal}"), stiffness, restitution, share));
        }
    }
    families
}

#[test]
fn boxes_and_discs_hold_on_slopes_that_friction_bears_and_slide_on_others() {
    let mut held = 0;
    for (index, (name, contacts, stiffness, restitution, share)) in families().into_iter().enumerate() {
        for degrees in [0.0, 15.0, 30.0, 45.0, 60.0] {
            let (angle, sag) = (degrees / 180.0 * PI, GRAVITY / stiffness);
            let (tangent, way) = (libm::tan(angle), &ways()[(index + degrees as usize / 15) % 3]);
            let width = 0.5 + 0.1 * (index % 3) as f64;
            let boxy = on_slope(angle, 0.05, &format!("shape: Rectangle(width: {width:?}, height: 0.1)"));
            let disc = on_slope(angle, 0.1, "atoms: Disc(radius: 0.1)");
            let material = |friction: f64| {
                format!(
                    "stiffness: {stiffness:?}, restitution: {restitution:?}, friction: (static: {friction:?}, dynamic: {:?})",
                    0.9 * friction
                )
            };
            let rolling = format!("{contacts}, rolling: Spring(friction: {:?})", 1.02 * tangent + 0.01);
            let what = format!("{name}, {stiffness:e} N/m, e = {restitution}, {degrees} degrees, {}", way.0);
            for (shape, contacts, things) in [("box", &contacts, &boxy), ("disc", &rolling, &disc)] {
                let text = scene(contacts, &material(1.02 * tangent + 0.01), things, 0.3);
                let what = format!("{shape}, {what}");
                let placed = load(
                    &scene(&format!("{contacts}, start: AsPlaced"), &material(1.0), things, 0.3),
                    &Overrides::default(),
                );
                let simulation = assert_stays(&what, &text, &way.1, share * sag);
                let moved = simulation.bodies().position[0].distance(placed.bodies().position[0]);
                assert!(
                    moved > 0.1 * sag && moved < 8.0 * sag,
                    "{what}: the start moved it by {:e} m/(m g/k)",
                    moved / sag
                );
                held += 1;
            }
            if degrees > 0.0 && stiffness > 1e5 {
                let (friction, time) = (0.8 * tangent, 0.3);
                let text = scene(&contacts, &material(friction), &boxy, time);
                let mut simulation = load(&text, &way.1);
                let begin = simulation.bodies().position[0];
                simulation.run_to_end().unwrap_or_else(|failure| panic!("{what}: {failure}"));
                let way = (begin - simulation.bodies().position[0]).length();
                let exact = 0.5 * GRAVITY * (libm::sin(angle) - 0.9 * friction * libm::cos(angle)) * time * time;
                let allowed = 1e-6 * exact + 1e-14;
                assert!((way - exact).abs() <= allowed, "slides, {what}: {way} instead of {exact}, {allowed} allowed");
            }
        }
    }
    assert_eq!(held, 100);
}

/// Law: numbers of six digits make no body drop. A box on a slope leaves a gap or an overlap of up to half a unit of the last digit of
/// its place and of its sides. It stays where the engine puts it before the start.
/// Not tested: springs so hard that they give less than such a gap.
#[test]
fn boxes_that_are_placed_with_six_digits_stay_on_slopes() {
    let six = |value: f64| format!("{value:.5e}").parse::<f64>().expect("a number");
    for (index, size) in [0.0431753, 0.211117, 1.96392, 7.77771].into_iter().enumerate() {
        for stiffness in [1e3, 1e4, 1e5] {
            let angle = six(0.3 + 0.0712345 * index as f64);
            let along = DVec2::new(libm::cos(angle), libm::sin(angle));
            let (end, half) = (along * 100.0, six(0.31 * size));
            let at = along * (0.4 * size) + along.perp() * half;
            let things = format!(
                "walls: [(name: \"ramp\", left: ({:?}, {:?}), right: (0, 0), material: \"m\")], \
                 bodies: [(name: \"a\", at: ({:?}, {:?}), angle: {angle:?}, mass: 1, material: \"m\", \
                           shape: Rectangle(width: {:?}, height: {:?}))]",
                end.x,
                end.y,
                six(at.x),
                six(at.y),
                six(size),
                2.0 * half
            );
            let stiffness = stiffness * GRAVITY / size;
            let material = format!("stiffness: {stiffness:?}, friction: 0.9, restitution: 0.4");
            let text = scene("", &material, &things, 0.5);
            for (way, overrides) in ways() {
                assert_stays(&format!("{size}, {stiffness:e}, {way}"), &text, &overrides, 0.0);
            }
        }
    }
}

#[test]
fn stacks_of_boxes_and_of_discs_stand() {
    for (index, (name, contacts, stiffness, restitution, share)) in families().into_iter().enumerate() {
        let count = 2 + index % 9;
        let material = format!("stiffness: {stiffness:?}, restitution: {restitution:?}, friction: 0.5");
        for (shape, half) in [("shape: Rectangle(width: 0.3, height: 0.2)", 0.1), ("atoms: Disc(radius: 0.1)", 0.1)] {
            let mut bodies = String::new();
            for level in 0..count {
                let height = half * (2 * level + 1) as f64;
                write!(bodies, "(name: \"b{level}\", at: (0, {height:?}), mass: 1, material: \"m\", {shape}), ")
                    .unwrap();
            }
            let things =
                format!("walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")], bodies: [{bodies}]");
            // The lowest contact bears all, and the top goes down by the sum of all overlaps.
            let sag = GRAVITY / stiffness * (count * count) as f64;
            let (way, overrides) = &ways()[index % 3];
            let what = format!("{count} times {shape}, {name}, {stiffness:e} N/m, e = {restitution}, {way}");
            assert_stays(&what, &scene(&contacts, &material, &things, 0.2), overrides, share * sag);
        }
    }
}

/// Bodies that nothing presses together, that move, or whose springs begin with energy: they begin as the scene places them.
#[test]
fn bodies_whose_springs_bear_nothing_or_something_else_begin_as_placed() {
    let material = "stiffness: 1e6, restitution: 0.3, friction: 0.6";
    let wall = "walls: [(name: \"w\", left: (0, 0), right: (0, 9), material: \"m\")]";
    let floor = "walls: [(name: \"f\", left: (1, 0), right: (0, 0), material: \"m\")]";
    let disc = |name: &str, x: f64, y: f64, more: &str| {
        format!("(name: \"{name}\", at: ({x:?}, {y:?}), material: \"m\", atoms: Disc(radius: 0.1, mass: 1){more})")
    };
    for (what, things) in [
        ("a disc beside a wall falls", format!("{wall}, bodies: [{}]", disc("a", 0.1, 3.0, ""))),
        ("a disc that moves", format!("{floor}, bodies: [{}]", disc("a", 0.0, 0.1, ", velocity: (0.1, 0)"))),
        ("a disc pressed in", format!("{floor}, bodies: [{}]", disc("a", 0.0, 0.099, ""))),
        ("a disc above the floor", format!("{floor}, bodies: [{}]", disc("a", 0.0, 0.100_01, ""))),
    ] {
        let [placed, found] = ["start: AsPlaced", ""].map(|start| {
            let mut simulation = load(&scene(start, material, &things, 0.05), &Overrides::default());
            let begin = starts(&simulation);
            simulation.run_to_end().unwrap_or_else(|failure| panic!("{what}: {failure}"));
            (begin, starts(&simulation))
        });
        assert_eq!(placed, found, "{what}");
    }
}

/// The card says which body moved farthest, and by how much. In equilibrium a disc on a floor lies `m g/k` deep.
#[test]
fn the_card_says_by_how_much_the_start_moved_bodies() {
    let things = "walls: [(name: \"f\", left: (1, 0), right: (0, 0), material: \"m\")], \
                  bodies: [(name: \"a\", at: (0, 0.1), material: \"m\", atoms: Disc(radius: 0.1, mass: 1))]";
    let mut simulation = load(&scene("", "stiffness: 1e6, restitution: 0.3", things, 0.1), &Overrides::default());
    let sag = 0.1 - simulation.bodies().position[0].y;
    // Rounding of a place of 0.1 m.
    assert!((sag - GRAVITY / 1e6).abs() < 1e-16, "{sag}");
    simulation.run_to_end().unwrap();
    let notes = simulation.card().notes;
    let told = notes.iter().filter(|note| note.starts_with("start: ") && note.contains("`a` by")).count();
    assert_eq!(told, 1, "{notes:?}");
}

/// Law: a sharp corner has no rolling radius, so rolling resistance gives a box no torque. It rests or slides as it does without.
/// Tolerances: those of the rest and the slide above.
#[test]
fn rolling_resistance_changes_nothing_for_boxes() {
    for contacts in ["rolling: Spring(friction: 0.1)", "normal: Dashpot, rolling: Spring(friction: 0.1)"] {
        for restitution in [0.1, 0.5, 0.9] {
            for friction in [0.3, 0.9] {
                let material = format!("stiffness: 1e6, restitution: {restitution:?}, friction: {friction:?}");
                let things = on_slope(0.5, 0.1, "shape: Rectangle(width: 0.5, height: 0.2)");
                let text = scene(contacts, &material, &things, 0.3);
                for (way, overrides) in ways() {
                    let mut simulation = load(&text, &overrides);
                    let begin = simulation.bodies().position[0];
                    simulation.run_to_end().unwrap_or_else(|failure| panic!("{way}: {failure}\n{text}"));
                    let slides = GRAVITY * (libm::sin(0.5) - friction * libm::cos(0.5));
                    let exact = 0.5 * slides.max(0.0) * 0.3 * 0.3;
                    let found = begin.distance(simulation.bodies().position[0]);
                    let allowed = 1e-6 * exact + 1e-6 * GRAVITY / 1e6;
                    assert!((found - exact).abs() <= allowed, "{way}: {found} instead of {exact}\n{text}");
                }
            }
        }
    }
}

/// A disc lies in a groove of two walls at right angles. Its friction slips on both while it settles, and nothing but friction holds its
/// turn. The walls begin far away, so that rounding of its places is a torque that no spring holds.
#[test]
fn a_disc_rests_in_a_groove_whatever_its_friction() {
    let half = PI / 4.0;
    for (number, friction) in [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9].into_iter().enumerate() {
        for (degrees, radius) in [(0.0, 0.1), (0.0, 0.37), (7.0, 0.1)] {
            let turn = degrees / 180.0 * PI;
            let bottom = DVec2::new(0.0, -radius * 2.0_f64.sqrt());
            let end = |angle: f64| bottom + 3.0 * DVec2::new(libm::cos(angle), libm::sin(angle));
            let (left, right) = (end(PI - half + turn), end(half + turn));
            // The turned groove is no longer symmetric under the disc, whose centre keeps its distance from both.
            let at = bottom + DVec2::new(-libm::sin(turn), libm::cos(turn)) * radius * 2.0_f64.sqrt();
            let walls = format!(
                "walls: [(name: \"l\", left: ({:?}, {:?}), right: ({:?}, {:?}), material: \"m\"), \
                 (name: \"r\", left: ({:?}, {:?}), right: ({:?}, {:?}), material: \"m\")]",
                bottom.x, bottom.y, left.x, left.y, right.x, right.y, bottom.x, bottom.y
            );
            let things = format!(
                "{walls}, bodies: [(name: \"d\", at: ({:?}, {:?}), mass: 1, material: \"m\", shape: Disc(radius: {radius:?}))]",
                at.x, at.y
            );
            let material = format!("stiffness: 1e6, restitution: 0.1, friction: {friction:?}");
            let (way, overrides) = &ways()[number % 3];
            let what = format!("groove, friction {friction}, {degrees} degrees, {way}");
            let text = scene("", &material, &things, 0.1);
            let simulation = assert_stays(&what, &text, overrides, 0.0);
            let bound = simulation.notes().iter().any(|note| note.contains("reached its bound"));
            assert!(!bound, "{what}: {:?}\n{text}", simulation.notes());
        }
    }
}
