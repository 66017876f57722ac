//! Good scenes: what is installed, in which order.

use super::super::{Kind, Source, load};
use super::loaded;
use super::plugins::{self, Log};

const GOOD: &str = r#"#![type = "Scene"]
// A comment before the scene.
Scene(
    format: 1,
    title: "Two points",
    forces: [Drag(quadratic: "0.02 N s2/m2", of: "b"), /* all */ Drag() /* no comma */],
    contacts: None,
    points: [(name: "a", at: (0, "30 cm"), mass: 1), (name: "b", at: (1, 2))],
    clock: (duration: 2,), // the last one
    camera: Fit(),
) // after"#;

#[test]
fn sections_are_installed_in_the_order_of_registration() {
    let app = loaded(GOOD);
    assert_eq!(
        app.world().resource::<Log>().0,
        [
            "fit 0.0 1",
            "clock 2",
            "point a",
            "point b",
            "Drag(quadratic: \"0.02 N s2/m2\", of: \"b\") of [1]",
            "Drag() of [0, 1]",
        ]
    );
}

#[test]
fn the_header_tells_what_the_scene_has() {
    let header = load(&mut plugins::app(), &Source::new("a.ron", GOOD)).unwrap();
    assert_eq!(header.title.as_deref(), Some("Two points"));
    assert_eq!(header.remarks, ["\"b\" has mass 1 kg"]);
    assert_eq!(header.outline.names(Kind::BODY), ["a", "b"]);
    assert!(header.outline.is_none("contacts"));
    assert!(header.outline.has_section("forces"));
    assert!(!header.outline.has_section("wind"));
    assert_eq!(header.outline.entries("forces")[1].path, "forces[1]");
    assert_eq!(header.outline.entries("camera")[0].path, "camera");
}

#[test]
fn nothing_is_installed_when_anything_is_wrong() {
    let mut app = plugins::app();
    assert!(load(&mut app, &Source::new("a.ron", GOOD.replace("(1, 2)", "(1, NaN)"))).is_err());
    assert!(!app.world().contains_resource::<Log>());
}

#[test]
fn no_cut_and_no_stray_letter_makes_it_stumble() {
    for (place, letter) in GOOD.char_indices() {
        let mut app = plugins::app();
        let _ = load(&mut app, &Source::new("a.ron", &GOOD[..place])).map_err(|errors| errors.render(true));
        for stray in ["(", ")", "]", "\"", ",", "'", "é", "1", ":", "\\", "/*", "inf", "\u{0}"] {
            let text = format!("{}{stray}{}", &GOOD[..place], &GOOD[place + letter.len_utf8()..]);
            let _ = load(&mut plugins::app(), &Source::new("a.ron", text)).map_err(|errors| errors.to_string());
        }
    }
}
