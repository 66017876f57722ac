//! Law: a box on an incline slides from `tan a = mu` on and topples from `tan a = w/h` on. Source: textbook (Coulomb 1785); truth file F07.
//!
//! The box starts in balance and does not swing. Tolerance: slopes are off each threshold by a share of 1e-4, to either side. Overlaps
//! of 4e-7 m shift the edge on which the box topples by less than 3e-6 of the width.
//!
//! Not tested: an incline that is raised during the run, pushes, elastic boxes at rest.

use jostle::problems::tilted_box::{GRAVITY, Incline, TRUTH, scene};
use jostle::problems::{ProblemSetting, Truth};

use super::support::{assert_near, load, run_to};

const SHARE: f64 = 1e-4;

/// The way of the box in a second in m, and its turning in rad.
fn after(slope: f64, friction: f64) -> (f64, f64) {
    let setting = ProblemSetting { method: "Dop853", tick: 2e-4, ..ProblemSetting::default() };
    let incline = Incline { slope, friction, stiffness: 1e8, restitution: 0.2 };
    let mut simulation = load(&scene(&setting, 1.0, &incline));
    let angle = simulation.bodies().angle[0];
    run_to(&mut simulation, 1.0);
    let bodies = simulation.bodies();
    (bodies.position[0].x, bodies.angle[0] - angle)
}

/// Below the threshold the box does not move by a bit.
#[test]
fn a_box_slides_where_the_incline_is_steeper_than_friction() {
    let truth = Truth::read(TRUTH);
    let friction = truth.number("push force to slide") / (4.0 * GRAVITY);
    let steepest = libm::tan(truth.number("slide angle"));
    assert_near("slope", steepest, friction, 4.0 * f64::EPSILON);
    let below = after(steepest * (1.0 - SHARE), friction);
    assert_eq!(below, (0.0, 0.0), "below");
    let slope = steepest * (1.0 + SHARE);
    let (way, turned) = after(slope, friction);
    let (sin, cos) = libm::sincos(libm::atan(slope));
    assert_near("way", way, 0.5 * GRAVITY * (sin - friction * cos), 1e-12);
    assert_near("angle", turned, 0.0, 1e-12);
}

/// On its edge the box has the torque `m g R sin d`; its weight leans past the edge by `d`. At the start `d` is the angle by which the
/// incline is too steep. The lean grows as `d cosh(p t)`, `p^2 = 3 g/(4 R)`, `R` half the diagonal. Tolerance: the edge is off by
/// 3e-6 of the width, 0.03 of the share.
#[test]
fn a_box_topples_where_its_weight_passes_the_edge() {
    let angle = Truth::read(TRUTH).number("topple angle");
    let steepest = libm::tan(angle);
    let below = after(steepest * (1.0 - SHARE), 0.9);
    let above = after(steepest * (1.0 + SHARE), 0.9);
    assert_eq!(below, (0.0, 0.0), "below");
    let half = 0.15_f64.hypot(0.25);
    let lean = SHARE * libm::sin(angle) * libm::cos(angle);
    let grown = lean * (libm::cosh((0.75 * GRAVITY / half).sqrt()) - 1.0);
    assert_near("turned", above.1, -grown, 0.03 * grown);
}
