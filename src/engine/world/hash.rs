//! A hash of the whole state: two runs are the same if and (almost certainly) only if their hashes are.

use super::packed::Bodies;
use jostle_language::digest::of_bytes;

/// Hash of positions, angles, velocities and spins of all bodies in canonical order, to the last bit. It is FNV-1a over
/// the little-endian bytes. It is the same on every machine.
pub fn state_hash(bodies: &Bodies) -> u64 {
    let values = (0..bodies.len()).flat_map(|body| {
        let (position, velocity) = (bodies.position[body], bodies.velocity[body]);
        [position.x, position.y, bodies.angle[body], velocity.x, velocity.y, bodies.spin[body]]
    });
    of_bytes(values.flat_map(|value| value.to_bits().to_le_bytes()))
}
