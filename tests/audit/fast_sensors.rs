//! Sensors that count from look to look, in motions that are faster than the frames of a film.
//!
//! Law: a mass on a spring swings as `A cos(w t)`. It passes a gate at `A/2` twice in each period, and crosses zero upwards once. Its speed is
//! `A w |sin(w t)|`. A thrown body is at height h at `(v -+ sqrt(v^2 - 2 g h))/g`. A body that turns uniformly comes back after
//! `2 pi/w`. Tolerances: places err by the share that the run states, so times by that share over `w`. The root of the cubic polynomial
//! errs by 1e-5 of a period at most (`tick/looks.rs`). In runs with ticks it errs by `(w dt)^3 dt/40`. Counts are exact: no gate lies where the motion turns.
//!
//! Not tested: channels that jump within a step.

use std::f64::consts::TAU;

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::world::hash::state_hash;

/// How a run is made.
#[derive(Clone, Copy, Debug)]
enum Way {
    Plain,
    Tolerance(f64),
    Reference,
    /// A method without states inside steps.
    Steps(&'static str, f64),
}

impl Way {
    fn overrides(self) -> Overrides {
        let (method, tolerance) = match self {
            Self::Plain => (None, None),
            Self::Tolerance(tolerance) => (None, Some(tolerance)),
            Self::Reference => (Some("Reference"), None),
            Self::Steps(method, tolerance) => (Some(method), Some(tolerance)),
        };
        Overrides { method: method.map(str::to_owned), tolerance, ..Overrides::default() }
    }

    /// The share by which times of crossings may be off.
    fn share(self) -> f64 {
        match self {
            // `(w dt)^3 dt/40` of 80 ticks in a swing, and the phase error of a second order, `(w dt)^2/24`.
            Self::Plain => (TAU / 80.0).powi(2) / 24.0,
            Self::Tolerance(tolerance) | Self::Steps(_, tolerance) => tolerance.max(1e-5),
            Self::Reference => 1e-6,
        }
    }
}

const WAYS: [Way; 6] = [
    Way::Plain,
    Way::Tolerance(1e-3),
    Way::Tolerance(1e-6),
    Way::Tolerance(1e-9),
    Way::Reference,
    Way::Steps("RungeKutta4", 1e-4),
];

fn load(text: &str, way: Way) -> Simulation {
    Simulation::load_with(&Source::new("fast.ron", text), &way.overrides(), |_| {})
        .unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

fn value(simulation: &mut Simulation, name: &str) -> f64 {
    let channel = jostle::sensors::find(simulation.world_mut(), name).unwrap_or_else(|| panic!("no channel {name}"));
    simulation.value(&channel)
}

/// The scene of the defect at another frequency in Hz.
fn oscillator(frequency: f64, duration: f64) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/defects/period_sensor.ron");
    let text = std::fs::read_to_string(path).unwrap();
    let stiffness = (TAU * frequency).powi(2);
    let text = text.replace("15791.367", &format!("{stiffness:?}"));
    text.replace("duration: 1)", &format!("duration: {duration:?})"))
}

#[test]
fn periods_counts_and_flows_of_fast_swings() {
    for (frequency, duration) in [(1.0, 2.0), (7.3, 1.0), (20.0, 1.0), (110.0, 0.3), (480.0, 0.1)] {
        for way in WAYS {
            let mut simulation = load(&oscillator(frequency, duration), way);
            simulation.run_to_end().unwrap();
            let swings = frequency * duration;
            // Passages at the phases 1/6 and 5/6 of each period, upward crossings of zero at 3/4.
            let passed =
                2.0 * swings.floor() + [1.0, 5.0].iter().filter(|at| swings.fract() > *at / 6.0).count() as f64;
            let crossed = swings.floor() + f64::from(swings.fract() > 0.75);
            let place = format!("{frequency} Hz, {way:?}");
            assert_eq!(value(&mut simulation, "g.count"), passed, "{place}");
            assert_eq!(value(&mut simulation, "fl.count"), passed, "{place}");
            let left = value(&mut simulation, "g.count.net");
            assert_eq!(left, passed % 2.0, "{place}");
            // A crossing is known one look later.
            let crossings = value(&mut simulation, "sw.crossings");
            assert!(crossings == crossed || crossings + 1.0 == crossed, "{place}: {crossings} of {crossed}");
            let share = way.share();
            for period in ["sw.period", "sw.period.mean"] {
                let found = value(&mut simulation, period);
                assert!((found * frequency - 1.0).abs() < 2.0 * share, "{place}: {period} {found}");
            }
            let rate = value(&mut simulation, "fl.count.rate");
            let dt = simulation.clock().dt;
            let window = ((0.5 / dt).round() * dt).min(duration);
            assert!((rate * window - 2.0 * frequency * window).abs() <= 2.0, "{place}: {rate} in {window} s");
        }
    }
}

/// The motion is the same whether sensors look or not, in any batches.
#[test]
fn looks_inside_steps_change_no_bit() {
    let scenes = [
        oscillator(20.0, 0.5),
        "Scene(format: 1, clock: (duration: 1), gravity: (0, -9.81),
            walls: [(name: \"floor\", left: (1, 0), right: (-1, 0))],
            joints: [Revolute(a: \"rod\", b: World, anchor_a: (-0.3, 0))],
            sensors: [Period(name: \"p\", of: \"ball.position.y\", crossing: 0.2)],
            bodies: [(name: \"ball\", at: (0, 0.5), atoms: Disc(radius: 0.1)),
                     (name: \"rod\", at: (0.3, 2), mass: 1, inertia: 0.1, shape: Disc(radius: 0.05))])"
            .to_owned(),
    ];
    for text in scenes {
        for way in [Way::Tolerance(1e-3), Way::Tolerance(1e-7), Way::Reference, Way::Steps("RungeKutta4", 1e-4)] {
            let begin = text.find("sensors: [").unwrap();
            let end = begin + text[begin..].find(")],\n").unwrap() + 3;
            let plain = format!("{}{}", &text[..begin], &text[end..]);
            let hash = |text: &str, batch: u64| {
                let mut simulation = load(text, way);
                while simulation.clock().ticks < simulation.ticks() {
                    let next = (simulation.clock().ticks + batch).min(simulation.ticks());
                    simulation.run_to_tick(next).unwrap();
                }
                let crossings = value(&mut simulation, "energy.kinetic");
                (state_hash(simulation.bodies()), crossings.to_bits())
            };
            let expected = hash(&plain, u64::MAX >> 1);
            for batch in [1, 4, u64::MAX >> 1] {
                assert_eq!(hash(&text, batch), expected, "{way:?}, batches of {batch}");
            }
        }
    }
}

/// A gate that is passed upwards and downwards within one frame, or within one coarse tick.
#[test]
fn a_body_that_turns_within_a_frame_passes_twice() {
    for (clock, ways) in [("", &WAYS[..]), ("tick: 0.1, method: VelocityVerlet", &WAYS[..1])] {
        // Rises 0.3125 m within 0.25 s; the gate lies below the top by the way of so many seconds.
        for late in [0.004, 0.011, 0.03] {
            let gate = 0.3125 - 5.0 * late * late;
            let text = format!(
                "Scene(format: 1, clock: (duration: 0.5, {clock}), gravity: (0, -10), contacts: None,
                sensors: [Counter(name: \"k\", of: \"b\", gate: ((1, {gate:?}), (-1, {gate:?})))],
                bodies: [(name: \"b\", at: (0, 0), velocity: (0.1, 2.5), atoms: Disc(radius: 0.02))])"
            );
            for way in ways {
                let mut simulation = load(&text, *way);
                simulation.run_to_end().unwrap();
                let counts = [value(&mut simulation, "k.count"), value(&mut simulation, "k.count.net")];
                assert_eq!(counts, [2.0, 0.0], "{way:?}, {late} s, {clock}");
            }
        }
    }
}

/// A disc of 1 kg stands `m g/k` deep, and 30 N lift it at once. It parts within 2 ms, before the first frame ends. That touch counts.
#[test]
fn a_touch_at_the_start_counts_that_ends_within_the_first_frame() {
    let text = "Scene(format: 1, clock: (duration: 0.5), gravity: (0, -10), film: (fps: 10),
        sensors: [Counter(name: \"k\", of: \"b\", touching: \"floor\"), Contacts(of: \"b\")],
        forces: [Thrust(of: \"b\", force: (0, 30))], materials: {\"m\": (stiffness: 1e6)},
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
        bodies: [(name: \"b\", at: (0, 0.09999), material: \"m\", atoms: Disc(radius: 0.1, mass: 1))])";
    for way in WAYS {
        let mut simulation = load(text, way);
        simulation.run_to_end().unwrap();
        let counts = ["k.count", "b.contacts.begun", "b.contacts"].map(|name| value(&mut simulation, name));
        assert_eq!(counts, [1.0, 1.0, 0.0], "{way:?}");
    }
}

/// A wheel that turns uniformly bounds no step by its error. The sine of its angle crosses a value upwards once in each turn.
#[test]
fn a_wheel_that_turns_uniformly_is_seen() {
    for turns in [3.3, 77.0] {
        let text = format!(
            "Scene(format: 1, clock: (duration: 1), contacts: None,
            sensors: [Expression(name: \"seen\", of: \"sin(w.angle)\"),
                      Period(name: \"p\", of: \"seen.value\", crossing: 0.5)],
            forces: [Spring(a: \"b\", b: World, anchor_b: (0, -3), stiffness: 1)],
            bodies: [(name: \"w\", at: (0, 0), spin: {:?}, atoms: Disc(radius: 0.1)),
                     (name: \"b\", at: (0, -2), atoms: Disc(radius: 0.1))])",
            TAU * turns
        );
        let seen: Vec<f64> = [Way::Tolerance(1e-6), Way::Reference]
            .iter()
            .map(|way| {
                let mut simulation = load(&text, *way);
                simulation.run_to_end().unwrap();
                value(&mut simulation, "p.crossings")
            })
            .collect();
        assert!(seen.iter().all(|crossings| (crossings - turns).abs() <= 1.0), "{turns}: {seen:?}");
    }
}
