//! Law: a rigid clump that touches a wall with one atom, `x` beside its centre of mass, meets it with the effective mass
//! `1/m* = 1/M + x^2/I`: the impulse is `(1 + e) m* v`, the spin after is `-J x/I`. Mass and inertia are those of all atoms
//! as discs, or those of the covered area. Source: any textbook on rigid bodies.
//!
//! Tolerances: restitution as in `restitution`, with the rate `sqrt(k/m*)`. The clump is slow, so that it turns by no more
//! than 1e-6 while it touches. The area was found by casting points at random, to 0.03.
//!
//! Not tested: several atoms that touch at once (the effective restitution depends on their number).

use super::support::{METHODS, assert_near, load, phases, run};

#[test]
fn an_impact_beside_the_center_of_mass_makes_it_spin() {
    // A rod of 1 kg and 2 m in length, struck 0.7 m beside its centre: the catalogue's example.
    let (mass, inertia, beside, restitution) = (1.0, 1.0 / 3.0, 0.7, 0.8);
    let effective = 1.0 / (1.0 / mass + beside * beside / inertia);
    let impulse = (1.0 + restitution) * effective;
    assert_near("impulse of the catalogue", impulse, 0.728_744_9, 1e-7);
    assert_near("spin of the catalogue", -impulse * beside / inertia, -1.530_364_4, 1e-7);
    let (stiffness, speed) = (1e6_f64, 1e-4);
    let rate = (stiffness / effective).sqrt();
    let tick = std::f64::consts::PI / rate / 400.0;
    let inelasticity = (1.0 - restitution * restitution) / (1.0 + restitution * restitution);
    let share = (2.0 * inelasticity / restitution + restitution / 2.0) * (rate * tick).powi(2);
    for method in METHODS {
        for phase in phases(16) {
            // The centre of mass of both atoms lies half-way; the right one is lower.
            let height = 0.35 + speed * tick * phase;
            let simulation = run(&format!(
                "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}),
                materials: {{ \"m\": (stiffness: {stiffness:?}, restitution: {restitution:?}) }},
                walls: [(name: \"wall\", left: (1, 0), right: (0, 0), material: \"m\")],
                bodies: [(name: \"rod\", at: (0, {height:?}), velocity: (0, -{speed:?}), material: \"m\",
                          mass: {mass:?}, inertia: {inertia:?}, atoms: List([
                    (at: ({beside:?}, 0), radius: 0.1, mass: 0.5), (at: (-{beside:?}, 0.5), radius: 0.1, mass: 0.5)]))])",
                600.0 * tick
            ));
            let bodies = simulation.bodies();
            let found = (bodies.velocity[0].y / speed + 1.0) * mass;
            assert_near("impulse", found, impulse, effective * share + 1e-5);
            // Struck from below on its right side it turns counter-clockwise.
            assert_near("spin", bodies.spin[0] / speed, impulse * beside / inertia, share * beside + 1e-5);
        }
    }
}

#[test]
fn overlapping_atoms_count_as_discs_or_as_the_area_they_cover() {
    // A T of sixteen discs of 0.5 m, 0.8 m apart: nine in the bar, seven below its middle.
    let bar = (0..9).map(|index| (0.8 * f64::from(index), 0.0));
    let stem = (1..8).map(|index| (0.8 * 4.0, -0.8 * f64::from(index)));
    let atoms: Vec<(f64, f64)> = bar.chain(stem).collect();
    let listed: Vec<String> = atoms.iter().map(|(x, y)| format!("(at: ({x:?}, {y:?}), radius: 0.5)")).collect();
    let body = |rule: &str| {
        let simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 1, tick: 1e-3, method: VelocityVerlet),
            materials: {{ \"m\": (density: 1) }},
            bodies: [(name: \"T\", at: (0, 0), material: \"m\", inertia: {rule}, atoms: List([{}]))])",
            listed.join(", ")
        ));
        (simulation.bodies().mass[0], simulation.bodies().inertia[0])
    };
    let disc = std::f64::consts::PI / 4.0;
    let (mass, inertia) = body("Discs");
    assert_near("mass as discs", mass, 16.0 * disc, 1e-12);
    assert_near("mass as discs, catalogue", mass, 12.566, 1e-3);
    let center = atoms.iter().fold((0.0, 0.0), |sum, atom| (sum.0 + atom.0 / 16.0, sum.1 + atom.1 / 16.0));
    let steiner: f64 = atoms.iter().map(|(x, y)| (x - center.0).powi(2) + (y - center.1).powi(2)).sum();
    assert_near("inertia as discs", inertia, disc * (16.0 * 0.125 + steiner), 1e-10);
    assert_near("inertia as points", body("Points").1, disc * steiner, 1e-10);
    let (mass, inertia) = body("Union");
    assert_near("mass of the area, catalogue", mass, 11.34, 0.03);
    // Fifteen pairs of neighbours overlap, in a lens each; no three discs do.
    let lens = 0.5 * libm::acos(0.8) - 0.4 * 0.6;
    assert_near("mass of the area", mass, 16.0 * disc - 15.0 * lens, 1e-12);
    // The inertia of the area, by casting points on a fine grid here: to the share of cells that the rim cuts.
    let cell = 0.005;
    let (mut area, mut first, mut second) = (0.0, (0.0, 0.0), 0.0);
    for column in -120..1420 {
        for row in -1240..120 {
            let (x, y) = ((f64::from(column) + 0.5) * cell, (f64::from(row) + 0.5) * cell);
            if atoms.iter().any(|(a, b)| (x - a).powi(2) + (y - b).powi(2) < 0.25) {
                area += cell * cell;
                first = (first.0 + x * cell * cell, first.1 + y * cell * cell);
                second += (x * x + y * y) * cell * cell;
            }
        }
    }
    let about = second - (first.0 * first.0 + first.1 * first.1) / area;
    // Cells on the rim, some 40 m of it, count whole or not: errors of cells are unrelated.
    let tolerance = cell * cell * (40.0 / cell).sqrt();
    assert_near("area", mass, area, 2.0 * tolerance);
    assert_near("inertia of the area", inertia, about, 2.0 * 16.0 * tolerance);
}
