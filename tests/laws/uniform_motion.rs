//! Law: a free body moves and turns at a constant rate (Newton's first law), after a million ticks as after one.
//!
//! Tolerance: the way and the turn of a tick are products, rounded once and the same in every tick: half a unit of the
//! last place of the whole. Compensated summation (Kahan 1965) adds two units at most, whatever the number of ticks; the
//! expected value is rounded too. Four units in all. A plain sum would be wrong by a thousand times as much.
//!
//! Not tested: forces, contacts.

use super::support::{METHODS, assert_near, load};

#[test]
fn a_million_ticks_add_up_like_one() {
    const TICKS: u64 = 1_000_000;
    let (velocity, spin, tick) = ([0.1, -0.037], 0.7, 1e-3);
    for method in METHODS {
        let mut simulation = load(&format!(
            "Scene(format: 1, clock: (duration: 2000, tick: {tick:?}, method: {method}), bodies: [
                (name: \"disc\", at: (0, 0), velocity: ({:?}, {:?}), spin: {spin:?}, atoms: Disc(radius: 0.1))])",
            velocity[0], velocity[1]
        ));
        simulation.run_to_tick(TICKS).expect("numbers stay finite");
        let bodies = simulation.bodies();
        let time = TICKS as f64 * tick;
        let found = [bodies.position[0].x, bodies.position[0].y, bodies.angle[0]];
        for (found, rate) in found.into_iter().zip([velocity[0], velocity[1], spin]) {
            let exact = rate * time;
            assert_near(&format!("{method}: {rate} for {time} s"), found, exact, 4.0 * f64::EPSILON * exact.abs());
        }
    }
}
