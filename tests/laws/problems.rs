//! Law: each problem of `jostle::problems`, its own. Source: each problem's file; the closed forms are compared here
//! with the truth files, which were made independently of them.
//!
//! Tolerances: at its tick the error of each method on each problem (the root mean square over 16 phases, where events fall on other
//! places of ticks) is within a factor of 1.5 of its leading term, as the problem tabulates it: the next term is smaller by a power of the
//! tick, and phases scatter. Constants are measured at finer ticks, and only regress; so where a bound of the leading term is derived (the methods
//! that go from tick to tick), every phase stays below it, too. What has no constant is at rounding. Closed forms agree with
//! truth files to a few units in the last place.
//!
//! Not tested: that errors fall with the right power; see `convergence`.

use jostle::integrate::Description;
use jostle::problems::{self, EventTiming, Expected, Problem, Truth};

use super::support::{assert_near, errors_at, fitted_order, rms_error};
use crate::part;

/// The greatest factor between an error and what the table says.
const FACTOR: f64 = 1.5;
/// Order 1 through events: at the problem's tick terms of order 2 are as large still, and the factor is 2.
const EARLY: [(&str, &str); 3] =
    [("coulomb_oscillator", "ExplicitEuler"), ("cradle", "SemiImplicitEuler"), ("elastic_bounce", "SemiImplicitEuler")];
/// Errors below so many times the worst case of rounding have no constant.
const ROUNDING: f64 = 10.0;

/// Root mean square over the phases of the error over the tick to the power of the order.
fn coefficient(problem: &Problem, method: &Description, events: EventTiming, tick: f64, order: u32) -> f64 {
    let errors = errors_at(problem, method, events, tick);
    let squares = errors.iter().map(|(tick, error)| (error / tick.powi(order as i32)).powi(2));
    (squares.sum::<f64>() / errors.len() as f64).sqrt()
}

/// What stands in a problem's table for a method, measured at finer ticks: the line as it is to be written, if errors there
/// are above rounding.
fn line_of_table(problem: &Problem, method: &Description, events: EventTiming, least: u32) -> Option<String> {
    let halvings: &[i32] = if problem.class.depends_on_phase() { &[1, 2, 3] } else { &[1, 2] };
    let ticks = halvings.iter().map(|halving| problem.tick / f64::from(1 << halving));
    let points: Vec<(f64, f64)> = std::iter::once(problem.tick)
        .chain(ticks)
        .map(|tick| (tick, rms_error(problem, method, events, tick)))
        .filter(|&(tick, error)| error > ROUNDING * (problem.rounding)(tick))
        .collect();
    let order = if points.len() > 1 { (fitted_order(&points).round() as u32).max(least) } else { least };
    let finer = if points.len() > 1 { &points[1..] } else { &points[..] };
    let logarithms = finer.iter().map(|&(tick, _)| coefficient(problem, method, events, tick, order).ln());
    let constant = (logarithms.sum::<f64>() / finer.len() as f64).exp();
    let timing = if events == EventTiming::Located { "located" } else { "per_tick" };
    (!points.is_empty()).then(|| format!("    Constant::{timing}(\"{}\", {order}, {constant:.3e}),", method.name))
}

/// Compares the error of a method at the problem's tick with its table; a line for the report, and whether it is good.
fn compare(problem: &Problem, method: &Description, events: EventTiming) -> (bool, String) {
    let (tick, rounding) = (problem.tick, (problem.rounding)(problem.tick));
    let errors = errors_at(problem, method, events, tick);
    let called = format!("{} {} {events:?}", problem.name, method.name);
    if method.stability_limit == 0.0 && errors.iter().any(|(_, error)| *error == f64::INFINITY) {
        return (true, format!("{called}: explodes, as no tick is stable"));
    }
    if method.whole_ticks.is_some()
        && events == EventTiming::PerTick
        && let Some(bound) = problem.bound(method.order, tick)
    {
        let worst = errors.iter().map(|(_, error)| *error).fold(0.0, f64::max);
        if worst.is_nan() || worst > bound {
            return (false, format!("{called}: {worst:.2e} is above the derived bound {bound:.2e}"));
        }
    }
    let least = problem.class.expected_located(method.order, events == EventTiming::Located);
    let tabulated = problem.constant(method.name, events);
    match (least, tabulated) {
        (Expected::Exact, Some(_)) => (false, format!("{called}: exact, and a constant is tabulated")),
        (Expected::Order(least), Some(constant)) if constant.order < least => {
            (false, format!("{called}: order {} is tabulated, {least} is expected", constant.order))
        }
        (_, Some(constant)) => {
            let found = coefficient(problem, method, events, tick, constant.order);
            let allowed = rounding / tick.powi(constant.order as i32);
            let ratio = found / constant.constant;
            let factor = if EARLY.contains(&(problem.name, method.name)) { 2.0 } else { FACTOR };
            let good = found <= factor * constant.constant + allowed && found + allowed >= constant.constant / factor;
            let order = constant.order;
            (
                good,
                format!("{called}: order {order}, {found:.3e} is {ratio:.2} of the table's {:.3e}", constant.constant),
            )
        }
        (least, None) => {
            let worst = errors
                .iter()
                .map(|(_, error)| *error)
                .fold(0.0, |most, error| if error <= most { most } else { error });
            if worst <= ROUNDING * rounding {
                return (true, format!("{called}: {worst:.1e}, rounding may be {rounding:.1e}"));
            }
            let Expected::Order(least) = least else { return (false, format!("{called}: not exact, {worst:e}")) };
            let line = line_of_table(problem, method, events, least).unwrap_or_default();
            (false, format!("{called}: no constant; at finer ticks:\n{line}"))
        }
    }
}

/// Every `of`-th method on all problems, so that threads share the work evenly.
fn errors_are_those_of_the_table(share: usize, of: usize) {
    let methods = problems::methods();
    let pairs = problems::ALL.iter().flat_map(|problem| methods.iter().map(move |method| (problem, method)));
    let combinations = pairs
        .flat_map(|(problem, method)| problem.timings(method).into_iter().map(move |events| (problem, method, events)));
    let mut report = Vec::new();
    let mut failed = false;
    for (problem, method, events) in part::of(combinations.skip(share).step_by(of)) {
        let (good, line) = compare(problem, method, events);
        failed |= !good;
        report.push(format!("{} {line}", if good { "   " } else { "BAD" }));
    }
    println!("{}", report.join("\n"));
    assert!(!failed, "\n{}", report.join("\n"));
}

#[test]
fn errors_are_those_of_the_table_first_share() {
    errors_are_those_of_the_table(0, 4);
}

#[test]
fn errors_are_those_of_the_table_second_share() {
    errors_are_those_of_the_table(1, 4);
}

#[test]
fn errors_are_those_of_the_table_third_share() {
    errors_are_those_of_the_table(2, 4);
}

#[test]
fn errors_are_those_of_the_table_fourth_share() {
    errors_are_those_of_the_table(3, 4);
}

/// Rows of a truth file with the times at which they are given.
fn rows(truth: &Truth, observable: &str) -> Vec<(f64, Vec<f64>)> {
    let (times, numbers) = (truth.times(observable), truth.numbers(observable));
    let width = numbers.len() / times.len();
    times.into_iter().zip(numbers.chunks(width).map(<[f64]>::to_vec)).collect()
}

/// Closed forms lose a few digits of their largest term: 16 units in the last place of it.
const ULPS: f64 = 16.0 * f64::EPSILON;

#[test]
fn closed_forms_agree_with_the_truth_files() {
    let truth = Truth::read(include_str!("../../assets/truths/P01_free_flight.json"));
    for (time, row) in rows(&truth, "state[x,y,vx,vy,theta]") {
        let (position, velocity) = problems::free_flight::state(time);
        let found = [position.x, position.y, velocity.x, velocity.y, problems::free_flight::angle(time)];
        for (found, exact) in found.into_iter().zip(row) {
            assert_near("free flight", found, exact, ULPS * 50.0);
        }
    }
    let truth = Truth::read(include_str!("../../assets/truths/P03_linear_drag.json"));
    for (time, row) in rows(&truth, "state[x,y,vx,vy]") {
        let (position, velocity) = problems::linear_drag::state(time);
        for (found, exact) in [position.x, position.y, velocity.x, velocity.y].into_iter().zip(row) {
            assert_near("linear drag", found, exact, ULPS * 400.0);
        }
    }
    let truth = Truth::read(problems::spring_mass::TRUTH);
    for (time, row) in rows(&truth, "x,v") {
        let (x, v) = problems::spring_mass::state(time);
        // The phase, up to 200 rad, is known to an ulp.
        assert_near("mass on a spring", x, row[0], ULPS * 2.0);
        assert_near("its velocity", v, row[1], ULPS * 20.0);
    }
    let truth = Truth::read(problems::rotating_ring::TRUTH);
    assert_near("radius of the ring", problems::rotating_ring::radius(), truth.number("radius"), ULPS);
    let breathing = truth.number("breathing mode angular frequency");
    assert_near("breathing of the ring", problems::rotating_ring::breathing(), breathing, ULPS * 40.0);
    let truth = Truth::read(problems::firing::TRUTH);
    let times = truth.numbers("time_of_flight[low,high]");
    for (angle, time) in [("angle_low", times[0]), ("angle_high", times[1])] {
        let missed = problems::firing::place(truth.number(angle), 0.0, time).distance(problems::firing::TARGET);
        assert_near("end of the shot", missed, 0.0, ULPS * 100.0);
    }
    let truth = Truth::read(problems::quadratic_drag::TRUTH);
    for (time, row) in rows(&truth, "fall[depth,speed]") {
        let (depth, speed) = problems::quadratic_drag::fall(time);
        assert_near("depth of the fall", depth, row[0], ULPS * 50.0);
        assert_near("speed of the fall", speed, row[1], ULPS * 16.0);
    }
    let truth = Truth::read(problems::cluster_rotation::TRUTH);
    for (time, row) in rows(&truth, "atom positions") {
        let atoms = problems::cluster_rotation::atoms(time);
        for (found, exact) in atoms.iter().flat_map(|atom| [atom.x, atom.y]).zip(row) {
            assert_near("atom of the cluster", found, exact, problems::cluster_rotation::FLOOR);
        }
    }
    let truth = Truth::read(include_str!("../../assets/truths/P07_kepler.json"));
    for (time, row) in rows(&truth, "relative state[x,y,vx,vy]") {
        let (position, velocity) = problems::kepler::state(time);
        // The times of the file are rounded: at 4.4 m/s and 630 s that is a few 1e-13 m, and 90 times that in m/s.
        for (found, exact) in [position.x, position.y].into_iter().zip(&row) {
            assert_near("place on the ellipse", found, *exact, 1e-12);
        }
        for (found, exact) in [velocity.x, velocity.y].into_iter().zip(&row[2..]) {
            assert_near("velocity on the ellipse", found, *exact, 1e-10);
        }
    }
    let truth = Truth::read(problems::elastic_bounce::TRUTH);
    for (time, row) in rows(&truth, "gap and velocity at t (gap = bottom of disc above wall)") {
        let (gap, velocity) = problems::elastic_bounce::state(time);
        // The period is known to an ulp: 20 of them are off by 20, at up to 3.1 m/s and, in contact, 314 m/s2.
        let late = 20.0 * f64::EPSILON * problems::elastic_bounce::PERIOD + f64::EPSILON * time;
        assert_near("gap of the bounce", gap, row[0], 4.0 * late + ULPS);
        assert_near("velocity of the bounce", velocity, row[1], 320.0 * late + 4.0 * ULPS);
    }
    let truth = Truth::read(problems::inelastic_impact::TRUTH);
    for inelasticity in [0.1, 0.5, 0.9] {
        let number = |what: &str| truth.number(&format!("{what} (mu_e={inelasticity})"));
        assert_near("e", problems::inelastic_impact::restitution(inelasticity), number("e"), ULPS);
        let contact_time = problems::inelastic_impact::contact_time(inelasticity);
        assert_near("contact time", contact_time, number("contact time"), ULPS);
        assert_near("overlap", problems::inelastic_impact::deepest(inelasticity), number("max overlap"), ULPS);
    }
    let truth = Truth::read(problems::dashpot_impact::TRUTH);
    for ratio in problems::dashpot_impact::RATIOS {
        for (pulls, ends) in [(true, "overlap"), (false, "force")] {
            let number = |what: &str| truth.number(&format!("{what} released at zero {ends} (zeta={ratio})"));
            let (lasts, restitution) = problems::dashpot_impact::contact(ratio, pulls);
            assert_near("contact time", lasts, number("t_c"), ULPS);
            assert_near("restitution", restitution, number("e"), ULPS);
        }
    }
    let truth = Truth::read(problems::incline::TRUTH);
    for (degrees, _) in &problems::incline::BLOCKS[..4] {
        for (time, row) in rows(&truth, &format!("displacement at {degrees} deg")) {
            assert_near("way down the incline", problems::incline::state(*degrees, 0.0, time).0, row[0], ULPS * 5.0);
        }
    }
    let [turns, distance] = truth.numbers("thrown uphill: turning time, distance")[..] else { panic!("two numbers") };
    let uphill = |time: f64| problems::incline::state(30.0, -4.0, time);
    assert_near("turn", uphill(turns).0, -distance, ULPS * 4.0);
    assert_near("return", uphill(truth.number("thrown uphill: return time")).0, 0.0, ULPS * 8.0);
    let speed = uphill(truth.number("thrown uphill: return time")).1;
    assert_near("speed of return", speed, truth.number("thrown uphill: return speed"), ULPS * 8.0);
    let truth = Truth::read(problems::stick_slip::TRUTH);
    for friction in problems::stick_slip::STATIC {
        let number = |what: &str| truth.number(&format!("{what} (mu_s={friction})"));
        let (slips, sticks, highest) = problems::stick_slip::round(friction);
        assert_near("slip", slips, number("slip duration"), ULPS);
        assert_near("stick", sticks, number("stick duration"), ULPS);
        assert_near("highest place", highest, number("x max"), ULPS);
    }
    let truth = Truth::read(problems::servo_wheel::TRUTH);
    for (time, row) in rows(&truth, "q") {
        assert_near("angle of the wheel", problems::servo_wheel::angle(time), row[0], ULPS * 2.0);
    }
    let truth = Truth::read(problems::slider_crank::TRUTH);
    for (time, row) in rows(&truth, "piston x,v,a") {
        assert_near("place of the piston", problems::slider_crank::piston(time), row[0], ULPS);
    }
    let truth = Truth::read(problems::rigid_ring::TRUTH);
    assert_near(
        "radius of the rigid ring",
        problems::rigid_ring::radius(),
        truth.number("rigid-link ring: radius"),
        ULPS,
    );
    assert_near("pull in it", problems::rigid_ring::tension(), truth.number("rigid-link ring: tension"), ULPS * 5.0);
    let truth = Truth::read(problems::falling_rod::TRUTH);
    assert_near("when the rod is level", problems::falling_rod::LEVEL, truth.number("time to horizontal"), ULPS);
    let truth = Truth::read(problems::wedge::TRUTH);
    for (degrees, _) in problems::wedge::GROOVES {
        let number = |what: &str| truth.number(&format!("{degrees} deg: {what}"));
        let [force, overlap, sinking, swing] = problems::wedge::statics(degrees);
        assert_near("force of a wedge", force, number("wall normal force"), ULPS * force);
        let frequency = number("vertical oscillation angular frequency sqrt(2k sin^2 a/m)");
        assert_near("swing between wedges", swing, frequency, ULPS * swing);
        let depths = truth.numbers(&format!("{degrees} deg: overlap, vertical sinking"));
        assert_near("overlap", overlap, depths[0], ULPS * overlap);
        assert_near("sinking", sinking, depths[1], ULPS * sinking);
    }
    let truth = Truth::read(problems::plank::TRUTH);
    for (found, exact) in problems::plank::forces().into_iter().zip(truth.numbers("reactions")) {
        assert_near("force of a foot", found, exact, ULPS * problems::plank::WEIGHT);
    }
    let truth = Truth::read(problems::spool::TRUTH);
    for angle in problems::spool::ANGLES {
        let found = problems::spool::acceleration(0.12, angle.parse::<f64>().expect("a number").to_radians());
        // The angle in degrees has 16 digits.
        assert_near("spool", found, truth.number(&format!("{angle} deg rolling acceleration")), 2.0 * ULPS);
    }
}
