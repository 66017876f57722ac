//! What sensors tell of groups of bodies: flow through a gate, angle of repose, counts, means; and expressions of channels.
//!
//! Each case is made so that its value is known by hand. Tolerance: rounding. Not tested: how far a real heap is from a straight line.

use jostle::Simulation;
use jostle::scene::Source;

fn load(bodies: &str, rest: &str) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\", method: VelocityVerlet), contacts: None, bodies: [{bodies}], {rest})"
    );
    Simulation::load(&Source::new("sensed.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"))
}

fn read(simulation: &mut Simulation, name: &str) -> f64 {
    let channel = jostle::sensors::find(simulation.world_mut(), name).unwrap_or_else(|| panic!("no channel {name}"));
    simulation.value(&channel)
}

fn unit(simulation: &mut Simulation, name: &str) -> &'static str {
    jostle::sensors::find(simulation.world_mut(), name).unwrap_or_else(|| panic!("no channel {name}")).unit
}

/// Law: in free flight a body is at `x + v t`. Three go to the right at 1 m/s, through x = 0 after 150.5, 250.5 and 350.5 ms; one comes back
/// after 200.5 ms; one passes beside the gate. They are seen at the tick behind, and are in a window of 100 ticks for 100 ticks.
#[test]
fn the_flow_is_that_of_the_bodies_that_pass() {
    let body = |name: &str, x: f64, y: f64, speed: f64, mass: f64| {
        format!(
            "(name: \"{name}\", at: ({x:?}, {y:?}), velocity: ({speed:?}, 0), mass: {mass:?}, atoms: Disc(radius: 0.1)),"
        )
    };
    let bodies = body("go_0", -0.1505, 0.0, 1.0, 1.0)
        + &body("go_1", -0.2505, 0.5, 1.0, 2.0)
        + &body("go_2", -0.3505, -0.5, 1.0, 4.0)
        + &body("back", 0.2005, 0.0, -1.0, 8.0)
        + &body("go_beside", -0.1505, 1.5, 1.0, 16.0);
    let flow = |name: &str, rest: &str| {
        format!("Flow(name: \"{name}\", of: [\"go_*\", \"back\"], gate: ((0, 1), (0, -1)), window: \"100 ms\"{rest}),")
    };
    let sensors = flow("net", "")
        + &flow("left", ", direction: Left")
        + &flow("right", ", direction: Right")
        + &flow("both", ", direction: Both")
        + "Flow(name: \"long\", of: \"go_*\", gate: ((0, 1), (0, -1)))";
    let mut simulation = load(&bodies, &format!("sensors: [{sensors}]"));
    assert!(read(&mut simulation, "net.count.rate").is_nan(), "no time has passed");
    // Net, left, right and both: number and mass so far, number and mass in the window.
    for (tick, expected) in [
        (150, [[0.0, 0.0, 0.0, 0.0]; 4]),
        (151, [[1.0, 1.0, 1.0, 1.0], [1.0, 1.0, 1.0, 1.0], [0.0; 4], [1.0, 1.0, 1.0, 1.0]]),
        (201, [[0.0, -7.0, 0.0, -7.0], [1.0, 1.0, 1.0, 1.0], [1.0, 8.0, 1.0, 8.0], [2.0, 9.0, 2.0, 9.0]]),
        (250, [[0.0, -7.0, 0.0, -7.0], [1.0, 1.0, 1.0, 1.0], [1.0, 8.0, 1.0, 8.0], [2.0, 9.0, 2.0, 9.0]]),
        (251, [[1.0, -5.0, 0.0, -6.0], [2.0, 3.0, 1.0, 2.0], [1.0, 8.0, 1.0, 8.0], [3.0, 11.0, 2.0, 10.0]]),
        (301, [[1.0, -5.0, 1.0, 2.0], [2.0, 3.0, 1.0, 2.0], [1.0, 8.0, 0.0, 0.0], [3.0, 11.0, 1.0, 2.0]]),
        (999, [[2.0, -1.0, 0.0, 0.0], [3.0, 7.0, 0.0, 0.0], [1.0, 8.0, 0.0, 0.0], [4.0, 15.0, 0.0, 0.0]]),
    ] {
        simulation.run_to_tick(tick).unwrap();
        for (name, [count, mass, recent, recent_mass]) in ["net", "left", "right", "both"].into_iter().zip(expected) {
            let mut of = |quantity: &str| read(&mut simulation, &format!("{name}.{quantity}"));
            assert_eq!([of("count"), of("mass")], [count, mass], "{name} at tick {tick}");
            let window = tick.min(100) as f64 * 1e-3;
            let rates = [of("count.rate") - recent / window, of("mass.rate") - recent_mass / window];
            assert!(rates.iter().all(|off| off.abs() < 1e-12), "{name} at tick {tick}: {rates:?}");
        }
        // Three in the last half second, and before that as many as since the start.
        if tick == 301 {
            assert!((read(&mut simulation, "long.count.rate") - 2.0 / 0.301).abs() < 1e-12);
        }
    }
    let units = ["count", "mass", "count.rate", "mass.rate"].map(|what| unit(&mut simulation, &format!("net.{what}")));
    assert_eq!(units, ["", "kg", "1/s", "kg/s"]);
}

/// A heap of fixed discs: the tops of columns lie on straight lines of 20 degrees on the left and of 35 degrees on the right of the summit.
/// Discs below them, of other sizes, change nothing, and those that fly or are elsewhere neither. Turned together with gravity the heap
/// has the same angles. Tolerance: rounding of places of about 1 m, over heights of 0.1 m, 1e-14.
#[test]
fn the_angle_of_repose_is_that_of_the_slopes() {
    let slopes = [20.0_f64, 35.0].map(|angle| libm::tan(angle.to_radians()));
    let heap = |turn: f64| {
        let (sin, cos) = libm::sincos(turn);
        let disc = |number: usize, x: f64, top: f64, radius: f64, speed: f64| {
            let y = top - radius;
            let motion = if speed == 0.0 { "fixed: true".to_owned() } else { format!("velocity: ({speed:?}, 0)") };
            let at = format!("({:?}, {:?})", cos * x - sin * y, sin * x + cos * y);
            format!("(name: \"grain_{number}\", at: {at}, {motion}, atoms: Disc(radius: {radius:?})),")
        };
        let mut bodies = String::new();
        let mut number = 0;
        let mut add = |x: f64, top: f64, radius: f64, speed: f64| {
            bodies += &disc(number, x, top, radius, speed);
            number += 1;
        };
        for column in -12_i32..=12 {
            let x = 0.05 * f64::from(column);
            let top = 0.5 - x.abs() * slopes[usize::from(column > 0)];
            // Surface discs alternate in size.
            add(x, top, if column % 2 == 0 { 0.024 } else { 0.015 }, 0.0);
            add(x, top - 0.06, 0.02, 0.0);
        }
        // One that falls above the left flank, and one on the ground far away.
        add(-0.2, 0.9, 0.02, -2.0);
        add(5.0, 0.02, 0.02, 0.0);
        let sensors =
            "Repose(name: \"heap\", of: \"grain_*\", within: ((-0.9, -0.9), (0.9, 2)), slower_than: 0.1, column: 0.03),
            Repose(name: \"all\", of: \"grain_*\", within: ((-0.9, -0.9), (0.9, 2)), column: 0.03)";
        load(&bodies, &format!("gravity: ({:?}, {:?}), sensors: [{sensors}]", 9.81 * sin, -9.81 * cos))
    };
    for turn in [0.0, 0.3] {
        let mut simulation = heap(turn);
        let mut degrees = |name: &str| read(&mut simulation, name).to_degrees();
        let found = [degrees("heap.repose.left"), degrees("heap.repose.right"), degrees("heap.repose")];
        for (found, expected) in found.into_iter().zip([20.0, 35.0, 27.5]) {
            assert!((found - expected).abs() < 1e-11, "turned by {turn}: {found} instead of {expected}");
        }
        assert!((degrees("all.repose.right") - 35.0).abs() > 1.0, "what falls counts if it is not excluded");
        assert_eq!(unit(&mut simulation, "heap.repose"), "rad");
    }
}

/// A heap against a wall has one flank: the mean is that of this one. A single body has none.
#[test]
fn a_flank_of_fewer_than_three_points_has_no_angle() {
    let disc = |number: i32| {
        let x = 0.1 * f64::from(number);
        format!("(name: \"grain_{number}\", at: ({x:?}, {:?}), fixed: true, atoms: Disc(radius: 0.05)),", -0.5 * x)
    };
    let bodies: String = (0..10).map(disc).collect();
    let sensors = "sensors: [Repose(name: \"heap\", of: \"*\"), Repose(name: \"one\", of: \"grain_3\")]";
    let mut simulation = load(&bodies, sensors);
    assert!(read(&mut simulation, "heap.repose.left").is_nan());
    for name in ["heap.repose.right", "heap.repose"] {
        assert!((read(&mut simulation, name) - libm::atan(0.5)).abs() < 1e-14, "{name}");
    }
    assert!(read(&mut simulation, "one.repose").is_nan());
}

const FOUR: &str = "(name: \"b_0\", at: (0, 0), velocity: (0, 1), mass: 1, atoms: Disc(radius: 0.1)),
    (name: \"b_1\", at: (1, 0), velocity: (0, 2), mass: 2, atoms: Disc(radius: 0.1)),
    (name: \"b_2\", at: (2, 0), velocity: (0, -3), mass: 4, atoms: Disc(radius: 0.1)),
    (name: \"b_3\", at: (3, 0), velocity: (6, 0), angle: \"90 deg\", mass: 8, atoms: Disc(radius: 0.1))";

/// Speeds of 1, 2, 3 and 6 m/s have the mean 3 and the deviation `sqrt((4 + 1 + 0 + 9)/4)`.
#[test]
fn means_and_counts_by_hand() {
    let sensors = "sensors: [Mean(name: \"all\", of: \"b_*\", quantity: \"speed\"),
        Mean(name: \"some\", of: \"b_*\", quantity: \"velocity.y\", within: ((0.5, -1), (2.5, 1))),
        Mean(name: \"none\", of: \"b_*\", quantity: \"speed\", within: ((8, 8), (9, 9))),
        Count(name: \"bin\", of: \"b_*\", within: ((0.5, -1), (2.5, -1), (2.5, 1), (0.5, 1))), Count(name: \"each\", of: \"*\")]";
    let mut simulation = load(FOUR, sensors);
    let mut of = |name: &str| read(&mut simulation, name);
    assert_eq!(["all.mean", "all.least", "all.greatest"].map(&mut of), [3.0, 1.0, 6.0]);
    assert!((of("all.deviation") - 3.5_f64.sqrt()).abs() < 1e-15);
    assert_eq!(["some.mean", "some.deviation", "some.least", "some.greatest"].map(&mut of), [-0.5, 2.5, -3.0, 2.0]);
    assert!(["none.mean", "none.deviation", "none.least"].map(&mut of).iter().all(|value| value.is_nan()));
    assert_eq!(["bin.count", "bin.mass", "each.count", "each.mass"].map(&mut of), [2.0, 6.0, 4.0, 15.0]);
    assert_eq!(unit(&mut simulation, "some.deviation"), "m/s");
    // b_3 leaves nothing behind; b_1 has left the bin upwards, b_2 downwards, both after less than a second.
    simulation.run_to_tick(900).unwrap();
    assert_eq!(read(&mut simulation, "bin.count"), 0.0);
}

#[test]
fn expressions_are_those_of_their_channels() {
    let expressions = [
        ("gap", "b_2.position.x - b_1.position.x", 1.0, "m"),
        ("twice", "2 * b_3.position.x - 50 cm", 5.5, "m"),
        ("speed", "hypot(b_3.velocity.x, b_3.velocity.y)", 6.0, "m/s"),
        ("plain", "b_2.speed / (1 m/s) + b_1.contacts", 3.0, ""),
        ("angle", "b_3.angle / 1 deg", 90.0, ""),
        ("area", "b_1.position.x * b_2.position.x", 2.0, "m2"),
        ("odd", "b_1.position.x ^ 3 * b_2.speed", 3.0, "m4 s-1"),
        ("momentum", "all.mass * mean.mean", 45.0, "N s"),
        ("outer", "max(gap.value, 3 * inner.value)", 6.0, "m"),
        ("inner", "if(b_1.position.x > b_0.position.x, 2 m, 0 m)", 2.0, "m"),
        ("quoted", "'a heap.count' - 1", 3.0, ""),
        ("given", "b_1.position.x + {length}", 1.25, "m"),
    ];
    let written = expressions.map(|(name, text, ..)| format!("Expression(name: \"{name}\", of: \"{text}\"),")).concat();
    let rest = format!(
        "params: {{ \"length\": \"25 cm\" }}, sensors: [{written} Count(name: \"all\", of: \"*\"), Count(name: \"a heap\", of: \"*\"),
         Mean(name: \"mean\", of: \"*\", quantity: \"speed\"), Period(name: \"cross\", of: \"gap.value\", crossing: 0)],
         expect: [Channel(name: \"gap.value\", below: 9)]"
    );
    let mut simulation = load(FOUR, &rest);
    for (name, _, expected, symbol) in expressions {
        let name = format!("{name}.value");
        let found = read(&mut simulation, &name);
        assert!((found - expected).abs() < 1e-14, "{name}: {found}");
        assert_eq!(unit(&mut simulation, &name), symbol, "{name}");
    }
    let channels = simulation.get_resource::<jostle::sensors::Channels>().unwrap();
    let columns: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
    assert!(expressions.iter().all(|(name, ..)| columns.contains(&&*format!("{name}.value"))), "{columns:?}");
    // What is not known yet is not known here either.
    let mut early = load(FOUR, "sensors: [Expression(name: \"push\", of: \"b_0.acceleration.x * 2 kg\")]");
    assert!(read(&mut early, "push.value").is_nan());
    early.run_to_tick(1).unwrap();
    assert_eq!((read(&mut early, "push.value"), unit(&mut early, "push.value")), (0.0, "N"));
}
