//! Random scenes of a few bodies: discs and clumps, walls and belts, a driven body, springs, drag and attraction, under
//! any contact laws. No reference is known; runs are compared with each other.

use std::fmt::Write;

use super::draw::Draw;

/// A scene, whose clock is still to be written.
pub struct Scene {
    head: String,
    rest: String,
}

impl Scene {
    /// The scene with the rest of its clock, such as `", method: Dop853"`.
    pub fn with(&self, clock: &str) -> String {
        format!("{}{clock}){}", self.head, self.rest)
    }
}

/// The scene of number `seed`.
pub fn scene(seed: u64) -> Scene {
    let mut draw = Draw::new(seed ^ 0x5eed_0000);
    // Hundredths of a second are whole ticks, whatever the tick.
    let duration = draw.between(15.0, 60.0).round() / 100.0;
    let gravity = if draw.happens(0.7) { "(0, -9.81)" } else { "(0, 0)" };
    let stiffness = draw.scale(5e3, 3e5);
    let dashpot = draw.happens(0.3);
    let normal = if dashpot { "Dashpot" } else { "Inelasticity" };
    let tangential = match draw.between(0.0, 1.0) {
        share if share < 0.2 => "None".to_owned(),
        share if share < 0.8 => "Spring(ratio: 0.8)".to_owned(),
        _ => format!("Spring(ratio: {:?})", draw.scale(0.3, 1.2)),
    };
    let rolling = match draw.happens(0.3) {
        true => format!("Spring(friction: {:?}, ratio: {:?})", draw.scale(0.02, 0.3), draw.scale(0.3, 1.0)),
        false => "None".to_owned(),
    };
    let dynamic = draw.scale(0.05, 0.8);
    let fixed = if draw.happens(0.5) { dynamic } else { dynamic * draw.between(1.0, 1.6) };
    let restitution = draw.between(0.2, 1.0);
    let belt = if draw.happens(0.3) { draw.between(-1.5, 1.5) } else { 0.0 };
    let mut rest = format!(
        ", gravity: {gravity}, contacts: Penalty(normal: {normal}, tangential: {tangential}, rolling: {rolling}),
        materials: {{ \"m\": (stiffness: {stiffness:?}, friction: (static: {fixed:?}, dynamic: {dynamic:?}), restitution: {restitution:?}, density: 60) }},
        walls: [(name: \"floor\", left: (2, 0), right: (0, 0), material: \"m\", surface_velocity: ({belt:?}, 0)),
                (name: \"west\", left: (0, 0), right: (0, 2), material: \"m\"), (name: \"east\", left: (2, 2), right: (2, 0), material: \"m\")],
        bodies: ["
    );
    let count = 1 + (draw.between(0.0, 3.0) as usize);
    let names = ["a", "b", "c"];
    for (index, name) in names.iter().enumerate().take(count) {
        let (x, y) = (0.35 + 0.6 * index as f64 + draw.between(-0.05, 0.05), draw.between(0.22, 0.7));
        let (vx, vy) = (draw.between(-2.0, 2.0), draw.between(-2.0, 1.0));
        let spin = draw.between(-8.0, 8.0);
        let atoms = match draw.happens(0.35) {
            false => format!("Disc(radius: {:?})", draw.between(0.08, 0.2)),
            true => {
                let (far, radius) = (draw.between(0.05, 0.15), draw.between(0.05, 0.1));
                format!(
                    "List([(at: (0, 0), radius: {radius:?}), (at: ({far:?}, 0), radius: {radius:?}), (at: (0, {far:?}), radius: 0.06)])"
                )
            }
        };
        let _ = write!(
            rest,
            "(name: \"{name}\", at: ({x:?}, {y:?}), velocity: ({vx:?}, {vy:?}), spin: {spin:?}, material: \"m\", atoms: {atoms}),"
        );
    }
    if draw.happens(0.2) {
        let (vx, spin) = (draw.between(-0.4, 0.4), draw.between(-3.0, 3.0));
        let _ = write!(
            rest,
            "(name: \"paddle\", at: (1, 1.3), kinematic: (velocity: ({vx:?}, -1), spin: {spin:?}), material: \"m\", atoms: Disc(radius: 0.15)),"
        );
    }
    rest.push_str("], forces: [");
    if draw.happens(0.3) {
        let _ = write!(rest, "Drag(linear: {:?}, quadratic: {:?}),", draw.scale(0.01, 0.5), draw.scale(0.01, 0.3));
    }
    if draw.happens(0.3) && count > 1 {
        let _ = write!(
            rest,
            "Spring(a: \"a\", b: \"b\", stiffness: {:?}, damping: {:?}),",
            draw.scale(3.0, 300.0),
            draw.scale(0.01, 2.0)
        );
    }
    if draw.happens(0.15) {
        let _ = write!(rest, "Attraction(constant: {:?}, softening: 0.1),", draw.scale(0.001, 0.1));
    }
    rest.push_str("])");
    Scene { head: format!("Scene(format: 1, clock: (duration: {duration:?}"), rest }
}
