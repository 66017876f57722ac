//! `list`: what there is, with an example and where it comes from.

use super::harness::Folder;

#[test]
fn the_scenes_are_listed_with_title_and_notes() {
    let folder = Folder::new("list_scenes");
    let ended = folder.jostle("list").code(0);
    for text in [
        "tetris             Blocks among pegs\n                   Blocks of 16 atoms fall, tumble and come to rest.\n",
        "Other lists: sections, ",
    ] {
        assert!(ended.out.contains(text), "{text}: {}", ended.out);
    }
    let scenes = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes")).unwrap();
    let scenes =
        scenes.filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|ending| ending == "ron"));
    assert_eq!(folder.jostle("list scenes --json").code(0).json().len(), scenes.count());
}

#[test]
fn what_a_scene_may_name_is_listed_with_its_module() {
    let folder = Folder::new("list_names");
    let ended = folder.jostle("list forces drag").code(0);
    let line: Vec<&str> = ended.out.split_whitespace().collect();
    assert_eq!(line[..3], ["Drag", "jostle::forces::drag", "Drag(linear:"], "{ended:?}");
    assert_eq!(ended.out.lines().count(), 1, "{ended:?}");
    let sections = folder.jostle("list sections --json").code(0).json();
    let of = |name: &str| sections.iter().find(|section| section["name"] == name).unwrap().clone();
    assert_eq!(of("gravity")["from"], "jostle::forces::gravity");
    assert_eq!(of("forces")["from"], "jostle::forces");
    assert_eq!(of("gravity")["text"], "gravity: (0, -9.81)");
    let methods = folder.jostle("list methods").code(0);
    assert!(methods.out.contains("VelocityVerlet     order 2, stable up to omega dt = 2\n"), "{methods:?}");
    let shapes = folder.jostle("list shapes --json").code(0).json();
    assert_eq!((&shapes[0]["name"], &shapes[0]["text"]), (&"Disc".into(), &"Disc(radius: 0.2)".into()));
    assert!(
        shapes.iter().any(|shape| shape["name"] == "Gear") && shapes.iter().any(|shape| shape["name"] == "Compound")
    );
    assert!(folder.jostle("list atoms").code(0).out.starts_with("Picture  Picture(spacing: 0.1"));
    assert!(folder.jostle("list layers").code(0).out.contains("jostle::record::layers::trails"));
    assert!(folder.jostle("list themes").code(0).out.contains("paper\n"));
    assert!(folder.jostle("list channels energy").code(0).out.contains("energy.residual\n"));
    for list in ["channels", "quantities"] {
        assert!(folder.jostle(&format!("list {list}")).code(0).out.contains("`jostle explain CHANNEL`"), "{list}");
    }
}

#[test]
fn an_unknown_list_is_told_with_the_known_ones() {
    let folder = Folder::new("list_unknown");
    folder.jostle("list force").code(2).says("did you mean `forces`? lists: scenes, sections, ");
    let ended = folder.jostle("list forces zebra").code(0).says("none of the forces holds `zebra`");
    assert_eq!(ended.out, "");
}
