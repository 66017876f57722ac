//! Laws of the force `TorsionSpring` of scenes; each test says its law and its tolerance.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

/// A damped torsion oscillator of 0.5 kg m2 on 8 N m/rad with 1.6 N m s/rad (damping ratio 0.4), let go after two and a
/// half turns: `phi = phi0 e^(-zeta w t) (cos wd t + zeta/sqrt(1 - zeta^2) sin wd t)`. Tolerance: order 2,
/// `(w dt)^2 = 1.6e-5` of the angle. Not tested: two bodies (see below).
#[test]
fn a_wound_up_flywheel_swings_back() {
    let scene = "Scene(format: 1, clock: (duration: 2, tick: \"1 ms\", method: VelocityVerlet),
        bodies: [(name: \"wheel\", at: (0, 0), angle: \"900 deg\", inertia: 0.5, atoms: Disc(radius: 0.3, mass: 1))],
        forces: [TorsionSpring(a: \"wheel\", b: World, stiffness: 8, damping: 1.6, angle: 0)])";
    let mut simulation = Simulation::load(&Source::new("wheel.ron", scene)).unwrap();
    simulation.run_to_end().unwrap();
    let (start, omega, ratio) = (5.0 * std::f64::consts::PI, 4.0, 0.4_f64);
    let root = (1.0 - ratio * ratio).sqrt();
    let (sin, cos) = libm::sincos(omega * root * 2.0);
    let exact = start * libm::exp(-ratio * omega * 2.0) * (cos + ratio / root * sin);
    let angle = simulation.bodies().angle[0];
    assert!((angle - exact).abs() < 1.6e-5 * start, "{angle} {exact}");
    let card = simulation.card();
    assert!(card.energy_error() < 1.6e-5, "{:e}", card.energy_error());
    // 4 rad/s, and damping as the method bears it: w^2 = k/I + 2 c/I w, so w = 3.2 + sqrt(3.2^2 + 16).
    let critical = 2.0 / (3.2 + 3.2_f64.hypot(4.0));
    assert!((card.critical_tick.unwrap() - critical).abs() < 1e-9, "{:?} {critical}", card.critical_tick);
}

/// Between two wheels the torques are opposite: angular momentum stays, to rounding.
#[test]
fn two_wheels_exchange_their_turn() {
    let scene = "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\"), contacts: None,
        bodies: [(name: \"a\", at: (0, 0), spin: 3, inertia: 0.5, atoms: Disc(radius: 0.3, mass: 1)),
                 (name: \"b\", at: (1, 0), inertia: 0.25, atoms: Disc(radius: 0.3, mass: 1))],
        forces: [TorsionSpring(a: \"a\", b: \"b\", stiffness: 8)])";
    let mut simulation = Simulation::load(&Source::new("wheels.ron", scene)).unwrap();
    simulation.run_to_end().unwrap();
    let spin = &simulation.bodies().spin;
    assert!((0.5 * spin[0] + 0.25 * spin[1] - 1.5).abs() < 1000.0 * f64::EPSILON, "{spin:?}");
    // w = sqrt(8 (2 + 4)) = 6.93/s: b spins with (1 - cos w t) of 2 rad/s; tolerance (w dt)^2 = 4.8e-5.
    let exact = 2.0 * (1.0 - libm::cos(48.0_f64.sqrt()));
    assert!((spin[1] - exact).abs() < 1e-4, "{} {exact}", spin[1]);
}
