//! `jostle check`: reads scenes and says what is wrong with them.

use clap::Args;

use super::Exit;
use super::flags::OverrideFlags;
use super::load::Request;
use super::pace::Runner;
use super::progress::Progress;
use super::result::{self, Detail, Ran};
use super::say::{count, print_line, say};
use crate::simulation::{Overrides, Simulation};

/// The command `check`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Check {
    /// Scene files, or example:NAME for a scene that comes with the program
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Also run each scene and check what it expects
    #[arg(long)]
    run: bool,
    #[command(flatten)]
    overrides: OverrideFlags,
    /// Print for each scene one line of JSON on standard output: its mistakes, or with --run its result
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle check my.ron                 every mistake with its line and a remedy
  jostle check --run scenes/*.ron     does each scene do what it says under `expect`?";

impl Check {
    pub(super) fn execute(self) -> Exit {
        let check = |name: &String| {
            let request = Request { name, json: self.json };
            let overrides = Overrides { untried: !self.run, ..self.overrides.overrides() };
            match request.load(&self.overrides.settings, &overrides) {
                Err(exit) => exit,
                Ok((_, simulation)) if self.run => self.run(request, simulation),
                Ok((_, simulation)) if self.json => {
                    let notes = simulation.notes();
                    print_line(&serde_json::json!({ "scene": name, "errors": [], "notes": notes }).to_string())
                }
                Ok((_, simulation)) => {
                    for note in simulation.notes() {
                        say(&format!("note: {name}: {note}"));
                    }
                    print_line(&format!("{name}: good; {}", contents(&simulation)))
                }
            }
        };
        self.scenes.iter().map(check).fold(Exit::Good, Exit::worse)
    }

    fn run(&self, request: Request, mut simulation: Simulation) -> Exit {
        let progress = Progress::new(simulation.ticks(), "ticks", self.json);
        let end = simulation.ticks();
        let failure = Runner { progress, wall_clock: None }.run_to(&mut simulation, end).err();
        let exit = result::tell(request, &Ran::whole(&simulation, failure.as_ref()), Detail::of(self.json, true));
        if exit == Exit::Good && !self.json {
            let holding = match simulation.outcomes().len() {
                0 => "nothing is expected".to_owned(),
                many => count(many, "expectation holds", "expectations hold"),
            };
            return print_line(&format!("{}: good; {}; {holding}", request.name, contents(&simulation)));
        }
        exit
    }
}

/// What is in a scene.
fn contents(simulation: &Simulation) -> String {
    let bodies = simulation.bodies();
    let atoms = count(bodies.atom_count(), "atom", "atoms");
    let walls = count(bodies.walls.len(), "wall", "walls");
    format!("{}, {atoms}, {walls}", count(bodies.len(), "body", "bodies"))
}
