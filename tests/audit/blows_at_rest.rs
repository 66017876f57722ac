//! Law: springs give no impulse. As a rope becomes taut or a slide reaches its end, bodies at rest on the floor take the blow as if
//! they were free: the impulse is `J = (1 + e) v / (1/m + 1/M + l^2/I)`, for a speed of arrival `v` and its lever `l` on the second
//! body. The floor acts later, by the overlap that follows.

use super::ran::{Pose, end};
use glam::DVec2;

const G: f64 = 9.81;
/// So long after the blow bodies are seen, in s.
const AFTER: f64 = 1e-5;
/// In that time weight, friction and springs change speeds by less than this, in m/s: each by about a weight.
const CHANGE: f64 = 3.0 * G * AFTER;

/// Clocks with the number of their ticks.
const CLOCKS: [(&str, u32); 5] = [
    ("tolerance: 1e-3", 0),
    ("tolerance: 1e-6", 0),
    ("method: Reference", 0),
    ("method: Dop853", 200),
    ("method: RungeKutta4", 1000),
];

/// The bodies just after a blow at `time` seconds, under each clock.
fn after(time: f64, rest_of_scene: &str) -> Vec<(&'static str, Vec<Pose>)> {
    let duration = time + AFTER;
    let run = |(clock, ticks): (&'static str, u32)| {
        let tick = if ticks > 0 { format!(", tick: {:?}", duration / f64::from(ticks)) } else { String::new() };
        let scene = format!(
            "Scene(format: 1, clock: (duration: {duration:?}, {clock}{tick}), gravity: (0, -9.81), {rest_of_scene})"
        );
        (clock, end(&scene).unwrap_or_else(|why| panic!("{clock}: {why}")).seen.pop().unwrap().1)
    };
    CLOCKS.into_iter().map(run).collect()
}

#[test]
fn a_rope_jerks_a_crate_that_rests_as_if_it_were_free() {
    // Masses of bob and crate, width and height of the crate, friction, velocity of the bob, length of the rope.
    let cases = [
        (1.0, 5.0, 0.3, 0.5, 0.5, (2.0, 0.0), 1.0),
        (2.0, 1.0, 0.4, 0.2, 0.9, (3.0, 0.5), 1.2),
        (0.3, 8.0, 0.6, 0.3, 0.2, (4.0, 1.0), 1.3),
    ];
    for (bob, crate_mass, width, height, friction, velocity, length) in cases {
        let stiffness = 2e4 * crate_mass;
        let depth = crate_mass * G / (2.0 * stiffness);
        let (anchor, begin) = (DVec2::new(0.5 * width, 0.5 * height), DVec2::new(0.6, 1.2));
        let held = DVec2::new(0.0, 0.5 * height - depth) + anchor;
        let velocity = DVec2::from(velocity);
        let place = |t: f64| begin + velocity * t - DVec2::new(0.0, 0.5 * G * t * t);
        let (mut low, mut high) = (0.0, 1.0);
        assert!((place(low) - held).length() < length && (place(high) - held).length() > length);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if (place(middle) - held).length() < length { low = middle } else { high = middle }
        }
        let along = (place(low) - held).normalize();
        let arrival = velocity - DVec2::new(0.0, G * low);
        let inertia = crate_mass * (width * width + height * height) / 12.0;
        let lever = anchor.perp_dot(along);
        let impulse = arrival.dot(along) / (1.0 / bob + 1.0 / crate_mass + lever * lever / inertia);
        let expected = [along * (impulse / crate_mass), arrival - along * (impulse / bob)];
        let scene = format!(
            "materials: {{ \"wood\": (stiffness: {stiffness:?}, friction: {friction}, restitution: 0.1) }},
             walls: [(name: \"floor\", left: (20, 0), right: (-20, 0), material: \"wood\")],
             bodies: [(name: \"crate\", at: (0, {:?}), mass: {crate_mass:?}, material: \"wood\",
                       shape: Rectangle(width: {width:?}, height: {height:?})),
                      (name: \"bob\", at: (0.6, 1.2), velocity: ({:?}, {:?}), collides: false,
                       atoms: Disc(radius: 0.05, mass: {bob:?}))],
             joints: [Rope(name: \"line\", a: \"crate\", anchor_a: ({:?}, {:?}), b: \"bob\", length: {length:?})]",
            0.5 * height,
            velocity.x,
            velocity.y,
            anchor.x,
            anchor.y,
        );
        for (clock, bodies) in after(low, &scene) {
            for (expected, body) in expected.iter().zip(&bodies) {
                let off = (body.velocity - *expected).length();
                assert!(off < CHANGE, "{clock}: {} for {expected}", body.velocity);
            }
        }
    }
}

#[test]
fn a_weight_that_reaches_the_end_of_its_slide_pushes_the_box_around_it_that_rests() {
    for (mass, own, restitution, friction) in [(1.0, 4.0, 0.5, 0.3), (3.0, 1.5, 0.0, 0.8)] {
        let scene = format!(
            "materials: {{ \"wood\": (stiffness: 1e5, friction: {friction}, restitution: 0.1) }},
             walls: [(name: \"floor\", left: (20, 0), right: (-20, 0), material: \"wood\")],
             bodies: [(name: \"box\", at: (0, 0.15), mass: {own:?}, material: \"wood\",
                       shape: Rectangle(width: 0.8, height: 0.3)),
                      (name: \"slug\", at: (-0.2, 0.15), velocity: (3, 0), collides: false,
                       atoms: Disc(radius: 0.05, mass: {mass:?}))],
             joints: [Prismatic(name: \"rail\", a: \"box\", b: \"slug\", axis: (1, 0), limits: (-0.3, 0.3),
                                restitution: {restitution:?})]"
        );
        let pushed = (1.0 + restitution) * 3.0 * mass / (mass + own);
        let expected = [pushed, 3.0 - pushed * own / mass];
        for (clock, bodies) in after(0.3 / 3.0, &scene) {
            for (expected, body) in expected.into_iter().zip(&bodies) {
                assert!((body.velocity.x - expected).abs() < CHANGE, "{clock}: {} for {expected}", body.velocity);
            }
        }
    }
}
