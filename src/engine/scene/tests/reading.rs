//! Good scenes: the installed sections and their order.

use super::super::{NameKind, Source, load};
use super::loaded;
use super::plugins::{self, Log};

const GOOD: &str = r###"#![type = "Scene"]
// A comment before the scene.
Scene(
    format: 1,
    title: "Everything once",
    forces: [Drag(quadratic: "0.02 N s2/m2", of: "b"), /* all */ Drag() /* no comma */],
    contacts: None,
    bodies: [
        (name: "a", at: (0, "30 cm"), atoms: Disc(radius: 0.1, mass: "2 g")),
        (name: "T", at: (4, 5), angle: "10 deg", velocity: (0.2, 0.4), spin: "3 rpm", material: "block",
         atoms: Picture(spacing: 0.1, mass: 0.01, rows: ["..##..", "##.###"])),
        (name: "b", fixed: true, datum: Origin, material: "rock", inertia: Union,
         atoms: List([(at: (0, 0), radius: 0.1), (at: (0.3, 0), radius: 0.2, stiffness: "2 kN/m")])),
        (name: "c", at: (5, 2), atoms: Disc(radius: 0.3, mass: 1), mass: 1.5, inertia: "2 kg m2", collides: false),
    ],
    fill: [(name: "gas", atoms: Disc(radius: 0.02), count: 3, within: ((1, 1), (2, 2)), speed: 1.0, seed: 7)],
    clock: (duration: 2, tick: "1 ms", method: VelocityVerlet, events: PerTick,), // the last one
    film: (fps: 30, size: (1280, 720), speed: 0.5, from: 0.5, to: 2),
    camera: Look(center: (3, 3), height: 6),
    materials: {
        "rock": (stiffness: 1000, friction: (static: 0.5, dynamic: 0.4), restitution: 0.8),
        "block": (friction: 0.25, inelasticity: 0.3, density: 2.5, color: "teal"),
    },
    pairs: [(between: ("rock", "block"), friction: 0.1)],
    walls: [(name: "floor", left: (6, 0), right: (0, 0), material: "rock")],
    wind: (speed: "3 km/h"),
) // after"###;

#[test]
fn sections_are_installed_in_the_order_of_registration() {
    let app = loaded(GOOD);
    assert_eq!(
        app.world().resource::<Log>().0,
        [
            "camera Look(center: (3, 3), height: 6)",
            "clock",
            "film",
            "materials",
            "pairs",
            "walls",
            "bodies",
            "fill",
            "wind",
            "Drag(quadratic: \"0.02 N s2/m2\", of: \"b\") of [2]",
            "Drag() of [0, 1, 2, 3, 4, 5, 6]",
        ]
    );
}

#[test]
fn the_header_tells_what_the_scene_has() {
    let header = load(&mut plugins::app(), &Source::new("a.ron", GOOD)).unwrap();
    assert_eq!(header.title.as_deref(), Some("Everything once"));
    assert_eq!(header.remarks, ["the wind has no gusts"]);
    assert_eq!(header.outline.names(NameKind::BODY), ["a", "T", "b", "c", "gas_0", "gas_1", "gas_2"]);
    assert_eq!(header.outline.names(NameKind::MATERIAL), ["rock", "block"]);
    assert!(header.outline.is_none("contacts"));
    assert!(header.outline.has_section("forces"));
    assert!(!header.outline.has_section("gravity"));
    assert_eq!(header.outline.entries("forces")[1].path, "forces[1]");
    assert_eq!(header.outline.entries("camera")[0].path, "camera");
}

#[test]
fn nothing_is_installed_when_anything_is_wrong() {
    let mut app = plugins::app();
    assert!(load(&mut app, &Source::new("a.ron", GOOD.replace("(4, 5)", "(1, NaN)"))).is_err());
    assert!(!app.world().contains_resource::<Log>());
}

#[test]
fn no_cut_and_no_stray_letter_makes_it_stumble() {
    for (index, letter) in GOOD.char_indices() {
        let mut app = plugins::app();
        let _ = load(&mut app, &Source::new("a.ron", &GOOD[..index])).map_err(|errors| errors.render(true));
        for stray in ["(", ")", "]", "\"", ",", "'", "é", "1", ":", "\\", "/*", "inf", "\u{0}"] {
            let text = format!("{}{stray}{}", &GOOD[..index], &GOOD[index + letter.len_utf8()..]);
            let _ = load(&mut plugins::app(), &Source::new("a.ron", text)).map_err(|errors| errors.to_string());
        }
    }
}
