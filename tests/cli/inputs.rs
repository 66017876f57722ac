//! Nothing that is written takes the place of something that was read, nor of a scene.

use super::harness::{FALL, Folder};

const PART: &str = r#"Scene(format: 1, bodies: [(name: "other", at: (2, 1), atoms: Disc(radius: 0.1, mass: 1))])"#;
const COURSE: &str = "time,share\n0,0.5\n10,0.5\n";
const PACKING: &str = "x,y,radius\n3,1,0.1\n4,1,0.1\n";

/// The ball of [`FALL`], and whatever a scene can read, each from a file whose name is one for an output.
fn scene() -> String {
    let forces = "forces: [Drive(of: \"ball\", force: (1, 0), course: Csv(\"course.csv\"))], ";
    let more = "include: [(file: \"part.xml\", prefix: \"p\")], packings: [(name: \"g\", file: \"grains.json\")], \
                look: (theme: \"mine.ron\"), ";
    let picture = "bodies: [(name: \"cow\", at: (9, 1), atoms: Png(file: \"cow.png\", height: 1, count: 9)), ";
    FALL.replace("bodies: [", &format!("{forces}{more}{picture}"))
}

fn folder(name: &str) -> Folder {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let cow = std::fs::read(root.join("assets/silhouettes/cow.png")).unwrap();
    let theme = std::fs::read(root.join("assets/themes/night.ron")).unwrap();
    let folder = Folder::new(name).with("scene.ron", scene()).with("course.csv", COURSE).with("part.xml", PART);
    folder.with("grains.json", PACKING).with("cow.png", &cow).with("mine.ron", theme).with("frames/frame_7.png", &cow)
}

/// All files with what is in them.
fn content(folder: &Folder) -> Vec<(String, Vec<u8>)> {
    let files = folder.names().into_iter().filter(|name| folder.path(name).is_file());
    files.map(|name| (name.clone(), folder.read(&name))).collect()
}

#[test]
fn no_output_takes_the_place_of_an_input() {
    let folder = folder("inputs");
    folder.jostle("run scene.ron --quiet").code(0);
    let before = content(&folder);
    for command in [
        "run scene.ron -o course.csv",
        "run scene.ron -o grains.json",
        "run scene.ron -o part.xml",
        "run scene.ron -o frames/../course.csv",
        "render scene.ron -o cow.png --at 0.1",
        "render scene.ron -o cow.png --strip 0,0.1",
        "render scene.ron -o cow.png --sheet 2x1",
        "plot scene.ron --channels ball.position.y -o cow.png",
        "measure scene.ron --budget 1 -o course.csv",
        "measure scene.ron --budget 1 -o cow.png",
        "test scene.ron --junit part.xml",
        "test scene.ron --junit grains.json",
    ] {
        let ended = folder.jostle(command).code(2);
        assert!(ended.err.contains("another file"), "{ended:?}");
        assert!(content(&folder) == before, "{command}");
    }
    folder.jostle("run scene.ron --quiet -o other.csv").code(0);
}

/// A sweep and a sequence write several files.
#[test]
fn no_file_of_several_takes_the_place_of_an_input() {
    let folder = folder("inputs_of_many");
    let sweep = FALL.replace("bodies: [", "packings: [(name: \"g\", file: \"table.csv\")], bodies: [");
    let frames = scene().replace("\"cow.png\"", "\"frames/frame_7.png\"");
    let folder = folder.with("sweep.ron", sweep).with("table.csv", PACKING).with("frames.ron", frames);
    folder
        .jostle("sweep sweep.ron --vary clock.tick=1ms,2ms -o .")
        .code(2)
        .says("`./table.csv` is an input of this command");
    folder.jostle("render frames.ron -o frames/").code(2).says("`frames/frame_7.png` is an input of this command");
    assert_eq!(folder.read("table.csv"), PACKING.as_bytes());
}

/// Links of both kinds lead to the same file.
#[cfg(unix)]
#[test]
fn links_to_inputs_are_inputs() {
    let folder = folder("inputs_by_links");
    std::os::unix::fs::symlink("course.csv", folder.path("soft.csv")).unwrap();
    std::fs::hard_link(folder.path("course.csv"), folder.path("hard.csv")).unwrap();
    std::os::unix::fs::symlink("scene.ron", folder.path("scene.csv")).unwrap();
    std::os::unix::fs::symlink("mine.ron", folder.path("theme.csv")).unwrap();
    let before = content(&folder);
    for name in ["soft.csv", "hard.csv", "scene.csv", "theme.csv"] {
        folder.jostle(&format!("run scene.ron -o {name}")).code(2);
        assert!(content(&folder) == before, "{name}");
    }
}

/// A scene may have any name, also that of its film.
#[test]
fn a_film_does_not_take_the_place_of_its_scene() {
    let folder = Folder::new("scene_as_film").with("base.gif", FALL).with("one.ron", FALL);
    folder.jostle("render base.gif").code(2).says("error: `base.gif` is a scene: say with -o where its film is to go");
    folder.jostle("render one.ron -o base.gif").code(0);
    let folder = folder.with("base.gif", FALL).with("deep/base.ron", FALL);
    folder.jostle("render deep/base.ron base.gif").code(2).says("`base.gif` is a scene");
    assert_eq!(folder.read("base.gif"), FALL.as_bytes());
}

/// What is no scene does not get the name of one.
#[test]
fn only_scenes_are_written_to_names_of_scenes() {
    let folder = Folder::new("ron_targets").with("one.ron", FALL).with("two.ron", FALL);
    for name in ["two.ron", "three.ron", "THREE.RON"] {
        for command in ["run one.ron -o", "test one.ron --junit", "schema -o", "schema --manual -o"] {
            folder.jostle(&format!("{command} {name}")).code(2).says("has the name of a scene");
        }
    }
    assert_eq!(folder.names(), ["one.ron", "two.ron"]);
    assert_eq!(folder.read("two.ron"), FALL.as_bytes());
    folder.jostle("new scene three").code(0);
    folder.jostle("fmt three.ron").code(0);
}
