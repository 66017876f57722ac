//! A method from outside: contacts see its changes of bodies between a step and the evaluation of forces.
//!
//! Law: under a spring and a dashpot two discs that do not move against each other are pushed apart by `k d` alone, whatever the
//! dashpot. Tolerance: rounding of the overlap, `u` times the place over the overlap, a part in 1e12.

use glam::DVec2;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::tick::{Integrator, Method};
use jostle::tick::{Tick, set_method};

/// Semi-implicit Euler that stops all motion before forces are evaluated.
struct Stops;

impl Integrator for Stops {
    fn advance(&mut self, tick: &mut Tick) {
        let dt = tick.dt;
        tick.advance(dt, dt, None);
        let bodies = tick.bodies();
        let kept = bodies.velocity.clone();
        bodies.velocity.fill(DVec2::ZERO);
        tick.evaluate(dt);
        tick.bodies().velocity = kept;
    }
}

#[test]
fn contacts_see_velocities_that_a_method_changes_after_its_step() {
    let text = "Scene(format: 1, clock: (duration: 0.05, tick: 0.0005, method: SemiImplicitEuler),
        contacts: Penalty(normal: Dashpot, damping: 20),
        materials: { \"soft\": (stiffness: 2000) },
        bodies: [(name: \"a\", at: (0, 0), velocity: (1, 0), material: \"soft\", atoms: Disc(radius: 0.1, mass: 1)),
            (name: \"b\", at: (0.2, 0), velocity: (-1, 0), material: \"soft\", atoms: Disc(radius: 0.1, mass: 1))])";
    let mut simulation = Simulation::load(&Source::new("stops.ron", text)).unwrap_or_else(|wrong| panic!("{wrong}"));
    set_method(simulation.world_mut(), Method(Box::new(Stops)));
    for tick in (3..60).step_by(3) {
        simulation.run_to_tick(tick).expect("numbers stay finite");
        let bodies = simulation.bodies();
        let overlap = 0.2 - (bodies.position[1].x - bodies.position[0].x);
        let spring = 1000.0 * overlap;
        assert!(overlap > 0.0, "they touch in all of these ticks");
        assert!((bodies.force[1].x - spring).abs() < 1e-12 * spring, "tick {tick}: {} {spring}", bodies.force[1].x);
    }
}
