//! The work of an evaluation of all forces. It is a count that does not depend on the computer or on its load.
//!
//! The unit is an evaluation of the forces of a world without atoms: about half a microsecond.

use super::State;

/// The work for each atom, each row of the constraints, and each pair of neighbours. Chains of 5 to 400 links and a driven cart were
/// measured.
const PER_ATOM: f64 = 0.04;
const PER_ROW: f64 = 1.5;
const PER_PAIR: f64 = 0.1;
/// The same for each pair that touches: the search for rest takes most of it.
const PER_CONTACT: f64 = 1.0;
/// The work for each multiplication in dense equations of rows: some 2 ns with its reads and writes.
pub(super) const PER_MULTIPLICATION: f64 = 0.004;

/// The work of an evaluation, from the present neighbours, contacts and rows.
pub fn work_of_an_evaluation(state: &State) -> f64 {
    let bodies = state.bodies();
    let (near, touching) = state.pairs().map_or((0, 0), |pairs| pairs.count(bodies));
    let (atoms, rows) = (bodies.atom_count() as f64, state.rows().len() as f64);
    1.0 + PER_ATOM * atoms + PER_ROW * rows + PER_PAIR * near as f64 + PER_CONTACT * touching as f64
}
