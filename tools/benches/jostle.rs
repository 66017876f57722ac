//! Criterion benches of whole scenes through the public interface. Each run of a bench does the same ticks of the same scene, from
//! a state that is reached outside the measurement; `elem/s` are ticks per second, for `load` bodies per second.

use std::fmt::Write;
use std::hint::black_box;
use std::time::Duration;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use jostle::Simulation;
use jostle::scene::Source;

/// Ticks that are measured: `count` of them after the first `from`; how often.
struct Stretch {
    from: u64,
    count: u64,
    samples: usize,
}

fn load(name: &str, text: &str) -> Simulation {
    Simulation::load(&Source::new(name, text)).unwrap_or_else(|errors| panic!("{name}: {}", errors.render(false)))
}

fn ticks(criterion: &mut Criterion, name: &str, scene: &str, stretch: &Stretch) {
    let end = stretch.from + stretch.count;
    let at_start = || {
        let mut simulation = load(name, scene);
        assert!(simulation.ticks() >= end, "{name} ends after {} ticks", simulation.ticks());
        simulation.run_to_tick(stretch.from).expect("the scene runs");
        simulation
    };
    let mut group = criterion.benchmark_group("tick");
    group
        .throughput(Throughput::Elements(stretch.count))
        .sample_size(stretch.samples)
        .measurement_time(Duration::from_secs(5));
    group.bench_function(name, |bencher| {
        let run = |mut simulation: Simulation| {
            simulation.run_to_tick(end).expect("the scene runs");
            simulation
        };
        bencher.iter_batched(at_start, run, BatchSize::PerIteration);
    });
    group.finish();
}

/// A thousand discs, each written out as a body of its own.
fn thousand_bodies() -> String {
    let mut scene =
        String::from("Scene(format: 1, clock: (duration: 1, tick: \"1 ms\"), gravity: (0, -9.81),\n    bodies: [\n");
    for body in 0..1000 {
        let (column, row) = (body % 40, body / 40);
        writeln!(scene, "        (name: \"disc_{body}\", at: ({column}, {row}), atoms: Disc(radius: 0.4, mass: 0.5)),")
            .expect("text is memory");
    }
    scene + "    ],\n)\n"
}

/// A thousand discs that fall by chance into a box: in the first second they meet, and loss brings them to rest.
const SETTLING: &str = r#"Scene(
    format: 1,
    clock: (duration: 2, tick: "0.2 ms", method: VelocityVerlet),
    gravity: (0, -9.81),
    materials: { "grain": (stiffness: "10 kN/m", friction: 0.4, restitution: 0.5, density: 10) },
    walls: [
        (name: "floor", left: (1.5, 0), right: (0, 0), material: "grain"),
        (name: "left", left: (0, 0), right: (0, 1), material: "grain"),
        (name: "right", left: (1.5, 1), right: (1.5, 0), material: "grain"),
    ],
    fill: [(name: "grain", atoms: Disc(radius: 0.02), material: "grain", count: 1000, within: ((0, 0), (1.5, 2)), speed: 0.5, seed: 1)],
)"#;

fn few(criterion: &mut Criterion) {
    // Blocks among pegs; the break shot is at 0.35 s.
    ticks(
        criterion,
        "tetris",
        include_str!("../../scenes/tetris.ron"),
        &Stretch { from: 1_000, count: 10_000, samples: 20 },
    );
    ticks(
        criterion,
        "billiards",
        include_str!("../../scenes/billiards.ron"),
        &Stretch { from: 3_000, count: 20_000, samples: 20 },
    );
}

fn many(criterion: &mut Criterion) {
    // Sand runs through the neck; the heap of the fill builds up.
    ticks(
        criterion,
        "hourglass",
        include_str!("../../scenes/hourglass.ron"),
        &Stretch { from: 6_250, count: 400, samples: 10 },
    );
    ticks(criterion, "fill_settling", SETTLING, &Stretch { from: 2_500, count: 400, samples: 10 });
}

fn loading(criterion: &mut Criterion) {
    let scene = thousand_bodies();
    let mut group = criterion.benchmark_group("load");
    group.throughput(Throughput::Elements(1000)).sample_size(20).measurement_time(Duration::from_secs(3));
    group.bench_function("thousand_bodies", |bencher| bencher.iter(|| load("thousand.ron", black_box(&scene))));
    group.finish();
}

criterion_group!(benches, few, many, loading);
criterion_main!(benches);
