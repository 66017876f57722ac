//! Law: motion is the same in every inertial frame: turned by 37 degrees, shifted, and boosted by 100 m/s. Source: Galileo;
//! Noether.
//!
//! It runs every problem of `jostle::problems` without external forces, under every method. Tolerance: rounding times
//! condition. In the other frame a place is known to an ulp of its distance from the origin, up to 100 m/s times the
//! length of the run. What such an ulp makes is measured: the run is repeated with every place of the start moved by
//! it. As each tick rounds anew, the square root of the number of ticks times that, and fifty times for what the worst
//! direction is worse than the one tried, is allowed.
//!
//! Not tested: frames of walls, fields and drag, which move with the scene.

use glam::DVec2;
use jostle::problems::{self, ProblemSetting};
use jostle::simulation::Simulation;
use jostle::world::{Position, Rotation, Velocity};

use super::support::is_closed;

const TURN: f64 = 37.0;
const SHIFT: DVec2 = DVec2::new(3.0, -7.0);
const BOOST: DVec2 = DVec2::new(80.0, 60.0);

/// Changes place, angle and velocity of each body at the start.
fn change(simulation: &mut Simulation, change: impl Fn(usize, DVec2, f64, DVec2) -> (DVec2, f64, DVec2)) {
    for body in 0..simulation.bodies().len() {
        let bodies = simulation.bodies();
        let (entity, old) = (bodies.entity[body], (bodies.position[body], bodies.angle[body], bodies.velocity[body]));
        let (position, angle, velocity) = change(body, old.0, old.1, old.2);
        simulation.world_mut().entity_mut(entity).insert((Position(position), Rotation(angle), Velocity(velocity)));
    }
}

/// The greatest distance between two lists of places.
fn apart(a: &[DVec2], b: impl Iterator<Item = DVec2>) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(b)).fold(0.0, f64::max)
}

#[test]
fn closed_problems_are_the_same_in_every_frame() {
    let mut report = Vec::new();
    for problem in problems::ALL.iter().filter(|problem| is_closed(problem)) {
        // A method without a stable tick has no state to compare.
        for method in problems::methods().into_iter().filter(|method| method.stability_limit > 0.0) {
            let setting =
                ProblemSetting { method: method.name, tick: problem.tick, shift: 0.0, ..ProblemSetting::default() };
            let load = || problem.load(&setting).expect("the problem is a scene");
            let (mut here, mut moved, mut there) = (load(), load(), load());
            let time = here.ticks() as f64 * problem.tick;
            let ulp = f64::EPSILON * (SHIFT.length() + BOOST.length() * time);
            // Of the first bodies, each in a direction of its own.
            change(&mut moved, |body, position, angle, velocity| {
                (position + DVec2::from_angle(2.4 * body as f64) * ulp, angle, velocity)
            });
            let turn = DVec2::from_angle(TURN.to_radians());
            change(&mut there, |_, position, angle, velocity| {
                (turn.rotate(position) + SHIFT, angle + TURN.to_radians(), turn.rotate(velocity) + BOOST)
            });
            for simulation in [&mut here, &mut moved, &mut there] {
                simulation.run_to_end().expect("numbers stay finite");
            }
            let ended = &here.bodies().position;
            let condition = apart(ended, moved.bodies().position.iter().copied()).max(ulp);
            let inverse = DVec2::new(turn.x, -turn.y);
            let back = |position: &DVec2| inverse.rotate(*position - SHIFT - BOOST * time);
            let found = apart(ended, there.bodies().position.iter().map(back));
            let allowed = 50.0 * condition * (here.ticks() as f64).sqrt();
            report.push(format!("{} {}: {found:.1e} m of {allowed:.1e} m", problem.name, method.name));
            assert!(found <= allowed, "{}", report.join("\n"));
        }
    }
    println!("{}", report.join("\n"));
    assert!(report.len() >= 8, "too few closed problems: {report:?}");
}
