//! A ball that bounces ten times on floors from soft to hard, 1e3 to 1e9 N/m. On the hardest a contact lasts 0.1 ms of
//! a period of 0.6 s. SI units.
//!
//! With `w = sqrt(k/m)` a contact that begins at the speed `v` lasts `(2/w) (pi - atan(v w/g))`, a flight `2 v/g`.

use crate::SimulationExt;
use std::error::Error;
use std::f64::consts::PI;

use super::{Case, Extent, Readings, load};
use crate::problems::Truth;
use jostle_engine::Simulation;

/// The case.
pub const CASE: Case = Case {
    name: "stiffness",
    what: "a ball bounces ten times on floors of 1e3 to 1e9 N/m",
    source: "closed form; truth file H02",
    cheap: false,
    short: "1e3, 1e6 and 1e9 N/m",
    run,
};

/// The reference values, for 1e9 N/m.
pub const TRUTH: &str = include_str!("../../../../assets/truths/H02_stiff_contact.json");
/// The speed at which the ball leaves the floor, in m/s.
pub const SPEED: f64 = 3.0;
/// In m/s2.
pub const GRAVITY: f64 = 9.81;
/// In m.
pub const RADIUS: f64 = 0.1;
/// The error of Dop853 in a contact of five ticks, as a share of the speed. It is of order 8 at omega dt = 0.6 with a
/// constant below 1e-6.
const EACH: f64 = 1e-8;
/// `omega dt` of runs with located events, and of those without.
const LOCATED: f64 = 0.6;
const PER_TICK: f64 = 0.1;

/// The ball of 1 kg leaves the floor upwards at the beginning, and so again a period later.
pub fn scene(stiffness: f64, method: &str, events: &str, tick: f64) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 10, tick: {tick:?}, method: {method}, events: {events}), gravity: (0, -{GRAVITY:?}),
        materials: {{ \"steel\": (stiffness: {stiffness:?}) }},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
        bodies: [(name: \"ball\", at: (0.5, {RADIUS:?}), velocity: (0, {SPEED:?}), material: \"steel\",
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])"
    )
}

/// From leaving the floor to leaving it again, in s.
pub fn period(stiffness: f64) -> f64 {
    let omega = stiffness.sqrt();
    2.0 * SPEED / GRAVITY + 2.0 / omega * (PI - libm::atan(SPEED * omega / GRAVITY))
}

/// Kinetic and potential energy of the flight over that at the floor, at the top of flight `number`.
fn energy_in_flight(simulation: &mut Simulation, stiffness: f64, number: u32) -> Result<f64, Box<dyn Error>> {
    let top = f64::from(number) * period(stiffness) + SPEED / GRAVITY;
    simulation.run_to_tick((top / simulation.clock().dt).round() as u64)?;
    let bodies = simulation.bodies();
    let height = bodies.position[0].y - RADIUS;
    let energy = (0.5 * bodies.velocity[0].y * bodies.velocity[0].y + GRAVITY * height) / (0.5 * SPEED * SPEED);
    Ok(if height > 0.0 { energy } else { f64::NAN })
}

fn run(extent: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let truth = Truth::read(TRUTH).number("bounce period");
    readings.at_most(
        "error of the closed form's period at 1e9 N/m, s",
        (period(1e9) - truth).abs(),
        4.0 * f64::EPSILON,
        "a few units in the last place",
    );
    for power in extent.pick(&[3, 6, 9][..], &[3, 4, 5, 6, 7, 8, 9][..]) {
        let stiffness: f64 = format!("1e{power}").parse()?;
        let omega = stiffness.sqrt();
        let mut simulation = load(&scene(stiffness, "VelocityVerlet", "PerTick", PER_TICK / omega))?;
        for (bounces, why) in [
            (
                1,
                "a kink inside a tick changes the velocity by up to (omega dt)^2/4, twice a contact, the energy by twice that",
            ),
            (10, "ten times (omega dt)^2"),
        ] {
            let energy = energy_in_flight(&mut simulation, stiffness, bounces)?;
            readings.at_most(
                format!("1e{power} N/m, VelocityVerlet by ticks: energy lost or gained in {bounces} bounces, share"),
                (energy - 1.0).abs(),
                f64::from(bounces) * PER_TICK * PER_TICK,
                why,
            );
        }
        let mut simulation = load(&scene(stiffness, "Dop853", "Located", LOCATED / omega))?;
        for bounces in [1, 10] {
            let energy = energy_in_flight(&mut simulation, stiffness, bounces)?;
            readings.at_most(
                format!("1e{power} N/m, Dop853 with located events: energy lost or gained in {bounces} bounces, share"),
                (energy - 1.0).abs(),
                2.0 * EACH * f64::from(bounces),
                "order 8 at omega dt = 0.6: below 1e-8 of the speed in a contact, the energy twice that",
            );
        }
        let (time, place) = (simulation.clock().time() - 10.0 * period(stiffness), simulation.bodies().position[0].y);
        let height = SPEED * time - 0.5 * GRAVITY * time * time;
        readings.at_most(
            format!("1e{power} N/m, Dop853: error of the place after ten bounces, m"),
            (place - RADIUS - height).abs(),
            SPEED * period(stiffness) * EACH * 50.0,
            "n contacts, each followed by flights of a wrong period: v T 1e-8 n^2/2",
        );
        let events = simulation.card().events_located as f64;
        readings.at_most(
            format!("1e{power} N/m: events located, away from 20.5"),
            (events - 20.5).abs(),
            0.5,
            "ten touches and ten partings, and the parting of the beginning",
        );
    }
    Ok(())
}
