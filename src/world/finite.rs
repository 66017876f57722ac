//! The guard against numbers that are not finite: it names the first body that went wrong.

use super::packed::Bodies;

/// The first body whose state is not finite, and which quantity it is.
pub fn first_not_finite(bodies: &Bodies) -> Option<(usize, &'static str)> {
    (0..bodies.len()).find_map(|body| {
        let quantity = if !bodies.position[body].is_finite() {
            "position"
        } else if !bodies.angle[body].is_finite() {
            "angle"
        } else if !bodies.velocity[body].is_finite() {
            "velocity"
        } else if !bodies.spin[body].is_finite() {
            "spin"
        } else {
            return None;
        };
        Some((body, quantity))
    })
}
