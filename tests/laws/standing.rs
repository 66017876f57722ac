//! Law: a standing body stays, and only if the contact laws hold it. At rest the normal force balances the load, within
//! `[1 - mu_e, 1 + mu_e] k d`. The tangential force is within the cone of the static coefficient (Coulomb 1785;
//! set-valued force laws: Moreau 1988). Beyond, a contact slips with the dynamic coefficient, and the body has the
//! acceleration that Newton's second law gives it. Energy lost to friction is never given back.
//!
//! A disc so heavy to turn that it hardly rolls stands on a slope: gravity is tilted, not the floor. (Friction turns it
//! by some 1e-10 rad/s2 all the same: nothing balances that, so it is not at rest.)
//!
//! Tolerances: a spring that a force `F` draws out without loss reaches twice its rest, `2 F/k_t`; forces are constant
//! while a body slips, so that velocities are sums of equal terms, rounded once per tick.
//!
//! Not tested: bodies with several contacts, piles, rolling.

use jostle::{Simulation, SimulationExt};

use super::support::{METHODS, assert_near, load};

const STIFFNESS: f64 = 1e4;
const TANGENTIAL: f64 = 0.8 * STIFFNESS;
const GRAVITY: f64 = 10.0;
const RADIUS: f64 = 0.1;
const TICK: f64 = 1e-3;
/// How deep the weight of 1 kg presses the disc in.
const SUNK: f64 = GRAVITY / STIFFNESS;

/// What differs from scene to scene.
struct Slope<'a> {
    method: &'a str,
    inelasticity: f64,
    friction: &'a str,
    /// Force along the slope, as a share of the normal one.
    tangent: f64,
    overlap: f64,
    more: &'a str,
    bodies: &'a str,
}

impl Slope<'_> {
    fn load(&self) -> Simulation {
        let Slope { method, inelasticity, friction, tangent, overlap, more, bodies } = self;
        let (pull, height) = (tangent * GRAVITY, RADIUS - overlap);
        load(&format!(
            "Scene(format: 1, clock: (duration: 100, tick: {TICK:?}, method: {method}), gravity: ({pull:?}, -{GRAVITY:?}),
            materials: {{ \"stone\": (stiffness: {STIFFNESS:?}, friction: {friction}, inelasticity: {inelasticity:?}) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"stone\")], {more}
            bodies: [(name: \"disc\", at: (0, {height:?}), material: \"stone\", inertia: 1e9,
                      atoms: Disc(radius: {RADIUS:?}, mass: 1)), {bodies}])"
        ))
    }
}

const PLAIN: Slope = Slope {
    method: "VelocityVerlet",
    inelasticity: 0.3,
    friction: "0.5",
    tangent: 0.0,
    overlap: SUNK,
    more: "",
    bodies: "",
};

fn run_to(simulation: &mut Simulation, time: f64) {
    simulation.run_to_tick((time / TICK).round() as u64).expect("numbers stay finite");
}

/// Wherever it begins, it ends where the band of the law allows its weight, with a velocity that is exactly zero.
#[test]
fn a_disc_comes_to_rest_where_the_law_holds_its_weight() {
    for method in METHODS {
        for (inelasticity, share) in [(0.3, 0.0), (0.3, 0.1), (0.3, 0.76), (0.3, 1.4), (0.3, 3.0), (0.7, 0.2)] {
            let mut simulation = Slope { method, inelasticity, overlap: share * SUNK, ..PLAIN }.load();
            run_to(&mut simulation, 20.0);
            let bodies = simulation.bodies();
            let overlap = RADIUS - bodies.position[0].y;
            let band = [1.0 - inelasticity, 1.0 + inelasticity].map(|factor| factor * STIFFNESS * overlap / GRAVITY);
            let what = format!("{method}, mu_e {inelasticity}, from {share}: {band:?}, {}", bodies.velocity[0]);
            // The overlap is a difference of numbers of the size of the radius.
            let rounding = 4.0 * f64::EPSILON * RADIUS / SUNK;
            assert!(band[0] <= 1.0 + rounding && band[1] >= 1.0 - rounding, "{what}");
            assert_eq!(bodies.velocity[0], glam::DVec2::ZERO, "{what}");
        }
    }
}

/// Below the static coefficient it stays within the elastic offset, for ever, also when lists of pairs are made anew
/// again and again because another body flies past far away.
#[test]
fn a_disc_on_a_slope_stays_within_its_elastic_offset() {
    let flyer = "(name: \"flyer\", at: (0, 50), velocity: (0, 300), collides: false, atoms: Disc(radius: 0.01)),
                 (name: \"comet\", at: (0, 60), velocity: (40, 300), atoms: Disc(radius: 0.2)),";
    for method in METHODS {
        for inelasticity in [0.0, 0.3] {
            for bodies in ["", flyer] {
                for way in [1.0, -1.0] {
                    // Twice the pull is above the dynamic coefficient, and below the static one.
                    let tangent = way * 0.2;
                    let friction = "(static: 0.5, dynamic: 0.3)";
                    let mut simulation = Slope { method, inelasticity, friction, tangent, bodies, ..PLAIN }.load();
                    let bound = 2.0 * 0.2 * GRAVITY / TANGENTIAL;
                    for second in 1..=10 {
                        run_to(&mut simulation, f64::from(second));
                        let offset = simulation.bodies().position[0].x * way;
                        // The spring follows to second order in the tick: w^2 dt^2 = 0.008 of itself.
                        assert!((-0.01 * bound..=1.01 * bound).contains(&offset), "{method}: {offset:e} of {bound:e}");
                    }
                }
            }
        }
    }
}

/// Above the dynamic coefficient what slips goes on slipping, with the acceleration of Newton and Coulomb.
#[test]
fn a_disc_on_a_steep_slope_slides_with_the_acceleration_of_coulomb() {
    for method in METHODS {
        for inelasticity in [0.0, 0.3] {
            for (friction, dynamic) in [("0.3", 0.3), ("(static: 0.35, dynamic: 0.2)", 0.2)] {
                let mut simulation = Slope { method, inelasticity, friction, tangent: 0.4, ..PLAIN }.load();
                run_to(&mut simulation, 1.0);
                let before = simulation.bodies().velocity[0].x;
                run_to(&mut simulation, 2.0);
                let gained = simulation.bodies().velocity[0].x - before;
                // A thousand equal terms, each rounded at a velocity of up to 4 m/s.
                let rounding = 1000.0 * f64::EPSILON * 4.0;
                let what = format!("{method}, mu_e {inelasticity}, {friction}: gained");
                assert_near(&what, gained, (0.4 - dynamic) * GRAVITY, rounding);
            }
        }
    }
}

/// A load that grows beyond the cone while the disc stands sets it moving, as Newton and Coulomb say; and friction
/// takes energy at each tick, or none.
#[test]
fn a_disc_at_rest_gives_way_to_a_new_load() {
    for method in METHODS {
        for (inelasticity, tangent) in [(0.0, -0.2), (0.3, -0.2), (0.0, 0.0), (0.3, 0.0)] {
            let more = "forces: [Thrust(of: \"disc\", force: (8, 0), from: 2)],";
            let friction = "(static: 0.5, dynamic: 0.3)";
            let mut simulation = Slope { method, inelasticity, friction, tangent, more, ..PLAIN }.load();
            let mut lost = 0.0;
            for tick in 1..=4000 {
                simulation.run_to_tick(tick).expect("numbers stay finite");
                let now = simulation.card().energy.friction;
                // Sums of a few terms of at most the energy of the spring at its limit.
                let rounding = 1e-12 * (0.5 * GRAVITY).powi(2) / TANGENTIAL;
                assert!(
                    now >= lost - rounding,
                    "{method}, mu_e {inelasticity}, {tangent}, tick {tick}: {lost:e} to {now:e}"
                );
                lost = now;
            }
            let found = simulation.bodies().velocity[0].x;
            let acceleration = (0.8 + tangent - 0.3) * GRAVITY;
            // It moves through the elastic offset first, from -2 F/k_t at most to slip at the static limit: on that way
            // it is slowed by between -0.5 and 0.5 in place of 0.3 of its weight, for the time it takes from rest with
            // the least that is left of the load.
            let way = (2.0 * 0.2 + 0.5) * GRAVITY / TANGENTIAL;
            let time = (2.0 * way / (0.1 * GRAVITY)).sqrt() + TICK;
            let what = format!("{method}, mu_e {inelasticity}, pull {tangent}: speed");
            assert_near(&what, found, acceleration * 2.0, 0.8 * GRAVITY * time);
        }
    }
}

/// A load that comes up slowly, from tick to tick, is noticed too: a heavy body flies past and pulls a bar that
/// stands on two feet. Its pull leaves the cone in the fourth second; from then on the bar slides. Only that it slides is tested,
/// and with half of the speed by Coulomb at least: the sum of `(pull - 0.5 (weight - lift)) dt` while that is positive.
#[test]
fn a_bar_at_rest_gives_way_to_a_load_that_grows() {
    let (strength, at, velocity) = (2000.0, glam::DVec2::new(50.0, 0.1), glam::DVec2::new(-10.0, 20.0));
    for method in METHODS {
        let height = RADIUS - SUNK / 2.0;
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 100, tick: {TICK:?}, method: {method}), gravity: (0, -{GRAVITY:?}),
            materials: {{ \"stone\": (stiffness: {STIFFNESS:?}, friction: 0.5, inelasticity: 0.3) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"stone\")],
            forces: [Attraction(constant: 2e-3)],
            bodies: [(name: \"bar\", at: (0, {height:?}), material: \"stone\", atoms: List([
                (at: (-1, 0), radius: {RADIUS:?}, mass: 0.5), (at: (1, 0), radius: {RADIUS:?}, mass: 0.5)])),
            (name: \"sun\", at: ({:?}, {:?}), velocity: ({:?}, {:?}), collides: false,
             atoms: Disc(radius: 1, mass: 1e6))])",
            at.x, at.y, velocity.x, velocity.y
        ));
        run_to(&mut simulation, 4.0);
        let slid: f64 = (0..4000)
            .map(|tick| {
                let time = f64::from(tick) * TICK;
                let away =
                    at + velocity * time - glam::DVec2::Y * (0.5 * GRAVITY * time * time) - RADIUS * glam::DVec2::Y;
                let pull = away * (strength / away.length().powi(3));
                (pull.x - 0.5 * (GRAVITY - pull.y)).max(0.0) * TICK
            })
            .sum();
        let found = simulation.bodies().velocity[0].x;
        assert!(slid > 1.0 && found > 0.5 * slid, "{method}: {found} m/s, by Coulomb {slid} m/s");
    }
}
