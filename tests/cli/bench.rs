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
    assert!(json["bytes_per_atom"].is_null(), "tetris is smaller than the program: {json}");
}

/// Memory is that of the scene: of 2000 discs no more than some kB each, and no less than what a disc's state takes (place,
/// velocity, angle, spin, mass, inertia and radius, ten numbers).
#[test]
fn memory_is_told_where_it_is_that_of_the_scene() {
    let folder = Folder::new("bench_memory");
    let measure = |scenes: &str| folder.jostle(&format!("bench {scenes} --ticks 2 --rounds 1 --json")).code(0).json();
    if let Some(bytes) = measure("bench:gas")[0]["bytes_per_atom"].as_f64() {
        assert!((80.0..5000.0).contains(&bytes), "{bytes}");
    }
    let table = folder.jostle("bench example:tetris --ticks 2 --rounds 1").code(0).out;
    assert!(table.lines().nth(1).is_some_and(|row| row.ends_with(" -")), "{table}");
}

/// What the help shows can be pasted at the root of the repository. It is run with short rounds.
#[test]
fn examples_of_the_help_can_be_pasted() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let help = Folder::new("bench_help").jostle("bench --help").code(0).out;
    let examples = help.lines().filter_map(|line| line.strip_prefix("  jostle "));
    let mut seen = 0;
    for example in examples.map(|line| line.split("  ").next().unwrap_or(line)) {
        let mut words: Vec<String> = example.split(' ').map(str::to_owned).collect();
        if let Some(star) = words.iter().position(|word| word.contains('*')) {
            let pattern = words.remove(star);
            let (folder, ending) = pattern.rsplit_once("/*").unwrap();
            let files = std::fs::read_dir(root.join(folder)).unwrap().map(|file| file.unwrap().path());
            let files = files.filter(|file| file.to_str().is_some_and(|name| name.ends_with(ending)));
            words.extend(files.map(|file| file.to_str().unwrap().to_owned()));
            assert!(words.len() > 2, "{pattern} fits nothing");
        }
        for (flag, value) in [("--ticks", "1"), ("--rounds", "1")] {
            if !words.iter().any(|word| word == flag) {
                words.extend([flag.to_owned(), value.to_owned()]);
            }
        }
        let ended = std::process::Command::new(env!("CARGO_BIN_EXE_jostle"))
            .args(&words)
            .current_dir(root)
            .output()
            .unwrap_or_else(|error| panic!("{example}: {error}"));
        assert!(ended.status.success(), "{example}: {}", String::from_utf8_lossy(&ended.stderr));
        seen += 1;
    }
    assert!(seen >= 6, "{help}");
}

#[test]
fn scenes_are_told_in_a_table() {
    let folder = Folder::new("bench_table").with("fall.ron", FALL);
    let ended = folder.jostle("bench example:bounce fall.ron --quick --rounds 1 --ticks 5").code(0);
    let lines: Vec<&str> = ended.out.lines().collect();
    assert!(lines[0].starts_with("scene ") && lines[0].ends_with("x plain  bytes/atom"), "{}", ended.out);
    assert!(lines[1].starts_with("example:bounce ") && lines[2].starts_with("fall "), "{}", ended.out);
    for text in [
        "The shares of the time:",
        "Integrate",
        "The results of the runs:",
        "note: fall: no plain loop beside it, for its contacts",
    ] {
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
