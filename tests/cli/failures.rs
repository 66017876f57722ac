//! Failing runs: exit code 3, the frames and rows so far kept, and a message with body, tick, time, likely cause and
//! remedy. Expectations that break: exit code 1.

use super::harness::{EXPLOSION, FALL, Folder, OVERFLOW};

/// A scene whose energy explodes.
#[test]
fn a_run_that_explodes_says_where_why_and_what_to_try() {
    let folder = Folder::new("explosion").with("boom.ron", EXPLOSION);
    let ended = folder
        .jostle("run boom.ron")
        .code(3)
        .says("error: boom.ron: the run went wrong: energy came out of nowhere, ")
        .says(" J that were put in, most of it in ")
        .says("help: the tick of 0.01 s is longer than the contacts can bear. The longest stable one was 6.3246e-6 s for `")
        .says(" s: try `--tick 5e-7` or finer\n")
        .says("Do not trust it: the run went wrong: ");
    let names = ["`first`", "`second`"];
    assert!(names.iter().any(|name| ended.err.contains(name)) && ended.err.contains(" s (tick "), "{ended:?}");
}

/// A scene whose numbers stop being numbers.
#[test]
fn a_run_with_infinite_numbers_says_where_and_what_to_try() {
    Folder::new("overflow")
        .with("over.ron", OVERFLOW)
        .jostle("run over.ron")
        .code(3)
        .says("error: over.ron: the run went wrong: the ")
        .says(" of `ball` is infinite or NaN at t = 1.")
        .says(
            "help: numbers grew beyond all bounds. Look for enormous speeds, forces, stiffnesses or sizes, and for masses near zero. \
             Look for drag that stops a body within a tick, and for a plugin that does not book its work. Or try `--tick 0.0025`\n",
        );
}

/// Velocities are numbers, but their squares are not: from the start on, or after a tick of thrust.
#[test]
fn a_run_whose_energy_is_infinite_ends_with_that() {
    let scene = |velocity: f64, more: &str| {
        format!(
            "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: VelocityVerlet), {more}
            bodies: [(name: \"ray\", at: (0, 0), velocity: ({velocity:e}, 0), atoms: Disc(radius: 0.1, mass: 1))])"
        )
    };
    let told = "the kinetic energy of `ray` is infinite or NaN";
    Folder::new("fast").with("fast.ron", scene(1e200, "")).jostle("run fast.ron").code(1).says(told);
    let thrust = "forces: [Thrust(of: \"ray\", force: (1e200, 0))],";
    Folder::new("faster").with("faster.ron", scene(0.0, thrust)).jostle("run faster.ron").code(3).says(told);
}

/// The remedy that is advised helps: with that tick the run ends well.
#[test]
fn the_advised_tick_helps() {
    let folder = Folder::new("remedy").with("boom.ron", EXPLOSION);
    folder.jostle("run boom.ron --tick 5e-7 --duration 0.02 --quiet").code(0);
}

#[test]
fn the_frames_before_a_run_went_wrong_are_kept() {
    let folder = Folder::new("kept").with("boom.ron", EXPLOSION);
    let ended = folder.jostle("render boom.ron --quiet").code(3).says(" before the run went wrong, ");
    let mut decoder = gif::DecodeOptions::new().read_info(std::io::Cursor::new(folder.read("boom.gif"))).unwrap();
    let mut frames = 0;
    while decoder.read_next_frame().unwrap().is_some() {
        frames += 1;
    }
    assert!((1..40).contains(&frames), "{frames}");
    assert!(ended.err.contains(&format!("boom.gif: the {frames} frame")), "{ended:?}");
    folder.jostle("render boom.ron -o frames/ --quiet").code(3);
    assert!(folder.has(&format!("frames/frame_{:05}.png", frames - 1)));
    assert!(!folder.has(&format!("frames/frame_{frames:05}.png")));
    // A picture of a moment that is never reached is not written.
    folder.jostle("render boom.ron --at 3 -o never.png").code(3).says("the run went wrong");
    assert_eq!(folder.names(), ["boom.gif", "boom.ron", "frames"]);
}

#[test]
fn the_rows_before_a_run_went_wrong_are_kept() {
    let folder = Folder::new("rows").with("boom.ron", EXPLOSION);
    folder.jostle("run boom.ron -o table.csv --quiet").code(3);
    let table = String::from_utf8(folder.read("table.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert!(rows.len() > 2 && rows.len() < 41, "{table}");
    assert!(rows[1].starts_with("0,1,0.5,0"), "{table}");
}

#[test]
fn a_run_that_went_wrong_is_told_in_json_too() {
    let folder = Folder::new("json_wrong").with("boom.ron", EXPLOSION);
    for command in ["run boom.ron --json", "render boom.ron --json", "check boom.ron --run --json"] {
        let ended = folder.jostle(command).code(3).says("the run went wrong");
        let [result] = &ended.json()[..] else { panic!("{ended:?}") };
        let verdict = result["card"]["verdict"].as_str().unwrap();
        assert!(verdict.starts_with("Do not trust it: the run went wrong: energy "), "{verdict}");
    }
}

#[test]
fn a_broken_expectation_is_told_in_a_line() {
    let scene =
        FALL.replace("sensors:", "expect: [Position(of: \"ball\", at: 0.1, is: (0, 1), within: 1e-3)], sensors:");
    let folder = Folder::new("broken_expectation").with("fall.ron", scene);
    let line = "expectation broken: Position(of: \"ball\", at: 0.1, is: (0, 1), within: 1e-3): ";
    for command in ["run", "run --quiet", "render", "render --quiet", "check --run"] {
        let ended = folder.jostle(&format!("{command} fall.ron")).code(1).says(line);
        assert_eq!((ended.err.matches("expectation broken").count(), ended.out.as_str()), (1, ""), "{ended:?}");
    }
    // Without a run nothing is broken.
    folder.jostle("check fall.ron").code(0);
}
