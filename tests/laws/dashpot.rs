//! Law: `N = max(0, k d - c v_n)`. Let `m` be the effective mass, `b = c/(2 m)`, `w0^2 = k/m`, `zeta = b/w0`. A contact
//! ends when its force does, and `e = exp(-b t)` with the duration `t`. It needs more damping for the same restitution
//! than a contact that pulls until its overlap is gone. Source: Schwager and Poeschel 2007 for the end; truth file C03;
//! the catalogue's cases of two discs and of overdamped contacts.
//!
//! Tolerances, with `s = w0 dt`. At the first touch the force jumps to `c v`. Velocity Verlet sees it at the end of the tick
//! and kicks for half a tick; it should have acted for the share `1 - theta` of the tick that was left: the disc arrives as
//! if it had been faster by the share `b dt (1 - 2 theta)`, and so it leaves. That is the whole of order 1, and its worst is
//! `e zeta s`. Semi-implicit Euler makes the same error, and kicks with the velocity of half a tick before, which makes
//! `zeta` larger by `zeta s/2` of itself, so that the contact lasts otherwise too. Order 2, all in shares of the speed
//! before and none made larger by what follows: place after the touch `zeta s^2`; spring in the touching tick `s^2/8`;
//! damping in it `2 zeta^2 s^2` for the velocity that it sees, and as much for its own decay; the estimate of velocities
//! `2 zeta^2 s^2`; the trapezoid of the rest `(1 + 4 zeta^2) s^2/12` and its phase `pi s^2/24`; the kink at the end `s^2/8`:
//! together less than `(1/2 + zeta + 6.5 zeta^2) s^2`. Kicks of whole ticks may make twice of it.
//!
//! Not tested: friction under this law (the laws are independent; see `oblique`).

use jostle::SimulationExt;
use std::f64::consts::PI;

use jostle::contacts::penalty::dashpot::{LEAST_RESTITUTION, ratio_of, restitution};
use jostle::problems::Truth;
use jostle::{Simulation, report::Card};

use super::support::{METHODS, assert_near, assert_rest, contact_forces, fitted_order, load, phases, run, table};

/// Truth file C03: in kg, N/m, m/s.
const MASS: f64 = 1.0;
const STIFFNESS: f64 = 1e4;
const SPEED: f64 = 2.0;
const OMEGA: f64 = 100.0;
const RADIUS: f64 = 0.1;
const RATIOS: [f64; 6] = [0.05, 0.2, 0.5, 0.9, 1.0, 1.5];

/// In N s/m, for a damping ratio of the disc on the wall.
fn damping(ratio: f64) -> f64 {
    2.0 * ratio * OMEGA * MASS
}

/// How long the force lasts in units of `1/w0`.
fn duration(ratio: f64) -> f64 {
    -libm::log(restitution(ratio)) / ratio
}

/// The relative change of restitution with the damping ratio, by a difference wide enough for rounding.
fn slope(ratio: f64) -> f64 {
    (restitution(ratio * (1.0 + 1e-5)) - restitution(ratio * (1.0 - 1e-5))) / (2e-5 * ratio)
}

/// Restitution with the errors of order 1, for a touch at the share `theta` of a tick of `step = w0 dt`.
fn predicted(method: &str, ratio: f64, step: f64, theta: f64) -> f64 {
    let later = if method == METHODS[0] { slope(ratio) * ratio * ratio * step / 2.0 } else { 0.0 };
    restitution(ratio) * (1.0 + ratio * step * (1.0 - 2.0 * theta)) + later
}

/// Bound of the errors of order 2; see above.
fn second_order(method: &str, ratio: f64, step: f64) -> f64 {
    let whole = if method == METHODS[0] { 2.0 } else { 1.0 };
    whole * (0.5 + ratio + 6.5 * ratio * ratio) * step * step
}

/// Bound of all errors.
fn bound(method: &str, ratio: f64, step: f64) -> f64 {
    let later = if method == METHODS[0] { (slope(ratio) * ratio * ratio * step / 2.0).abs() } else { 0.0 };
    restitution(ratio) * ratio * step + later + second_order(method, ratio, step)
}

/// A disc that meets the wall after `1 + theta` ticks.
fn scene(method: &str, tick: f64, theta: f64, contacts: &str, material: &str) -> String {
    let height = RADIUS + SPEED * tick * (1.0 + theta);
    format!(
        "Scene(format: 1, clock: (duration: 1, tick: {tick:?}, method: {method}),
        materials: {{ \"clay\": (stiffness: {STIFFNESS:?}, {material}) }},
        contacts: Penalty(normal: Dashpot, {contacts}), sensors: [ContactForce(on: \"floor\")],
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"clay\")],
        bodies: [(name: \"ball\", at: (0.5, {height:?}), velocity: (0, -{SPEED:?}), material: \"clay\",
                  atoms: Disc(radius: {RADIUS:?}, mass: {MASS:?}))])"
    )
}

fn damped(ratio: f64) -> String {
    format!("damping: {:?}", damping(ratio))
}

/// What is left of an impact.
struct Impact {
    restitution: f64,
    /// Ticks with a force.
    pushed: f64,
    card: Card,
}

/// Runs until the disc is off the wall.
fn impact(text: &str) -> Impact {
    let mut simulation = load(text);
    let mut pushed = 0.0;
    loop {
        simulation.run_to_tick(simulation.clock().ticks + 1).expect("numbers stay finite");
        let force = contact_forces(&simulation).on_wall[0].y;
        assert!(force <= 0.0, "the contact pulls with {force} N");
        pushed += f64::from(u8::from(force != 0.0));
        let (height, velocity) = (simulation.bodies().position[0].y, simulation.bodies().velocity[0].y);
        assert!(simulation.clock().time() < 0.5, "it should have left the wall");
        if height > RADIUS && velocity > 0.0 {
            return Impact { restitution: velocity / SPEED, pushed, card: simulation.card() };
        }
    }
}

#[test]
fn restitution_and_contact_time_are_those_of_the_closed_form() {
    let truth = Truth::read(include_str!("../../assets/truths/C03_spring_dashpot.json"));
    for ratio in [0.05, 0.2, 0.5, 0.9] {
        let number = |what: &str| truth.number(&format!("{what} released at zero force (zeta={ratio})"));
        assert_near("closed form: restitution", restitution(ratio), number("e"), 1e-14);
        assert_near("closed form: duration", duration(ratio) / OMEGA, number("t_c"), 1e-14);
    }
    assert_near("overdamped, of the catalogue", restitution(1.5), 0.075_588_3, 1e-7);
    let step = 0.01;
    for method in METHODS {
        for ratio in RATIOS {
            for theta in phases(16) {
                let found = impact(&scene(method, step / OMEGA, theta, &damped(ratio), ""));
                assert_near("restitution", found.restitution, restitution(ratio), bound(method, ratio, step));
                // Counted in ticks, it is off by one at most, and by what a tick changes of rate and damping.
                let later = if method == METHODS[0] { 1.0 + ratio * step / 2.0 } else { 1.0 };
                let lasts = duration(ratio * later) / later / step;
                assert_near("ticks with a force", found.pushed, lasts, 1.0 + second_order(method, ratio, step) / step);
            }
        }
    }
}

/// The jump at the first touch makes order 1, with the coefficient that theory gives; nothing else does.
#[test]
fn errors_are_of_first_order_by_the_jump_at_the_first_touch_alone() {
    for method in METHODS {
        for ratio in RATIOS {
            let (mut worst, mut left) = (Vec::new(), Vec::new());
            for step in [0.04, 0.02, 0.01, 0.005, 0.0025] {
                let errors = phases(100).map(|theta| {
                    let found = impact(&scene(method, step / OMEGA, theta, &damped(ratio), "")).restitution;
                    ((found - restitution(ratio)).abs(), (found - predicted(method, ratio, step, theta)).abs())
                });
                let worse = |(a, b): (f64, f64), (c, d): (f64, f64)| (a.max(c), b.max(d));
                let (error, rest) = errors.fold((0.0, 0.0), worse);
                assert!(error <= bound(method, ratio, step), "{method}, {ratio}, step {step}: {error:e}");
                assert!(rest <= second_order(method, ratio, step), "{method}, {ratio}, step {step}: {rest:e} left");
                worst.push((step, error));
                left.push((step, rest));
            }
            let (order, next) = (fitted_order(&worst), fitted_order(&left));
            println!("{method}, zeta {ratio}: order {order:.2};{} then {next:.2};{}", table(&worst), table(&left));
            assert!(order >= 0.75, "{method}, {ratio}: order {order};{}", table(&worst));
            assert!(next >= 1.75, "{method}, {ratio}: order {next} after the first;{}", table(&left));
        }
    }
}

#[test]
fn a_restitution_is_converted_and_comes_out() {
    let step = 0.005;
    for method in METHODS {
        for wanted in [0.9, 0.7, 0.5, 0.3, 0.1, 0.05] {
            let ratio = ratio_of(wanted);
            for theta in phases(16) {
                let found = impact(&scene(method, step / OMEGA, theta, "", &format!("restitution: {wanted:?}")));
                assert_near("restitution", found.restitution, wanted, bound(method, ratio, step));
                assert!(!found.card.notes.iter().any(|note| note.contains("Dashpot")), "{:?}", found.card.notes);
            }
        }
    }
    // The same from a contact that pulls needs another ratio: the catalogue's, 18 % apart.
    assert_near("ratio", ratio_of(0.5), 0.255_275_64, 1e-8);
}

/// Zero would need infinite damping: the least that is converted is used, and the card says so.
#[test]
fn less_restitution_than_can_be_converted_is_said_on_the_card() {
    let step = 0.001;
    for given in [0.0, 0.005] {
        let found = impact(&scene(METHODS[1], step / OMEGA, 0.4, "", &format!("restitution: {given:?}")));
        let ratio = ratio_of(LEAST_RESTITUTION);
        assert_near("restitution", found.restitution, LEAST_RESTITUTION, bound(METHODS[1], ratio, step));
        let told =
            |note: &String| note.contains("Dashpot cannot give the restitution") && note.contains("and gives 0.01");
        assert!(found.card.notes.iter().any(told), "{:?}", found.card.notes);
    }
}

/// Two equal discs, with half the mass: the catalogue's example. Lasts: until the force ends, with an overlap of
/// `2 b/w0^2` times the speed.
#[test]
fn two_discs_meet_with_their_reduced_mass() {
    let (mass, stiffness, rate) = (PI / 4.0, 1e5, 100.0);
    let omega = (2.0 * stiffness / mass).sqrt();
    let ratio = rate / omega;
    let (exact, lasts) = (0.574_364_374_5, 5.544_912_9e-3);
    let tick = 0.01 / omega;
    for method in METHODS {
        for theta in phases(32) {
            let (apart, damping) = (0.5 + tick * (1.0 + theta) / 2.0, rate * mass);
            let disc = |name: &str, x: f64, speed: f64| {
                format!(
                    "(name: \"{name}\", at: ({x:?}, 0), velocity: ({speed:?}, 0), material: \"steel\",
                      atoms: Disc(radius: 0.5, mass: {mass:?}))"
                )
            };
            let simulation = run(&format!(
                "Scene(format: 1, clock: (duration: 0.02, tick: {tick:?}, method: {method}),
                contacts: Penalty(normal: Dashpot, damping: {damping:?}),
                materials: {{ \"steel\": (stiffness: {:?}) }}, bodies: [{}, {}])",
                2.0 * stiffness,
                disc("a", -apart, 0.5),
                disc("b", apart, -0.5)
            ));
            let bodies = simulation.bodies();
            let speed = bodies.velocity[1].x - bodies.velocity[0].x;
            let gap = bodies.position[1].x - bodies.position[0].x - 1.0;
            assert_near("restitution", speed, exact, bound(method, ratio, 0.01));
            let ended = simulation.clock().time() - gap / speed - 2.0 * rate / (omega * omega);
            let began = tick * (1.0 + theta);
            // A change of speed changes nothing of the duration; the place after the touch does.
            let tolerance = second_order(method, ratio, 0.01) / exact / omega;
            let later = if method == METHODS[0] { 0.01 * ratio * lasts } else { 0.0 };
            assert_near("duration", ended - began, lasts, tolerance + later + tick * ratio);
        }
    }
}

/// A clump struck beside its centre of mass, with the effective mass `1/(1/M + x^2/I)`: a restitution comes out there too,
/// and N s/m give the ratio of that mass.
#[test]
fn beside_the_center_of_mass_the_effective_mass_counts() {
    let (mass, inertia, beside, stiffness, speed) = (1.0, 1.0 / 3.0, 0.7, 1e6_f64, 1e-4);
    let effective = 1.0 / (1.0 / mass + beside * beside / inertia);
    let omega = (stiffness / effective).sqrt();
    let (step, damping) = (0.01, 400.0);
    let given = damping / (2.0 * effective * omega);
    for method in METHODS {
        for (contacts, wanted) in [(String::new(), 0.5), (format!("damping: {damping:?}"), restitution(given))] {
            let ratio = ratio_of(wanted);
            for theta in phases(16) {
                let tick = step / omega;
                let height = 0.35 + speed * tick * (1.0 + theta);
                let simulation = run(&format!(
                    "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}),
                    contacts: Penalty(normal: Dashpot, {contacts}),
                    materials: {{ \"m\": (stiffness: {stiffness:?}, restitution: 0.5) }},
                    walls: [(name: \"wall\", left: (1, 0), right: (0, 0), material: \"m\")],
                    bodies: [(name: \"rod\", at: (0, {height:?}), velocity: (0, -{speed:?}), material: \"m\",
                              mass: {mass:?}, inertia: {inertia:?}, atoms: List([
                        (at: ({beside:?}, 0), radius: 0.1, mass: 0.5),
                        (at: (-{beside:?}, 0.5), radius: 0.1, mass: 0.5)]))])",
                    700.0 * tick
                ));
                let bodies = simulation.bodies();
                let impulse = (1.0 + wanted) * effective;
                let share = effective * bound(method, ratio, step);
                // It turns by 1e-6 while it touches.
                assert_near("impulse", (bodies.velocity[0].y / speed + 1.0) * mass, impulse, share + 1e-5);
                let spin = impulse * beside / inertia;
                assert_near("spin", bodies.spin[0] / speed, spin, share * beside / inertia + 1e-5);
            }
        }
    }
}

/// The work of the dashpot is booked with the mean of the forces at both ends of a tick, which both methods do as well,
/// but for the tick of the first touch: there the contact knows only the way since the touch. So the account is open by
/// `N theta v dt/2` with `N = k (1 - theta) v dt + c v`, and else by rounding: 1e-14 of the energy for each of up to 400
/// ticks.
#[test]
fn what_is_lost_is_booked_but_for_the_way_before_the_touch() {
    for method in METHODS {
        for ratio in RATIOS {
            for step in [0.04, 0.01] {
                for theta in phases(16) {
                    let tick = step / OMEGA;
                    let found = impact(&scene(method, tick, theta, &damped(ratio), ""));
                    let before = 0.5 * MASS * SPEED * SPEED;
                    let kinetic = before * found.restitution * found.restitution;
                    let way = SPEED * tick;
                    let force = STIFFNESS * (1.0 - theta) * way + damping(ratio) * SPEED;
                    let open = -0.5 * force * theta * way;
                    let energy = &found.card.energy;
                    assert_near("residual", energy.residual, open, 4e-12 * before);
                    assert_near("lost", energy.inelasticity, before - kinetic + open, 4e-12 * before);
                    assert_eq!((energy.elastic, energy.friction), (0.0, 0.0));
                }
            }
        }
    }
}

/// Weights of contacts from the floor up over `1 kg x g`.
fn assert_stands(what: &str, simulation: &mut Simulation, settled: f64, weight: f64) {
    assert_rest(what, simulation, settled, 2.0);
    let force = -contact_forces(simulation).on_wall[0].y;
    assert_near(what, force / weight, 1.0, 1e-9);
}

/// The force at rest has one value, `k d`, so that the motion dies out as `exp(-b t)`, and slower overdamped, until only
/// rounding is left of it; then nothing moves at all.
#[test]
fn bodies_come_to_rest_exactly() {
    for method in METHODS {
        for (contacts, restitution) in
            [("", 0.9), ("", 0.5), ("", 0.05), (&*damped(0.05), 1.0), (&*damped(1.5), 1.0), (&*damped(5.0), 1.0)]
        {
            let what = format!("{method}, {contacts} {restitution}");
            let world = |bodies: &str| {
                format!(
                    "Scene(format: 1, clock: (duration: 1000, tick: 2e-4, method: {method}), gravity: (0, -9.81),
                    materials: {{ \"clay\": (stiffness: {STIFFNESS:?}, restitution: {restitution:?}, friction: 0.5) }},
                    contacts: Penalty(normal: Dashpot, {contacts}), sensors: [ContactForce(on: \"floor\")],
                    walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"clay\")], bodies: [{bodies}])"
                )
            };
            let disc = |name: &str, height: f64| {
                format!(
                    "(name: \"{name}\", at: (0, {height:?}), material: \"clay\", atoms: Disc(radius: 0.1, mass: 1))"
                )
            };
            let mut ball = load(&world(&disc("ball", 0.5)));
            assert_stands(&what, &mut ball, 15.0, 9.81);
            assert_near(&what, 0.1 - ball.bodies().position[0].y, 9.81 / STIFFNESS, 1e-9 * 0.1);
            // One upon the other; their slower mode has a third of the damping.
            let mut column = load(&world(&format!("{}, {}", disc("lower", 0.1), disc("upper", 0.32))));
            assert_stands(&what, &mut column, 30.0, 2.0 * 9.81);
            // A block that lands on a corner.
            let block = "(name: \"block\", at: (0, 0.5), angle: 0.3, velocity: (0.5, 0), material: \"clay\",
                          atoms: Picture(spacing: 0.1, mass: 0.125, rows: [\"####\", \"####\"]))";
            assert_stands(&what, &mut load(&world(block)), 30.0, 9.81);
        }
    }
}

/// A row of `count` atoms, 0.2 m apart, that lands flat.
fn landing(
    method: &str,
    tick: f64,
    theta: f64,
    count: usize,
    inertia: &str,
    (contacts, material): (&str, &str),
) -> f64 {
    let height = RADIUS + SPEED * tick * (1.0 + theta);
    let simulation = run(&format!(
        "Scene(format: 1, clock: (duration: {:?}, tick: {tick:?}, method: {method}),
        materials: {{ \"clay\": (stiffness: {STIFFNESS:?}, {material}) }}, contacts: Penalty({contacts}),
        walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"clay\")],
        bodies: [(name: \"row\", at: (0.5, {height:?}), velocity: (0, -{SPEED:?}), material: \"clay\",
                  mass: {MASS:?}, {inertia} atoms: Picture(spacing: {:?}, mass: 1, rows: [{:?}]))])",
        10.0 / OMEGA,
        2.0 * RADIUS,
        "#".repeat(count)
    ));
    let bodies = simulation.bodies();
    assert!(bodies.position[0].y > RADIUS, "it should have left the wall");
    assert_near("it lands flat", bodies.angle[0], 0.0, 1e-12);
    bodies.velocity[0].y / SPEED
}

/// Under Inelasticity work is lost in proportion to elastic energy, whatever the number of springs.
#[test]
fn under_inelasticity_restitution_does_not_depend_on_how_many_atoms_land() {
    let wanted: f64 = 0.5;
    let inelasticity = (1.0 - wanted * wanted) / (1.0 + wanted * wanted);
    for method in METHODS {
        for count in [1_usize, 4, 9] {
            let (tick, rate) = (0.005 / OMEGA, (count as f64).sqrt());
            for theta in phases(16) {
                let law = ("normal: Inelasticity", "restitution: 0.5");
                let found = landing(method, tick, theta, count, "", law);
                // See `restitution`.
                let tolerance = (2.0 * inelasticity / wanted + wanted / 2.0) * (0.005 * rate).powi(2);
                assert_near("restitution", found, wanted, tolerance);
            }
        }
    }
}

/// Under Dashpot `k` and `c` of all atoms add up. Given N s/m, the damping ratio is `sqrt(n)` times that of one atom under
/// the whole mass, and so it is given a restitution where levers do not count. Else each atom has the damping of its own
/// effective mass `1/(1/M + x^2/I)`: two of them, `x` to both sides, make `sqrt(2/(1 + M x^2/I))` times the ratio, which is
/// none more where one feels nothing of the other, `M x^2 = I`. (With more than two their forces end one after the other.)
#[test]
fn under_dashpot_restitution_falls_with_the_number_of_atoms_that_land() {
    let (step, ratio) = (0.005, ratio_of(0.5));
    let (given, converted) = (damped(ratio), String::new());
    let own = MASS * RADIUS * RADIUS;
    let lever = |share: f64| (2.0 / (1.0 + share)).sqrt();
    for (count, contacts, inertia, factor) in [
        (1_usize, &given, own, 1.0),
        (4, &given, own, 2.0),
        (9, &given, own, 3.0),
        (1, &converted, own, 1.0),
        (4, &converted, 1e9, 2.0),
        (9, &converted, 1e9, 3.0),
        (2, &converted, own, lever(1.0)),
        (2, &converted, 3.0 * own, lever(1.0 / 3.0)),
        (2, &given, own, 2.0_f64.sqrt()),
    ] {
        let together = factor * ratio;
        for method in METHODS {
            for theta in phases(16) {
                let law = (&*format!("normal: Dashpot, {contacts}"), "restitution: 0.5");
                let clause = format!("inertia: {inertia:?},");
                let found = landing(method, step / OMEGA, theta, count, &clause, law);
                let tolerance = bound(method, together, step * (count as f64).sqrt());
                assert_near(&format!("restitution of {count}"), found, restitution(together), tolerance);
            }
        }
    }
    let row = "materials: { \"clay\": (restitution: 0.5) }, contacts: Penalty(normal: Dashpot),
        bodies: [(name: \"row\", at: (0, 1), material: \"clay\", atoms: Picture(spacing: 0.1, mass: 1, rows: [\"##\"]))])";
    let notes = load(&format!("Scene(format: 1, clock: (duration: 1, tick: 1e-3), {row}")).card().notes;
    assert!(
        notes.iter().any(|note| note
            .contains("A body that lands on n atoms at once rebounds less. Its damping ratio is up to sqrt(n) times")),
        "{notes:?}"
    );
}
