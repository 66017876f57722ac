//! Layers of a film: what plugins add to its pictures, as plain marks in the world.
//!
//! A layer is a function from the world to marks; it is called once for each frame, with the state at the end of the tick
//! in which the frame's time lies. It measures and never pushes. Without layers a film costs nothing more.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

/// Something drawn over the bodies. Lengths are in metres, line widths are the film's own.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its shape.
    pub shape: MarkShape,
    /// A name of the theme's palette (`"teal"`) or `"#rrggbb"`; `None`: the theme's ink.
    pub color: Option<String>,
}

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MarkShape {
    /// A line between two points.
    Line(DVec2, DVec2),
    /// A line with a head at its second point.
    Arrow(DVec2, DVec2),
    /// A circle by its centre and radius.
    Circle(DVec2, f64),
}

/// A layer: looks at the world and adds marks.
pub type Layer = fn(&World, &mut Vec<Mark>);

/// The layers of a film, from back to front.
#[derive(Resource, Default)]
pub struct Layers(Vec<Layer>);

impl Layers {
    /// The marks of all layers, from back to front.
    pub fn marks(world: &World) -> Vec<Mark> {
        let mut marks = Vec::new();
        for layer in world.get_resource::<Self>().map_or(&[][..], |layers| &layers.0) {
            layer(world, &mut marks);
        }
        marks
    }
}

/// How plugins add a layer.
pub trait FilmAppExt {
    /// Adds a layer in front of those before.
    fn add_layer(&mut self, layer: Layer) -> &mut Self;
}

impl FilmAppExt for App {
    fn add_layer(&mut self, layer: Layer) -> &mut Self {
        self.world_mut().get_resource_or_init::<Layers>().0.push(layer);
        self
    }
}
