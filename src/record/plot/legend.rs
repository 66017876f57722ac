//! What the colours of a film mean, and a few facts of its scene.

use bevy_app::App;
use bevy_ecs::prelude::*;

use crate::forces::gravity::Gravity;
use crate::simulation::Simulation;
use crate::world::{Body, Materials, Motion, Name};

/// A legend: entries, and lines of facts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Legend {
    /// Bodies first, then what layers draw.
    pub entries: Vec<LegendEntry>,
    /// Short lines on the scene: how many bodies, gravity, tick.
    pub facts: Vec<String>,
}

/// One line of a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendEntry {
    /// What it is.
    pub label: String,
    /// What it looks like.
    pub mark: LegendMark,
}

/// What stands before a line of a legend.
#[derive(Clone, Debug, PartialEq)]
pub enum LegendMark {
    /// A patch in the colour of the body at this place of the cast.
    Body(usize),
    /// An arrow in a colour of the theme, or `"#rrggbb"`; `None`: ink.
    Arrow(Option<String>),
    /// A line; see [`LegendMark::Arrow`].
    Line(Option<String>),
    /// A ring; see [`LegendMark::Arrow`].
    Ring(Option<String>),
}

/// What plugins add to the legend.
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

impl Legend {
    /// The legend of a scene at its beginning.
    ///
    /// Bodies of one material with a colour of its own look alike, so they share a line; a material of a single body
    /// goes by the body's name. Fixed bodies stand last.
    pub fn of(simulation: &Simulation) -> Legend {
        let (world, bodies) = (simulation.world(), simulation.bodies());
        let materials = world.get_resource::<Materials>();
        let mut lines: Vec<Line> = Vec::new();
        let mut moving = 0;
        for place in 0..bodies.len() {
            let fixed = world.get::<Body>(bodies.entity[place]).is_some_and(|body| body.motion == Motion::Fixed);
            moving += usize::from(!fixed);
            let material = bodies.atoms_of(place).next().map(|first| bodies.atom_material[first]);
            let shared = material.and_then(|index| {
                let materials = materials?;
                materials.by_index.get(index.place())?.color.as_ref()?;
                materials.names.get(index.place()).cloned()
            });
            let known = lines.iter_mut().find(|line| shared.is_some() && line.shared == shared && line.fixed == fixed);
            if let Some(line) = known {
                line.bodies += 1;
            } else {
                let name = world.get::<Name>(bodies.entity[place]).map(|name| name.0.clone()).unwrap_or_default();
                lines.push(Line { name, shared, fixed, place, bodies: 1 });
            }
        }
        lines.sort_by_key(|line| line.fixed);
        let entry = |line: Line| LegendEntry {
            label: match line.shared {
                Some(material) if line.bodies > 1 => material,
                _ => line.name,
            },
            mark: LegendMark::Body(line.place),
        };
        let added = world.get_resource::<Added>().map_or(&[][..], |added| &added.0);
        let entries = lines.into_iter().map(entry).chain(added.iter().cloned()).collect();
        Legend { entries, facts: facts(simulation, moving) }
    }
}

struct Line {
    name: String,
    /// The material whose bodies share the line.
    shared: Option<String>,
    fixed: bool,
    place: usize,
    bodies: usize,
}

fn facts(simulation: &Simulation, moving: usize) -> Vec<String> {
    let (world, bodies) = (simulation.world(), simulation.bodies());
    let count = |number: usize, one: &str, many: &str| format!("{number} {}", if number == 1 { one } else { many });
    let mut things = vec![count(moving, "body", "bodies")];
    if bodies.len() > moving {
        things.push(format!("{} fixed", bodies.len() - moving));
    }
    things.push(count(bodies.atom_radius.len(), "atom", "atoms"));
    let mut numbers = Vec::new();
    if let Some(gravity) = world.get_resource::<Gravity>() {
        numbers.push(format!("g = {} m/s²", brief(gravity.0.length())));
    }
    let tick = simulation.clock().dt;
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
