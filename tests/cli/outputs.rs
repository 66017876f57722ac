//! Targets of films and tables: formats by their endings, no accidental overwriting, no incomplete files.

use super::harness::{EXPLOSION, FALL, Folder};

#[test]
fn without_o_the_film_goes_to_the_current_folder() {
    let folder = Folder::new("default").with("deep/fall.ron", FALL);
    let ended = folder.jostle("render deep/fall.ron").code(0).says("fall.gif: 2 frames, 0.20 s, ");
    assert_eq!(ended.out, "");
    folder.jostle("render deep/fall.ron --at 0.1").code(0).says("fall.png: one picture, ");
    folder.jostle("render deep/fall.ron --png").code(0).says("fall/: 2 frames");
    assert_eq!(folder.names(), ["deep", "fall", "fall.gif", "fall.png"]);
}

#[test]
fn the_ending_tells_the_format() {
    let folder = Folder::new("formats").with("fall.ron", FALL);
    folder.jostle("render fall.ron -o a.gif --quiet").code(0);
    folder.jostle("render fall.ron -o b.PNG --at 0.1 --quiet").code(0);
    folder.jostle("render fall.ron -o c/ --quiet").code(0);
    folder.jostle("render fall.ron -o d/ --at 0.1 --quiet").code(0);
    assert!(folder.read("a.gif").starts_with(b"GIF89a"));
    for picture in ["b.PNG", "c/frame_00000.png", "c/frame_00001.png", "d/fall.png"] {
        assert!(folder.read(picture).starts_with(b"\x89PNG\r\n"), "{picture}");
    }
    assert!(!folder.has("c/frame_00002.png"));
    let message = "error: the ending of `e.avi` names no format. .gif, .apng, .mp4 and .webm are films. .png is one \
                   picture, with --at, --strip or --sheet. A / at the end means a directory of pictures. .rgba or the name - \
                   (standard output) means raw pictures\n";
    assert_eq!(folder.jostle("render fall.ron -o e.avi").code(2).err, message);
    folder
        .jostle("render fall.ron -o e.png")
        .code(2)
        .says("a .png holds one picture: add --at T, --strip T,T,T or --sheet 4x3");
    folder.jostle("render fall.ron -o e.gif --at 0.1").code(2).says("--at makes one picture: write it to a .png");
    folder.jostle("render fall.ron -o e.gif --png").code(2).says("--png makes pictures: they need a directory");
    assert_eq!(folder.names(), ["a.gif", "b.PNG", "c", "d", "fall.ron"]);
}

#[test]
fn several_scenes_go_into_a_directory() {
    let folder = Folder::new("several").with("one.ron", FALL).with("two.ron", FALL);
    folder.jostle("render one.ron two.ron -o films/ --quiet").code(0);
    folder.jostle("render one.ron two.ron -o pictures/ --png --quiet").code(0);
    folder.jostle("render one.ron two.ron -o stills/ --at 0.1 --quiet").code(0);
    for file in ["films/one.gif", "films/two.gif", "pictures/two/frame_00001.png", "stills/one.png", "stills/two.png"] {
        assert!(folder.has(file), "{file}");
    }
    assert_eq!(folder.read("films/one.gif"), folder.read("films/two.gif"));
    let ended = folder.jostle("render one.ron two.ron -o films.gif").code(2);
    assert_eq!(ended.err, "error: 2 scenes need a directory: `-o films/`\n");
}

#[test]
fn two_scenes_of_one_name_do_not_overwrite_each_other() {
    let folder = Folder::new("twins").with("a/fall.ron", FALL).with("b/fall.ron", FALL);
    for output in ["-o films/", ""] {
        let message = "error: `a/fall.ron` and `b/fall.ron` would both go to `";
        folder.jostle(&format!("render a/fall.ron b/fall.ron {output}")).code(2).says(message);
    }
    folder.jostle("render a/fall.ron a/fall.ron -o films/").code(2).says("error: `a/fall.ron` is named twice\n");
    assert_eq!(folder.names(), ["a", "b"]);
}

#[test]
fn one_wrong_scene_does_not_stop_the_others() {
    let folder = Folder::new("others").with("one.ron", FALL).with("two.ron", FALL).with("boom.ron", EXPLOSION);
    folder.jostle("render one.ron none.ron two.ron -o films/ --quiet").code(2).says("there is no file `none.ron`");
    assert!(folder.has("films/one.gif") && folder.has("films/two.gif"));
    // The gravest decides.
    folder.jostle("render none.ron boom.ron one.ron -o films/ --quiet").code(3);
    folder.jostle("check one.ron none.ron").code(2);
}

#[test]
fn what_cannot_be_written_is_usage_with_a_remedy() {
    let folder = Folder::new("unwritable").with("fall.ron", FALL).with("file", "").with("table.csv/x", "");
    for (arguments, message) in [
        ("render fall.ron -o none/film.gif", "`none/film.gif` could not be written"),
        ("render fall.ron -o none/film.gif", "create its directory first"),
        ("render fall.ron -o file/film.gif", "a part of its path is a file"),
        ("render fall.ron -o file/", "file"),
        ("run fall.ron -o none/table.csv", "create its directory first"),
        ("run fall.ron -o table.csv", "error: `table.csv` is a directory: name a file in it"),
        ("run fall.ron -o none/", "error: `none/` is a directory: name a file in it, such as `none/channels.csv`"),
        ("run fall.ron -o fall.ron", "error: `fall.ron` is the scene itself"),
        ("run fall.ron -o ./fall.ron", "error: `./fall.ron` is the scene itself"),
        ("run fall.ron -o fall.gif", "use `jostle render` for pictures"),
        ("run fall.ron -o fall.mp4", "use `jostle render` for pictures"),
        ("render fall.ron -o none/film.apng", "create its directory first"),
        ("render fall.ron -o none/film.rgba", "create its directory first"),
        ("render fall.ron -o none/strip.png --strip 0,0.1", "create its directory first"),
    ] {
        let ended = folder.jostle(arguments).code(2).says(message);
        assert_eq!(ended.out, "");
    }
    assert_eq!(folder.read("fall.ron"), FALL.as_bytes());
    assert_eq!(folder.names(), ["fall.ron", "file", "table.csv"]);
}

/// A finished file takes the place of what has its name: a directory must not be in the way, a device not be lost.
#[cfg(unix)]
#[test]
fn devices_and_directories_are_no_targets() {
    let folder = Folder::new("devices").with("fall.ron", FALL).with("fall.gif/keep", "");
    folder.jostle("run fall.ron -o /dev/null").code(2).says("error: `/dev/null` is a device or a pipe: name a file\n");
    folder.jostle("render fall.ron").code(2).says("error: `fall.gif` is a directory; say with -o where");
}

#[test]
fn pictures_of_an_earlier_sequence_are_mentioned() {
    let folder = Folder::new("left_over").with("fall.ron", FALL);
    folder.jostle("render fall.ron -o frames/ --quiet").code(0);
    folder.jostle("render fall.ron -o frames/ --duration 0.1").code(0).says("note: 1 picture of an earlier");
}

#[test]
fn scenes_that_come_with_the_program_need_no_files() {
    let folder = Folder::new("embedded");
    folder.jostle("render example:tetris --duration 0.1 --size 64x36 --quiet").code(0);
    assert_eq!(folder.names(), ["tetris.gif"]);
}

#[test]
fn the_film_does_not_depend_on_threads() {
    let folder = Folder::new("threads");
    for threads in [1, 2, 7] {
        let arguments = "render example:tetris --duration 1 --size 96x54 --quiet";
        folder.jostle(&format!("{arguments} --threads {threads} -o {threads}.gif")).code(0);
    }
    let film = folder.read("1.gif");
    assert!(film == folder.read("2.gif") && film == folder.read("7.gif"));
}

/// A still is a look at a moment: what the scene expects of later ones is not yet broken.
#[test]
fn a_still_breaks_no_expectation_of_later_times() {
    let folder = Folder::new("early");
    folder.jostle("render example:kepler --at 1 --size 64x36 --quiet").code(0);
    folder.jostle("run example:kepler --duration 1").code(1).says("the run ended too early to judge it");
}
