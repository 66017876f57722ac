//! `test`: all scenes of a folder, several at once, a line each.

use super::harness::{FALL, Folder, OVERFLOW};

/// A fall that claims to stay above a height.
fn expecting(low: &str) -> String {
    let expect = format!("expect: [Inside(of: \"ball\", box: ((-1, {low}), (1, 2)))],\n)");
    FALL.strip_suffix(')').unwrap().to_owned() + &expect
}

fn mixed(name: &str) -> Folder {
    Folder::new(name)
        .with("scenes/holds.ron", expecting("0.7"))
        .with("scenes/deep/breaks.ron", expecting("0.9"))
        .with("scenes/plain.ron", FALL)
        .with("scenes/part.ron", "Scene(format: 1, bodies: [])")
        .with("scenes/look.ron", "Theme(ink: \"black\")")
        .with("scenes/note.txt", "no scene")
        .with("scenes/.hidden/wrong.ron", "Scene(")
        .with("scenes/target/CACHEDIR.TAG", "")
        .with("scenes/target/wrong.ron", "Scene(")
}

#[test]
fn every_scene_is_told_in_a_line_in_order() {
    let folder = mixed("test_lines");
    let one = folder.jostle("test scenes --threads 1").code(1);
    let lines: Vec<&str> = one.out.lines().collect();
    let begins = ["BROKEN    scenes/deep/breaks.ron", "            Inside(of: \"ball\"", "good      scenes/holds.ron"];
    let rest = ["skipped   scenes/look.ron", "skipped   scenes/part.ron", "untested  scenes/plain.ron", "5 scenes in "];
    assert_eq!(lines.len(), 7, "{one:?}");
    for (line, begin) in lines.iter().zip(begins.into_iter().chain(rest)) {
        assert!(line.starts_with(begin), "{line} {begin}");
    }
    assert!(lines[6].ends_with("1 good, 1 untested, 1 broken, 2 skipped"), "{one:?}");
    assert_eq!(one.err, "");
    // The same but for the times, with any number of threads.
    let without_times = |text: &str| text.split_whitespace().filter(|word| !word.contains('.')).collect::<String>();
    let many = folder.jostle("test scenes --threads 4").code(1);
    assert_eq!(without_times(&one.out), without_times(&many.out));
}

#[test]
fn the_exit_code_tells_the_worst() {
    let folder = mixed("test_codes").with("wild.ron", OVERFLOW).with("wrong.ron", "Scene(format: 1, clock: ())");
    folder.jostle("test scenes/holds.ron scenes/plain.ron").code(0);
    folder.jostle("test wrong.ron").code(1);
    folder.jostle("test nowhere.ron").code(2).says("nowhere.ron");
    folder.jostle("test nofolder").code(2).says("nofolder");
    let ended = folder.jostle("test wild.ron wrong.ron").code(3);
    assert!(ended.out.starts_with("FAILED    wild.ron"), "{ended:?}");
    assert!(ended.out.contains("REFUSED   wrong.ron") && ended.out.contains("wrong.ron:1:"), "{ended:?}");
    // A scene that is named is meant to be one.
    folder.jostle("test scenes/look.ron").code(1);
    let empty = Folder::new("test_empty");
    empty.jostle("test").code(2).says("there are no scenes");
    folder.jostle("test scenes/holds.ron --junit here/").code(2).says("is a directory");
}

#[test]
fn flags_override_every_scene() {
    let folder = mixed("test_flags");
    folder.jostle("test scenes/deep --duration 0.1").code(0);
    let quiet = folder.jostle("test scenes/holds.ron scenes/plain.ron --quiet").code(0);
    assert_eq!(quiet.out.lines().count(), 1, "only the summary: {quiet:?}");
}

#[test]
fn results_are_written_for_programs() {
    let folder = mixed("test_json").with("wrong.ron", "Scene(format: 1, clock: ())");
    let ended = folder.jostle("test scenes wrong.ron --json --junit report.xml").code(1);
    let results: Vec<String> =
        ended.json().iter().map(|json| format!("{} {}", json["scene"], json["result"])).collect();
    let expected = [
        "\"scenes/deep/breaks.ron\" \"broken\"",
        "\"scenes/holds.ron\" \"good\"",
        "\"scenes/look.ron\" \"skipped\"",
        "\"scenes/part.ron\" \"skipped\"",
        "\"scenes/plain.ron\" \"good\"",
        "\"wrong.ron\" \"refused\"",
    ];
    assert_eq!(results, expected);
    assert_eq!(ended.json()[1]["expect"][0]["holds"], true);
    assert_eq!(ended.json()[5]["errors"][0]["line"], 1);
    let report = String::from_utf8(folder.read("report.xml")).unwrap();
    assert!(report.contains("name=\"jostle\" tests=\"8\" failures=\"1\" errors=\"1\" skipped=\"2\""), "{report}");
}

/// Promise: what is expected at the last moment is judged, also where so many ticks of 0.15 ms round to a time below it.
#[test]
fn what_is_expected_at_the_end_is_judged() {
    let mut folder = Folder::new("test_at_the_end");
    for (number, end) in ["0.9", "1.5", "10.8"].into_iter().enumerate() {
        let scene = format!(
            "Scene(format: 1, clock: (duration: {end}, tick: \"0.15 ms\", method: VelocityVerlet),
             bodies: [(name: \"ball\", at: (0, 0), atoms: Disc(radius: 0.05))],
             expect: [Position(of: \"ball\", at: {end}, is: (0, 0), within: 1e-3), AtRest(of: \"*\", from: {end}, speed_below: 1e-6)])"
        );
        folder = folder.with(&format!("scenes/end_{number}.ron"), scene);
    }
    let ended = folder.jostle("test scenes").code(0);
    assert!(ended.out.contains("3 good"), "{ended:?}");
}
