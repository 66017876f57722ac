//! One number for the whole state: two runs are the same if and only if (as good as) their hashes are.

use super::packed::Bodies;

/// Hash of positions, angles, velocities and spins of all bodies in canonical order, to the last bit: FNV-1a, 64 bits
/// (Fowler, Noll, Vo 1991), over the little-endian bytes. It is the same on every machine.
pub fn state_hash(bodies: &Bodies) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |value: f64| {
        for byte in value.to_bits().to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    };
    for body in 0..bodies.len() {
        let (position, velocity) = (bodies.position[body], bodies.velocity[body]);
        for value in [position.x, position.y, bodies.angle[body], velocity.x, velocity.y, bodies.spin[body]] {
            add(value);
        }
    }
    hash
}
