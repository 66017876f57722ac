//! A film decodes to the promised number of frames and to exactly its length.

use std::path::Path;
use std::process::Command;

const SCENE: &str = r#"Scene(
    format: 1,
    title: "A ball flies",
    clock: (duration: 1.5, tick: "1 ms"),
    film: (fps: 30, size: (96, 54), speed: 0.5, from: 0.5),
    gravity: (0, -10),
    bodies: [(name: "ball", at: (0, 0), velocity: (2, 5), atoms: Disc(radius: 0.1))],
)"#;

/// One second of physics at half speed is two seconds of film: 60 frames at 30 per second, whose delays of 3, 3, 4 ...
/// hundredths of a second add up to 200.
#[test]
fn a_gif_has_all_frames_and_exactly_the_length_of_the_film() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("film");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("flight.ron"), SCENE).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_jostle"));
    let status = command.current_dir(&folder).args(["render", "flight.ron", "--quiet"]).status().unwrap();
    assert!(status.success());
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::Indexed);
    let mut decoder = options.read_info(std::fs::File::open(folder.join("flight.gif")).unwrap()).unwrap();
    assert_eq!((decoder.width(), decoder.height()), (96, 54));
    let (mut delays, mut changed) = (Vec::new(), 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        delays.push(frame.delay);
        changed += usize::from(frame.width > 1 && frame.height > 1);
    }
    assert_eq!(delays.len(), 60);
    assert_eq!(delays.iter().map(|delay| u32::from(*delay)).sum::<u32>(), 200);
    assert!(delays.iter().all(|delay| (3..=4).contains(delay)), "{delays:?}");
    // The ball and the clock move: hardly a frame is like the one before.
    assert!(changed > 50, "{changed}");
}
