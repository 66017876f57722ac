//! `jostle measure`: the error and cost of each method and tick on a scene, and advice.

mod print;

use std::cell::Cell;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::Exit;
use super::destination::{is_directory, takes_no_file};
use super::flags;
use super::inputs::Inputs;
use super::load::{self, Request};
use super::progress_bar::Progress;
use super::say::{number, print_json, print_line, say};
use crate::cli::author;
use crate::output::{OutputError, write_picture, write_whole};
use crate::raster::{Theme, draw_diagram};
use crate::report::measure::{self, MeasureRequest, Measured, NoReference, Way};
use crate::report::work_precision::Cost;
use crate::simulation::{Overrides, Simulation};

/// The command `measure`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Measure {
    /// A scene file, or example:NAME for a scene that comes with the program
    #[arg(value_name = "SCENE")]
    scene: String,
    /// Write the measurement: a table (.csv) or a work-precision diagram (.png). The flag may stand several times
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Take about this time in seconds
    #[arg(long, value_name = "SECONDS", value_parser = flags::above_zero, default_value = "20", allow_negative_numbers = true)]
    budget: f64,
    /// Try at most so many ticks with each method. Ticks longer than its first one do not count. Default: as many as the budget
    /// allows
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    rungs: Option<u16>,
    /// Measure these methods, separated by commas. Default: all
    #[arg(long, value_name = "A,B,..", value_delimiter = ',', value_parser = flags::registered_methods())]
    methods: Vec<String>,
    /// The measure of cost: time on this computer, or evaluations of all forces, the same on every computer
    #[arg(long, value_name = "WHAT", default_value = "time")]
    cost: CostName,
    /// Seconds of physics, instead of the scene's
    #[arg(long, value_name = "T", value_parser = flags::above_zero, allow_negative_numbers = true)]
    duration: Option<f64>,
    /// Give a parameter of the scene (`params`) another value: a number or an expression. The flag may stand several times
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = flags::setting)]
    settings: Vec<(String, String)>,
    /// Size of the diagram in pixels
    #[arg(long, value_name = "WxH", value_parser = flags::size, default_value = "1200x720")]
    size: (u32, u32),
    /// Colours of the diagram
    #[arg(long, value_name = "NAME", value_parser = clap::builder::PossibleValuesParser::new(Theme::names()))]
    theme: Option<String>,
    /// Print the measurement as one line of JSON on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum CostName {
    Time,
    Evaluations,
}

const EXAMPLES: &str = "\
Examples:
  jostle measure example:projectile                          a table, and which method and tick to take
  jostle measure example:bounce -o bounce.png -o bounce.csv  a work-precision diagram, and the table as a file
  jostle measure example:kepler --duration 2 --budget 5      a shorter run, in five seconds
  jostle measure example:bounce --methods VelocityVerlet,Dop853 --rungs 4
  jostle measure example:kepler --cost evaluations --json    a cost that is the same on every computer, for a program

A reference run comes first: Dop853 with located events. Two more runs give its own error: one with a greater tolerance, and one \
that begins very near to it. Then each method runs the scene with ticks from about twice the critical one down by factors of \
two. The cheapest run of all \
is always next. A method ends if its error is that of the reference, and all end if the budget is used up. If the first tick of a \
method does well, the method tries longer ones too.

An error is a share of the motion, the greater one of two, from up to a hundred moments. The first is the greatest distance \
of any point of a body from the reference, over how far the body goes. The second is the root mean square of the difference \
of its velocity, over how fast the body is. The sign `<` marks errors below three times that of the \
reference, which are not known better. If the motion is chaotic, the command compares runs until the reference loses it, and \
names this time. For the rest of the run, it compares means over time and over all bodies (`beyond`).

The cost is the time of the fastest of three to nine runs that do nothing else. A star marks settings that no other setting \
beats: none is more exact for less.

Exit codes: 0 good, 1 the scene is wrong or all its bodies rest, 2 the command line is wrong or the budget is too short for the \
reference run, 3 the reference run or all settings go wrong. Even then, the output has all measurements.";

impl Measure {
    pub(super) fn execute(self) -> Exit {
        let request = Request { name: &self.scene, json: self.json, silent: self.json };
        if let Some(message) = self.output.iter().find_map(|path| objection(request, path)) {
            return request.usage(&message);
        }
        let source = match load::source(&self.scene) {
            Ok(source) => source.with_settings(&self.settings),
            Err(errors) => return request.refuse_scene(&errors),
        };
        if !self.output.is_empty() {
            let overrides = Overrides { duration: self.duration, untried: true, ..Overrides::default() };
            let inputs = match Simulation::load_with(&source, &overrides, author::plugin) {
                Ok(simulation) => Inputs::of(request, &simulation),
                Err(errors) => return request.refuse_scene(&errors),
            };
            if let Some(message) = self.output.iter().find_map(|path| inputs.objection(path)) {
                return request.usage(&message);
            }
        }
        let load = |way: Way| {
            let mut overrides = Overrides { duration: self.duration, ..Overrides::default() };
            match way {
                Way::Plan(plan) => overrides.plan = Some(plan.clone()),
                Way::Flags(method, tick) => {
                    (overrides.method, overrides.tick) = (Some(method.to_owned()), Some(tick));
                }
            }
            Simulation::load_with(&source, &overrides, author::plugin)
        };
        let order = MeasureRequest {
            budget: self.budget,
            rungs: self.rungs.map_or(usize::MAX, usize::from),
            methods: self.methods.clone(),
            cost: if self.cost == CostName::Time { Cost::Time } else { Cost::Evaluations },
        };
        const STEPS: f64 = 100.0;
        let progress = Progress::new(STEPS as u64, "hundredths of the budget", self.json);
        let last = Cell::new(0);
        let tell = |share: f64| {
            let step = (share * STEPS) as u64;
            if last.replace(step) != step {
                progress.at(step);
            }
        };
        let measured = measure::measure(&load, &order, &tell);
        drop(progress);
        match measured {
            Ok(measured) => self.tell(request, &measured),
            Err(why) => self.refuse(request, &why),
        }
    }

    /// Prints and writes the measurement.
    fn tell(&self, request: Request, measured: &Measured) -> Exit {
        let mut exit = if measured.reference.is_err() || measured.all_fail() { Exit::RunWrong } else { Exit::Good };
        let run = self.run_with();
        exit = exit.worse(if self.json {
            print_json(&print::json(&self.scene, measured, &run))
        } else {
            print_line(print::text(measured, &run).trim_end())
        });
        for path in &self.output {
            let written = if ends_with(path, "csv") {
                write_whole(path, print::csv(measured))
            } else {
                self.draw(request, measured, path)
            };
            match written {
                Ok(()) if self.json => (),
                Ok(()) => say(&format!("{} written", path.display())),
                Err(error) => exit = exit.worse(request.usage(&error.to_string())),
            }
        }
        if exit == Exit::RunWrong {
            say(&match &measured.reference {
                Err(NoReference::Failed(failure)) => format!(
                    "error: the reference run goes wrong: {failure}. Without it no error is known. Softer contacts, heavier \
                     bodies or weaker forces help. `jostle run {}` tells more",
                    self.scene
                ),
                _ => format!(
                    "error: no setting comes to the end of the scene. Softer contacts, heavier bodies or a larger --budget \
                     for shorter ticks help. `jostle run {}` tells more",
                    self.scene
                ),
            });
        }
        exit
    }

    fn draw(&self, request: Request, measured: &Measured, path: &Path) -> Result<(), OutputError> {
        let theme = self.theme.as_deref().or(Theme::names().first().copied()).and_then(Theme::named);
        let theme = theme.expect("a program without a theme fails its tests");
        let picture = draw_diagram(&measured.diagram(&request.stem()), &theme, self.size)?;
        write_picture(path, &picture).map(|_| ())
    }

    /// The command that runs the scene as it was measured, without method and tick.
    fn run_with(&self) -> String {
        let mut words = vec!["jostle run".to_owned(), shell(&self.scene)];
        words.extend(self.duration.map(|duration| format!("--duration {duration}")));
        words.extend(self.settings.iter().map(|(name, value)| format!("--set {}", shell(&format!("{name}={value}")))));
        words.join(" ")
    }

    /// Tells why nothing was measured.
    fn refuse(&self, request: Request, why: &NoReference) -> Exit {
        let scene = &self.scene;
        match why {
            NoReference::Scene(errors) => request.refuse_scene(errors),
            NoReference::Still => request.refuse(
                Exit::SceneWrong,
                "bodies",
                "all bodies rest, and errors are shares of the motion",
                "give a body a velocity or a force, or measure a longer run with --duration",
            ),
            NoReference::Short(needed) => {
                let needed = number(format!("{needed:.0e}").parse().unwrap_or(*needed));
                let message = format!("--budget {} s is too short for the reference run", number(self.budget));
                let help = format!("it needs about {needed} s: --budget {needed}, or a shorter run with --duration");
                request.refuse(Exit::Usage, "", &message, &help)
            }
            NoReference::Parts => request.refuse(
                Exit::RunWrong,
                "",
                "reference runs with different steps go apart before the first moment of comparison: no place of a body is known",
                "a shorter run with --duration and closer moments, or a larger --budget for finer steps",
            ),
            NoReference::Failed(failure) => request.refuse(
                Exit::RunWrong,
                "",
                &failure.to_string(),
                &format!("softer contacts, heavier bodies or weaker forces; `jostle run {scene}` tells more"),
            ),
        }
    }
}

/// A word as a shell reads it.
fn shell(word: &str) -> String {
    let plain = |letter: char| letter.is_alphanumeric() || "-_./:=+,%@".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

fn ends_with(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

/// The objection to an output path.
fn objection(request: Request, path: &Path) -> Option<String> {
    let name = path.display();
    if is_directory(path) {
        Some(format!("`{name}` is a directory: name a file in it, such as `{}`", path.join("measure.png").display()))
    } else if !ends_with(path, "csv") && !ends_with(path, "png") {
        Some(format!("`measure` writes a table to a .csv and a diagram to a .png, not `{name}`"))
    } else if request.is_at(path) {
        Some(format!("`{name}` is the scene: write to another file"))
    } else {
        takes_no_file(path)
    }
}

#[cfg(test)]
mod tests {
    use super::shell;

    #[test]
    fn words_are_quoted_where_a_shell_would_part_them() {
        assert_eq!(shell("scenes/a-b_1.ron"), "scenes/a-b_1.ron");
        assert_eq!(shell("my scene.ron"), "'my scene.ron'");
        assert_eq!(shell("it's"), r"'it'\''s'");
    }
}
