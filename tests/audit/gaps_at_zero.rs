//! Law: a gap that is zero at the beginning of a step may close and open again inside it, and runs see that. Bodies that just touch begin
//! so, and so does each step behind the moment at which a contact ends. Rounding puts such a gap above or below zero.

use super::ran::demand_agreement;

const CLOCKS: [&str; 6] = [
    ", tolerance: 1e-2",
    ", tolerance: 1e-3",
    ", tolerance: 1e-4",
    ", tolerance: 1e-6",
    ", method: Reference",
    ", method: Dop853, tick: 2e-4",
];

/// A disc that flies into the floor from its first moment on. A thrust lifts it again within the first step of a loose tolerance.
#[test]
fn a_disc_that_begins_at_the_floor_bounces() {
    for (radius, speed, thrust, stiffness) in [(0.05, 0.48, 40.0, 4e5), (0.5, 2.0, 60.0, 3e8), (0.003, 0.1, 35.0, 9e3)]
    {
        let mass = 800.0 * radius * radius;
        let scene = |clock: &str| {
            format!(
                "Scene(format: 1, clock: (duration: 0.2{clock}), film: (fps: 25), gravity: (0, -9.81),
                    materials: {{ \"m\": (stiffness: {stiffness:?}, friction: 0.3, restitution: 0.6) }},
                    walls: [(name: \"floor\", left: (9, 0), right: (-9, 0), material: \"m\")],
                    bodies: [(name: \"b\", at: (0, {radius:?}), velocity: (0.2, -{speed:?}), spin: 3, material: \"m\",
                              atoms: Disc(radius: {radius:?}, mass: {mass:?}))],
                    forces: [Thrust(of: \"b\", force: (0, {force:?}), to: 0.15)])",
                force = thrust * mass
            )
        };
        demand_agreement(&format!("radius {radius}"), &CLOCKS, 4, scene);
    }
}

/// A rod rocks on two tips, and each tip leaves the floor and comes back.
#[test]
fn a_tip_that_left_comes_back_within_a_step() {
    for torque in [0.6621, 0.66, 0.655, 0.67] {
        let scene = |clock: &str| {
            format!(
                "Scene(format: 1, clock: (duration: 0.32{clock}), film: (fps: 100),
                    contacts: Penalty(normal: Dashpot),
                    materials: {{ \"m\": (stiffness: 196000),
                                  \"n\": (restitution: 0.6674, density: 52.91, friction: 0.1117, stiffness: 55100) }},
                    walls: [(name: \"floor\", material: \"m\", heights: [(-0.774, 0), (1.1155, 0.10435)])],
                    bodies: [(name: \"b\", at: (0.2065382425437649, 0.2636737189883551), material: \"n\", mass: 4.258,
                              shape: Capsule(from: (0, 0.1723), to: (-0.1116, -0.2215), radius: 0.01568)),
                             (name: \"c\", material: \"n\", shape: Disc(radius: 0.6985),
                              at: (0.4420410025114709, 1.1517755639366951))],
                    forces: [Torque(of: \"b\", value: {torque:?})])"
            )
        };
        demand_agreement(&format!("torque {torque}"), &CLOCKS, 4, scene);
    }
}
