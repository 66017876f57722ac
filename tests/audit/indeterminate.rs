//! Law: of all normal forces that balance the loads of bodies at rest, those act that are nearest to the springs of the contacts, each
//! difference measured by the spring's force. Source: minimum of `sum ((N - k d)/(k d))^2` under the balance, in closed form for one
//! body between two. All methods take these forces, and the card names the band.
//!
//! Tolerance: 1e-6 of the greater force. Searches for rest end below 1e-9, and the springs' depths are read from places.
//!
//! Not tested: forces of islands with joints at rest under methods from tick to tick.

use jostle::contacts::ContactForces;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

const GRAVITY: f64 = 9.81;

fn load(text: &str, method: Option<&str>) -> Simulation {
    let overrides = Overrides { method: method.map(str::to_owned), ..Overrides::default() };
    Simulation::load_with(&Source::new("band.ron", text), &overrides, |_| {}).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// A press comes down onto a box on a floor, and stops so that both contacts are `depth` deep together.
fn squeeze(depth: f64, mass: f64, stiffness: f64, restitution: f64) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 2), gravity: (0, -{GRAVITY:?}), \
         materials: {{\"m\": (stiffness: {stiffness:?}, restitution: {restitution:?}, friction: 0.5)}}, \
         walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")], \
         bodies: [(name: \"box\", at: (0, 0.2), mass: {mass:?}, material: \"m\", shape: Rectangle(width: 0.4, height: 0.4, rounding: 0.01)), \
         (name: \"press\", at: (0, 0.7), kinematic: (path: [(time: 1, by: (0, {:?}))]), material: \"m\", shape: Rectangle(width: 0.6, height: 0.2, rounding: 0.01))], \
         sensors: [ContactForce(on: \"floor\")])",
        -0.2 - depth
    )
}

#[test]
fn a_squeezed_box_bears_what_its_springs_bear() {
    for (depth, mass, stiffness, restitution) in
        [(0.01, 1.0, 1e5, 0.2), (0.004, 5.0, 1e6, 0.5), (0.002, 0.3, 1e5, 0.05)]
    {
        for method in [None, Some("Dop853"), Some("RungeKutta4")] {
            let mut simulation = load(&squeeze(depth, mass, stiffness, restitution), method);
            simulation.run_to_end().unwrap();
            let height = simulation.bodies().position[0].y;
            let (below, above) = (0.2 - height, depth - (0.2 - height));
            // Two corners each; the press gives way like the box.
            let (floor, press) = (2.0 * stiffness * below, stiffness * above);
            let lacks = mass * GRAVITY - (floor - press);
            let exact = floor + floor * floor / (floor * floor + press * press) * lacks;
            let found = simulation.state().contact_forces().map_or(0.0, |forces: &ContactForces| -forces.on_wall[0].y);
            let what = format!("{depth} m, {mass} kg, {stiffness:e} N/m, e = {restitution}, {method:?}");
            assert!((found - exact).abs() <= 1e-6 * exact, "{what}: {found} N instead of {exact} N");
            let notes = simulation.card().notes;
            let told = notes.iter().any(|note| note.contains("statics does not determine") && note.contains("`box`"));
            assert!(told, "{what}: {notes:?}");
        }
    }
}

/// A disc on a slide lies in a table that moves. The slide would bear any part of the weight, so the contact bears what its spring
/// does, `k d`. While the table is faster, friction drives the disc with `mu k d/m`. Velocity Verlet sees the end of that at a tick.
#[test]
fn a_disc_on_a_slide_is_driven_by_the_force_of_its_spring() {
    for (depth, restitution) in [(0.003, 0.4), (0.002, 0.1), (0.004, 0.8)] {
        let text = format!(
            "Scene(format: 1, clock: (duration: 0.05), gravity: (0, -{GRAVITY:?}), \
             materials: {{\"m\": (stiffness: 5000.0, friction: 0.5, restitution: {restitution:?})}}, \
             bodies: [(name: \"table\", at: (0, -0.5), kinematic: (velocity: (3, 0)), material: \"m\", shape: Rectangle(width: 40, height: 1)), \
             (name: \"b\", at: (0, {:?}), material: \"m\", atoms: Disc(radius: 0.18, mass: 1.2))], \
             joints: [Prismatic(name: \"p\", a: World, b: \"b\", axis: (1, 0))])",
            0.18 - depth
        );
        // The spring of friction, with 0.8 of the stiffness, is drawn to `mu N/k_t` at 3 m/s. Then it slips.
        let (most, end, drawn) = (0.5 * 2500.0 * depth / 1.2, 0.05, 0.5 * depth / 0.8 / 3.0);
        let slips = end - drawn;
        let exact = most * (drawn * drawn / 6.0 + 0.5 * drawn * slips + 0.5 * slips * slips);
        for method in [None, Some("Dop853")] {
            let mut simulation = load(&text, method);
            simulation.run_to_end().unwrap();
            let x = simulation.bodies().position[1].x;
            // The disc's own speed in that time is below a thousandth of 3 m/s, and the time below a hundredth of the whole.
            let allowed = if method.is_some() { 1e-5 } else { simulation.clock().dt / end } * exact;
            assert!((x - exact).abs() <= allowed, "{depth} m, e = {restitution}, {method:?}: {x} instead of {exact}");
        }
    }
}

/// Two pads hold a block at eight corners. Their rows depend on each other, and rounding must not make forces of that. The block slips,
/// so it falls as under velocity Verlet with a fine tick. Springs of friction are drawn by `mu F/k_t = 5e-5 m` first, at two pads.
#[test]
fn a_pinched_block_slips_alike_under_all_methods() {
    let path = format!("{}/assets/defects/pinched_block.ron", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|wrong| panic!("{path}: {wrong}"));
    let height = |method: &str, tick: f64| {
        let overrides = Overrides { method: Some(method.to_owned()), tick: Some(tick), ..Overrides::default() };
        let mut simulation = Simulation::load_with(&Source::new("pinched_block.ron", &text), &overrides, |_| {})
            .unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_end().unwrap_or_else(|failure| panic!("{method}: {failure}"));
        simulation.bodies().position[0].y
    };
    let fine = height("VelocityVerlet", 1e-5);
    for (method, tick) in [("Dop853", 5e-4), ("Dop853", 2e-4), ("RungeKutta4", 2e-4)] {
        let found = height(method, tick);
        assert!((found - fine).abs() < 1e-4, "{method}, {tick} s: {found} instead of {fine}");
    }
}
