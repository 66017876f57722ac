//! Law: physics does not know metres: with lengths times `s`, times times `sqrt(s)` and stiffness over `s` everything is the
//! same under the same gravity; nor does it know where the origin is. Source: dimensional analysis; truth file H03.
//!
//! Tolerances: scaled by a power of four no number is rounded otherwise, so all bits are the same: an absolute tolerance
//! anywhere in the contact laws would show. By other factors: rounding of `n` ticks times what a fall and a contact make
//! of it. Far away, at `X`, overlaps are rounded to an ulp of `X`: forces are off by up to `k ulp(X)/2`, velocities by that
//! times the contact time over the mass.
//!
//! Not tested: joints.

use std::fmt::Write;

use glam::DVec2;
use jostle::problems::{Problem, Setting, Truth, cluster_rotation, elastic_bounce};

use super::support::{assert_near, kinetic, load, phases, run_to};

/// Bodies of several atoms that fall into a bin, collide with friction and inelasticity, and come to rest.
fn bin(scale: f64) -> String {
    let time = scale.sqrt();
    let mut bodies = String::new();
    let mut chance = phases(100);
    let mut next = || chance.next().unwrap_or_default();
    for number in 0..8_usize {
        let (x, y) = ((0.3 + 0.4 * (number % 3) as f64) * scale, (0.4 + 0.4 * (number / 3) as f64) * scale);
        let (speed, spin, angle) = ((next() - 0.5) * time, (4.0 * next() - 2.0) / time, 6.0 * next());
        let atoms = if number % 2 == 0 {
            format!("Disc(radius: {:?}, mass: 0.3)", 0.1 * scale)
        } else {
            let (along, up, radius) = (0.12 * scale, 0.05 * scale, 0.08 * scale);
            format!(
                "List([(at: (0, 0), radius: {radius:?}, mass: 0.2), (at: ({along:?}, {up:?}), radius: {radius:?}, mass: 0.1)])"
            )
        };
        let _ = write!(
            bodies,
            "(name: \"b{number}\", at: ({x:?}, {y:?}), angle: {angle:?}, velocity: ({speed:?}, 0), spin: {spin:?},
              material: \"clay\", atoms: {atoms}),"
        );
    }
    let (tick, stiffness, width) = (time / 2048.0, 1e4 / scale, 1.4 * scale);
    format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{ \"clay\": (stiffness: {stiffness:?}, friction: (static: 0.5, dynamic: 0.4), inelasticity: 0.4) }},
        walls: [
            (name: \"floor\", left: ({scale:?}, 0), right: (0, 0), material: \"clay\"),
            (name: \"left\", left: (0, 0), right: (0, {scale:?}), material: \"clay\"),
            (name: \"right\", left: ({width:?}, {scale:?}), right: ({width:?}, 0), material: \"clay\"),
        ],
        bodies: [{bodies}])",
        100.0 * time
    )
}

#[test]
fn everything_is_the_same_at_every_size() {
    let ticks = [100, 1000, 4000, 20_000];
    let mut one = load(&bin(1.0));
    let powers = [-20, -10, 10, 20];
    let mut others = powers.map(|power| load(&bin(2.0_f64.powi(power))));
    for tick in ticks {
        one.run_to_tick(tick).expect("numbers stay finite");
        for (power, other) in powers.into_iter().zip(&mut others) {
            other.run_to_tick(tick).expect("numbers stay finite");
            let (length, time) = (2.0_f64.powi(power), 2.0_f64.powi(power / 2));
            let (a, b) = (one.bodies(), other.bodies());
            for body in 0..a.len() {
                let what = format!("2^{power}, tick {tick}, body {body}");
                assert_eq!(a.position[body] * length, b.position[body], "{what}: position");
                assert_eq!(a.angle[body], b.angle[body], "{what}: angle");
                assert_eq!(a.velocity[body] * (length / time), b.velocity[body], "{what}: velocity");
                assert_eq!(a.spin[body] / time, b.spin[body], "{what}: spin");
            }
        }
    }
    assert_eq!(kinetic(one.bodies()), 0.0, "they have come to rest");
}

/// The bounce of truth file C01 at a size, `ticks` ticks per period: gap over the height of the fall.
fn bounce(scale: f64, offset: DVec2, ticks: f64) -> jostle::Simulation {
    let time = scale.sqrt();
    let period = elastic_bounce::PERIOD * time;
    let (radius, stiffness) = (elastic_bounce::RADIUS * scale, elastic_bounce::OMEGA.powi(2) / scale);
    let (x, floor) = (offset.x, offset.y);
    let height = floor + radius + elastic_bounce::HEIGHT * scale;
    load(&format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {:?}, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{ \"rubber\": (stiffness: {stiffness:?}) }},
        walls: [(name: \"floor\", left: ({:?}, {floor:?}), right: ({x:?}, {floor:?}))],
        bodies: [(name: \"ball\", at: ({x:?}, {height:?}), material: \"rubber\", atoms: Disc(radius: {radius:?}, mass: 1))])",
        100.0 * period,
        period / ticks,
        x + scale.max(1.0),
    ))
}

#[test]
fn a_ball_bounces_alike_at_every_size() {
    let truth = Truth::read(include_str!("../../assets/truths/H03_far_and_scaled.json"));
    let mut one = bounce(1.0, DVec2::ZERO, 4000.0);
    let mut others = [("1.0e-6", 1e-6), ("0.001", 1e-3), ("1.0e+3", 1e3), ("1.0e+6", 1e6)].map(|(name, scale)| {
        let period = truth.number(&format!("scale {name}: bounce period"));
        assert_near("period", elastic_bounce::PERIOD * f64::sqrt(scale) / period, 1.0, 4.0 * f64::EPSILON);
        (scale, bounce(scale, DVec2::ZERO, 4000.0))
    });
    for quarter in 1..=40 {
        one.run_to_tick(1000 * quarter).expect("numbers stay finite");
        for (scale, other) in &mut others {
            other.run_to_tick(1000 * quarter).expect("numbers stay finite");
            let gap = |height: f64, scale: f64| height / scale - elastic_bounce::RADIUS;
            let (a, b) = (gap(one.bodies().position[0].y, 1.0), gap(other.bodies().position[0].y, *scale));
            // Velocities are rounded twice a tick. A share eps of the speed puts the ball off by 4 h eps a period later (see the
            // problem), and all ticks before add up.
            let ticks = 1000.0 * quarter as f64;
            let tolerance = 2.0 * ticks * f64::EPSILON * 4.0 * (quarter as f64 / 4.0 + 1.0);
            assert_near(&format!("gap at scale {scale:e}"), b, a, tolerance);
        }
    }
}

#[test]
fn a_ball_bounces_alike_far_away() {
    let far = 1e6;
    let truth = Truth::read(include_str!("../../assets/truths/H03_far_and_scaled.json"));
    let ulp = truth.number("ulp of the coordinate at X (f64)");
    let mut here = bounce(1.0, DVec2::ZERO, 4000.0);
    let mut beside = bounce(1.0, DVec2::new(far, 0.0), 4000.0);
    let mut there = bounce(1.0, DVec2::new(far, far), 4000.0);
    for quarter in 1..=20 {
        for simulation in [&mut here, &mut beside, &mut there] {
            simulation.run_to_tick(1000 * quarter).expect("numbers stay finite");
        }
        let height = here.bodies().position[0].y;
        assert_eq!(beside.bodies().position[0].y, height, "beside, the height is the same to the last bit");
        // Each contact of 32 ms changes the velocity by up to that of half an ulp of overlap, the start by half an ulp of height
        // more; a velocity wrong by u puts the ball off by 4 h u/v a period later.
        let contacts = (quarter as f64 / 4.0).ceil();
        let speed = elastic_bounce::OMEGA.powi(2) * 0.5 * ulp * 0.032 + 9.81 * ulp / 3.1;
        let tolerance = 4.0 * 0.5 / 3.1 * speed * contacts * (contacts + 1.0) / 2.0 + 2.0 * ulp;
        assert_near("height", there.bodies().position[0].y - far, height, tolerance);
    }
}

/// Far away a fast cluster keeps its shape: atoms are off by no more than an ulp of where they are.
#[test]
fn a_cluster_turns_alike_far_away() {
    let far = 1e6;
    let Problem { scene, .. } = cluster_rotation::PROBLEM;
    let setting = Setting { method: "VelocityVerlet", tick: 1e-4, shift: 0.0, ..Setting::default() };
    let text = scene(&setting, 1.0);
    let mut here = load(&text);
    let mut there = load(&text.replace("at: (0, 0), velocity", &format!("at: ({far:?}, {far:?}), velocity")));
    run_to(&mut here, 1.0);
    run_to(&mut there, 1.0);
    let ulp = 2.0_f64.powi(-33);
    assert_eq!(here.bodies().angle, there.bodies().angle);
    for atom in 0..here.bodies().atom_count() {
        let (a, b) = (here.bodies().atom_place(atom), there.bodies().atom_place(atom));
        let off = (b - DVec2::splat(far) - a).abs().max_element();
        assert!(off > 0.0 && off <= 1.5 * ulp, "{off:e} of {ulp:e}");
    }
}
