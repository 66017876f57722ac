//! The program of the template makes the film that its README promises.

use std::path::Path;
use std::process::Command;

#[test]
fn the_scene_of_the_template_becomes_a_film() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/templates/plugin/scene.ron");
    let film = Path::new(env!("CARGO_TARGET_TMPDIR")).join("spring.gif");
    let mut program = Command::new(env!("CARGO_BIN_EXE_home_spring"));
    let ended = program.arg("render").arg(scene).args(["--quiet", "-o"]).arg(&film).status().expect("the program runs");
    assert!(ended.success());
    assert!(std::fs::read(&film).expect("a film").starts_with(b"GIF89a"));
    std::fs::remove_file(film).expect("the film goes");
}
