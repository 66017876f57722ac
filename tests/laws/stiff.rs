//! Law: an elastic ball keeps its energy and its period, however stiff the floor. Source: closed form; truth file H02, a floor
//! of 1e9 N/m on which a contact lasts 0.1 ms of a period of 0.6 s.
//!
//! Tolerances, with `z = w dt`. Velocity Verlet without located events: a kink inside a tick changes the velocity by up to a share
//! `z^2/4`, twice a contact, and the energy by twice that; so it is after each bounce within `z^2` of what it was before. Located,
//! Dop853 errs by less than 1e-8 of the speed in a contact (`z = 0.6`, order 8 with a constant below 1e-6: see
//! `convergence`), and `n` contacts, each of which is followed by flights that grow a wrong period, make the place after the tenth
//! bounce wrong by up to `v T 1e-8 n^2/2`.
//!
//! Not tested: what a tick far above the critical one gives (numbers without meaning): that the card says so, is.

use jostle::Simulation;
use jostle::problems::Truth;

use super::support::{assert_near, load};

const STIFFNESS: f64 = 1e9;
const SPEED: f64 = 3.0;
const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 0.1;

fn truth() -> Truth {
    Truth::read(include_str!("../../assets/truths/H02_stiff_contact.json"))
}

/// The ball leaves the floor upwards at the beginning, so that a period later it does so again.
fn scene(method: &str, events: &str, tick: f64) -> Simulation {
    load(&format!(
        "Scene(format: 1, clock: (duration: 7, tick: {tick:?}, method: {method}, events: {events}), gravity: (0, -{GRAVITY:?}),
        materials: {{ \"steel\": (stiffness: {STIFFNESS:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
        bodies: [(name: \"ball\", at: (0.5, {RADIUS:?}), velocity: (0, {SPEED:?}), material: \"steel\",
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])"
    ))
}

/// Kinetic and potential energy of the flight over that at the floor, at the top of flight `number`.
fn energy_in_flight(simulation: &mut Simulation, number: u32) -> f64 {
    let period = truth().number("bounce period");
    let top = (f64::from(number) + 0.5) * period;
    simulation.run_to_tick((top / simulation.clock().dt).round() as u64).expect("numbers stay finite");
    let bodies = simulation.bodies();
    let height = bodies.position[0].y - RADIUS;
    assert!(height > 0.0, "in flight: {height}");
    (0.5 * bodies.velocity[0].y.powi(2) + GRAVITY * height) / (0.5 * SPEED * SPEED)
}

#[test]
fn unlocated_events_cost_a_share_of_energy_in_each_bounce() {
    for tick in [1e-5, 5e-6] {
        let mut simulation = scene("VelocityVerlet", "PerTick", tick);
        let step = STIFFNESS.sqrt() * tick;
        let first = energy_in_flight(&mut simulation, 1);
        assert_near("after one bounce", first, 1.0, step * step);
        let tenth = energy_in_flight(&mut simulation, 10);
        assert_near("after ten bounces", tenth, 1.0, 10.0 * step * step);
        assert!((tenth - 1.0).abs() > 1e-9, "there is something to be located");
    }
}

#[test]
fn located_events_keep_energy_and_period_of_ten_bounces() {
    let period = truth().number("bounce period");
    assert_near("critical tick", 2.0 / STIFFNESS.sqrt(), truth().number("dt_crit symplectic euler/verlet"), 1e-19);
    // Five ticks a contact; all else would bear much longer ones.
    let mut simulation = scene("Dop853", "Located", 2e-5);
    let each = 1e-8;
    let energy = energy_in_flight(&mut simulation, 1);
    assert_near("energy after one bounce", energy, 1.0, 2.0 * each);
    let energy = energy_in_flight(&mut simulation, 10);
    assert_near("energy after ten bounces", energy, 1.0, 20.0 * each);
    let (time, bodies) = (simulation.clock().time() - 10.0 * period, simulation.bodies());
    let height = SPEED * time - 0.5 * GRAVITY * time * time;
    assert_near("place", bodies.position[0].y - RADIUS, height, SPEED * period * each * 50.0);
    let card = simulation.card();
    // Touching and parting, ten times; the parting of the beginning.
    println!("{} events, {energy:?}", card.events_located);
    assert!((20..=21).contains(&card.events_located), "{} events", card.events_located);
}

/// Far above the contact time nothing is right, and the card says so.
#[test]
fn the_card_warns_of_ticks_far_above_the_contact_time() {
    for tick in [1.0 / 60.0, 1e-3, 1e-4] {
        for (method, events) in [("VelocityVerlet", "PerTick"), ("Dop853", "Located")] {
            let mut simulation = scene(method, events, tick);
            // A run that gains so much energy that the guard ends it says so, too.
            let ended = simulation.run_to_tick((0.7 / tick) as u64);
            let notes = simulation.card().notes;
            let warned = notes.iter().any(|note| note.contains("the critical one") || note.contains("is not resolved"));
            assert!(warned || ended.is_err(), "{method} {tick}: {notes:?}");
        }
    }
}
