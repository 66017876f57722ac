use super::*;

#[test]
fn every_value_has_its_place_and_path() {
    let text = "Scene(a: 1, b: [(x: -2e-3), Drag(y: \"s\")], m: { \"k\": (z: 0.1..0.5) }, c: List([7, 8]),)";
    let found = lex(text);
    assert_eq!(found.fault, None);
    let at = |path: &str| {
        let place = found.tree.find(path, text).unwrap();
        assert!(place.whole, "{path}");
        &text[found.tree.span(place.node)]
    };
    assert_eq!(at("a"), "1");
    assert_eq!(at("b[0].x"), "-2e-3");
    assert_eq!(at("b[1].y"), "\"s\"");
    assert_eq!(at("m[\"k\"].z"), "0.1..0.5");
    assert_eq!(at("c[1]"), "8");
    for path in ["a", "b[0].x", "b[1].y", "m[\"k\"].z", "c[1]", "b"] {
        let node = found.tree.find(path, text).unwrap().node;
        assert_eq!(found.tree.path(node, text), path);
        assert_eq!(found.tree.innermost(found.tree.span(node).start, false), node);
    }
}

#[test]
fn no_beginning_of_a_scene_makes_it_stumble() {
    let text = "#![type = \"x\"]\n/* a /* b */ */ Scene(a: r#\"q\"#, d: {\"é\": 'ü', \"f\": '\\n'}, g: -inf, h: 1_000u32) // end";
    assert_eq!(lex(text).fault, None);
    for end in (0..text.len()).filter(|&end| text.is_char_boundary(end)) {
        let _ = lex(&text[..end]);
        let _ = lex(&text[end..]);
    }
}

#[test]
fn a_million_brackets_are_one_plain_error() {
    for bracket in ["(", "[", "{\"a\":", "Some("] {
        let fault = lex(&bracket.repeat(1_000_000)).fault.unwrap();
        assert_eq!(fault.message, "brackets are nested more than 48 deep");
    }
}
