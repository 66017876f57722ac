//! Silhouettes from PNG pictures: the resulting discs, and the messages for unusable pictures.
//!
//! Tolerance: said where it is used. Not tested here: how well discs cover, which the unit tests of
//! `src/engine/shapes/silhouette` do.

use std::path::{Path, PathBuf};

use image::{GrayImage, Luma, LumaA};
use jostle::Simulation;
use jostle::scene::Source;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("silhouettes").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(folder.join("pictures")).unwrap();
    folder
}

/// A dark square of 120 pixels on white, with margins.
fn square(path: &Path) {
    let inside = |x: u32, y: u32| (40..160).contains(&x) && (20..140).contains(&y);
    GrayImage::from_fn(200, 150, |x, y| Luma([if inside(x, y) { 0 } else { 255 }])).save(path).unwrap();
}

fn scene(folder: &Path, body: &str) -> Source {
    let path = folder.join("main.ron");
    let text = format!(
        "Scene(\n    format: 1,\n    clock: (duration: 0.1, tick: \"1 ms\"),\n    materials: {{ \"felt\": (density: 3) }},\n    bodies: [{body}],\n)"
    );
    std::fs::write(&path, text).unwrap();
    Source::read(&path).unwrap()
}

/// The square is 2 m high, wherever it stands in the picture; mass and inertia are those of the covered area: density
/// times area, and a^2/6 of the mass for a square of side a.
#[test]
fn a_picture_becomes_a_body_of_its_area() {
    let folder = folder("good");
    square(&folder.join("pictures/square.png"));
    let body = "(name: \"s\", at: (5, 1), material: \"felt\", atoms: Png(file: \"pictures/square.png\", height: 2, count: 200))";
    let simulation = Simulation::load(&scene(&folder, body)).unwrap();
    let notes = &simulation.header().remarks;
    let note = notes.iter().find(|note| note.starts_with("pictures/square.png: ")).unwrap();
    let share = note.split("cover ").nth(1).unwrap().split(" %").next().unwrap().parse::<f64>().unwrap() / 100.0;
    let bodies = simulation.bodies();
    // Of the area, exactly what the note says is covered, by its digits and by counting pixels: of an outline of 4 x 256
    // pixels each may be wrong by one half.
    let pixels = 4.0 * 256.0 * 0.5 / (256.0 * 256.0);
    assert!(share > 0.98 && (bodies.mass[0] / 12.0 - share).abs() < 0.0005 + pixels, "{note} {}", bodies.mass[0]);
    // What is not covered are the corners, at most sqrt(2) m from the centre: (1 - share) of the mass with 2 m^2 each.
    let whole = bodies.mass[0] * 4.0 / 6.0;
    assert!((bodies.inertia[0] - whole).abs() < (1.0 - share + pixels) * bodies.mass[0] * 2.0, "{}", bodies.inertia[0]);
    // The centre of mass is where it is put; discs reach the lowest edge, 1 m below, to two pixels.
    let lowest = (0..bodies.atom_count()).map(|atom| bodies.atom_offset(atom).y - bodies.atom_radius[atom]);
    assert!((lowest.fold(0.0, f64::min) + 1.0).abs() < 2.0 * 2.0 / 256.0);
}

#[test]
fn a_template_in_another_folder_finds_its_picture() {
    let folder = folder("included");
    square(&folder.join("pictures/square.png"));
    let part = "Scene(format: 1, templates: { \"s\": (args: [\"n\"], bodies: [(name: \"s\", at: (\"n\", 0), atoms: Png(file: \"square.png\", height: 0.5, count: \"10 * n\"))]) })";
    std::fs::write(folder.join("pictures/part.ron"), part).unwrap();
    let main = "Scene(format: 1, clock: (duration: 0.1, tick: \"1 ms\"), include: [(file: \"pictures/part.ron\")],
        instances: [Repeat(count: 3, make: (of: \"s\", name: \"p_{i}\", with: (n: \"1 + floor(i / 2)\"), set: { \"s.at[1]\": \"i\" }))])";
    std::fs::write(folder.join("main.ron"), main).unwrap();
    let simulation = Simulation::load(&Source::read(&folder.join("main.ron")).unwrap()).unwrap();
    assert_eq!(simulation.bodies().len(), 3);
    assert_eq!(simulation.bodies().atom_count(), 10 + 10 + 20);
    // The same silhouette is worked out, and told, once.
    assert_eq!(simulation.header().remarks.iter().filter(|note| note.starts_with("square.png: ")).count(), 2);
}

#[test]
fn pictures_that_are_none_are_told() {
    let folder = folder("wrong");
    let pictures = folder.join("pictures");
    std::fs::write(pictures.join("film.png"), b"GIF89a and so on").unwrap();
    std::fs::write(pictures.join("half.png"), b"\x89PNG\r\n\x1a\n and no more").unwrap();
    GrayImage::from_pixel(30, 30, Luma([255])).save(pictures.join("white.png")).unwrap();
    image::GrayAlphaImage::from_pixel(30, 30, LumaA([0, 100])).save(pictures.join("faint.png")).unwrap();
    GrayImage::from_pixel(4097, 2, Luma([0])).save(pictures.join("wide.png")).unwrap();
    for (file, message) in [
        ("cow.png", "there is no file `cow.png`"),
        ("pictures", "`pictures` is a folder"),
        ("pictures/film.png", "`pictures/film.png` is not a PNG picture"),
        ("pictures/half.png", "`pictures/half.png` cannot be read: "),
        ("pictures/white.png", "`pictures/white.png` has no silhouette: nothing in it is darker than grey"),
        ("pictures/faint.png", "`pictures/faint.png` has no silhouette: nothing in it is half opaque"),
        ("pictures/wide.png", "`pictures/wide.png` is larger than 4096 x 4096 pixels"),
    ] {
        let body = format!("(name: \"s\", at: (5, 1), atoms: Png(file: \"{file}\", height: 2, count: 200))");
        let errors =
            Simulation::load(&scene(&folder, &body)).err().unwrap_or_else(|| panic!("{file} is taken as good"));
        let [error] = errors.errors() else { panic!("{errors}") };
        assert!(error.message.starts_with(message), "{errors}");
        assert_eq!((error.path.as_str(), error.line), ("bodies[0].atoms.file", Some(5)), "{errors}");
        assert!(error.help.is_some(), "{errors}");
    }
}
