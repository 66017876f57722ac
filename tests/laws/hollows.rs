//! Laws of hollows of concave shapes.
//!
//! Source: the potential of a disc and a shape of convex parts is the sum of `k/2` times the squares of its overlaps with the parts whose sides
//! meet in a hollow. So a disc that rolls in and out of a hollow without friction keeps its energy. Tolerances: at each test. Not tested:
//! hollows of gears, and those between overlapping parts of a compound.

use jostle::SimulationExt;

use super::support::{load, run_to};

/// A disc slides through the hollow of a fixed block, whose outline bends by `bend` rad. Returns the missing share of the energy after half a
/// second.
fn missing(clock: &str, bend: f64) -> f64 {
    let depth = 0.25 * libm::tan(0.5 * bend);
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 1, {clock}), gravity: (0, -9.81),
         materials: {{\"default\": (stiffness: 4e4, restitution: 1, friction: 0)}},
         bodies: [(name: \"disc\", at: (0.12, 0.05), velocity: (-0.8, -0.6), mass: 0.08, atoms: Disc(radius: 0.035)),
            (name: \"block\", at: (0, 0), datum: Origin, fixed: true,
             shape: Polygon(points: [(-0.25, -0.3), (0.25, -0.3), (0.25, 0), (0, {:?}), (-0.25, 0)]))])",
        -depth
    ));
    run_to(&mut simulation, 0.5);
    let (card, scale) = (simulation.card(), 0.5 * 0.08 + 0.08 * 9.81 * 0.1);
    assert!(card.largest_overlap.meters > 1e-3);
    card.energy.residual.abs() / scale
}

/// The angular frequency in rad/s of the disc on two contacts, `sqrt(2 k / m)`.
const PACE: f64 = 1000.0;

/// Tolerance: a method of order `p` leaves the share `(w h)^p` of the energy. A force that jumps where a side ends takes a tenth of it.
#[test]
fn a_disc_keeps_its_energy_in_a_hollow() {
    for bend in [0.05, 0.3, 0.9] {
        let found = missing("method: Dop853, tick: \"0.1 ms\"", bend);
        assert!(found < (PACE * 1e-4).powi(8), "Dop853, {bend} rad: {found:e}");
        let found = missing("method: RungeKutta4, tick: \"50 us\"", bend);
        assert!(found < (PACE * 50e-6).powi(4), "RungeKutta4, {bend} rad: {found:e}");
    }
}

/// Tolerance: velocity Verlet keeps a modified energy, which differs by the share `(w h)^2` (Hairer, Lubich, Wanner 2006, IX.8).
#[test]
fn velocity_verlet_keeps_the_energy_in_a_hollow_too() {
    for bend in [0.05, 0.3, 0.9] {
        for tick in [20e-6, 5e-6] {
            let found = missing(&format!("method: VelocityVerlet, tick: {tick:?}"), bend);
            assert!(found < (PACE * tick).powi(2), "{bend} rad, tick {tick}: {found:e}");
        }
    }
}
