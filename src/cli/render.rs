//! `jostle render`: runs scenes and draws them.

use std::path::PathBuf;

use clap::Args;

use super::Exit;
use super::destination::{Place, Wish, places};
use super::estimate::EstimateFlags;
use super::film::{FilmRequest, Made, Shot};
use super::flags::{self, OverrideFlags, StrictFlag};
use super::interrupt;
use super::load::Request;
use super::result::{self, Detail, Ran};
use super::say::{count as in_words, say};
use super::side_by_side::all_cores;
use crate::output::{OutputTarget, WrittenFilm};
use crate::simulation::Overrides;

/// The command `render`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Render {
    /// Scene files, or example:NAME for a scene that comes with the program
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Write here. FILM.gif, .apng, .mp4 and .webm are films; the last two need the program ffmpeg. PICTURE.png goes with
    /// --at, --strip or --sheet. A directory DIR/ gets DIR/frame_00000.png and so on, or DIR/<scene>.gif of each of several
    /// scenes. FILM.rgba and - are raw pictures in a file and on standard output. Default: <scene>.gif in the current directory
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Draw only the picture at this time of the physics, in seconds. The run ends there
    #[arg(long, value_name = "T", value_parser = flags::moment, allow_negative_numbers = true)]
    at: Option<f64>,
    /// Draw the pictures at these times of the physics, in seconds, side by side
    #[arg(long, value_name = "T,T,T", value_parser = flags::moments, allow_hyphen_values = true, conflicts_with = "at")]
    strip: Option<flags::Moments>,
    /// Draw a contact sheet of so many columns and rows: pictures spread evenly over the film
    #[arg(long, value_name = "4x3", value_parser = flags::sheet, conflicts_with_all = ["at", "strip"])]
    sheet: Option<(u32, u32)>,
    /// Make the GIF no larger than this, such as 2MB: with fewer colours, fewer pixels or fewer frames. A message tells which
    #[arg(long, value_name = "SIZE", value_parser = flags::bytes, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["at", "strip", "sheet", "png", "pace"])]
    max_size: Option<u64>,
    /// Draw no faster than the film plays, for a program that shows it live (`-o - --pace`). A message counts the frames that
    /// come too late. Without this flag, drawing is as fast as possible
    #[arg(long, conflicts_with_all = ["at", "strip", "sheet"])]
    pace: bool,
    /// Write PNG sequences instead of GIFs. Each of several scenes gets a directory of its own, DIR/<scene>/
    #[arg(long)]
    png: bool,
    /// Size of the picture in pixels, instead of the scene's. In a strip or sheet, each picture has it
    #[arg(long, value_name = "WxH", value_parser = flags::size, allow_negative_numbers = true)]
    size: Option<(u32, u32)>,
    /// Frames per second of the film, instead of the scene's. A GIF shows at most 50
    #[arg(long, value_name = "N", value_parser = flags::rate, allow_negative_numbers = true)]
    fps: Option<f64>,
    /// Colours, instead of the scene's: paper, night or print, or a file such as mine.ron
    #[arg(long, value_name = "NAME")]
    theme: Option<String>,
    /// Draw these layers too, separated by commas: trails, forces, velocities, boxes, names, contacts, scale, time. `none`
    /// draws only the bodies, without the scene's layers
    #[arg(long, value_name = "LAYER,LAYER", value_parser = flags::layers)]
    layers: Option<flags::LayerWords>,
    #[command(flatten)]
    overrides: OverrideFlags,
    #[command(flatten)]
    estimates: EstimateFlags,
    #[command(flatten)]
    strict: StrictFlag,
    /// Draw with so many threads, and share the work of a tick among them. The film is the same. Default: one for each core
    #[arg(long, value_name = "N", value_parser = flags::threads, allow_negative_numbers = true)]
    threads: Option<usize>,
    /// Show no progress bar, and messages only if something is wrong
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
  jostle render my.ron -o strip.png --strip 0,0.5,1   three pictures side by side
  jostle render my.ron -o sheet.png --sheet 4x3       twelve moments of the film with their times
  jostle render my.ron --theme night --layers trails,forces
  jostle render my.ron --max-size 2MB                 a GIF that fits
  jostle render my.ron -o film.mp4                    a video, if ffmpeg is installed
  jostle render my.ron -o - --size 640x360 | ffplay -f rawvideo -pixel_format rgba -video_size 640x360 -
  jostle render my.ron -o frames/ --size 1920x1080    frames/frame_00000.png and so on
  jostle render scenes/*.ron -o films/                films/<scene>.gif, one for each scene";

impl Render {
    pub(super) fn execute(self) -> Exit {
        let scenes: Vec<Request> =
            self.scenes.iter().map(|name| Request { name, json: self.json, silent: self.quiet || self.json }).collect();
        let wish = Wish { output: self.output.as_deref(), still: self.still(), png: self.png };
        match places(&scenes, &wish) {
            Ok(places) => {
                if let Some(message) = places.iter().find_map(|place| self.objection(&place.target)) {
                    say(&format!("error: {message}"));
                    return Exit::Usage;
                }
                let films = scenes.into_iter().zip(&places).take_while(|_| !interrupt::asked());
                let ends = films.map(|(scene, place)| self.render(scene, place));
                ends.fold(Exit::Good, Exit::worse)
            }
            Err(exit) => exit,
        }
    }

    /// The flag that asks for one picture.
    fn still(&self) -> Option<&'static str> {
        let at = self.at.map(|_| "--at");
        at.or(self.strip.as_ref().map(|_| "--strip")).or(self.sheet.map(|_| "--sheet"))
    }

    fn shot(&self) -> Shot {
        match (self.at, &self.strip, self.sheet) {
            (Some(at), ..) => Shot::At(at),
            (_, Some(moments), _) => Shot::Strip(moments.0.clone()),
            (.., Some(places)) => Shot::Sheet(places),
            _ => Shot::Film,
        }
    }

    /// The objection of the other flags to a target.
    fn objection(&self, target: &OutputTarget) -> Option<String> {
        let path = target.path();
        if self.json && target.is_standard_output() {
            Some(
                "--json and the raw pictures of `-o -` both need standard output: write the film to a .rgba".to_owned(),
            )
        } else if self.max_size.is_some() && !target.is_gif() {
            Some(format!("--max-size is for GIFs: `{}` is none", path.display()))
        } else {
            None
        }
    }

    fn render(&self, request: Request, place: &Place) -> Exit {
        let layers = self.layers.clone().map(|layers| layers.0);
        let threads = Some(self.threads.unwrap_or_else(all_cores));
        let overrides = Overrides { layers, threads, ..self.overrides.overrides() };
        interrupt::disarm();
        let (source, mut simulation) = match request.load(&self.overrides.settings, &overrides) {
            Ok(loaded) => loaded,
            Err(exit) => return exit,
        };
        let order = FilmRequest {
            request,
            source: &source,
            overrides: &overrides,
            place,
            shot: &self.shot(),
            size: self.size,
            frames_per_second: self.fps,
            threads: self.threads,
            theme: self.theme.as_deref(),
            most_bytes: self.max_size,
            pace: self.pace,
            whole: false,
            silent: self.quiet || self.json,
            quiet: self.quiet,
        };
        self.estimates.watch(&mut simulation);
        let Made { written, failure } = match order.make(&mut simulation) {
            Ok(made) => made,
            Err(exit) => return exit,
        };
        let detail = Detail::of(self.json, self.quiet);
        if let Some(written) = &written
            && (detail == Detail::Card || failure.is_some())
        {
            report(
                written,
                failure.is_some().then_some("the run went wrong").or(interrupt::asked().then_some("Ctrl-C")),
            );
        }
        if failure.is_none()
            && !interrupt::asked()
            && let Err(exit) = self.estimates.estimate(&mut simulation, request, (&source, &overrides))
        {
            return exit;
        }
        let (cut, strict) = (self.still().is_some(), self.strict.strict);
        let ran = Ran { cut, strict, ..Ran::whole(&simulation, failure.as_ref()) };
        result::tell(request, &ran, detail)
    }
}

/// Reports the written film. `cut`: the reason for which it ended early.
fn report(written: &WrittenFilm, cut: Option<&str>) {
    let WrittenFilm { path, frames: count, bytes, seconds, left_over } = written;
    let size = flags::bytes_in_words(*bytes as f64);
    let path = path.display();
    let frames = in_words(*count as usize, "frame", "frames");
    // A still lasts no time.
    if *seconds == 0.0 && *count == 1 {
        say(&format!("{path}: one picture, {size}"));
    } else if *seconds == 0.0 {
        say(&format!("{path}: {frames} in one picture, {size}"));
    } else if let Some(end) = cut {
        say(&format!("{path}: the {frames} before {end}, {seconds:.2} s, {size}"));
    } else {
        say(&format!("{path}: {frames}, {seconds:.2} s, {size}"));
    }
    if *left_over > 0 {
        let pictures = in_words(*left_over as usize, "picture", "pictures");
        say(&format!("note: {pictures} of an earlier, longer sequence stand behind them"));
    }
}
