//! Law: the balance of forces and torques and the equal stiffness of five posts determine their loads, whose sum is
//! exactly the weight. Source: least complementary energy; truth file S03.
//!
//! Tolerance: the swing of the plank falls below rounding in half of the run. Forces are rounded as differences of heights are, by 1e-16 m
//! times 1e5 N/m, a few times each. So all are right to 1e-9 N.
//!
//! Not tested: feet that part from their posts.

use jostle::contacts::Other;
use jostle::problems::plank::{FEET, PROBLEM, TRUTH, WEIGHT};
use jostle::problems::{ProblemSetting, Truth};

use super::support::assert_near;

#[test]
fn posts_bear_what_their_stiffness_tells() {
    let exact = Truth::read(TRUTH).numbers("reactions");
    for method in ["VelocityVerlet", "RungeKutta4", "Dop853"] {
        let setting = ProblemSetting { method, tick: PROBLEM.tick, ..ProblemSetting::default() };
        let mut simulation = PROBLEM.load(&setting).expect("the scene is correct");
        simulation.run_to_tick((0.5 / PROBLEM.tick) as u64).expect("numbers stay finite");
        let mut forces = vec![0.0; FEET.len()];
        for point in simulation.state().contact_points().expect("the contact law tells its points") {
            let Other::Body(other) = point.other else { panic!("posts are bodies") };
            // The plank is the first body.
            forces[point.body.max(other) - 1] += point.force.y.abs();
        }
        for (post, (found, exact)) in forces.iter().zip(&exact).enumerate() {
            assert_near(&format!("{method}: post {post}"), *found, *exact, 1e-9);
        }
        assert_near(&format!("{method}: all posts"), forces.iter().sum(), WEIGHT, 1e-9);
    }
}
