//! `bench`: what ticks cost. Times differ from computer to computer and from run to run; everything else does not. Not tested: that
//! times are right.

use super::harness::{EXPLOSION, FALL, Folder};

#[test]
fn what_is_not_time_is_the_same_each_time() {
    let folder = Folder::new("bench_json");
    let measure = || {
        let [json] = &folder.jostle("bench example:tetris --ticks 40 --rounds 2 --json").code(0).json()[..] else {
            panic!("one line")
        };
        json.clone()
    };
    let (json, again) = (measure(), measure());
    for key in ["scene", "bodies", "atoms", "ticks", "candidate_pairs", "touching_pairs", "energy_residual", "hash"] {
        assert!(!json[key].is_null() && json[key] == again[key], "{key}: {} {}", json[key], again[key]);
    }
    // A round goes ahead of the two.
    assert_eq!((&json["atoms"], &json["ticks"]), (&87.into(), &120.into()));
    let [run] = &folder.jostle("run example:tetris --duration 0.12 --json").code(0).json()[..] else {
        panic!("one line")
    };
    assert_eq!(json["hash"], run["card"]["hash"], "it is the run of the scene");
    let [later] = &folder.jostle("bench example:tetris --ticks 40 --rounds 1 --from 40ms --json").code(0).json()[..]
    else {
        panic!("one line")
    };
    assert_eq!(json["hash"], later["hash"], "40 ticks ahead, a round that is not timed, and one");
    let sum: f64 = json["stages"].as_array().unwrap().iter().map(|stage| stage["share"].as_f64().unwrap()).sum();
    // All parts of the ticks: rounding is all that may be missing.
    assert!((sum - 1.0).abs() < 1e-9, "{json}");
    for key in ["us_per_tick", "ns_per_atom_tick"] {
        let of = |which: &str| json[key][which].as_f64().unwrap();
        assert!(0.0 < of("min") && of("min") <= of("median") && of("median") <= of("max"), "{key}: {json}");
    }
    assert!(json["plain"]["ratio"]["median"].as_f64().unwrap() > 0.0, "{json}");
    assert_eq!(json["bytes"].is_null(), !cfg!(target_os = "linux"));
}

#[test]
fn scenes_are_told_in_a_table() {
    let folder = Folder::new("bench_table").with("fall.ron", FALL);
    let ended = folder.jostle("bench example:bounce fall.ron --quick --rounds 1 --ticks 5").code(0);
    let lines: Vec<&str> = ended.out.lines().collect();
    assert!(lines[0].starts_with("scene ") && lines[0].ends_with("x plain  bytes/atom"), "{}", ended.out);
    assert!(lines[1].starts_with("example:bounce ") && lines[2].starts_with("fall "), "{}", ended.out);
    for text in
        ["Where the time goes:", "Integrate", "What came out:", "note: fall: no plain loop beside it, for its contacts"]
    {
        assert!(ended.out.contains(text), "{text}: {}", ended.out);
    }
    // Without a name there is something to measure, too.
    let ended = folder.jostle("bench --quick --ticks 2 --rounds 1").code(0).says("scenes/benchmarks");
    assert!(ended.out.contains("bench:gas"), "{}", ended.out);
}

#[test]
fn what_cannot_be_measured_is_told() {
    let folder = Folder::new("bench_wrong").with("explosion.ron", EXPLOSION);
    folder.jostle("bench nowhere.ron").code(2).says("there is no file `nowhere.ron`");
    let ended = folder.jostle("bench explosion.ron example:tetris --ticks 200 --rounds 1").code(3);
    assert!(ended.out.contains("example:tetris"), "the others are measured: {}", ended.out);
    folder.jostle("bench example:tetris --rounds 0").code(2);
    folder.jostle("bench example:tetris --from 1e9").code(2).says("the scene ends after 20 s");
    let ended = folder.jostle("bench example:tetris --method RungeKutta4 --quick --ticks 5 --rounds 1").code(0);
    assert!(ended.out.contains("its method is not velocity Verlet in whole ticks"), "{}", ended.out);
}
