//! Law: a tick far above the time of a contact gives meaningless numbers. The card says so, however stiff the floor is.
//!
//! Not tested: what shorter ticks give (see `hard`).

use jostle::SimulationExt;
use jostle::problems::hard::stiffness;

use super::support::load;

#[test]
fn the_card_warns_of_ticks_far_above_the_contact_time() {
    for tick in [1.0 / 60.0, 1e-3, 1e-4] {
        for (method, events) in [("VelocityVerlet", "PerTick"), ("Dop853", "Located")] {
            let mut simulation = load(&stiffness::scene(1e9, method, events, tick));
            // A run that gains so much energy that the guard ends it says so, too.
            let ended = simulation.run_to_tick((0.7 / tick) as u64);
            let notes = simulation.card().notes;
            let warned =
                notes.iter().any(|note| note.contains("the critical one") || note.contains("does not resolve"));
            assert!(warned || ended.is_err(), "{method} {tick}: {notes:?}");
        }
    }
}
