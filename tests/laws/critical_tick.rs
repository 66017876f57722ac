//! Law: a method that is stable up to `w dt = 2` allows a tick of `2/w_max`. Here `w_max` is the largest angular
//! frequency of `K phi = w^2 M phi` with all springs that hold a body. Source: Hairer, Lubich, Wanner 2006, I.5; for
//! contacts: Itasca, PFC, *Timestep determination*.
//!
//! A body of 2 kg and 0.05 kg m2 is clamped by three contacts off its centre, of 1e5, 1e5 and 4e4 N/m. The eigenvalue
//! is that of a 3 x 3 matrix, solved to 40 digits: `w_max = 555.282536068347 rad/s`, 1.6 times `sqrt(sum k/m)`.
//!
//! Tolerance: the contacts bear forces `N`, and their turning adds `N r` to the stiffness `k r^2`: 1e-4 of 0.1 or 0.3 m,
//! a share below 1e-3.
//!
//! Not tested: what becomes of a run above the limit (see `hard`); slipping contacts.

use jostle::SimulationExt;
use jostle::problems::hard::tick_limit::{CRITICAL, NAIVE, clamped};

use super::support::{METHODS, assert_near, load};

#[test]
fn the_card_has_the_critical_tick_of_all_contacts_together() {
    for method in METHODS {
        let mut simulation = load(&clamped(method, 1e-4, 100));
        simulation.run_to_end().expect("numbers stay finite");
        let critical = simulation.card().critical_tick.expect("it touches");
        assert_near("critical tick", critical, CRITICAL, 1e-3 * CRITICAL);
        assert!(critical < 0.7 * NAIVE);
    }
}

/// The card warns of the tick above, with body and time, and of no other.
#[test]
fn a_tick_above_the_critical_one_is_warned_of() {
    let warned = |share: f64| {
        let mut simulation = load(&clamped("VelocityVerlet", share * CRITICAL, 6));
        simulation.run_to_end().expect("numbers stay finite");
        simulation.card().warnings
    };
    let [above] = &warned(1.1)[..] else { panic!("{:?}", warned(1.1)) };
    let begin = "the tick of 0.0039619 s is above the critical one of 0.0036";
    assert!(above.starts_with(begin) && above.contains("`block`"), "{above}");
    // Each of its contacts alone lasts few ticks, and that is told; it is not above the critical tick.
    assert!(warned(0.9).iter().all(|warning| !warning.contains("critical")), "{:?}", warned(0.9));
    assert_eq!(warned(0.1), Vec::<String>::new());
}

/// Two pairs that touch one after the other, the second 25 times as stiff: the card has the stiffer. Two bodies on one
/// spring have `w^2 = k (1/m + 1/m)`, `k` in series.
#[test]
fn a_brief_touch_among_others_is_not_missed() {
    let mut simulation = load(
        "Scene(format: 1, clock: (duration: 1, tick: 2e-4), materials: { \"soft\": (stiffness: 1e3), \"hard\": (stiffness: 25e3) },
        bodies: [
            (name: \"a\", at: (0, 0), velocity: (1, 0), material: \"soft\", atoms: Disc(radius: 0.1, mass: 0.5)),
            (name: \"b\", at: (0.25, 0), material: \"soft\", atoms: Disc(radius: 0.1, mass: 0.5)),
            (name: \"c\", at: (0, 1), velocity: (1, 0), material: \"hard\", atoms: Disc(radius: 0.1, mass: 0.5)),
            (name: \"d\", at: (0.6, 1), material: \"hard\", atoms: Disc(radius: 0.1, mass: 0.5)),
        ])",
    );
    simulation.run_to_tick(1500).expect("numbers stay finite");
    // The products of two bodies find the eigenvalue to the digits in which the contact's normal is known.
    let soft = 2.0 / f64::sqrt(1e3 / 2.0 * 4.0);
    assert_near("soft", simulation.card().critical_tick.expect("a and b touched"), soft, 1e-9 * soft);
    simulation.run_to_end().expect("numbers stay finite");
    assert_near("hard", simulation.card().critical_tick.expect("they touched"), soft / 5.0, 1e-9 * soft);
}

/// A ball of 1 kg that lies on a floor of 1e4 N/m and is pushed a hair, with a damping of `damping` N s/m: its speed after
/// `ticks` ticks and the greatest until then, both over the first, and the card's critical tick in seconds.
fn damped(method: &str, damping: f64, tick: f64, ticks: u64) -> (f64, f64, f64) {
    let push = 1e-9;
    let mut simulation = load(&format!(
        "Scene(format: 1, clock: (duration: 1000, tick: {tick:?}, method: {method}), gravity: (0, -10),
        contacts: Penalty(normal: Dashpot, tangential: None, damping: \"{damping:?} N s/m\"),
        materials: {{ \"m\": (stiffness: 1e4) }},
        walls: [(name: \"floor\", left: (1, 0), right: (-1, 0))],
        bodies: [(name: \"ball\", at: (0, 0.099), velocity: (0, {push:?}), material: \"m\", atoms: Disc(radius: 0.1, mass: 1))])"
    ));
    let mut greatest = 0.0_f64;
    for tick in 1..=ticks {
        if simulation.run_to_tick(tick).is_err() {
            return (f64::INFINITY, f64::INFINITY, 0.0);
        }
        greatest = greatest.max(simulation.bodies().velocity[0].length() / push);
    }
    (simulation.bodies().velocity[0].length() / push, greatest, simulation.card().critical_tick.expect("it touches"))
}

/// Damping `c` beside a spring: semi-implicit Euler is stable while `(w dt)^2 + 2 c dt/m < 4` (its recurrence at
/// alternating signs), velocity Verlet, whose forces see an estimate of the velocity, while `(w dt)^2 + 4 c dt/m < 4` but
/// for a part in 400. Two hundredths below swings die out, above they grow until the contact opens.
#[test]
fn damping_shortens_the_critical_tick() {
    for (method, weight) in METHODS.into_iter().zip([1.0, 2.0]) {
        for damping in [10.0, 50.0, 400.0] {
            let half = 0.5 * weight * damping;
            let exact = 2.0 / (half + (half * half + 1e4_f64).sqrt());
            let (below, _, critical) = damped(method, damping, 0.98 * exact, 3000);
            assert_near("critical tick", critical, exact, 1e-3 * exact);
            let (_, above, _) = damped(method, damping, 1.02 * exact, 3000);
            println!("{method}, {damping}: {below:e} below, {above:e} above");
            assert!(below < 1e-6, "{method}, {damping}: {below}");
            assert!(above > 1e3, "{method}, {damping}: {above}");
        }
    }
}
