//! Law: a method that is stable up to `w dt = 2` bears a tick of `2/w_max`, `w_max` the largest angular frequency of
//! `K phi = w^2 M phi` with all springs that hold a body. Source: Hairer, Lubich, Wanner 2006, I.5; for contacts: Itasca,
//! PFC, *Timestep determination*.
//!
//! A body of 2 kg and 0.05 kg m2 is clamped by three contacts off its centre, of 1e5, 1e5 and 4e4 N/m. The eigenvalue is
//! that of a 3 x 3 matrix, solved to 40 digits: `w_max = 555.282536068347 rad/s`, 1.6 times what `sqrt(sum k/m)` says.
//!
//! Tolerance: the contacts bear forces `N`, and their turning adds `N r` to the stiffness `k r^2`: 1e-4 of 0.1 or 0.3 m,
//! a share below 1e-3.
//!
//! Not tested: slipping contacts.

use super::support::{METHODS, assert_near, kinetic, load};

const CRITICAL: f64 = 0.003_601_770_036_134_956;
const NAIVE: f64 = 0.005_773_502_691_896_258;
const RADIUS: f64 = 0.03;

/// The body in equilibrium: the floor bears 10 N twice, the wall 10 N, and it turns by a hair.
fn clamped(method: &str, tick: f64, ticks: u64) -> String {
    let (sunk, pressed) = (1e-4, 2.5e-4);
    let up = -0.1 + RADIUS - sunk;
    let back = 0.3 - RADIUS + pressed;
    let duration = tick * ticks as f64;
    format!(
        "Scene(format: 1, clock: (duration: {duration:?}, tick: {tick:?}, method: {method}), gravity: (5, -10),
        walls: [
            (name: \"floor\", left: (1, 0), right: (0, 0)),
            (name: \"right\", left: (0.3, 1), right: (0.3, 0)),
        ],
        bodies: [(name: \"block\", at: (0, 0.1), spin: 1e-6, mass: 2, inertia: 0.05, atoms: List([
            (at: (0, 0), radius: 0.01, mass: 1),
            (at: (-0.3, {up:?}), radius: {RADIUS:?}, stiffness: 1e5, mass: 1e-12),
            (at: (0.25, {up:?}), radius: {RADIUS:?}, stiffness: 1e5, mass: 1e-12),
            (at: ({back:?}, 0.05), radius: {RADIUS:?}, stiffness: 4e4, mass: 1e-12),
        ]))])"
    )
}

/// Kinetic energy over that of the beginning, the greatest of `ticks` ticks.
fn growth(method: &str, tick: f64, ticks: u64) -> f64 {
    let mut simulation = load(&clamped(method, tick, ticks));
    let start = kinetic(simulation.bodies());
    let mut greatest = 0.0_f64;
    for tick in 1..=ticks {
        simulation.run_to_tick(tick).expect("numbers stay finite");
        greatest = greatest.max(kinetic(simulation.bodies()) / start);
    }
    greatest
}

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

/// Near its limit the energy of a stable oscillation swings by `1/(1 - (w dt/2)^2)`, 5.3 at nine tenths, and each of the
/// three modes has at most all of it. At eleven tenths an amplitude grows by `2 (1.1)^2 - 1 + sqrt(..) = 2.4` in a tick,
/// until contacts open.
#[test]
fn nine_tenths_of_it_are_borne_and_eleven_are_not() {
    for method in METHODS {
        let borne = growth(method, 0.9 * CRITICAL, 20_000);
        assert!(borne < 3.0 * 5.3, "{method}: {borne}");
        let not = growth(method, 1.1 * CRITICAL, 8);
        assert!(not > 1e4, "{method}: {not}");
        println!("{method}: {borne} {not}");
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
