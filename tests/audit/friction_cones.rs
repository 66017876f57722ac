//! Laws of friction that several contacts of one body share: a box on two corners. It slips if the cones of all contacts together do
//! not suffice, and never before. Source: Coulomb's law for the whole box, with the static coefficient until it slips.
//!
//! Tolerance: contacts are held at rest, so springs take no part, and places agree to rounding of the path: 1e-9 m. Velocity Verlet
//! draws its springs by `mu m g/k` and looks at ticks: it agrees to 1e-3 of the way, and to ten such lengths.

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;

const GRAVITY: f64 = 9.81;
const STIFFNESS: f64 = 1e6;

/// The located ways, and the default with its allowed share of the way.
fn ways() -> Vec<(&'static str, Overrides, f64)> {
    let method =
        |name: &str, tick: f64| Overrides { method: Some(name.to_owned()), tick: Some(tick), ..Overrides::default() };
    let tolerance = |tolerance: f64| Overrides { tolerance: Some(tolerance), ..Overrides::default() };
    vec![
        ("default", Overrides::default(), 1e-3),
        ("tolerance 1e-5", tolerance(1e-5), 3e-5),
        ("tolerance 1e-8", tolerance(1e-8), 3e-8),
        ("Reference", Overrides { method: Some("Reference".to_owned()), ..Overrides::default() }, 0.0),
        ("Dop853", method("Dop853", 1e-3), 0.0),
        ("RungeKutta4", method("RungeKutta4", 5e-4), 0.0),
    ]
}

/// The place of the box at the end, for each way.
fn ends(text: &str) -> Vec<(&'static str, f64, f64)> {
    let end = |(name, overrides, share): (&'static str, Overrides, f64)| {
        let source = Source::new("cones.ron", text);
        let mut simulation =
            Simulation::load_with(&source, &overrides, |_| {}).unwrap_or_else(|e| panic!("{e}\n{text}"));
        simulation.run_to_end().unwrap_or_else(|failure| panic!("{name}: {failure}\n{text}"));
        (name, simulation.bodies().position[0].x, share)
    };
    ways().into_iter().map(end).collect()
}

/// Boxes: width, height, mass, static and dynamic coefficient.
const BOXES: [(f64, f64, f64, f64, f64); 5] = [
    (0.4, 0.1, 2.0, 1.1, 0.6),
    (0.3, 0.2, 0.5, 0.6, 0.2),
    (1.0, 0.1, 10.0, 0.9, 0.85),
    (0.26, 0.16, 1.37, 0.5, 0.5),
    (0.5, 0.25, 0.38, 0.94, 0.3),
];

fn scene(duration: f64, (width, height, mass, fixed, slips): (f64, f64, f64, f64, f64), rest: &str) -> String {
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}), gravity: (0, -{GRAVITY:?}), \
         materials: {{\"m\": (stiffness: {STIFFNESS:?}, restitution: 0, friction: (static: {fixed:?}, dynamic: {slips:?}))}}, \
         bodies: [(name: \"b\", at: (0, {:?}), mass: {mass:?}, material: \"m\", \
         shape: Rectangle(width: {width:?}, height: {height:?}, rounding: 0.005)), {rest}",
        0.5 * height
    )
}

/// A force that grows with time pulls the box. It slips at `t = mu_s m g/c`, and then goes with `(c t - mu_d m g)/m`.
#[test]
fn a_pulled_box_slips_at_the_sum_of_its_cones() {
    for of_box in BOXES {
        let (_, _, mass, fixed, slips) = of_box;
        for way in [1.0, -1.0] {
            let weight = mass * GRAVITY;
            let (rate, end) = (2.0 * fixed * weight, 0.8);
            let begins = fixed * weight / rate;
            let text = scene(
                end,
                of_box,
                &format!(
                    "], walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")], \
                     forces: [Drive(of: \"b\", force: ({:?}, 0), course: Piecewise([(0, 0), (1, 1)]))])",
                    way * rate
                ),
            );
            let late = end - begins;
            let pulled = rate * ((end.powi(3) - begins.powi(3)) / 6.0 - begins * begins * late / 2.0);
            let exact = way * (pulled - slips * weight * late * late / 2.0) / mass;
            for (name, found, share) in ends(&text) {
                let springs = if name == "default" { 10.0 * fixed * weight / STIFFNESS } else { 1e-9 };
                let allowed = share * exact.abs() + springs;
                assert!((found - exact).abs() <= allowed, "{name}, {of_box:?}: {found} instead of {exact}\n{text}");
            }
        }
    }
}

/// A force stays below the sum of all cones, and beyond what one corner with its static and one with its dynamic coefficient bear.
#[test]
fn a_box_that_friction_bears_stays() {
    for of_box in BOXES {
        let (_, _, mass, fixed, _) = of_box;
        let weight = mass * GRAVITY;
        let text = scene(
            0.6,
            of_box,
            &format!(
                "], walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")], \
                 forces: [Drive(of: \"b\", force: ({:?}, 0), course: Sine(amplitude: 1, frequency: 3))])",
                0.98 * fixed * weight
            ),
        );
        for (name, found, _) in ends(&text) {
            let allowed = 4.0 * fixed * weight / STIFFNESS;
            assert!(found.abs() <= allowed, "{name}, {of_box:?}: moved by {found}\n{text}");
        }
    }
}

/// A table starts with `6 d/T^2`, more than friction gives. The box slides at once, with `mu_d g`. After a stop of the table at a point
/// of its path, at which its acceleration jumps, it slides at once again. The springs of velocity Verlet, with `0.8 k`, are drawn first,
/// for about a radian of their swing. So long the box has another acceleration, by `mu_s g` at most.
#[test]
fn a_table_that_jumps_into_motion_leaves_the_box_behind() {
    for of_box in BOXES {
        let (_, _, mass, fixed, slips) = of_box;
        let (time, rest) = (0.2, 0.1);
        // Twice as much as friction bears.
        let by = 2.0 * fixed * GRAVITY * time * time / 6.0;
        for (waits, begins) in [(String::new(), 0.0), (format!("(time: {rest:?}, by: (0, 0)), "), rest)] {
            let end = begins + 0.4 * time;
            let text = scene(
                end,
                of_box,
                &format!(
                    "(name: \"table\", at: (0, -0.5), material: \"m\", shape: Rectangle(width: 20, height: 1), \
                     kinematic: (path: [{waits}(time: {:?}, by: ({by:?}, 0))]))])",
                    begins + time
                ),
            );
            let exact = 0.5 * slips * GRAVITY * (end - begins) * (end - begins);
            for (name, found, share) in ends(&text) {
                let drawn = fixed * GRAVITY * (mass / (0.8 * STIFFNESS)).sqrt() * (end - begins);
                let allowed = share * exact + if name == "default" { drawn } else { 1e-9 };
                assert!((found - exact).abs() <= allowed, "{name}, {of_box:?}: {found} instead of {exact}\n{text}");
            }
        }
    }
}
