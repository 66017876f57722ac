//! The error that `run` and `render` estimate of themselves, and the flags for it.

use super::harness::{FALL, Folder};

/// A ball that lies in the sun for long before it falls on another one: the beginning tells nothing of the rest.
const LATE: &str = r#"Scene(
    format: 1,
    clock: (duration: 400, tick: "0.3 ms", method: VelocityVerlet),
    walls: [(name: "floor", left: (1, 0), right: (0, 0))],
    bodies: [(name: "ball", at: (0, 40), velocity: (0, -0.1), atoms: Disc(radius: 0.1, mass: 1))],
)"#;

#[test]
fn every_run_has_an_estimate_and_it_changes_no_bit() {
    let folder = Folder::new("estimate").with("fall.ron", FALL);
    let with = folder.jostle("run fall.ron --json").code(0).json().remove(0);
    let without = folder.jostle("run fall.ron --json --no-estimate").code(0).json().remove(0);
    assert!(without["card"]["error"].is_null(), "{without}");
    assert!(with["card"]["error"]["position"]["discretisation"].is_f64(), "{with}");
    assert!(
        with["card"]["error"]["position"]["rounding"].is_null() && with["card"]["error"]["position"]["model"].is_null()
    );
    assert_eq!(with["card"]["hash"], without["card"]["hash"]);
    assert_eq!(with["bodies"], without["bodies"]);
    let film = folder.jostle("render fall.ron --json").code(0).json().remove(0);
    assert_eq!(film["card"]["error"], with["card"]["error"]);
    folder.jostle("run fall.ron").code(0).says("error             places +- ");
}

#[test]
fn rounding_and_model_are_told_when_asked_for() {
    let folder = Folder::new("estimate_all").with("fall.ron", FALL);
    let all = folder.jostle("run fall.ron --estimate --rounding --model --json").code(0).json().remove(0);
    for what in ["position", "velocity"] {
        for part in ["discretisation", "rounding", "model"] {
            assert!(all["card"]["error"][what][part].is_f64(), "{what} {part}: {all}");
        }
    }
    folder.jostle("run fall.ron --estimate --no-estimate").code(2);
}

#[test]
fn a_beginning_without_a_touch_tells_of_the_beginning_alone() {
    let folder = Folder::new("estimate_late").with("late.ron", LATE);
    let ended = folder.jostle("run late.ron --json").code(0).json().remove(0);
    let (error, end) = (&ended["card"]["error"], ended["time"].as_f64().unwrap());
    assert!(error["horizon"].as_f64().unwrap() < 0.9 * end, "{ended}");
    let notes = ended["card"]["notes"].to_string();
    assert!(notes.contains("in which no bodies touch") && notes.contains("--estimate"), "{notes}");
    let verdict = ended["card"]["verdict"].as_str().unwrap();
    assert!(
        verdict.starts_with("Trust energy (") && verdict.contains("Runs with finer steps cover only the time before"),
        "{verdict}"
    );
    let ended = folder.jostle("run late.ron --json --estimate").code(0).json().remove(0);
    assert!(ended["card"]["error"]["horizon"].is_null(), "{ended}");
}

/// Under a tolerance the error is known from the runs that found the steps.
#[test]
fn a_tolerance_needs_no_estimate() {
    let folder = Folder::new("estimate_known").with("fall.ron", FALL);
    let with = folder.jostle("run fall.ron --tolerance 1e-6 --json").code(0).json().remove(0);
    let without = folder.jostle("run fall.ron --tolerance 1e-6 --no-estimate --json").code(0).json().remove(0);
    assert_eq!(with["card"]["error"], without["card"]["error"]);
    assert!(with["card"]["error"]["position"]["discretisation"].is_f64(), "{with}");
}

/// Of a long run only the beginning is made again: the verdict trusts no more than that.
#[test]
fn what_was_not_run_again_is_not_trusted() {
    let spring = r#"Scene(format: 1, clock: (duration: 200, tick: 1e-4, method: VelocityVerlet),
        bodies: [(name: "mass", at: (1, 0), atoms: Disc(radius: 0.1, mass: 1))],
        forces: [Spring(a: "mass", b: World, stiffness: 100, length: 0)])"#;
    let folder = Folder::new("estimate_long").with("spring.ron", spring);
    folder
        .jostle("run spring.ron")
        .code(0)
        .says("Trust energy (")
        .says("Use `--estimate`, which repeats the whole run");
    let card = folder.jostle("run spring.ron --json").code(0).json().remove(0)["card"].clone();
    assert!(card["error"]["horizon"].as_f64().is_some_and(|until| until < 100.0), "{card}");
    folder.jostle("run spring.ron --estimate").code(0).says("Trust it: places to about ");
}
