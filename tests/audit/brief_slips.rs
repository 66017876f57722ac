//! Law: a rigid crate slips while a sine pushes harder than `mu_s m g`, however briefly it does. Then it slides back with `mu_d` until it
//! stops: `m v = (A/w)(cos(w s) - cos(w t)) - mu_d m g (t - s)` since the moment `s`. Nothing moves for most of a period, so steps are
//! long, and each slip lasts a small share of one. Both corners of the crate give way at one moment.

use super::ran::end;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const G: f64 = 9.81;
/// In m. All trials may take the same steps through a brief slip, so no difference of trials tells the error of these steps.
const SAME_STEPS: f64 = 1e-9;

/// The way in m of one slip under a push of `1 + beyond` times `mu_s m g` with the angular frequency `w`.
fn way(w: f64, statics: f64, dynamics: f64, beyond: f64) -> f64 {
    let push = (1.0 + beyond) * statics * G;
    let begin = FRAC_PI_2 - libm::acos(1.0 / (1.0 + beyond));
    let speed = |t: f64| {
        let phase = libm::cos(begin) - libm::cos(begin + w * t);
        push / w * phase - dynamics * G * t
    };
    // It rises first, and comes back to zero before the push has changed its sign.
    let (mut low, mut high) = ((PI - begin) / w, (PI - begin) / w);
    while speed(low) < 0.0 {
        high = low;
        low *= 0.99;
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if speed(middle) > 0.0 { low = middle } else { high = middle }
    }
    let t = 0.5 * (low + high);
    let path = libm::cos(begin) * t - (libm::sin(begin + w * t) - libm::sin(begin)) / w;
    push / w * path - 0.5 * dynamics * G * t * t
}

#[test]
fn crates_slip_as_often_as_a_push_exceeds_static_friction() {
    // Frequency, both coefficients, the share beyond static friction, half periods, size.
    let cases = [
        (0.85, 0.22, 0.209, 2e-5, 3, 0.12),
        (1.27, 0.3, 0.297, 1e-5, 5, 0.2),
        (1.24, 0.56, 0.5544, 1e-4, 3, 0.1),
        (0.7, 0.5, 0.45, 1e-3, 3, 1.0),
    ];
    for (frequency, statics, dynamics, beyond, halves, size) in cases {
        let (w, mass) = (TAU * frequency, 800.0 * size * size);
        let law = way(w, statics, dynamics, beyond);
        assert!(law > 0.0, "the law has a slip");
        let push = (1.0 + beyond) * statics * mass * G;
        for clock in [", tolerance: 1e-3", ", tolerance: 1e-5", ", tolerance: 1e-7", ", method: Reference"] {
            let scene = format!(
                "Scene(format: 1, clock: (duration: {:?}{clock}), film: (fps: 30), gravity: (0, -9.81),
                    materials: {{ \"wood\": (stiffness: {:?}, friction: (static: {statics}, dynamic: {dynamics}), restitution: 0.3) }},
                    walls: [(name: \"floor\", left: (20, 0), right: (-20, 0), material: \"wood\")],
                    bodies: [(name: \"crate\", at: (0, {:?}), mass: {mass:?}, material: \"wood\",
                              shape: Rectangle(width: {:?}, height: {size:?})),
                             (name: \"bird\", at: (0, 50), velocity: (1, 12), shape: Disc(radius: 0.1), material: \"wood\")],
                    forces: [Drive(of: \"crate\", force: ({push:?}, 0), course: Sine(frequency: {frequency}))])",
                0.5 * f64::from(halves) / frequency,
                1e5 * mass,
                0.5 * size,
                4.0 * size,
            );
            let ran = end(&scene).expect("a run to its end");
            let (stated, _) = ran.stated().expect("an error is stated");
            let crate_at = ran.seen[0].1[0].place.x;
            // Slips of successive half periods go there and back.
            let off = (crate_at - law).abs();
            assert!(
                off <= 3.0 * stated + SAME_STEPS,
                "{frequency} Hz{clock}: {crate_at:e} for {law:e}, {stated:e} stated"
            );
            assert!(off < 0.1 * law, "{frequency} Hz{clock}: a slip of {law:e} is missed");
        }
    }
}
