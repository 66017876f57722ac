//! The legend of a film: its colours, and a few facts of its scene.

use std::collections::{BTreeMap, BTreeSet};

use bevy_app::App;
use bevy_ecs::prelude::*;

use jostle_frames::plot::{Legend, LegendEntry, LegendMark};

use crate::scene::count;
use crate::tick::State;
use crate::world::{Body, Materials, Motion, Name};

/// Lines of bodies that are kept.
const MOST_LINES: usize = 24;

/// The entries that plugins add to the legend.
#[derive(Resource, Default)]
struct Added(Vec<LegendEntry>);

/// How plugins explain the marks of their layers.
pub trait LegendAppExt {
    /// Adds a line to the legend of films that have one.
    fn add_legend(&mut self, entry: LegendEntry) -> &mut Self;
}

impl LegendAppExt for App {
    fn add_legend(&mut self, entry: LegendEntry) -> &mut Self {
        self.world_mut().get_resource_or_init::<Added>().0.push(entry);
        self
    }
}

/// The legend of a scene at its beginning.
///
/// Bodies of one material with its own colour look alike, so they share a line. A material of a single body has the
/// body's name in the line. Fixed bodies stand last.
pub fn legend(world: &World) -> Legend {
    let bodies = &world.resource::<State>().bodies;
    let materials = world.get_resource::<Materials>();
    let mut lines: Vec<Line> = Vec::new();
    let mut known_lines: BTreeMap<(String, bool), usize> = BTreeMap::new();
    let mut moving = 0;
    for index in 0..bodies.len() {
        let fixed = world.get::<Body>(bodies.entity[index]).is_some_and(|body| body.motion == Motion::Fixed);
        moving += usize::from(!fixed);
        let material = bodies.atoms_of(index).next().map(|first| bodies.atom_material(first));
        let shared = material.and_then(|material| {
            let materials = materials?;
            materials.by_index.get(material.index())?.color.as_ref()?;
            materials.names.get(material.index()).cloned()
        });
        let known = shared.as_ref().and_then(|material| known_lines.get(&(material.clone(), fixed)).copied());
        if let Some(line) = known {
            lines[line].bodies += 1;
            continue;
        }
        if let Some(material) = &shared {
            known_lines.insert((material.clone(), fixed), lines.len());
        }
        let name = world.get::<Name>(bodies.entity[index]).map(Name::to_string).unwrap_or_default();
        lines.push(Line { name, shared, fixed, index, bodies: 1 });
    }
    lines.sort_by_key(|line| line.fixed);
    // Fixed and moving bodies of a material have a line each.
    let moving_too: BTreeSet<String> =
        known_lines.keys().filter(|(_, fixed)| !fixed).map(|(material, _)| material.clone()).collect();
    let entry = |line: Line| LegendEntry {
        label: match line.shared {
            Some(material) if line.bodies > 1 && line.fixed && moving_too.contains(&material) => {
                format!("{material}, fixed")
            }
            Some(material) if line.bodies > 1 => material,
            _ => line.name,
        },
        mark: LegendMark::Body(line.index),
    };
    let added = world.get_resource::<Added>().map_or(&[][..], |added| &added.0);
    let more = lines.len().saturating_sub(MOST_LINES);
    lines.truncate(MOST_LINES);
    let entries = lines.into_iter().map(entry).chain(added.iter().cloned()).collect();
    Legend { entries, more, facts: facts(world, moving) }
}

struct Line {
    name: String,
    /// The material whose bodies share the line.
    shared: Option<String>,
    fixed: bool,
    index: usize,
    bodies: usize,
}

fn facts(world: &World, moving: usize) -> Vec<String> {
    let bodies = &world.resource::<State>().bodies;
    let mut things = vec![count(moving, "body", "bodies")];
    if bodies.len() > moving {
        things.push(format!("{} fixed", bodies.len() - moving));
    }
    things.push(count(bodies.atom_radius.len(), "atom", "atoms"));
    let mut numbers = Vec::new();
    if let Some(gravity) = bodies.field {
        numbers.push(format!("g = {} m/s²", brief(gravity.length())));
    }
    let tick = world.resource::<State>().clock.dt;
    let (tick, unit) = match tick {
        tick if tick < 1e-3 => (tick * 1e6, "µs"),
        tick if tick < 1.0 => (tick * 1e3, "ms"),
        tick => (tick, "s"),
    };
    numbers.push(format!("Δt = {} {unit}", brief(tick)));
    vec![things.join(" · "), numbers.join("   ")]
}

/// A number in three digits.
fn brief(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Source;

    #[test]
    fn bodies_that_look_alike_share_a_line_and_fixed_ones_stand_last() {
        let scene = r#"Scene(
            format: 1, clock: (duration: 1, tick: "0.5 ms"), gravity: (3, -4),
            materials: { "gas": (color: "sky"), "peg": (color: "grey"), "lone": (color: "teal"), "plain": () },
            bodies: [
                (name: "pegs", fixed: true, at: (0, 0), material: "peg", atoms: List([(at: (0, 0), radius: 1), (at: (3, 0), radius: 1)])),
                (name: "first", at: (9, 0), material: "lone", atoms: Disc(radius: 0.1)),
                (name: "second", at: (9, 3), material: "plain", atoms: Disc(radius: 0.1)),
                (name: "third", at: (9, 6), material: "plain", atoms: Disc(radius: 0.1)),
            ],
            fill: [(name: "gas", atoms: Disc(radius: 0.1), material: "gas", count: 20, within: ((-9, 2), (9, 9)), seed: 1)],
        )"#;
        let arrow = LegendEntry { label: "contact force".into(), mark: LegendMark::Arrow(Some("red".into())) };
        let added = arrow.clone();
        let simulation =
            crate::Simulation::load_with(&Source::new("legend.ron", scene), &Default::default(), move |app| {
                app.add_legend(added.clone());
            });
        let legend = super::legend(simulation.unwrap_or_else(|errors| panic!("{errors}")).unpublished_world());
        let line = |label: &str, index| LegendEntry { label: label.into(), mark: LegendMark::Body(index) };
        // Bodies without a colour of their own get one each, so they have a line each.
        let bodies = [line("first", 1), line("second", 2), line("third", 3), line("gas", 4), line("pegs", 0)];
        assert_eq!(legend.entries, [&bodies[..], &[arrow]].concat());
        assert_eq!(legend.facts, ["23 bodies · 1 fixed · 25 atoms", "g = 5 m/s²   Δt = 500 µs"]);
    }
}
