//! Laws of contacts that pass from a side of a hull to its corner and from part to part. The change is an event, so
//! that methods with stages keep their order and their account across it.
//!
//! Not tested: corners that have sunk below the side of another core, and joints of lines.

use jostle::{Simulation, SimulationExt};

use super::support::{load, run_to};

/// A plank that glides over a fixed peg, tips over it with its corner and falls off. There is neither friction nor loss.
fn plank(method: &str, tick: f64, shape: &str) -> Simulation {
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 1, tick: {tick:?}, method: {method}), gravity: (0, -9.81),
            materials: {{ \"default\": (stiffness: 2e3, restitution: 1) }},
            bodies: [(name: \"plank\", at: (0.15, 0.5), velocity: (0.8, 0), mass: 1, inertia: 0.05, {shape}),
                (name: \"peg\", at: (0, 0), fixed: true, atoms: Disc(radius: 0.3))])"
    ));
    run_to(&mut simulation, 0.75);
    simulation
}

fn state(simulation: &Simulation) -> [f64; 6] {
    let bodies = simulation.bodies();
    let (place, velocity) = (bodies.position[0], bodies.velocity[0]);
    [place.x, place.y, bodies.angle[0], velocity.x, velocity.y, bodies.spin[0]]
}

fn largest_difference(a: [f64; 6], b: [f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// A plank of one hull; and one whose cut lies under the peg, so that the contact goes on at another part.
const PLANKS: [&str; 2] = [
    "shape: Rectangle(width: 0.8, height: 0.1, rounding: 0.04)",
    "shape: Polygon(points: [(-0.4, -0.06), (0.4, -0.06), (0.4, 0.06), (0.02, 0.06), (-0.4, 0.1)], rounding: 0.04)",
];

/// Law: methods keep their order where the contact passes from side to corner. Each halving of the tick divides the error of `RungeKutta4` by
/// 16. Half of that factor is asked for, as few ticks show no order to the last digit.
///
/// Tolerance of `Dop853`: order 8 in the angle of 0.045 rad over which the contact swings in a tick, `sqrt(k / m) h`. Six such shares of 1 m
/// are 1e-10 m.
#[test]
fn methods_keep_their_order_where_the_nearest_feature_changes() {
    for shape in PLANKS {
        let exact = state(&plank("Dop853", 2.5e-4, shape));
        // It has tipped over the peg.
        assert!(exact[2] < -0.3 && exact[5] < -0.5, "{exact:?}");
        let coarser = state(&plank("Dop853", 1e-3, shape));
        assert!(largest_difference(exact, coarser) < 1e-10, "{:e}", largest_difference(exact, coarser));
        let errors =
            [2e-3, 1e-3, 5e-4].map(|tick| largest_difference(state(&plank("RungeKutta4", tick, shape)), exact));
        assert!(errors[1] < errors[0] / 8.0 && errors[2] < errors[1] / 8.0, "{errors:?}");
    }
}

/// Law: where two held contacts at one place come to have different curvatures, one of them gives way. Gears that mesh keep their account:
/// what the motor gives becomes energy or is lost.
///
/// Tolerance: a thousandth of the work of the motor. Two rows that contradict each other make forces without bound.
#[test]
fn teeth_on_teeth_keep_their_account_under_methods_with_stages() {
    let gear = |name: &str, place: f64, angle: f64, teeth: usize| {
        format!(
            "(name: \"{name}\", at: ({place:?}, 0), angle: {angle:?}, shape: Gear(teeth: {teeth}, module: 0.01, chords: 2))"
        )
    };
    let gears = [
        gear("pinion", 0.0, 0.0, 12),
        gear("wheel", 0.2101, std::f64::consts::PI / 30.0, 30),
        gear("drum", 0.4602, 0.0, 20),
    ];
    for (method, tick) in [("RungeKutta4", 50e-6), ("RungeKutta4", 60e-6), ("Dop853", 50e-6)] {
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 1, tick: {tick:?}, method: {method}), gravity: (0, -9.81),
                materials: {{ \"default\": (stiffness: 2e5, friction: 0.1, restitution: 0.1, density: 40) }},
                bodies: [{}, (name: \"load\", at: (0.54, -0.15), collides: false, shape: Disc(radius: 0.03), mass: 1)],
                joints: [Revolute(name: \"small\", a: World, b: \"pinion\"), Revolute(a: World, b: \"wheel\"),
                    Revolute(name: \"last\", a: World, b: \"drum\"), Prismatic(name: \"rope\", a: World, b: \"load\", axis: (0, 1)),
                    Rack(of: (\"last\", \"rope\"), radius: 0.08)],
                controllers: [Motor(of: \"small\", speed: 6.283, limit: 2)])",
            gears.join(", ")
        ));
        run_to(&mut simulation, 0.04);
        let energy = simulation.card().energy;
        assert!(energy.residual.abs() < 1e-3 * energy.work, "{method}, {tick}: {energy:?}");
        assert!(simulation.bodies().spin[0].abs() < 10.0);
    }
}
