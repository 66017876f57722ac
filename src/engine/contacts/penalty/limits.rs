//! The limits of a penalty law, and the response of a single contact, before the first tick.

use super::inelasticity::{largest_inelasticity, restitution_of};
use super::normal::NormalForce;
use super::pair_law::PairLaw;
use super::{NormalLaw, Penalty, TangentialLaw, dashpot, rolling};
use crate::tick::Stability;
use crate::world::{Bodies, Materials};

/// The effects that the law cannot produce, for the card.
pub(super) fn notes(settings: &Penalty, materials: &Materials, bodies: &Bodies) -> Vec<String> {
    let mut notes = Vec::new();
    if settings.tangential == TangentialLaw::None && materials.any_friction() {
        notes.push("contacts: with `tangential: None` the friction of the materials does not act".to_owned());
    }
    if settings.normal != NormalLaw::Dashpot {
        return notes;
    }
    let clumps = (0..bodies.len()).any(|body| bodies.atoms_of(body).len() > 1);
    let least = restitution_of(largest_inelasticity(materials));
    if clumps {
        notes.push(
            "contacts: under Dashpot the restitution is that of one atom. A body that lands on n atoms at once \
        rebounds less. Its damping ratio is up to sqrt(n) times as large"
                .to_owned(),
        );
    }
    if settings.damping.is_none() && settings.damping_rate.is_none() && least < dashpot::LEAST_RESTITUTION {
        let limit = dashpot::LEAST_RESTITUTION;
        notes.push(format!("contacts: Dashpot cannot give the restitution {least}, and gives {limit}"));
    }
    notes
}

/// Greatest angular frequency that a single contact of any body can have, in rad/s.
///
/// A contact of atom `i` with a harder side has `omega^2 = k w`. Its mobility along its direction is `w = 1/m + r^2/I`.
/// Between two moving bodies it is a weighted mean of both sides' values, so no pair exceeds the greatest. Normal and
/// tangential spring turn the same body, so their values are added. Many simultaneous contacts on one body respond
/// still faster.
///
/// Damping counts as if the method were the default one, the strictest: with `g = 2 c w` the frequency is
/// `g/2 + sqrt(g^2/4 + omega^2)` (see [`Stability::damping_limit`]).
pub(super) fn stiffest_contact<N: NormalForce>(bodies: &Bodies, materials: &Materials, settings: &Penalty) -> f64 {
    let ratio = settings.tangential.ratio().filter(|_| materials.any_friction()).unwrap_or(0.0);
    let turning = settings.rolling.ratio().unwrap_or(0.0);
    let weight = Stability::default().weight_of_damping();
    let mut law = PairLaw::default();
    N::set_up(&mut law, largest_inelasticity(materials), settings);
    let mut frequency = |atom: usize| {
        let body = bodies.atom_body(atom);
        let distance = bodies.atom_offset(atom).length();
        let mobility = |arm: f64| bodies.inverse_mass(body) + arm * arm * bodies.inverse_inertia(body);
        law.stiffness = bodies.atom_stiffness(atom);
        let (stiffness, damping) = N::response(&law, mobility(distance));
        let radius = bodies.atom_radius[atom];
        let rolling = rolling::stiffness(turning, law.stiffness, radius) * bodies.inverse_inertia(body);
        let across = ratio * law.stiffness * mobility(distance + radius) + rolling;
        let damped = 0.5 * weight * damping * mobility(distance);
        damped + (damped * damped + stiffness * mobility(distance) + across).sqrt()
    };
    let colliding = (0..bodies.atom_count()).filter(|&atom| bodies.collides[bodies.atom_body(atom)]);
    colliding.map(&mut frequency).fold(0.0, f64::max)
}
