//! `run --fps`: how often a row of channels is written.

use super::harness::{FALL, Folder};

/// The times of the rows of a run of 0.2 s in ticks of 1 ms, in ms.
fn rows(folder: &Folder, flags: &str) -> Vec<f64> {
    folder.jostle(&format!("run fall.ron -o rows.csv {flags}")).code(0);
    let table = String::from_utf8(folder.read("rows.csv")).unwrap();
    table.lines().skip(1).map(|line| 1e3 * line.split(',').next().unwrap().parse::<f64>().unwrap()).collect()
}

/// Law: row k of a rate stands at the tick nearest to k / rate; the first and the last moment are there.
#[test]
fn rows_stand_at_the_ticks_nearest_to_their_moments() {
    let folder = Folder::new("rows").with("fall.ron", FALL);
    for (rate, count) in [(5.0, 2), (10.0, 3), (30.0, 7), (100.0, 21), (400.0, 81), (1000.0, 201)] {
        let rows = rows(&folder, &format!("--fps {rate}"));
        assert_eq!(rows.len(), count, "{rate}: {rows:?}");
        for (index, row) in rows.iter().enumerate() {
            let moment = index as f64 * 1e3 / rate;
            assert!((row - moment).abs() <= 0.5 + 1e-9, "{rate}: row {index} at {row} ms, not {moment} ms");
        }
    }
    // Frames of the film without it, and under a tolerance as often as asked for.
    assert_eq!(rows(&folder, "").len(), 3);
    assert_eq!(rows(&folder, "--tolerance 1e-6 --fps 100").len(), 21);
}

#[test]
fn more_rows_than_ticks_are_told() {
    let folder = Folder::new("rows_many").with("fall.ron", FALL);
    let ended = folder.jostle("run fall.ron -o rows.csv --fps 5000").code(0);
    ended.says("note: --fps 5000 asks for more rows than the run has ticks. Each tick gives one row, every 0.001 s");
    assert_eq!(rows(&folder, "--fps 5000").len(), 201);
    folder.jostle("run fall.ron --fps 100").code(2).says("--output");
    folder.jostle("run fall.ron -o rows.csv --fps 0").code(2).says("expected rows for each second of physics");
}
