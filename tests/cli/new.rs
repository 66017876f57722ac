//! `jostle new`: its files are a good beginning, and it destroys none.

use std::path::Path;

use super::harness::Folder;

#[test]
fn a_new_scene_runs_and_holds_what_it_expects() {
    let folder = Folder::new("new_scene");
    let ended = folder.jostle("new scene my-first_1").code(0);
    assert!(ended.out.contains("jostle check my-first_1.ron --run"), "{ended:?}");
    assert_eq!(folder.names(), ["my-first_1.ron"]);
    let checked = folder.jostle("check my-first_1.ron --run").code(0);
    assert!(checked.out.contains("2 expectations hold"), "{checked:?}");
    assert!(checked.err.is_empty(), "nothing to remark on: {checked:?}");
    let text = String::from_utf8(folder.read("my-first_1.ron")).unwrap();
    assert!(text.contains("title: \"my-first_1\"") && !text.contains("NAME"), "{text}");
}

/// The ending may be given too.
#[test]
fn a_new_scene_is_called_as_its_file() {
    let folder = Folder::new("new_scene_ending");
    folder.jostle("new scene fall.ron").code(0);
    assert_eq!(folder.names(), ["fall.ron"]);
}

/// That the plugin's template builds and passes its tests is checked by `tools/check`, where it is a crate.
#[test]
fn a_new_plugin_is_the_template_by_another_name() {
    let folder = Folder::new("new_plugin");
    let ended = folder.jostle("new plugin rubber_band").code(0);
    assert!(ended.out.contains("cd rubber_band && cargo test"), "{ended:?}");
    let read = |name: &str| String::from_utf8(folder.read(&format!("rubber_band/{name}"))).unwrap();
    let templates = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/templates/plugin");
    for (file, template) in [
        ("src/lib.rs", "lib.rs"),
        ("src/main.rs", "main.rs"),
        ("src/tests.rs", "tests.rs"),
        ("scene.ron", "scene.ron"),
        ("README.md", "README.md"),
    ] {
        let text = read(file);
        assert!(!text.to_lowercase().replace('_', "").contains("homespring"), "{file}: {text}");
        let back = text.replace("rubber_band", "home_spring").replace("RubberBand", "HomeSpring");
        assert_eq!(back, std::fs::read_to_string(templates.join(template)).unwrap(), "{file}");
    }
    let manifest = read("Cargo.toml");
    assert!(manifest.contains("name = \"rubber_band\""), "{manifest}");
    let checkout = env!("CARGO_MANIFEST_DIR");
    assert!(manifest.contains(&format!("\njostle = {{ path = {checkout:?} }}\n")), "{manifest}");
    // What is tested is what is handed out.
    let tested = std::fs::read_to_string(templates.join("../../../tools/plugin_template/Cargo.toml")).unwrap();
    let dependencies = tested.lines().skip_while(|line| *line != "[dependencies]").skip(1);
    for line in dependencies.take_while(|line| !line.is_empty()).filter(|line| !line.starts_with("jostle")) {
        assert!(manifest.contains(&format!("\n{line}\n")), "{line} is not in {manifest}");
    }
}

#[test]
fn a_new_plugin_may_be_built_against_a_checkout() {
    let checkout = "[package]\nname = \"jostle\"\n";
    let folder = Folder::new("new_plugin_checkout").with("over there/Cargo.toml", checkout).with("empty/file", "");
    let mut command = folder.command("new plugin near --jostle");
    assert!(command.arg("over there").output().unwrap().status.success());
    let manifest = String::from_utf8(folder.read("near/Cargo.toml")).unwrap();
    assert!(manifest.contains("\njostle = { path = \"../over there\" }\n"), "{manifest}");
    folder.jostle("new plugin far --jostle empty").code(2).says("`empty` is not a checkout of Jostle");
    folder.jostle("new plugin far --jostle nowhere").code(2).says("not a checkout");
    assert!(!folder.has("far"), "a refusal leaves nothing behind");
}

#[test]
fn nothing_is_overwritten() {
    let folder = Folder::new("new_twice").with("mine.ron", "mine").with("band/notes", "mine");
    folder.jostle("new scene mine").code(2).says("`mine.ron` exists already");
    folder.jostle("new plugin band").code(2).says("`band` exists already");
    assert_eq!(folder.read("mine.ron"), b"mine");
    assert_eq!(folder.names(), ["band", "mine.ron"]);
    assert!(!folder.has("band/Cargo.toml"));
}

#[test]
fn names_that_cannot_be_are_refused() {
    let folder = Folder::new("new_names");
    for name in ["../up", "a/b", ".hidden", "-flag.ron", "", "two.dots.ron", "größe"] {
        let ended = folder.command("new scene").arg(name).output().unwrap();
        assert_eq!(ended.status.code(), Some(2), "{name}");
    }
    for name in ["Big", "a-b", "1st", "../up", "", "_a"] {
        let ended = folder.command("new plugin").arg(name).output().unwrap();
        assert_eq!(ended.status.code(), Some(2), "{name}");
    }
    folder.jostle("new plugin Big").code(2).says("small letters, digits and underscores");
    folder.jostle("new plugin match").code(2).says("take another name");
    folder.jostle("new plugin serde").code(2).says("take another name");
    assert!(folder.names().is_empty());
}

#[test]
fn its_help_has_examples() {
    let folder = Folder::new("new_help");
    for command in ["new", "new plugin", "new scene"] {
        let ended = folder.jostle(&format!("{command} --help")).code(0);
        assert!(ended.out.contains("Examples:\n  jostle new scene pendulum"), "{ended:?}");
    }
    assert!(folder.jostle("new plugin --help").out.contains("--jostle <PATH>"));
}
