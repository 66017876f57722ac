//! Law: the effect of a row of touching soft discs on a pulse depends on the springs, not on the tick: the pulse
//! disperses. Source: Herrmann and Seitz 1982; truth file M01 (modal solution).
//!
//! Tolerances: those of the problem (kinks inside ticks); they grow with the number of contacts, two kinks each. All discs
//! have parted when the truth says so: before it the last pair still touches, after it none does, but for the ticks in
//! which a share `(w dt)^2` of overlaps is undone. Momentum is kept to rounding.
//!
//! Not tested: hard discs, whose outcome is that of one collision after the other.

use jostle::SimulationExt;
use jostle::problems::{ProblemSetting, cradle};

use super::support::{METHODS, assert_near, load, momenta, phases, run_to};

const CASES: [(usize, usize); 6] = [(2, 1), (3, 1), (4, 1), (5, 1), (5, 2), (10, 1)];

#[test]
fn a_pulse_disperses_in_every_row() {
    for method in METHODS {
        let tick = 1e-4;
        for (count, incoming) in CASES {
            let interaction = cradle::interaction_time(count, incoming);
            let mut worst = 0.0_f64;
            for phase in phases(16) {
                let setting = ProblemSetting { method, tick, shift: phase * tick, ..ProblemSetting::default() };
                let text = cradle::scene(&setting, 1.0, count, incoming);
                let mut simulation = load(&text);
                // All touch in the middle of it; shortly before the end some still do.
                run_to(&mut simulation, 0.95 * interaction);
                let touching = |simulation: &jostle::Simulation| simulation.card().energy.elastic > 0.0;
                assert!(touching(&simulation), "N = {count}: still in touch");
                run_to(&mut simulation, interaction + 0.05 * interaction);
                assert!(!touching(&simulation), "N = {count}: all parted");
                worst = worst.max(cradle::error_of(&simulation, count, incoming));
                let ((momentum, _), (scale, _)) = momenta(simulation.bodies());
                let ticks = simulation.clock().ticks as f64;
                assert_near("momentum", momentum.x / scale, incoming as f64 / scale, ticks * f64::EPSILON);
            }
            let order = if method == METHODS[0] { 1 } else { 2 };
            let bound = cradle::leading_error(order, tick) * (count as f64 / 4.0).max(1.0) * incoming as f64;
            println!("{method}, N = {count}, {incoming} incoming: {worst:.2e} of {bound:.2e}");
            assert!(worst <= bound, "{method}, N = {count}, {incoming} incoming: {worst:e} > {bound:e}");
        }
    }
}
