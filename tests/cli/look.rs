//! `--theme` and `--layers`.

use super::harness::{FALL, Folder};

#[test]
fn themes_and_layers_are_chosen_on_the_command_line() {
    let folder = Folder::new("look").with("a.ron", FALL);
    let mut pictures = Vec::new();
    for flags in ["", "--theme night", "--theme print", "--layers trails,velocities", "--layers none"] {
        folder.jostle(&format!("render a.ron -o a.png --at 0.1 --quiet {flags}")).code(0);
        pictures.push(folder.read("a.png"));
    }
    for (index, picture) in pictures.iter().enumerate() {
        assert!(!pictures[..index].contains(picture), "picture {index} is like one before");
    }
}

#[test]
fn wrong_themes_and_layers_are_named_before_anything_runs() {
    let folder = Folder::new("wrong_look").with("a.ron", FALL).with("mine.ron", "(background: \"white\")");
    folder.jostle("render a.ron --theme nite").code(2).says("`nite` is no theme; themes are paper, night, print");
    folder.jostle("render a.ron --theme lost.ron").code(2).says("there is no file `lost.ron`; themes are");
    folder
        .jostle("render a.ron --theme mine.ron")
        .code(2)
        .says("`mine.ron` is no theme: line 1, column 15: ")
        .says("#rrggbb");
    folder.jostle("render a.ron --layers trails,speeds").code(2).says("there is no layer `speeds`").says("velocities");
    assert_eq!(folder.names(), ["a.ron", "mine.ron"]);
}

/// A theme that the scene names lies beside the scene, wherever the program runs.
#[test]
fn a_theme_of_ones_own_lies_beside_the_scene() {
    let paper = include_str!("../../assets/themes/paper.ron");
    let scene = FALL.replace("gravity:", "look: (theme: \"mine.ron\", layers: []), gravity:");
    let folder = Folder::new("own_look").with("scenes/a.ron", &scene);
    folder.jostle("render scenes/a.ron -o a.png --at 0").code(1).says("look.theme: there is no file `scenes/mine.ron`");
    assert!(!folder.has("a.png"));
    let folder = folder.with("scenes/mine.ron", paper.replace("background: \"#FAF9F6\"", "background: \"#0A0B0C\""));
    folder.jostle("render scenes/a.ron -o a.png --at 0 --quiet").code(0);
    let picture = image::open(folder.path("a.png")).unwrap().to_rgb8();
    // A pixel beside the grid: most of the picture has the background.
    let background = picture.pixels().filter(|pixel| pixel.0 == [10, 11, 12]).count();
    assert!(background > 64 * 36 / 4, "{background}");
}
