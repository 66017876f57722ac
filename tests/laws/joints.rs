//! Laws of joints: pendulums, chains and loops against reference values, under every method; drift, reactions, energy.
//!
//! Reference values: `assets/truths/J*.json` and `S06`, made with 40 digits or by two independent methods. Tolerances: under `Dop853`
//! ten times the reference's own error, or 1e-12, or the growth of rounding where the motion is sensitive; for other methods the order
//! that they state. Joint drift: 1e-12 of the size of the mechanism, for all methods. Not tested: contacts beside joints.

use std::fmt::Write as _;

use glam::DVec2;
use jostle::joints::Joint;
use jostle::problems::Truth;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

const METHODS: [(&str, i32); 7] = [
    ("ExplicitEuler", 1),
    ("SemiImplicitEuler", 1),
    ("VelocityVerlet", 2),
    ("ImplicitMidpoint", 2),
    ("RungeKutta4", 4),
    ("Symplectic4", 4),
    ("Dop853", 8),
];

/// Joint drift is below that, for mechanisms of some metres.
const DRIFT: f64 = 1e-12;

fn truth(name: &str) -> Truth {
    Truth::read(&std::fs::read_to_string(format!("assets/truths/{name}.json")).unwrap())
}

fn load(method: &str, tick: f64, body: &str) -> Simulation {
    let scene = format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: {method}), gravity: (0, -9.81), contacts: None, {body})"
    );
    Simulation::load_with(&Source::new("joints.ron", scene), &Overrides::default(), |_| {})
        .unwrap_or_else(|errors| panic!("{errors}"))
}

fn run_to(simulation: &mut Simulation, time: f64) {
    let tick = (time / simulation.clock().dt).round() as u64;
    simulation.run_to_tick(tick).unwrap();
}

fn demand_small_drift(simulation: &Simulation, of: &str) {
    let drift = simulation.card().largest_joint_drift.expect("the scene has joints");
    assert!(drift.meters < DRIFT, "{of}: {drift:?}");
    for joint in simulation.state().models_of::<Joint>() {
        assert!(joint.drift(simulation.bodies()) < DRIFT, "{of}: {} is open", joint.name);
    }
}

/// A link of a chain: its mass, length, distance of its centre from its upper end, inertia, angle from the vertical.
struct Link {
    mass: f64,
    length: f64,
    center: f64,
    inertia: f64,
    angle: f64,
}

/// A chain that hangs in the origin: bodies and joints; and where it ends.
fn chain(links: &[Link]) -> (String, String, DVec2) {
    let (mut bodies, mut joints, mut top) = (String::new(), String::new(), DVec2::ZERO);
    for (number, Link { mass, length, center, inertia, angle }) in links.iter().enumerate() {
        let (sin, cos) = libm::sincos(*angle);
        let along = DVec2::new(sin, -cos);
        let at = top + along * *center;
        let turned = angle - std::f64::consts::FRAC_PI_2;
        writeln!(
            bodies,
            "(name: \"link{number}\", at: ({:?}, {:?}), angle: {turned:?}, mass: {mass:?}, inertia: {inertia:?},
              atoms: Disc(radius: 0.02)),",
            at.x, at.y
        )
        .unwrap();
        let upper = match number {
            0 => "a: World, anchor_a: (0, 0)".to_owned(),
            _ => format!(
                "a: \"link{}\", anchor_a: ({:?}, 0)",
                number - 1,
                links[number - 1].length - links[number - 1].center
            ),
        };
        writeln!(
            joints,
            "Revolute(name: \"pin{number}\", {upper}, b: \"link{number}\", anchor_b: ({:?}, 0)),",
            -center
        )
        .unwrap();
        top += along * *length;
    }
    (bodies, joints, top)
}

fn angles(simulation: &Simulation, count: usize) -> Vec<f64> {
    let bodies = simulation.bodies();
    let angle = |link: usize| bodies.angle[link] + std::f64::consts::FRAC_PI_2;
    (0..count).map(angle).chain(bodies.spin[..count].iter().copied()).collect()
}

/// The greatest difference.
fn off(found: &[f64], exact: &[f64]) -> f64 {
    assert_eq!(found.len(), exact.len());
    found.iter().zip(exact).map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max)
}

/// Source: J01, elliptic functions. At 179 degrees rounding grows near the upper equilibrium by `e^(3.13/s t)` until it falls.
#[test]
fn a_point_on_a_rod_is_the_mathematical_pendulum() {
    let truth = truth("J01_pendulum_exact");
    for (degrees, tolerance) in [(10.0_f64, 1e-12), (90.0, 1e-12), (179.0, 1e-8)] {
        let observable = format!("theta,omega,tension (theta0={degrees} deg)");
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let mut simulation = load(
            "Dop853",
            0.01,
            &format!(
                "bodies: [(name: \"bob\", at: ({sin:?}, {:?}), mass: 1, atoms: Disc(radius: 0.1))],
                 joints: [Distance(name: \"rod\", a: World, anchor_a: (0, 0), b: \"bob\", length: 1)]",
                -cos
            ),
        );
        for time in truth.times(&observable) {
            run_to(&mut simulation, time);
            let (place, velocity) = (simulation.bodies().position[0], simulation.bodies().velocity[0]);
            let theta = libm::atan2(place.x, -place.y);
            let joint = simulation.state().model::<Joint>().unwrap();
            let tension = joint.reaction.0.dot(-place.normalize());
            let error = off(&[theta, place.perp_dot(velocity), tension], &truth.row(&observable, time).unwrap());
            assert!(error < tolerance * 10.0, "{degrees} degrees at {time} s: {error:e}");
        }
        demand_small_drift(&simulation, "pendulum");
    }
}

const CLUSTER: &str = "bodies: [(name: \"cluster\", datum: Origin, at: (0, 0), atoms: List([
        (at: (0, 0), radius: 0.1, mass: 1), (at: (0.3, -0.2), radius: 0.15, mass: 1.5), (at: (0.5, 0.1), radius: 0.1, mass: 0.7)]))],
    joints: [Revolute(name: \"pin\", a: World, b: \"cluster\", anchor_b: (0, 0))]";

/// Source: J02. The inertia is that of the atoms as discs, the anchor is counted from the origin of the atoms.
#[test]
fn a_cluster_on_a_pin_swings_and_pulls_as_a_compound_pendulum() {
    let truth = truth("J02_compound_pendulum");
    let mut simulation = load("Dop853", 0.01, CLUSTER);
    for time in truth.times("theta,omega") {
        run_to(&mut simulation, time);
        let bodies = simulation.bodies();
        let angle = truth.row("body rotation angle (theta-theta0)", time).unwrap()[0];
        let spin = truth.row("theta,omega", time).unwrap()[1];
        assert!(off(&[bodies.angle[0], bodies.spin[0]], &[angle, spin]) < 1e-12, "at {time} s");
        let force = simulation.state().model::<Joint>().unwrap().reaction.0;
        let exact = truth.row("pin reaction on body [Fx,Fy]", time).unwrap();
        assert!(off(&force.to_array(), &exact) < 1e-9, "at {time} s: {force}");
    }
    demand_small_drift(&simulation, "cluster");
    let card = simulation.card();
    assert!(card.energy.residual.abs() < 1e-12 && card.momentum_residual.iter().all(|n| n.abs() < 1e-11), "{card}");
}

/// Source: J02 at 3 s. With half the tick the error of a method of order `p` is `2^-p` of it, within a quarter of an order; under `Dop853`
/// both are rounding.
#[test]
fn every_method_keeps_its_order_on_joints() {
    let truth = truth("J02_compound_pendulum");
    let exact = truth.row("body rotation angle (theta-theta0)", 3.0).unwrap()[0];
    for (method, order) in METHODS {
        let error = |tick: f64| {
            let mut simulation = load(method, tick, CLUSTER);
            run_to(&mut simulation, 3.0);
            demand_small_drift(&simulation, method);
            (simulation.bodies().angle[0] - exact).abs()
        };
        let fine = if order == 1 { 0.0005 } else { 0.0025 };
        let (coarse, fine) = (error(2.0 * fine), error(fine));
        if order == 8 {
            assert!(coarse < 1e-11 && fine < 1e-12, "{method}: {coarse:e}, {fine:e}");
        } else {
            let found = (coarse / fine).log2();
            assert!((found - f64::from(order)).abs() < 0.25, "{method}: {coarse:e}, {fine:e}: order {found}");
        }
    }
}

/// Sources: J03 until 5 s, J04 until 3 s.
#[test]
fn double_and_triple_pendulums_follow_the_reference() {
    let double = truth("J03_double_pendulum");
    let right = std::f64::consts::FRAC_PI_2;
    let mut simulation = load(
        "Dop853",
        0.01,
        "bodies: [(name: \"a\", at: (1, 0), mass: 1, atoms: Disc(radius: 0.1)), (name: \"b\", at: (2, 0), mass: 1, atoms: Disc(radius: 0.1))],
         joints: [Distance(a: World, anchor_a: (0, 0), b: \"a\", length: 1), Distance(a: \"a\", b: \"b\", length: 1)]",
    );
    for time in double.times("theta..omega (t<=5)") {
        run_to(&mut simulation, time);
        let bodies = simulation.bodies();
        let exact = double.row("theta..omega (t<=5)", time).unwrap();
        let hangs = |angle: f64| DVec2::new(libm::sin(angle), -libm::cos(angle));
        let first = hangs(exact[0]);
        let error = bodies.position[0].distance(first).max(bodies.position[1].distance(first + hangs(exact[1])));
        assert!(error < 1e-11, "double at {time} s: {error:e}");
    }
    demand_small_drift(&simulation, "double");
    let triple = truth("J04_triple_pendulum");
    let link = |mass: f64, length: f64, degrees: f64| Link {
        mass,
        length,
        center: 0.5 * length,
        inertia: mass * length * length / 12.0,
        angle: degrees.to_radians(),
    };
    let (bodies, joints, _) = chain(&[link(1.0, 1.0, 100.0), link(0.8, 0.8, 80.0), link(0.6, 0.6, 120.0)]);
    let mut simulation = load("Dop853", 0.001, &format!("bodies: [{bodies}], joints: [{joints}]"));
    for time in triple.times("theta..omega (t<=3)") {
        run_to(&mut simulation, time);
        let exact = triple.row("theta..omega (t<=3)", time).unwrap();
        let mut found = angles(&simulation, 3);
        // Angles of the reference are within one turn.
        for (found, exact) in found[..3].iter_mut().zip(&exact) {
            *found += 4.0 * right * ((exact - *found) / (4.0 * right)).round();
        }
        let error = off(&found, &exact);
        assert!(error < 1e-11, "triple at {time} s: {error:e}");
    }
    demand_small_drift(&simulation, "triple");
}

fn parallelogram(cranks: usize) -> String {
    let (sin, cos) = libm::sincos(60.0_f64.to_radians());
    let (mut bodies, mut joints) = (String::new(), String::new());
    for crank in 0..cranks {
        let x = crank as f64;
        let turned = (60.0_f64 - 90.0).to_radians();
        writeln!(
            bodies,
            "(name: \"crank{crank}\", at: ({:?}, {:?}), angle: {turned:?}, mass: 0.5, inertia: {:?}, atoms: Disc(radius: 0.02)),",
            x + 0.5 * sin,
            -0.5 * cos,
            0.5 / 12.0
        )
        .unwrap();
        writeln!(joints, "Revolute(a: World, anchor_a: ({x}, 0), b: \"crank{crank}\", anchor_b: (-0.5, 0)),").unwrap();
        writeln!(
            joints,
            "Revolute(a: \"crank{crank}\", anchor_a: (0.5, 0), b: \"coupler\", anchor_b: ({:?}, 0)),",
            x - 1.0
        )
        .unwrap();
    }
    let coupler = format!(
        "(name: \"coupler\", at: ({:?}, {:?}), mass: 2, inertia: 0.7, atoms: Disc(radius: 0.02)),",
        1.0 + sin,
        -cos
    );
    format!("bodies: [{bodies} {coupler}], joints: [{joints}]")
}

/// Source: J12. The third crank is redundant: its rows follow from the others, the motion does not change but for its mass.
#[test]
fn loops_move_exactly_with_redundant_cranks_too() {
    let truth = truth("J12_parallelogram");
    for cranks in [2, 3] {
        let observable = format!("theta,omega with {cranks} cranks");
        for (method, tick, tolerance) in [("Dop853", 0.01, 1e-11), ("VelocityVerlet", 0.001, 1e-4)] {
            let mut simulation = load(method, tick, &parallelogram(cranks));
            for time in truth.times(&observable) {
                run_to(&mut simulation, time);
                let exact = truth.row(&observable, time).unwrap();
                let bodies = simulation.bodies();
                for crank in 0..cranks {
                    let found = [bodies.angle[crank] + std::f64::consts::FRAC_PI_2, bodies.spin[crank]];
                    let error = off(&found, &exact);
                    assert!(error < tolerance, "{method}, {cranks} cranks at {time} s: {error:e}");
                }
                assert!(bodies.angle[cranks].abs() < 1e-12, "the coupler stays level");
            }
            demand_small_drift(&simulation, method);
            let card = simulation.card();
            let told = card.notes.iter().any(|note| note.contains("follow from others"));
            assert_eq!(told, cranks == 3, "the third crank holds what two do: {:?}", card.notes);
        }
    }
    let simulation = load("VelocityVerlet", 0.001, CLUSTER);
    assert!(!simulation.card().notes.iter().any(|note| note.contains("follow from others")));
}

/// Source: S06, ten links of 0.01 kg with a load of 100 kg. Tolerance: the stiff modes of light links turn rounding of the state into
/// `1e4` times as much of their accelerations.
#[test]
fn a_light_rope_bears_a_load_of_ten_thousand_links() {
    let truth = truth("S06_rope_heavy_load");
    let link =
        |_| Link { mass: 0.01, length: 0.2, center: 0.1, inertia: 0.01 * 0.04 / 12.0, angle: 30.0_f64.to_radians() };
    let links: Vec<Link> = (0..10).map(link).collect();
    let (bodies, joints, end) = chain(&links);
    let load_of =
        format!("(name: \"load\", at: ({:?}, {:?}), mass: 100, inertia: 1, atoms: Disc(radius: 0.1)),", end.x, end.y);
    let hook = "Revolute(name: \"hook\", a: \"link9\", anchor_a: (0.1, 0), b: \"load\", anchor_b: (0, 0)),";
    let scene = format!("bodies: [{bodies} {load_of}], joints: [{joints} {hook}]");
    let observable = "link angles after release of the straight rope";
    for (method, tick, tolerance) in [("Dop853", 0.0005, 1e-9), ("VelocityVerlet", 0.0002, 1e-3)] {
        let mut simulation = load(method, tick, &scene);
        for time in truth.times(observable) {
            run_to(&mut simulation, time);
            let exact = truth.row(observable, time).unwrap();
            let error = off(&angles(&simulation, 10)[..10], &exact[..10]);
            assert!(error < tolerance, "{method} at {time} s: {error:e}");
        }
        demand_small_drift(&simulation, method);
    }
}

/// Law: RATTLE is symplectic (Hairer, Lubich, Wanner, theorem VII.1.3), so the energy of a conservative mechanism has no trend: its
/// greatest error in a million ticks is that of the first fifty thousand, within a tenth.
#[test]
fn energy_of_velocity_verlet_has_no_trend_in_a_million_ticks() {
    let mut simulation = load("VelocityVerlet", 0.002, CLUSTER);
    let mut worst = [0.0_f64; 2];
    for look in 1..=20_000 {
        simulation.run_to_tick(50 * look).unwrap();
        let error = simulation.card().energy.residual.abs();
        worst[usize::from(look > 1000)] = error.max(worst[usize::from(look > 1000)]);
    }
    assert!(worst[1] < 1.1 * worst[0], "{worst:?}");
    assert!(worst[0] > 1e-9, "it is an error of the method: {worst:?}");
    demand_small_drift(&simulation, "a million ticks");
}

/// Source: J10. A rod falls over its hinge from 5 degrees beside the vertical; a chain of six links falls from the horizontal.
#[test]
fn a_rod_falls_over_its_hinge_and_a_chain_from_the_horizontal() {
    let truth = truth("J10_hinged_rod_fall");
    let time = truth.number("time to horizontal");
    let (sin, cos) = libm::sincos(85.0_f64.to_radians());
    let mut simulation = load(
        "Dop853",
        time / 200.0,
        &format!(
            "bodies: [(name: \"rod\", at: ({:?}, {:?}), angle: \"85 deg\", mass: 1, inertia: {:?}, atoms: Disc(radius: 0.02))],
             joints: [Revolute(name: \"hinge\", a: World, anchor_a: (0, 0), b: \"rod\", anchor_b: (-0.5, 0))]",
            0.5 * cos,
            0.5 * sin,
            1.0 / 12.0
        ),
    );
    simulation.run_to_tick(200).unwrap();
    let speed = truth.number("angular speed at horizontal");
    let bodies = simulation.bodies();
    assert!(off(&[bodies.angle[0], -bodies.spin[0]], &[0.0, speed]) < 1e-12, "{} {}", bodies.angle[0], bodies.spin[0]);
    let force = simulation.state().model::<Joint>().unwrap().reaction.0;
    let exact = truth.numbers("hinge force at horizontal [horizontal,vertical]");
    assert!(off(&force.to_array(), &exact) < 1e-9, "{force}");
    let link = |_| Link {
        mass: 0.1,
        length: 0.2,
        center: 0.1,
        inertia: 0.1 * 0.04 / 12.0,
        angle: std::f64::consts::FRAC_PI_2,
    };
    let links: Vec<Link> = (0..6).map(link).collect();
    let (bodies, joints, _) = chain(&links);
    let mut simulation = load("Dop853", 0.001, &format!("bodies: [{bodies}], joints: [{joints}]"));
    let observable = "6-link chain released horizontally: angles";
    for time in truth.times(observable) {
        run_to(&mut simulation, time);
        let error = off(&angles(&simulation, 6)[..6], &truth.row(observable, time).unwrap());
        assert!(error < 1e-9, "at {time} s: {error:e}");
    }
    demand_small_drift(&simulation, "falling chain");
}

/// Source: J09. A chain of twenty links between two pins that begins in the shape in which it hangs stays in it: a closed loop of forces.
/// Tolerance: the shape is known to 1e-15 m, and a chain off by that swings about as far; of the
/// forces, 1e-9 N.
#[test]
fn a_hanging_chain_stays_in_its_shape() {
    let nodes = truth("J09_catenary").numbers("node positions");
    let nodes: Vec<DVec2> = nodes.chunks_exact(2).map(|place| DVec2::new(place[0], place[1])).collect();
    let (mut bodies, mut joints) = (String::new(), String::new());
    for (number, ends) in nodes.windows(2).enumerate() {
        let (middle, along) = (0.5 * (ends[0] + ends[1]), ends[1] - ends[0]);
        writeln!(
            bodies,
            "(name: \"link{number}\", at: ({:?}, {:?}), angle: {:?}, mass: 0.05, inertia: {:?}, atoms: Disc(radius: 0.005)),",
            middle.x,
            middle.y,
            libm::atan2(along.y, along.x),
            0.05 * 0.01 / 12.0
        )
        .unwrap();
        let left = match number {
            0 => "a: World, anchor_a: (0, 0)".to_owned(),
            _ => format!("a: \"link{}\", anchor_a: (0.05, 0)", number - 1),
        };
        writeln!(joints, "Revolute({left}, b: \"link{number}\", anchor_b: (-0.05, 0)),").unwrap();
    }
    joints += "Revolute(a: World, anchor_a: (1.4, 0), b: \"link19\", anchor_b: (0.05, 0))";
    for method in ["VelocityVerlet", "Dop853"] {
        let mut simulation = load(method, 0.001, &format!("bodies: [{bodies}], joints: [{joints}]"));
        let before = simulation.bodies().position.clone();
        run_to(&mut simulation, 1.0);
        let moved = simulation.bodies().position.iter().zip(&before).map(|(now, was)| now.distance(*was));
        let moved = moved.fold(0.0, f64::max);
        assert!(moved < 1e-10, "{method}: {moved:e}");
        let joint = simulation.state().model::<Joint>().unwrap();
        let exact = truth("J09_catenary").numbers("pin force left on chain [Fx,Fy]");
        assert!(off(&joint.reaction.0.to_array(), &exact) < 1e-9, "{method}: {}", joint.reaction.0);
        demand_small_drift(&simulation, method);
    }
}

/// Law: a grid of discs with pins in all four directions, more rows than its bodies have freedoms, is a rigid body that hangs in two corners: it
/// stays, and the pins of the corners bear its weight. Tolerance: rounding of a weight of 78 N. The card has nothing to say against
/// a structure that stands still.
#[test]
fn a_grid_with_more_pins_than_freedoms_hangs_still() {
    let (size, pitch) = (9, 0.2);
    let (mut bodies, mut joints) = (String::new(), String::new());
    for column in 0..size {
        for row in 0..size {
            let fixed = row == 0 && (column == 0 || column == size - 1);
            let (x, y) = (pitch * f64::from(column), -pitch * f64::from(row));
            writeln!(
                bodies,
                "(name: \"d{column}_{row}\", at: ({x:?}, {y:?}), mass: 0.1, fixed: {fixed}, atoms: Disc(radius: 0.08)),"
            )
            .unwrap();
            for (right, down, from, to) in [(1, 0, "(0.1, 0)", "(-0.1, 0)"), (0, 1, "(0, -0.1)", "(0, 0.1)")] {
                let (next, below) = (column + right, row + down);
                if next < size && below < size {
                    writeln!(
                        joints,
                        "Revolute(a: \"d{column}_{row}\", anchor_a: {from}, b: \"d{next}_{below}\", anchor_b: {to}),"
                    )
                    .unwrap();
                }
            }
        }
    }
    for method in ["VelocityVerlet", "RungeKutta4"] {
        let mut simulation = load(method, 0.01, &format!("bodies: [{bodies}], joints: [{joints}]"));
        let before = simulation.bodies().position.clone();
        run_to(&mut simulation, 0.5);
        let moved = simulation.bodies().position.iter().zip(&before).map(|(now, was)| now.distance(*was));
        assert!(moved.fold(0.0, f64::max) < 1e-13, "{method}");
        let state = simulation.state();
        let corners = state.models_of::<Joint>().filter(|joint| {
            joint.pair(state.bodies()).is_some_and(|pair| {
                pair.a.body.is_some_and(|body| !state.bodies().dynamic[body])
                    || pair.b.body.is_some_and(|body| !state.bodies().dynamic[body])
            })
        });
        // The reaction acts on the second body, which is a corner in one of the four joints.
        let weight: f64 = corners
            .map(|joint| {
                let pair = joint.pair(state.bodies()).unwrap();
                let on_grid = pair.b.body.is_some_and(|body| state.bodies().dynamic[body]);
                if on_grid { joint.reaction.0.y } else { -joint.reaction.0.y }
            })
            .sum();
        let exact = 0.1 * 9.81 * f64::from(size * size - 2);
        assert!((weight - exact).abs() < 1e-9, "{method}: {weight} instead of {exact}");
        let card = simulation.card();
        assert!(card.verdict.starts_with("Trust") || !card.verdict.contains("Do not"), "{method}: {}", card.verdict);
        demand_small_drift(&simulation, method);
    }
}

/// Two wheels that turn about their centres, one of them at the origin, and a pendulum on the second: gears divide the torque as they
/// divide the rates. Where nothing has a size but the wheels, gaps of rounding are no failure. The energy is that of the start, and the
/// angles keep their ratio.
#[test]
fn gears_about_the_origin_keep_their_ratio_and_the_energy() {
    for (method, tolerance) in
        [("Dop853", 1e-11), ("RungeKutta4", 1e-7), ("VelocityVerlet", 1e-3), ("Symplectic4", 1e-6)]
    {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 3, tick: \"1 ms\", method: {method}), gravity: (0, -9.81), contacts: None,
             bodies: [(name: \"first\", at: (0, 0), spin: 3, mass: 2, inertia: 0.3, atoms: Disc(radius: 0.05)),
                (name: \"second\", at: (1, 0), spin: -6, mass: 1, inertia: 0.1, atoms: Disc(radius: 0.05)),
                (name: \"bob\", at: (1, -0.7), velocity: (-1.8, 0), mass: 0.5, inertia: 0.02, atoms: Disc(radius: 0.05))],
             joints: [Revolute(name: \"p\", a: World, anchor_a: (0, 0), b: \"first\"),
                Revolute(name: \"q\", a: World, anchor_a: (1, 0), b: \"second\"), GearPair(of: (\"p\", \"q\"), ratio: -2),
                Revolute(a: \"second\", anchor_a: (0, -0.3), b: \"bob\", anchor_b: (0, 0.4))],
             sensors: [Energy()])"
        );
        let mut simulation =
            Simulation::load(&Source::new("gears.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_tick(3000).unwrap_or_else(|failure| panic!("{method}: {failure}"));
        let bodies = simulation.bodies();
        assert!((bodies.angle[1] + 2.0 * bodies.angle[0]).abs() < 1e-13, "{method}");
        assert!(bodies.position[0].length() < 1e-14, "{method}");
        let residual = simulation.card().energy.residual;
        assert!(residual.abs() < tolerance, "{method}: {residual}");
    }
}
