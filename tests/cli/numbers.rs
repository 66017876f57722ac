//! `run -o`: channels as comma-separated values.

use super::harness::{FALL, Folder};
use jostle::{Simulation, scene::Source};

#[test]
fn channels_have_a_header_with_units_and_a_row_per_frame() {
    let folder = Folder::new("channels").with("fall.ron", FALL);
    let ended = folder.jostle("run fall.ron -o channels.csv --quiet").code(0);
    assert_eq!((ended.out.as_str(), ended.err.as_str()), ("", ""));
    let table = String::from_utf8(folder.read("channels.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let header = ["time [s]", "ball.position.x [m]", "ball.position.y [m]", "ball.angle [rad]", "energy.kinetic [J]"];
    assert_eq!(rows[0][..5], header);
    assert_eq!(rows[1][..4], ["0", "0", "1", "0"]);
    // Ten frames per second for a fifth of a second, both ends included.
    assert_eq!(rows.len(), 1 + 3);
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    let mut simulation = Simulation::load(&Source::new("fall.ron", FALL)).unwrap();
    simulation.run_to_end().unwrap();
    let height: f64 = rows[3][2].parse().unwrap();
    assert_eq!(height.to_bits(), simulation.bodies().position[0].y.to_bits());
}

#[test]
fn a_scene_without_sensors_is_told() {
    let folder =
        Folder::new("no_sensors").with("fall.ron", FALL.replace("sensors: [Pose(of: \"ball\"), Energy()],", ""));
    folder.jostle("run fall.ron -o channels.csv").code(0).says("note: the scene has no sensors");
}
