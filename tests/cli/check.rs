//! `check`: good scenes in a line each.

use super::harness::{FALL, Folder};

#[test]
fn a_good_scene_is_told_in_a_line() {
    let folder = Folder::new("check").with("fall.ron", FALL);
    let ended = folder.jostle("check fall.ron fall.ron").code(0);
    assert_eq!(ended.out, "fall.ron: good; 1 body, 1 atom, 0 walls\n".repeat(2));
    assert_eq!(ended.err, "");
    let ended = folder.jostle("check --run fall.ron").code(0);
    assert_eq!(ended.out, "fall.ron: good; 1 body, 1 atom, 0 walls; it has no expectations\n");
    let ended = folder.jostle("check --run example:projectile").code(0);
    assert!(ended.out.ends_with("; 4 expectations hold\n"), "{ended:?}");
    assert_eq!(folder.names(), ["fall.ron"]);
}

#[test]
fn a_good_scene_has_an_empty_list_of_mistakes() {
    let ended = Folder::new("check_json").jostle("check --json example:tetris").code(0);
    let [result] = &ended.json()[..] else { panic!("{ended:?}") };
    assert_eq!(result["scene"], "example:tetris");
    assert_eq!(result["errors"], serde_json::json!([]));
}

/// What the engine notes before the first tick is seen without a run.
#[test]
fn an_overlap_at_the_start_is_noted() {
    let scene = "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: VelocityVerlet), bodies: [
        (name: \"a\", at: (0, 0), atoms: Disc(radius: 1)), (name: \"b\", at: (1, 0), atoms: Disc(radius: 1))])";
    let folder = Folder::new("check_overlap").with("two.ron", scene);
    let ended = folder.jostle("check two.ron").code(0);
    assert!(ended.err.starts_with("note: two.ron: at the start `a` and `b` overlap by 1 m, 100 %"), "{ended:?}");
    let [result] = &folder.jostle("check --json two.ron").code(0).json()[..] else { panic!("one line") };
    assert_eq!(result["notes"].as_array().map(Vec::len), Some(1), "{result}");
}

/// The exit code alone says that a scene is good; what is wrong is told all the same.
#[test]
fn a_quiet_check_tells_mistakes_alone() {
    let folder = Folder::new("check_quiet").with("fall.ron", FALL).with("wrong.ron", FALL.replace("gravity", "gravty"));
    for run in ["", " --run"] {
        let ended = folder.jostle(&format!("check --quiet fall.ron{run}")).code(0);
        assert_eq!((ended.out.as_str(), ended.err.as_str()), ("", ""), "{ended:?}");
        folder.jostle(&format!("check --quiet fall.ron wrong.ron{run}")).code(1).says("gravty");
    }
}
