//! Law: if contacts are too many for their events to be located, runs stay finite, their energy closes, and heaps come
//! to rest. Held contacts that depend on each other together hold the loads of rigid statics. Source: the energy of a
//! spring under velocity Verlet swings by the share `(omega dt/2)^2` (Hairer, Lubich and Wanner 2003), and crowded
//! ticks are divided so that `omega dt` is at most 1/2.
//!
//! Tolerances: a sixteenth of the energy that went round, from that; momentum: rounding, as many terms as there are ticks and
//! bodies. Where everything comes to rest: exactly 0.
//!
//! Not tested: that a single trajectory is right, as crowds are chaotic; scenes of a thousand bodies under costly methods for
//! longer than until they ran away when redundant contacts and damped ones had no force.

use jostle::SimulationExt;
use std::fmt::Write;
use std::path::Path;

use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, world::hash::state_hash};

use super::support::{assert_near, assert_rest, load, run_to};

/// `omega dt/2`, squared, at most.
const SWING: f64 = 0.0625;

fn shipped(name: &str, method: &str, duration: f64) -> Simulation {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.ron"));
    let overrides = Overrides { method: Some(method.to_owned()), duration: Some(duration), ..Overrides::default() };
    let source = Source::read(&path).expect("the scene is shipped");
    let mut simulation = Simulation::load_with(&source, &overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{name}, {method}: {failure}"));
    simulation
}

fn overloaded_ticks(simulation: &Simulation) -> u64 {
    simulation.state().located().given_up
}

#[test]
fn overloaded_scenes_stay_finite_and_their_energy_closes() {
    for (name, method, duration, overloaded) in [
        ("hourglass", "RungeKutta4", 0.2, Some(true)),
        ("hourglass", "Dop853", 0.07, None),
        ("hourglass", "Symplectic4", 0.02, None),
        ("marble_mills", "RungeKutta4", 1.0, Some(true)),
        ("marble_mills", "Dop853", 0.5, None),
        ("marble_mills", "Symplectic4", 0.4, None),
        ("plinko", "RungeKutta4", 1.0, None),
        ("plinko", "Dop853", 0.4, None),
        ("snow_globe", "RungeKutta4", 0.3, None),
        ("snow_globe", "Dop853", 0.1, None),
        ("tetris", "RungeKutta4", 2.0, Some(false)),
        ("tetris", "Dop853", 2.0, Some(false)),
        ("tetris", "Symplectic4", 2.0, Some(false)),
    ] {
        let simulation = shipped(name, method, duration);
        let card = simulation.card();
        let energy = card.energy;
        let round = energy.kinetic + energy.elastic + energy.friction + energy.inelasticity + energy.drag;
        let what = format!("{name}, {method}");
        println!(
            "{what}: {} of {} ticks crowded, {:e}",
            overloaded_ticks(&simulation),
            simulation.clock().ticks,
            energy.residual / round
        );
        assert_near(&what, energy.residual / round, 0.0, SWING);
        let found = overloaded_ticks(&simulation) > 0;
        assert!(overloaded.is_none_or(|overloaded| overloaded == found), "{what}");
        let bodies = simulation.bodies();
        let mass: f64 = (0..bodies.len()).filter(|&body| bodies.dynamic[body]).map(|body| bodies.mass[body]).sum();
        let clock = simulation.clock();
        let terms = clock.ticks as f64 * bodies.len() as f64;
        let rounding = f64::EPSILON * mass * 9.81 * clock.time() * terms.sqrt();
        for residual in card.momentum_residual {
            assert_near(&what, residual, 0.0, 10.0 * rounding);
        }
        // It is told on the card.
        let told = card.notes.iter().any(|note| note.contains("too many events to locate"));
        assert_eq!(told, found, "{what}: {:?}", card.notes);
    }
}

/// Rows of discs as they lie in a heap, let fall by a centimetre.
fn heap(method: &str) -> String {
    let mut bodies = String::new();
    for (row, count) in [8, 7, 8, 7, 8, 7, 8, 7].into_iter().enumerate() {
        for index in 0..count {
            let (x, y) = (0.2 * f64::from(index) - 0.1 * f64::from(count - 1), 0.11 + 0.18 * row as f64);
            let _ = write!(
                bodies,
                "(name: \"disc_{row}_{index}\", at: ({x:?}, {y:?}), material: \"m\", atoms: Disc(radius: 0.1, mass: 1)),"
            );
        }
    }
    format!(
        "Scene(format: 1, clock: (duration: 10, tick: 0.0005, method: {method}), gravity: (0, -9.81),
        materials: {{ \"m\": (stiffness: 5e4, friction: 0.4, restitution: 0.4) }},
        walls: [(name: \"floor\", left: (1, 0), right: (-1, 0), material: \"m\"),
                (name: \"left\", left: (-0.8, 0), right: (-0.8, 1), material: \"m\"),
                (name: \"right\", left: (0.8, 1), right: (0.8, 0), material: \"m\")],
        bodies: [{bodies}])"
    )
}

#[test]
fn a_heap_of_sixty_discs_comes_to_rest() {
    for method in ["RungeKutta4", "Dop853"] {
        let mut simulation = load(&heap(method));
        assert_rest(method, &mut simulation, 1.5, 1.0);
        let weight = 60.0 * 9.81;
        let residual = simulation.card().momentum_residual[1];
        assert_near(method, residual, 0.0, f64::EPSILON * weight * 2.5 * 10.0 * (5000.0_f64 * 60.0).sqrt());
    }
}

/// The same run twice gives the same bits, in and out of crowds.
#[test]
fn event_overload_is_deterministic() {
    let hashes = [(); 2].map(|()| state_hash(shipped("marble_mills", "RungeKutta4", 0.3).bodies()));
    assert_eq!(hashes[0], hashes[1]);
}

/// 16 discs in a row on a slope of 0.2 rad, that fall by a millimetre: all contacts are redundant but three rows.
#[test]
fn a_wide_block_stands_on_sixteen_atoms() {
    for (method, angle) in [
        ("SemiImplicitEuler", 0.2_f64),
        ("VelocityVerlet", 0.2),
        ("RungeKutta4", 0.0),
        ("RungeKutta4", 0.2),
        ("Dop853", 0.2),
        ("Symplectic4", 0.2),
        ("ImplicitMidpoint", 0.2),
    ] {
        let (sin, cos) = libm::sincos(angle);
        let (x, y) = (0.051 * sin, 0.051 * cos);
        let row = "#".repeat(16);
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 10, tick: 0.0005, method: {method}, events: Located), gravity: (0, -9.81),
            materials: {{ \"m\": (stiffness: 1e4, friction: 0.4, inelasticity: 0.3) }},
            walls: [(name: \"slope\", left: ({cos:?}, {:?}), right: (0, 0), material: \"m\")],
            bodies: [(name: \"block\", at: ({x:?}, {y:?}), angle: {:?}, material: \"m\",
                      atoms: Picture(spacing: 0.1, mass: 0.0625, rows: [\"{row}\"]))])",
            -sin, -angle
        ));
        assert_rest(&format!("{method}, {angle} rad"), &mut simulation, 0.5, 0.2);
        // Its landing may be a crowd; 32 rows at rest are not too many.
        let landing = overloaded_ticks(&simulation);
        run_to(&mut simulation, 0.8);
        assert_eq!(overloaded_ticks(&simulation), landing, "{method}: crowded at rest");
        // It slid while it fell and bounced, at most with friction full from the beginning: less than by falling freely.
        assert!(simulation.bodies().position[0].y > -0.05, "{method}: {}", simulation.bodies().position[0]);
    }
}

/// What carries a body accelerates: a block that sticks to a table moved along a curve goes where the table goes. The path is
/// cubics through points of a sine, with the velocities of the sine, so that its acceleration is linear between points, which
/// `Dop853` integrates exactly; steps end at the points. Tolerance: rounding of the sums, `sqrt(ticks)` last bits of the swing.
#[test]
fn a_block_that_sticks_follows_a_shaken_table() {
    let (swing, omega) = (0.05_f64, 2.0 * std::f64::consts::PI);
    let mut path = String::new();
    for point in 1..=16 {
        let phase = omega * f64::from(point) / 8.0;
        let (sin, cos) = libm::sincos(phase);
        let (time, x, velocity) = (f64::from(point) / 8.0, swing * sin, swing * omega * cos);
        let _ = write!(path, "(time: {time:?}, by: ({x:?}, 0), velocity: ({velocity:?}, 0)),");
    }
    let (start, stiffness) = (swing * omega, 1e5);
    // Four atoms bear it, each on one of the table: springs in series.
    let overlap = 9.81 / (4.0 * 0.5 * stiffness);
    let scene = |tick: f64| {
        format!(
            "Scene(format: 1, clock: (duration: 2, tick: {tick:?}, method: Dop853), gravity: (0, -9.81),
            contacts: Penalty(tangential: Exact),
            materials: {{ \"m\": (stiffness: {stiffness:?}, friction: 0.4, inelasticity: 0.3) }},
            bodies: [
                (name: \"table\", at: (0, 0), material: \"m\", atoms: Picture(spacing: 0.1, rows: [\"####\"]),
                 kinematic: (velocity: ({start:?}, 0), path: [{path}])),
                (name: \"block\", at: (0, {:?}), velocity: ({start:?}, 0), material: \"m\",
                 atoms: Picture(spacing: 0.1, mass: 0.25, rows: [\"####\"]))])",
            0.1 - overlap
        )
    };
    for tick in [1e-3, 7.3e-3] {
        let mut simulation = load(&scene(tick));
        let mut worst = 0.0_f64;
        while simulation.clock().time() < 1.9 {
            let next = simulation.clock().time() + 0.05;
            run_to(&mut simulation, next);
            let bodies = simulation.bodies();
            let offset = bodies.position[1] - bodies.position[0] - glam::DVec2::new(0.0, 0.1 - overlap);
            worst = worst.max(offset.length());
        }
        println!("tick {tick}: {worst:e}");
        let ticks = 2.0 / tick;
        assert_near("way from the table", worst, 0.0, f64::EPSILON * (0.1 + swing) * 4.0 * ticks.sqrt());
        let energy = simulation.card().energy;
        assert_near("energy", energy.residual, 0.0, f64::EPSILON * start * start * 16.0 * ticks.sqrt());
        assert_near("lost to friction", energy.friction, 0.0, f64::EPSILON * start * start * 16.0 * ticks.sqrt());
    }
}

/// What lies on a belt and sticks goes with it, at its velocity to the last bit.
#[test]
fn a_block_that_sticks_goes_with_its_belt() {
    for method in ["RungeKutta4", "Dop853"] {
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 2, tick: 0.001, method: {method}), gravity: (0, -9.81),
            contacts: Penalty(tangential: Exact),
            materials: {{ \"m\": (stiffness: 1e5, friction: 0.4, inelasticity: 0.3) }},
            walls: [(name: \"belt\", left: (1, 0), right: (-1, 0), material: \"m\", surface_velocity: (0.5, 0))],
            bodies: [(name: \"block\", at: (0, 0.05), material: \"m\",
                      atoms: Picture(spacing: 0.1, mass: 0.25, rows: [\"####\"]))])"
        ));
        run_to(&mut simulation, 1.0);
        let before = simulation.bodies().position[0].x;
        let speed = simulation.bodies().velocity[0].x;
        assert_near(method, speed.abs(), 0.5, 2.0 * f64::EPSILON);
        run_to(&mut simulation, 2.0);
        assert_near(method, simulation.bodies().position[0].x - before, speed, 1e-13);
    }
}

/// Rows of discs rest on more contacts than their freedoms need. The force nearest the springs then leaves the band of one of them.
/// That contact stays at the end of its band, and neither parts nor approaches. The sign of what rounding leaves of its velocity ends no mode, so
/// nothing happens any more. The row goes with its belt to rounding.
#[test]
fn rows_of_discs_at_the_ends_of_their_bands_rest_without_events() {
    for method in ["RungeKutta4", "Dop853"] {
        for friction in ["Exact", "Spring(ratio: 0.8)"] {
            for (row, stiffness, angle) in
                [("###", 1e5, 0.0_f64), ("####", 1e5, 0.0), ("####", 3e4, 0.15), ("######", 1e6, 0.0)]
            {
                let (sin, cos) = libm::sincos(angle);
                let mut simulation = load(&format!(
                    "Scene(format: 1, clock: (duration: 2, tick: 0.001, method: {method}), gravity: (0, -9.81),
                    contacts: Penalty(tangential: {friction}),
                    materials: {{ \"m\": (stiffness: {stiffness:?}, friction: 0.4, inelasticity: 0.3) }},
                    walls: [(name: \"belt\", left: ({:?}, {:?}), right: ({:?}, {:?}), material: \"m\",
                             surface_velocity: ({:?}, {:?}))],
                    bodies: [(name: \"block\", at: ({:?}, {:?}), angle: {angle:?}, material: \"m\",
                              atoms: Picture(spacing: 0.1, mass: 0.25, rows: [\"{row}\"]))])",
                    2.0 * cos,
                    2.0 * sin,
                    -2.0 * cos,
                    -2.0 * sin,
                    0.5 * cos,
                    0.5 * sin,
                    -0.05 * sin,
                    0.05 * cos
                ));
                run_to(&mut simulation, 1.6);
                let what = format!("{row} of {stiffness:e} N/m at {angle} rad, {friction}, {method}");
                let (before, events) = (simulation.bodies().position[0], simulation.state().located());
                run_to(&mut simulation, 2.0);
                let (way, located) = (simulation.bodies().position[0] - before, simulation.state().located());
                assert_near(&what, way.length(), 0.2, 1e-13);
                assert_eq!((located.count, located.given_up), (events.count, events.given_up), "{what}");
            }
        }
    }
}
