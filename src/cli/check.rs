//! `jostle check`: reads scenes and reports their mistakes.

use clap::Args;

use super::film_times::Misfit;
use super::flags::{OverrideFlags, StrictFlag};
use super::interrupt;
use super::load::Request;
use super::pace::{Ended, Runner};
use super::progress_bar::Progress;
use super::result::{self, Detail, Ran};
use super::say::{count, print_json, print_line, say};
use super::{Exit, colors};
use crate::scene::{Source, number};
use crate::simulation::{Overrides, Simulation};
use crate::world::Name;
use crate::world::anchor::{Anchor, Anchors};

/// The command `check`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Check {
    /// Scene files, or example:NAME for a scene that comes with the program
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Also run each scene and check its expectations
    #[arg(long)]
    run: bool,
    #[command(flatten)]
    overrides: OverrideFlags,
    #[command(flatten)]
    strict: StrictFlag,
    /// Show messages only if something is wrong
    #[arg(long)]
    quiet: bool,
    /// Print for each scene one line of JSON on standard output: its mistakes, or with --run its result
    #[arg(long)]
    json: bool,
}

/// More anchors are told by `--json` alone.
const MOST_ANCHORS: usize = 12;

const EXAMPLES: &str = "\
Examples:
  jostle check my.ron                 every mistake with its line and a remedy
  jostle check --run scenes/*.ron     does each scene do what it says under `expect`?
  jostle check --quiet scenes/*.ron   print mistakes only; the exit code is 0 if there are none";

impl Check {
    pub(super) fn execute(self) -> Exit {
        if self.strict.strict && !self.run {
            say("error: --strict is about runs: add --run");
            return Exit::Usage;
        }
        let check = |name: &String| {
            interrupt::disarm();
            let request = Request { name, json: self.json, silent: self.quiet || self.json };
            let overrides = Overrides { untried: !self.run, ..self.overrides.overrides() };
            match request.load(&self.overrides.settings, &overrides) {
                Err(exit) => exit,
                Ok((source, simulation)) => match refused_by_render(request, &source, &simulation) {
                    Some(exit) => exit,
                    None => self.tell(request, simulation),
                },
            }
        };
        let wanted = self.scenes.iter().take_while(|_| !interrupt::asked());
        wanted.map(check).fold(Exit::Good, Exit::worse)
    }

    fn tell(&self, request: Request, simulation: Simulation) -> Exit {
        let name = request.name;
        if self.run {
            return self.run(request, simulation);
        }
        let notes = simulation.notes();
        let anchors = anchors(&simulation);
        if self.json {
            let anchors: Vec<_> = anchors.iter().map(Seen::json).collect();
            let told = serde_json::json!({ "scene": name, "errors": [], "notes": notes, "anchors": anchors });
            return print_json(&told);
        }
        if self.quiet {
            return Exit::Good;
        }
        for note in notes {
            say(&format!("note: {name}: {note}"));
        }
        for anchor in anchors.iter().take(MOST_ANCHORS) {
            say(&format!("anchor: {name}: {}", anchor.told()));
        }
        if anchors.len() > MOST_ANCHORS {
            let more = count(anchors.len() - MOST_ANCHORS, "more anchor", "more anchors");
            say(&format!("anchor: {name}: and {more}, which --json tells"));
        }
        print_line(&format!("{name}: good; {}", contents(&simulation)))
    }

    fn run(&self, request: Request, mut simulation: Simulation) -> Exit {
        let progress = Progress::new(simulation.ticks(), "ticks", self.quiet || self.json);
        let end = simulation.ticks();
        interrupt::arm();
        interrupt::reach_into(&mut simulation);
        let failure = match (Runner { progress, wall_clock: None }).run_to(&mut simulation, end) {
            Err(Ended::Wrong(failure)) => Some(failure),
            Ok(()) | Err(Ended::Interrupted) => None,
        };
        let ran = Ran { strict: self.strict.strict, ..Ran::whole(&simulation, failure.as_ref()) };
        let exit = result::tell(request, &ran, Detail::of(self.json, true));
        if exit == Exit::Good && !self.json && !self.quiet {
            let holding = match simulation.outcomes().len() {
                0 => "it has no expectations".to_owned(),
                many => count(many, "expectation holds", "expectations hold"),
            };
            return print_line(&format!("{}: good; {}; {holding}", request.name, contents(&simulation)));
        }
        exit
    }
}

/// An anchor, and where it is at the start.
struct Seen {
    path: String,
    /// `None`: the world.
    body: Option<String>,
    position: [f64; 2],
    /// Smaller coordinates are rounding.
    rounding: f64,
    given: bool,
}

impl Seen {
    fn told(&self) -> String {
        let shown = |place: f64| number(if place.abs() <= self.rounding { 0.0 } else { place });
        let [x, y] = self.position.map(shown);
        let body = self.body.as_ref().map_or_else(|| "the world".to_owned(), |body| format!("`{body}`"));
        let default = if self.given { "" } else { ", by default" };
        format!("`{}` on {body} is at ({x}, {y}) m at the start{default}", self.path)
    }

    fn json(&self) -> serde_json::Value {
        let Self { path, body, position, given, .. } = self;
        serde_json::json!({ "path": path, "body": body, "position": position, "default": !given })
    }
}

fn anchors(simulation: &Simulation) -> Vec<Seen> {
    let (world, bodies) = (simulation.unpublished_world(), simulation.bodies());
    let seen = |anchor: &Anchor| {
        Some(Seen {
            path: anchor.path.clone(),
            body: anchor.body.map(|body| world.get::<Name>(body).map(Name::to_string).unwrap_or_default()),
            position: anchor.position(bodies)?.to_array(),
            rounding: anchor.rounding(bodies),
            given: anchor.given,
        })
    };
    simulation.get_resource::<Anchors>().map_or_else(Vec::new, |anchors| anchors.0.iter().filter_map(seen).collect())
}

/// Mistakes for which only `render` refuses a scene: an unknown theme, and moments that are not in the run.
fn refused_by_render(request: Request, source: &Source, simulation: &Simulation) -> Option<Exit> {
    let theme = colors::theme(request, source, simulation, None).err();
    theme.or_else(|| Misfit::of(simulation).map(|misfit| misfit.refuse(request, simulation, Exit::SceneWrong)))
}

/// The contents of a scene.
fn contents(simulation: &Simulation) -> String {
    let bodies = simulation.bodies();
    let atoms = count(bodies.atom_count(), "atom", "atoms");
    let walls = count(bodies.wall_count(), "wall", "walls");
    format!("{}, {atoms}, {walls}", count(bodies.len(), "body", "bodies"))
}
