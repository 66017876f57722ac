//! Law: a contact at rest holds with any force that its law allows there, `[1 - mu, 1 + mu] k d`, so a body comes to rest
//! in finite time with an overlap between `m g/(k (1 + mu))` and `m g/(k (1 - mu))`; from then on nothing moves at all, and
//! every contact carries what stands above it. Source: statics; truth files C05, M03, H01.
//!
//! Tolerances: "at rest" is a velocity of exactly zero and a state that does not change by a bit. Forces: 1e-9 of the
//! weight, the imbalance with which the engine may lay a body to rest. Heights of rebounds: a share `2 x 2 mu s^2/e^2`,
//! `s = w dt`, at each impact for restitution (see `restitution`; heights go with the square of the speed).
//!
//! Not tested: rest on slopes (see `slope`).

use std::f64::consts::PI;
use std::fmt::Write;

use jostle::problems::{Setting, Truth, settling_bounce};
use jostle::scene::Source;
use jostle::simulation::{Overrides, Simulation};

use super::support::{METHODS, assert_near, assert_rest, contact_forces, fitted_order, load, phases, run_to, table};

/// The greatest heights of the flights after each impact, one after the other, in m.
fn rebounds(simulation: &mut Simulation, until: f64) -> Vec<f64> {
    let mut heights = Vec::new();
    let mut before = (0.0, f64::NEG_INFINITY);
    while simulation.clock().time() < until {
        simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
        let (position, velocity) = (simulation.bodies().position[0].y, simulation.bodies().velocity[0].y);
        let gap = position - settling_bounce::RADIUS;
        if before.0 > 0.0 && velocity <= 0.0 && gap > 0.0 {
            // The top lies between two ticks.
            heights.push(gap + velocity * velocity / (2.0 * settling_bounce::GRAVITY));
        }
        before = (velocity, gap);
    }
    heights
}

#[test]
fn a_ball_bounces_to_rest_as_the_closed_form_says() {
    let truth = Truth::read(settling_bounce::TRUTH);
    let exact = truth.numbers("soft: rebound heights 1..6");
    let (mu, omega) = (settling_bounce::INELASTICITY, settling_bounce::STIFFNESS.sqrt());
    let squared = (1.0 - mu) / (1.0 + mu);
    for method in METHODS {
        let mut points = Vec::new();
        for tick in [2e-4, 1e-4, 5e-5, 2.5e-5] {
            let mut worst = 0.0_f64;
            for phase in phases(8) {
                let setting = Setting { method, tick, shift: phase * tick, ..Setting::default() };
                let mut simulation = settling_bounce::PROBLEM.load(&setting).expect("the scene is correct");
                let found = rebounds(&mut simulation, 2.56);
                for (number, (found, exact)) in found.iter().zip(&exact).enumerate() {
                    let share = (number + 1) as f64 * (4.0 * mu / squared + 1.0) * (omega * tick).powi(2);
                    // Semi-implicit Euler falls from up to half a tick's way higher.
                    let higher = if method == METHODS[0] { 9.81 * tick * (2.0 * 9.81_f64).sqrt() / 9.81 } else { 0.0 };
                    assert_near(&format!("rebound {number}"), found / exact, 1.0, share + higher);
                    worst = worst.max((found / exact - 1.0).abs());
                }
                assert!(found.len() >= exact.len(), "{} rebounds", found.len());
            }
            points.push((tick, worst));
        }
        let order = fitted_order(&points);
        println!("{method}: heights, order {order:.2};{}", table(&points));
        assert!(order >= 0.75, "{method}: order {order};{}", table(&points));
    }
}

/// The overlap at rest depends on where in a tick the last turn falls, but not by more than the band; the time to rest
/// by no more than the last flight and the last contacts.
#[test]
fn the_ball_rests_inside_the_band_and_never_moves_again() {
    let truth = Truth::read(settling_bounce::TRUTH);
    let band = truth.numbers("soft: band of admissible rest overlaps [mg/(k(1+mu)), mg/(k(1-mu))]");
    let at_rest = truth.number("soft: time at rest");
    let (_, overlap, end) = settling_bounce::history();
    assert_near("closed form: rest overlap", overlap, truth.number("soft: rest overlap"), 1e-15);
    assert_near("closed form: time at rest", end, at_rest, 1e-12);
    for method in METHODS {
        for tick in [2e-4, 5e-5] {
            for phase in phases(8) {
                let setting = Setting { method, tick, shift: phase * tick, ..Setting::default() };
                let text = (settling_bounce::PROBLEM.scene)(&setting, 10.0);
                let mut simulation = load(&text);
                let mut rested = f64::INFINITY;
                while simulation.clock().time() < 4.0 {
                    simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
                    if simulation.bodies().velocity[0].y == 0.0 {
                        rested = rested.min(simulation.clock().time());
                    } else {
                        rested = f64::INFINITY;
                    }
                }
                let found = settling_bounce::RADIUS - simulation.bodies().position[0].y;
                assert!(band[0] <= found && found <= band[1], "{method} {tick}: {found:e} outside {band:?}");
                // Twelve flights, each changed by a share of up to 2 mu s^2/e^2 of at most 0.7 s, and the last one of them,
                // of some 20 ms, may be there or not.
                let step = settling_bounce::STIFFNESS.sqrt() * tick;
                let share = 2.0 * 0.3 * step * step * 1.3 / 0.7;
                assert_near("time at rest", rested, at_rest, at_rest * 12.0 * share + 0.03);
                assert_rest("ball", &mut simulation, 4.0, 5.0);
            }
        }
    }
}

/// Frictionless discs on a floor, one above the other between guides that they do not touch: radius, mass and stiffness.
fn column(discs: &[(f64, f64, f64)], rest: &str, tick: f64) -> String {
    let mut bodies = String::new();
    let mut height = 0.0;
    for (number, (radius, mass, stiffness)) in discs.iter().enumerate() {
        height += radius;
        let _ = write!(
            bodies,
            "(name: \"disc_{number}\", at: (0, {height:?}), material: \"smooth\",
              atoms: List([(at: (0, 0), radius: {radius:?}, mass: {mass:?}, stiffness: {stiffness:?})])),"
        );
        height += radius;
    }
    format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: VelocityVerlet), gravity: (0, -9.81), {rest}
        walls: [
            (name: \"floor\", left: (1, 0), right: (0, 0), material: \"smooth\"),
            (name: \"left\", left: (-0.6, 0), right: (-0.6, 1), material: \"smooth\"),
            (name: \"right\", left: (0.6, 1), right: (0.6, 0), material: \"smooth\"),
        ],
        sensors: [ContactForce(on: \"floor\")], bodies: [{bodies}])"
    )
}

/// Contact forces from the floor up: each carries the contact forces on all bodies above it.
fn carried(simulation: &Simulation) -> Vec<f64> {
    let forces = contact_forces(simulation);
    let mut carried: Vec<f64> = forces
        .on_body
        .iter()
        .rev()
        .scan(0.0, |sum, force| {
            *sum += force.y;
            Some(*sum)
        })
        .collect();
    carried.reverse();
    assert_near("floor", -forces.on_wall[0].y / carried[0], 1.0, 1e-12);
    carried
}

const CLAY: &str = "materials: { \"smooth\": (stiffness: 1, inelasticity: 0.3) },";

fn assert_column_stands(what: &str, discs: &[(f64, f64, f64)], tick: f64, settled: f64, exact: &[f64]) {
    let mut simulation = load(&column(discs, CLAY, tick));
    assert_rest(what, &mut simulation, settled, 1.0);
    let found = carried(&simulation);
    assert_eq!(found.len(), exact.len());
    for (found, exact) in found.iter().zip(exact) {
        assert_near(what, found / exact, 1.0, 1e-9);
    }
}

#[test]
fn each_contact_of_a_column_of_twenty_discs_carries_what_is_above() {
    let exact = Truth::read(include_str!("../../assets/truths/M03_column_hydrostatic.json"))
        .numbers("contact forces from the floor up");
    assert_column_stands("column", &[(0.05, 0.5, 2e5); 20], 2e-4, 20.0, &exact);
}

#[test]
fn a_mass_ratio_of_ten_thousand_stands_both_ways() {
    let truth = Truth::read(include_str!("../../assets/truths/H01_mass_ratio_stack.json"));
    let (light, heavy) = ((0.5, 1.0, 2e7), (0.5, 1e4, 2e7));
    let exact = truth.numbers("heavy on light: forces floor-light, light-heavy");
    assert_column_stands("heavy on light", &[light, heavy], 1e-4, 20.0, &exact);
    let exact = truth.numbers("light on heavy: forces floor-heavy, heavy-light");
    assert_column_stands("light on heavy", &[heavy, light], 1e-4, 20.0, &exact);
}

/// Elastic contacts settle by drag and have one overlap only, force over stiffness. The lowest mode dies out with
/// `exp(-c t/2 m)`: to 1e-13 of its 10 mm after 30 s.
#[test]
fn elastic_columns_sink_in_by_weight_over_stiffness() {
    let elastic = "materials: { \"smooth\": (stiffness: 1) }, forces: [Drag(linear: 1.0)],";
    let overlaps = |simulation: &Simulation, radius: f64| {
        let heights: Vec<f64> = simulation.bodies().position.iter().map(|position| position.y).collect();
        let between = heights.windows(2).map(|pair| 2.0 * radius - (pair[1] - pair[0]));
        std::iter::once(radius - heights[0]).chain(between).collect::<Vec<f64>>()
    };
    let truth = Truth::read(include_str!("../../assets/truths/M03_column_hydrostatic.json"));
    let exact = truth.numbers("overlaps from the floor up");
    let mut simulation = load(&column(&[(0.05, 0.5, 2e5); 20], elastic, 2e-4));
    run_to(&mut simulation, 40.0);
    let found = overlaps(&simulation, 0.05);
    // The floor is infinitely stiff: its contact has the disc's own stiffness, twice that of a pair.
    assert_near("overlap with the floor", found[0], exact[0] / 2.0, 1e-12);
    for (found, exact) in found[1..].iter().zip(&exact[1..]) {
        assert_near("overlap", *found, *exact, 1e-12);
    }
    let sinks = 0.05 * 39.0 - simulation.bodies().position[19].y;
    assert_near("sinking", sinks, truth.number("sinking of the top disc") - exact[0] / 2.0, 1e-12);

    // Five discs of pi/4 kg on a floor as soft as a pair: the lowest has half the stiffness of the others there.
    let mass = PI / 4.0;
    let mut discs = vec![(0.5, mass, 2e5); 5];
    discs[0].2 = 1e5;
    let mut simulation = load(&column(&discs, elastic, 2e-4));
    run_to(&mut simulation, 60.0);
    let found = overlaps(&simulation, 0.5);
    assert_near("bottom overlap", found[0], 5.0 * mass * 9.81 / 1e5, 1e-12);
    assert_near("bottom overlap of the catalogue", found[0], 3.852_378_0e-4, 1e-10);
}

#[test]
fn tetris_comes_to_rest() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/tetris.ron")).expect("it is there");
    for tick in [1e-3, 0.25e-3] {
        let overrides = Overrides { tick: Some(tick), duration: Some(120.0), ..Default::default() };
        let source = Source::new("tetris.ron", text.clone());
        let mut simulation = Simulation::load_with(&source, &overrides, |_| {}).expect("a correct scene");
        assert_rest(&format!("tetris at {tick} s"), &mut simulation, 60.0, 60.0);
    }
}

/// 200 bodies of four shapes and three materials, poured into a bin. Its floor is of gravel: on a smooth one a disc that
/// touches nothing else rolls for ever, as it should, since nothing resists rolling.
fn pile() -> String {
    let gravel: Vec<String> =
        (0..38).map(|place| format!("(at: ({:?}, 0), radius: 0.06)", 0.1 * f64::from(place))).collect();
    let mut bodies = format!(
        "(name: \"gravel\", fixed: true, datum: Origin, material: \"stone\", atoms: List([{}])),",
        gravel.join(", ")
    );
    let mut chance = phases(1000);
    let mut next = || chance.next().unwrap_or_default();
    for number in 0..200_usize {
        let (x, y) = (0.2 + 0.25 * (number % 14) as f64 + 0.05 * next(), 0.3 + 0.27 * (number / 14) as f64);
        let (angle, speed) = (6.0 * next(), next() - 0.5);
        let atoms = match number % 4 {
            0 => format!("Disc(radius: {:?})", 0.06 + 0.04 * next()),
            1 => "Picture(spacing: 0.09, mass: 0.01, rows: [\"##\", \"##\"])".to_owned(),
            2 => "List([(at: (0, 0), radius: 0.07, mass: 0.02), (at: (0.07, 0.03), radius: 0.05, mass: 0.01)])"
                .to_owned(),
            _ => "Picture(spacing: 0.08, mass: 0.01, rows: [\"###\"])".to_owned(),
        };
        let material = ["wood", "stone", "rubber"][(number / 4 + number) % 3];
        let _ = write!(
            bodies,
            "(name: \"body_{number}\", at: ({x:?}, {y:?}), angle: {angle:?}, velocity: ({speed:?}, 0),
              material: \"{material}\", atoms: {atoms}),"
        );
    }
    format!(
        "Scene(format: 1, clock: (duration: 30, tick: 1e-3, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{
            \"wood\": (stiffness: 2000, friction: 0.4, inelasticity: 0.4, density: 1),
            \"stone\": (stiffness: 4000, friction: 0.6, inelasticity: 0.3, density: 2),
            \"rubber\": (stiffness: 1000, friction: (static: 0.8, dynamic: 0.7), inelasticity: 0.2, density: 1.5),
        }},
        walls: [
            (name: \"floor\", left: (1, 0), right: (0, 0), material: \"stone\"),
            (name: \"left\", left: (0, 0), right: (0, 1), material: \"wood\"),
            (name: \"right\", left: (3.7, 1), right: (3.7, 0), material: \"wood\"),
        ],
        bodies: [{bodies}])"
    )
}

#[test]
fn a_pile_of_two_hundred_mixed_bodies_comes_to_rest() {
    assert_rest("pile", &mut load(&pile()), 20.0, 10.0);
}
