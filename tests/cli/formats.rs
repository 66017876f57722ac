//! Formats beside GIF and PNG: APNG, raw pictures, and videos by ffmpeg. A small script takes the place of ffmpeg,
//! whose result is not tested.

use std::process::Stdio;

use image::AnimationDecoder;

use super::harness::{FALL, Folder};

/// The bytes of the raw film of a scene in the folder.
fn raw(folder: &Folder, arguments: &str) -> Vec<u8> {
    let output = folder.command(&format!("render {arguments} -o - --quiet")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// Decoded by the `image` crate, which composes the frames by itself; the `png` crate made their pixels.
#[test]
fn an_apng_holds_each_frame_exactly() {
    let folder = Folder::new("apng");
    let scene = "example:tetris --duration 2 --size 160x90";
    let pictures = raw(&folder, scene);
    for (rate, seconds) in [("30", 2.0), ("12.5", 2.0)] {
        folder.jostle(&format!("render {scene} --fps {rate} -o film.apng --quiet")).code(0);
        let file = std::io::Cursor::new(folder.read("film.apng"));
        let decoder = image::codecs::png::PngDecoder::new(file).unwrap().apng().unwrap();
        let frames = decoder.into_frames().collect_frames().unwrap();
        let length: f64 =
            frames.iter().map(|frame| frame.delay().numer_denom_ms()).map(|(n, d)| f64::from(n) / f64::from(d)).sum();
        // A film's length is met to the unit its frames are counted in: 1/30 s and 1/10000 s.
        assert!((length / 1e3 - seconds).abs() < 1e-4, "{length} ms");
        if rate == "30" {
            let shown: Vec<u8> = frames.iter().flat_map(|frame| frame.buffer().as_raw().clone()).collect();
            assert!(shown == pictures, "{} frames of {} bytes", frames.len(), shown.len());
        }
    }
    // Whoever knows no animations sees the first frame.
    let still = image::load_from_memory_with_format(&folder.read("film.apng"), image::ImageFormat::Png).unwrap();
    assert!(still.to_rgba8().as_raw()[..] == pictures[..160 * 90 * 4]);
}

#[test]
fn raw_pictures_go_to_standard_output_or_a_file() {
    let folder = Folder::new("raw").with("fall.ron", FALL);
    folder
        .jostle("render fall.ron -o film.rgba")
        .code(0)
        .says("raw pictures: 64 x 36 pixels, 10 frames per second, 4 bytes each pixel")
        .says("ffplay -f rawvideo -pixel_format rgba -video_size 64x36 -framerate 10");
    let pictures = raw(&folder, "fall.ron");
    assert_eq!(pictures.len(), 2 * 64 * 36 * 4);
    assert!(pictures == folder.read("film.rgba"));
    assert!(pictures.as_chunks::<4>().0.iter().all(|pixel| pixel[3] == 255));
    folder.jostle("render fall.ron -o frames/ --quiet").code(0);
    for (index, picture) in pictures.chunks_exact(64 * 36 * 4).enumerate() {
        let file = folder.read(&format!("frames/frame_{index:05}.png"));
        assert!(image::load_from_memory(&file).unwrap().to_rgba8().as_raw()[..] == *picture);
    }
    assert_eq!(folder.names(), ["fall.ron", "film.rgba", "frames"]);
}

#[test]
fn what_does_not_go_with_standard_output_is_said() {
    let folder = Folder::new("raw_wrong").with("fall.ron", FALL).with("two.ron", FALL);
    for (arguments, message) in [
        ("fall.ron -o - --json", "both need standard output: write the film to a .rgba"),
        ("fall.ron -o - --at 0.1", "--at makes PNG files; standard output (`-o -`) takes raw films"),
        ("fall.ron -o - --sheet 2x2", "--sheet makes PNG files"),
        ("fall.ron -o - --png", "--png makes PNG files"),
        ("fall.ron two.ron -o -", "standard output takes one film, not 2; name one scene"),
    ] {
        let ended = folder.jostle(&format!("render {arguments}")).code(2).says(message);
        assert!(ended.out.is_empty() || ended.out.starts_with("{\"scene\""));
    }
    assert_eq!(folder.names(), ["fall.ron", "two.ron"]);
}

/// The bytes do not depend on the threads, whatever the format.
#[test]
fn no_format_depends_on_threads() {
    let folder = Folder::new("format_threads");
    for (name, flags) in [("film.gif", ""), ("film.apng", ""), ("film.rgba", ""), ("sheet.png", "--sheet 3x2")] {
        let bytes = [1, 2, 4].map(|threads| {
            let scene = "render example:tetris --duration 1.5 --size 96x54 --quiet";
            folder.jostle(&format!("{scene} --threads {threads} {flags} -o {name}")).code(0);
            folder.read(name)
        });
        assert!(bytes[0] == bytes[1] && bytes[0] == bytes[2], "{name}");
    }
    let sequence = [1, 2, 4].map(|threads| {
        let arguments = format!("render example:tetris --duration 0.5 --size 96x54 --quiet --threads {threads} -o f/");
        folder.jostle(&arguments).code(0);
        (0..15).map(|index| folder.read(&format!("f/frame_{index:05}.png"))).collect::<Vec<_>>()
    });
    assert!(sequence[0] == sequence[1] && sequence[0] == sequence[2]);
}

/// A folder that has a program `ffmpeg` of this text, and nothing else on the path but the system's own.
#[cfg(unix)]
fn with_ffmpeg(folder: Folder, text: &str) -> Folder {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder.with("bin/ffmpeg", format!("#!/bin/sh\n{text}\n"));
    std::fs::set_permissions(folder.path("bin/ffmpeg"), std::fs::Permissions::from_mode(0o755)).unwrap();
    folder
}

/// Renders with that path: exit code and messages.
#[cfg(unix)]
fn render(folder: &Folder, arguments: &str) -> (Option<i32>, String) {
    let path = format!("{}:/usr/bin:/bin", folder.path("bin").display());
    let mut command = folder.command(&format!("render {arguments}"));
    let output = command.env("PATH", path).stdout(Stdio::null()).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[cfg(unix)]
#[test]
fn videos_are_made_by_ffmpeg() {
    let copy = "for last; do :; done\nprintf '%s\\n' \"$@\" > arguments.txt\ncat > \"${last#file:}\"";
    let folder = with_ffmpeg(Folder::new("video").with("fall.ron", FALL), copy);
    let pictures = raw(&folder, "fall.ron");
    for (name, codec) in [("film.mp4", "libx264"), ("film.webm", "libvpx-vp9")] {
        let (code, said) = render(&folder, &format!("fall.ron -o {name}"));
        assert_eq!(code, Some(0), "{said}");
        assert!(said.contains(&format!("{name}: 2 frames, 0.20 s, 19 kB")), "{said}");
        assert!(folder.read(name) == pictures, "the program was given the frames");
        let arguments = String::from_utf8(folder.read("arguments.txt")).unwrap();
        let part = format!("file:{name}.");
        for words in ["rawvideo\n-pixel_format\nrgba\n-video_size\n64x36\n-framerate\n10\n-i\npipe:0", codec, &part] {
            assert!(arguments.contains(words), "{words}: {arguments}");
        }
    }
    assert_eq!(folder.names(), ["arguments.txt", "bin", "fall.ron", "film.mp4", "film.webm"]);
}

#[cfg(unix)]
#[test]
fn a_video_without_ffmpeg_is_told_with_its_remedy() {
    let folder = Folder::new("no_ffmpeg").with("fall.ron", FALL).with("film.mp4", "old");
    let mut command = folder.command("render fall.ron -o film.mp4");
    let output = command.env("PATH", folder.path("")).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = "error: `film.mp4` needs the program `ffmpeg`, which is not installed (not found on PATH); install it, \
                   or write a .gif or .apng, which need nothing else\n";
    assert_eq!(String::from_utf8(output.stderr).unwrap(), message);
    assert_eq!(
        (folder.names(), folder.read("film.mp4")),
        (vec!["fall.ron".into(), "film.mp4".into()], b"old".to_vec())
    );
}

#[cfg(unix)]
#[test]
fn a_failing_ffmpeg_is_quoted() {
    let refuses = "echo \"Unknown encoder 'libx264'\" >&2\nexit 3";
    let gives_up = "head -c 100 > /dev/null\necho 'Out of memory' >&2\nexit 1";
    let at_the_end = "cat > /dev/null\necho 'moov atom lost' >&2\nexit 4";
    let silent = "cat > /dev/null\nexit 5";
    for (name, text, told) in [
        ("refuses", refuses, "`ffmpeg` ended with exit status: 3 and said:\nUnknown encoder 'libx264'\n"),
        ("gives_up", gives_up, "`ffmpeg` ended with exit status: 1 and said:\nOut of memory\n"),
        ("at_the_end", at_the_end, "`ffmpeg` ended with exit status: 4 and said:\nmoov atom lost\n"),
        ("silent", silent, "`ffmpeg` ended with exit status: 5 and said nothing\n"),
    ] {
        let folder = Folder::new(&format!("ffmpeg_{name}")).with("fall.ron", FALL).with("film.mp4", "old");
        let folder = with_ffmpeg(folder, text);
        let (code, said) = render(&folder, "fall.ron -o film.mp4 --size 640x360");
        assert_eq!(code, Some(2), "{said}");
        assert_eq!(said, format!("error: `film.mp4` could not be written: {told}"));
        assert_eq!(folder.names(), ["bin", "fall.ron", "film.mp4"]);
        assert_eq!(folder.read("film.mp4"), b"old");
    }
}
