//! Plots beside films: the same bytes for any number of threads, the same picture by all ways to a moment.

use image::RgbaImage;
use image::imageops::crop_imm;

use super::harness::Folder;

/// A ball bounces in a picture that has room for a panel: from pixel 281 on.
const SCENE: &str = r#"Scene(
    format: 1,
    clock: (duration: 2, tick: "1 ms"),
    film: (fps: 20, size: (400, 225)),
    camera: Look(center: (0, 1), height: 3),
    gravity: (0, -9.81),
    walls: [(name: "floor", left: (1, 0), right: (0, 0))],
    bodies: [(name: "ball", at: (0, 1), velocity: (0.2, 0), atoms: Disc(radius: 0.1))],
    plots: [(title: "Energy", channels: ["energy.kinetic", "energy.potential", "energy.total"])],
)"#;

const STAGE: u32 = 281;

fn picture(folder: &Folder, name: &str) -> RgbaImage {
    image::load_from_memory(&folder.read(name)).unwrap().to_rgba8()
}

fn panel(picture: &RgbaImage) -> RgbaImage {
    crop_imm(picture, STAGE, 0, picture.width() - STAGE, picture.height()).to_image()
}

#[test]
fn films_with_plots_are_the_same_for_any_number_of_threads() {
    let phases = r#"plots: [(x: "ball.position.y", y: "ball.velocity.y", tail: 0.5),
        (histogram: (channel: "ball.position.y", from: 0, to: 1)), "#;
    let folder = Folder::new("plots_threads").with("fly.ron", SCENE.replace("plots: [", phases));
    for ending in ["gif", "apng", "rgba"] {
        let films = ["1", "2", "4"].map(|threads| {
            folder.jostle(&format!("render fly.ron -o film.{ending} --threads {threads} --quiet")).code(0);
            folder.read(&format!("film.{ending}"))
        });
        assert!(films[0] == films[1] && films[0] == films[2], "{ending}");
    }
}

/// The panel at 1 s is the same in a still, a strip, a sequence, a film that runs backwards, and whatever the camera.
#[test]
fn a_moment_looks_the_same_however_it_is_reached() {
    let backwards = SCENE.replace("fps: 20", "fps: 20, speed: -1");
    let standing = SCENE.replace("fps: 20", "fps: 20, freeze: [(at: 0.5, for: 1)]");
    let folder = Folder::new("plots_moments").with("fly.ron", SCENE);
    let folder = folder.with("back.ron", backwards).with("stand.ron", standing);
    folder.jostle("render fly.ron -o still.png --at 1 --quiet").code(0);
    let still = picture(&folder, "still.png");
    assert_eq!(still.dimensions(), (400, 225));
    folder.jostle("render fly.ron -o strip.png --strip 0,1 --quiet").code(0);
    assert!(panel(&crop_imm(&picture(&folder, "strip.png"), 406, 0, 400, 225).to_image()) == panel(&still));
    for (scene, frame) in [("fly", 20), ("back", 19), ("stand", 40)] {
        folder.jostle(&format!("render {scene}.ron -o {scene}/ --quiet")).code(0);
        assert!(panel(&picture(&folder, &format!("{scene}/frame_{frame:05}.png"))) == panel(&still), "{scene}");
    }
    // Another moment looks different.
    assert!(panel(&picture(&folder, "fly/frame_00021.png")) != panel(&still));
    for camera in ["Fit()", "Follow(of: \"ball\", height: 3)"] {
        let other = SCENE.replace("Look(center: (0, 1), height: 3)", camera);
        let folder = Folder::new("plots_cameras").with("fly.ron", other);
        folder.jostle("render fly.ron -o still.png --at 1 --quiet").code(0);
        assert!(panel(&picture(&folder, "still.png")) == panel(&still), "{camera}");
    }
}

/// Law: at rest only the clock and the ends of the curves move on, and a frame takes at most 2 kB in the size of a usual
/// film. Counted are the packed pixels, without the 20 bytes of each frame's head.
#[test]
fn frames_at_rest_are_small() {
    let scene = SCENE.replace("size: (400, 225)", "size: (1280, 720)").replace("gravity: (0, -9.81),", "");
    let folder = Folder::new("plots_rest").with("rest.ron", scene.replace("velocity: (0.2, 0)", "velocity: (0, 0)"));
    folder.jostle("render rest.ron --quiet").code(0);
    let mut options = gif::DecodeOptions::new();
    options.skip_frame_decoding(true);
    let bytes = folder.read("rest.gif");
    let mut film = options.read_info(bytes.as_slice()).unwrap();
    let mut sizes = Vec::new();
    while let Some(frame) = film.read_next_frame().unwrap() {
        sizes.push(frame.buffer.len());
    }
    assert_eq!(sizes.len(), 40);
    assert!(sizes[1..].iter().all(|size| *size <= 2028), "{sizes:?}");
    assert!(sizes[1..].iter().filter(|size| **size > 60).count() > 20, "nothing moves: {sizes:?}");
}

#[test]
fn small_pictures_say_that_there_is_no_room() {
    let folder = Folder::new("plots_small").with("fly.ron", SCENE);
    let ended = folder.jostle("render fly.ron -o still.png --at 1 --size 160x90").code(0);
    ended.says("note: 160 x 90 pixels are too few to show the plots beside the film");
    folder.jostle("render fly.ron -o tall.png --at 1 --size 240x400 --quiet").code(0);
    assert_eq!(picture(&folder, "tall.png").dimensions(), (240, 400));
}

/// Walls have no position: the name looks right, and only the engine knows.
#[test]
fn channels_that_only_look_right_are_refused() {
    let folder =
        Folder::new("plots_missing").with("fly.ron", SCENE.replace("\"energy.kinetic\"", "\"floor.position.x\""));
    folder.jostle("render fly.ron").code(1).says("there is no channel \"floor.position.x\"").says("plots[0]");
    assert_eq!(folder.names(), ["fly.ron"]);
}

/// A pattern means the same of a scene and of the table that it makes: the figures have as many plots, so the same height.
#[test]
fn patterns_of_quantities_are_those_of_tables() {
    let sensors = SCENE.trim_end().strip_suffix(')').unwrap().to_owned();
    let sensors = sensors + "    sensors: [Pose(of: \"*\"), Velocity(of: \"*\"), Energy()],\n)";
    let folder = Folder::new("plot_patterns").with("fly.ron", sensors);
    folder.jostle("run fly.ron -o fly.csv --quiet").code(0);
    for pattern in ["ball.position.*", "*.position.*", "energy.*"] {
        folder.jostle(&format!("plot fly.ron -o scene.png --quiet --channels {pattern}")).code(0);
        folder.jostle(&format!("plot fly.csv -o table.png --quiet --channels {pattern}")).code(0);
        assert_eq!(picture(&folder, "scene.png").dimensions(), picture(&folder, "table.png").dimensions(), "{pattern}");
    }
    folder.jostle("plot fly.ron --channels ball.nowhere.*").code(2).says("nowhere");
    let table = folder.with("gaps.csv", "time,a\n0,1\n1,nan\n2,inf\n3,\n");
    table.jostle("plot gaps.csv").code(0).says("note: a: 3 of 4 cells are empty, NaN or infinite");
}

#[test]
fn figures_of_scenes_and_tables_are_drawn() {
    let folder = Folder::new("plot_figures").with("fly.ron", SCENE);
    folder.jostle("plot fly.ron").code(0).says("fly.png: one picture, ");
    assert_eq!(picture(&folder, "fly.png").dimensions(), (1200, 720));
    folder.jostle("plot fly.ron -o two.png --channels energy.total,ball.*.z --quiet").code(2);
    folder.jostle("plot fly.ron -o two.png --channels energy.total,b*.position.x --quiet").code(0);
    assert_eq!(picture(&folder, "two.png").dimensions(), (1200, 960));
    folder.jostle("plot fly.ron -o phase.png --x ball.position.y --channels ball.velocity.y --size 600x400").code(0);
    assert_eq!(picture(&folder, "phase.png").dimensions(), (600, 400));
    folder.jostle("plot fly.ron -o log.png --channels ball.velocity.y --log").code(0).says("which --log cannot show");
    // What `run` writes can be plotted.
    let folder =
        folder.with("measured.ron", SCENE.replace("plots:", "sensors: [Pose(of: \"ball\"), Energy()], plots:"));
    folder.jostle("run measured.ron -o table.csv --quiet").code(0);
    folder.jostle("plot table.csv").code(0).says("table.png: one picture, ");
    // Metres, radians, joules: three plots.
    assert_eq!(picture(&folder, "table.png").dimensions(), (1200, 1440));
    folder.jostle("plot table.csv -o one.png --channels ball.position.y --title Height --theme night").code(0);
    assert_ne!(folder.read("one.png"), folder.read("table.png"));
}

/// Promise: a figure in which labels would overlap is refused with the least size, and that size is drawn. At the upper edge of each plot
/// rows are blank, so nothing of one plot lies in another.
#[test]
fn a_figure_too_small_for_its_labels_is_refused() {
    let folder = Folder::new("plot_small").with("fly.ron", SCENE);
    let three = "plot fly.ron --channels energy.total,ball.position.y,ball.velocity.y";
    let ended = folder.jostle(&format!("{three} --size 300x150")).code(2);
    ended.says("300x150 is too small for 3 plots").says("the least size is 160x285, or choose fewer channels");
    folder.jostle("plot fly.ron --channels energy.total --size 150x400").code(2).says("the least size is 160x95\n");
    assert!(!folder.has("fly.png"));
    for size in ["160x285", "2000x285"] {
        folder.jostle(&format!("{three} --size {size} -o least.png --quiet")).code(0);
        let picture = picture(&folder, "least.png");
        let (width, height) = picture.dimensions();
        let background = *picture.get_pixel(0, 0);
        let is_blank = |row: u32| (0..width).all(|x| *picture.get_pixel(x, row) == background);
        for plot in 0..3 {
            let edge = plot * height / 3;
            let between = (edge.saturating_sub(4)..edge + 4).filter(|row| is_blank(*row)).count();
            assert!(between >= 4, "{size}: plot {plot}: {between} blank rows at its upper edge");
        }
    }
}

#[test]
fn what_cannot_be_plotted_is_told() {
    let bare = SCENE.replace(
        "plots: [(title: \"Energy\", channels: [\"energy.kinetic\", \"energy.potential\", \"energy.total\"])],",
        "",
    );
    let folder = Folder::new("plot_wrong").with("fly.ron", SCENE).with("bare.ron", bare);
    let folder = folder.with("t.csv", "time [s],height [m]\n0,1\n1,2,3\n").with("n.csv", "1,2\n3,4\n");
    let folder = folder.with("good.csv", "time [s],height [m]\n0,1\n1,2\n").with("x.csv", "time,height\n0,high\n");
    for (arguments, messages) in [
        ("bare.ron", &["the scene has no `plots`", "--channels energy.kinetic"][..]),
        (
            "fly.ron --channels energy.kinetc",
            &["there is no channel `energy.kinetc`", "did you mean `energy.kinetic`?"],
        ),
        ("fly.ron --channels bal.position.x", &["there is no wall or body named \"bal\"", "did you mean \"ball\"?"]),
        ("fly.ron --channels energy.total --x ball.positon.x", &["--x", "did you mean `position.x`?"]),
        ("fly.ron --x ball.position.x", &["name the channels to plot with --channels"]),
        ("fly.ron --channels floor.position.x", &["there is no channel \"floor.position.x\""]),
        ("fly.ron -o film.gif", &["`plot` draws a .png, not `film.gif`"]),
        ("fly.ron -o folder/", &["`folder/` is a directory"]),
        ("t.csv", &["`t.csv`, line 3: expected 2 cells, as there are names, found 3"]),
        ("n.csv", &["`n.csv`, line 1: expected the names of the columns, found the number `1`"]),
        ("x.csv", &["`x.csv`, line 2: `high` in the column `height` is not a number"]),
        ("good.csv --channels heigth", &["`good.csv` has no column `heigth`: did you mean `height`?"]),
        ("none.csv", &["there is no file `none.csv`"]),
        ("fly.ron --theme blak", &["blak", "paper", "night"]),
    ] {
        let ended = folder.jostle(&format!("plot {arguments}")).code(2);
        messages.iter().fold(ended, |ended, message| ended.says(message));
    }
    assert_eq!(folder.names(), ["bare.ron", "fly.ron", "good.csv", "n.csv", "t.csv", "x.csv"]);
}

/// Two balls that are thrown from two places.
const TWO: &str = r#"Scene(format: 1, clock: (duration: 1, tick: "10 ms"), gravity: (0, -10), sensors: [Pose(of: "*")], bodies: [
    (name: "a", at: (0, 0), velocity: (1, 4), atoms: Disc(radius: 0.1)),
    (name: "b", at: (3, 0), velocity: (2, 6), atoms: Disc(radius: 0.1)),
    (name: "peg", at: (9, 0), fixed: true, atoms: Disc(radius: 0.1)),
])"#;

/// Two bodies are never drawn over the places of one without a word; `*` gives each its own, as a plot of it alone shows.
#[test]
fn each_channel_is_drawn_over_that_of_its_own_body() {
    let folder = Folder::new("plot_pairs").with("two.ron", TWO);
    folder.jostle("run two.ron -o two.csv --quiet").code(0);
    for source in ["two.ron", "two.csv"] {
        let refused = format!("plot {source} --x a.position.x --channels a.position.y,b.position.y");
        let ended = folder.jostle(&refused).code(2);
        ended.says("`b.position.y` would be drawn over `a.position.x`").says("write `*.position.x`");
        folder
            .jostle(&format!("plot {source} -o both.png --x *.position.x --channels a.position.y,b.position.y"))
            .code(0);
        folder.jostle(&format!("plot {source} -o own.png --x b.position.x --channels b.position.y")).code(0);
        folder.jostle(&format!("plot {source} -o star.png --x *.position.x --channels b.position.y")).code(0);
        assert_eq!(folder.read("own.png"), folder.read("star.png"));
        // Another pair of axes that was meant so.
        folder.jostle(&format!("plot {source} -o other.png --x a.position.x --channels b.position.y")).code(0);
        assert_ne!(folder.read("own.png"), folder.read("other.png"));
    }
    folder
        .jostle("plot two.ron --x p*.position.x --channels a.position.y")
        .code(2)
        .says("does not fit the owner of `a.position.y`");
    folder.jostle("plot two.ron --x *.positon.x --channels a.position.y").code(2).says("did you mean `position.x`?");
}
