//! Law: with ever stiffer contacts a scene becomes that of rigid bodies. Overlaps of lasting contacts are forces over `k`, and so
//! is the error. A blow lasts `pi sqrt(m/k)`, and its error falls as `1/sqrt(k)`. Source: truth files C09, C11 and C12, which know
//! nothing of stiffness.
//!
//! Tolerances: the power of `k` over three decades is right to 0.02. The next term of the error is a hundredth of the error or less, from
//! the first decade on. Two stiffnesses that are ten times apart tell the rigid limit, to 1e-9 m where contacts last. A blow turns the
//! box by a thousandth while it lasts: such a share of the last error is left, and ten times that is allowed. Steps err by less
//! than 1e-11.
//!
//! Not tested: the errors of methods at a given stiffness (see `problems` and `convergence`).

use jostle::Simulation;
use jostle::problems::{Setting, Truth, corner_impact, falling_ladder, leaving_cylinder};
use jostle::scene::Source;

use super::support::fitted_order;

/// Steps in `1/sqrt(k/kg)`.
const STEPS: f64 = 0.25;

/// Runs a scene of a stiffness under `Dop853` for a time in s.
fn run(scene: fn(&Setting, f64, f64) -> String, duration: f64, stiffness: f64) -> Simulation {
    let ticks = (duration * stiffness.sqrt() / STEPS).ceil();
    let setting = Setting { method: "Dop853", tick: duration / ticks, ..Setting::default() };
    let text = scene(&setting, duration, stiffness);
    let mut simulation = Simulation::load(&Source::new("rigid.ron", text)).expect("the scene is correct");
    simulation.run_to_tick(ticks as u64).expect("numbers stay finite");
    simulation
}

/// Asserts that differences from a rigid truth fall with a power of the stiffness over three decades, and that the last two of
/// them tell the truth, to a tolerance given for the last.
#[track_caller]
fn assert_limit(what: &str, (first, power): (f64, f64), tolerance: fn(f64) -> f64, off: impl Fn(f64) -> f64) {
    let points: Vec<(f64, f64)> = (0..4).map(|decade| first * 10.0_f64.powi(decade)).map(|k| (k, off(k))).collect();
    let sizes: Vec<(f64, f64)> = points.iter().map(|(stiffness, off)| (*stiffness, off.abs())).collect();
    let found = fitted_order(&sizes);
    let factor = 10.0_f64.powf(power);
    let limit = (factor * points[3].1 - points[2].1) / (factor - 1.0);
    println!("{what}: power {found:.4}, {points:?}, in the limit {limit:e}");
    assert!((found + power).abs() < 0.02, "{what}: the power of the stiffness is {found}; {points:?}");
    assert!(limit.abs() < tolerance(sizes[3].1), "{what}: in the limit {limit:e} is left; {points:?}");
}

/// The place at a later time holds the time, the angle and the velocity of the ladder's leaving.
#[test]
fn a_ladder_leaves_the_wall_as_a_rigid_one() {
    let truth = Truth::read(falling_ladder::TRUTH);
    let (left, angle) = (truth.number("detach time"), truth.number("detach angle"));
    let speed = truth.number("horizontal speed after detachment");
    let rigid = |time: f64| falling_ladder::RADIUS + falling_ladder::HALF * libm::cos(angle) + speed * (time - left);
    for time in [0.75, 0.9] {
        assert_limit(
            &format!("ladder at {time} s"),
            (1e5, 1.0),
            |_| 1e-9,
            |stiffness| run(falling_ladder::scene, time, stiffness).bodies().position[0].x - rigid(time),
        );
    }
}

#[test]
fn a_slider_leaves_the_cylinder_as_a_rigid_one() {
    let truth = Truth::read(leaving_cylinder::TRUTH);
    let number = |what: &str| truth.number(&format!("slide: {what}"));
    let (sin, cos) = libm::sincos(number("detach angle"));
    let far = leaving_cylinder::RADII[0] + leaving_cylinder::RADII[1];
    let (from, along) = (glam::DVec2::new(sin, cos) * far, glam::DVec2::new(cos, -sin));
    let velocity = along * number("speed at detachment");
    for time in [0.85, 0.95] {
        let rigid = leaving_cylinder::parabola(number("detach time"), from, velocity, time);
        let off = |stiffness: f64| run(leaving_cylinder::scene, time, stiffness).bodies().position[0] - rigid;
        assert_limit(&format!("slider at {time} s, along"), (1e5, 1.0), |_| 1e-9, |stiffness| off(stiffness).x);
        assert_limit(&format!("slider at {time} s, up"), (1e5, 1.0), |_| 1e-9, |stiffness| off(stiffness).y);
    }
}

#[test]
fn a_corner_strikes_as_a_rigid_one() {
    let truth = Truth::read(corner_impact::TRUTH);
    let after = truth.numbers("v_y, omega after");
    // The time until the end goes with the length of the contact.
    let end = |stiffness: f64| {
        let duration = corner_impact::PROBLEM.duration() * (corner_impact::STIFFNESS / stiffness).sqrt();
        run(corner_impact::scene, duration, stiffness)
    };
    assert_limit(
        "velocity of the box",
        (1e7, 0.5),
        |last| 1e-2 * last,
        |stiffness| (end(stiffness).bodies().velocity[0].y - after[0]) / corner_impact::SPEED,
    );
    assert_limit(
        "spin of the box",
        (1e7, 0.5),
        |last| 1e-2 * last,
        |stiffness| (end(stiffness).bodies().spin[0] - after[1]) / after[1],
    );
}
