//! `jostle fmt`: writes scenes in their standard layout.

use std::io::Read;
use std::path::Path;

use clap::Args;

use super::Exit;
use super::load;
use super::say::{print_line, say, say_mistakes};
use crate::output::write_whole;
use crate::scene::{LARGEST_SCENE, SceneErrors, Source, formatted};

/// The command `fmt`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Fmt {
    /// Scene files, or - for standard input, whose layout goes to standard output
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Write nothing. Name the files that are not in the standard layout, and exit with 1 if there are any
    #[arg(long)]
    check: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle fmt my.ron             indentation, blanks and commas; sections in the order of the manual
  jostle fmt --check *.ron      is everything in the standard layout?
  jostle fmt - < my.ron         to standard output, as editors do it

Your line breaks stay, and so do numbers, texts and comments as they are written. Only characters that a terminal obeys \
or hides become escapes, such as \\u{1b}. A list or map that fills one line of \
more than 120 columns gets a line for each item. Sections move only if the scene keeps its meaning.

Exit codes: 0 good, 1 a scene cannot be read or (with --check) is not in the standard layout, 2 command line wrong.";

/// The name of standard input.
const STANDARD_INPUT: &str = "-";

impl Fmt {
    pub(super) fn execute(self) -> Exit {
        if self.scenes.len() > 1 && self.scenes.iter().any(|name| name == STANDARD_INPUT) {
            say("error: standard input (-) takes no files beside it");
            return Exit::Usage;
        }
        self.scenes.iter().map(|name| self.lay_out(name)).fold(Exit::Good, Exit::worse)
    }

    fn lay_out(&self, name: &str) -> Exit {
        let source = if name == STANDARD_INPUT { standard_input() } else { file(name) };
        let source = match source {
            Ok(source) => source,
            Err(exit) => return exit,
        };
        let text = match formatted(&source) {
            Ok(text) => text,
            Err(errors) => return refuse(&errors),
        };
        let changed = text != source.text;
        match (self.check, name == STANDARD_INPUT) {
            (true, _) if changed => {
                let first = source.text.lines().zip(text.lines()).take_while(|(a, b)| a == b).count() + 1;
                print_line(&format!("{name}:{first}: not in the standard layout")).worse(Exit::SceneWrong)
            }
            // The last line end is printed.
            (false, true) => print_line(text.strip_suffix('\n').unwrap_or(&text)),
            (false, false) if changed => match write_whole(Path::new(name), &text) {
                Ok(()) => Exit::Good,
                Err(error) => {
                    say(&format!("error: {error}"));
                    Exit::Usage
                }
            },
            _ => Exit::Good,
        }
    }
}

fn file(name: &str) -> Result<Source, Exit> {
    let path = Path::new(name);
    load::file(path).map_err(|errors| if path.exists() { refuse(&errors) } else { refuse(&errors).worse(Exit::Usage) })
}

fn standard_input() -> Result<Source, Exit> {
    let mut bytes = Vec::new();
    let read = std::io::stdin().take(LARGEST_SCENE as u64 + 1).read_to_end(&mut bytes);
    let text = read.ok().filter(|&length| length <= LARGEST_SCENE).and_then(|_| String::from_utf8(bytes).ok());
    text.map(|text| Source::new("standard input", text)).ok_or_else(|| {
        say("error: standard input is no scene: it cannot be read, is too large, or is not UTF-8 text");
        Exit::Usage
    })
}

fn refuse(errors: &SceneErrors) -> Exit {
    say_mistakes(errors);
    Exit::SceneWrong
}
