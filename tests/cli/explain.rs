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
        "mean of 200 ticks",
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
        ("events", "When jumps of the forces take place"),
        ("horizon", "up to which places can be told"),
        ("Reference", "the smallest error there is"),
        ("events located", "how often a step ended where forces jump"),
        ("packing", "`packings` is a section of the scene"),
        ("body", "`bodies` is a section of the scene"),
        ("rest", "nothing moves at all, to the last bit"),
        ("asleep", "ticks leave them out"),
        ("sleep", "ticks leave them out"),
        ("simd", "`--simd LEVEL` is a flag of `jostle run`, "),
        ("vector instructions", "A level that the processor lacks is refused"),
        ("threads", "Threads that draw and that share the work of a tick"),
        ("quick", "`--quick` is a flag of `jostle bench`: "),
    ] {
        let ended = folder.jostle(&format!("explain {name}")).code(0);
        assert!(ended.out.contains(text), "{name}: {ended:?}");
    }
    folder.jostle("explain Darg").code(2).says("did you mean `Drag`?");
    folder.jostle("explain thread").code(0);
    folder.jostle("explain treads").code(2).says("did you mean `threads`?");
    folder.jostle("explain Drag --json").code(2).says("--json is for scenes");
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
