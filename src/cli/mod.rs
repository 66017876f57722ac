//! The command line: one file per command.

mod aim;
mod author;
mod bench;
mod check;
mod colors;
mod columns;
mod destination;
mod estimate;
mod examples;
mod explain;
mod film;
mod film_times;
mod find;
mod flags;
mod fmt;
mod inputs;
mod interrupt;
mod junit;
mod list;
mod load;
mod measure;
mod new;
mod pace;
mod paths;
mod plot;
mod progress_bar;
mod projector;
mod reading;
mod render;
mod report;
mod result;
mod row_ticks;
mod run;
mod save;
mod say;
mod schema;
mod side_by_side;
mod squeeze;
mod sweep;
mod test;
mod trial;
mod wall_clock;

use clap::{Parser, Subcommand};

use crate::scene::is_hidden;

/// How a command ended. The exit codes are documented in the manual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// 0: good.
    Good,
    /// 1: the scene is wrong, or an expectation is broken.
    SceneWrong,
    /// 2: the command line is wrong, or a file cannot be written.
    Usage,
    /// 3: the run failed; frames so far are kept.
    RunWrong,
    /// 130: Ctrl-C ended the run; frames so far are kept.
    Interrupted = 130,
}

impl From<Exit> for std::process::ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

impl Exit {
    /// The graver of two.
    fn worse(self, other: Self) -> Self {
        if other as u8 > self as u8 { other } else { self }
    }
}

const EXAMPLES: &str = "\
Examples:
  jostle render example:tetris                           the film tetris.gif, and the error card
  jostle render example:bounce -o bounce.png --at 1.5    one picture, after 1.5 s
  jostle render scenes/*.ron -o films/                   a film of each scene
  jostle run example:projectile -o channels.csv          numbers instead of pictures
  jostle plot example:bounce --channels elastic.position.y  a figure of a sensor's channel
  jostle check my_scene.ron                              read it and report its mistakes
  jostle test scenes/                                    do all scenes of a folder meet their expectations?
  jostle sweep my_scene.ron --vary mass=1..5 -o out/     a table and pictures of several values
  jostle measure my_scene.ron                            the error and the cost of each method and tick
  jostle list                                            the scenes that come with the program
  jostle new scene my_scene                              a scene to begin with
  jostle schema --manual | less                          every section and field that a scene may have

Scenes that come with the program: {scenes}.

Exit codes: 0 good, 1 scene or expectation wrong, 2 command line wrong or a file cannot be written, 3 run gone wrong,
130 ended by Ctrl-C. What a run reached is kept.";

fn after_help() -> String {
    let names: Vec<&str> = examples::SCENES.iter().map(|(name, _)| *name).collect();
    EXAMPLES.replace("{scenes}", &names.join(", "))
}

pub use author::{main_with, tell_commit};

/// 2D physics without a window: a scene in a RON file becomes films, numbers and a statement of their errors.
#[derive(Parser, Debug)]
#[command(name = "jostle", version, after_help = after_help())]
pub struct CommandLine {
    #[command(subcommand)]
    command: Command,
    /// Let scenes read files from any folder. Without it, a file lies in the scene's folder, below it, or in one above it
    #[arg(long, global = true)]
    allow_outside: bool,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Run a scene and print its error card; with -o also write its channels as CSV
    Run(run::RunArguments),
    /// Run scenes and draw them: films (GIF, APNG, MP4, WebM, raw), pictures, strips, contact sheets and sequences (PNG)
    Render(render::Render),
    /// Draw channels as a figure: of a scene, or of a table of comma-separated values
    Plot(plot::PlotCommand),
    /// Read scenes and report their mistakes; with --run also check their expectations
    Check(check::Check),
    /// Run all scenes of a folder, several at once, and check their expectations
    Test(test::Test),
    /// Run a scene with many values of its parameters, and write a table, a contact sheet and films
    Sweep(sweep::Sweep),
    /// Measure the cost of ticks of scenes, beside a plain loop that does the same work
    Bench(bench::Bench),
    /// Run problems with exact answers by all methods, and report error against time: Markdown, HTML, tables, diagrams
    Report(report::Report),
    /// Measure the error and the cost of each method and tick on a scene, and name the cheapest ones
    Measure(measure::Measure),
    /// Give scenes their standard layout; comments and line breaks stay
    Fmt(fmt::Fmt),
    /// Show the systems of a scene with their costs, or the meaning of a name or word
    Explain(explain::Explain),
    /// List the scenes that come with the program, or the names that a scene may use: sections, forces, sensors, methods ...
    List(list::List),
    /// Write a starting point: a plugin or a scene
    New(new::New),
    /// Write the JSON schema of scenes for programs, or with --manual the manual for people
    Schema(schema::SchemaCommand),
}

impl CommandLine {
    /// The command line of this process. If it is wrong or asks for help, the process ends with a message.
    pub fn read() -> Self {
        Self::try_parse().unwrap_or_else(|error| {
            // The colours of the message are escapes themselves. If an argument holds another one, it stands without colours.
            if std::env::args_os().any(|argument| argument.to_string_lossy().contains(is_hidden)) {
                say::say(error.to_string().trim_end());
                std::process::exit(error.exit_code());
            }
            error.exit()
        })
    }

    /// Executes the command. Messages go to standard error, results to standard output.
    pub fn execute(self) -> Exit {
        load::allow_outside(self.allow_outside);
        interrupt::listen();
        match self.command {
            Command::Run(run) => run.execute(),
            Command::Render(render) => render.execute(),
            Command::Plot(plot) => plot.execute(),
            Command::Check(check) => check.execute(),
            Command::Test(test) => test.execute(),
            Command::Sweep(sweep) => sweep.execute(),
            Command::Bench(bench) => bench.execute(),
            Command::Report(report) => report.execute(),
            Command::Measure(measure) => measure.execute(),
            Command::Fmt(fmt) => fmt.execute(),
            Command::Explain(explain) => explain.execute(),
            Command::List(list) => list.execute(),
            Command::New(new) => new.execute(),
            Command::Schema(schema) => schema.execute(),
        }
    }
}
