//! Backwards, standing still, following, within a size, at the speed of the clock.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use super::harness::{EXPLOSION, FALL, Folder};

/// A ball falls 0.7845 m onto a floor: after 0.3961 s, in the tick that ends at 0.397 s.
const DROP: &str = r#"Scene(
    format: 1,
    clock: (duration: 1, tick: "1 ms", method: VelocityVerlet),
    film: (fps: 20, size: (64, 36)),
    camera: Look(center: (0, 1), height: 2.4),
    gravity: (0, -10),
    materials: { "soft": (stiffness: 1e4) },
    walls: [(name: "floor", left: (1, 0), right: (0, 0), material: "soft")],
    bodies: [(name: "ball", at: (0, 0.9845), velocity: (0, 0), material: "soft", atoms: Disc(radius: 0.2, mass: 1))],
)"#;

const FRAME: usize = 64 * 36 * 4;

/// The raw frames of a scene whose film is given.
fn frames(scene: &str, film: &str) -> Vec<Vec<u8>> {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let folder = Folder::new(&format!("control_{number}"))
        .with("scene.ron", scene.replace("film: (", &format!("film: ({film}, ")));
    let output = folder.command("render scene.ron -o - --quiet").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout.chunks(FRAME).map(<[u8]>::to_vec).collect()
}

#[test]
fn a_negative_speed_shows_the_same_frames_from_the_last_to_the_first() {
    for film in ["from: 0.2", "from: 0.1, to: 0.7, freeze: [(at: 0.33, for: 0.2)]"] {
        let forwards = frames(DROP, &format!("speed: 0.5, {film}"));
        let mut backwards = frames(DROP, &format!("speed: -0.5, {film}"));
        assert!(forwards.len() > 20 && forwards[0] != forwards[5]);
        backwards.reverse();
        assert!(forwards == backwards, "{film}");
    }
}

/// Frames before and after are those of the film that does not stand still; between them the moment stands for exactly
/// as many frames as it is to last.
#[test]
fn a_film_stands_still_at_a_time() {
    let plain = frames(DROP, "speed: 1");
    let frozen = frames(DROP, "speed: 1, freeze: [(at: 0.32, for: 0.5)]");
    // Frames at 0, 0.05 .. 0.3 are before the moment.
    assert_eq!(frozen.len(), plain.len() + 10);
    assert!(frozen[..7] == plain[..7] && frozen[17..] == plain[7..]);
    assert!(frozen[7..17].iter().all(|frame| *frame == frozen[7]) && frozen[7] != frozen[6] && frozen[7] != frozen[17]);
}

/// The contact begins in the tick from 0.396 s to 0.397 s (see [`DROP`]; `t = sqrt(2 h/g)`, which the method meets to
/// rounding): the film is that which stands still at the end of that tick.
#[test]
fn a_film_stands_still_at_a_contact() {
    let time = frames(DROP, "freeze: [(at: 0.397, for: 0.5)]");
    for touch in [r#"("ball", "floor")"#, r#"("floor", "ball")"#] {
        assert!(frames(DROP, &format!("freeze: [(touch: {touch}, for: 0.5)]")) == time, "{touch}");
    }
    let other = frames(DROP, "freeze: [(at: 0.398, for: 0.5)]");
    assert!(other != time, "the test can tell ticks apart");
}

#[test]
fn a_contact_that_does_not_begin_is_noted() {
    let scene = DROP.replace("film: (", r#"film: (to: 0.3, freeze: [(touch: ("ball", "floor"), for: 0.5)], "#);
    let folder = Folder::new("untouched").with("drop.ron", scene);
    let note = "note: film.freeze[0]: `ball` and `floor` do not begin to touch in the film, so it does not stop there";
    folder.jostle("render drop.ron").code(0).says(note).says("drop.gif: 6 frames");
    let late = DROP.replace("film: (", "film: (freeze: [(at: 3, for: 0.5)], ");
    let folder = Folder::new("late_freeze").with("drop.ron", late);
    let message = "error: film.freeze[0].at: the film is to stop at 3 s, but the run ends at 1 s";
    folder.jostle("render drop.ron").code(1).says(message).says("choose an earlier moment");
    folder.jostle("run drop.ron --quiet").code(0);
}

/// The middle of the picture is the middle of the body, whose highlight lies beside it.
#[test]
fn a_followed_body_stays_in_the_middle() {
    let middle = |frame: &Vec<u8>| frame[(18 * 64 + 32) * 4..][..3].to_vec();
    let look = frames(DROP, "speed: 1");
    let follow = DROP.replace("camera: Look(center: (0, 1), height: 2.4)", "camera: Follow(of: \"ball\", height: 2.4)");
    let seen = frames(&follow, "speed: 1");
    assert_eq!(seen.len(), 20);
    assert!(seen.iter().all(|frame| middle(frame) == middle(&seen[0])));
    assert!(middle(&look[7]) != middle(&look[0]), "a camera that stands sees the ball leave the middle");
    // Smoothing: it starts in the middle and is left behind.
    let slow = frames(&follow.replace("2.4)", "2.4, smoothing: \"2 s\")"), "speed: 1");
    assert!(slow[0] == seen[0] && middle(&slow[7]) != middle(&seen[7]));
    // Backwards it is the picture that is played backwards, not the camera's lag: without lag both are the same.
    let mut backwards = frames(&follow, "speed: -1");
    backwards.reverse();
    assert!(backwards == seen);
}

#[test]
fn a_film_played_backwards_of_a_run_that_goes_wrong_begins_where_it_did() {
    let folder = Folder::new("backwards_wrong").with("boom.ron", EXPLOSION.replace("film: (", "film: (speed: -1, "));
    folder.jostle("render boom.ron --quiet").code(3).says(" before the run went wrong, ");
    assert_eq!(folder.names(), ["boom.gif", "boom.ron"]);
}

#[cfg(unix)]
#[test]
fn a_film_that_cannot_be_kept_aside_says_where() {
    let folder = Folder::new("no_spool").with("drop.ron", DROP.replace("film: (", "film: (speed: -1, "));
    for flags in ["", "--max-size 1MB"] {
        let mut command = folder.command(&format!("render drop.ron --quiet {flags}"));
        let output = command.env("TMPDIR", folder.path("none")).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.starts_with("error: the program could not keep the frames in `"), "{said}");
        assert!(said.ends_with("or set TMPDIR to another directory\n"), "{said}");
        assert_eq!(folder.names(), ["drop.ron"]);
    }
}

fn gif(folder: &Folder, name: &str) -> (u16, u16, usize, u32) {
    let mut decoder = gif::DecodeOptions::new().read_info(std::io::Cursor::new(folder.read(name))).unwrap();
    let (mut frames, mut hundredths) = (0, 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        frames += 1;
        hundredths += u32::from(frame.delay);
    }
    (decoder.width(), decoder.height(), frames, hundredths)
}

#[test]
fn a_film_is_fitted_into_a_size() {
    let folder = Folder::new("max_size");
    let render = "render example:tetris --duration 4 --size 320x180";
    folder.jostle(&format!("{render} -o plain.gif --quiet")).code(0);
    let plain = folder.read("plain.gif");
    folder
        .jostle(&format!("{render} -o roomy.gif --max-size 1GB"))
        .code(0)
        .says("--max-size 1000.0 MB: the film fits as it is");
    assert!(folder.read("roomy.gif") == plain);
    let mut before = u64::MAX;
    for part in [2, 5, 12] {
        let most = plain.len() / part;
        let ended = folder.jostle(&format!("{render} -o film.gif --max-size {most}")).code(0);
        let told = ended.err.lines().find(|line| line.starts_with("--max-size ")).unwrap().to_owned();
        let length = folder.read("film.gif").len();
        assert!(length <= most && (length as u64) < before, "{length} of {most}: {told}");
        // Pictures are made as large as fits: nine tenths are aimed at, three sizes are tried.
        assert!(4 * length >= 3 * most, "{length} of {most}: {told}");
        before = length as u64;
        let (width, height, frames, hundredths) = gif(&folder, "film.gif");
        assert_eq!(told.contains(&format!("{width} x {height} pixels instead of 320 x 180")), width < 320, "{told}");
        let rate = format!("{} frames per second instead of 30", 30 * frames / 120);
        assert_eq!(told.contains(&rate), frames < 120, "{told}");
        assert!(told.contains("colours instead of 255"), "{told}");
        assert_eq!(hundredths, 400, "the film is as long as before");
        folder.jostle(&format!("{render} -o other.gif --threads 1 --quiet --max-size {most}")).code(0);
        assert!(folder.read("other.gif") == folder.read("film.gif"), "it does not depend on the threads");
    }
    let folder = folder.with("film.gif", "old");
    let ended = folder.jostle(&format!("{render} -o film.gif --max-size 1kB")).code(2);
    assert!(ended.err.contains("error: the film does not fit into 1 kB. At an eighth of its size"), "{ended:?}");
    assert_eq!(folder.read("film.gif"), b"old");
    assert_eq!(folder.names(), ["film.gif", "other.gif", "plain.gif", "roomy.gif"]);
}

#[test]
fn wrong_sizes_are_refused() {
    let folder = Folder::new("max_size_wrong").with("fall.ron", FALL);
    for (arguments, message) in [
        ("--max-size 2apples", "expected a size such as 2MB, 500kB or 1.5MiB"),
        ("--max-size -2MB", "expected a size such as 2MB"),
        ("--max-size 2MB -o film.apng", "--max-size is for GIFs: `film.apng` is none"),
        ("--max-size 2MB --at 0.1", "cannot be used with"),
        ("--max-size 2MB --pace", "cannot be used with"),
    ] {
        folder.jostle(&format!("render fall.ron {arguments}")).code(2).says(message);
    }
    assert_eq!(folder.names(), ["fall.ron"]);
}

/// Whoever reads the raw pictures of a film at the speed of the clock has the first one while the film still runs.
#[test]
fn paced_frames_come_one_by_one() {
    let folder = Folder::new("live").with("drop.ron", DROP.replace("film: (", "film: (speed: 0.2, "));
    let mut command = folder.command("render drop.ron -o - --pace --quiet");
    let mut child = command.stdout(std::process::Stdio::piped()).spawn().unwrap();
    let mut reader = child.stdout.take().unwrap();
    let mut rest = vec![0; FRAME];
    std::io::Read::read_exact(&mut reader, &mut rest).unwrap();
    assert!(child.try_wait().unwrap().is_none(), "the film of five seconds had ended");
    std::io::Read::read_to_end(&mut reader, &mut rest).unwrap();
    assert_eq!(rest.len(), 100 * FRAME);
    assert!(child.wait().unwrap().success());
}

/// A run at the speed of the clock lasts as long as its physics, a film as long as it is to be watched; the last frame
/// is shown one frame before the end. How late single frames are depends on the machine and is not tested.
#[test]
fn pace_keeps_to_the_clock() {
    let folder = Folder::new("pace").with("drop.ron", DROP.replace("film: (", "film: (speed: 2, "));
    for (arguments, shortest, said) in [
        ("run drop.ron --pace --duration 0.5", 500, "--pace: 51 steps at the speed of the clock, "),
        ("run drop.ron --pace --duration 0.5 -o table.csv", 500, "--pace: "),
        ("render drop.ron --pace", 450, "--pace: 10 frames at the speed of the clock, "),
        ("render drop.ron --pace -o film.rgba", 450, "--pace: 10 frames at the speed of the clock, "),
    ] {
        let start = Instant::now();
        folder.jostle(arguments).code(0).says(said);
        assert!(start.elapsed() >= Duration::from_millis(shortest), "{arguments}: {:?}", start.elapsed());
    }
}
