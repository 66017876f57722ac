//! Law: with ever stiffer contacts a scene becomes that of rigid bodies. Overlaps of lasting contacts are forces over
//! `k`, and so is the error. A blow lasts `pi sqrt(m/k)`, and its error falls as `1/sqrt(k)`. Source: truth files C09
//! to C12 and H06, which do not depend on stiffness.
//!
//! Tolerances: the power of `k` over three decades is right to 0.02. The next term of the error is a hundredth of the error or less, from
//! the first decade on. Two stiffnesses that are ten times apart tell the rigid limit, to 1e-9 m where contacts last. A blow turns the
//! box by a thousandth while it lasts: such a share of the last error is left, and ten times that is allowed. Steps err by less
//! than 1e-11.
//!
//! Not tested: the errors of methods at a given stiffness (see `problems` and `convergence`).

use jostle::Simulation;
use jostle::problems::{ProblemSetting, Truth, corner_impact, falling_ladder, leaving_cylinder, rocking_block};
use jostle::scene::Source;

use super::support::fitted_order;

/// Steps in `1/sqrt(k/kg)`.
const STEPS: f64 = 0.25;

/// Runs a scene of a stiffness under `Dop853` for a time in s.
fn run(scene: impl Fn(&ProblemSetting, f64, f64) -> String, duration: f64, stiffness: f64) -> Simulation {
    let ticks = (duration * stiffness.sqrt() / STEPS).ceil();
    let setting = ProblemSetting { method: "Dop853", tick: duration / ticks, ..ProblemSetting::default() };
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

/// A quarter of a period from its start the block stands upright, with the speed of its impact.
#[test]
fn a_block_rocks_as_a_rigid_one() {
    let truth = Truth::read(rocking_block::TRUTH);
    let (quarter, spin) = (truth.number("quarter period (exact)"), truth.number("angular speed just before impact"));
    let end = |stiffness: f64| run(rocking_block::scene, quarter, stiffness);
    assert_limit("angle of the block", (1e5, 1.0), |_| 1e-9, |stiffness| end(stiffness).bodies().angle[0]);
    assert_limit("spin of the block", (1e5, 1.0), |_| 1e-8, |stiffness| end(stiffness).bodies().spin[0] - spin);
}

/// A bullet of 1 kg comes back from a wall of 4 mm later than from a rigid one, by the way at its speed in a contact of
/// `pi sqrt(m/k)`. Long ticks do not let it through where events are located. Tolerance: 1e-9 m of the closed form.
#[test]
fn a_bullet_comes_back_from_a_thin_wall() {
    let truth = Truth::read(include_str!("../../assets/truths/H06_bullet_toi.json"));
    let (end, speed) = (0.004, 900.0);
    let scene = |setting: &ProblemSetting, duration: f64, stiffness: f64| {
        format!(
            "Scene({}, materials: {{ \"steel\": (stiffness: {stiffness:?}, restitution: 1) }},
            walls: [(name: \"wall\", from: (2.002, -1), to: (2.002, 1), thickness: 0.004, material: \"steel\")],
            bodies: [(name: \"bullet\", at: (0, 0), velocity: (900, 0), mass: 1, material: \"steel\", shape: Disc(radius: 0.01))])",
            setting.clock(duration)
        )
    };
    assert_limit(
        "bullet",
        (1e11, 0.5),
        |_| 1e-9,
        |stiffness| {
            let off =
                run(scene, end, stiffness).bodies().position[0].x - truth.number("rebound position at t_end (e=1)");
            let late = speed * std::f64::consts::PI / stiffness.sqrt();
            assert!((off - late).abs() < 1e-9, "bullet at {stiffness} N/m: {off} m, {late} m expected");
            off
        },
    );
    for tick in [end, end / 3.0, truth.number("largest dt that cannot tunnel without CCD")] {
        let setting = ProblemSetting { method: "Dop853", tick, ..ProblemSetting::default() };
        let mut simulation = Simulation::load(&Source::new("bullet.ron", scene(&setting, end, 1e11))).expect("correct");
        simulation.run_to_end().expect("the bullet does not pass");
        assert!(simulation.bodies().velocity[0].x < 0.0, "ticks of {tick} s let the bullet through");
    }
}

/// The lines of the angle before and after the impact cross in the middle of the contact.
#[test]
fn a_spinning_capsule_strikes_a_peg_when_a_rigid_one_does() {
    let truth = Truth::read(include_str!("../../assets/truths/H06_bullet_toi.json"));
    let (end, spin) = (0.2, 40.0);
    let scene = |setting: &ProblemSetting, duration: f64, stiffness: f64| {
        format!(
            "Scene({}, contacts: Penalty(tangential: None),
            materials: {{ \"steel\": (stiffness: {stiffness:?}, restitution: 1), \"hard\": (stiffness: 1e300, restitution: 1) }},
            bodies: [(name: \"capsule\", at: (0, 0), velocity: (3, 0.5), spin: {spin:?}, mass: 1, material: \"steel\",
                      shape: Capsule(from: (-0.5, 0), to: (0.5, 0), radius: 0.02)),
                     (name: \"peg\", at: (0.9, 0.4), fixed: true, material: \"hard\", shape: Disc(radius: 0.05))])",
            setting.clock(duration)
        )
    };
    assert_limit(
        "capsule",
        (1e7, 0.5),
        |last| 1e-2 * last,
        |stiffness| {
            let simulation = run(scene, end, stiffness);
            let bodies = simulation.bodies();
            let (angle, after) = (bodies.angle[0], bodies.spin[0]);
            (angle - after * end) / (spin - after) - truth.number("spinning capsule TOI")
        },
    );
}

/// A disc that rolls from the top of a cylinder needs ever more friction as its weight on the cylinder vanishes: with a coefficient of 1e5 it
/// slips for the last 1e-5 of its way only. Its error also holds the phase of a small swing. Tolerance: ten overlaps of 1e-6 m, for
/// deviations grow on the way down from the top.
#[test]
fn a_disc_rolls_off_the_cylinder_as_a_rigid_one() {
    let truth = Truth::read(leaving_cylinder::TRUTH);
    let number = |what: &str| truth.number(&format!("roll: {what}"));
    let (end, stiffness, gravity) = (1.05, 1e7, leaving_cylinder::GRAVITY);
    let [cylinder, radius] = leaving_cylinder::RADII;
    let far = cylinder + radius;
    let overlap = (gravity - 0.25 / far) / stiffness;
    let scene = |setting: &ProblemSetting, duration: f64, stiffness: f64| {
        let rough = "restitution: 1, friction: 1e5";
        format!(
            "Scene({}, gravity: (0, -{gravity:?}), contacts: Penalty(tangential: Exact),
            materials: {{ \"soft\": (stiffness: {stiffness:?}, {rough}), \"hard\": (stiffness: 1e300, {rough}) }},
            bodies: [(name: \"disc\", at: (0, {:?}), velocity: (0.5, 0), spin: {:?}, mass: 1, material: \"soft\", shape: Disc(radius: {radius:?})),
                     (name: \"cylinder\", fixed: true, at: (0, 0), material: \"hard\", shape: Disc(radius: {cylinder:?}))])",
            setting.clock(duration),
            far - overlap,
            -0.5 / (radius - overlap)
        )
    };
    let (sin, cos) = libm::sincos(number("detach angle"));
    let velocity = glam::DVec2::new(cos, -sin) * number("speed at detachment");
    let rigid = leaving_cylinder::parabola(number("detach time"), glam::DVec2::new(sin, cos) * far, velocity, end);
    let simulation = run(scene, end, stiffness);
    let off = simulation.bodies().position[0].distance(rigid);
    println!("rolling disc: off by {off:e} m");
    assert!(off < 1e-5, "rolling disc: off by {off:e} m");
}
