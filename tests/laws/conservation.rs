//! Law: what acts between bodies alone keeps momentum and angular momentum. Source: Newton's third law; forces along the line
//! of centres have no torque.
//!
//! It runs every problem of `jostle::problems` without external forces, under every method. Tolerance: 1e-13 of the
//! sums of absolute values per thousand ticks: each kick rounds a velocity by at most half a unit in the last place,
//! 1.1e-16 of it, and a walk of two kicks a tick is off by `sqrt(2000) x 1.1e-16 = 5e-15` then; twenty times that is
//! allowed.
//!
//! Not tested: energy (see `energy`), rough contacts of clumps (see `momentum`).

use jostle::problems::{self, ProblemSetting};

use super::support::{is_closed, momenta};

const PER_THOUSAND_TICKS: f64 = 1e-13;

#[test]
fn closed_problems_keep_momentum_and_angular_momentum() {
    let mut closed = Vec::new();
    for problem in problems::ALL.iter().filter(|problem| is_closed(problem)) {
        closed.push(problem.name);
        // A method without a stable tick explodes.
        for method in problems::methods().into_iter().filter(|method| method.stability_limit > 0.0) {
            let tick = problem.tick / 4.0;
            let setting = ProblemSetting { method: method.name, tick, shift: 0.0, ..ProblemSetting::default() };
            let mut simulation = problem.load(&setting).expect("the problem is a scene");
            let ((momentum, turning), (mut scale, mut turning_scale)) = momenta(simulation.bodies());
            for thousands in 1..=20 {
                simulation.run_to_tick(1000 * thousands).expect("numbers stay finite");
                let ((momentum_now, turning_now), scales) = momenta(simulation.bodies());
                // Bodies that begin at rest are compared with what they get.
                (scale, turning_scale) = (scale.max(scales.0), turning_scale.max(scales.1));
                let allowed = PER_THOUSAND_TICKS * thousands as f64;
                let lost = (momentum_now - momentum).length() / scale;
                let name = format!("{} under {} after {thousands} thousand ticks", problem.name, method.name);
                assert!(lost <= allowed, "{name}: momentum off by {lost:e}");
                // Bodies on one line have no angular momentum to compare with: then that of the line about a metre beside it.
                let lost = (turning_now - turning).abs() / turning_scale.max(scale);
                assert!(lost <= allowed || !method.symplectic, "{name}: angular momentum off by {lost:e}");
            }
        }
    }
    for name in ["figure_eight", "rotating_ring", "oblique_collision", "cradle"] {
        assert!(closed.contains(&name), "{name} is closed, but not among {closed:?}");
    }
}
