//! The anatomy of a scene: the entries that it names, the systems of a tick, the time of each stage.

use crate::SimulationExt;
use crate::cli::paths::handed_on;
use bevy_ecs::prelude::World;
use std::fmt::Write;
use std::time::{Duration, Instant};

use serde_json::json;

use jostle_language::numbers::percentage;

use crate::cli::Exit;
use crate::cli::author;
use crate::cli::flags::OverrideFlags;
use crate::cli::load::Request;
use crate::cli::say::{count, number};
use crate::report::Card;
use crate::scene::{RegisteredName, SceneRegistry};
use crate::simulation::{Overrides, Simulation};
use crate::tick::Failure;
use crate::tick::State;
use crate::tick::stopwatch::{self, TickPart};

/// The duration of the run without looks at the clock, which gives their cost.
const PLAIN: Duration = Duration::from_millis(500);
/// The longest duration of the run with looks at the clock around each stage.
const WATCHED: Duration = Duration::from_millis(2500);
/// Fewer ticks have no first and last tenth to be compared.
const FEWEST_TICKS: u64 = 100;

/// The findings about a scene.
pub(super) struct Anatomy {
    title: Option<String>,
    things: String,
    named: Vec<Named>,
    card: Card,
    /// Ticks that were looked at, from the first on, and those of the whole run.
    ticks: u64,
    all_ticks: u64,
    atoms: usize,
    pairs: (usize, usize),
    /// The search for pairs, and the mean number of evaluations for which its lists held.
    search: Option<(&'static str, f64)>,
    /// Seconds per tick of a run without looks at the clock.
    per_tick: f64,
    /// The same in the first and in the last tenth of the ticks; nothing, if they are few.
    tenths: Option<[f64; 2]>,
    /// The cost of looks at the clock, as a share of a tick.
    slower: f64,
    parts: Vec<Stage>,
    failure: Option<String>,
}

/// A section of the scene, or an entry of one, and the module that reads it.
struct Named {
    name: String,
    from: String,
}

/// A part of the tick.
struct Stage {
    name: &'static str,
    share: f64,
    systems: Vec<System>,
}

/// A system, its module, and what in the scene it is there for, if that is known.
struct System {
    name: String,
    module: String,
    serves: Option<String>,
}

impl Anatomy {
    /// Runs a scene twice and looks at it.
    pub fn of(request: Request, flags: &OverrideFlags) -> Result<Self, Exit> {
        let (source, mut plain) = request.load(&flags.settings, &flags.overrides())?;
        let mut failure = run_for(&mut plain, u64::MAX, PLAIN, &mut Vec::new()).err();
        let common = plain.clock().ticks;
        let overrides = Overrides { plan: plain.plan().cloned(), ..flags.overrides() };
        let mut watched = Simulation::load_with(&source, &overrides, author::plugin)
            .map_err(|errors| request.refuse_scene(&errors))?;
        stopwatch::watch(watched.world_mut());
        // It fails where the other one did.
        let mut marks = vec![(0, 0.0)];
        let mut ran = run_for(&mut watched, common, Duration::MAX, &mut marks);
        let slower = (watched.seconds_spent() / plain.seconds_spent().max(1e-9) - 1.0).max(0.0);
        if ran.is_ok() && failure.is_none() {
            ran = run_for(&mut watched, u64::MAX, WATCHED, &mut marks);
        }
        failure = ran.err().or(failure);
        let ticks = watched.clock().ticks;
        let known = known_in(&watched);
        let parts = stages(watched.world(), &known);
        let pairs = watched.resource::<State>().pairs();
        Ok(Self {
            title: watched.header().title.clone(),
            things: things(&watched),
            named: named(&watched),
            card: watched.card(),
            ticks,
            all_ticks: watched.ticks(),
            atoms: watched.bodies().atom_count(),
            pairs: pairs.map_or((0, 0), |pairs| (pairs.atoms.len(), pairs.surfaces.len())),
            search: pairs.map(|pairs| {
                let evaluations = watched.resource::<State>().evaluation().count;
                (pairs.search.told(), evaluations as f64 / pairs.version.max(1) as f64)
            }),
            per_tick: watched.seconds_spent() / (1.0 + slower) / ticks.max(1) as f64,
            tenths: tenths(&marks, ticks).map(|tenths| tenths.map(|seconds| seconds / (1.0 + slower))),
            slower,
            parts,
            failure: failure.map(|failure| failure.to_string()),
        })
    }

    /// The part of the run to which the numbers belong.
    fn looked_at(&self) -> String {
        let (ticks, all) = (self.ticks, self.all_ticks);
        if ticks == all {
            return format!("mean of all {} of the run", count(ticks as usize, "tick", "ticks"));
        }
        let time = |ticks: u64| number(rounded(ticks as f64 * self.card.tick));
        format!("mean of the first {ticks} of {all} ticks, {} of {} s", time(ticks), time(all))
    }

    /// In words.
    pub fn told(&self, scene: &str) -> String {
        let card = &self.card;
        let mut text = format!("{scene}: {}\n", self.title.as_deref().unwrap_or("a scene without a title"));
        let mut row = |label: &str, what: &str| {
            let _ = writeln!(text, "  {label:<10}{what}");
        };
        row("things", &self.things);
        row("method", &card.method);
        let critical = card.critical_tick.map_or_else(String::new, |critical| {
            format!(", {} of the critical tick of {} s", percentage(card.tick / critical), number(rounded(critical)))
        });
        row("tick", &format!("{} s{critical}", number(card.tick)));
        for note in &card.notes {
            row("note", note);
        }
        if let Some(failure) = &self.failure {
            row("failed", failure);
        }
        let width = self.named.iter().map(|named| named.name.len()).max().unwrap_or(0);
        let _ = writeln!(text, "\nThe names in the scene, and the modules that read them:");
        for Named { name, from } in &self.named {
            let _ = writeln!(text, "  {name:<width$}  {from}");
        }
        let pairs = match self.pairs {
            (0, 0) => String::new(),
            (atoms, walls) => format!(
                "; in the end {} were near each other, {walls} near walls",
                count(atoms, "pair of atoms", "pairs of atoms")
            ),
        };
        let _ = writeln!(
            text,
            "\nOne tick takes {} us, {:.1} ns per atom ({}{pairs}):",
            number(rounded(self.per_tick * 1e6)),
            self.per_tick * 1e9 / self.atoms.max(1) as f64,
            self.looked_at(),
        );
        if let Some([first, last]) = self.tenths.map(|tenths| tenths.map(|seconds| number(rounded(seconds * 1e6)))) {
            let _ = writeln!(text, "  The first tenth of these ticks took {first} us each, the last tenth {last} us.");
        }
        if self.ticks < self.all_ticks && self.failure.is_none() {
            let _ = writeln!(text, "  Later ticks may cost more or less: `jostle run` takes them all.");
        }
        if let Some((search, lasted)) = self.search {
            let _ = writeln!(
                text,
                "  The search for pairs is {search}. A list lasted {lasted:.0} evaluations in the mean."
            );
        }
        let _ = writeln!(text, "  {:<20}{:>7}{:>12}   systems, in order", "stage", "share", "us");
        for Stage { name, share, systems } in &self.parts {
            let spent = number(rounded(share * self.per_tick * 1e6));
            let _ = write!(text, "  {name:<20}{:>5.1} %{spent:>12}   ", share * 100.0);
            let mut lines: Vec<String> = systems.iter().map(System::told).collect();
            if lines.is_empty() {
                lines.push("(no system: what is left is the schedule)".to_owned());
            }
            let _ = writeln!(text, "{}", lines.join(&format!("\n{:44}", "")));
        }
        let _ = writeln!(
            text,
            "Looking at the clock around each stage made the ticks {:.0} % slower. The shares are those of that run.",
            self.slower * 100.0
        );
        text
    }

    /// For programs.
    pub fn to_json(&self, scene: &str) -> serde_json::Value {
        let system = |system: &System| json!({ "name": system.name, "module": system.module, "serves": system.serves });
        let stage = |stage: &Stage| {
            let systems: Vec<_> = stage.systems.iter().map(system).collect();
            json!({ "stage": stage.name, "share": stage.share, "systems": systems })
        };
        json!({
            "scene": scene,
            "title": self.title,
            "things": self.things,
            "named": self.named.iter().map(|named| json!({ "name": named.name, "from": named.from })).collect::<Vec<_>>(),
            "method": self.card.method,
            "tick": self.card.tick,
            "critical_tick": self.card.critical_tick,
            "notes": self.card.notes,
            "failure": self.failure,
            "ticks": self.ticks,
            "ticks_of_run": self.all_ticks,
            "pairs_of_atoms": self.pairs.0,
            "atoms_near_walls": self.pairs.1,
            "search": self.search.map(|(search, lasted)| json!({ "how": search, "evaluations_per_list": lasted })),
            "seconds_per_tick": self.per_tick,
            "seconds_per_tick_of_tenths": self.tenths.map(|[first, last]| json!({ "first": first, "last": last })),
            "ns_per_atom_tick": self.per_tick * 1e9 / self.atoms.max(1) as f64,
            "slower_when_watched": self.slower,
            "stages": self.parts.iter().map(stage).collect::<Vec<_>>(),
        })
    }
}

/// The least duration of a batch of ticks, between two marks.
const BATCH: Duration = Duration::from_millis(3);

/// Runs until a tick, or until the scene or the time is over. On the way it marks ticks and seconds spent.
fn run_for(
    simulation: &mut Simulation,
    until: u64,
    time: Duration,
    marks: &mut Vec<(u64, f64)>,
) -> Result<(), Failure> {
    let (start, until) = (Instant::now(), until.min(simulation.ticks()));
    let mut batch = 1;
    while simulation.clock().ticks < until && start.elapsed() < time {
        let begin = Instant::now();
        simulation.run_to_tick(simulation.clock().ticks.saturating_add(batch).min(until))?;
        marks.push((simulation.clock().ticks, simulation.seconds_spent()));
        if begin.elapsed() < BATCH {
            batch = batch.saturating_mul(2);
        }
    }
    Ok(())
}

/// Seconds per tick in the first and in the last tenth of ticks, between the marks nearest to their ends.
fn tenths(marks: &[(u64, f64)], ticks: u64) -> Option<[f64; 2]> {
    let nearest = |tick: u64| marks.iter().min_by_key(|(marked, _)| marked.abs_diff(tick)).copied();
    let between = |from: u64, to: u64| {
        let ((begin, early), (end, late)) = (nearest(from)?, nearest(to)?);
        (end > begin).then(|| (late - early) / (end - begin) as f64)
    };
    if ticks < FEWEST_TICKS {
        return None;
    }
    Some([between(0, ticks / 10)?, between(ticks - ticks / 10, ticks)?])
}

/// Three digits are enough of what was measured.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

fn things(simulation: &Simulation) -> String {
    let bodies = simulation.bodies();
    let moving = bodies.dynamic.iter().filter(|dynamic| **dynamic).count();
    let led = match bodies.len() - moving {
        0 => String::new(),
        led => format!(" ({moving} moved by forces, {led} fixed or led)"),
    };
    format!(
        "{}{led}, {}, {}",
        count(bodies.len(), "body", "bodies"),
        count(bodies.atom_count(), "atom", "atoms"),
        count(bodies.wall_count(), "wall", "walls")
    )
}

/// The sections of the scene in the order of the file, their entries instead of those that take some.
fn named(simulation: &Simulation) -> Vec<Named> {
    let outline = &simulation.header().outline;
    let registry = simulation.resource::<SceneRegistry>();
    let sections = registry.sections();
    let mut named = Vec::new();
    for section in outline.sections() {
        let known = sections.iter().find(|known| known.name == section);
        let entries = outline.entries(section);
        if entries.is_empty() {
            named.push(Named {
                name: section.to_owned(),
                from: known.map_or_else(String::new, |known| handed_on(known.origin)),
            });
        }
        let readers = registry.entries(section);
        let mut before: Vec<&str> = Vec::new();
        for mention in entries.iter().map(|mention| mention.name.as_str()) {
            if before.contains(&mention) {
                continue;
            }
            before.push(mention);
            let many = entries.iter().filter(|other| other.name == mention).count();
            let times = if many > 1 { format!(" (x {many})") } else { String::new() };
            let from = readers
                .iter()
                .find(|known| known.name == mention)
                .map_or_else(String::new, |known| handed_on(known.origin));
            named.push(Named { name: format!("{section}: {mention}{times}"), from });
        }
    }
    named
}

/// The sections and entries that the scene names, with the modules that read them.
fn known_in(simulation: &Simulation) -> Vec<(String, RegisteredName)> {
    let outline = &simulation.header().outline;
    let registry = simulation.resource::<SceneRegistry>();
    let mut known = Vec::new();
    for section in registry.sections() {
        for entry in registry.entries(section.name) {
            let there = outline.entries(section.name).iter().any(|mention| mention.name == entry.name);
            let by_default = section.name == "contacts" && !outline.has_section(section.name);
            if there || by_default {
                let default = if by_default { " (by default)" } else { "" };
                known.push((format!("{}: {}{default}", section.name, entry.name), entry));
            }
        }
        if !section.takes_entries && outline.has_section(section.name) {
            known.push((section.name.to_owned(), section));
        }
    }
    known
}

fn stages(world: &World, known: &[(String, RegisteredName)]) -> Vec<Stage> {
    let Some(watch) = world.resource::<State>().stopwatch() else { return Vec::new() };
    let spent = |part: TickPart| watch.spent(part).as_secs_f64();
    // Between two ticks only the loop runs, so that time belongs to no stage.
    let in_ticks = |part: &TickPart| *part != TickPart::Between;
    let all: f64 = TickPart::ALL.into_iter().filter(in_ticks).map(spent).sum();
    let systems = stopwatch::systems(world);
    let stage = |(part, names): (TickPart, Vec<String>)| Stage {
        name: part.name(),
        share: if all > 0.0 { spent(part) / all } else { 0.0 },
        systems: names.iter().map(|name| System::named(name, known)).collect(),
    };
    let wanted = |(part, names): &(TickPart, Vec<String>)| in_ticks(part) && (spent(*part) > 0.0 || !names.is_empty());
    systems.into_iter().filter(wanted).map(stage).collect()
}

impl System {
    /// A system by its full name, such as `jostle::forces::gravity::apply_gravity`.
    fn named(full: &str, known: &[(String, RegisteredName)]) -> Self {
        let full = handed_on(full);
        let (path, types) = full.split_once('<').unwrap_or((&full, ""));
        let (module, name) = path.rsplit_once("::").unwrap_or(("", path));
        let types: Vec<&str> = types
            .trim_end_matches('>')
            .split(',')
            .map(|part| part.rsplit("::").next().unwrap_or(part).trim_end_matches('>'))
            .filter(|part| !part.is_empty())
            .collect();
        let types = if types.is_empty() { String::new() } else { format!("<{}>", types.join(", ")) };
        let within = |(_, known): &&(String, RegisteredName)| {
            module.strip_prefix(&*handed_on(known.origin)).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
        };
        let nearest = known.iter().filter(within).max_by_key(|(_, known)| known.origin.len());
        Self {
            name: format!("{name}{types}"),
            module: module.to_owned(),
            serves: nearest.map(|(what, _)| what.clone()),
        }
    }

    fn told(&self) -> String {
        let serves = self.serves.as_ref().map_or_else(String::new, |serves| format!(", for `{serves}`"));
        format!("{} ({}{serves})", self.name, self.module)
    }
}

#[cfg(test)]
mod tests {
    use super::tenths;

    /// Tick k costs k us. So in the first tenth of a thousand ticks the mean cost is 50 us, in the last 950 us.
    #[test]
    fn the_tenths_of_a_run_that_grows_dear_differ() {
        let marks: Vec<(u64, f64)> = (0..=1000).step_by(20).map(|tick| (tick, 0.5e-6 * (tick * tick) as f64)).collect();
        let [first, last] = tenths(&marks, 1000).expect("enough ticks");
        assert!((first - 50e-6).abs() < 1e-12 && (last - 950e-6).abs() < 1e-12, "{first} {last}");
        assert_eq!(tenths(&marks, 50), None);
    }
}
