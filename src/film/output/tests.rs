use std::fs::{self, File};
use std::sync::Arc;

use ::gif::{ColorOutput, DecodeOptions};
use glam::DVec2;
use tiny_skia::Pixmap;

use super::*;
use crate::raster::{Camera, Painter, Scratch, Theme, WorldRectangle};
use jostle_frames::frame::{BodyLook, BodyPose, Cast, Disc, WallLook};
use jostle_frames::mark::{Mark, MarkShape};

const SIZE: (u32, u32) = (160, 120);

/// A directory for each test, removed at its end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("jostle-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).expect("a temporary directory");
        Folder(path)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("the directory");
        let mut names: Vec<_> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn view() -> View {
    let camera = Camera::fit(WorldRectangle { low: DVec2::ZERO, high: DVec2::new(4.0, 3.0) }, 0.06, SIZE);
    View { camera, theme: Theme::named("night").expect("shipped"), frame_step: 0.04, panel: None }
}

/// A block of four discs and a ball that cross a room with a peg and a floor.
fn frames(count: usize) -> Vec<Frame> {
    let disc = |x, y, radius| Disc { offset: DVec2::new(x, y), radius };
    let block = vec![disc(0.0, 0.0, 0.25), disc(0.5, 0.0, 0.25), disc(0.0, 0.5, 0.25), disc(0.5, 0.5, 0.25)];
    let body =
        |name: &str, discs, fixed| BodyLook { name: name.to_owned(), discs, hulls: Vec::new(), color: None, fixed };
    let bodies = vec![
        body("peg", vec![disc(0.0, 0.0, 0.4)], true),
        body("block", block, false),
        body("ball", vec![disc(0.0, 0.0, 0.3)], false),
    ];
    let floor = WallLook {
        name: "floor".to_owned(),
        left: DVec2::new(4.0, 0.0),
        right: DVec2::ZERO,
        thickness: None,
        points: Vec::new(),
        color: None,
    };
    let cast = Arc::new(Cast { title: "Test".to_owned(), bodies, walls: vec![floor] });
    let frame = |index: usize| {
        let time = 0.04 * index as f64;
        let pose = |x, y, angle| BodyPose { position: DVec2::new(x, y), angle };
        let poses = vec![pose(2.0, 0.5, 0.0), pose(0.5 + time, 1.5, 2.0 * time), pose(3.5 - time, 2.0, -time)];
        Frame { time, cast: cast.clone(), poses, marks: vec![Mark::plain(MarkShape::Time)], center: None }
    };
    (0..count).map(frame).collect()
}

fn drawn(frame: &Frame) -> Pixmap {
    let painter = Painter::new(&view(), frame).expect("a small picture");
    let mut picture = painter.backdrop().clone();
    painter.paint(frame, &mut picture, &mut Scratch::default());
    picture
}

fn begin(path: &Path, threads: usize) -> Result<Box<dyn Film>, OutputError> {
    open(
        &OutputTarget::new(path)?,
        &FilmSettings { frames_per_second: 30.0, threads, ..FilmSettings::default() },
        view(),
    )
}

fn film(path: &Path, threads: usize, frames: &[Frame]) -> Result<WrittenFilm, OutputError> {
    let mut film = begin(path, threads)?;
    for frame in frames {
        film.push(frame.clone())?;
    }
    film.finish()
}

/// The whole pictures of a GIF, as a viewer composes them, with their delays.
fn watch(path: &Path) -> Vec<(Vec<[u8; 4]>, u16)> {
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::RGBA);
    let mut decoder = options.read_info(File::open(path).expect("the film")).expect("a GIF");
    let mut screen = vec![[0; 4]; (SIZE.0 * SIZE.1) as usize];
    let mut shown = Vec::new();
    while let Some(frame) = decoder.read_next_frame().expect("a good frame") {
        let width = usize::from(frame.width);
        for (row, pixels) in frame.buffer.as_chunks::<4>().0.chunks_exact(width).enumerate() {
            let start = (usize::from(frame.top) + row) * SIZE.0 as usize + usize::from(frame.left);
            for (below, above) in screen[start..start + width].iter_mut().zip(pixels) {
                if above[3] > 0 {
                    *below = *above;
                }
            }
        }
        shown.push((screen.clone(), frame.delay));
    }
    shown
}

#[test]
fn a_gif_shows_the_frames_that_were_drawn() {
    let folder = Folder::new("gif-shows");
    let (path, frames) = (folder.path("film.gif"), frames(60));
    let written = film(&path, 2, &frames).expect("a film");
    let shown = watch(&path);
    assert_eq!((written.frames, shown.len()), (60, 60));
    assert_eq!(written.seconds, 2.0);
    assert_eq!(shown.iter().map(|(_, delay)| u32::from(*delay)).sum::<u32>(), 200);
    assert_eq!(written.bytes, fs::metadata(&path).expect("the film").len());
    assert_eq!(folder.names(), ["film.gif"]);

    let flat = Painter::new(&view(), &frames[0]).expect("a small picture").flat_colors();
    for (frame, (screen, _)) in frames.iter().zip(&shown) {
        let truth = drawn(frame);
        let mut squares = 0.0;
        for (wanted, seen) in truth.pixels().iter().zip(screen) {
            let wanted = [wanted.red(), wanted.green(), wanted.blue()];
            if flat.iter().any(|flat| [flat.0, flat.1, flat.2] == wanted) {
                assert_eq!(wanted, seen[..3], "flat colours are exact");
            }
            squares += wanted.iter().zip(seen).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>();
        }
        // Only blends at edges are off. One level of mean error is 48 dB. That is far better than 255 fixed colours,
        // which would reach about 36 dB.
        assert!((squares / (3.0 * screen.len() as f64)).sqrt() < 1.0, "at {} s", frame.time);
    }
}

/// Frames that change, stand still and change again; a single frame; whole groups and parts of them. The `image` crate
/// decodes them, and composes the frames independently.
#[test]
fn an_apng_shows_exactly_the_frames_that_were_drawn() {
    use image::AnimationDecoder;
    let folder = Folder::new("apng-shows");
    let path = folder.path("film.apng");
    for (count, threads) in [(1, 1), (4, 2), (11, 3)] {
        let mut frames = frames(count);
        for index in 5..8.min(count) {
            frames[index] = frames[4].clone();
        }
        let written = film(&path, threads, &frames).expect("a film");
        assert_eq!((written.frames, written.seconds), (count as u64, count as f64 / 30.0));
        assert_eq!(written.bytes, fs::metadata(&path).expect("the film").len());
        let file = std::io::BufReader::new(File::open(&path).expect("the film"));
        let decoder = image::codecs::png::PngDecoder::new(file).and_then(|decoder| decoder.apng()).expect("an APNG");
        let shown = decoder.into_frames().collect_frames().expect("good frames");
        assert_eq!(shown.len(), count);
        for (frame, shown) in frames.iter().zip(&shown) {
            assert!(shown.buffer().as_raw() == drawn(frame).data(), "at {} s", frame.time);
            // In milliseconds: a thirtieth of a second, in lowest terms.
            assert_eq!(shown.delay().numer_denom_ms(), (100, 3));
        }
    }
    assert_eq!(folder.names(), ["film.apng"]);
}

/// A film that exceeds its limit of bytes is abandoned, and no file of it remains. A film of few colours is smaller.
#[test]
fn a_gif_keeps_to_its_limits() {
    let folder = Folder::new("limits");
    let path = folder.path("film.gif");
    let make = |settings: FilmSettings| {
        let mut film = open(&OutputTarget::new(&path).expect("a GIF"), &settings, view())?;
        frames(60).into_iter().try_for_each(|frame| film.push(frame))?;
        film.finish()
    };
    let whole = make(FilmSettings::default()).expect("a film").bytes;
    let few = make(FilmSettings { colors: 15, ..FilmSettings::default() }).expect("a film").bytes;
    assert!(few < whole, "{few} bytes, {whole} with all colours");
    let kept = make(FilmSettings { most_bytes: Some(whole), ..FilmSettings::default() }).expect("it fits").bytes;
    assert_eq!(kept, whole);
    let given_up = make(FilmSettings { most_bytes: Some(whole / 2), ..FilmSettings::default() });
    let Err(OutputError::TooLarge { bytes, frames, .. }) = given_up else { panic!("{given_up:?}") };
    assert!(bytes > whole / 2 && frames < 60, "{bytes} bytes after {frames} frames");
    assert_eq!((folder.names(), fs::metadata(&path).expect("the film before").len()), (vec!["film.gif".into()], whole));
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let folder = Folder::new("threads");
    let frames = frames(60);
    let bytes = |threads| {
        let path = folder.path(&format!("film{threads}.gif"));
        film(&path, threads, &frames).expect("a film");
        fs::read(path).expect("the film")
    };
    let one = bytes(1);
    assert!(bytes(0) == one && bytes(2) == one && bytes(3) == one);
}

#[test]
fn a_film_may_end_early() {
    let folder = Folder::new("early");
    for count in [1, 3, 47, 50] {
        let path = folder.path("film.gif");
        let written = film(&path, 2, &frames(count)).expect("a shorter film");
        assert_eq!((written.frames, watch(&path).len()), (count as u64, count));
    }
    for name in ["nothing.gif", "nothing.apng", "nothing.rgba"] {
        let nothing = film(&folder.path(name), 1, &[]);
        assert!(matches!(nothing, Err(OutputError::NoFrames { .. })), "{name}");
    }
    assert_eq!(folder.names(), ["film.gif"], "nothing is left of a film without frames");
}

#[test]
fn a_dropped_film_leaves_what_it_has() {
    let folder = Folder::new("dropped");
    let mut film = begin(&folder.path("film.gif"), 1).expect("a film");
    frames(52).into_iter().for_each(|frame| film.push(frame).expect("room on the disk"));
    drop(film);
    let [part] = &folder.names()[..] else { panic!("{:?}", folder.names()) };
    assert!(part.starts_with("film.gif.") && part.ends_with(".part"), "{part}");
    assert_eq!(watch(&folder.path(part)).len(), 52);
}

#[test]
fn frames_without_change_are_tiny() {
    let folder = Folder::new("still");
    let path = folder.path("film.gif");
    let same = vec![frames(1).remove(0); 60];
    let long = film(&path, 1, &same).expect("a film").bytes;
    assert_eq!(watch(&path).len(), 60);
    let short = film(&path, 1, &same[..10]).expect("a film").bytes;
    // Control block 8, image block 10, data 7 bytes.
    assert_eq!((long - short) / 50, 25);
}

#[test]
fn a_new_cast_is_drawn_from_its_first_frame() {
    let folder = Folder::new("cast");
    let path = folder.path("film.gif");
    let mut frames = frames(50);
    for frame in &mut frames[20..] {
        frame.cast = Arc::new(Cast { bodies: frame.cast.bodies[..2].to_vec(), ..(*frame.cast).clone() });
        frame.poses.truncate(2);
    }
    film(&path, 2, &frames).expect("a film");
    let shown = watch(&path);
    let place = view().camera.to_picture(frames[19].poses[2].position + DVec2::new(0.0, 0.1));
    let pixel = place.y as usize * SIZE.0 as usize + place.x as usize;
    let Theme { background, .. } = view().theme;
    assert_ne!(shown[19].0[pixel][..3], [background.0, background.1, background.2], "the ball");
    assert_eq!(shown[20].0[pixel][..3], [background.0, background.1, background.2], "no ball");
}

#[test]
fn a_sequence_holds_each_frame_exactly() {
    let folder = Folder::new("sequence");
    let target = PathBuf::from(format!("{}/", folder.path("deep/er").display()));
    let frames = frames(11);
    let written = film(&target, 2, &frames).expect("pictures");
    assert_eq!((written.frames, written.left_over), (11, 0));
    let mut bytes = 0;
    for (index, frame) in frames.iter().enumerate() {
        let file = fs::read(target.join(format!("frame_{index:05}.png"))).expect("a picture");
        bytes += file.len() as u64;
        assert_eq!(Pixmap::decode_png(&file).expect("a PNG"), drawn(frame));
    }
    assert_eq!(written.bytes, bytes);
    let shorter = film(&target, 3, &frames[..4]).expect("pictures");
    assert_eq!((shorter.frames, shorter.left_over), (4, 7));
}

#[test]
fn a_still_is_the_last_frame() {
    let folder = Folder::new("one");
    let path = folder.path("picture.PNG");
    let frames = frames(3);
    assert_eq!(film(&path, 1, &frames).expect("a picture").frames, 1);
    let picture = Pixmap::decode_png(&fs::read(&path).expect("a picture")).expect("a PNG");
    assert_eq!(picture, drawn(&frames[2]));
}

#[test]
fn wrong_targets_and_settings_are_refused_before_the_run() {
    let unknown = OutputTarget::new("film.avi").expect_err("no such format").to_string();
    assert!(unknown.contains("film.avi") && unknown.contains(".gif, .apng, .mp4, .webm, .rgba, .png, /"), "{unknown}");

    let folder = Folder::new("refused");
    let target = OutputTarget::new(folder.path("film.gif")).expect("a GIF");
    for rate in [f64::NAN, 0.0, -30.0, 60.0, f64::INFINITY] {
        let refused = open(&target, &FilmSettings { frames_per_second: rate, ..FilmSettings::default() }, view()).err();
        assert!(matches!(refused, Some(OutputError::Rate { .. })), "{rate}");
    }
    for (size, longest) in [((70_000, 10), 65_535), ((0, 10), 0), ((10, 0), 0)] {
        let view = View { camera: Camera::look(DVec2::ZERO, 1.0, size), ..view() };
        let refused = open(&target, &FilmSettings { frames_per_second: 30.0, ..FilmSettings::default() }, view).err();
        assert!(matches!(refused, Some(OutputError::Size { longest: said, .. }) if said == longest), "{size:?}");
    }
    let nowhere = begin(&folder.path("no/such/film.gif"), 1).err().expect("no directory").to_string();
    assert!(nowhere.contains("film.gif") && nowhere.contains("create its directory first"), "{nowhere}");
    assert!(folder.names().is_empty());
}

#[test]
fn a_frame_without_its_poses_is_refused() {
    let folder = Folder::new("poses");
    for name in ["film.gif", "film.apng", "film.rgba", "picture.png", "pictures/"] {
        let mut film = begin(&folder.path(name), 1).expect("a film");
        let mut frame = frames(1).remove(0);
        frame.poses.pop();
        assert!(matches!(film.push(frame), Err(OutputError::Poses { bodies: 3, poses: 2, .. })));
    }
}

/// The disk takes no more than 16 kB. For this the test runs again as a child process with the shell's limit for files.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said_with_its_remedy() {
    let name = "output::tests::a_full_disk_is_said_with_its_remedy";
    if std::env::var_os(LIMITED).is_none() {
        let program = std::env::current_exe().expect("the tests");
        let script = "trap '' XFSZ; ulimit -f 16; exec \"$0\" --exact \"$1\"";
        let mut child = std::process::Command::new("bash");
        let output = child.args(["-c", script]).arg(program).arg(name).env(LIMITED, "").output().expect("a shell");
        assert!(output.status.success(), "{output:?}");
        assert!(String::from_utf8_lossy(&output.stdout).contains("1 passed"), "{output:?}");
        return;
    }
    let folder = Folder::new("full");
    let mut film = begin(&folder.path("film.gif"), 1).expect("a film");
    let frames = frames(2000);
    let refused = frames.iter().find_map(|frame| film.push(frame.clone()).err()).expect("no space");
    let said = refused.to_string();
    assert!(said.contains("film.gif") && said.contains("free some space"), "{said}");
    assert!(matches!(film.push(frames[0].clone()), Err(OutputError::GivenUp { .. })));
    assert!(matches!(film.finish(), Err(OutputError::GivenUp { .. })));
}

/// Says to a test that it is the child.
#[cfg(target_os = "linux")]
const LIMITED: &str = "JOSTLE_TEST_FILES_ARE_LIMITED";

#[test]
fn a_broken_sequence_says_where_its_frames_are() {
    let folder = Folder::new("broken");
    fs::create_dir(folder.path("frame_00006.png")).expect("a folder in the way");
    let mut film = begin(&PathBuf::from(format!("{}/", folder.0.display())), 1).expect("pictures");
    let refused = frames(20).into_iter().find_map(|frame| film.push(frame).err()).expect("in the way");
    let said = refused.to_string();
    assert!(said.contains("frame_00006.png") && said.contains("The part written so far is in"), "{said}");
    assert!(matches!(film.finish(), Err(OutputError::GivenUp { .. })));
    let names = folder.names();
    assert!(names.iter().all(|name| name.ends_with(".png")), "{names:?}");
    assert_eq!(names[..6].last().map(String::as_str), Some("frame_00005.png"));
}
