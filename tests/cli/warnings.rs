//! Runs that end beyond a limit of their tick: a line each on standard error, a note on the card, exit code 0.

use super::harness::Folder;

/// A ball of 1 kg on a spring of 10 kN/m: its contact lasts pi/100 s, the critical tick is 1/50 s.
const BOUNCE: &str = r#"Scene(
    format: 1,
    clock: (duration: 0.5, tick: "1 ms", method: VelocityVerlet),
    film: (fps: 10, size: (64, 36)),
    gravity: (0, -10),
    materials: { "rubber": (stiffness: "10 kN/m") },
    walls: [(name: "floor", left: (1, 0), right: (0, 0), material: "rubber")],
    bodies: [(name: "ball", at: (0, 0.3), material: "rubber", atoms: Disc(radius: 0.1, mass: 1))],
)"#;

const BRIEF: &str = "the contact of `floor` and `ball` at t = 0.205 s lasts 6.3 ticks. The run does not resolve an impact of \
                     fewer than 7. Use --tick ";
const ABOVE: &str = "the tick of 0.025 s is above the critical one of 0.02 s. The contacts of `ball` set it at t = ";
const FAR: &str = "`ball` travelled 1.12 times the smallest radius in the tick before t = 0.25 s. It may have passed through \
                   others unseen. Use --tick ";

/// Runs with a tick; the warning is told in a line, and as a note in the JSON.
#[track_caller]
fn warns(folder: &str, tick: &str, warning: &str) {
    let folder = Folder::new(folder).with("bounce.ron", BOUNCE);
    for command in ["run", "run --quiet", "render", "render --quiet", "check --run"] {
        let ended = folder.jostle(&format!("{command} bounce.ron --tick {tick}")).code(0);
        let line = format!("warning: bounce.ron: {warning}");
        assert_eq!(ended.err.matches(&line).count(), 1, "{command}: {line}\n{ended:#?}");
    }
    let ended = folder.jostle(&format!("run bounce.ron --tick {tick} --json")).code(0);
    let note = ended.json()[0]["card"]["notes"]
        .as_array()
        .unwrap()
        .iter()
        .any(|note| note.as_str().unwrap().starts_with(&format!("warning: {warning}")));
    assert!(note, "{ended:#?}");
}

#[test]
fn a_contact_of_few_ticks() {
    warns("brief", "5ms", BRIEF);
}

#[test]
fn a_tick_above_the_critical_one() {
    warns("above", "25ms", ABOVE);
}

#[test]
fn a_body_that_travels_farther_than_the_smallest_radius() {
    warns("far", "50ms", FAR);
}

/// With the tick that is advised nothing is left to warn of.
#[test]
fn the_advised_tick_helps() {
    let folder = Folder::new("advised").with("bounce.ron", BOUNCE);
    for tick in ["5ms", "25ms"] {
        let ended = folder.jostle(&format!("run bounce.ron --tick {tick}"));
        let line = ended.err.lines().find(|line| line.starts_with("warning: ")).unwrap();
        let advice = line.split("Use --tick ").nth(1).unwrap();
        let again = folder.jostle(&format!("run bounce.ron --tick {advice}")).code(0);
        assert!(!again.err.contains("warning: "), "{again:#?}");
    }
}

/// A tolerance out of reach has its cause. If that is the finest steps, neither rounding nor chaos is blamed. A line and the verdict tell
/// it, and the card below that line does not repeat it.
#[test]
fn a_tolerance_that_the_finest_steps_do_not_reach() {
    let folder = Folder::new("finest");
    for (scene, cause) in [
        ("bounce --duration 4 --tolerance 1e-12", ": the engine takes no finer steps"),
        ("tetris --duration 4 --tolerance 1e-9", ": the motion magnifies errors of the finest steps, as chaos does"),
    ] {
        let told = folder.jostle(&format!("run example:{scene}")).err;
        assert!(told.starts_with("warning: example:") && told.contains(cause), "{scene}: {told}");
        assert!(!told.contains("by rounding or chaos"), "{scene}: {told}");
        assert_eq!(told.matches("is not reached").count(), 2, "{scene}: {told}");
    }
}

#[test]
fn a_good_run_has_none() {
    let folder = Folder::new("no_warning").with("bounce.ron", BOUNCE);
    for scene in ["bounce.ron", "example:tetris", "example:billiards", "example:kepler"] {
        let ended = folder.jostle(&format!("run {scene}")).code(0);
        assert!(!ended.err.contains("warning"), "{ended:#?}");
    }
}

/// What is advised can be done: a tick of zero cannot, and neither can a tick where an error is asked for.
#[test]
fn the_advice_suits_the_run() {
    let folder = Folder::new("advice").with("bounce.ron", BOUNCE);
    let said = |flags: &str| folder.jostle(&format!("run bounce.ron {flags}")).code(0).err;
    let euler = said("--method ExplicitEuler --duration 0.3");
    assert!(
        euler.contains("Use --method VelocityVerlet") && euler.contains("Use `--method VelocityVerlet`."),
        "{euler}"
    );
    assert!(euler.contains("(none is stable)") && !euler.contains("--tick"), "{euler}");
    for flags in ["--tolerance 1e-4", "--method Reference"] {
        let card = said(flags);
        assert!(!card.contains("--tick"), "{flags}: {card}");
    }
    assert!(said("--tick 1ms").contains("--tick 0.0002"));
}
