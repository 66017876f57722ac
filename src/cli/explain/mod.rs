//! `jostle explain`: the stages of a scene's tick and their costs, or the meaning of a name or a word.

mod channel;
mod flag;
mod language_parts;
mod name;
mod scene;
mod synonyms;
mod words;

use std::path::Path;

use clap::Args;

use super::Exit;
use super::flags::OverrideFlags;
use super::load::{EXAMPLE, Request};
use super::say::say;

/// The command `explain`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Explain {
    /// A scene file or example:NAME, and a channel of it if that is meant. Or the name of a section, entry, field, method, channel
    /// or flag, or a common word for one. Or a word on the error card
    #[arg(value_name = "SCENE|NAME", required = true)]
    what: Vec<String>,
    #[command(flatten)]
    overrides: OverrideFlags,
    /// Print what a scene does as one line of JSON on standard output
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle explain example:tetris     its systems in order, who brought them, and how the time is shared out
  jostle explain Drag               what a force, sensor, section or method is, with an example
  jostle explain hinge              the same, by a common word for it
  jostle explain radius             a field: everything that has it, with default and meaning
  jostle explain critical tick      what a word on the error card means
  jostle explain kinetic            what a channel is, its unit, and the sensor that gives it
  jostle explain example:bounce elastic.position.y
                                    the meaning of a channel of a scene
  jostle explain threads            the meaning of a flag, and the commands that have it

The command runs a scene twice. The first run takes half a second. The second one takes up to three seconds, and reads the \
clock around each stage. Both runs begin at the start of the scene. The output says how much of it they covered.";

impl Explain {
    pub(super) fn execute(self) -> Exit {
        let what = self.what.join(" ");
        if let [scene, name] = &self.what[..]
            && is_scene(scene)
        {
            return channel::of_scene(Request { name: scene, json: false, silent: false }, &self.overrides, name);
        }
        if is_scene(&what) {
            return self.scene(Request { name: &what, json: self.json, silent: self.json });
        }
        if self.json {
            say("error: --json is for scenes; `jostle list --json` tells names to programs");
            return Exit::Usage;
        }
        name::explain(&what)
    }

    fn scene(&self, request: Request) -> Exit {
        match scene::Anatomy::of(request, &self.overrides) {
            Ok(anatomy) if self.json => super::say::print_json(&anatomy.to_json(request.name)),
            Ok(anatomy) => super::say::print_line(anatomy.told(request.name).trim_end()),
            Err(exit) => exit,
        }
    }
}

fn is_scene(what: &str) -> bool {
    what.starts_with(EXAMPLE) || what.ends_with(".ron") || Path::new(what).is_file()
}
