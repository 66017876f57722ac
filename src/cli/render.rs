//! `jostle render`: runs scenes and draws them.

use std::path::PathBuf;

use clap::Args;

use super::Exit;
use super::film::{Made, Order};
use super::flags::{self, OverrideFlags};
use super::load::Request;
use super::result::{self, Detail};
use super::say::{count, say};
use super::target::{Place, Wish, places};
use crate::output::Written;

/// The command `render`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Render {
    /// Scene files, or example:NAME for a scene that comes with the program
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Where to: FILM.gif, PICTURE.png (with --at), or a directory DIR/ (one scene: DIR/frame_00000.png and so on;
    /// several: DIR/<scene>.gif each). Default: <scene>.gif in the current directory
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Draw only the picture at this time of the physics, in seconds; the run ends there
    #[arg(long, value_name = "T", value_parser = flags::moment, allow_negative_numbers = true)]
    at: Option<f64>,
    /// PNG sequences instead of GIFs; of several scenes each in a directory of its own, DIR/<scene>/
    #[arg(long)]
    png: bool,
    /// Size of the picture in pixels, instead of the scene's
    #[arg(long, value_name = "WxH", value_parser = flags::size, allow_negative_numbers = true)]
    size: Option<(u32, u32)>,
    /// Frames per second of the film, instead of the scene's; a GIF shows at most 50
    #[arg(long, value_name = "N", value_parser = flags::rate, allow_negative_numbers = true)]
    fps: Option<f64>,
    #[command(flatten)]
    overrides: OverrideFlags,
    /// Threads that draw; the film does not depend on it. Default: one for each core
    #[arg(long, value_name = "N", value_parser = flags::threads, allow_negative_numbers = true)]
    threads: Option<usize>,
    /// No progress bar, and messages only if something is wrong
    #[arg(long)]
    quiet: bool,
    /// Print the result of each scene as one line of JSON on standard output
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle render example:tetris                        the film tetris.gif
  jostle render my.ron -o still.png --at 1.5          one picture, after 1.5 s
  jostle render my.ron -o frames/ --size 1920x1080    frames/frame_00000.png and so on
  jostle render scenes/*.ron -o films/                films/<scene>.gif, one for each scene";

impl Render {
    pub(super) fn execute(self) -> Exit {
        let scenes: Vec<Request> = self.scenes.iter().map(|name| Request { name, json: self.json }).collect();
        let wish = Wish { output: self.output.as_deref(), still: self.at.is_some(), png: self.png };
        match places(&scenes, &wish) {
            Ok(places) => {
                let ends = scenes.into_iter().zip(&places).map(|(scene, place)| self.render(scene, place));
                ends.fold(Exit::Good, Exit::worse)
            }
            Err(exit) => exit,
        }
    }

    fn render(&self, request: Request, place: &Place) -> Exit {
        let overrides = self.overrides.overrides();
        let (source, mut simulation) = match request.load(&self.overrides) {
            Ok(loaded) => loaded,
            Err(exit) => return exit,
        };
        let order = Order {
            request,
            source: &source,
            overrides: &overrides,
            place,
            at: self.at,
            size: self.size,
            frames_per_second: self.fps,
            threads: self.threads,
            silent: self.quiet || self.json,
        };
        let Made { written, failure } = match order.make(&mut simulation) {
            Ok(made) => made,
            Err(exit) => return exit,
        };
        let detail = Detail::of(self.json, self.quiet);
        if let Some(written) = &written
            && (detail == Detail::Card || failure.is_some())
        {
            report(written, failure.is_some());
        }
        result::tell(request, &simulation, failure.as_ref(), self.at.is_some(), detail)
    }
}

/// Says what was written.
fn report(written: &Written, cut: bool) {
    let Written { path, frames, bytes, seconds, left_over } = written;
    let size = if *bytes < 1_000_000 {
        format!("{} kB", bytes.div_ceil(1000))
    } else {
        format!("{:.1} MB", *bytes as f64 / 1e6)
    };
    let path = path.display();
    let frames = count(*frames as usize, "frame", "frames");
    // A still lasts no time.
    if *seconds == 0.0 {
        say(&format!("{path}: one picture, {size}"));
    } else if cut {
        say(&format!("{path}: the {frames} before the run went wrong, {seconds:.2} s, {size}"));
    } else {
        say(&format!("{path}: {frames}, {seconds:.2} s, {size}"));
    }
    if *left_over > 0 {
        let pictures = count(*left_over as usize, "picture", "pictures");
        say(&format!("note: after them still stand {pictures} of an earlier, longer sequence"));
    }
}
