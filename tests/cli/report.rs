//! `jostle report`: what it writes, and what it refuses.

use super::harness::Folder;

#[test]
fn problems_are_reported_with_tables_diagrams_and_pages() {
    let folder = Folder::new("report");
    folder.jostle("report free_flight sliding_stop -o out --quick").code(0).says("2 problems in out/report.html");
    let read = |name: &str| std::fs::read_to_string(folder.path(&format!("out/{name}"))).expect(name);
    let csv = read("sliding_stop.csv");
    assert!(csv.starts_with("method,events,tick,error,cost,failure\nAuto,Auto,"), "{csv}");
    // Each row has numbers or a reason.
    for row in csv.lines().skip(1) {
        let cells: Vec<&str> = row.splitn(6, ',').collect();
        let measured = cells[3].parse::<f64>().is_ok_and(|error| error >= 0.0)
            && cells[4].parse::<f64>().is_ok_and(|cost| cost > 0.0);
        assert!(measured != (cells[5].len() > 2), "{row}");
    }
    let curves = csv
        .lines()
        .skip(1)
        .map(|row| row.split(',').take(2).collect::<Vec<_>>())
        .collect::<std::collections::BTreeSet<_>>();
    let svg = read("sliding_stop.svg");
    assert_eq!(svg.matches("<polyline").count(), curves.len());
    assert_eq!(svg.matches("<circle").count(), csv.lines().skip(1).filter(|row| row.ends_with(',')).count());
    let (markdown, html) = (read("report.md"), read("report.html"));
    for page in [&markdown, &html] {
        assert!(
            page.contains("free_flight") && page.contains("sliding_stop") && page.contains("VelocityVerlet"),
            "{page}"
        );
    }
    // The page needs nothing beside itself.
    assert_eq!(html.matches("<svg").count(), 2);
    assert!(!html.contains("src=") && !html.contains(".svg\""), "{html}");
}

#[test]
fn what_cannot_be_reported_is_refused() {
    let folder = Folder::new("no_report");
    folder.jostle("report keplr -o out").code(2).says("there is no problem `keplr`; did you mean `kepler`?");
    std::fs::write(folder.path("file"), "").unwrap();
    folder.jostle("report kepler -o file/out").code(2).says("cannot be made");
}
