//! Law: a torque that comes and goes rolls a disc only while it exceeds the resistance, and the resistance stops the disc again. Source:
//! Coulomb's law for rolling (type C of Ai, Chen, Rotter and Ooi 2011), and the moment of inertia about the point of contact, `J = 3/2 m
//! R^2`. A torque rises by `c` in N m/s up to `c t0`, and falls as fast. The resistance `b = mu_r R m g` gives way at `b/c`, which is
//! `u` before the peak. The net torque is the same `u` behind it, and there the disc is fastest. The resistance brakes it `2 u` behind
//! the peak and later, and it stops `sqrt(2) u` later still. It has turned by `(1 + 2 sqrt(2)/3) c u^3/J`.
//!
//! Tolerance: the springs of friction and of resistance give by `mu m g/k` at their surfaces, twice: as they are drawn and let go. The
//! way of the disc is 50 times that or more.

use jostle::simulation::Overrides;

use super::begins_at_rest::{GRAVITY, load, scene, ways};

const STIFFNESS: f64 = 1e7;

struct Torque {
    radius: f64,
    mass: f64,
    /// Coefficient of rolling resistance.
    rolling: f64,
    /// Of the peak, over the resistance.
    excess: f64,
    /// Time of the peak in s.
    peak: f64,
}

impl Torque {
    fn resistance(&self) -> f64 {
        self.rolling * self.radius * self.mass * GRAVITY
    }

    fn turns(&self) -> f64 {
        let rate = self.excess * self.resistance() / self.peak;
        let before_peak = self.peak * (1.0 - 1.0 / self.excess);
        let inertia = 1.5 * self.mass * self.radius * self.radius;
        (1.0 + 2.0 * 2.0_f64.sqrt() / 3.0) * rate * before_peak.powi(3) / inertia
    }

    /// The angle at the end, after the disc has stopped.
    fn angle(&self, normal: &str, overrides: &Overrides) -> f64 {
        let Self { radius, mass, rolling, excess, peak } = *self;
        let (material, contacts) = (
            format!("stiffness: {STIFFNESS:?}, friction: 0.5, restitution: 0.1"),
            format!("normal: {normal}, rolling: Spring(friction: {rolling:?})"),
        );
        let things = format!(
            "walls: [(name: \"floor\", left: (9, 0), right: (-9, 0), material: \"m\")], \
             bodies: [(name: \"a\", at: (0, {radius:?}), mass: {mass:?}, material: \"m\", shape: Disc(radius: {radius:?}))], \
             forces: [Drive(of: \"a\", torque: {:?}, course: Piecewise([(0, 0), ({peak:?}, 1), ({:?}, 0)]))]",
            excess * self.resistance(),
            2.0 * peak
        );
        let mut simulation = load(&scene(&contacts, &material, &things, 2.5 * peak), overrides);
        simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}"));
        simulation.bodies().angle[0]
    }
}

#[test]
fn a_torque_that_ebbs_leaves_a_disc_where_its_resistance_stops_it() {
    let torques = [
        Torque { radius: 0.1, mass: 1.0, rolling: 0.05, excess: 1.2, peak: 0.3 },
        Torque { radius: 0.2, mass: 0.5, rolling: 0.02, excess: 1.4, peak: 0.2 },
        Torque { radius: 0.05, mass: 2.0, rolling: 0.1, excess: 1.3, peak: 0.25 },
    ];
    for torque in &torques {
        // Shares of both springs, the rolling one a circle of the radius.
        let gives = 2.0 * (0.5 + torque.rolling) * torque.mass * GRAVITY / (0.8 * STIFFNESS * torque.radius);
        for normal in ["Dashpot", "Inelasticity"] {
            for (way, overrides) in ways() {
                let (found, law) = (torque.angle(normal, &overrides), torque.turns());
                assert!((found - law).abs() < gives, "{normal}, {way}: {found} instead of {law}, {gives:e} allowed");
                assert!(law > 50.0 * gives, "the law {law} is no more than what springs give");
            }
        }
    }
}

/// Law: the way of a body that stands is that of its springs, a share of their depth. A run with finer steps agrees with it to a share
/// of that depth, and so the verdict trusts its place.
#[test]
fn a_disc_that_stands_under_a_torque_is_trusted() {
    let material = "stiffness: 1e6, friction: 0.4, restitution: 0.1";
    let things = "walls: [(name: \"floor\", left: (5, 0), right: (-5, 0), material: \"m\")], \
        bodies: [(name: \"d\", at: (0, 0.1), mass: 1, material: \"m\", shape: Disc(radius: 0.1)), \
        (name: \"p\", at: (0, 0.225), mass: 1, material: \"m\", shape: Rectangle(width: 0.6, height: 0.05, rounding: 0.002))], \
        joints: [Prismatic(name: \"j\", a: World, b: \"p\", axis: (0, 1))], \
        forces: [Thrust(of: \"p\", force: (0, -20)), \
        Drive(of: \"d\", torque: 2.02, course: Piecewise([(0, 0), (0.1, 0), (0.6, 1), (0.9, 1), (1.0, 0)]))]";
    let ran = super::ran::run(&scene("", material, things, 1.2), 1).unwrap_or_else(|why| panic!("{why}"));
    assert!(ran.is_trusted(), "{}", ran.card.verdict);
}
