//! Strips and contact sheets: several frames in one picture, each exactly the one `--at` draws.

use super::harness::{FALL, Folder};

/// Pixels between two frames.
const GAP: u32 = 6;

const SCENE: &str = r#"Scene(
    format: 1,
    clock: (duration: 2, tick: "1 ms"),
    film: (fps: 10, size: (64, 36), from: 0.5),
    camera: Look(center: (0, 0), height: 4),
    bodies: [(name: "ball", at: (-2, 0), velocity: (2, 0), atoms: Disc(radius: 0.3))],
)"#;

fn picture(folder: &Folder, name: &str) -> image::RgbaImage {
    image::load_from_memory(&folder.read(name)).unwrap().to_rgba8()
}

#[test]
fn a_strip_shows_its_moments_side_by_side() {
    let folder = Folder::new("strip").with("fly.ron", SCENE);
    let ended = folder.jostle("render fly.ron -o strip.png --strip 0,500ms,1.25");
    ended.code(0).says("strip.png: 3 frames in one picture, ");
    let strip = picture(&folder, "strip.png");
    assert_eq!(strip.dimensions(), (3 * 64 + 2 * GAP, 36));
    for (index, time) in [0.0, 0.5, 1.25].into_iter().enumerate() {
        folder.jostle(&format!("render fly.ron -o still.png --at {time} --quiet")).code(0);
        let part = image::imageops::crop_imm(&strip, index as u32 * (64 + GAP), 0, 64, 36).to_image();
        assert!(part == picture(&folder, "still.png"), "{time}");
    }
    assert_eq!(folder.names(), ["fly.ron", "still.png", "strip.png"]);
}

/// From the film's first moment to its last: 0.5, 0.8, 1.1, 1.4, 1.7, 2.
#[test]
fn a_sheet_spreads_its_moments_over_the_film() {
    let folder = Folder::new("sheet").with("fly.ron", SCENE);
    folder.jostle("render fly.ron -o sheet.png --sheet 3x2").code(0).says("sheet.png: 6 frames in one picture, ");
    let sheet = picture(&folder, "sheet.png");
    assert_eq!(sheet.dimensions(), (3 * 64 + 2 * GAP, 2 * 36 + GAP));
    for (index, time) in [0.5, 0.8, 1.1, 1.4, 1.7, 2.0].into_iter().enumerate() {
        folder.jostle(&format!("render fly.ron -o still.png --at {time} --quiet")).code(0);
        let (column, row) = (index as u32 % 3, index as u32 / 3);
        let part = image::imageops::crop_imm(&sheet, column * (64 + GAP), row * (36 + GAP), 64, 36).to_image();
        // The bodies are where they are in the still; the clock may count in finer digits.
        let body = |image: &image::RgbaImage| image::imageops::crop_imm(image, 0, 14, 64, 8).to_image();
        assert!(body(&part) == body(&picture(&folder, "still.png")), "{time}");
    }
}

#[test]
fn large_sheets_are_fitted_to_a_screen_unless_a_size_is_given() {
    let folder = Folder::new("sheet_size").with("fly.ron", SCENE.replace("(64, 36)", "(1280, 720)"));
    folder.jostle("render fly.ron -o sheet.png --sheet 4x1 --quiet").code(0);
    assert_eq!(picture(&folder, "sheet.png").dimensions(), (4 * 480 + 3 * GAP, 270));
    folder.jostle("render fly.ron -o sheet.png --sheet 4x1 --size 100x50 --quiet").code(0);
    assert_eq!(picture(&folder, "sheet.png").dimensions(), (4 * 100 + 3 * GAP, 50));
    let ended = folder.jostle("render fly.ron -o huge.png --sheet 20x20 --size 8192x8192").code(2);
    assert!(ended.err.contains("20 x 20 frames would be a picture of 163954 x 163954 pixels"), "{ended:?}");
    assert_eq!(folder.names(), ["fly.ron", "sheet.png"]);
}

#[test]
fn wrong_moments_and_targets_are_refused() {
    let folder = Folder::new("strip_wrong").with("fall.ron", FALL);
    for (arguments, message) in [
        ("--strip 0,1", "--strip 1 s is after the end: the run lasts 0.2 s"),
        ("--strip 0.1,0", "expected times from early to late, but 0 comes after 0.1"),
        ("--strip 0,,1", "expected times separated by commas, such as 0,0.5,1 or 0,20ms"),
        ("--strip -1,0", "expected times separated by commas"),
        ("--sheet 4", "expected columns and rows such as 4x3"),
        ("--sheet 100x100", "at most 400 frames in all"),
        ("--strip 0,0.1 -o film.gif", "--strip makes one picture: write it to a .png instead of `film.gif`"),
        ("--sheet 2x2 -o film.mp4", "--sheet makes one picture: write it to a .png instead of `film.mp4`"),
        ("--sheet 2x2 --at 0.1", "cannot be used with"),
        ("--sheet 2x2 --pace", "cannot be used with"),
    ] {
        folder.jostle(&format!("render fall.ron {arguments}")).code(2).says(message);
    }
    assert_eq!(folder.names(), ["fall.ron"]);
    folder.jostle("render fall.ron --sheet 2x1 --quiet").code(0);
    assert_eq!(folder.names(), ["fall.png", "fall.ron"]);
}
