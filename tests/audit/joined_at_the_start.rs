//! Law: bodies that touch at the start and that joints hold begin in equilibrium, like single bodies. Source: statics. A pair that its
//! joints make rigid stands on all its corners like one plate on springs. The springs bear its weight and its moment. A load that
//! changes below friction moves nothing. A cart with free wheels rolls down a slope with `M g sin a / (M + sum I/r^2)` from the first
//! moment on.
//!
//! Tolerances: the plate sinks as far as springs give, to the square of its small turn. Bodies that stand keep their places to the last
//! bit under located events. From tick to tick they creep by a share of the give of their springs. The way of a cart is right to
//! rounding of its places, and to the share of 1e-7 by which the search for the start may end.
//!
//! Bodies that the scene leaves as placed drop onto their springs first. Once they stand, the same loads move nothing.
//!
//! Not tested: joints that move at the start, whose bodies begin as placed.

use glam::DVec2;

use super::begins_at_rest::{GRAVITY, load, scene, ways};

const FLOOR: &str = "walls: [(name: \"floor\", left: (9, 0), right: (-9, 0), material: \"m\")]";

/// The radius of corners in metres.
const ROUND: f64 = 0.005;

/// A box on the floor.
struct Block {
    x: f64,
    width: f64,
    height: f64,
    mass: f64,
}

impl Block {
    fn text(&self, name: &str) -> String {
        let Self { x, width, height, mass } = self;
        format!(
            "(name: \"{name}\", at: ({x:?}, {:?}), mass: {mass:?}, material: \"m\", \
             shape: Rectangle(width: {width:?}, height: {height:?}, rounding: {ROUND:?}))",
            0.5 * height
        )
    }

    fn corners(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|sign| self.x + sign * (0.5 * self.width - ROUND))
    }
}

/// Pairs with the stiffness of their contacts.
fn pairs() -> [(f64, [Block; 2]); 3] {
    let block = |x: f64, width: f64, height: f64, mass: f64| Block { x, width, height, mass };
    [
        (1e5, [block(-0.5, 0.4, 0.2, 2.0), block(0.5, 0.4, 0.2, 2.5)]),
        (1e6, [block(-0.7, 0.3, 0.3, 0.4), block(0.1, 0.9, 0.3, 7.0)]),
        (3e4, [block(-1.0, 1.0, 0.1, 1.0), block(0.3, 0.2, 0.1, 1.5)]),
    ]
}

fn on_floor(stiffness: f64, blocks: &[Block; 2], joint: &str, rest: &str) -> String {
    on_floor_from("", stiffness, blocks, joint, rest)
}

fn on_floor_from(start: &str, stiffness: f64, blocks: &[Block; 2], joint: &str, rest: &str) -> String {
    let [a, b] = blocks;
    let things = format!("{FLOOR}, bodies: [{}, {}], joints: [{joint}], {rest}", a.text("a"), b.text("b"));
    scene(start, &format!("stiffness: {stiffness:?}, restitution: 0.3, friction: 0.4"), &things, 1.0)
}

const RIGID: [&str; 2] = ["Prismatic(name: \"s\", a: \"a\", b: \"b\", axis: (1, 0))", "Weld(a: \"a\", b: \"b\")"];

#[test]
fn a_rigid_pair_begins_like_one_plate_on_springs() {
    for (stiffness, blocks) in pairs() {
        let corners: Vec<f64> = blocks.iter().flat_map(Block::corners).collect();
        let [zeroth, first, second] = [0, 1, 2].map(|power| corners.iter().map(|x| x.powi(power)).sum::<f64>());
        let [load_of, moment] = [0, 1].map(|power| {
            blocks.iter().map(|block| block.mass * GRAVITY * block.x.powi(power)).sum::<f64>() / stiffness
        });
        let determinant = zeroth * second - first * first;
        let (depth, turn) =
            ((load_of * second - moment * first) / determinant, (zeroth * moment - first * load_of) / determinant);
        for joint in RIGID {
            let text = on_floor(stiffness, &blocks, joint, "");
            for (name, overrides) in ways() {
                let mut simulation = load(&text, &overrides);
                let begin = simulation.bodies().position.clone();
                for (body, block) in blocks.iter().enumerate() {
                    let sunk = 0.5 * block.height - begin[body].y;
                    let exact = depth + turn * block.x;
                    assert!((sunk - exact).abs() < 1e-3 * depth, "{name}, {joint}: {sunk} m for {exact} m");
                    let turned = simulation.bodies().angle[body];
                    assert!((turned + turn).abs() < 1e-3 * depth, "{name}, {joint}: {turned} for {}", -turn);
                }
                simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
                assert_eq!(simulation.bodies().position, begin, "{name}, {joint}");
            }
        }
    }
}

#[test]
fn a_load_below_friction_moves_no_pair_on_a_slide() {
    for (stiffness, blocks) in pairs() {
        let weight = blocks.iter().map(|block| block.mass).fold(f64::INFINITY, f64::min) * GRAVITY;
        for share in [0.2, 0.3] {
            let amplitude = share * weight;
            let push =
                format!("controllers: [Actuator(of: \"s\", force: Sine(amplitude: {amplitude:?}, frequency: 3.7))]");
            let text = on_floor(stiffness, &blocks, RIGID[0], &push);
            for (name, overrides) in ways() {
                let mut simulation = load(&text, &overrides);
                let begin = simulation.bodies().position.clone();
                simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
                let allowed = if name == "default" { 1e-2 * weight / stiffness } else { 0.0 };
                for (body, begin) in begin.iter().enumerate() {
                    let moved = simulation.bodies().position[body].distance(*begin);
                    assert!(moved <= allowed, "{name}, {amplitude} N: body {body} moved by {moved:e} m");
                }
            }
        }
    }
}

#[test]
fn a_load_below_friction_moves_no_pair_that_has_settled() {
    const SETTLED: f64 = 0.5;
    for (stiffness, blocks) in pairs() {
        let weight = blocks.iter().map(|block| block.mass).fold(f64::INFINITY, f64::min) * GRAVITY;
        for share in [0.2, 0.3] {
            let most = share * weight;
            let push = format!(
                "controllers: [Actuator(of: \"s\", force: Course([({SETTLED:?}, 0), (0.6, {most:?}), (0.7, {:?}), \
                 (0.8, {most:?}), (1, 0)]))]",
                -most
            );
            let text = on_floor_from("start: AsPlaced", stiffness, &blocks, RIGID[0], &push);
            for (name, overrides) in &ways()[1..] {
                let mut simulation = load(&text, overrides);
                let ticks = (SETTLED / simulation.clock().dt).round() as u64;
                simulation.run_to_tick(ticks).unwrap_or_else(|failure| panic!("{failure}\n{text}"));
                let settled = simulation.bodies().position.clone();
                simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
                for (body, settled) in settled.iter().enumerate() {
                    let moved = simulation.bodies().position[body].distance(*settled);
                    assert!(moved == 0.0, "{name}, {most} N: body {body} moved by {moved:e} m\n{text}");
                }
            }
        }
    }
}

/// The stiffness of a cart's contacts in N/m.
const CART: f64 = 1e6;

/// A body on two discs, on a slope through the origin.
fn cart(angle: f64, body: f64, wheel: f64) -> String {
    let along = DVec2::new(libm::cos(angle), libm::sin(angle));
    let at = |x: f64, y: f64| {
        let at = along * x + along.perp() * y;
        format!("at: ({:?}, {:?}), angle: {angle:?}, material: \"m\"", at.x, at.y)
    };
    let disc =
        |name: &str, x: f64| format!("(name: \"{name}\", {}, atoms: Disc(radius: 0.1, mass: {wheel:?}))", at(x, 0.1));
    let end = along * 30.0;
    let things = format!(
        "walls: [(name: \"ramp\", left: ({:?}, {:?}), right: ({:?}, {:?}), material: \"m\")], bodies: [\
         (name: \"cart\", {}, mass: {body:?}, shape: Rectangle(width: 0.8, height: 0.2)), {}, {}], joints: [\
         Revolute(a: \"cart\", anchor_a: (-0.3, -0.15), b: \"p\"), Revolute(a: \"cart\", anchor_a: (0.3, -0.15), b: \"q\")]",
        end.x,
        end.y,
        -end.x,
        -end.y,
        at(0.0, 0.25),
        disc("p", -0.3),
        disc("q", 0.3)
    );
    scene("", &format!("stiffness: {CART:?}, restitution: 0.2, friction: 0.8"), &things, 0.4)
}

#[test]
fn a_cart_rolls_down_a_slope_from_the_first_moment_on() {
    for (angle, body, wheel) in [(0.1, 4.0, 0.5), (-0.25, 50.0, 0.05), (0.4, 1.0, 3.0)] {
        let text = cart(angle, body, wheel);
        // A disc has I = m r^2/2. It rolls on the radius that its overlap leaves.
        let weight = (body + 2.0 * wheel) * GRAVITY;
        let rolls = 0.1 - 0.5 * weight * libm::cos(angle) / CART;
        let turning = wheel * (0.1 / rolls).powi(2);
        let acceleration = weight * libm::sin(angle) / (body + 2.0 * wheel + turning);
        for (name, overrides) in ways() {
            let mut simulation = load(&text, &overrides);
            assert!(simulation.notes().iter().any(|note| note.starts_with("start: ")), "{name}\n{text}");
            let begin = simulation.bodies().position[0];
            simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
            let moved = simulation.bodies().position[0] - begin;
            let exact = -0.5 * acceleration * 0.4 * 0.4;
            let along = DVec2::new(libm::cos(angle), libm::sin(angle));
            let error = (moved - along * exact).length();
            assert!(error < 1e-6 * exact.abs(), "{name}, {angle}, {body} kg: off by {error:e} m of {exact} m");
        }
    }
}

/// A slide lets its box sink by less than its springs give, and a taut rope by nothing. There it stands, with the rest of its weight.
#[test]
fn a_joint_is_never_put_beyond_its_limit() {
    const LOWEST: f64 = -1e-5;
    let slide = format!("Prismatic(a: World, anchor_a: (0, 0.1), b: \"a\", axis: (0, 1), limits: ({LOWEST:?}, 1))");
    let rope = "Rope(a: World, anchor_a: (0, 0.7), b: \"a\", anchor_b: (0, 0.1))".to_owned();
    let block = Block { x: 0.0, width: 0.5, height: 0.2, mass: 2.0 };
    for (joint, lowest) in [(slide, LOWEST), (rope, 0.0)] {
        let things = format!("{FLOOR}, bodies: [{}], joints: [{joint}]", block.text("a"));
        let text = scene("", "stiffness: 1e5, restitution: 0, friction: 0.4", &things, 0.2);
        for (name, overrides) in ways() {
            let mut simulation = load(&text, &overrides);
            let begin = simulation.bodies().position[0];
            assert_eq!(begin, DVec2::new(0.0, 0.1), "{name}, {joint}");
            simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
            let sunk = simulation.bodies().position[0].y - begin.y;
            assert!((sunk - lowest).abs() < 1e-9, "{name}, {joint}: {sunk} m");
        }
    }
}
