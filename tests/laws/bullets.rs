//! Laws of fast bodies and thin walls: nothing passes through unsaid.
//!
//! A contact stops a bullet if it is stiff enough and the tick is short enough. If not, the run ends, and names one of the two at least. Not tested: discs that
//! pass each other in a tick, of which the card warns.

use jostle::Simulation;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::support::load;

/// A wall of 2 m along y that is so thick, and a bullet on its left.
#[derive(Clone, Debug)]
struct Shot {
    wall: &'static str,
    thickness: f64,
    fixed: bool,
    bullet: &'static str,
    speed: f64,
    spin: f64,
    angle: f64,
    /// How far the bullet goes in a tick, as a share of the thickness.
    share: f64,
    stiffness: f64,
}

impl Shot {
    fn fired(&self, clock: &str) -> (Simulation, u64) {
        let Self { thickness, speed, spin, angle, stiffness, .. } = self;
        let tick = self.share * thickness / speed;
        let half = format!("{:?}", 0.5 * thickness);
        let wall = self.wall.replace("THICKNESS", &format!("{thickness:?}")).replace("HALF", &half);
        let free = if self.fixed { "fixed: true" } else { "mass: 3" };
        let text = format!(
            "Scene(format: 1, clock: (duration: 1, tick: {tick:e}, {clock}),
             materials: {{\"default\": (stiffness: {stiffness:?}, restitution: 0.7)}},
             bodies: [(name: \"wall\", at: (0, 0), {free}, shape: {wall}),
                (name: \"bullet\", at: (-0.03, 0.1), angle: {angle:?}, velocity: ({speed:?}, 0), spin: {spin:?}, mass: 0.01, shape: {})])",
            self.bullet
        );
        (load(&text), (0.06 / (self.share * thickness)).ceil() as u64)
    }
}

prop_compose! {
    fn shots()(
        wall in prop::sample::select(vec![
            "Rectangle(width: THICKNESS, height: 2)",
            "Rectangle(width: THICKNESS, height: 2, rounding: \"0.2 mm\")",
            "Capsule(from: (0, -1), to: (0, 1), radius: HALF)",
        ]),
        bullet in prop::sample::select(vec![
            "Disc(radius: 0.004)",
            "Rectangle(width: 0.01, height: 0.006)",
            "Capsule(from: (-0.006, 0), to: (0.006, 0), radius: 0.003)",
            "Regular(sides: 5, radius: 0.006, rounding: 0.001)",
        ]),
        thickness in 0.0005..0.004_f64,
        fixed in any::<bool>(),
        speed in 5.0..500.0_f64,
        spin in -1e4..1e4_f64,
        angle in 0.0..6.0_f64,
        share in 0.05..20.0_f64,
        stiffness in prop::sample::select(vec![1e4, 1e6, 1e8]),
    ) -> Shot {
        Shot { wall, thickness, fixed, bullet, speed, spin, angle, share, stiffness }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default() })]

    /// Law: a bullet is on its side of the wall at the end, or the run ends before and names one of the two.
    #[test]
    fn no_bullet_passes_unsaid(shot in shots(), method in prop::sample::select(vec!["VelocityVerlet", "RungeKutta4"])) {
        let (mut simulation, ticks) = shot.fired(&format!("method: {method}"));
        if let Err(failure) = simulation.run_to_tick(ticks) {
            let told = failure.to_string();
            prop_assert!(told.contains("bullet") || told.contains("wall"), "{told}");
            return Ok(());
        }
        let bodies = simulation.bodies();
        let place = |name: &str| {
            let slot = (0..bodies.len()).find(|slot| simulation.name(*slot) == name).expect("the body is there");
            (bodies.position[slot], bodies.angle[slot])
        };
        let ((wall, turned), (bullet, _)) = (place("wall"), place("bullet"));
        let (sin, cos) = turned.sin_cos();
        let from = bullet - wall;
        let across = from.x * cos + from.y * sin;
        prop_assert!(across < 0.0, "{across} m, {shot:?}");
    }
}
