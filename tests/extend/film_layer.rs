//! A film layer from outside: marks are drawn where they lie, in front of the bodies, and nowhere else.
//!
//! Tolerance: a line of 2.2 pixels at 1280 x 720 is drawn at 640 x 360 with 1.1 pixels, smoothed over its neighbours: within
//! two pixels of the mark. An arrow with its halo is 2.9 line widths wide: within 1.6 pixels and the neighbours. Its head
//! reaches 6.3 line widths back and 3.5 aside, 7.9 pixels, and as much more. Not tested: how smoothing rounds.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle::Simulation;
use jostle::raster::{Camera, Painter, Scratch, Theme, View};
use jostle::record::frame::Frame;
use jostle::record::{FilmAppExt, Mark, MarkShape};
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::simulation::Recorder;
use jostle::world::{Body, Position};

const SCENE: &str = "Scene(format: 1, clock: (duration: 1, tick: 1e-3), bodies: [
    (name: \"ball\", at: (0, 0), velocity: (1, 0), atoms: Disc(radius: 0.3))])";

const SHAPES: [MarkShape; 3] = [
    MarkShape::Line(DVec2::new(-1.0, 0.5), DVec2::new(1.0, 0.6)),
    MarkShape::Arrow(DVec2::new(-1.0, -0.5), DVec2::new(-0.4, -0.8)),
    MarkShape::Circle(DVec2::new(1.0, -0.5), 0.2),
];

fn fixed_marks(_: &World, marks: &mut Vec<Mark>) {
    marks.extend(SHAPES.map(|shape| Mark { shape, color: Some("red".to_owned()) }));
}

/// A ring that goes with each body.
fn rings(world: &World, marks: &mut Vec<Mark>) {
    let Some(mut bodies) = world.try_query_filtered::<&Position, With<Body>>() else { return };
    marks.extend(bodies.iter(world).map(|position| Mark { shape: MarkShape::Circle(position.0, 0.1), color: None }));
}

fn frame(plugins: fn(&mut App), time: f64) -> Frame {
    let source = Source::new("film.ron", SCENE);
    let mut simulation = Simulation::load_with(&source, &Overrides::default(), plugins).expect("a correct scene");
    Recorder::default().frame(&mut simulation, time).expect("numbers stay finite")
}

fn camera() -> Camera {
    Camera::look(DVec2::ZERO, 2.0, (640, 360))
}

/// Pixels in which two frames differ, as places in the world, with the colour that the first one has there.
fn differences(a: &Frame, b: &Frame) -> Vec<(DVec2, [u8; 3])> {
    let camera = camera();
    let view = View { camera, theme: Theme::named("paper").expect("it is there"), frame_step: 0.1, panel: None };
    let paint = |frame: &Frame| {
        let painter = Painter::new(&view, frame).expect("a picture");
        let mut picture = painter.backdrop().clone();
        painter.paint(frame, &mut picture, &mut Scratch::default());
        picture
    };
    let (a, b) = (paint(a), paint(b));
    let origin = camera.to_picture(DVec2::ZERO);
    let mut found = Vec::new();
    for (index, (a, b)) in a.pixels().iter().zip(b.pixels()).enumerate() {
        if a != b {
            let pixel = DVec2::new((index % 640) as f64 + 0.5, (index / 640) as f64 + 0.5) - origin;
            let world = DVec2::new(pixel.x, -pixel.y) / camera.pixels_per_meter();
            found.push((world, [a.red(), a.green(), a.blue()]));
        }
    }
    found
}

/// Distance of a point from the lines of a mark, an arrow's head left out.
fn distance(shape: &MarkShape, point: DVec2) -> f64 {
    match *shape {
        MarkShape::Line(from, to) | MarkShape::Arrow(from, to) => {
            let share = (point - from).dot(to - from) / (to - from).length_squared();
            point.distance(from.lerp(to, share.clamp(0.0, 1.0)))
        }
        MarkShape::Circle(center, radius) => (point.distance(center) - radius).abs(),
        _ => unreachable!("not among the shapes of this test"),
    }
}

/// Points along a mark.
fn points(shape: &MarkShape) -> Vec<DVec2> {
    let shares = (1..20).map(|step| f64::from(step) / 20.0);
    match *shape {
        MarkShape::Line(from, to) | MarkShape::Arrow(from, to) => shares.map(|share| from.lerp(to, share)).collect(),
        MarkShape::Circle(center, radius) => {
            shares.map(|share| center + radius * DVec2::from_angle(std::f64::consts::TAU * share)).collect()
        }
        _ => unreachable!("not among the shapes of this test"),
    }
}

#[test]
fn marks_are_drawn_where_they_lie_and_nowhere_else() {
    let changed = differences(
        &frame(
            |app| {
                app.add_layer(fixed_marks);
            },
            0.0,
        ),
        &frame(|_| {}, 0.0),
    );
    let pixel = 1.0 / camera().pixels_per_meter();
    for (place, _) in &changed {
        let MarkShape::Arrow(_, head) = SHAPES[1] else { unreachable!() };
        let near = SHAPES.iter().any(|shape| distance(shape, *place) <= 2.6 * pixel);
        assert!(near || place.distance(head) <= 9.9 * pixel, "drawn at {place}, where no mark is");
    }
    for point in SHAPES.iter().flat_map(points) {
        let drawn = |(place, _): &&(DVec2, [u8; 3])| place.distance(point) <= pixel;
        let (_, color) = changed.iter().find(drawn).unwrap_or_else(|| panic!("nothing is drawn at {point}"));
        // More red than anything else: the colour that was asked for, on a light ground.
        assert!(color[0] > color[1] && color[0] > color[2], "{color:?} at {point}");
    }
}

/// It is drawn over the body, where that is in this frame.
#[test]
fn a_layer_sees_the_state_of_its_frame() {
    let with = frame(
        |app| {
            app.add_layer(rings);
        },
        0.5,
    );
    let changed = differences(&with, &frame(|_| {}, 0.5));
    let pixel = 1.0 / camera().pixels_per_meter();
    let ring = MarkShape::Circle(DVec2::new(0.5, 0.0), 0.1);
    assert!(!changed.is_empty());
    assert!(changed.iter().all(|(place, _)| distance(&ring, *place) <= 2.0 * pixel));
    for point in points(&ring) {
        assert!(changed.iter().any(|(place, _)| place.distance(point) <= pixel), "nothing is drawn at {point}");
    }
}
