//! `sweep`: many values of what varies, in a table that depends on nothing else.

use super::harness::{FALL, Folder};

/// A ball that is thrown upwards, and has to be above a height in the end.
fn thrown() -> String {
    let scene = FALL.replace("at: (0, 1)", "at: (0, 1), velocity: (0, \"2 * lift\")");
    let params =
        "params: { \"lift\": 1, \"n\": 3 },\n    expect: [Inside(of: \"ball\", box: ((-1, 0.85), (1, 9)))],\n)";
    scene.strip_suffix(')').unwrap().to_owned() + params
}

fn table(folder: &Folder, name: &str) -> Vec<Vec<String>> {
    let text = String::from_utf8(folder.read(name)).unwrap();
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// Uniform acceleration: y = 1 + 2 lift t + g t^2 / 2, which velocity Verlet solves exactly (but for rounding). What is not
/// tested: scenes with contacts.
#[test]
fn every_combination_is_a_row_with_what_was_measured() {
    let folder = Folder::new("sweep_rows").with("ball.ron", thrown());
    let ended = folder.jostle("sweep ball.ron --vary lift=0..2:5 --vary gravity[1]=-5,-10 -o out").code(1);
    assert!(ended.err.contains("out/table.csv: 10 runs, 9 good, 1 broken"), "{ended:?}");
    let rows = table(&folder, "out/table.csv");
    let column =
        |name: &str| rows[0].iter().position(|column| column == name).unwrap_or_else(|| panic!("{name}: {rows:?}"));
    assert_eq!(rows[0][..4], ["run", "lift", "gravity[1]", "result"]);
    assert_eq!(rows.len(), 11);
    let (last, most) = (column("ball.position.y final [m]"), column("ball.position.y max [m]"));
    for (run, row) in rows[1..].iter().enumerate() {
        let (lift, gravity) = ([0.0, 0.5, 1.0, 1.5, 2.0][run / 2], [-5.0, -10.0][run % 2]);
        assert_eq!(row[..3], [format!("{}", run + 1), format!("{lift}"), format!("{gravity}")]);
        let y = |t: f64| 1.0 + 2.0 * lift * t + 0.5 * gravity * t * t;
        let cell = |column: usize| row[column].parse::<f64>().unwrap();
        assert!((cell(last) - y(0.2)).abs() < 1e-13, "{row:?}");
        // Looked at where the film has its frames: every tenth of a second.
        let greatest = [y(0.0), y(0.1), y(0.2)].into_iter().fold(f64::NEG_INFINITY, f64::max);
        assert!((cell(most) - greatest).abs() < 1e-13, "{row:?}");
        assert_eq!(row[3], if y(0.2) < 0.85 { "broken" } else { "good" }, "{row:?}");
        assert_eq!(row.last().unwrap().is_empty(), row[3] == "good", "{row:?}");
    }
    let sheet = image::load_from_memory(&folder.read("out/contact_sheet.png")).unwrap();
    // Ten pictures in four columns, with 6 pixels between them.
    assert_eq!(sheet.width(), 4 * 360 + 3 * 6);
}

#[test]
fn tables_depend_neither_on_threads_nor_on_shards() {
    let folder = Folder::new("sweep_shards").with("ball.ron", thrown());
    let vary = "sweep ball.ron --vary lift=1..4 --vary bodies.ball.atoms.mass=1,2,-1 --quiet";
    folder.jostle(&format!("{vary} -o one --threads 1")).code(1);
    folder.jostle(&format!("{vary} -o many --threads 7 --no-sheet")).code(1);
    assert_eq!(folder.read("one/table.csv"), folder.read("many/table.csv"));
    assert!(!folder.has("many/contact_sheet.png"));
    for which in [5, 2, 1, 4, 3] {
        folder.jostle("sweep --merge parts").code(2);
        folder.jostle(&format!("{vary} -o parts --shard {which}/5"));
    }
    folder.jostle("sweep --merge parts").code(0).says("parts/table.csv: 12 runs of 5 shards");
    assert_eq!(folder.read("one/table.csv"), folder.read("parts/table.csv"));
    // A table of another sweep is not taken for one of this one.
    folder.jostle("sweep ball.ron --vary lift=1..12 --quiet -o parts --shard 2/5").code(0);
    folder.jostle("sweep --merge parts").code(2).says("different sweeps");
}

/// Scene, flags and what varies make a sweep; the number of threads and what is drawn do not.
#[test]
fn shards_of_different_sweeps_do_not_merge() {
    let folder = Folder::new("sweep_others").with("ball.ron", thrown());
    let other = thrown().replace("radius: 0.1", "radius: 0.2");
    assert_ne!(other, thrown());
    let folder = folder.with("other.ron", other);
    let sweep = |arguments: &str, which: usize| {
        folder.jostle(&format!("sweep {arguments} --quiet -o parts --shard {which}/2"));
    };
    let plain = "ball.ron --vary lift=1..4";
    for different in [
        "other.ron --vary lift=1..4",
        "ball.ron --vary lift=1..4 --duration 0.1",
        "ball.ron --vary lift=1..4 --set n=4",
        "ball.ron --vary lift=1,2,3,5",
    ] {
        sweep(plain, 1);
        sweep(different, 2);
        let ended = folder.jostle("sweep --merge parts").code(2).says("of different sweeps: ");
        for shard in ["`table.1-of-2.csv` of the sweep ", "`table.2-of-2.csv` of the sweep "] {
            assert!(ended.err.contains(shard), "{different}: {ended:?}");
        }
        assert!(!folder.has("parts/table.csv"), "{different}");
    }
    sweep(&format!("{plain} --threads 1 --no-sheet"), 2);
    folder.jostle("sweep --merge parts").code(0);
}

#[test]
fn runs_that_fail_are_rows_with_their_reason() {
    let folder = Folder::new("sweep_failures").with("ball.ron", thrown());
    let ended = folder.jostle("sweep ball.ron --vary bodies.ball.atoms.mass=1,-1,1 -o out").code(2);
    assert!(ended.err.contains("takes the value 1 twice"), "{ended:?}");
    let ended = folder.jostle("sweep ball.ron --vary bodies.ball.atoms.mass=1,-1,2 -o out").code(1);
    assert!(ended.err.contains("run 2 (bodies.ball.atoms.mass = -1): refused: "), "{ended:?}");
    let rows = table(&folder, "out/table.csv");
    assert_eq!([&rows[1][2], &rows[2][2], &rows[3][2]], ["good", "refused", "good"]);
    assert!(rows[2].concat().contains("bodies[0].atoms.mass: must be"), "{rows:?}");
    // The message of a run that went wrong, without the lines below it.
    let spring = "forces: [Spring(a: \"ball\", b: World, stiffness: \"stiff\")], params: { \"stiff\": 1 },
        expect: [Channel(name: \"ball.position.x\", below: 1e300)],\n)";
    let folder = folder.with("spring.ron", FALL.strip_suffix(')').unwrap().to_owned() + spring);
    let ended = folder.jostle("sweep spring.ron --vary stiff=1,1e9 -o sprung").code(3);
    assert!(ended.err.contains("): failed: "), "{ended:?}");
    let rows = table(&folder, "sprung/table.csv");
    assert_eq!((rows.len(), rows[0].last().map(String::as_str)), (3, Some("reason")));
    assert_eq!([&rows[1][2], &rows[2][2]], ["good", "failed"]);
    assert!(rows[1].last().unwrap().is_empty() && rows[2].concat().contains("energy came out of nowhere"), "{rows:?}");
    // The claim held as long as the run lasted, which says nothing of its end.
    assert_eq!(rows[0][3..5], ["expectations held", "expectations"]);
    assert_eq!([&rows[1][3..5], &rows[2][3..5]], [["1", "1"], ["not reached", "1"]], "{rows:?}");
    // What is wrong with all of them is told with its place.
    let ended = folder.jostle("sweep ball.ron --vary bodies.ball.atoms.mas=1,2 -o out").code(1);
    assert!(ended.err.contains("ball.ron:7:") && ended.err.contains("did you mean `mass`"), "{ended:?}");
}

#[test]
fn results_and_films_are_made_for_each_run() {
    let folder = Folder::new("sweep_films").with("ball.ron", thrown());
    let sweep = "sweep ball.ron --vary lift=1..2 -o out --films --size 32x20 --json --no-sheet --set n=4";
    let ended = folder.jostle(sweep).code(0);
    let results = ended.json();
    assert_eq!(results.len(), 2);
    assert_eq!(results[1]["vary"]["lift"], "2");
    assert_eq!(results[1]["result"], "good");
    assert!(results[1]["channels"]["ball.position.y"]["final"].as_f64().unwrap() > 1.0);
    for film in ["out/run_1.gif", "out/run_2.gif"] {
        assert!(folder.read(film).starts_with(b"GIF89a"), "{film}");
    }
    assert_eq!(ended.err, "");
}

#[test]
fn sweeps_that_cannot_be_are_told_before_anything_runs() {
    let folder = Folder::new("sweep_refused").with("ball.ron", thrown());
    for (arguments, message) in [
        ("--vary gravity=1..3", "say which part of it, such as `gravity[1]`"),
        ("--vary bodies.bal.spin=1..3", "did you mean `ball`?"),
        ("--vary lift=1..3 --vary lift=4", "varies twice"),
        ("--vary clock.tick=1ms,2ms --tick 0.001", "leave --tick away"),
        ("--vary lift=1..3 --set lift=4", "leave --set lift away"),
        ("--vary lift=1..2.5", "say how many values"),
        ("--vary lift=1..1000 --vary n=1..1000", "a sweep makes at most 100000"),
        ("--vary lift=1..2 --shard 3/2", "such as 3/16"),
    ] {
        folder.jostle(&format!("sweep ball.ron {arguments} -o out")).code(2).says(message);
    }
    folder.jostle("sweep ball.ron --vary lift=1..2").code(2).says("--output <DIR>");
    folder.jostle("sweep --merge .").code(2).says("there are no tables of shards");
    assert_eq!(folder.names(), ["ball.ron"]);
}
