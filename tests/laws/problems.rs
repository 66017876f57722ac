//! Law: each problem of `jostle::problems`, its own. Source: each problem's file; the closed forms are compared here
//! with the truth files, which were made independently of them.
//!
//! Tolerances: each problem derives the leading error term and the worst case of rounding of a method of a given order
//! (`Problem::bound`). Closed forms agree with truth files to a few units in the last place.
//!
//! Not tested: that errors fall with the right power; see `convergence`.

use jostle::problems::{self, Setting, Truth};

use super::support::{assert_near, phases};

/// Every method on every problem, at the stated tick and at one 32 times finer, in the worst of eight phases.
#[test]
fn every_problem_is_solved_within_its_bound() {
    let mut report = Vec::new();
    let mut failed = false;
    for problem in problems::ALL {
        // The leading terms are those of the methods that go from tick to tick; the others' orders are in `convergence`.
        for method in problems::methods().into_iter().filter(|method| method.whole_ticks.is_some()) {
            let mut ticks = vec![problem.tick, problem.tick / 32.0];
            // Where a million ticks would show no more than rounding again, one refinement is enough.
            if problem.class == problems::Class::Free {
                ticks = vec![problem.tick, problem.tick / 2.0];
            }
            for tick in ticks {
                let count = if problem.class.depends_on_phase() { 8 } else { 1 };
                let worst = phases(count)
                    .map(|phase| {
                        let setting = Setting { method: method.name, tick, shift: phase * tick, ..Setting::default() };
                        problem.measure(&setting).unwrap_or_else(|error| panic!("{}: {error}", problem.name))
                    })
                    .fold(0.0, f64::max);
                let bound = problem.bound(method.order, tick);
                failed |= worst.is_nan() || worst > bound;
                let mark = if worst <= bound { "" } else { "  <-- too much" };
                let (name, method, unit) = (problem.name, method.name, problem.unit);
                report.push(format!("{name} {method} {tick:.4e} s: {worst:.2e} of {bound:.2e} {unit}{mark}"));
            }
        }
    }
    println!("{}", report.join("\n"));
    assert!(!failed, "\n{}", report.join("\n"));
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
}
