//! Outlines from SVG files: the resulting shapes, and the messages for unusable files.
//!
//! Tolerance: said where it is used. Not tested here: paths, transforms and chords, which the unit tests of `src/engine/shapes/svg` do.

use std::path::{Path, PathBuf};

use jostle::Simulation;
use jostle::scene::Source;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("drawings").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn drawing(folder: &Path, body: &str) {
    let text =
        format!("<?xml version=\"1.0\"?><svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\">{body}</svg>");
    std::fs::write(folder.join("part.svg"), text).unwrap();
}

fn scene(folder: &Path, shape: &str) -> Source {
    let path = folder.join("main.ron");
    let body = format!("(name: \"part\", at: (5, 1), angle: 0.2, material: \"tin\", shape: {shape})");
    let text = format!(
        "Scene(\n    format: 1,\n    clock: (duration: 0.1, tick: \"1 ms\"),\n    materials: {{ \"tin\": (density: 3) }},\n    bodies: [{body}],\n)"
    );
    std::fs::write(&path, text).unwrap();
    Source::read(&path).unwrap()
}

/// Mass, inertia, and corners from the centre of mass in order.
fn measured(source: &Source) -> (f64, f64, Vec<(f64, f64)>) {
    let simulation = Simulation::load(source).unwrap_or_else(|errors| panic!("{errors}"));
    let bodies = simulation.bodies();
    let mut corners: Vec<(f64, f64)> =
        (0..bodies.atom_count()).map(|atom| bodies.atom_offset(atom)).map(|at| (at.x, at.y)).collect();
    corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
    (bodies.mass[0], bodies.inertia[0], corners)
}

/// Law: a drawn L is the polygon through its corners: mass, centre, moment of inertia and parts. Drawn with units of 0.1 m, to its height, as a
/// part of a drawing, or in a compound. Tolerance: 1e-12, some roundings of numbers near 1.
#[test]
fn a_drawn_l_is_a_polygon() {
    let folder = folder("l");
    drawing(&folder, "<g id=\"l\"><path d=\"M1 2 v6 h4 v-2 h-2 v-4 z\"/></g><circle cx=\"9\" cy=\"20\" r=\"1\"/>");
    let exact = measured(&scene(
        &folder,
        "Polygon(points: [(0, 0), (0.4, 0), (0.4, 0.2), (0.2, 0.2), (0.2, 0.6), (0, 0.6)], rounding: 0.01)",
    ));
    assert!((exact.0 - 3.0 * (0.16 - 5.0 * 1e-4 * (1.0 - std::f64::consts::FRAC_PI_4))).abs() < 1e-12);
    for size in ["unit: 0.1", "height: 0.6"] {
        for (open, close) in [("", ""), ("Compound([", "])")] {
            let shape = format!("{open}Svg(file: \"part.svg\", id: \"l\", {size}, rounding: 0.01){close}");
            let found = measured(&scene(&folder, &shape));
            assert!((found.0 - exact.0).abs() < 1e-12 && (found.1 - exact.1).abs() < 1e-12, "{shape}: {found:?}");
            assert_eq!(found.2.len(), exact.2.len());
            let near = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() < 1e-12 && (a.1 - b.1).abs() < 1e-12;
            assert!(found.2.iter().zip(&exact.2).all(near), "{shape}: {found:?}, not {exact:?}");
        }
    }
}

/// The card says of a drawing how many outlines, points and parts it has, how near they are, what is lost and what is left out.
#[test]
fn what_a_drawing_became_is_noted() {
    let folder = folder("note");
    drawing(&folder, "<path d=\"M0 0 A1 1 0 0 1 2 0 L4 0 L4 4 H0 Z\"/><text>part</text>");
    let simulation =
        Simulation::load(&scene(&folder, "Svg(file: \"part.svg\", unit: 0.1, tolerance: \"1 mm\")")).unwrap();
    let note = simulation.header().remarks.iter().find(|note| note.starts_with("part.svg: ")).expect("a note");
    // Half a round with a radius of 0.1 m needs 12 chords: its area is less by the share 1.1 % of a tenth of it.
    for words in
        ["1 outline of", "convex part", "within 0.001 m of the curves", "% of the area is lost", "Not read: text"]
    {
        assert!(note.contains(words), "{note}");
    }
}

/// What is wrong with a drawing is told with the field that names it, what was found, and what to do.
#[test]
fn a_drawing_that_is_no_shape_is_refused() {
    let folder = folder("bad");
    let refused = |body: &str, shape: &str| {
        drawing(&folder, body);
        Simulation::load(&scene(&folder, shape)).err().map(|error| error.to_string()).unwrap_or_default()
    };
    let square = "<rect width=\"4\" height=\"4\"/>";
    for (body, fields, words) in [
        (square, "file: \"path.svg\", height: 1", "there is no file `path.svg`"),
        (square, "file: \"part.svg\"", "the field `height` or `unit` is missing"),
        (square, "file: \"part.svg\", height: 1, unit: 1", "exclude each other"),
        (square, "file: \"part.svg\", height: -1", "must be above zero"),
        (square, "file: \"part.svg\", height: 1, scale: 2", "scale"),
        (square, "file: \"part.svg\", height: 1, outlines: []", "outlines"),
        (square, "height: 1", "file"),
        (square, "file: \"part.svg\", height: 1, id: \"rim\"", "no element with the id `rim`"),
        ("<text>part</text>", "file: \"part.svg\", height: 1", "`part.svg`: has no outline, only text"),
        ("<path d=\"M0 0 L4 4 L4 0 L0 4 Z\"/>", "file: \"part.svg\", height: 1", "sides 0 and 2 meet"),
        ("<circle r=\"2\"/><circle r=\"1\"/>", "file: \"part.svg\", height: 1", "shapes have no holes"),
        ("<circle r=\"2\"/>", "file: \"part.svg\", height: 1, tolerance: \"1 nm\"", "points are needed"),
    ] {
        let message = refused(body, &format!("Svg({fields})"));
        assert!(message.contains(words) && message.contains("main.ron:5"), "{fields}: {message}");
    }
}
