//! Law: a body of mass m that leaves home with velocity v stands at `(v/w) sin(w t)`, `w = sqrt(k/m)` (harmonic
//! oscillator). Here w = 2 rad/s, v = 3 m/s.
//!
//! Not tested: contacts, other integrators.

use glam::DVec2;
use jostle::Simulation;
use jostle::raster::{Camera, Painter, Scratch, Theme, View};
use jostle::scene::{SceneErrors, Source};
use jostle::simulation::{Overrides, Recorder};

use super::Channels;

const W: f64 = 2.0;
const V: f64 = 3.0;

fn load(stiffness: &str, tick: f64) -> Result<Simulation, SceneErrors> {
    let scene = format!(
        r#"Scene(
            format: 1,
            clock: (duration: 1, tick: {tick:?}, method: VelocityVerlet),
            bodies: [(name: "ball", at: (1, 0), velocity: (3, 0), atoms: Disc(radius: 0.1, mass: 0.5))],
            forces: [HomeSpring(of: "ball", home: (1, 0), stiffness: {stiffness})],
            sensors: [HomeSpringStretch(of: "ball")],
        )"#
    );
    Simulation::load_with(&Source::new("spring.ron", scene), &Overrides::default(), super::plugin)
}

fn run(tick: f64) -> Simulation {
    let mut simulation = load("\"2 N/m\"", tick).unwrap();
    simulation.run_to_end().unwrap();
    simulation
}

fn error(tick: f64) -> f64 {
    (run(tick).bodies().position[0].x - 1.0 - V / W * W.sin()).abs()
}

/// Velocity Verlet swings too fast by the share `(w dt)^2 / 24`, which puts the body off by `v t (w dt)^2 / 24` at most,
/// and as much again for the amplitude. Half the tick leaves a quarter of the error; terms of higher order are 1 %.
#[test]
fn the_body_swings_as_the_law_says() {
    let (coarse, fine) = (error(0.01), error(0.005));
    assert!(coarse > 0.0 && coarse < 2.0 * V * (W * 0.01_f64).powi(2) / 24.0, "{coarse:e}");
    assert!((coarse / fine - 4.0).abs() < 0.04, "{coarse:e} {fine:e}");
}

/// After a quarter of a period, 0.785 s, the stretch has been v/w. Looked at once per tick, it is missed by
/// `(w dt)^2 / 8` of it at most, and the method is off by as much again.
#[test]
fn the_sensor_gives_the_greatest_stretch() {
    let simulation = run(0.001);
    let channel = simulation.resource::<Channels>().iter().next().expect("the scene asks for one");
    assert_eq!((channel.name.as_str(), channel.unit), ("ball.home_spring.stretch", "m"));
    let stretch = simulation.value(channel);
    assert!((stretch - V / W).abs() < V / W * (W * 0.001_f64).powi(2) / 4.0, "{stretch}");
}

/// Half a second later the body stands at 1 + 1.5 sin(1) m, and the spring is drawn between home and there.
#[test]
fn a_film_shows_the_spring() {
    let mut simulation = load("2", 0.001).unwrap();
    let mut frame = Recorder::default().frame(&mut simulation, 0.5).unwrap();
    let camera = Camera::look(DVec2::new(1.5, 0.0), 2.0, (640, 360));
    let view = View { camera, theme: Theme::named("paper").unwrap(), frame_step: 0.1, panel: None };
    let painter = Painter::new(&view, &frame).unwrap();
    let mut paint = || {
        let mut picture = painter.backdrop().clone();
        painter.paint(&frame, &mut picture, &mut Scratch::default());
        frame.marks.clear();
        picture
    };
    let (with, without) = (paint(), paint());
    // Corners in the middle of the zigzag lie on the line from home to the body, clear of both.
    for corner in [4, 6, 8, 10, 12] {
        let place = camera.to_picture(DVec2::new(1.0 + V / W * (W * 0.5).sin() * f64::from(corner) / 16.0, 0.0));
        let (x, y) = (place.x as u32, place.y as u32);
        assert_ne!(with.pixel(x, y), without.pixel(x, y), "corner {corner} at {place}");
    }
    assert_eq!(with.pixel(20, 20), without.pixel(20, 20), "nothing is drawn elsewhere");
}

#[test]
fn a_wrong_stiffness_is_told_with_its_place() {
    let errors = load("-2", 0.01).err().unwrap();
    assert_eq!(errors.errors()[0].path, "forces[0].stiffness");
}

/// A run that goes on from a snapshot remembers the greatest stretch of before.
#[test]
fn a_snapshot_keeps_the_stretch() {
    let whole = run(1e-3);
    let mut saved = load("\"2 N/m\"", 1e-3).unwrap();
    saved.run_to_tick(900).unwrap();
    let snapshot = saved.snapshot().unwrap();
    let mut resumed = load("\"2 N/m\"", 1e-3).unwrap();
    resumed.restore(&snapshot).unwrap();
    resumed.run_to_end().unwrap();
    let stretch = |simulation: &Simulation| simulation.value(simulation.resource::<Channels>().iter().next().unwrap());
    assert_eq!(stretch(&whole), stretch(&resumed));
}
