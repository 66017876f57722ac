//! Whether contacts from a file belong to the bodies and pairs of the run that reads them.

use super::normal::NormalForce;
use super::penalty_model::PenaltyState;
use crate::tick::State;
use crate::tick::pairs::NEW;
use crate::tick::snapshot::{UnfitSnapshot, demand};
use crate::world::Bodies;

/// Demands that all laws follow from the scene, and that all places and lengths are among those there are.
pub(super) fn demand_fit<N: NormalForce>(own: &PenaltyState, state: &State) -> Result<(), UnfitSnapshot> {
    let PenaltyState { contacts, rolling } = own;
    let (bodies, Some(pairs)): (&Bodies, _) = (state.bodies(), &state.pairs) else { return Ok(()) };
    demand(contacts.laws.fits::<N>(&contacts.materials, &contacts.settings), "the laws of contacts")?;
    let laws = contacts.laws.len();
    let (atoms, surfaces) = (&contacts.atoms, &contacts.surfaces);
    demand(atoms.fits(laws, bodies.len()) && surfaces.fits(laws, bodies.len()), "the lists of contacts")?;
    // Contacts are those of the present pairs, or of the pairs before. Later pairs must not get the version of contacts that are there.
    let carried = |before: &[u32], len: usize| before.iter().all(|&before| before == NEW || (before as usize) < len);
    let belong = |version: u64, atoms: usize, surfaces: usize| {
        if version == pairs.version {
            atoms == pairs.atoms.len() && surfaces == pairs.surfaces.len()
        } else {
            let carries = carried(&pairs.atoms_before, atoms) && carried(&pairs.surfaces_before, surfaces);
            version < pairs.version && carries
        }
    };
    demand(belong(contacts.version, atoms.len(), surfaces.len()), "the numbers of contacts")?;
    if contacts.version == pairs.version {
        let places = pairs.atoms.iter().map(|pair| (pair.a, pair.b));
        let same = places.enumerate().all(|(index, pair)| atoms.pairs.place(index) == Some(pair));
        demand(same, "the places of contacts")?;
        demand(contacts.records.fits(bodies, &pairs.atoms, atoms), "the records of contacts")?;
    }
    if let Some(rolling) = rolling {
        let numbers = rolling.atoms.iter().chain(&rolling.surfaces).all(|one| (one.elongation + one.held).is_finite());
        let fits = belong(rolling.version, rolling.atoms.len(), rolling.surfaces.len());
        demand(fits && numbers, "the springs of rolling contacts")?;
    }
    let all = atoms.len() + surfaces.len();
    let released = contacts.released.iter().all(|index| (*index as usize) < all);
    demand(released, "the contacts whose forces were released")?;
    demand(contacts.held.fits(state.rows().len(), all, bodies.len()), "the held contacts")?;
    let contradicted = contacts.contradicted.is_none_or(|one| one.body < bodies.len() && one.since.is_finite());
    demand(contradicted, "the body that contacts hold against other rows")?;
    demand(contacts.rest.fits(bodies.len()), "the bodies at rest")?;
    demand(contacts.meetings.fits(atoms.len(), bodies.len()), "the meetings of bodies in flight")
}
