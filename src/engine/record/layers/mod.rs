//! Layers of a film, one per file: plain marks in the world, beside bodies, walls and title.
//!
//! A layer reads the world and adds marks. It is called once for each frame, with the state at the end of the frame's
//! tick. It measures and never pushes. A layer that shows the past also reads the world between frames, at its rate. A
//! film pays only for its layers, and a run without pictures pays for none.

mod boxes;
mod contact_forces;
mod contact_points;
mod free_body;
mod inset;
mod joints;
mod names;
mod of_bodies;
mod scale;
mod scale_bar;
mod springs;
mod time;
mod trails;
mod velocities;

use bevy_app::App;
use bevy_ecs::prelude::*;

pub use jostle_frames::{Corner, Mark, MarkShape};

use crate::record::sections::look::LAYERS;
use crate::scene::values::Names;
use crate::scene::{Arity, Diagnostics, NameKind, Outline, SceneAppExt, install_word};
use crate::tick::State;
use crate::world::Bodies;

/// The built-in layers by the words of the command line, with their names in the scene, from back to front.
pub const WORDS: [(&str, &str); 11] = [
    ("trails", "Trails"),
    ("boxes", "Boxes"),
    ("springs", "Springs"),
    ("joints", "Joints"),
    ("velocities", "Velocities"),
    ("contacts", "ContactPoints"),
    ("forces", "ContactForces"),
    ("freebody", "FreeBody"),
    ("names", "Names"),
    ("scale", "ScaleBar"),
    ("time", "Time"),
];

/// Whether a film shows a layer if its scene names none.
fn is_default(layer: &str, outline: &Outline) -> bool {
    match layer {
        "ScaleBar" | "Time" => true,
        "Joints" => outline.has_section("joints"),
        "Springs" => outline.entries("forces").iter().any(|force| force.name.ends_with("Spring")),
        _ => false,
    }
}

/// Something that is drawn in each frame. Every function from the world to marks is one.
pub trait Layer: Send + Sync + 'static {
    /// Adds the marks of one frame.
    fn draw(&self, world: &World, marks: &mut Vec<Mark>);

    /// When the layer looks at the world between frames; `None`: never.
    fn memory(&self) -> Option<LayerMemory> {
        None
    }

    /// Looks at the world at the end of a tick.
    fn look(&mut self, _world: &World) {}
}

impl<F: Fn(&World, &mut Vec<Mark>) + Send + Sync + 'static> Layer for F {
    fn draw(&self, world: &World, marks: &mut Vec<Mark>) {
        self(world, marks);
    }
}

/// How a layer remembers, in seconds of physics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerMemory {
    /// From one look to the next.
    pub every: f64,
    /// The time before a frame, beyond which the past does not matter to it.
    pub length: f64,
}

/// The layers of a film, from back to front.
#[derive(Resource, Default)]
pub struct Layers(Vec<Box<dyn Layer>>);

impl Layers {
    /// The marks of all layers, from back to front.
    pub fn marks(world: &World) -> Vec<Mark> {
        let mut marks = Vec::new();
        for layer in world.get_resource::<Self>().map_or(&[][..], |layers| &layers.0) {
            layer.draw(world, &mut marks);
        }
        marks
    }

    /// The next tick after `seen` at which some layer reads the world, before a frame at `time` s. Ticks last `dt` s.
    pub(crate) fn next_look(world: &World, seen: Option<u64>, time: f64, dt: f64) -> Option<u64> {
        let layers = world.get_resource::<Self>()?;
        let next = |memory: LayerMemory| {
            let early = ((time - memory.length) / dt).floor().max(0.0) as u64;
            let from = seen.map_or(early, |seen| early.max(seen + 1));
            from.next_multiple_of(stride(memory, dt))
        };
        layers.0.iter().filter_map(|layer| layer.memory()).map(next).min()
    }

    /// Lets the layers look whose turn it is in this tick.
    pub(crate) fn look(world: &mut World, tick: u64, dt: f64) {
        let Some(mut layers) = world.remove_resource::<Self>() else { return };
        for layer in &mut layers.0 {
            if layer.memory().is_some_and(|memory| tick.is_multiple_of(stride(memory, dt))) {
                layer.look(world);
            }
        }
        world.insert_resource(layers);
    }
}

/// From one look to the next, in ticks.
fn stride(memory: LayerMemory, dt: f64) -> u64 {
    ((memory.every / dt).round() as u64).max(1)
}

/// How plugins add a layer.
pub trait FilmAppExt {
    /// Adds a layer in front of those before. Components are up to date when it looks at the world.
    fn add_layer(&mut self, layer: impl Layer) -> &mut Self;
}

impl FilmAppExt for App {
    fn add_layer(&mut self, layer: impl Layer) -> &mut Self {
        self.world_mut().get_resource_or_init::<State>().show_components();
        add_own_layer(self, layer);
        self
    }
}

/// Adds a layer that reads no pose and no velocity of a component.
fn add_own_layer(app: &mut App, layer: impl Layer) {
    app.world_mut().get_resource_or_init::<Layers>().0.push(Box::new(layer));
}

/// The height of a film's picture in metres. The recorder of a film sets it, so that arrows get visible lengths.
/// Absent: one metre.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct PictureHeight(pub f64);

impl PictureHeight {
    fn of(world: &World) -> f64 {
        world.get_resource::<Self>().map_or(1.0, |height| height.0)
    }
}

/// Which layers the caller wants beside those of the scene, by the words of [`WORDS`]; `None` and nothing: no change. An
/// empty list takes all away.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct WantedLayers(pub Option<Vec<String>>);

/// Installs the default layers if the scene names none, and the layers that the caller wants. The scene's layers have
/// been installed before.
pub(crate) fn install_wanted(outline: &Outline, app: &mut App) {
    let wanted = app.world_mut().remove_resource::<WantedLayers>().unwrap_or_default().0;
    if wanted.as_ref().is_some_and(Vec::is_empty) {
        app.world_mut().remove_resource::<Layers>();
        return;
    }
    let by_default = !outline.has_section(LAYERS);
    let wanted = wanted.unwrap_or_default();
    for (word, name) in WORDS {
        let named = outline.entries(LAYERS).iter().any(|mention| mention.name == name);
        let missing = by_default && is_default(name, outline) || wanted.iter().any(|wish| wish == word);
        if missing && !named {
            install_word(app, outline, LAYERS, name);
        }
    }
}

/// Registers the layers of this folder, from back to front.
pub fn plugin(app: &mut App) {
    app.register_entry_section(LAYERS, Arity::Words, "layers: [Trails(seconds: 1), ContactForces, ScaleBar, Time]");
    app.describe_section(LAYERS, "The layers beside bodies, walls and title. `--layers` chooses others for one film.");
    trails::plugin(app);
    boxes::plugin(app);
    springs::plugin(app);
    joints::plugin(app);
    velocities::plugin(app);
    contact_points::plugin(app);
    contact_forces::plugin(app);
    free_body::plugin(app);
    names::plugin(app);
    inset::plugin(app);
    scale_bar::plugin(app);
    time::plugin(app);
}

/// The bodies that a layer shows: those named, or all that move.
#[derive(Clone, Debug, Default)]
struct Shown(Option<Vec<u64>>);

impl Shown {
    /// Reports names that fit no body.
    fn check(of: Option<&Names>, outline: &Outline, report: &mut Diagnostics) {
        if let Some(names) = of {
            names.require(NameKind::BODY, outline, "of", report);
        }
    }

    /// The keys of a scene's bodies are their places in the outline.
    fn new(of: Option<&Names>, outline: &Outline) -> Self {
        Self(of.map(|names| names.matching(NameKind::BODY, outline).into_iter().map(|index| index as u64).collect()))
    }

    /// Places of the bodies in canonical order.
    fn indices<'a>(&'a self, bodies: &'a Bodies) -> impl Iterator<Item = usize> + 'a {
        (0..bodies.len()).filter(|&index| match &self.0 {
            Some(keys) => keys.binary_search(&bodies.key.at(index)).is_ok(),
            None => bodies.moves[index],
        })
    }
}
