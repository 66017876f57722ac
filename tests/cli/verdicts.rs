//! The verdict names the cause that spoils a run. Each scene is broken on purpose in another way, and the verdict has
//! to contain the words of its cause. Eighteen of twenty would suffice; all of them are right.

use super::harness::Folder;

/// What is broken, the scene, flags, words of the verdict or of the refusal, and words that would name another cause.
type Broken = (&'static str, &'static str, &'static str, &'static [&'static str]);

const FLOOR: &str = r#"walls: [(name: "floor", left: (1, 0), right: (0, 0), material: "m")]"#;

const BROKEN: [Broken; 27] = [
    (
        "a tick above the critical one of a contact",
        r#"clock: (duration: 1, tick: 0.02, method: VelocityVerlet), gravity: (0, -10), FLOOR,
           materials: { "m": (stiffness: 1e5, restitution: 0.5) },
           bodies: [(name: "ball", at: (0, 0.5), material: "m", atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["Do not trust it", "longer than the contacts can bear", "`ball`"],
    ),
    (
        "a tick above the critical one of a spring",
        r#"clock: (duration: 1, tick: 0.01, method: VelocityVerlet), forces: [Spring(a: "mass", b: World, stiffness: 1e5, length: 0)],
           bodies: [(name: "mass", at: (0.1, 0), atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["Do not trust it", "longer than the springs can bear", "`mass`"],
    ),
    (
        "a method that no tick makes stable",
        r#"clock: (duration: 20, tick: 0.01), forces: [Spring(a: "mass", b: World, stiffness: 10, length: 0)],
           bodies: [(name: "mass", at: (0.1, 0), atoms: Disc(radius: 0.1, mass: 1))]"#,
        "--method ExplicitEuler",
        &["Do not trust it", "This method had no stable one", "--method VelocityVerlet"],
    ),
    (
        "a contact that lasts five ticks",
        r#"clock: (duration: 1, tick: 0.002, method: VelocityVerlet), gravity: (0, -10), FLOOR,
           materials: { "m": (stiffness: 1e5, restitution: 0.8) },
           bodies: [(name: "ball", at: (0, 0.5), material: "m", atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["lasts only 4.5 ticks", "`ball`", "--tick"],
    ),
    (
        "a bullet that ticks carry over a disc",
        r#"clock: (duration: 0.5, tick: 0.001, method: VelocityVerlet),
           materials: { "m": (stiffness: 1e4) },
           bodies: [(name: "disc", at: (0.0, 0), fixed: true, material: "m", atoms: Disc(radius: 0.1, mass: 1)),
                    (name: "bullet", at: (-3.15, 0), velocity: (300, 0), material: "m", atoms: Disc(radius: 0.02, mass: 0.01))]"#,
        "",
        &["`bullet`", "travelled", "missed a contact"],
    ),
    (
        "tips of a stick that spins fast",
        r#"clock: (duration: 0.5, tick: 0.001, method: VelocityVerlet),
           bodies: [(name: "stick", at: (0, 0), spin: 2000, atoms: List([(at: (-1, 0), radius: 0.1, mass: 1), (at: (1, 0), radius: 0.1, mass: 1)])),
                    (name: "far", at: (50, 0), atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["`stick`", "travelled", "missed a contact"],
    ),
    (
        "bodies that begin in each other",
        r#"clock: (duration: 1, method: VelocityVerlet), materials: { "m": (stiffness: 1e4, restitution: 0.9) },
           bodies: [(name: "left", at: (0, 0), material: "m", atoms: Disc(radius: 0.1, mass: 1)),
                    (name: "right", at: (0.05, 0), material: "m", atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["Do not trust the model at contacts", "`left` and `right` overlap at the start", "other places"],
    ),
    (
        "a body that begins in the floor",
        r#"clock: (duration: 0.3, method: VelocityVerlet), gravity: (0, -10), FLOOR,
           materials: { "m": (stiffness: 1e5, restitution: 0.9) },
           bodies: [(name: "ball", at: (0, 0.04), material: "m", atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["Do not trust the model at contacts", "overlap at the start", "`ball`"],
    ),
    (
        "a floor too soft for what lies on it",
        r#"clock: (duration: 5, method: VelocityVerlet), gravity: (0, -10), FLOOR,
           materials: { "m": (stiffness: 50, restitution: 0.3) },
           bodies: [(name: "ball", at: (0, 0.1), material: "m", atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["Do not trust the model at contacts", "`ball`", "a `stiffness` ", "times as high"],
    ),
    (
        "an anvil on a ball",
        r#"clock: (duration: 1, method: VelocityVerlet), gravity: (0, -10), FLOOR,
           materials: { "m": (stiffness: 1e4, restitution: 0.3) },
           bodies: [(name: "ball", at: (0, 0.1), material: "m", atoms: Disc(radius: 0.1, mass: 0.1)),
                    (name: "anvil", at: (0, 0.5), material: "m", atoms: Disc(radius: 0.3, mass: 1000))]"#,
        "",
        &["Do not trust the model at contacts", "`anvil` has 10000 times the mass of `ball`"],
    ),
    (
        "an impact that goes through",
        r#"clock: (duration: 1, tick: 1e-4, method: VelocityVerlet), FLOOR,
           materials: { "m": (stiffness: 1e3, restitution: 0.8) },
           bodies: [(name: "ball", at: (0, 0.5), velocity: (0, -50), material: "m", atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["Do not trust the model at contacts", "bodies overlap by", "a `stiffness` ", "times as high"],
    ),
    (
        "billiards: chaos",
        r#"clock: (duration: 20, tick: 2e-4, method: VelocityVerlet), materials: { "m": (stiffness: 1e5, restitution: 1) },
           walls: [(name: "south", left: (1, 0), right: (0, 0), material: "m"), (name: "north", left: (0, 2), right: (1, 2), material: "m"),
                   (name: "west", left: (0, 0), right: (0, 1), material: "m"), (name: "east", left: (2, 1), right: (2, 0), material: "m")],
           bodies: [(name: "a", at: (0.5, 0.5), velocity: (2, 1), material: "m", atoms: Disc(radius: 0.2, mass: 1)),
                    (name: "b", at: (1.3, 0.7), velocity: (-1, 2), material: "m", atoms: Disc(radius: 0.2, mass: 1)),
                    (name: "c", at: (0.7, 1.4), velocity: (1, -2), material: "m", atoms: Disc(radius: 0.2, mass: 1))]"#,
        "--estimate",
        &["places after about", "chaos"],
    ),
    (
        "three bodies that attract each other: chaos",
        r#"clock: (duration: 60, tick: 1e-3, method: Symplectic4), forces: [Attraction(constant: 1, softening: 0.05)],
           bodies: [(name: "three", at: (1, 3), collides: false, atoms: Disc(radius: 0.01, mass: 3)),
                    (name: "four", at: (-2, -1), collides: false, atoms: Disc(radius: 0.01, mass: 4)),
                    (name: "five", at: (1, -1), collides: false, atoms: Disc(radius: 0.01, mass: 5))]"#,
        "--estimate",
        &["places after about", "chaos"],
    ),
    (
        "a planet with a tick too long for its passage",
        r#"clock: (duration: 60, tick: 0.01, method: VelocityVerlet), forces: [Attraction(constant: 1)],
           bodies: [(name: "sun", at: (0, 0), fixed: true, collides: false, atoms: Disc(radius: 0.01, mass: 1)),
                    (name: "planet", at: (-1.8, 0), velocity: (0, -0.3333), collides: false, atoms: Disc(radius: 0.01, mass: 0.001))]"#,
        "",
        &["too long for the motion", "`planet` first", "--tick"],
    ),
    (
        "a planet that a method gives energy, which is no chaos",
        r#"clock: (duration: 20, tick: 0.001, method: ExplicitEuler), forces: [Attraction(constant: 1)],
           bodies: [(name: "sun", at: (0, 0), fixed: true, collides: false, atoms: Disc(radius: 0.01, mass: 1)),
                    (name: "planet", at: (1, 0), velocity: (0, 0.7), collides: false, atoms: Disc(radius: 0.01, mass: 0.001))]"#,
        "",
        &["too long for the motion", "`planet` first", "--tick"],
    ),
    (
        "a force that swings twice in a tick",
        r#"clock: (duration: 1, tick: 0.01), forces: [Drive(of: "ball", force: (5000, 0), course: Sine(frequency: 200))],
           bodies: [(name: "ball", at: (0, 0), collides: false, atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["Do not trust it", "`forces[0]` swings with 0.5 ticks a period", "--tick 5e-5"],
    ),
    (
        "a scene that lies far from the origin",
        r#"clock: (duration: 1, tick: 1e-3, method: VelocityVerlet), gravity: (0, -10), materials: { "m": (stiffness: 1e4) },
           walls: [(name: "floor", left: (1e12, 1e12), right: (0, 1e12), material: "m")],
           bodies: [(name: "ball", at: (1e12, "1000000000000.2 m"), material: "m", atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["`ball` is 1e12 m from the origin", "around the origin"],
    ),
    (
        "a restitution above one",
        r#"clock: (duration: 1), FLOOR, materials: { "m": (restitution: 1.5) },
           bodies: [(name: "ball", at: (0, 0.5), material: "m", atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["restitution", "must be from 0 to 1"],
    ),
    (
        "drag that stops a body within a tick",
        r#"clock: (duration: 10, tick: 0.1, method: VelocityVerlet), forces: [Drag(linear: 30)],
           bodies: [(name: "ball", at: (0, 0), velocity: (1, 0), collides: false, atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["drag takes more than the whole velocity"],
    ),
    (
        "drag on a body that could touch others and does not",
        r#"clock: (duration: 10, tick: 0.1, method: VelocityVerlet), forces: [Drag(linear: 30)],
           bodies: [(name: "ball", at: (0, 0), velocity: (1, 0), atoms: Disc(radius: 0.1, mass: 1)),
                    (name: "far", at: (0, 900), fixed: true, atoms: Disc(radius: 0.1, mass: 1))]"#,
        "",
        &["drag takes more than the whole velocity"],
    ),
    (
        "a force that makes values infinite",
        r#"clock: (duration: 2, tick: 0.01, method: VelocityVerlet), forces: [Thrust(of: "ball", force: (1e308, 0), from: 1)],
           bodies: [(name: "ball", at: (0, 0), atoms: Disc(radius: 0.1, mass: 0.001))]"#,
        "",
        &["`ball`", "infinite or NaN", "enormous"],
    ),
    (
        "two bodies that fall into each other",
        r#"clock: (duration: 3, tick: 0.01, method: VelocityVerlet), forces: [Attraction(constant: 1)],
           bodies: [(name: "a", at: (-0.5, 0), collides: false, atoms: Disc(radius: 0.01, mass: 1)),
                    (name: "b", at: (0.5, 0.001), collides: false, atoms: Disc(radius: 0.01, mass: 1))]"#,
        "",
        &["`a` and `b` fall upon each other", "softening"],
    ),
    (
        "two bodies that attract and stand in almost one place",
        r#"clock: (duration: 1), contacts: None, forces: [Attraction(constant: 100)],
           bodies: [(name: "a", at: (0, 0), atoms: Disc(radius: 0.1)), (name: "b", at: (1e-9, 0), atoms: Disc(radius: 0.1))]"#,
        "",
        &["steps have become too short", "`a` and `b` fall upon each other", "softening"],
    ),
    (
        "impacts that ticks do not see",
        r#"clock: (duration: 20, tick: 0.001, method: VelocityVerlet), gravity: (0, -10), FLOOR,
           materials: { "m": (stiffness: 8e3, restitution: 1) },
           bodies: [(name: "ball", at: (0, 1.9), material: "m", atoms: Disc(radius: 1, mass: 1))]"#,
        "",
        &["contacts begin, end, stick and slip inside ticks", "`ball` first", "--tolerance"],
    ),
    (
        "a tolerance that chaos does not let",
        r#"clock: (duration: 60, tolerance: 1e-6), forces: [Attraction(constant: 1, softening: 0.05)],
           bodies: [(name: "three", at: (1, 3), collides: false, atoms: Disc(radius: 0.01, mass: 3)),
                    (name: "four", at: (-2, -1), collides: false, atoms: Disc(radius: 0.01, mass: 4)),
                    (name: "five", at: (1, -1), collides: false, atoms: Disc(radius: 0.01, mass: 5))]"#,
        "",
        &["is not reached", "chaos"],
    ),
    (
        "a stiff spring and a light mass beside heavy ones",
        r#"clock: (duration: 1, tick: 0.01, method: VelocityVerlet), forces: [Spring(a: "heavy", b: "light", stiffness: 1000, length: 0.5)],
           bodies: [(name: "heavy", at: (0, 0), collides: false, atoms: Disc(radius: 0.1, mass: 100)),
                    (name: "light", at: (0.6, 0), collides: false, atoms: Disc(radius: 0.1, mass: 0.01))]"#,
        "",
        &["Do not trust it", "longer than the springs can bear", "`light`"],
    ),
    (
        "a motor that drives a slider and crank into the dead point",
        r#"clock: (duration: 2, tick: 0.01, method: Dop853), contacts: None,
           bodies: [(name: "crank", at: (0.09078691764006462, 0.062110672073453894), angle: 0.6, mass: 0.5, inertia: 0.004, atoms: Disc(radius: 0.03)),
                    (name: "rod", at: (0.48018271728899364, 0.062110672073453894), angle: -0.2050759793984942, mass: 0.35, inertia: 0.012, atoms: Disc(radius: 0.03)),
                    (name: "piston", at: (0.778791599297858, 0), mass: 0.7, atoms: Disc(radius: 0.05))],
           joints: [Revolute(name: "hub", a: World, anchor_a: (0, 0), b: "crank", anchor_b: (-0.11, 0)),
                    Revolute(name: "pin", a: "crank", anchor_a: (0.11, 0), b: "rod", anchor_b: (-0.305, 0)),
                    Revolute(name: "wrist", a: "rod", anchor_a: (0.305, 0), b: "piston", anchor_b: (0, 0)),
                    Prismatic(name: "slide", a: World, b: "piston", axis: (1, 0))],
           controllers: [Motor(name: "drive", of: "slide", speed: 0.4)]"#,
        "",
        &["Do not trust it", "a motor without a `limit`", "a dead point"],
    ),
];

#[test]
fn the_verdict_names_the_cause() {
    let folder = Folder::new("verdicts");
    let mut wrong = Vec::new();
    for (number, (what, scene, flags, words)) in BROKEN.into_iter().enumerate() {
        let name = format!("broken_{number}.ron");
        std::fs::write(folder.path(&name), format!("Scene(format: 1, {})", scene.replace("FLOOR", FLOOR))).unwrap();
        let ended = folder.jostle(&format!("run {name} {flags}"));
        let told = ended.err.lines().filter(|line| !line.starts_with("warning")).collect::<Vec<_>>();
        let verdict = told.iter().filter(|line| !line.starts_with("  note")).copied().collect::<Vec<_>>().join("\n");
        if words.iter().any(|word| !verdict.contains(word)) {
            wrong.push(format!("{what}: {words:?} expected, but\n{verdict}\n"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}: {}", wrong.len(), BROKEN.len(), wrong.join("\n"));
}

/// The stiffness and tick that the verdict asks for do what it says: overlaps of linear springs fall with the root of the stiffness
/// in impacts, `d = v sqrt(m/k)`, and faster at rest; a tenth of that is what gravity may add to an impact.
#[test]
fn a_stiffness_as_high_as_advised_makes_overlaps_small() {
    let folder = Folder::new("verdict_stiffness");
    let soft: Vec<&Broken> = BROKEN.iter().filter(|broken| broken.3.contains(&"times as high")).collect();
    assert_eq!(soft.len(), 2);
    for (_, scene, ..) in soft {
        let scene = format!("Scene(format: 1, {})", scene.replace("FLOOR", FLOOR));
        std::fs::write(folder.path("soft.ron"), &scene).unwrap();
        let card = folder.jostle("run soft.ron --json").json().remove(0)["card"].clone();
        let verdict = card["verdict"].as_str().unwrap();
        let after = |words: &str| verdict.split_once(words).unwrap().1.split([' ', ':']).next().unwrap();
        let (times, tick): (f64, &str) = (after("a `stiffness` some ").parse().unwrap(), after("--tick "));
        let begin = scene.find("stiffness: ").unwrap() + "stiffness: ".len();
        let end = begin + scene[begin..].find(',').unwrap();
        let stiffness: f64 = scene[begin..end].parse().unwrap();
        std::fs::write(folder.path("hard.ron"), format!("{}{}{}", &scene[..begin], times * stiffness, &scene[end..]))
            .unwrap();
        let card = folder.jostle(&format!("run hard.ron --json --tick {tick}")).json().remove(0)["card"].clone();
        let share = card["largest_overlap"]["share_of_radius"].as_f64().unwrap();
        assert!(share <= 0.055, "{verdict}: {share}");
        assert!(!card["verdict"].as_str().unwrap().contains("the model at contacts"), "{}", card["verdict"]);
    }
}

/// What is doubted is not among what is trusted: a run whose beginning alone was compared, and whose contacts are soft, is trusted in
/// its energy, and until then in its places; then it says what is not, then what would help.
#[test]
fn the_verdict_speaks_with_one_voice() {
    let folder = Folder::new("verdict_voice");
    let soft = r#"Scene(format: 1, clock: (duration: 200, tick: 1e-4, method: VelocityVerlet), gravity: (0, -10), FLOOR,
        materials: { "m": (stiffness: 5000, restitution: 1) },
        bodies: [(name: "ball", at: (0, 1), material: "m", atoms: Disc(radius: 0.1, mass: 1))])"#;
    std::fs::write(folder.path("soft.ron"), soft.replace("FLOOR", FLOOR)).unwrap();
    let card = folder.jostle("run soft.ron --json").code(0).json().remove(0)["card"].clone();
    // `d = v sqrt(m/k)` with the 4.2 m/s of a fall of 0.9 m: 60 % of the radius.
    let share = card["largest_overlap"]["share_of_radius"].as_f64().unwrap();
    assert!(share > 0.5 && share < 0.7, "{share}");
    let verdict = card["verdict"].as_str().unwrap();
    let (trusted, doubted) = verdict.split_once(" Do not trust ").unwrap();
    let (doubted, help) = doubted.split_once(" Use ").unwrap();
    assert!(trusted.starts_with("Trust energy (residual "), "{verdict}");
    assert!(doubted.starts_with("the model at contacts: bodies overlap by "), "{verdict}");
    assert!(doubted.contains(". Do not trust places"), "{verdict}");
    assert!(help.starts_with("a `stiffness` some ") && help.contains("`--estimate`"), "{verdict}");
    assert!(!trusted.contains("velocities to"), "places are doubted and trusted: {verdict}");
}

/// A scene with nothing wrong is not blamed.
#[test]
fn nothing_is_blamed_where_nothing_is_wrong() {
    let folder = Folder::new("verdict_good");
    for scene in ["projectile", "incline", "kepler", "solar_system"] {
        folder.jostle(&format!("run example:{scene} --estimate")).code(0).says("\n  Trust it: places to about ");
    }
    // Its balls go in by a seventh of a radius. All else is trusted.
    let verdict =
        folder.jostle("run example:bounce --estimate --json").code(0).json().remove(0)["card"]["verdict"].clone();
    let verdict = verdict.as_str().unwrap();
    assert!(verdict.starts_with("Trust energy ") && verdict.contains("places to about "), "{verdict}");
    assert_eq!(verdict.matches("Do not trust").count(), 1, "{verdict}");
    assert!(verdict.contains("Do not trust the model at contacts: bodies overlap by 15 % of a radius"), "{verdict}");
}

/// A mechanism that stands is not blamed for the rounding of the forces that hold it.
#[test]
fn what_stands_is_not_blamed_for_rounding() {
    let folder = Folder::new("verdict_still");
    let scene = r#"Scene(format: 1, clock: (duration: 6, method: Dop853, tick: "10 ms"), contacts: None, gravity: (0, -9.81),
        bodies: [(name: "arm", at: (0.6, 0), mass: 2, inertia: 0.1, atoms: Disc(radius: 0.1))],
        joints: [Revolute(name: "pin", a: World, anchor_a: (0, 0), b: "arm", anchor_b: (-0.6, 0), friction: 1.5, limits: (0, 3))],
        controllers: [Actuator(of: "pin", force: Sine(amplitude: 13.1, frequency: 0.25))])"#;
    std::fs::write(folder.path("still.ron"), scene).unwrap();
    folder.jostle("run still.ron").code(0).says("\n  Trust it: all bodies rest. The energy residual is 0.");
    let held = scene.replace("method: Dop853, tick: \"10 ms\"", "method: Reference");
    std::fs::write(folder.path("held.ron"), held).unwrap();
    folder.jostle("run held.ron").code(0).says("\n  Trust it: all bodies rest. The energy residual is 0.");
}

/// A box that rests has no impact, however few ticks an impact of its stiffness would last. One that is thrown has.
#[test]
fn impacts_are_doubted_only_where_bodies_meet() {
    let folder = Folder::new("verdict_rests");
    let scene = r#"Scene(format: 1, clock: (duration: 2, tick: "1 ms", method: VelocityVerlet), gravity: (0, -9.81),
        materials: { "m": (stiffness: 1e5, friction: 0.4, restitution: 0.3) },
        walls: [(name: "floor", left: (10, 0), right: (-10, 0), material: "m")],
        bodies: [(name: "box", at: (0, 0.05), shape: Rectangle(width: 0.2, height: 0.1), mass: 1, material: "m")],
        forces: [Drive(of: "box", force: (1, 0), course: Sine(frequency: 0.5))])"#;
    for (at, doubted) in [("(0, 0.05)", false), ("(0, 0.3)", true)] {
        std::fs::write(folder.path("box.ron"), scene.replace("(0, 0.05)", at)).unwrap();
        let card = folder.jostle("run box.ron --json").code(0).json().remove(0)["card"].clone();
        let verdict = card["verdict"].as_str().unwrap();
        assert_eq!(verdict.contains("Do not trust impacts"), doubted, "at {at}: {verdict}");
    }
}
