//! Law: contact with a linear spring is half a period of an oscillator; with gravity it lasts
//! `(2/w)(pi - atan(v w/g))`. Two soft discs scatter as the scattering integral says. Source: truth files C01 and C06.
//!
//! Tolerances: where a contact begins somewhere inside a tick, velocity Verlet changes the velocity by up to a share
//! `(w dt)^2/4`, and the frequency of the oscillator is off by `(w dt)^2/24`; so contact times and velocity ratios may
//! be off by a share `(w dt)^2/4`, worst of 16 phases. The deepest overlap is seen at ticks only: `(w dt)^2/8` more.
//!
//! Not tested: friction, inelasticity (see `restitution`).

use jostle::SimulationExt;
use std::f64::consts::PI;

use jostle::problems::{ProblemSetting, Truth, elastic_bounce, inelastic_impact, oblique_collision};

use super::support::{assert_near, load, momenta, phases, run};

const VERLET: &str = "VelocityVerlet";

#[test]
fn an_elastic_impact_lasts_half_a_period() {
    let truth = Truth::read(elastic_bounce::TRUTH);
    let contact_time = truth.number("contact time, no gravity = pi sqrt(m/k)");
    let deepest = truth.number("max overlap, no gravity");
    let tick = contact_time / 100.0;
    let share = (inelastic_impact::OMEGA * tick).powi(2) / 4.0;
    for phase in phases(16) {
        let setting = ProblemSetting { method: VERLET, tick, shift: phase * tick, ..ProblemSetting::default() };
        let simulation = run(&inelastic_impact::scene(&setting, 0.08, 0.0));
        let bodies = simulation.bodies();
        let (gap, speed) = (bodies.position[0].y - inelastic_impact::RADIUS, bodies.velocity[0].y);
        assert_near("velocity ratio", speed / inelastic_impact::SPEED, 1.0, share);
        let touch = inelastic_impact::GAP / inelastic_impact::SPEED - setting.shift;
        let lasted = simulation.clock().time() - gap / speed - touch;
        assert_near("contact time", lasted / contact_time, 1.0, share);
        let overlap = simulation.card().largest_overlap.meters;
        assert_near("deepest overlap", overlap / deepest, 1.0, 1.5 * share);
    }
}

#[test]
fn gravity_makes_the_contact_longer_and_deeper() {
    let truth = Truth::read(elastic_bounce::TRUTH);
    let contact_time = truth.number("contact time with gravity = (2/w)(pi - atan(v w/g))");
    let deepest = truth.number("max overlap with gravity");
    let impact = truth.number("impact speed");
    let tick = PI / elastic_bounce::OMEGA / 100.0;
    let share = (elastic_bounce::OMEGA * tick).powi(2) / 4.0;
    for phase in phases(16) {
        let setting = ProblemSetting { method: VERLET, tick, shift: phase * tick, ..ProblemSetting::default() };
        let mut simulation = elastic_bounce::PROBLEM.load(&setting).expect("the scene is correct");
        simulation.run_to_tick((0.8 * elastic_bounce::PERIOD / tick) as u64).expect("numbers stay finite");
        let bodies = simulation.bodies();
        let (gap, speed) = (bodies.position[0].y - elastic_bounce::RADIUS, bodies.velocity[0].y);
        // Back along the parabola to the end of contact.
        let left_with = (speed * speed + 2.0 * 9.81 * gap).sqrt();
        assert_near("velocity ratio", left_with / impact, 1.0, share);
        let touch = impact / 9.81 - setting.shift;
        let lasted = simulation.clock().time() - (left_with - speed) / 9.81 - touch;
        assert_near("contact time", lasted / contact_time, 1.0, share);
        assert_near("deepest overlap", simulation.card().largest_overlap.meters / deepest, 1.0, 1.5 * share);
    }
}

/// Up to the 21st bounce, against the truth file. A share `s` of the velocity at each bounce puts the ball off by up to
/// `4 (1 + 2 + ... + 21) s` heights (see the problem).
#[test]
fn states_of_twenty_bounces_are_those_of_the_closed_form() {
    let truth = Truth::read(elastic_bounce::TRUTH);
    let observable = "gap and velocity at t (gap = bottom of disc above wall)";
    let tick = elastic_bounce::PERIOD / 10_000.0;
    let bound = 4.0 * 231.0 * (elastic_bounce::OMEGA * tick).powi(2) / 4.0;
    let setting = ProblemSetting { method: VERLET, tick, shift: 0.0, ..ProblemSetting::default() };
    let mut simulation = elastic_bounce::PROBLEM.load(&setting).expect("the scene is correct");
    for (time, exact) in truth.times(observable).iter().zip(truth.numbers(observable).chunks(2)) {
        simulation.run_to_tick((time / tick).round() as u64).expect("numbers stay finite");
        let gap = simulation.bodies().position[0].y - elastic_bounce::RADIUS;
        assert_near("gap over height", gap / elastic_bounce::HEIGHT, exact[0] / elastic_bounce::HEIGHT, bound);
    }
}

#[test]
fn two_soft_discs_scatter_as_the_integral_says() {
    let truth = Truth::read(oblique_collision::TRUTH);
    let deepest = truth.number("soft: max overlap");
    let contact_time = truth.number("soft: contact duration");
    let tick = contact_time / 100.0;
    // The rate of the contact, with series stiffness 7.5 kN/m and reduced mass 2/3 kg.
    let share = 7500.0 / (2.0 / 3.0) * tick * tick / 4.0;
    for phase in phases(16) {
        let setting = ProblemSetting { method: VERLET, tick, shift: phase * tick, ..ProblemSetting::default() };
        let text = (oblique_collision::PROBLEM.scene)(&setting, 0.04);
        let ((momentum, turning), _) = momenta(load(&text).bodies());
        let simulation = run(&text);
        let bodies = simulation.bodies();
        for (found, exact) in bodies.velocity.iter().zip(oblique_collision::after()) {
            assert_near("velocity", (*found - exact).length() / oblique_collision::SPEED, 0.0, share);
        }
        assert_near("deepest overlap", simulation.card().largest_overlap.meters / deepest, 1.0, 1.5 * share);
        let ((momentum_after, turning_after), (scale, turning_scale)) = momenta(bodies);
        // A hundred ticks of rounding.
        assert_near("momentum", (momentum_after - momentum).length() / scale, 0.0, 100.0 * f64::EPSILON);
        assert_near("angular momentum", (turning_after - turning) / turning_scale, 0.0, 100.0 * f64::EPSILON);
        // Frictionless: nothing but rounding of the contact point makes them spin.
        let rim = bodies.spin.iter().map(|spin| 0.15 * spin.abs()).fold(0.0, f64::max);
        assert_near("speed of the rim", rim / oblique_collision::SPEED, 0.0, 100.0 * f64::EPSILON);
    }
}
