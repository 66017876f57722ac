//! Law: the friction of a block on two corners ends at the static coefficient times the sum of both normal forces, also if the
//! spring of a corner is at its own cone before. Source: Coulomb's law for the whole block.
//!
//! The block is a wedge on a slope under a sine, so both corners bear other forces. The truth is a closed form: bisection finds
//! the beginning, and the way is a parabola plus a sine.
//!
//! Tolerance: the springs of both corners swing while the load grows. Each leads or lags the load by up to a radian of that swing,
//! `1/sqrt(k_t/m)` in time, and friction drops so much earlier or later. Springs give by `mu_s N/k_t`.

use std::f64::consts::TAU;

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;

const GRAVITY: f64 = 9.81;
const SLOPE: f64 = 0.3;
const MASS: f64 = 2.0;
const STIFFNESS: f64 = 1e6;
/// Of the tangential springs, by default.
const RATIO: f64 = 0.8;
const FORCE: (f64, f64) = (18.0, 4.0);
const FREQUENCY: f64 = 0.9;
const PHASE: f64 = 0.2;
/// In seconds: the block still slides up.
const END: f64 = 0.35;

fn scene(restitution: f64, (fixed, slips): (f64, f64)) -> String {
    let (sin, cos) = (libm::sin(SLOPE), libm::cos(SLOPE));
    format!(
        "Scene(format: 1, clock: (duration: {END:?}), gravity: (0, -{GRAVITY:?}), \
         materials: {{\"m\": (stiffness: {STIFFNESS:?}, restitution: {restitution:?}, friction: (static: {fixed:?}, dynamic: {slips:?}))}}, \
         walls: [(name: \"slope\", left: ({cos:?}, {sin:?}), right: (0, 0), material: \"m\")], \
         bodies: [(name: \"b\", at: ({:?}, {:?}), angle: {SLOPE:?}, mass: {MASS:?}, inertia: 0.0378, material: \"m\", \
         shape: Polygon(points: [(-0.3333, -0.1), (0.1667, -0.1), (0.1667, 0.2)], rounding: 0.002))], \
         forces: [Drive(of: \"b\", force: {FORCE:?}, course: Sine(amplitude: 1, frequency: {FREQUENCY:?}, phase: {PHASE:?}))])",
        -0.1 * sin,
        0.1 * cos,
    )
}

/// The force along the slope and the normal force.
fn loads(time: f64) -> (f64, f64) {
    let (sin, cos) = (libm::sin(SLOPE), libm::cos(SLOPE));
    let (weight, swing) = (MASS * GRAVITY, libm::sin(TAU * FREQUENCY * time + PHASE));
    let (along, off) = (FORCE.0 * cos + FORCE.1 * sin, FORCE.1 * cos - FORCE.0 * sin);
    (along * swing - weight * sin, weight * cos - off * swing)
}

/// The beginning of the slip in seconds, and the way along the slope at the end in metres.
fn truth((fixed, slips): (f64, f64)) -> (f64, f64) {
    let lacks = |time: f64| loads(time).0 - fixed * loads(time).1;
    let (mut low, mut high) = (0.0, 0.25);
    assert!(lacks(low) < 0.0 && lacks(high) > 0.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if lacks(middle) < 0.0 { low = middle } else { high = middle }
    }
    // The push is `steady + swing sin(..)`.
    let push = |time: f64| loads(time).0 - slips * loads(time).1;
    let (omega, sine) = (TAU * FREQUENCY, |time: f64| libm::sin(TAU * FREQUENCY * time + PHASE));
    let swing = (push(high) - push(0.0)) / (sine(high) - sine(0.0));
    let steady = push(high) - swing * sine(high);
    let (time, cosine) = (END - high, libm::cos(omega * high + PHASE));
    let of_sine = cosine * time / omega - (sine(END) - sine(high)) / (omega * omega);
    (high, (0.5 * steady * time * time + swing * of_sine) / MASS)
}

#[test]
fn a_wedge_slips_at_the_sum_of_its_cones() {
    let method = |name: &str, tick: Option<f64>| Overrides { method: Some(name.into()), tick, ..Overrides::default() };
    let tolerance = |tolerance: f64| Overrides { tolerance: Some(tolerance), ..Overrides::default() };
    let ways = [
        Overrides::default(),
        tolerance(1e-3),
        tolerance(1e-6),
        method("Reference", None),
        method("Dop853", Some(1e-3)),
        method("VelocityVerlet", Some(1e-4)),
    ];
    for coefficients in [(0.5, 0.4), (0.55, 0.3), (0.45, 0.4)] {
        let (begins, way) = truth(coefficients);
        let (stiffness, normal) = (RATIO * STIFFNESS, loads(begins).1);
        let drop = (coefficients.0 - coefficients.1) * normal / MASS;
        let early = 2.0 / (stiffness / MASS).sqrt();
        let allowed = drop * early * (END - begins) + coefficients.0 * normal / stiffness;
        for restitution in [0.0, 0.3] {
            let text = scene(restitution, coefficients);
            for overrides in &ways {
                let source = Source::new("wedge.ron", text.clone());
                let mut run =
                    Simulation::load_with(&source, overrides, |_| {}).unwrap_or_else(|error| panic!("{error}\n{text}"));
                run.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
                let at = run.bodies().position[0];
                let found = at.x / libm::cos(SLOPE) + 0.1 * libm::tan(SLOPE);
                let name = (&overrides.method, overrides.tick, overrides.tolerance);
                assert!((found - way).abs() <= allowed, "{name:?}: {found} for {way}, {allowed:e} allowed\n{text}");
            }
        }
    }
}

/// Law: an opposite contact slides with the dynamic coefficient beside one that sticks. A wheel between two plates rolls on the floor
/// and slides on the ceiling, which presses with `P`. Its arms are its radius without the overlaps, `a` on the floor and `b` on the
/// ceiling. So it goes with `(F - mu_d P (1 + b/a)) / (m + I/a^2)`. Forces that hold it nevertheless would need a ceiling that presses
/// more than its spring.
///
/// Tolerance: that of fixed ticks, whose order is two, for a motion of constant acceleration: their last digits, and ten times the
/// share of forces that the search for the start leaves.
#[test]
fn a_wheel_between_two_plates_slides_on_one_of_them() {
    let (radius, push, force, slips, time) = (0.1, 10.0, 20.0, 0.4, 0.3);
    let (sag, dent) = ((push + GRAVITY) / STIFFNESS, push / STIFFNESS);
    let scene = |pull: f64, thrust: &str| {
        format!(
            "Scene(format: 1, clock: (duration: {time:?}), gravity: ({pull:?}, -{GRAVITY:?}), \
             materials: {{\"m\": (stiffness: {STIFFNESS:?}, restitution: 0.3, friction: (static: 0.8, dynamic: {slips:?}))}}, \
             walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\"), \
                     (name: \"ceiling\", left: (0, {:?}), right: (1, {0:?}), material: \"m\")], \
             bodies: [(name: \"w\", at: (0, {:?}), material: \"m\", atoms: Disc(radius: {radius:?}, mass: 1))], \
             forces: [{thrust}])",
            2.0 * radius - sag - dent,
            radius - sag
        )
    };
    let (arm, above) = (radius - sag, radius - dent);
    let inertia = 0.5 * radius * radius / (arm * arm);
    let way = 0.5 * (force - slips * push * (1.0 + above / arm)) / (1.0 + inertia) * time * time;
    for text in [scene(0.0, &format!("Thrust(of: \"w\", force: ({force:?}, 0))")), scene(force, "")] {
        for (method, tick) in [(None, None), (Some("Dop853"), Some(1e-3)), (Some("Reference"), None)] {
            let overrides = Overrides { method: method.map(str::to_owned), tick, ..Overrides::default() };
            let mut run = Simulation::load_with(&Source::new("wheel.ron", text.clone()), &overrides, |_| {})
                .unwrap_or_else(|error| panic!("{error}\n{text}"));
            run.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
            let found = run.bodies().position[0].x;
            assert!((found - way).abs() <= 1e-6 * way, "{method:?}: {found} for {way}\n{text}");
        }
    }
}
