//! Law: an anchor counts from the datum of its body. With `datum: Origin` a point of the body's own drawing stays that point, wherever the
//! centre of mass is; an anchor that is left out is the centre of mass.
//!
//! The clump has discs of 1 kg in its origin and of 3 kg at (0.4, 0), with the radius 0.1: its centre of mass is at (0.3, 0), its moment of
//! inertia `4 r^2/2 + 1 0.3^2 + 3 0.1^2 = 0.14 kg m2`. Its origin stands at (1, 2), turned by 90 degrees, so that the anchor (0.4, 0) is at
//! (1, 2.4), and 0.1 m above the centre of mass. A force of 2 N to the right there has the torque -0.2 N m about it.
//!
//! Tolerance: within a tick of 1 ms the clump turns by 7e-7 rad and moves by 3e-7 m, by which arms and springs change: 1e-6 of each number.
//! Not tested: bodies that a plugin spawns.

use glam::DVec2;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::world::Name;
use jostle::world::anchor::Anchors;

const DT: f64 = 1e-3;

fn clump(datum: &str, at: &str, rest: &str) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\", method: VelocityVerlet), contacts: None,
         walls: [(name: \"slant\", left: (0, 5.4), right: (5.4, 0))],
         bodies: [(name: \"clump\", at: {at}, angle: \"90 deg\", {datum} atoms: List([(at: (0, 0), radius: 0.1, mass: 1), (at: (0.4, 0), radius: 0.1, mass: 3)]))],
         {rest})"
    );
    Simulation::load(&Source::new("clump.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"))
}

/// The same anchor from the origin and from the centre of mass, in the same place of the world.
fn both(entry: impl Fn(&str) -> String) -> [Simulation; 2] {
    [clump("datum: Origin,", "(1, 2)", &entry("(0.4, 0)")), clump("", "(1, 2.3)", &entry("(0.1, 0)"))]
}

fn where_anchors_are(simulation: &Simulation) -> Vec<(String, DVec2)> {
    let anchors = &simulation.get_resource::<Anchors>().expect("there are anchors").0;
    let place = |anchor: &jostle::world::anchor::Anchor| {
        let body = anchor.body.expect("it is on a body");
        let name = simulation.unpublished_world().get::<Name>(body).expect("it has a name");
        assert_eq!(name.to_string(), "clump");
        (anchor.path.clone(), anchor.position(simulation.bodies()).expect("the body is there"))
    };
    anchors.iter().filter(|anchor| anchor.given).map(place).collect()
}

#[test]
fn forces_act_where_their_anchors_are_drawn() {
    let forces = [
        "Thrust(of: \"clump\", at: AT, force: (2, 0))",
        "Thrust(of: \"clump\", at: AT, force: (0, -2), frame: Body)",
        "Drive(of: \"clump\", at: AT, force: (2, 0), course: Sine(frequency: 0, phase: \"90 deg\"))",
        "Spring(a: \"clump\", anchor_a: AT, b: World, anchor_b: (3, 2.4), stiffness: 2, length: 1)",
    ];
    for force in forces {
        for mut simulation in both(|at| format!("forces: [{}]", force.replace("AT", at))) {
            let [(path, at)] = &where_anchors_are(&simulation)[..] else { panic!("one anchor") };
            assert!(path.starts_with("forces[0].a") && at.distance(DVec2::new(1.0, 2.4)) < 1e-15, "{path}: {at}");
            simulation.run_to_tick(1).unwrap();
            let (velocity, spin) = (simulation.bodies().velocity[0], simulation.bodies().spin[0]);
            let (faster, turned) = (DVec2::new(2.0 / 4.0 * DT, 0.0), -0.2 / 0.14 * DT);
            assert!(velocity.distance(faster) < 1e-6 * faster.length(), "{force}: {velocity}");
            assert!((spin - turned).abs() < 1e-6 * turned.abs(), "{force}: {spin}");
        }
    }
}

/// Law: a force through the centre of mass does not turn a body.
#[test]
fn an_anchor_that_is_left_out_is_the_centre_of_mass() {
    for force in [
        "Thrust(of: \"clump\", force: (2, 0))",
        "Drive(of: \"clump\", force: (2, 0), course: Piecewise([(0, 1)]))",
        "Spring(a: \"clump\", b: World, anchor_b: (3, 2.3), stiffness: 2, length: 1)",
    ] {
        let mut simulation = clump("datum: Origin,", "(1, 2)", &format!("forces: [{force}]"));
        simulation.run_to_tick(100).unwrap();
        let anchors = simulation.get_resource::<Anchors>().map_or(&[][..], |anchors| &anchors.0);
        assert!(anchors.iter().all(|anchor| !anchor.given && anchor.at == DVec2::ZERO), "{force}: {anchors:?}");
        assert_eq!(simulation.bodies().spin[0], 0.0, "{force}");
    }
}

/// A ray from (1, 2.4) to the right meets the line `x + y = 5.4` at (3, 2.4). A hinge there is closed.
#[test]
fn sensors_and_joints_count_as_forces_do() {
    for mut simulation in both(|at| {
        format!(
            "sensors: [Range(name: \"eye\", of: \"clump\", at: {at}, angle: \"-90 deg\")],
             joints: [Revolute(name: \"hinge\", a: World, anchor_a: (1, 2.4), b: \"clump\", anchor_b: {at})]"
        )
    }) {
        let anchors = where_anchors_are(&simulation);
        let paths: Vec<&str> = anchors.iter().map(|(path, _)| path.as_str()).collect();
        assert!(paths.contains(&"sensors[0].at") && paths.contains(&"joints[0].anchor_b"), "{paths:?}");
        assert!(anchors.iter().all(|(_, at)| at.distance(DVec2::new(1.0, 2.4)) < 1e-15), "{anchors:?}");
        let mut read = |name: &str| {
            let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the channel is there");
            simulation.value(&channel)
        };
        assert!((read("eye.range") - 2.0).abs() < 1e-14);
        assert!(read("hinge.drift") < 1e-15);
    }
}
