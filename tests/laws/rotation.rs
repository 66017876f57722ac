//! Law: a free rigid body keeps spin, energy and angular momentum, and its atoms keep their distances. Source: truth
//! file P05; 1e4 rad/s for 10 s.
//!
//! Tolerances: nothing acts, so velocities stay to the last bit. Energies and momenta are sums of a few terms: 16 units
//! in the last place. Distances of atoms follow from one (cos, sin) per tick, never accumulated: 4 units in the last
//! place of the position, 8 m.
//!
//! Not tested: places of the atoms (see `problems`).

use jostle::problems::{Setting, Truth, cluster_rotation};

use super::support::{METHODS, assert_near, kinetic, momenta};

#[test]
fn a_fast_cluster_keeps_its_shape_and_its_momenta() {
    let truth = Truth::read(cluster_rotation::TRUTH);
    let atoms = truth.numbers("centre of mass");
    for method in METHODS {
        let setting = Setting { method, tick: 1e-4, shift: 0.0, ..Setting::default() };
        let mut simulation = cluster_rotation::PROBLEM.load(&setting).expect("the scene is correct");
        let bodies = simulation.bodies();
        assert_near("mass", bodies.mass[0], truth.number("mass"), 1e-15);
        assert_near("inertia", bodies.inertia[0], truth.number("inertia"), 1e-15);
        assert_near("centre, x", bodies.position[0].x, atoms[0], 1e-15);
        assert_near("centre, y", bodies.position[0].y, atoms[1], 1e-15);
        let distances = |simulation: &jostle::Simulation| {
            let place = |atom| simulation.bodies().atom_place(atom);
            [(0, 1), (1, 2), (2, 0)].map(|(a, b)| place(a).distance(place(b)))
        };
        let before = distances(&simulation);
        for tick in [1, 100, 10_000, 100_000] {
            simulation.run_to_tick(tick).expect("numbers stay finite");
            let bodies = simulation.bodies();
            assert_eq!(bodies.spin[0], cluster_rotation::SPIN);
            assert_eq!(bodies.velocity[0], cluster_rotation::VELOCITY);
            let ulps = 16.0 * f64::EPSILON;
            assert_near("energy", kinetic(bodies) / truth.number("kinetic energy"), 1.0, ulps);
            let ((_, turning), _) = momenta(bodies);
            assert_near("turning", turning / truth.number("angular momentum about origin"), 1.0, ulps);
            for (found, exact) in distances(&simulation).into_iter().zip(before) {
                assert_near("distance of atoms", found, exact, 4.0 * f64::EPSILON * 8.0);
            }
        }
    }
}
