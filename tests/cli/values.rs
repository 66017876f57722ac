//! Impossible values in scenes are refused with path and line. Unusual values run, or end with a message, but never
//! with a panic.

use super::harness::{FALL, Folder};

fn with(before: &str, after: &str) -> String {
    assert!(FALL.contains(before), "{before}");
    FALL.replacen(before, after, 1)
}

#[test]
fn impossible_values_are_refused_with_path_and_line() {
    let folder = Folder::new("impossible");
    let above_zero = "must be a finite number above zero, got";
    for (before, after, message) in [
        ("duration: 0.2", "duration: 0", format!("clock.duration: {above_zero} 0\n")),
        ("duration: 0.2", "duration: -1", format!("clock.duration: {above_zero} -1\n")),
        ("duration: 0.2", "duration: NaN", "clock.duration: must be a finite number, got NaN\n".into()),
        ("duration: 0.2", "duration: 1e400", "clock.duration: must be a finite number, got 1e400\n".into()),
        ("\"1 ms\"", "0", format!("clock.tick: {above_zero} 0\n")),
        ("\"1 ms\"", "5", "clock.tick: the tick of 5 s is longer than the whole run of 0.2 s\n".into()),
        ("radius: 0.1", "radius: 0", format!("bodies[0].atoms.radius: {above_zero} 0\n")),
        ("radius: 0.1", "radius: -1", format!("bodies[0].atoms.radius: {above_zero} -1\n")),
        ("mass: 1", "mass: 0", format!("bodies[0].atoms.mass: {above_zero} 0\n")),
        ("stiffness: 1000", "stiffness: -5", format!("materials[\"soft\"].stiffness: {above_zero} -5\n")),
        ("fps: 10", "fps: 0", "film.fps: must be from 0.01 to 1000, got 0\n".into()),
        ("(64, 36)", "(0, 36)", "film.size[0]: must be from 16 to 8192 pixels, got 0\n".into()),
        ("(64, 36)", "(64, 1e9)", "film.size[1]: must be from 16 to 8192 pixels, got 1000000000\n".into()),
        ("fps: 10", "from: 2, to: 1", "film.to: must be after `from`, which is 2 s, got 1 s\n".into()),
    ] {
        std::fs::write(folder.path("wrong.ron"), with(before, after)).unwrap();
        let ended = folder.jostle("check wrong.ron").code(1).says(&message).says("--> wrong.ron:");
        assert_eq!(ended.out, "");
    }
}

#[test]
fn names_are_unique_and_known() {
    let folder = Folder::new("names");
    let twice = "bodies: [(name: \"ball\", at: (5, 1), atoms: Disc(radius: 0.1)), ";
    for (before, after, message, help) in [
        ("bodies: [", twice, "the name \"ball\" is taken by another body", "give every thing its own name"),
        ("material: \"soft\"", "material: \"sofa\"", "there is no material named \"sofa\"", "did you mean \"soft\"?"),
        ("gravity", "gravitty", "there is no section `gravitty`", "did you mean `gravity`?"),
        ("duration: 0.2", "durration: 0.2", "`clock` has no field `durration`", "did you mean `duration`?"),
        ("duration: 0.2", "duration: 0.2, duration: 1", "`duration` stands here twice", "keep one of the two"),
        ("of: \"ball\"", "of: \"bill\"", "bill", "did you mean"),
    ] {
        std::fs::write(folder.path("wrong.ron"), with(before, after)).unwrap();
        folder.jostle("check wrong.ron").code(1).says(message).says(help).says("--> wrong.ron:");
    }
}

#[test]
fn a_scene_without_bodies_says_so() {
    let folder = Folder::new("bodiless").with("void.ron", "Scene(format: 1, clock: (duration: 1))");
    folder.jostle("run void.ron").code(1).says("error: the scene has no bodies").says("bodies: [");
}

#[test]
fn more_ticks_than_anybody_can_wait_for_are_refused() {
    let folder = Folder::new("ticks").with("fall.ron", FALL).with("long.ron", with("duration: 0.2", "duration: 1e14"));
    for arguments in ["check long.ron", "run fall.ron --tick 1e-20", "render long.ron"] {
        folder.jostle(arguments).code(1).says("ticks").says("a run takes at most 1e15 ticks");
    }
    assert_eq!(folder.names(), ["fall.ron", "long.ron"]);
}

/// Numbers that are finite and still beyond all measure: whatever comes of them, a message or a picture, it is no
/// panic (the harness checks that), takes no time and no memory to speak of.
#[test]
fn wild_values_end_in_a_picture_or_a_message() {
    let folder = Folder::new("wild");
    for (before, after, code) in [
        ("(0, 1)", "(0, 1e200)", 0),
        ("(0, -9.81)", "(0, 1e308)", 3),
        ("radius: 0.1", "radius: 1e308", 1),
        ("radius: 0.1", "radius: 1e-320", 3),
        ("mass: 1)", "mass: 1e-320)", 3),
        ("fps: 10", "speed: 1e300", 0),
        ("film:", "camera: Look(center: (0, 0), height: 1e-300), film:", 0),
        ("film:", "camera: Look(center: (0, 0), height: 1e300), film:", 0),
        ("film:", "camera: Look(center: (1e300, 0), height: 1), film:", 0),
    ] {
        std::fs::write(folder.path("wild.ron"), with(before, after)).unwrap();
        folder.jostle("render wild.ron").code(code);
    }
}
