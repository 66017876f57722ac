//! Laws that hold for every scene: no position, direction, handedness or state of rest is preferred; actio is reactio.
//! Contacts push and never pull, and act along the surface only within the cone. Source: mechanics; McNamara,
//! Garcia-Rojo and Herrmann 2008 for contacts that turn as one rigid body.
//!
//! Scenes are drawn by chance from fixed seeds: three to five discs and clumps of two discs, with friction, inelasticity and
//! spin, that run into each other. Tolerances: moved, boosted, turned or renumbered, numbers are rounded otherwise, in each
//! of `n` ticks by a few half ulps of the greatest of them; the scene itself magnifies that by a condition, which is measured
//! with twins of the scene disturbed by 1e-9. So `8 n eps` times the condition times the size of the scene is allowed. A
//! mirror image has the same bits, and so has a scene of discs turned by a quarter: all sums and products are the same but
//! for signs. (Clumps are not: the cosine of an angle and a quarter is rounded otherwise.) Renumbering changes the order
//! of sums (of the forces on a body, and of how far both sides of a contact rolled), so that it counts as rounding.
//!
//! Not tested: walls, which have a place of their own, in translations and boosts.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

use glam::DVec2;
use jostle::{Simulation, SimulationExt};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::support::{assert_near, contact_forces, kinetic, load, momenta, run_to};

/// Everywhere in these scenes.
const TICK: f64 = 5e-4;
const TICKS: u64 = 600;
const STIFFNESS: f64 = 1e4;
/// The greatest number in them: metres, metres per second, or radians.
const SIZE: f64 = 10.0;

fn settings(seed: u64, cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(seed), failure_persistence: None, ..ProptestConfig::default() }
}

#[derive(Clone, Debug)]
struct Drawn {
    bodies: Vec<DrawnBody>,
    friction: f64,
    inelasticity: f64,
    ratio: f64,
}

#[derive(Clone, Debug)]
struct DrawnBody {
    position: DVec2,
    velocity: DVec2,
    angle: f64,
    spin: f64,
    radius: f64,
    mass: f64,
    clump: bool,
    mirrored: bool,
}

/// Jitter of a place in m, speed in m/s, spin in rad/s, radius in m, mass in kg, whether it is a clump.
type Numbers = (f64, f64, f64, f64, f64, f64, bool);

/// Bodies on a circle that fly to its middle.
fn drawn(clumps: bool) -> impl Strategy<Value = Drawn> {
    drawn_with(clumps, 0.6)
}

fn drawn_with(clumps: bool, inelasticity: f64) -> impl Strategy<Value = Drawn> {
    let body =
        (-0.05..0.05_f64, -0.05..0.05_f64, 1.5..3.0_f64, -5.0..5.0_f64, 0.08..0.14_f64, 0.5..2.0_f64, any::<bool>());
    let bodies = prop::collection::vec(body, 3..=5);
    (bodies, 0.0..0.8_f64, 0.0..1.0_f64, 0.3..1.5_f64).prop_map(move |(bodies, friction, lossy, ratio)| {
        let count = bodies.len() as f64;
        let place = |(number, body): (usize, Numbers)| {
            let (x, y, speed, spin, radius, mass, clump) = body;
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * number as f64 / count + 0.3);
            let out = DVec2::new(cos, sin);
            DrawnBody {
                position: out * 0.45 + DVec2::new(x, y),
                velocity: out * -speed,
                angle: spin,
                spin,
                radius,
                mass,
                clump: clump && clumps,
                mirrored: false,
            }
        };
        let bodies = bodies.into_iter().enumerate().map(place).collect();
        Drawn { bodies, friction, inelasticity: lossy * inelasticity, ratio }
    })
}

impl Drawn {
    fn map(&self, change: impl Fn(&mut DrawnBody)) -> Self {
        let mut other = self.clone();
        other.bodies.iter_mut().for_each(change);
        other
    }

    /// Runs the scene with its bodies in some order; returns their last positions, velocities, angles and spins in the order
    /// in which they were drawn.
    fn outcome(&self, order: &[usize]) -> Vec<State> {
        let simulation = self.run(order, TICKS);
        let bodies = simulation.bodies();
        let place = |number| order.iter().position(|&ordered| ordered == number).unwrap_or_default();
        (0..bodies.len())
            .map(|number| {
                let body = place(number);
                State {
                    position: bodies.position[body],
                    velocity: bodies.velocity[body],
                    angle: bodies.angle[body],
                    spin: bodies.spin[body],
                }
            })
            .collect()
    }

    fn in_order(&self) -> Vec<State> {
        self.outcome(&(0..self.bodies.len()).collect::<Vec<_>>())
    }

    fn run(&self, order: &[usize], ticks: u64) -> Simulation {
        let mut bodies = String::new();
        for &number in order {
            let DrawnBody { position, velocity, angle, spin, radius, mass, clump, mirrored } = &self.bodies[number];
            let atoms = if *clump {
                let x = if *mirrored { -0.09 } else { 0.09 };
                format!(
                    "List([(at: (0, 0), radius: {radius:?}, mass: {mass:?}), (at: ({x:?}, 0.04), radius: 0.07, mass: 0.3)])"
                )
            } else {
                format!("Disc(radius: {radius:?}, mass: {mass:?})")
            };
            let _ = write!(
                bodies,
                "(name: \"body_{number}\", at: ({:?}, {:?}), velocity: ({:?}, {:?}), angle: {angle:?}, spin: {spin:?},
                  material: \"m\", atoms: {atoms}),",
                position.x, position.y, velocity.x, velocity.y
            );
        }
        let Self { friction, inelasticity, ratio, .. } = self;
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 10, tick: {TICK:?}, method: VelocityVerlet),
            contacts: Penalty(tangential: Spring(ratio: {ratio:?})),
            materials: {{ \"m\": (stiffness: {STIFFNESS:?}, friction: {friction:?}, inelasticity: {inelasticity:?}) }},
            bodies: [{bodies}])"
        ));
        simulation.run_to_tick(ticks).expect("numbers stay finite");
        simulation
    }

    /// How much the scene magnifies a small disturbance of places and velocities.
    fn condition(&self, reference: &[State]) -> f64 {
        let small = 1e-9;
        let disturbed = [DVec2::X, DVec2::Y].map(|direction| {
            let mut twin = self.clone();
            for (number, body) in twin.bodies.iter_mut().enumerate() {
                let sign = if number % 2 == 0 { 1.0 } else { -1.0 };
                body.position += direction * (sign * small);
                body.velocity += direction.perp() * (sign * small);
            }
            difference(reference, &twin.in_order()) / small
        });
        disturbed[0].max(disturbed[1]).max(1.0)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct State {
    position: DVec2,
    velocity: DVec2,
    angle: f64,
    spin: f64,
}

impl State {
    fn minus(&self, other: &Self) -> f64 {
        let angles = (self.angle - other.angle).abs().max((self.spin - other.spin).abs());
        (self.position - other.position).length().max((self.velocity - other.velocity).length()).max(angles)
    }
}

fn difference(a: &[State], b: &[State]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.minus(b)).fold(0.0, f64::max)
}

/// Fails if two outcomes differ by more than rounding, as the scene magnifies it.
fn same_but_for_rounding(scene: &Drawn, reference: &[State], found: &[State], size: f64) -> Result<(), TestCaseError> {
    let off = difference(reference, found);
    let condition = scene.condition(reference);
    let allowed = 8.0 * TICKS as f64 * f64::EPSILON * condition * size;
    prop_assert!(off <= allowed, "off by {off:e} > {allowed:e}, condition {condition:e}");
    Ok(())
}

/// Fails if a scene that flies along as a whole does not do the same.
fn boosted(scene: &Drawn, boost: DVec2) -> Result<(), TestCaseError> {
    let reference = scene.in_order();
    let mut found = scene.map(|body| body.velocity += boost).in_order();
    for state in &mut found {
        state.velocity -= boost;
        state.position -= boost * (TICKS as f64 * TICK);
    }
    same_but_for_rounding(scene, &reference, &found, SIZE + 100.0)
}

fn turned(vector: DVec2, angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos, sin).rotate(vector)
}

proptest! {
    #![proptest_config(settings(1, 32))]

    #[test]
    fn space_has_no_place(scene in drawn(true), x in -100.0..100.0_f64, y in -100.0..100.0_f64) {
        let (reference, offset) = (scene.in_order(), DVec2::new(x, y));
        let mut found = scene.map(|body| body.position += offset).in_order();
        found.iter_mut().for_each(|state| state.position -= offset);
        same_but_for_rounding(&scene, &reference, &found, SIZE + 100.0)?;
    }

    #[test]
    fn space_has_no_direction(scene in drawn(true), angle in -3.0..3.0_f64) {
        let reference = scene.in_order();
        let mut found = scene.map(|body| {
            body.position = turned(body.position, angle);
            body.velocity = turned(body.velocity, angle);
            body.angle += angle;
        }).in_order();
        for state in &mut found {
            state.position = turned(state.position, -angle);
            state.velocity = turned(state.velocity, -angle);
            state.angle -= angle;
        }
        same_but_for_rounding(&scene, &reference, &found, SIZE)?;
    }

    #[test]
    fn a_quarter_turn_of_discs_keeps_every_bit(scene in drawn(false)) {
        let reference = scene.in_order();
        let found = scene.map(|body| {
            body.position = body.position.perp();
            body.velocity = body.velocity.perp();
        }).in_order();
        for (reference, found) in reference.iter().zip(&found) {
            prop_assert_eq!(reference.position.perp(), found.position);
            prop_assert_eq!(reference.velocity.perp(), found.velocity);
            prop_assert_eq!((reference.angle, reference.spin), (found.angle, found.spin));
        }
    }

    #[test]
    fn a_quarter_turn_of_clumps_is_rounding(scene in drawn(true)) {
        let reference = scene.in_order();
        let mut found = scene.map(|body| {
            body.position = body.position.perp();
            body.velocity = body.velocity.perp();
            body.angle += FRAC_PI_2;
        }).in_order();
        for state in &mut found {
            state.position = -state.position.perp();
            state.velocity = -state.velocity.perp();
            state.angle -= FRAC_PI_2;
        }
        same_but_for_rounding(&scene, &reference, &found, SIZE)?;
    }

    #[test]
    fn a_mirror_image_has_the_same_bits(scene in drawn(true)) {
        let mirror = DVec2::new(-1.0, 1.0);
        let reference = scene.in_order();
        let found = scene.map(|body| {
            body.position *= mirror;
            body.velocity *= mirror;
            body.angle = -body.angle;
            body.spin = -body.spin;
            body.mirrored = true;
        }).in_order();
        for (reference, found) in reference.iter().zip(&found) {
            prop_assert_eq!(reference.position * mirror, found.position);
            prop_assert_eq!(reference.velocity * mirror, found.velocity);
            prop_assert_eq!((-reference.angle, -reference.spin), (found.angle, found.spin));
        }
    }

    #[test]
    fn no_state_of_rest_is_preferred(scene in drawn(true), x in -100.0..100.0_f64, y in -100.0..100.0_f64) {
        boosted(&scene, DVec2::new(x, y))?;
    }

    #[test]
    fn elastic_contacts_prefer_no_state_of_rest(
        scene in drawn_with(true, 0.0),
        x in -100.0..100.0_f64,
        y in -100.0..100.0_f64,
    ) {
        boosted(&scene, DVec2::new(x, y))?;
    }

    #[test]
    fn numbering_is_rounding(scene in drawn(true), turn in 1_usize..5) {
        let reference = scene.in_order();
        let mut order: Vec<usize> = (0..scene.bodies.len()).rev().collect();
        order.rotate_left(turn % scene.bodies.len());
        same_but_for_rounding(&scene, &reference, &scene.outcome(&order), SIZE)?;
    }

    /// Nothing comes from outside: momentum and angular momentum stay, to rounding; and impacts create no energy: kinks inside
    /// ticks may give shares `(w dt)^2/2` at each of up to a dozen contacts (see `oblique`).
    #[test]
    fn every_force_has_its_opposite(scene in drawn(true)) {
        let order: Vec<usize> = (0..scene.bodies.len()).collect();
        let before = scene.run(&order, 0);
        let after = scene.run(&order, TICKS);
        let ((momentum, turning), (scale, turning_scale)) = momenta(before.bodies());
        let ((momentum_after, turning_after), _) = momenta(after.bodies());
        let allowed = 4.0 * TICKS as f64 * f64::EPSILON;
        prop_assert!((momentum_after - momentum).length() <= allowed * scale);
        prop_assert!((turning_after - turning).abs() <= allowed * (turning_scale + scale));
        let energy = after.card().energy;
        let share = 12.0 * (STIFFNESS / 0.5).sqrt().powi(2) * TICK * TICK / 2.0;
        let start = kinetic(before.bodies());
        prop_assert!(energy.kinetic + energy.elastic <= start * (1.0 + share), "{energy:?} of {start}");
        prop_assert!(energy.friction >= 0.0 && energy.inelasticity >= -share * start, "{energy:?}");
    }
}

proptest! {
    #![proptest_config(settings(2, 64))]

    /// The force on a disc, tick by tick while it strikes another or a wall: it pushes, and its tangential part is within the
    /// cone of the static coefficient, to rounding of its two parts.
    #[test]
    fn contacts_push_and_stay_within_the_cone(
        offset in -0.19..0.19_f64,
        speed in 0.5..4.0_f64,
        spins in (-30.0..30.0_f64, -30.0..30.0_f64),
        coefficients in (0.05..1.0_f64, 0.3..1.0_f64),
        inelasticity in 0.0..0.7_f64,
        ratio in 0.2..2.0_f64,
        wall in any::<bool>(),
    ) {
        let (sticking, sliding) = (coefficients.0, coefficients.0 * coefficients.1);
        let (floor, other) = if wall {
            ("walls: [(name: \"wall\", left: (0, -0.1), right: (0, 0.1), material: \"m\")],", String::new())
        } else {
            let other = format!(
                "(name: \"second\", at: (0, 0), spin: {:?}, material: \"m\", atoms: Disc(radius: 0.1, mass: 2)),",
                spins.1
            );
            ("", other)
        };
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 10, tick: 2e-4, method: VelocityVerlet), {floor}
            contacts: Penalty(tangential: Spring(ratio: {ratio:?})), sensors: [ContactForce(on: \"first\")],
            materials: {{ \"m\": (stiffness: {STIFFNESS:?}, friction: (static: {sticking:?}, dynamic: {sliding:?}),
                                  inelasticity: {inelasticity:?}) }},
            bodies: [(name: \"first\", at: (0.21, {offset:?}), velocity: (-{speed:?}, {:?}), spin: {:?}, material: \"m\",
                      atoms: Disc(radius: 0.1, mass: 1)), {other}])",
            if wall { 10.0 * offset } else { 0.0 },
            spins.0
        ));
        let (mut touched, mut after) = (0, 0);
        while simulation.clock().ticks < 5000 && after < 10 {
            simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
            let bodies = simulation.bodies();
            let force = contact_forces(&simulation).on_body[0];
            let apart = if wall { DVec2::X } else { bodies.position[0] - bodies.position[1] };
            let normal = apart.normalize();
            if force == DVec2::ZERO {
                after += u32::from(touched > 0);
                continue;
            }
            touched += 1;
            let (pushes, pulls) = (force.dot(normal), force.perp_dot(normal).abs());
            prop_assert!(pushes > 0.0, "it pulls with {pushes:e} N");
            let rounding = 8.0 * f64::EPSILON * force.length();
            prop_assert!(pulls <= sticking * pushes + rounding, "{pulls} N along, {pushes} N across, mu {sticking}");
        }
        prop_assert!(touched > 10, "they should touch, {touched} ticks");
    }
}

/// A disc on the floor is pushed along by less than friction holds, and sways on its tangential spring; a runner far away
/// makes the lists of pairs anew again and again. To the disc that makes no difference of a bit.
#[test]
fn history_survives_new_lists() {
    let scene = |runner: &str| {
        load(&format!(
            "Scene(format: 1, clock: (duration: 10, tick: 1e-4, method: VelocityVerlet), gravity: (0, -10),
            materials: {{ \"m\": (stiffness: 1e4, friction: 0.5) }},
            forces: [Thrust(of: \"disc\", force: (2, 0))],
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"disc\", at: (0, 0.099), inertia: 1e9, material: \"m\", atoms: Disc(radius: 0.1, mass: 1)),
                     {runner}])"
        ))
    };
    let mut alone = scene("");
    let mut beside = scene(
        "(name: \"runner\", at: (10, 30), velocity: (300, 0), atoms: Disc(radius: 0.1, mass: 1), material: \"m\"),",
    );
    let version = |simulation: &Simulation| simulation.state().pairs().unwrap().version;
    let mut lists = version(&beside);
    let mut moved = 0.0_f64;
    for hundreds in 1..=50 {
        alone.run_to_tick(100 * hundreds).expect("numbers stay finite");
        beside.run_to_tick(100 * hundreds).expect("numbers stay finite");
        assert_eq!(alone.bodies().position[0], beside.bodies().position[0], "after {hundreds} hundred ticks");
        assert_eq!(alone.bodies().velocity[0], beside.bodies().velocity[0], "after {hundreds} hundred ticks");
        moved = moved.max(alone.bodies().position[0].x);
    }
    lists = version(&beside) - lists;
    assert!(lists > 20 + version(&alone), "the runner should make new lists: {lists}");
    // It sways by up to twice the 2 N over the spring's 8 kN/m, and has not crept.
    assert!(moved > 1e-4 && moved <= 2.0 * 2.0 / 8e3 * (1.0 + 1e-3), "moved by {moved}");
}

/// Two discs that hang together by attraction and turn about each other like one rigid body do not wind up the spring
/// between them. The engine's displacement along the contact is right to second order, so what is left over in a tick is of
/// the third order in `w dt`, in a turn of the second.
#[test]
fn a_pair_that_turns_as_one_body_has_no_tangential_force() {
    let (radius, overlap, rate, stiffness) = (0.5, 1e-3, 3.0_f64, 1e4);
    let distance: f64 = 2.0 * radius - overlap;
    let constant = (stiffness * overlap + rate * rate * distance / 2.0) * distance * distance;
    for tick in [1e-3, 1e-4] {
        let (x, speed) = (distance / 2.0, rate * distance / 2.0);
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 100, tick: {tick:?}, method: VelocityVerlet),
            forces: [Attraction(constant: {constant:?})], sensors: [ContactForce(on: \"left\")],
            materials: {{ \"m\": (stiffness: {:?}, friction: 0.5) }}, bodies: [
                (name: \"left\", at: (-{x:?}, 0), velocity: (0, -{speed:?}), spin: {rate:?}, material: \"m\",
                 atoms: Disc(radius: {radius:?}, mass: 1)),
                (name: \"right\", at: ({x:?}, 0), velocity: (0, {speed:?}), spin: {rate:?}, material: \"m\",
                 atoms: Disc(radius: {radius:?}, mass: 1)),
            ])",
            2.0 * stiffness
        ));
        let mut greatest = 0.0_f64;
        for part in 1..=100 {
            run_to(&mut simulation, 0.2 * f64::from(part));
            let bodies = simulation.bodies();
            let normal = (bodies.position[1] - bodies.position[0]).normalize();
            greatest = greatest.max(contact_forces(&simulation).on_body[0].perp_dot(normal).abs());
        }
        let bodies = simulation.bodies();
        println!(
            "tick {tick}: tangential {greatest:e} N of {} N; spin off by {:e}",
            stiffness * overlap,
            bodies.spin[0] - rate
        );
        assert_eq!(simulation.card().energy.friction, 0.0, "nothing slips");
        let second_order = (rate * tick).powi(2);
        assert_near("spin", bodies.spin[0] / rate, 1.0, second_order);
        assert_near("tangential force", greatest / (0.8 * stiffness * radius), 0.0, second_order);
    }
}
