//! Wrong flags: the message names them with the expected value, the exit code is 2, and no scene runs.

use super::harness::{FALL, Folder};

#[test]
fn impossible_values_of_flags_are_refused() {
    let folder = Folder::new("flags").with("fall.ron", FALL);
    let time = "expected a time above zero, such as 0.5 (seconds) or 20ms";
    let moment = "expected a time, zero or later, such as 1.5 (seconds) or 20ms";
    let size = "expected width and height in pixels such as 1280x720, each from 16 to 8192";
    let rate = "expected frames per second, from 0.01 to 1000";
    let threads = "expected a whole number from 1 to 1024";
    for (flag, name, values, message) in [
        ("--duration", "T", &["-1", "0", "nan", "inf", "1e400", "long"][..], time),
        ("--tick", "DT", &["-1", "0", "nan", "1e-400", "1kg"], time),
        ("--at", "T", &["-1", "nan", "inf", "soon"], moment),
        ("--size", "WxH", &["0x0", "1e9x1", "8193x16", "720", "64x", "x"], size),
        ("--fps", "N", &["0", "-1", "nan", "1e9", "1001"], rate),
        ("--threads", "N", &["0", "-1", "1025", "99999999999999999999", "all"], threads),
        (
            "--tolerance",
            "X",
            &["-1", "0", "1", "nan", "fine"],
            "expected a share above zero and below one, such as 1e-6",
        ),
    ] {
        for value in values {
            let ended = folder.jostle(&format!("render fall.ron {flag} {value}")).code(2);
            let expected = format!("error: invalid value '{value}' for '{flag} <{name}>': {message}\n");
            assert!(ended.err.starts_with(&expected), "{ended:?}");
        }
    }
    assert_eq!(folder.names(), ["fall.ron"]);
}

#[test]
fn an_unknown_method_is_answered_with_the_registered_ones() {
    let folder = Folder::new("method").with("fall.ron", FALL);
    let known = "[possible values: Auto, Reference, ExplicitEuler, SemiImplicitEuler, VelocityVerlet, RungeKutta4";
    folder.jostle("run fall.ron --method Leapfrog").code(2).says("'Leapfrog' for '--method <NAME>'").says(known);
    folder
        .jostle("run fall.ron --method SemiImplicitEuler")
        .code(0)
        .says("method SemiImplicitEuler from the command line");
}

#[test]
fn unknown_flags_and_missing_scenes_are_usage() {
    let folder = Folder::new("usage").with("fall.ron", FALL);
    folder.jostle("render fall.ron --durration 20").code(2).says("a similar argument exists: '--duration'");
    folder.jostle("render").code(2).says("<SCENE>...");
    folder.jostle("").code(2).says("Usage: jostle [OPTIONS] <COMMAND>");
    folder.jostle("play fall.ron").code(2).says("unrecognized subcommand 'play'");
}

#[test]
fn overrides_are_named_on_the_card() {
    let folder = Folder::new("overrides").with("fall.ron", FALL);
    folder
        .jostle("run fall.ron --tick 2ms --duration 0.1")
        .code(0)
        .says("tick 0.002 s from the command line")
        .says("duration 0.1 s from the command line")
        .says("0.1 s in 50 ticks");
}

/// A scene with both is refused; so is one with the other from the command line.
#[test]
fn a_reference_run_takes_no_tolerance() {
    let referred = FALL.replace("VelocityVerlet", "Reference");
    let folder = Folder::new("reference").with("fall.ron", FALL).with("referred.ron", referred);
    let wrong = "`Reference` makes the smallest error there is: it takes no tolerance";
    for scene in ["fall.ron --method Reference", "referred.ron"] {
        folder.jostle(&format!("run {scene} --tolerance 1e-3")).code(1).says(wrong).says("--method Auto");
    }
    folder.jostle("run referred.ron --tolerance 1e-3 --method Auto").code(0);
}

/// What the command line puts in place of something of the scene stands on the card.
#[test]
fn what_is_left_out_of_the_clock_is_named_on_the_card() {
    let fall = "Scene(format: 1, clock: (duration: 1, tolerance: 1e-5), gravity: (0, -10),
        bodies: [(name: \"ball\", at: (0, 5), atoms: Disc(radius: 0.1))])";
    let folder = Folder::new("left_out").with("free.ron", fall).with("ticks.ron", fall.replace("tolerance", "tick"));
    let left_out = "the run leaves out the tolerance 1e-5 of the scene: ";
    folder
        .jostle("run free.ron --tick 1ms")
        .code(0)
        .says(&format!("{left_out}the command line gives a tick in its place"));
    folder.jostle("run free.ron --method Reference").code(0).says(&format!("{left_out}`Reference` makes the smallest"));
    folder.jostle("run ticks.ron --tolerance 1e-3").code(0).says("in place of the tick of the scene");
}

#[test]
fn moments_beyond_the_run_are_refused() {
    let folder = Folder::new("beyond").with("fall.ron", FALL).with("late.ron", FALL.replace("fps: 10", "from: 30"));
    let ended = folder.jostle("render fall.ron --at 0.3").code(2);
    assert_eq!(ended.err, "error: --at 0.3 s is after the end: the run lasts 0.2 s\n");
    folder.jostle("render fall.ron --at 0.2 --quiet").code(0);
    let message = "error: film.from: the film begins at 30 s, but the run ends at 0.2 s";
    folder.jostle("render late.ron").code(1).says(message).says("begin earlier, or let the run last longer");
    // The film never changes the physics: it cannot be wrong for those who do not film.
    folder.jostle("run late.ron").code(0);
    assert_eq!(folder.names(), ["fall.png", "fall.ron", "late.ron"]);
}

#[test]
fn films_of_more_frames_than_anybody_watches_are_refused() {
    let folder = Folder::new("frames").with("slow.ron", FALL.replace("fps: 10", "speed: 1e-300"));
    folder.jostle("render slow.ron").code(1).says("film: 0.2 s of physics would be 6e300 frames, more than 1000000");
    folder.jostle("render slow.ron --fps 50").code(2).says("a higher `speed`");
    assert_eq!(folder.names(), ["slow.ron"]);
}

/// The run would last for minutes: the refusal must not wait for the camera that looks ahead.
#[test]
fn rates_beyond_the_format_are_refused_before_the_run() {
    let folder = Folder::new("rate").with("fall.ron", FALL.replace("duration: 0.2", "duration: 1e6"));
    let message = "60 frames per second cannot be shown in this format";
    folder.jostle("render fall.ron --fps 60 --duration 1e4").code(2).says(message).says("use `--fps 50`");
}

/// `--set` gives a parameter another value, in every command that runs scenes; the card and the messages say so.
#[test]
fn parameters_are_set() {
    let scene =
        FALL.replacen("(0, 1)", "(0, \"high\")", 1).replacen("gravity:", "params: { \"high\": 1 }, gravity:", 1);
    let folder = Folder::new("set").with("fall.ron", &scene).with("high.ron", FALL.replacen("(0, 1)", "(0, 3)", 1));
    let height = |arguments: &str| {
        let ended = folder.jostle(&format!("run --json {arguments}")).code(0);
        ended.json()[0]["bodies"][0]["position"][1].as_f64().unwrap()
    };
    let by_hand = height("high.ron");
    for flags in ["--set high=3", "--set high=300cm", "--set high=2 --set high=3"] {
        assert_eq!(height(&format!("fall.ron {flags}")), by_hand, "{flags}");
    }
    folder.jostle("check fall.ron --set high=3").code(0).says("note: fall.ron: high = 3 from the command line");
    folder
        .jostle("check fall.ron --set hihg=3")
        .code(1)
        .says("--set hihg: the scene has no parameter `hihg`")
        .says("did you mean `high`?");
    folder
        .jostle("render fall.ron --set high=3kg -o fall.png --at 0")
        .code(1)
        .says("got a mass `3 kg`")
        .says("--> fall.ron:");
    folder.jostle("run fall.ron --set high").code(2).says("expected a parameter and its value, such as n=9");
}
