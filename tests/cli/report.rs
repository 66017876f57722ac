//! `jostle report`: its outputs, and its refusals. Not tested: that times are right; the hard cases themselves (see
//! `laws/hard`).

use super::harness::Folder;

#[test]
fn problems_are_reported_with_tables_diagrams_and_pages() {
    let folder = Folder::new("report");
    let peers =
        "problem,unit,engine,version,settings,step,error,cpu,failed\nfree_flight,m,other,1.2,default,0.1,0.1,1e-5,\n";
    let folder = folder.with("peers.csv", peers);
    let ended = folder.jostle("report free_flight sliding_stop spin pile -o out --quick --peers peers.csv").code(0);
    ended.says("2 problems and 1 hard case in out/report.html");
    let read = |name: &str| std::fs::read_to_string(folder.path(&format!("out/{name}"))).expect(name);
    let csv = read("sliding_stop.csv");
    assert!(csv.starts_with("method,events,tick [s],error,seconds_per_second,"), "{csv}");
    // Each row has numbers or a reason.
    for row in csv.lines().skip(1) {
        let cells: Vec<&str> = row.splitn(7, ',').collect();
        let measured = cells[3].parse::<f64>().is_ok_and(|error| error >= 0.0)
            && cells[4].parse::<f64>().is_ok_and(|cost| cost > 0.0);
        assert!(measured != (cells[6].len() > 2), "{row}");
    }
    let picture = image::load_from_memory(&folder.read("out/free_flight.png")).expect("a diagram");
    assert_eq!((picture.width(), picture.height()), (960, 600));
    let (markdown, html) = (read("report.md"), read("report.html"));
    for page in [&markdown, &html] {
        for word in ["free_flight", "sliding_stop", "VelocityVerlet", "reference", "rustc", "commit", "state hash"] {
            assert!(page.to_lowercase().contains(&word.to_lowercase()), "{word}: {page}");
        }
        // What is left out is told; what is run stands beside its threshold.
        assert!(page.contains("Left out") && page.contains("pile") && page.contains("16 units in the last place"));
        // The curve of the other engine comes with what it is.
        assert!(page.contains("Other engines: the same scene and norm"), "{page}");
    }
    assert!(markdown.contains("![Cost against error of free_flight](free_flight.png)"), "{markdown}");
    // The page needs nothing beside itself.
    assert_eq!(html.matches("src=\"data:image/png;base64,").count(), 2);
    assert_eq!(html.matches("src=").count(), 2);
    let cases = read("hard_cases.csv");
    assert!(cases.lines().skip(1).all(|row| row.starts_with("spin,") && row.contains(",passed,")), "{cases}");
}

/// Where Git keeps no files, there is nothing to compare with; `JOSTLE_COMMIT` tells another commit on purpose.
#[test]
fn a_report_tells_the_commit_that_is_checked_out() {
    let root = env!("CARGO_MANIFEST_DIR");
    if !std::path::Path::new(root).join(".git").exists() || option_env!("JOSTLE_COMMIT").is_some() {
        return;
    }
    let told =
        std::process::Command::new("git").args(["-C", root, "rev-parse", "HEAD"]).output().expect("git is there");
    let commit = String::from_utf8(told.stdout).unwrap();
    let folder = Folder::new("commit");
    folder.jostle("report spin -o out --quick").code(0);
    let page = std::fs::read_to_string(folder.path("out/report.md")).unwrap();
    assert!(page.contains(&format!("| commit | {} |", &commit[..12])), "{commit}: {page}");
}

#[test]
fn what_cannot_be_reported_is_refused() {
    let folder = Folder::new("no_report").with("table.csv", "a,b\n1,2\n");
    folder.jostle("report keplr -o out").code(2).says("there is no problem `keplr`; did you mean `kepler`?");
    std::fs::write(folder.path("file"), "").unwrap();
    folder.jostle("report kepler -o file/out").code(2).says("cannot be made");
    folder.jostle("report gas -o out --quick").code(2).says("--quick leaves out gas");
    folder.jostle("report kepler -o out --peers nowhere.csv").code(2).says("there is no file `nowhere.csv`");
    folder.jostle("report kepler -o out --peers table.csv").code(2).says("table.csv: line 1: the columns of");
}
