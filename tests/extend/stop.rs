//! Promise: a user can end a run inside a tick that takes long. The run says where it ended. It is not continued or saved as if it had
//! reached the end of the tick. A run of many ticks ends between two of them.

use std::sync::atomic::{AtomicU64, Ordering};

use jostle::scene::Source;
use jostle::tick::{FailureKind, work_of_an_evaluation};
use jostle::{Simulation, SimulationExt};

/// A planet on an ellipse. Its tick lasts the whole run, with some hundred steps.
const ORBIT: &str = "Scene(format: 1, clock: (duration: 20, tick: 20, method: Reference),
    bodies: [(name: \"sun\", at: (0, 0), mass: 1e6, atoms: Disc(radius: 0.1)),
             (name: \"planet\", at: (1, 0), velocity: (0, 1), mass: 1, atoms: Disc(radius: 0.01))],
    forces: [Spring(a: \"sun\", b: \"planet\", stiffness: 3)])";

/// Steps after which the run is ended.
const STEPS: u64 = 10;

static ASKED: AtomicU64 = AtomicU64::new(0);

#[test]
fn a_run_ends_inside_a_tick_on_request_and_says_when() {
    let mut simulation = Simulation::load(&Source::new("orbit.ron", ORBIT)).unwrap();
    simulation.ask_inside_ticks(|_| ASKED.fetch_add(1, Ordering::Relaxed) < STEPS);
    let failure = simulation.run_to_end().unwrap_err();
    assert_eq!((failure.wrong, ASKED.load(Ordering::Relaxed)), (FailureKind::Stopped, STEPS + 1));
    let reached = simulation.state().stopped_at().unwrap();
    assert!(reached > 0.0 && reached < 20.0, "{reached}");
    assert!(simulation.snapshot().is_err(), "a snapshot would hold a part of a tick");
}

#[test]
fn a_run_that_goes_on_ends_in_the_same_bits() {
    let load = || Simulation::load(&Source::new("orbit.ron", ORBIT)).unwrap();
    let (mut plain, mut asked) = (load(), load());
    asked.ask_inside_ticks(|_| true);
    plain.run_to_end().unwrap();
    asked.run_to_end().unwrap();
    assert_eq!(plain.card().hash, asked.card().hash);
}

/// A planet with ticks that are steps: so many that they would take hours.
const TICKS: &str = "Scene(format: 1, clock: (duration: 1e6, tick: 1e-4, method: VelocityVerlet), 
    bodies: [(name: \"sun\", at: (0, 0), mass: 1e6, atoms: Disc(radius: 0.1)),
             (name: \"planet\", at: (1, 0), velocity: (0, 1), mass: 1, atoms: Disc(radius: 0.01))],
    forces: [Spring(a: \"sun\", b: \"planet\", stiffness: 3)])";

static BETWEEN: AtomicU64 = AtomicU64::new(0);

#[test]
fn a_run_ends_between_ticks_on_request_and_can_be_saved() {
    let load = || Simulation::load(&Source::new("orbit.ron", TICKS)).unwrap();
    let mut simulation = load();
    simulation.ask_inside_ticks(|_| BETWEEN.fetch_add(1, Ordering::Relaxed) < STEPS);
    let failure = simulation.run_to_end().unwrap_err();
    assert_eq!((failure.wrong, BETWEEN.load(Ordering::Relaxed)), (FailureKind::Stopped, STEPS + 1));
    let ticks = simulation.clock().ticks;
    assert!(ticks > STEPS && ticks < simulation.ticks() && simulation.failure().is_none(), "{ticks}");
    assert!(simulation.snapshot().is_ok());
    // Its state is that of a whole run at this tick.
    let mut whole = load();
    whole.run_to_tick(ticks).unwrap();
    assert_eq!(simulation.bodies().position, whole.bodies().position);
}

/// Without neighbours the work of each evaluation stays the same. A step of `Reference` has 16 evaluations at most, and is
/// tried again with fewer: four tries.
const PER_STEP: f64 = 64.0;

#[test]
fn a_run_ends_inside_a_tick_after_its_work() {
    for most in [100.0, 1000.0] {
        let alone = ORBIT.replace("mass: 1,", "mass: 1, collides: false,");
        let mut simulation = Simulation::load(&Source::new("orbit.ron", alone)).unwrap();
        simulation.end_after(most);
        let failure = simulation.run_to_end().unwrap_err();
        let each = work_of_an_evaluation(simulation.state());
        let work = simulation.state().evaluation().count as f64 * each;
        assert_eq!(failure.wrong, FailureKind::Stopped);
        assert!((most..most + (PER_STEP + 1.0) * each).contains(&work), "{work} of {most}");
    }
}
