//! Law: a block on a slope stays if `tan a <= mu`, with `mu` the mean of both coefficients. Otherwise it slides with `g
//! (sin a - mu cos a)`, and thrown uphill it comes back slower. On the flat it stops after `v^2/(2 mu g)` and stays.
//! Source: Coulomb 1785, any textbook; truth files F01, F02.
//!
//! The block is a row of four discs and stands as deep as the slope component of its weight presses it. Tolerances: on the
//! slope it is displaced by at most the elastic `mu N/k_t`, and then nothing moves, to the last bit. Slipping forces are
//! constant, so that the acceleration is right to the 1e-9 with which normal forces balance. Before the springs are
//! drawn out by `s = mu N/k_t` friction is missing: the block is faster then by up to `u = mu N/sqrt(k_t m)` (the work
//! `mu N s/2` that is missing), and its way longer by `u t`. Where friction begins it is missing for one tick more, and for
//! another one while the load shifts forward, as friction pitches the block.
//!
//! Wide blocks of 4 to 16 discs, whose contacts share the load unevenly, hold up to the static coefficient like narrow ones,
//! on slopes and under loads that begin suddenly. There the coefficients differ, so that what is let go slides away.
//!
//! Not tested: blocks that topple.

use jostle::problems::Truth;
use jostle::world::hash::state_hash;

use super::support::{METHODS, assert_near, assert_rest, load, run_to};

const GRAVITY: f64 = 9.81;
/// Of each disc in N/m.
const STIFFNESS: f64 = 1e8;
const TICK: f64 = 5e-5;
const FRICTION: f64 = 0.4;
const RADIUS: f64 = 0.05;

/// A block of 1 kg on a slope that falls to the right by `angle`, moving downhill with `speed` m/s.
fn scene(method: &str, angle: f64, speed: f64) -> String {
    let (sin, cos) = libm::sincos(angle);
    // Four discs carry it.
    let height = RADIUS - GRAVITY * cos / (4.0 * STIFFNESS);
    let (x, y) = (height * sin, height * cos);
    format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {TICK:?}, method: {method}), gravity: (0, -{GRAVITY:?}),
        materials: {{
            \"sled\": (stiffness: {STIFFNESS:?}, friction: 0.3, inelasticity: 0.3),
            \"slope\": (friction: 0.5, inelasticity: 0.3),
        }},
        walls: [(name: \"slope\", left: ({cos:?}, {:?}), right: (0, 0), material: \"slope\")],
        bodies: [(name: \"block\", at: ({x:?}, {y:?}), angle: {:?}, velocity: ({:?}, {:?}), material: \"sled\",
                  atoms: Picture(spacing: {:?}, mass: 0.25, rows: [\"####\"]))])",
        -sin,
        -angle,
        speed * cos,
        -speed * sin,
        2.0 * RADIUS
    )
}

/// Way down the slope in m and velocity in m/s.
fn state(simulation: &jostle::Simulation, angle: f64) -> (f64, f64) {
    let (sin, cos) = libm::sincos(angle);
    let down = glam::DVec2::new(cos, -sin);
    let bodies = simulation.bodies();
    (bodies.position[0].dot(down), bodies.velocity[0].dot(down))
}

/// What the springs and the first ticks let the block gain in speed before friction is full, in m/s.
fn gain(angle: f64) -> f64 {
    let friction = FRICTION * GRAVITY * libm::cos(angle);
    friction / (0.8 * 4.0 * STIFFNESS).sqrt() + 2.0 * friction * TICK
}

fn truth() -> Truth {
    Truth::read(include_str!("../../assets/truths/F01_incline_stick_slip.json"))
}

#[test]
fn below_the_friction_angle_a_block_stays_for_ever() {
    for method in METHODS {
        for degrees in [0.0_f64, 15.0, 21.7] {
            let angle = degrees.to_radians();
            let mut simulation = load(&scene(method, angle, 0.0));
            let elastic = FRICTION * GRAVITY * libm::cos(angle) / (4.0 * 0.8 * STIFFNESS);
            run_to(&mut simulation, 0.1);
            let hash = state_hash(simulation.bodies());
            let (way, _) = state(&simulation, angle);
            assert!(way.abs() <= elastic, "{method}, {degrees} deg: {way:e} > {elastic:e}");
            assert_rest(&format!("{method}, {degrees} deg"), &mut simulation, 0.2, 100.0);
            assert_eq!(state_hash(simulation.bodies()), hash, "{method}, {degrees} deg: drift in 100 s");
        }
    }
}

#[test]
fn above_the_friction_angle_it_slides_with_the_exact_acceleration() {
    for method in METHODS {
        for degrees in [21.9_f64, 35.0] {
            let angle = degrees.to_radians();
            let exact = truth().number(&format!("acceleration at {degrees:.0$} deg", usize::from(degrees < 30.0)));
            let ways = truth().numbers(&format!("displacement at {degrees:.0$} deg", usize::from(degrees < 30.0)));
            let mut simulation = load(&scene(method, angle, 0.0));
            let mut speeds = Vec::new();
            for (time, exact) in [0.5, 1.0, 2.0].into_iter().zip(ways) {
                run_to(&mut simulation, time);
                let (way, speed) = state(&simulation, angle);
                speeds.push(speed);
                // Semi-implicit Euler is ahead by half a tick of its speed.
                assert_near("way", way, exact, gain(angle) * time + speed * TICK);
            }
            println!("{method}, {degrees} deg: acceleration off by {:e}", speeds[2] - speeds[1] - exact);
            assert_near("acceleration", speeds[2] - speeds[1], exact, 1e-9 * GRAVITY);
        }
    }
}

/// Whether a block that is let go on a slope of `angle` still stands after a tenth of a second.
fn holds(method: &str, angle: f64) -> bool {
    let mut simulation = load(&scene(method, angle, 0.0));
    run_to(&mut simulation, 0.1);
    simulation.bodies().velocity[0] == glam::DVec2::ZERO
}

#[test]
fn the_friction_angle_is_located() {
    let exact = truth().number("critical angle");
    for method in METHODS {
        let (mut low, mut high) = (exact - 0.05, exact + 0.06);
        assert!(holds(method, low) && !holds(method, high));
        while high - low > 1e-6 {
            let middle = 0.5 * (low + high);
            if holds(method, middle) { low = middle } else { high = middle }
        }
        println!("{method}: threshold off by {:e} rad", 0.5 * (low + high) - exact);
        assert_near("friction angle", 0.5 * (low + high), exact, 1e-4);
    }
}

/// At the top it turns within two ticks; both ways friction is missing as above, and `2 s` of work more at the turn.
#[test]
fn thrown_uphill_it_comes_back_slower() {
    let angle = 30.0_f64.to_radians();
    let turning = truth().numbers("thrown uphill: turning time, distance");
    let (returns, left) = (truth().number("thrown uphill: return time"), truth().number("thrown uphill: return speed"));
    for method in METHODS {
        let mut simulation = load(&scene(method, angle, -4.0));
        run_to(&mut simulation, turning[0]);
        let (way, speed) = state(&simulation, angle);
        let missing = gain(angle) + 2.0 * GRAVITY * TICK;
        assert_near("speed at the turn", speed, 0.0, missing);
        assert_near("distance", -way, turning[1], missing * turning[0] + 4.0 * TICK);
        run_to(&mut simulation, returns);
        let (way, speed) = state(&simulation, angle);
        println!("{method}: way {way:e}, speed off by {:e}", speed - left);
        assert_near("return speed", speed, left, 3.0 * missing);
        assert_near("return", way, 0.0, 3.0 * missing * returns + 4.0 * TICK);
    }
}

/// Until friction is full it is missing for `s/v`, and during two ticks.
#[test]
fn a_sliding_block_stops_and_stays() {
    let truth = Truth::read(include_str!("../../assets/truths/F02_sliding_stop.json"));
    let states = truth.numbers("x,v");
    for method in METHODS {
        let mut simulation = load(&scene(method, 0.0, 3.0));
        let stretch = FRICTION * GRAVITY / (4.0 * 0.8 * STIFFNESS);
        let missing = FRICTION * GRAVITY * (stretch / 3.0 + 2.0 * TICK);
        for (time, exact) in [0.2, 0.5, 0.8, 5.0].into_iter().zip(states.chunks(2)) {
            run_to(&mut simulation, time);
            let (way, speed) = state(&simulation, 0.0);
            assert_near("way", way, exact[0], missing * time.min(0.8) + 3.0 * TICK);
            if exact[1] == 0.0 {
                assert_eq!(speed, 0.0, "it stands");
            } else {
                assert_near("speed", speed, exact[1], missing);
            }
        }
        assert_near("stopping distance", state(&simulation, 0.0).0, truth.number("stopping distance"), 1e-3);
        assert_rest("block", &mut simulation, 5.0, 5.0);
    }
}

/// A row of `count` discs of 1 kg in all that stands on a wall which falls by `angle`; static 0.6, dynamic 0.3. The ticks are
/// a twentieth of what a contact lasts or less.
fn wide(method: &str, count: usize, angle: f64, forces: &str) -> String {
    let stiffness = 1e6;
    let (sin, cos) = libm::sincos(angle);
    let height = RADIUS - GRAVITY * cos / (count as f64 * stiffness);
    let (x, y, row) = (height * sin, height * cos, "#".repeat(count));
    format!(
        "Scene(format: 1, clock: (duration: 1000, tick: 2e-5, method: {method}), gravity: (0, -{GRAVITY:?}), {forces}
        materials: {{ \"m\": (stiffness: {stiffness:?}, friction: (static: 0.6, dynamic: 0.3), inelasticity: 0.3) }},
        walls: [(name: \"slope\", left: ({cos:?}, {:?}), right: (0, 0), material: \"m\")],
        bodies: [(name: \"block\", at: ({x:?}, {y:?}), angle: {:?}, material: \"m\",
                  atoms: Picture(spacing: 0.1, mass: {:?}, rows: [\"{row}\"]))])",
        -sin,
        -angle,
        1.0 / count as f64
    )
}

#[test]
fn wide_blocks_hold_up_to_the_static_coefficient() {
    for method in METHODS {
        for count in [4, 8, 16, 40] {
            for (slope, stays) in [(0.59, true), (0.61, false)] {
                let mut simulation = load(&wide(method, count, libm::atan(slope), ""));
                run_to(&mut simulation, 0.2);
                let stands = simulation.bodies().velocity[0] == glam::DVec2::ZERO;
                assert_eq!(stands, stays, "{method}, {count} discs, tan {slope}");
            }
        }
    }
}

/// What it moves before it is caught: while the velocity of one tick, `F dt/m`, is braked by what is left of the cone.
#[test]
fn a_sudden_load_is_held_up_to_the_static_coefficient() {
    for method in METHODS {
        for count in [4, 8, 16, 40] {
            for (share, stays) in [(0.6, true), (0.95, true), (1.05, false)] {
                let load_of = 0.6 * GRAVITY * share;
                let forces = format!("forces: [Thrust(of: \"block\", force: ({load_of:?}, 0), from: 0.1)],");
                let mut simulation = load(&wide(method, count, 0.0, &forces));
                run_to(&mut simulation, 0.3);
                let bodies = simulation.bodies();
                let caught = 0.5 * (load_of * 2e-5).powi(2) / (0.6 * GRAVITY * (1.0 - share)) + 2.0 * load_of * 4e-10;
                if stays {
                    assert_eq!(bodies.velocity[0], glam::DVec2::ZERO, "{method}, {count} discs, {share} of the limit");
                    assert!(bodies.position[0].x.abs() <= caught, "{}: {caught:e}", bodies.position[0].x);
                } else {
                    assert!(bodies.velocity[0].x > 0.5 * (load_of - 0.3 * GRAVITY) * 0.2, "{method}, {count} discs");
                }
            }
        }
    }
}
