//! Scenes made by `params`, `templates`, `instances` and `Repeat` equal their written-out forms.
//!
//! Each is compared with a scene written out by hand: same names in the same order, and after the run the same bits.
//! Tolerance: none; the numbers by hand are those that the expressions round to. Not tested here: messages, which stand
//! in `tests/wrong_scenes/authoring`, and files, which `authoring_files` tests.

use jostle::Simulation;
use jostle::scene::Source;
use jostle::world::hash::state_hash;

/// Names of all bodies and the hash of the state in the end.
pub fn end(source: &Source) -> (Vec<String>, u64) {
    let mut simulation = Simulation::load(source).unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_end().unwrap();
    let names = (0..simulation.bodies().len()).map(|index| simulation.name(index).to_owned()).collect();
    (names, state_hash(simulation.bodies()))
}

const HEAD: &str = "Scene(format: 1, clock: (duration: 0.5, tick: \"1 ms\"), gravity: (0, -9.81),
    walls: [(name: \"floor\", left: (1, 0), right: (0, 0))],";

#[track_caller]
fn same(made: &str, by_hand: &str) {
    let [made, by_hand] = [made, by_hand].map(|scene| end(&Source::new("a.ron", format!("{HEAD}{scene})"))));
    assert_eq!(made, by_hand);
}

#[test]
fn expressions_are_the_numbers_they_stand_for() {
    same(
        r#"params: { "n": 5, "gap": "2 cm", "r": "0.5 * gap", "high": "2 * r + 3 cm", "start": (0.25, 1) },
        bodies: [
            (name: "a", at: ("n", "high"), spin: "n * 2 rad / 1 s", atoms: Disc(radius: "r")),
            (name: "b", at: "start", velocity: ("-n", "if(n > 3, 1 m/s, 2)"), angle: "90 deg", atoms: Disc(radius: "10 * r", mass: "n")),
        ],"#,
        r#"bodies: [
            (name: "a", at: (5, 0.05), spin: 10, atoms: Disc(radius: 0.01)),
            (name: "b", at: (0.25, 1), velocity: (-5, 1), angle: "90 deg", atoms: Disc(radius: 0.1, mass: 5)),
        ],"#,
    );
}

#[test]
fn expressions_need_no_parameters() {
    same(
        r#"bodies: [
            (name: "pi", at: ("2*cos(0)", "1 + 2^2"), spin: "3*2", atoms: Disc(radius: "2*1 cm")),
            (name: "b", at: ("-8*(1 m)", 1), angle: "pi", atoms: Disc(radius: 0.1)),
        ],"#,
        r#"bodies: [
            (name: "pi", at: (2, 5), spin: 6, atoms: Disc(radius: 0.02)),
            (name: "b", at: (-8, 1), angle: 3.141592653589793, atoms: Disc(radius: 0.1)),
        ],"#,
    );
}

/// A text that is a name stays a name, though a parameter is called so too.
#[test]
fn texts_stay_texts() {
    same(
        r#"params: { "r": 0.5, "stuff": "steel" },
        materials: { "r": (friction: 0.5), "steel": (friction: 0.25) },
        bodies: [
            (name: "r", at: ("r", "r"), velocity: (1, 0), material: "r", atoms: Disc(radius: 0.5)),
            (name: "{stuff}_{2 * r}", at: (4, "r"), velocity: (1, 0), material: "{stuff}", atoms: Disc(radius: "r")),
        ],
        forces: [Drag(linear: 0.5, of: "r")],"#,
        r#"materials: { "r": (friction: 0.5), "steel": (friction: 0.25) },
        bodies: [
            (name: "r", at: (0.5, 0.5), velocity: (1, 0), material: "r", atoms: Disc(radius: 0.5)),
            (name: "steel_1", at: (4, 0.5), velocity: (1, 0), material: "steel", atoms: Disc(radius: 0.5)),
        ],
        forces: [Drag(linear: 0.5, of: "r")],"#,
    );
}

const BOBS: &str = r#"templates: {
        "bob": (
            args: ["x", "tilt"],
            params: { "m": 1 },
            materials: { "own": (stiffness: 500) },
            bodies: [
                (name: "ball", at: ("x", 0.25), angle: "tilt", material: "own", atoms: Disc(radius: 0.125, mass: "m")),
                (name: "weight", at: ("x + 0.5", 2), atoms: Disc(radius: 0.25, mass: 1)),
            ],
            fill: [(name: "dust", atoms: Disc(radius: 0.01), count: 3, within: ((5, 5), (6, 6)))],
            forces: [Drag(linear: 0.5, of: "ball"), Torque(of: "dust_*", value: 0.001)],
        ),
        "pair": (
            args: ["at"],
            instances: [
                (of: "bob", name: "left", with: (x: "at - 4", tilt: 0)),
                (of: "bob", name: "right", with: (x: "at + 4", tilt: "90 deg", m: 2)),
            ],
            forces: [Drag(linear: 0.25, of: "left/weight")],
        ),
    },"#;

#[test]
fn instances_have_names_and_references_of_their_own() {
    same(
        &format!(
            r#"{BOBS}
        bodies: [(name: "ball", at: (0, 9), atoms: Disc(radius: 0.1))],
        instances: [(of: "bob", name: "one", with: (x: 1, tilt: "0 deg"))],
        forces: [Drag(linear: 1, of: "ball")],"#
        ),
        r#"materials: { "one/own": (stiffness: 500) },
        bodies: [
            (name: "ball", at: (0, 9), atoms: Disc(radius: 0.1)),
            (name: "one/ball", at: (1, 0.25), material: "one/own", atoms: Disc(radius: 0.125, mass: 1)),
            (name: "one/weight", at: (1.5, 2), atoms: Disc(radius: 0.25, mass: 1)),
        ],
        fill: [(name: "one/dust", atoms: Disc(radius: 0.01), count: 3, within: ((5, 5), (6, 6)))],
        forces: [Drag(linear: 0.5, of: "one/ball"), Torque(of: "one/dust_*", value: 0.001), Drag(linear: 1, of: "ball")],"#,
    );
}

#[test]
fn overrides_reach_every_field_also_through_templates_in_templates() {
    let ball = |name: &str, x: f64, more: &str, atoms: &str, own: &str| {
        format!(
            r#"(name: "{name}/ball", at: ({x}, 0.25), {more} material: "{own}", atoms: Disc({atoms})),
            (name: "{name}/weight", at: ({}, 2), atoms: Disc(radius: 0.25, mass: 1)),"#,
            x + 0.5
        )
    };
    let dust = |name: &str| {
        format!(r#"(name: "{name}/dust", atoms: Disc(radius: 0.01), count: 3, within: ((5, 5), (6, 6))),"#)
    };
    let forces =
        |name: &str| format!(r#"Drag(linear: 0.5, of: "{name}/ball"), Torque(of: "{name}/dust_*", value: 0.001),"#);
    same(
        &format!(
            r#"{BOBS}
        materials: {{ "soft": (stiffness: 100) }},
        instances: [(of: "pair", name: "p", with: (at: 10), set: {{
            "left/ball.mass": "2 * 3",
            "left/ball.velocity": (1, 0),
            "right/ball.atoms.radius": 0.0625,
            "*/ball.at[1]": 0.25,
            "left/own.stiffness": 250,
        }})],"#
        ),
        &format!(
            r#"materials: {{ "soft": (stiffness: 100), "p/left/own": (stiffness: 250), "p/right/own": (stiffness: 500) }},
        bodies: [{}{}],
        fill: [{}{}],
        forces: [{}{} Drag(linear: 0.25, of: "p/left/weight")],"#,
            ball("p/left", 6.0, "mass: 6, velocity: (1, 0),", "radius: 0.125, mass: 1", "p/left/own"),
            ball("p/right", 14.0, "angle: \"90 deg\",", "radius: 0.0625, mass: 2", "p/right/own"),
            dust("p/left"),
            dust("p/right"),
            forces("p/left"),
            forces("p/right"),
        ),
    );
}

#[test]
fn repeats_write_lines_grids_and_circles() {
    same(
        r#"bodies: [
            Repeat(count: 3, line: (from: (0, 1), to: (4, 2)), make: (name: "l_{i}", at: ("x", "y"), atoms: Disc(radius: 0.25))),
            Repeat(count: (2, 2), grid: (from: (10, 1), step: (1, 2)), make: (name: "g_{i}_{j}", at: ("x", "y"), atoms: Disc(radius: 0.25))),
            Repeat(count: 4, circle: (center: (20, 5), radius: 2, start: "0 deg"), make: (name: "c_{i}", at: ("round(x)", "round(y)"), spin: "angle", atoms: Disc(radius: 0.25))),
            (name: "row", at: (30, 1), atoms: List([
                Repeat(count: 2, as: "k", make: [(at: ("k", 0), radius: 0.25), (at: ("k", 0.5), radius: 0.125)]),
                (at: (2, 0), radius: 0.5),
            ])),
        ],"#,
        r#"bodies: [
            (name: "l_0", at: (0, 1), atoms: Disc(radius: 0.25)),
            (name: "l_1", at: (2, 1.5), atoms: Disc(radius: 0.25)),
            (name: "l_2", at: (4, 2), atoms: Disc(radius: 0.25)),
            (name: "g_0_0", at: (10, 1), atoms: Disc(radius: 0.25)),
            (name: "g_1_0", at: (11, 1), atoms: Disc(radius: 0.25)),
            (name: "g_0_1", at: (10, 3), atoms: Disc(radius: 0.25)),
            (name: "g_1_1", at: (11, 3), atoms: Disc(radius: 0.25)),
            (name: "c_0", at: (22, 5), atoms: Disc(radius: 0.25)),
            (name: "c_1", at: (20, 7), spin: "90 deg/s", atoms: Disc(radius: 0.25)),
            (name: "c_2", at: (18, 5), spin: "180 deg/s", atoms: Disc(radius: 0.25)),
            (name: "c_3", at: (20, 3), spin: "270 deg/s", atoms: Disc(radius: 0.25)),
            (name: "row", at: (30, 1), atoms: List([
                (at: (0, 0), radius: 0.25), (at: (0, 0.5), radius: 0.125),
                (at: (1, 0), radius: 0.25), (at: (1, 0.5), radius: 0.125),
                (at: (2, 0), radius: 0.5),
            ])),
        ],"#,
    );
}

/// Walls and instances are repeated as bodies are, and repeats stand in each other.
#[test]
fn whatever_stands_in_a_list_is_repeated() {
    let scene =
        |more: &str| format!("Scene(format: 1, clock: (duration: 0.5, tick: \"1 ms\"), gravity: (0, -9.81), {more})");
    let made = scene(
        r#"walls: [Repeat(count: 2, make: (name: "floor_{i}", left: (1, "i / 4"), right: (0, "i / 4")))],
        templates: { "bob": (args: ["x"], bodies: [(name: "ball", at: ("x", 1), atoms: Disc(radius: 0.125))]) },
        instances: [Repeat(count: 2, make: Repeat(count: 2, as: "k", make: (of: "bob", name: "b_{i}{k}", with: (x: "2 * i + k"))))],"#,
    );
    let by_hand = scene(
        r#"walls: [(name: "floor_0", left: (1, 0), right: (0, 0)), (name: "floor_1", left: (1, 0.25), right: (0, 0.25))],
        bodies: [
            (name: "b_00/ball", at: (0, 1), atoms: Disc(radius: 0.125)), (name: "b_01/ball", at: (1, 1), atoms: Disc(radius: 0.125)),
            (name: "b_10/ball", at: (2, 1), atoms: Disc(radius: 0.125)), (name: "b_11/ball", at: (3, 1), atoms: Disc(radius: 0.125)),
        ],"#,
    );
    assert_eq!(end(&Source::new("a.ron", made)), end(&Source::new("a.ron", by_hand)));
}

#[test]
fn parameters_are_set_from_outside() {
    let scene = |n: &str| {
        format!(
            "{HEAD} params: {{ \"n\": {n}, \"r\": \"1 / (2 * n)\" }},
            bodies: [Repeat(count: \"n\", make: (name: \"b_{{i}}\", at: (\"i\", \"r\"), atoms: Disc(radius: \"r\")))])"
        )
    };
    let set = |value: &str| Source::new("a.ron", scene("5")).with_settings(&[("n".to_owned(), value.to_owned())]);
    assert_eq!(end(&set("2")), end(&Source::new("a.ron", scene("2"))));
    assert_eq!(end(&set("2 * 4")).0.len(), 8);
    let message = |name: &str, value: &str| {
        let source = Source::new("a.ron", scene("5")).with_settings(&[(name.to_owned(), value.to_owned())]);
        Simulation::load(&source).err().expect("it is wrong").errors()[0].clone()
    };
    let unknown = message("m", "3");
    assert_eq!((unknown.path.as_str(), unknown.message.as_str()), ("--set m", "the scene has no parameter `m`"));
    assert_eq!(unknown.help.as_deref(), Some("did you mean `n`? parameters: `n`, `r`"));
    assert_eq!(
        message("n", "1 / r").message,
        "parameters are made from each other in a circle: `n` needs `r` needs `n`"
    );
    assert_eq!(message("n", "2 * (3").message, "this bracket is never closed in `2 * (3`");
}

/// The time this thread was at work, in s: that of the clock would count what other programs do. Where the system does not
/// tell, it is that of the clock.
fn seconds_busy() -> f64 {
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|told| told.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.elapsed().as_secs_f64(), |nanoseconds| nanoseconds * 1e-9)
}

/// A few hundred bytes must not keep the reader busy for more than 5 s; that a message comes at all also says that the
/// memory was enough. The largest scene that is made takes longest.
#[test]
fn small_texts_make_no_endless_work() {
    let chain =
        |link: &dyn Fn(usize) -> String| (0..40).map(|n| format!("\"p{n}\": {}, ", link(n))).collect::<String>();
    let ball = "(name: \"ball\", at: (0, 0), atoms: Disc(radius: 0.1))";
    let deep = "Repeat(count: 500, make: ".repeat(12) + ball + &")".repeat(12);
    let doubled = |body: &str| {
        format!("params: {{ {} \"p40\": 1 }}, bodies: [{body}],", chain(&|n| format!("(\"p{0}\", \"p{0}\")", n + 1)))
    };
    let scenes = [
        format!("bodies: [{deep}],"),
        doubled("(name: \"ball\", at: \"p0\", atoms: Disc(radius: 0.1))"),
        format!(
            "params: {{ {} \"p40\": \"x\" }}, bodies: [(name: \"{{p0}}\", at: (0, 0), atoms: Disc(radius: 0.1))],",
            chain(&|n| format!("\"{{p{0}}}{{p{0}}}\"", n + 1))
        ),
        format!(
            "templates: {{ {} \"p20\": (bodies: []) }}, instances: [(of: \"p0\", name: \"a\")], bodies: [{ball}],",
            (0..20)
                .map(|n| format!(
                    "\"p{n}\": (instances: [(of: \"p{0}\", name: \"a\"), (of: \"p{0}\", name: \"b\"), (of: \"p{0}\", name: \"c\")]), ",
                    n + 1
                ))
                .collect::<String>()
        ),
        format!(
            "bodies: [Repeat(count: 200000, make: (name: \"b_{{i}}\", at: (\"i{}\", 0), atoms: Disc(radius: 0.1)))],",
            " + 1".repeat(2000)
        ),
        format!("params: {{ {} \"q\": 1 }}, bodies: [{ball}],", (0..50_000).map(|n| format!("\"p{n}\": \"p{} + 1\", ", n + 1)).collect::<String>())
            .replace("at: (0, 0)", "at: (\"p0\", 0)"),
        format!("params: {{ \"p\": \"{}1\" }}, bodies: [{}],", "(".repeat(100_000), ball.replace("(0, 0)", "(\"p\", 0)")),
    ];
    for scene in scenes {
        let source = Source::new("a.ron", format!("{HEAD}{scene})"));
        let start = seconds_busy();
        let errors = Simulation::load(&source).err().unwrap_or_else(|| panic!("taken as good: {:.200}", source.text));
        let seconds = seconds_busy() - start;
        // Work of the processor, not time on a clock. A bound that is missing shows as minutes, a slow machine does not.
        assert!(seconds < 60.0, "{seconds} s for {:.200}", source.text);
        let first = &errors.errors()[0];
        let bounds = ["more than", "too large", "too deeply", "too long"];
        assert!(bounds.iter().any(|bound| first.message.contains(bound)), "{}: {:.200}", first.message, source.text);
    }
}
