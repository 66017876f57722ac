//! Energy that the ledger misses, or that came out of nowhere.

use super::{Cause, Evidence, Trust, VerdictPart, near, ticks};
use crate::Remedy;
use jostle_language::numbers::{number, percent, percentage};

/// The ledger may miss this share of the energy that changed form.
pub(crate) const UNACCOUNTED: f64 = 0.05;

/// Energy or momentum is NaN or infinite.
pub(super) fn not_finite(evidence: &Evidence) -> Option<Cause> {
    let card = evidence.card;
    let finite =
        [card.energy.residual, card.momentum_residual[0], card.momentum_residual[1]].iter().all(|x| x.is_finite());
    let what = "energy or momentum is infinite or NaN".to_owned();
    (!finite).then(|| Cause { trust: Trust::Not, what, remedy: evidence.finer() })
}

/// More energy is missing than a good tick leaves. The message adds the most likely reason.
pub(super) fn unaccounted(evidence: &Evidence) -> Option<Cause> {
    let card = evidence.card;
    let error = card.energy_error();
    // If energies are so large that their ratio is NaN, `not_finite` reports them.
    if error.is_nan() || error <= UNACCOUNTED {
        return None;
    }
    let share = format!("the accounts miss {} of the energy", percentage(error));
    if let Some(Cause { trust, what, remedy }) = near::attraction(evidence) {
        return Some(Cause { trust, what: format!("{share}. {}", crate::capital(&what)), remedy });
    }
    let why = [ticks::brief_contact, ticks::far_travel_unseen].into_iter().find_map(|cause| cause(evidence));
    let why = why.map(|cause| cause.what).or_else(|| super::trajectory_error::began(evidence)).map_or_else(
        || "The tick is too long for the forces, or a plugin does not book its work".to_owned(),
        |why| crate::capital(&why),
    );
    let what = format!("{share}. {why}");
    let tolerance = evidence.or_tolerance();
    Some(Cause { trust: Trust::Not, what, remedy: card.remedy().map(|remedy| format!("`{remedy}`{tolerance}")) })
}

/// The verdict does not mention a smaller share of missing energy.
pub(super) const MISSING: f64 = 1e-3;

/// Friction and contacts may give this share of the energy in a run that is good for a first look.
const GIVEN: f64 = 1e-2;
/// The verdict does not mention a smaller share that they give.
const ROUNDED: f64 = 1e-3;

/// Friction and contacts have given energy. They held bodies by less than their springs, while loads compressed these further.
pub(super) fn given_back(evidence: &Evidence) -> Option<Cause> {
    let card = evidence.card;
    let given = card.given_back;
    let share = given / card.energy_scale;
    let trust = if share > GIVEN { Trust::Not } else { Trust::ButNot(VerdictPart::Energy) };
    let what = format!(
        "friction and contacts have given {} J, though they can only take energy. Wedged contacts that should rest sink in",
        number(given)
    );
    (share > ROUNDED).then(|| Cause { trust, what, remedy: evidence.finer() })
}

/// Possible causes of a failure that no function of this folder explains.
pub(super) fn of_unknown_cause(evidence: &Evidence) -> String {
    let card = evidence.card;
    let remedy = match card.remedy() {
        // The failure itself made the contacts from which the card derives its tick, so that tick is not advised.
        Some(Remedy::Tick(_)) => format!(". Or try `{}`", Remedy::Tick(card.tick / 4.0)),
        Some(remedy) => format!(". Or try `{remedy}`"),
        None => String::new(),
    };
    format!(
        "numbers grew beyond all bounds. Look for enormous speeds, forces, stiffnesses or sizes, and for masses near zero. Look for \
         drag that stops a body within a tick, and for a plugin that does not book its work{remedy}"
    )
}

/// The sentence on the energy residual.
pub(super) fn residual(evidence: &Evidence) -> String {
    match evidence.card.energy_error() {
        0.0 => "The energy residual is 0.".to_owned(),
        error => format!("The energy residual is {} of the energy that changed form.", percent(error)),
    }
}
