//! The guard against NaN and infinity: it names the first body with such a number.

use super::packed::Bodies;

/// The first body whose state is NaN or infinite, and the name of the quantity.
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
        } else if bodies.dynamic[body] && !twice_kinetic(bodies, body).is_finite() {
            "kinetic energy"
        } else {
            return None;
        };
        Some((body, quantity))
    })
}

fn twice_kinetic(bodies: &Bodies, body: usize) -> f64 {
    let (velocity, spin) = (bodies.velocity[body], bodies.spin[body]);
    bodies.mass[body] * velocity.length_squared() + bodies.inertia[body] * spin * spin
}
