//! Law: rolling resistance is a torque of up to `mu_r R N` against the turn of one side on the other, with
//! `1/R = 1/Ra + 1/Rb`. A disc (`I = m r^2/2`) that rolls has `m v' = f` and `I v'/r = -f r - mu_r r N`, so it slows down with
//! `(2/3) mu_r g` and stops after `3 v^2/(4 mu_r g)`; on a slope it stays if `tan a <= mu_r` and else rolls with
//! `(2/3) g (sin a - mu_r cos a)`, given that friction is enough. Source: statics; Ai, Chen, Rotter and Ooi 2011, of whose
//! models this is the one that comes to rest.
//!
//! The disc sinks in by `d = N/k`, a share of 1e-6 of its radius at most, so friction has the arm `h = r - d`: the exact
//! acceleration is `g (sin a - mu_r (r/h) cos a)/(1 + r^2/(2 h^2))`. Forces are constant then, so that accelerations are right
//! to the 1e-9 of the weight with which normal forces balance. Until the torque is full it is missing for a tick, as its
//! spring is drawn out by `mu_r N/(0.8 k)` in less, and the spring of friction swings by up to `f/sqrt(k_t m/3)` in speed.
//!
//! Not tested: rolling with slip, clumps (each contact has the law of its atoms).

use glam::DVec2;
use jostle::contacts::penalty::PenaltyState;
use jostle::{Simulation, SimulationExt};

use super::support::{METHODS, assert_near, assert_rest, load, run, run_to};

const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 0.1;
const STIFFNESS: f64 = 1e8;
const TICK: f64 = 5e-5;

/// A disc of 1 kg on a slope that falls to the right by `angle`, pressed in as deep as it stands, rolling downhill.
fn scene(method: &str, angle: f64, resistance: f64, speed: f64) -> String {
    let (sin, cos) = libm::sincos(angle);
    let height = arm(angle);
    format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {TICK:?}, method: {method}), gravity: (0, -{GRAVITY:?}),
        materials: {{ \"rubber\": (stiffness: {STIFFNESS:?}, friction: 0.5, inelasticity: 0.3) }},
        contacts: Penalty(rolling: Spring(friction: {resistance:?})),
        walls: [(name: \"floor\", left: ({cos:?}, {:?}), right: (0, 0), material: \"rubber\")],
        bodies: [(name: \"disc\", at: ({:?}, {:?}), velocity: ({:?}, {:?}), spin: {:?}, material: \"rubber\",
                  atoms: Disc(radius: {RADIUS:?}, mass: 1))])",
        -sin,
        height * sin,
        height * cos,
        speed * cos,
        -speed * sin,
        -speed / height
    )
}

/// Height of the disc's centre over the slope.
fn arm(angle: f64) -> f64 {
    RADIUS - GRAVITY * libm::cos(angle) / STIFFNESS
}

/// Downhill, in m/s2.
fn acceleration(angle: f64, resistance: f64) -> f64 {
    let (sin, cos) = libm::sincos(angle);
    let deep = RADIUS / arm(angle);
    GRAVITY * (sin - resistance * deep * cos) / (1.0 + deep * deep / 2.0)
}

/// Way and velocity downhill.
fn state(simulation: &Simulation, angle: f64) -> (f64, f64) {
    let (sin, cos) = libm::sincos(angle);
    let (bodies, down) = (simulation.bodies(), DVec2::new(cos, -sin));
    (bodies.position[0].dot(down), bodies.velocity[0].dot(down))
}

/// By how much the speed may be off, in m/s: a tick of `slowing` m/s2, and the swing of the spring of friction.
fn off(slowing: f64) -> f64 {
    slowing.abs() * TICK + slowing.abs() / (0.8 * STIFFNESS / 3.0).sqrt()
}

#[test]
fn a_rolling_disc_slows_down_evenly_and_stops_for_ever() {
    let (resistance, speed) = (0.05, 1.0);
    let exact = acceleration(0.0, resistance);
    assert_near("of the catalogue", exact, -0.327, 1e-6);
    let (time, way) = (-speed / exact, speed * speed / (-2.0 * exact));
    assert_near("way of the catalogue", way, 1.529_052_0, 1e-5);
    for method in METHODS {
        let mut simulation = load(&scene(method, 0.0, resistance, speed));
        run_to(&mut simulation, 0.5);
        let first = state(&simulation, 0.0);
        assert_near("speed", first.1, speed + 0.5 * exact, off(exact));
        run_to(&mut simulation, 2.5);
        let second = state(&simulation, 0.0);
        println!("{method}: acceleration off by {:e}", (second.1 - first.1) / 2.0 - exact);
        assert_near("acceleration", (second.1 - first.1) / 2.0, exact, 1e-9 * GRAVITY);
        assert_near("way", second.0, speed * 2.5 + 0.5 * exact * 2.5 * 2.5, off(exact) * 2.5 + speed * TICK);
        // What is missing in speed makes it stop later.
        let late = off(exact) / -exact + 2.0 * TICK;
        run_to(&mut simulation, time - late);
        assert!(state(&simulation, 0.0).1 > 0.0, "{method}: it should roll until {time} s");
        assert_rest(method, &mut simulation, ((time + late) / TICK).ceil() * TICK, 10.0);
        assert_near("stopping way", state(&simulation, 0.0).0, way, off(exact) * time + speed * TICK);
        assert_near(
            "it never slipped",
            -simulation.bodies().angle[0] * arm(0.0),
            way,
            off(exact) * time + speed * TICK,
        );
    }
}

/// The same where events are located: the spring's angle is state, it gives way and sticks at events of its own, and is held at
/// rest. The springs of friction and of rolling follow to the order of the method, so the energy is accounted for to that:
/// `(w dt)^4` of what both springs hold, with `w dt` below 1; and the disc stops as exactly as above.
#[test]
fn a_rolling_disc_stops_for_ever_where_events_are_located() {
    let (resistance, speed) = (0.05, 1.0);
    let exact = acceleration(0.0, resistance);
    let (time, way) = (-speed / exact, speed * speed / (-2.0 * exact));
    for method in ["RungeKutta4", "Dop853"] {
        let mut simulation = load(&scene(method, 0.0, resistance, speed));
        let late = off(exact) / -exact + 2.0 * TICK;
        run_to(&mut simulation, time - late);
        assert!(state(&simulation, 0.0).1 > 0.0, "{method}: it should roll until {time} s");
        assert_rest(method, &mut simulation, ((time + late) / TICK).ceil() * TICK, 0.5);
        assert_near("stopping way", state(&simulation, 0.0).0, way, off(exact) * time + speed * TICK);
        let card = simulation.card();
        let springs = 0.5 * (resistance * RADIUS * GRAVITY).powi(2) / (0.8 * STIFFNESS * RADIUS * RADIUS)
            + 0.5 * (exact * exact) / (0.8 * STIFFNESS / 3.0);
        println!("{method}: residual {:e}, events {}", card.energy.residual, card.events_located);
        assert_near("residual", card.energy.residual, 0.0, springs + 1e-12 * 0.75 * speed * speed);
        assert!(card.events_located > 0 && card.events_located < 64, "{method}: {} events", card.events_located);
    }
}

/// Torque times turn is lost, to what is missing in the first tick; semi-implicit Euler is ahead by half a tick of its speed.
#[test]
fn what_rolling_resistance_takes_is_booked_as_friction() {
    let (resistance, speed) = (0.05, 1.0);
    for method in METHODS {
        let mut simulation = load(&scene(method, 0.0, resistance, speed));
        for time in [1.0, 3.5] {
            run_to(&mut simulation, time);
            let (bodies, energy) = (simulation.bodies(), simulation.card().energy);
            let now = 0.5 * bodies.velocity[0].length_squared() + 0.5 * bodies.inertia[0] * bodies.spin[0].powi(2);
            let start = 0.5 * speed * speed * (1.0 + 0.5 * (RADIUS / arm(0.0)).powi(2));
            let tick = resistance * GRAVITY * speed * TICK;
            println!("{method}, {time} s: residual {:e} J, lost {} J", energy.residual, energy.friction);
            assert_near("residual", energy.residual, 0.0, tick);
            assert_near("lost", energy.friction, start - now, tick);
        }
    }
}

#[test]
fn on_a_slope_a_disc_stays_or_rolls_with_the_exact_acceleration() {
    let resistance = 0.2;
    for method in METHODS {
        for degrees in [5.0_f64, 11.2] {
            let angle = degrees.to_radians();
            let mut simulation = load(&scene(method, angle, resistance, 0.0));
            assert_rest(&format!("{method}, {degrees} deg"), &mut simulation, 0.1, 50.0);
            let elastic = resistance * GRAVITY / (0.8 * STIFFNESS);
            assert_near("it never rolled", state(&simulation, angle).0, 0.0, elastic);
        }
        for degrees in [11.5_f64, 20.0] {
            let angle = degrees.to_radians();
            let exact = acceleration(angle, resistance);
            let mut simulation = load(&scene(method, angle, resistance, 0.0));
            run_to(&mut simulation, 0.5);
            let first = state(&simulation, angle);
            run_to(&mut simulation, 1.5);
            let second = state(&simulation, angle);
            println!("{method}, {degrees} deg: acceleration off by {:e}", second.1 - first.1 - exact);
            assert_near("acceleration", second.1 - first.1, exact, 1e-9 * GRAVITY);
            // From rest the torque is missing until its spring is drawn out: by no more than all of it for as long as the
            // disc needs to roll so far.
            let stretch = resistance * GRAVITY / (0.8 * STIFFNESS);
            let gain = resistance * GRAVITY * ((2.0 * stretch / exact).sqrt() + TICK) + off(GRAVITY * libm::sin(angle));
            let way = 0.5 * exact * 1.5 * 1.5;
            assert_near("way", second.0, way, gain * 1.5 + second.1 * TICK);
        }
    }
}

#[test]
fn the_steepest_slope_on_which_a_disc_stays_is_located() {
    let resistance = 0.2;
    for method in METHODS {
        let holds = |angle: f64| {
            let mut simulation = load(&scene(method, angle, resistance, 0.0));
            run_to(&mut simulation, 0.1);
            simulation.bodies().velocity[0] == DVec2::ZERO
        };
        let exact = libm::atan(resistance);
        let (mut low, mut high) = (exact - 0.05, exact + 0.06);
        assert!(holds(low) && !holds(high));
        while high - low > 1e-7 {
            let middle = 0.5 * (low + high);
            if holds(middle) { low = middle } else { high = middle }
        }
        println!("{method}: threshold off by {:e} rad", 0.5 * (low + high) - exact);
        // Where arms are shorter it is `tan a = mu_r r/h`.
        let sunk = resistance * GRAVITY / STIFFNESS / RADIUS;
        assert_near("steepest slope", 0.5 * (low + high), exact, 1e-7 + sunk);
    }
}

/// Two discs of different size, pressed together without friction: the torque `mu_r N/(1/Ra + 1/Rb)` slows one and hastens
/// the other until they turn alike; momentum is kept, and the energy of the relative turn is lost. Pressed from the start as
/// deep as they stand, so the force is constant, but for a tick at the start and one at the end.
#[test]
fn two_discs_turn_each_other_with_the_rolling_radius_of_both() {
    let (radius_a, radius_b, resistance, press, spin) = (0.1, 0.3, 0.1, 10.0, 60.0);
    let (inertia_a, inertia_b) = (0.5 * radius_a * radius_a, radius_b * radius_b);
    let torque = resistance * press / (1.0 / radius_a + 1.0 / radius_b);
    let relative = torque / inertia_a + torque / inertia_b;
    let common = inertia_a * spin / (inertia_a + inertia_b);
    for method in METHODS {
        let overlap = press / (STIFFNESS / 2.0);
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 1000, tick: {TICK:?}, method: {method}),
            materials: {{ \"m\": (stiffness: {STIFFNESS:?}, friction: 0.5, inelasticity: 0.3) }},
            contacts: Penalty(tangential: None, rolling: Spring(friction: {resistance:?})),
            forces: [Thrust(of: \"a\", force: ({press:?}, 0)), Thrust(of: \"b\", force: (-{press:?}, 0))],
            bodies: [
                (name: \"a\", at: (-{radius_a:?}, 0), spin: {spin:?}, material: \"m\",
                 atoms: Disc(radius: {radius_a:?}, mass: 1)),
                (name: \"b\", at: ({:?}, 0), material: \"m\", atoms: Disc(radius: {radius_b:?}, mass: 2)),
            ])",
            radius_b - overlap
        ));
        for time in [1.0, 3.0] {
            run_to(&mut simulation, time);
            let spins = &simulation.bodies().spin;
            assert_near("spin of a", spins[0], spin - torque / inertia_a * time, torque / inertia_a * TICK + 1e-9);
            assert_near("spin of b", spins[1], torque / inertia_b * time, torque / inertia_b * TICK + 1e-9);
        }
        let ends = spin / relative;
        run_to(&mut simulation, (ends / TICK).floor() * TICK - 2.0 * TICK);
        let [a, b] = [simulation.bodies().spin[0], simulation.bodies().spin[1]];
        assert!(a - b > 0.0, "{method}: {a} and {b} rad/s before they turn alike");
        for time in [(ends / TICK).ceil() * TICK + 4.0 * TICK, 6.0] {
            run_to(&mut simulation, time);
            let spins = &simulation.bodies().spin;
            println!("{method}, {time} s: spins differ by {:e}", spins[0] - spins[1]);
            // Rounding of some 1e5 ticks.
            assert_near("common spin", spins[0], common, 1e5 * f64::EPSILON * spin);
            assert_near("common spin", spins[1], common, 1e5 * f64::EPSILON * spin);
        }
        let lost = 0.5 * inertia_a * spin * spin - 0.5 * (inertia_a + inertia_b) * common * common;
        let energy = simulation.card().energy;
        assert_near("lost", energy.friction, lost, torque * spin * TICK);
        assert_near("residual", energy.residual, 0.0, torque * spin * TICK);
    }
}

/// Two discs that hang together by attraction and turn about each other like one rigid body: the turn of one against the
/// other is that of rounding, once for each of the ticks.
#[test]
fn a_pair_that_turns_as_one_body_has_no_rolling_torque() {
    let (radius, overlap, rate, stiffness, tick) = (0.5, 1e-3, 3.0_f64, 1e4, 1e-3);
    let distance: f64 = 2.0 * radius - overlap;
    let constant = (stiffness * overlap + rate * rate * distance / 2.0) * distance * distance;
    let (x, speed) = (distance / 2.0, rate * distance / 2.0);
    let disc = |name: &str, side: f64| {
        format!(
            "(name: \"{name}\", at: ({:?}, 0), velocity: (0, {:?}), spin: {rate:?}, material: \"m\",
              atoms: Disc(radius: {radius:?}, mass: 1))",
            side * x,
            side * speed
        )
    };
    for method in METHODS {
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 100, tick: {tick:?}, method: {method}),
            forces: [Attraction(constant: {constant:?})], contacts: Penalty(rolling: Spring(friction: 0.1)),
            materials: {{ \"m\": (stiffness: {:?}, friction: 0.5) }}, bodies: [{}, {}])",
            2.0 * stiffness,
            disc("left", -1.0),
            disc("right", 1.0)
        ));
        for part in 1..=20 {
            run_to(&mut simulation, f64::from(part));
            let contacts = simulation.state().model::<PenaltyState>().unwrap();
            let rolling = contacts.rolling.as_ref().unwrap();
            assert_eq!(rolling.atoms.len(), 1);
            let turned = rate * f64::from(part);
            assert_near("turn of one against the other", rolling.atoms[0].elongation, 0.0, 2.0 * turned * f64::EPSILON);
        }
        assert!(simulation.bodies().angle[0] > 50.0, "they turn");
        assert_eq!(simulation.card().energy.friction, 0.0, "nothing gives way");
    }
}

/// What the rolling spring of a bouncing disc holds when the disc parts is lost to friction, and booked. Elastic contacts
/// without other friction; the account of Verlet is open by a share `(w dt)^2`, 1e-4, of what swings.
#[test]
fn what_a_rolling_spring_holds_at_separation_is_in_the_ledger() {
    let simulation = run(
        "Scene(format: 1, clock: (duration: 0.1, tick: 1e-4),
        contacts: Penalty(tangential: None, rolling: Spring(friction: 10)),
        materials: { \"m\": (stiffness: 1e4) },
        walls: [(name: \"floor\", left: (1, 0), right: (-1, 0), material: \"m\")],
        bodies: [(name: \"disc\", at: (0, 0.101), velocity: (0, -1), spin: 3, material: \"m\", atoms: Disc(radius: 0.1, mass: 1))])",
    );
    let energy = simulation.card().energy;
    assert!(simulation.bodies().velocity[0].y > 0.9, "it has parted");
    assert!(energy.friction > 1e-3, "{energy:?}");
    // Swings of 0.5 J along the normal and of the 0.0225 J of the spin.
    assert!(energy.residual.abs() < 1e-4 * 0.5225, "{energy:?}");
}

/// A disc that turns as prescribed turns one that lies on it, by rolling resistance alone: its work is what the other gains
/// and what is lost.
#[test]
fn the_work_of_what_turns_as_prescribed_is_booked() {
    let simulation = run("Scene(format: 1, clock: (duration: 0.05, tick: 1e-5), gravity: (0, -10),
        contacts: Penalty(tangential: None, rolling: Spring(friction: 0.2)),
        materials: { \"m\": (stiffness: 1e4) },
        bodies: [(name: \"roll\", at: (0, 0), kinematic: (spin: 5), material: \"m\", atoms: Disc(radius: 0.1)),
                 (name: \"disc\", at: (0, 0.198), material: \"m\", atoms: Disc(radius: 0.1, mass: 1))])");
    let energy = simulation.card().energy;
    assert!(energy.work > 1e-2, "{energy:?}");
    assert!(energy.residual.abs() < 1e-4 * energy.work, "{energy:?}");
}

/// Law: without friction against rolling a disc rolls as if there were no rolling law, to the last bit: a sweep may begin at zero.
#[test]
fn rolling_friction_of_zero_is_none() {
    for method in METHODS {
        let with = scene(method, 0.1, 0.0, 1.0);
        let without = with.replace("rolling: Spring(friction: 0.0)", "rolling: None");
        assert_ne!(with, without);
        let [with, without] = [with, without].map(|scene| {
            let mut simulation = load(&scene);
            run_to(&mut simulation, 0.01);
            simulation.card().hash
        });
        assert_eq!(with, without, "{method}");
    }
}
