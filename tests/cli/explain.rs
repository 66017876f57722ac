//! `explain`: what a scene does in a tick, and what words mean.

use super::harness::{FALL, Folder};

/// Shares and times are measured and differ; everything else does not.
#[test]
fn a_scene_is_taken_apart() {
    let folder = Folder::new("explain_scene").with("fall.ron", FALL);
    let ended = folder.jostle("explain example:tetris --duration 0.2").code(0);
    for text in [
        "example:tetris: Blocks among pegs\n",
        "6 bodies (5 moved by forces, 1 fixed or led), 87 atoms, 4 walls\n",
        "jostle::forces::gravity",
        "sensors: Pose",
        "Evaluate: Pairs",
        "Evaluate: Contacts",
        "apply_forces (jostle::tick::stages)",
        "PairSearch (jostle::contacts::search",
        "for `gravity`)",
        "for `contacts: Penalty (by default)`)",
        "mean of all 200 ticks of the run",
    ] {
        assert!(ended.out.contains(text), "{text}: {}", ended.out);
    }
    let [json] = &folder.jostle("explain fall.ron --json").code(0).json()[..] else { panic!("one line") };
    assert_eq!(json["ticks"], 200);
    assert_eq!(json["tick"], 0.001);
    let stages = json["stages"].as_array().unwrap();
    let sum: f64 = stages.iter().map(|stage| stage["share"].as_f64().unwrap()).sum();
    // All parts of the ticks, and nothing else: rounding is all that may be missing.
    assert!((sum - 1.0).abs() < 1e-9, "{stages:?}");
    let forces = stages.iter().find(|stage| stage["stage"] == "Evaluate: Forces").unwrap();
    let integrate = stages.iter().find(|stage| stage["stage"] == "Integrate").unwrap();
    assert_eq!(integrate["systems"][0]["name"], "integrate");
    let serves: Vec<&str> = forces["systems"].as_array().unwrap().iter().filter_map(|s| s["serves"].as_str()).collect();
    assert_eq!(serves, ["gravity"]);
    folder.jostle("explain nowhere.ron").code(2).says("there is no file `nowhere.ron`");
}

#[test]
fn names_and_words_are_explained() {
    let folder = Folder::new("explain_names");
    for (name, text) in [
        ("Drag", "`Drag` is an entry of `forces`"),
        ("gravity", "gravity: (0, -9.81)"),
        ("forces", "takes entries: "),
        ("velocityverlet", "order 2"),
        ("critical tick", "the longest tick that the method bears"),
        ("energy.residual", "is a channel"),
        ("tolerance", "`clock.tolerance` is a field of the section `clock`"),
        ("duration", "Length of the run"),
        ("events", "The moments at which forces jump"),
        ("horizon", "until which places are known"),
        ("Reference", "the smallest error there is"),
        ("events located", "the number of steps that ended at a jump of a force"),
        ("packing", "`packings` is a section of the scene"),
        ("body", "`bodies` is a section of the scene"),
        ("rest", "do not move at all, to the last bit"),
        ("asleep", "Ticks leave such bodies out"),
        ("sleep", "Ticks leave such bodies out"),
        ("simd", "`--simd LEVEL` is a flag of `jostle run`, "),
        ("vector instructions", "refuses a level that the processor lacks"),
        ("threads", "Draw with so many threads, and share the work of a tick"),
        ("quick", "`--quick` is a flag of `jostle bench`: "),
    ] {
        let ended = folder.jostle(&format!("explain {name}")).code(0);
        assert!(ended.out.contains(text), "{name}: {ended:?}");
    }
    for (name, texts) in [
        ("hinge", &["Scenes say `Revolute` for hinge.", "`Revolute` is an entry of `joints`"][..]),
        ("slider", &["`Prismatic` is an entry of `joints`"]),
        ("rod", &["`Distance` is an entry of `joints`"]),
        ("pid", &["`Servo` is an entry of `controllers`"]),
        ("time step", &["Scenes say `tick` for time step.", "`clock.tick` is a field of the section `clock`"]),
        ("Uniform", &["`Uniform` is a choice of `fill.radius`.\nFor example: Uniform(0.01, 0.02)\nevery radius from"]),
        (
            "LogNormal",
            &["`LogNormal` is a choice of `fill.radius`", "\n  mean: length in m; needed. The mean of the radius"],
        ),
        ("choice", &["`Choice` is a choice of `fill.radius`"]),
        (
            "radius",
            &[
                "`fill.radius` is a field of the section `fill`",
                "`radius` is a field of:",
                "`joints: Rack`",
                "; needed. ",
            ],
        ),
        ("datum", &["`bodies.datum` is a field of the section `bodies`", "default: "]),
        ("anchor", &["anchor_a: ", "anchor_b: ", "`joints: Revolute`", "default: "]),
        ("largest share", &["the greatest depth of two bodies, or of a body and a wall, in each other"]),
        ("overlap", &["`Overlap` is an entry of `sensors`", "the greatest depth of two bodies, or of a body"]),
        ("restitution", &["materials", "joints"]),
        ("Gear", &["`Gear` is a choice of `bodies.shape`", "\n  teeth: "]),
    ] {
        let ended = folder.jostle(&format!("explain {name}")).code(0);
        texts.iter().for_each(|text| assert!(ended.out.contains(text), "{name}: {text}: {}", ended.out));
    }
    folder.jostle("explain hing").code(2).says("did you mean `hinge`?");
    folder.jostle("explain Darg").code(2).says("did you mean `Drag`?");
    folder.jostle("explain thread").code(0);
    folder.jostle("explain treads").code(2).says("did you mean `threads`?");
    folder.jostle("explain Drag --json").code(2).says("--json is for scenes");
}

/// What a channel is, its unit and the sensor that gives it, from its name or a part of it; in a scene its value too.
#[test]
fn channels_are_explained() {
    let folder = Folder::new("explain_channels").with("fall.ron", FALL);
    for (name, texts) in [
        (
            "kinetic",
            &["`energy.kinetic` is a channel, in J. ", "The sensor `Energy` makes a column of it: Energy()"][..],
        ),
        (
            "ball.position.x",
            &["`position.x` of a body, in m. ", "The sensor `Pose` makes a column of it: Pose(of: \"ball\")"],
        ),
        ("ball.weight.y", &["`weight.y` of a body, in N", "The sensor `Force`"]),
        ("spin", &["`NAME.spin` is a channel: `spin` of a body, in rad/s"]),
        ("hip.travel", &["`travel` of a joint that slides, in m", "The sensor `Joint`"]),
        ("gap.clearance", &["`clearance` of a sensor, by its name", "The sensor `Clearance`"]),
        ("ball.x", &["`ball.x` is a part of the names of channels: ", "`ball.position.x`", "`ball.velocity.x`"]),
        ("fall.ron ball.position.y", &["`ball.position.y` is a channel of fall.ron, in m. At the start it is "]),
    ] {
        let ended = folder.jostle(&format!("explain {name}")).code(0);
        texts.iter().for_each(|text| assert!(ended.out.contains(text), "{name}: {text}: {}", ended.out));
    }
    // In a scene the sensor is told as the scene writes it.
    let sensors = "[Pose(of: \"b*\"), Mean(name: \"bed\", of: \"*\",
        quantity: \"speed\"), Mean(name: \"other\", of: \"ball\", quantity: \"position.y\")]";
    let folder = folder.with("measured.ron", FALL.replace("[Pose(of: \"ball\"), Energy()]", sensors));
    for (name, entry, others) in [
        ("ball.position.y", "`sensors[0]` of the scene makes a column of it: Pose(of: \"b*\")\n", "Mean("),
        ("bed.mean", ": Mean(name: \"bed\", of: \"*\", quantity: \"speed\")\n", "Mean(name: \"other\""),
    ] {
        let told = folder.jostle(&format!("explain measured.ron {name}")).code(0).out;
        assert!(told.contains(entry) && !told.contains(others), "{name}: {told}");
    }
    folder
        .jostle("explain fall.ron bal.position.y")
        .code(2)
        .says("there is no channel `bal.position.y`")
        .says("did you mean \"ball\"");
}

/// A run that takes longer than the look at it is told as far as it was looked at.
#[test]
fn a_long_run_is_told_as_far_as_it_was_looked_at() {
    let folder = Folder::new("explain_long").with("fall.ron", FALL);
    let ended = folder.jostle("explain fall.ron --duration 1e6").code(0);
    assert!(ended.out.contains("mean of the first ") && ended.out.contains(" of 1000000 s"), "{}", ended.out);
    assert!(ended.out.contains("The first tenth of these ticks took "), "{}", ended.out);
    assert!(ended.out.contains("Later ticks may cost more or less"), "{}", ended.out);
    let [json] = &folder.jostle("explain fall.ron --duration 1e6 --json").code(0).json()[..] else {
        panic!("one line")
    };
    assert_eq!(json["ticks_of_run"], 1_000_000_000);
    assert!(json["ticks"].as_u64().unwrap() < 1_000_000_000);
}

/// Whatever the card says in front of a number is explained.
#[test]
fn every_row_of_the_card_is_explained() {
    let folder = Folder::new("explain_card");
    let card = folder.jostle("run example:tetris --duration 2").code(0).err;
    let rows = card.lines().skip(1).take_while(|line| !line.starts_with("  Trust") && !line.starts_with("  Do not"));
    let rows: Vec<&str> = rows.map(|line| line[..20].trim()).filter(|row| *row != "time").collect();
    assert_eq!(rows.len(), 11, "{card}");
    for row in rows {
        folder.jostle(&format!("explain {row}")).code(0);
    }
    folder.jostle("explain verdict").code(0);
}
