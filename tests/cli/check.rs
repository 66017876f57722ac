//! `check`: good scenes in a line each.

use super::harness::{FALL, Folder};

#[test]
fn a_good_scene_is_told_in_a_line() {
    let folder = Folder::new("check").with("fall.ron", FALL);
    let ended = folder.jostle("check fall.ron fall.ron").code(0);
    assert_eq!(ended.out, "fall.ron: good; 1 body, 1 atom, 0 walls\n".repeat(2));
    assert_eq!(ended.err, "");
    let ended = folder.jostle("check --run fall.ron").code(0);
    assert_eq!(ended.out, "fall.ron: good; 1 body, 1 atom, 0 walls; nothing is expected\n");
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
