//! `jostle schema`: the scene language, as JSON schema or as the manual.

use std::path::PathBuf;

use bevy_app::App;
use clap::Args;

use super::Exit;
use super::destination::takes_no_file;
use super::say::{print_line, say};
use crate::output::write_whole;
use crate::plugins;
use crate::scene::SceneRegistry;
use crate::scene::schema::Language;

/// The command `schema`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct SchemaCommand {
    /// Write the manual in Markdown: every section and field with value, unit, default and meaning
    #[arg(long)]
    manual: bool,
    /// The file to write. Default: standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  jostle schema -o scene.schema.json        JSON schema (draft 2020-12) of the scene language
  jostle schema --manual -o manual.md       the manual for people
  jostle schema --manual | less";

impl SchemaCommand {
    pub(super) fn execute(self) -> Exit {
        let mut app = App::empty();
        plugins::standard(&mut app);
        super::author::plugin(&mut app);
        let language = Language::of(app.world().resource::<SceneRegistry>());
        let text = if self.manual { language.manual() } else { format!("{:#}\n", language.json()) };
        let Some(path) = self.output else { return print_line(text.trim_end()) };
        let refused = takes_no_file(&path).map_or(Ok(()), Err);
        match refused.and_then(|()| write_whole(&path, &text).map_err(|error| error.to_string())) {
            Ok(()) => Exit::Good,
            Err(message) => {
                say(&format!("error: {message}"));
                Exit::Usage
            }
        }
    }
}
