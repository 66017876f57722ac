//! Promise: ticks in which no pair, contact or mode is new allocate nothing.
//!
//! A batch of ticks allocates for itself, once. So the median batch of two ticks allocates as often as the median batch of one. Not
//! tested: ticks in which pairs, contacts or modes are new.

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simd::Counting;

const GROUND: &str =
    "gravity: (0, -9.81), materials: { \"m\": (stiffness: 1e5, friction: 0.8, restitution: 0.2, density: 50) },
    walls: [(name: \"ground\", heights: (of: \"0\", from: -5, to: 50, pieces: 20), material: \"m\")]";

/// A car that stands on its wheels, or drives.
fn car(speed: f64) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 10, tick: 1e-3, method: VelocityVerlet), {GROUND},
            bodies: [(name: \"car\", at: (0, 0.3), material: \"m\", shape: Rectangle(width: 1, height: 0.2)),
                (name: \"rear\", at: (-0.4, 0.2), material: \"m\", atoms: Disc(radius: 0.2)),
                (name: \"front\", at: (0.4, 0.2), material: \"m\", atoms: Disc(radius: 0.2))],
            joints: [Revolute(name: \"r\", a: \"car\", anchor_a: (-0.4, -0.1), b: \"rear\", collide: false),
                Revolute(name: \"f\", a: \"car\", anchor_a: (0.4, -0.1), b: \"front\", collide: false)],
            controllers: [Motor(name: \"d\", of: \"r\", speed: {speed:?}, limit: 20)])"
    )
}

/// A row of boxes that slide.
fn boxes() -> String {
    format!(
        "Scene(format: 1, clock: (duration: 10, tick: 1e-4, method: VelocityVerlet), {GROUND},
            bodies: [Repeat(count: 9, make: (name: \"box_{{i}}\", at: (\"i\", 0.05), velocity: (9, 0), material: \"m\",
                shape: Rectangle(width: 0.3, height: 0.1)))])"
    )
}

fn run(simulation: &mut Simulation, ticks: u64) {
    let end = simulation.clock().ticks + ticks;
    simulation.run_to_tick(end).unwrap_or_else(|failure| panic!("{failure}"));
}

/// The median of the allocations in batches of so many ticks.
fn median(simulation: &mut Simulation, ticks: u64) -> u64 {
    let mut counts: Vec<u64> = (0..99)
        .map(|_| {
            let before = Counting::allocations();
            run(simulation, ticks);
            Counting::allocations() - before
        })
        .collect();
    counts.sort_unstable();
    counts[counts.len() / 2]
}

#[test]
fn a_steady_tick_allocates_nothing() {
    for (what, text) in [("drives", car(-3.0)), ("stands", car(0.0)), ("slides", boxes())] {
        let mut simulation =
            Simulation::load(&Source::new("steady.ron", &text)).unwrap_or_else(|errors| panic!("{errors}"));
        run(&mut simulation, 300);
        let [one, two] = [1, 2].map(|ticks| median(&mut simulation, ticks));
        assert_eq!(one, two, "{what}: {} allocations in a tick", two as i64 - one as i64);
    }
}
