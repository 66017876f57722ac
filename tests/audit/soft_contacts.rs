//! Soft contacts: verdicts on overlaps, the stiffness of materials that give none, and paths that ticks do not see.
//!
//! Reference values are closed forms of a linear spring, given at each test. Tolerance of overlaps and bounces: the engine takes 40 ticks
//! for a contact, which leaves some thousandths of its depth.

use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

use super::ran::{Ran, run};

const G: f64 = 9.81;

fn defect(name: &str) -> String {
    let path = format!("{}/assets/defects/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|wrong| panic!("{path}: {wrong}"))
}

#[track_caller]
fn ran(text: &str, looks: u64) -> Ran {
    run(text, looks).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

fn loaded(text: &str, overrides: &Overrides) -> Simulation {
    let source = Source::new("soft.ron", text);
    Simulation::load_with(&source, overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

fn ended(text: &str) -> Simulation {
    let mut simulation = loaded(text, &Overrides::default());
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
    simulation
}

fn share(simulation: &Simulation) -> f64 {
    simulation.state().deepest_overlap().in_share.share
}

fn stiffness(simulation: &Simulation) -> f64 {
    simulation.bodies().atom_stiffness(0)
}

/// A verdict says nothing of an overlap below a twentieth of a radius, and names its effect from there on. From a tenth on it does not
/// trust contacts.
#[track_caller]
fn told_as_deserved(verdict: &str, share: f64, effect: &str) {
    let verdict = verdict.to_lowercase();
    let (names, doubts) = (verdict.contains("of a radius"), verdict.contains("do not trust the model at contacts"));
    assert_eq!((names, doubts), (share > 0.05, share > 0.1), "{share}: {verdict}");
    assert_eq!(verdict.contains(effect), names, "{share}, `{effect}`: {verdict}");
}

const SHARES: [f64; 8] = [0.01, 0.048, 0.052, 0.075, 0.098, 0.102, 0.25, 0.4];

/// Law: a disc whose weight presses it in by `d` rolls as one of the radius `r - d`. Without rebound it goes down to `d = m g/k` and
/// stays there. The verdict names that share of each turn.
#[test]
fn a_soft_wheel_rolls_less_far_and_the_verdict_says_by_how_much() {
    for radius in [0.01, 0.05, 1.0] {
        for share in SHARES {
            let (mass, speed) = (2.0, 3.0 * radius);
            let (stiffness, spin) = (mass * G / (share * radius), -speed / (radius * (1.0 - share)));
            let text = format!(
                "Scene(format: 1, clock: (duration: 2), gravity: (0, -{G}),
                    materials: {{\"m\": (stiffness: {stiffness:?}, restitution: 0, friction: 1)}},
                    walls: [(name: \"road\", left: (1, 0), right: (0, 0), material: \"m\")],
                    bodies: [(name: \"wheel\", at: (0, {radius:?}), velocity: ({speed:?}, 0), spin: {spin:?}, material: \"m\",
                        atoms: Disc(radius: {radius:?}, mass: {mass}))])"
            );
            let ran = ran(&text, 2);
            let [first, last] = [&ran.seen[0].1[0], &ran.seen[1].1[0]];
            let way = (last.place.x - first.place.x) / (first.angle - last.angle);
            let exact = radius * (1.0 - share);
            assert!((way - exact).abs() < 1e-3 * exact, "{radius}, {share}: {way} m per rad instead of {exact}");
            told_as_deserved(&ran.card.verdict, share, "a wheel rolls up to ");
            if share > 0.05 {
                let percent: f64 = format!("{:.1e}", share * 100.0).parse().unwrap();
                let words = format!("a wheel rolls up to {percent} % less far in a turn");
                assert!(ran.card.verdict.to_lowercase().contains(&words), "{words}: {}", ran.card.verdict);
            }
        }
    }
}

/// Law: a ball that falls by `h` and is pressed in by `D`, `k (1 + mu) D^2/2 = m g (h + D)`, rises by `h'` with `h' + D = e^2 (h + D)`, and
/// `e^2 = (1 - mu)/(1 + mu)`. The verdict names `(1 - e^2) D`.
#[test]
fn a_soft_bounce_is_lower_and_the_verdict_says_by_how_much() {
    for (radius, restitution) in [(0.1, 0.9), (0.02, 0.6), (0.5, 0.3)] {
        for share in SHARES {
            let (mass, deep, fall) = (0.5, share * radius, 4.0 * radius);
            let squared: f64 = restitution * restitution;
            let loading = 2.0 / (1.0 + squared);
            let stiffness = 2.0 * mass * G * (fall + deep) / (deep * deep * loading);
            let rise = squared * (fall + deep) - deep;
            let begins = (2.0 * fall / G).sqrt();
            // In the midst of the rise.
            let lasts = std::f64::consts::PI * (mass / stiffness).sqrt();
            let duration = begins + lasts + 0.5 * (2.0 * rise.max(0.0) / G).sqrt();
            let text = format!(
                "Scene(format: 1, clock: (duration: {duration:?}), gravity: (0, -{G}),
                    materials: {{\"m\": (stiffness: {stiffness:?}, restitution: {restitution:?})}},
                    walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
                    bodies: [(name: \"ball\", at: (0, {:?}), material: \"m\", atoms: Disc(radius: {radius:?}, mass: {mass}))])",
                radius + fall
            );
            let ran = ran(&text, 1);
            let found = ran.card.largest_overlap.meters;
            assert!((found - deep).abs() < 0.01 * deep, "{radius}, {share}: {found} m deep instead of {deep}");
            let ball = &ran.seen[0].1[0];
            if rise > 0.0 {
                let height = ball.place.y - radius + ball.velocity.y.powi(2) / (2.0 * G);
                assert!((height - rise).abs() < 0.01 * fall, "{radius}, {share}: {height} m instead of {rise}");
            }
            told_as_deserved(&ran.card.verdict, found / radius, "a bounce takes about ");
            assert_eq!(ran.card.verdict.contains("comes back up to "), found / radius > 0.05, "{}", ran.card.verdict);
        }
    }
}

/// Law: centres of equal discs in contact are nearer by their overlap, and a packing is denser by the square.
#[test]
fn a_soft_packing_is_denser_and_the_verdict_says_so() {
    let packing = |stiffness: f64| {
        format!(
            "Scene(format: 1, clock: (duration: 0.6), gravity: (0, -{G}),
                materials: {{\"m\": (stiffness: {stiffness:?}, restitution: 0, friction: 0.3, density: 100)}},
                walls: [(name: \"floor\", left: (0.5, 0), right: (0, 0), material: \"m\"),
                    (name: \"left\", left: (0, 0), right: (0, 1), material: \"m\"),
                    (name: \"right\", left: (0.5, 1), right: (0.5, 0), material: \"m\")],
                fill: [(name: \"g\", atoms: Disc(radius: 0.04), material: \"m\", count: 40, seed: 1, within: ((0, 0), (0.5, 0.9)))])"
        )
    };
    let verdict = ended(&packing(3e3)).card().verdict;
    assert!(
        verdict.contains("Do not trust the model at contacts") && verdict.contains("a packing is up to "),
        "{verdict}"
    );
    let verdict = ended(&packing(3e6)).card().verdict;
    assert!(!verdict.contains("a packing"), "{verdict}");
}

/// The scenes of users that were wrong and trusted.
#[test]
fn soft_scenes_are_not_trusted_in_silence() {
    for (name, effect) in
        [("odometry", "a wheel rolls up to "), ("soft_bounce", "a bounce takes about "), ("overlap", "a bounce")]
    {
        let verdict = ran(&defect(name).replace("duration: 10", "duration: 1"), 1).card.verdict;
        assert!(
            verdict.contains("Do not trust the model at contacts") && verdict.to_lowercase().contains(effect),
            "{name}: {verdict}"
        );
    }
}

/// The share of the smallest radius that the stiffness of a material without one allows, as the manual states.
const STATED: f64 = 0.02;

/// Velocity Verlet with 40 ticks for half a swing swings farther by `(omega dt)^2/24`, with `omega dt = pi/40`. A touch that begins
/// inside a tick adds up to `(omega dt)^2/8`.
const TICKS_LEAVE: f64 = 1.0 + 1.1e-3;

/// Law: a body of mass `m` at the speed `v` presses in a spring by `v sqrt(m/k)`. Two bodies do so with the reduced mass and half the
/// stiffness. The default stiffness keeps that below the stated share, and is not below 1000 N/m.
#[test]
fn the_default_stiffness_suits_masses_and_speeds() {
    let body = |name: &str, x: f64, v: f64, mass: f64, radius: f64| {
        format!(
            "(name: \"{name}\", at: ({x:?}, 0), velocity: ({v:?}, 0), atoms: Disc(radius: {radius:?}, mass: {mass:?}))"
        )
    };
    for mass in [1e-3, 0.03, 1.0, 30.0, 1e3] {
        for speed in [0.01, 0.3, 3.0, 20.0] {
            for radius in [0.01, 0.2] {
                // They meet soon, and part before the end.
                let duration = 0.3 * radius / speed;
                let scene = |what: String| format!("Scene(format: 1, clock: (duration: {duration:?}), {what})");
                let ball = body("ball", 1.1 * radius, -speed, mass, radius);
                let wall = "walls: [(name: \"w\", left: (0, 0), right: (0, 1))]";
                let fixed =
                    format!("(name: \"f\", at: ({:?}, 0), fixed: true, atoms: Disc(radius: {radius:?}))", -radius);
                let other = |mass: f64, radius: f64| body("other", -1.02 * radius, speed, mass, radius);
                for (what, expected) in [
                    (format!("{wall}, bodies: [{ball}]"), speed * mass.sqrt()),
                    (format!("bodies: [{ball}, {fixed}]"), speed * (2.0 * mass).sqrt()),
                    (format!("bodies: [{ball}, {}]", other(mass, radius)), 2.0 * speed * mass.sqrt()),
                    (format!("bodies: [{ball}, {}]", other(9.0 * mass, radius)), f64::NAN),
                    (format!("bodies: [{ball}, {}]", other(0.1 * mass, 0.5 * radius)), f64::NAN),
                ] {
                    let simulation = ended(&scene(what.clone()));
                    let (found, k) = (share(&simulation), stiffness(&simulation));
                    let of = format!("{mass} kg, {speed} m/s, {radius} m, {what}: {k} N/m, {found}");
                    assert!(k >= 1000.0 && found > 0.0 && found <= STATED * TICKS_LEAVE, "{of}");
                    // Not much stiffer than needed: two digits, and a sampled maximum.
                    let needed = (expected / (STATED * radius)).powi(2);
                    assert!(expected.is_nan() || k <= needed.max(1000.0) * 1.11, "{of}: {needed} would do");
                    let told = |note: &String| note.contains("N/m for bodies whose material gives none");
                    assert_eq!(simulation.notes().iter().any(told), k > 1000.0, "{of}");
                }
            }
        }
    }
}

/// Law: a body falls to the floor, to the bottom of a valley, to a shelf or onto another body. Bodies on it, and bodies that joints hold to
/// it, press too.
#[test]
fn the_default_stiffness_suits_falls_and_loads() {
    let floor = "walls: [(name: \"floor\", left: (1, 0), right: (0, 0))]";
    let valley = "walls: [(name: \"l\", left: (0, 0), right: (-1, 1)), (name: \"r\", left: (1, 1), right: (0, 0))]";
    let shelf = "walls: [(name: \"shelf\", from: (-1, 0), to: (1, 0))]";
    let disc = |name: &str, y: f64, mass: f64| {
        format!("(name: \"{name}\", at: (0, {y:?}), atoms: Disc(radius: 0.05, mass: {mass:?}))")
    };
    for mass in [1e-3, 1e3] {
        for fall in [0.0, 0.01, 0.5] {
            let ball = disc("ball", 0.05 + fall, mass);
            let high = disc("ball", 0.05 * 2.0_f64.sqrt() + fall, mass);
            let tower: Vec<String> = (0..5).map(|n| disc(&format!("d{n}"), 0.05 + 0.1 * f64::from(n), mass)).collect();
            let table = "(name: \"table\", fixed: true, at: (0, -0.5), shape: Rectangle(width: 2, height: 1))";
            let robot = format!(
                "(name: \"chassis\", at: (0, {:?}), mass: {mass:?}, shape: Rectangle(width: 0.3, height: 0.04)),
                 (name: \"rear\", at: (-0.1, {:?}), atoms: Disc(radius: 0.05, mass: {:?})),
                 (name: \"front\", at: (0.1, {:?}), atoms: Disc(radius: 0.05, mass: {:?}))],
                 joints: [Revolute(a: \"chassis\", b: \"rear\", anchor_a: (-0.1, -0.01)), Revolute(a: \"chassis\", b: \"front\", anchor_a: (0.1, -0.01))",
                0.06 + fall, 0.05 + fall, mass / 8.0, 0.05 + fall, mass / 8.0
            );
            for what in [
                format!("{floor}, bodies: [{ball}]"),
                format!("{valley}, bodies: [{high}]"),
                format!("{shelf}, bodies: [{ball}]"),
                format!("bodies: [{ball}, {table}]"),
                format!("{floor}, bodies: [{}]", tower.join(", ")),
                format!("{floor}, bodies: [{robot}]"),
            ] {
                let duration = (2.0 * fall / G).sqrt() + 0.1;
                let text = format!(
                    "Scene(format: 1, clock: (duration: {duration:?}), gravity: (0, -{G}), materials: {{\"default\": (restitution: 0.5)}}, {what})"
                );
                let simulation = ended(&text);
                let found = share(&simulation);
                assert!(found > 0.0 && found <= STATED * TICKS_LEAVE, "{mass} kg, {fall} m, {what}: {found}");
                let verdict = simulation.card().verdict;
                assert!(!verdict.contains("the model at contacts"), "{verdict}");
            }
        }
    }
}

/// Law: a light scene keeps 1000 N/m, and the bits of a scene that gives it. A factor of the stiffness multiplies what was chosen.
#[test]
fn the_default_stiffness_of_light_scenes_stays() {
    let scene = |materials: &str| {
        format!(
            "Scene(format: 1, clock: (duration: 1), gravity: (0, -1), {materials}
                walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
                bodies: [(name: \"ball\", at: (0, 0.12), atoms: Disc(radius: 0.1, mass: 0.05))])"
        )
    };
    let [left_out, given] =
        ["", "materials: {\"default\": (stiffness: 1000)},"].map(|materials| ended(&scene(materials)));
    assert_eq!((stiffness(&left_out), left_out.card().hash), (1000.0, given.card().hash));
    let heavy = scene("").replace("mass: 0.05", "mass: 50");
    let [once, four] =
        [None, Some(4.0)].map(|factor| loaded(&heavy, &Overrides { stiffness: factor, ..Overrides::default() }));
    assert!(stiffness(&once) > 1e5, "{}", stiffness(&once));
    assert_eq!(stiffness(&four), 4.0 * stiffness(&once));
    let mixed =
        heavy.replace("bodies: [", "bodies: [(name: \"own\", at: (9, 9), atoms: Disc(radius: 0.1, stiffness: 77)), ");
    assert_eq!(loaded(&mixed, &Overrides::default()).bodies().atom_stiffness(0), 77.0);
}

/// Law: a contact of mass `m` lasts `pi sqrt(m/k)`. A tick of the scene bounds the default stiffness, so that it lasts 20 ticks or more. The
/// card tells the overlap to expect. A tick of the command line changes nothing.
#[test]
fn the_tick_of_a_scene_bounds_the_default_stiffness() {
    for (mass, tick) in [(1.0, 1e-3), (0.5, 1e-4), (0.03, 1e-3), (20.0, 5e-3)] {
        let scene = |clock: &str| {
            format!(
                "Scene(format: 1, clock: (duration: 1{clock}), gravity: (0, -{G}), walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],
                    bodies: [(name: \"ball\", at: (0, 1.1), atoms: Disc(radius: 0.1, mass: {mass:?}))])"
            )
        };
        let by_tick = mass * (std::f64::consts::PI / (20.0 * tick)).powi(2);
        let wanted = mass * 2.0 * G * 1.002 / (0.002_f64 * 0.002);
        let bounded = ended(&scene(&format!(", tick: {tick:?}, method: VelocityVerlet")));
        let exact = by_tick.min(wanted).max(1000.0);
        assert!(
            (exact..1.11 * exact).contains(&stiffness(&bounded)),
            "{mass}, {tick}: {} for {exact}",
            stiffness(&bounded)
        );
        let told = |note: &String| note.contains("the tick of the scene is too long for that");
        assert_eq!(bounded.notes().iter().any(told), by_tick < wanted, "{:?}", bounded.notes());
        let overrides = Overrides { tick: Some(tick), ..Overrides::default() };
        let free = stiffness(&loaded(&scene(""), &overrides));
        assert!((wanted..1.11 * wanted).contains(&free), "{mass}: {free} for {wanted}");
    }
}

/// Law: a path that goes from stop to stop within few ticks meets bodies unseen. It is not trusted, whatever the error of the rest, and
/// the tick that the engine chooses resolves it.
#[test]
fn ticks_too_long_for_a_path_are_not_trusted() {
    let ran_into = ran(&defect("path_alias"), 1).card.verdict;
    assert!(ran_into.starts_with("Do not trust it") && ran_into.contains("the path of `piston`"), "{ran_into}");
    for swing in [2e-4, 5e-4, 7e-4, 1e-3, 2e-3, 0.05] {
        for repeat in [true, false] {
            let scene = |tick: &str| {
                format!(
                    "Scene(format: 1, clock: (duration: 0.3{tick}), materials: {{\"default\": (stiffness: 1e5)}}, bodies: [
                        (name: \"piston\", at: (0, 0), kinematic: (path: [(time: {swing:?}, by: (0.5, 0)), (time: {:?}, by: (0, 0))],
                            repeat: {repeat}), atoms: Disc(radius: 0.1)),
                        (name: \"ball\", at: (0, 4), velocity: (0.1, 0), atoms: Disc(radius: 0.1))])",
                    2.0 * swing
                )
            };
            let verdict = ended(&scene(", tick: 1e-3, method: VelocityVerlet")).card().verdict;
            assert_eq!(verdict.contains("the path of `piston`"), swing < 2.4e-3, "{swing}: {verdict}");
            let verdict = ended(&scene("")).card().verdict;
            assert!(!verdict.contains("the path of `piston`"), "{swing}: {verdict}");
        }
    }
}

/// Law: bars that cross have no corner inside each other, so no contact parts them. The card names them, and the verdict doubts them.
#[test]
fn bars_that_cross_are_not_trusted() {
    let verdict = ran(&defect("overlap_trust"), 1).card.verdict;
    assert!(verdict.contains("Do not trust the model at contacts"), "{verdict}");
    for degrees in [20, 45, 90, 130] {
        for (width, at) in [(1.0, 0.0), (1.0, 0.2), (3.0, -0.1)] {
            for load in ["", ", gravity: (0, -1), walls: [(name: \"floor\", left: (1, -0.6), right: (0, -0.6))]"] {
                let text = format!(
                    "Scene(format: 1, clock: (duration: 0.05){load}, bodies: [
                        (name: \"a\", at: (0, 0), shape: Rectangle(width: {width:?}, height: 0.1)),
                        (name: \"b\", at: ({at:?}, 0), angle: \"{degrees} deg\", shape: Capsule(from: (-0.5, 0), to: (0.5, 0), radius: 0.02))])"
                );
                let card = ran(&text, 1).card;
                let of = format!("{degrees}, {width}, {at}: {}", card.verdict);
                assert!(card.verdict.contains("Do not trust the model at contacts"), "{of}");
                assert!(card.verdict.contains("`a` and `b` overlap at the start"), "{of}");
                assert!(card.largest_overlap_share.share_of_radius > 0.5, "{of}");
            }
        }
    }
}
