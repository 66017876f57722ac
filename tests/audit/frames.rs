//! Promise: the frames of a film decide nothing of the physics. Under a tolerance, ticks are frames, and trials have other ticks than
//! the run that they speak for.

use super::ran::demand_agreement;

/// A box rocks on the floor. A force off its centre pushes it both ways. At turning points its contacts stick and stand.
const ROCKS: &str = "Scene(format: 1, clock: (duration: 1.85CLOCK), gravity: (0, -9.81),
    materials: { \"m\": (stiffness: 33460.0, restitution: 0.6, friction: 0.5) },
    walls: [(name: \"floor\", left: (1, 0), right: (-1, 0), material: \"m\")],
    bodies: [(name: \"b\", at: (0, 0.11655), shape: Rectangle(width: 0.199, height: 0.2331), mass: 0.4527, material: \"m\")],
    forces: [Drive(of: \"b\", force: (2.0129200555546065, 0), at: (0, 0.09498), course: Piecewise([(0, 0), (0.0771, 0.221),
             (0.1542, -0.008), (0.2313, -0.613), (0.3083, -0.835), (0.3854, -0.834), (0.4625, 0.665), (0.5396, -0.759),
             (0.6167, -0.727), (0.6938, 0.987), (0.7708, 0.632), (0.8479, -0.412), (0.925, 0.666), (1.0021, 0.905),
             (1.0792, -0.178), (1.1562, -0.384), (1.2333, 0.165), (1.3104, 0.809), (1.3875, -0.451), (1.4646, -0.076),
             (1.5417, -0.426), (1.6188, -0.898), (1.6958, -0.027), (1.7729, 0.684), (1.85, 0.32)])),
             Drive(of: \"b\", force: (0, 2.0884571547006), course: Sine(frequency: 3.3835014183867345, phase: 6.218499794009662))])";

#[test]
fn a_rocking_box_comes_to_the_same_place_at_all_frame_rates() {
    let films = [20, 24, 25, 30, 50, 60].map(|rate| format!(", tolerance: 1e-6), film: (fps: {rate}"));
    let tolerances = [1e-2, 1e-3, 1e-4, 1e-5, 1e-8].map(|tolerance| format!(", tolerance: {tolerance:?}"));
    let all: Vec<&str> = films.iter().chain(&tolerances).map(String::as_str).collect();
    demand_agreement("box", &all, 8, |clock| ROCKS.replace("CLOCK", clock));
}
