//! Rounding of places far from the origin: few digits are left for overlaps.

use super::{Cause, Evidence, Trust};
use jostle_engine::tick::State;
use jostle_language::numbers::{number, percent, rough};

/// Contacts rattle if the last digit of a place exceeds this share of their overlap.
const COARSE: f64 = 1e-3;

/// The last digit of a place is not small beside the overlaps that make forces, or beside the bodies themselves.
pub(super) fn rounding(evidence: &Evidence) -> Option<Cause> {
    let (bodies, card) = (evidence.world.resource::<State>().bodies(), evidence.card);
    let (far, body) = (0..bodies.len())
        .map(|body| (bodies.position[body].abs().max_element(), body))
        .filter(|(far, _)| far.is_finite())
        .fold((0.0, None), |most, (far, body)| if far > most.0 { (far, Some(body)) } else { most });
    let digit = f64::EPSILON * far;
    let overlap = card.largest_overlap.meters;
    let size = if overlap > 0.0 { overlap.max(load(evidence.world.resource(), body?)) } else { bodies.smallest_radius };
    let share = digit / size;
    let body = evidence.name(bodies.entity[body?]);
    let what = format!(
        "`{body}` is {} m from the origin, where places have steps of {} m. Such a step is {} of the {}",
        number(far),
        rough(digit),
        percent(share),
        if overlap > 0.0 { "deepest overlap" } else { "smallest radius" }
    );
    let remedy = Some("a scene that lies around the origin".to_owned());
    (share > COARSE && share.is_finite()).then_some(Cause { trust: Trust::Not, what, remedy })
}

/// The least overlap in m that a body causes: by its weight, or without gravity by its speed. A contact that merely grazes the
/// body has a smaller one, which is no measure of its forces.
fn load(state: &State, body: usize) -> f64 {
    let (bodies, gravity) = (state.bodies(), state.gravity().length());
    let stiffness = bodies.atoms_of(body).map(|atom| bodies.atom_stiffness(atom)).fold(0.0, f64::max);
    if stiffness == 0.0 || !bodies.dynamic[body] {
        return 0.0;
    }
    let give = 1.0 / (bodies.inverse_mass(body) * stiffness);
    if gravity > 0.0 { gravity * give } else { bodies.velocity[body].length() * give.sqrt() }
}
