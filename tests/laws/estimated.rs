//! Law: the error that a run estimates of itself is that which it has.
//!
//! Two runs with ticks `h` and `h/2` differ by `(1 - 2^-p)` of the error of the first, if errors fall with the power `p`; the next
//! term of an error, and an order that is lower where forces jump, change that by a factor below 3 in the range where errors fall
//! with the tick. Phases of events in ticks scatter: a tenth of the settings may be outside, none by more than 10 below.
//!
//! The truth is the reference run of the same scene, whose error is far below.

use jostle::problems;
use jostle::report::Card;
use jostle::report::estimate::validation::{Checked, METHODS, check};
use jostle::report::estimate::{Effort, EstimateRequest, Repeated, estimate, watch};
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

#[test]
fn estimates_are_within_a_factor_of_three_of_the_truth() {
    let all: Vec<Checked> = problems::ALL
        .iter()
        .flat_map(|problem| check(problem).unwrap_or_else(|error| panic!("{}: {error}", problem.name)))
        .collect();
    // On most problems errors of order 8 are rounding before they fall with the order.
    for (method, least) in METHODS.into_iter().zip([60, 40, 12]) {
        let many = all.iter().filter(|checked| checked.method == method).count();
        assert!(many >= least, "{method}: {many} settings are compared");
    }
    let outside: Vec<&Checked> = all.iter().filter(|checked| !(1.0 / 3.0..=3.0).contains(&checked.ratio())).collect();
    assert!(10 * outside.len() <= all.len(), "{} of {} are outside: {outside:#?}", outside.len(), all.len());
    let low: Vec<&&Checked> = outside.iter().filter(|checked| checked.ratio() < 0.1).collect();
    assert!(low.is_empty(), "more than ten times too small: {low:#?}");
}

/// Runs a scene and estimates its error.
fn estimated(text: &str, wanted: EstimateRequest) -> Card {
    let source = Source::new("scene.ron", text);
    let overrides = Overrides::default();
    let load = |overrides: &Overrides| Simulation::load_with(&source, overrides, |_| {});
    let mut simulation = load(&overrides).unwrap();
    watch(&mut simulation, wanted);
    simulation.run_to_end().unwrap();
    estimate(&mut simulation, wanted, &Repeated { overrides: &overrides, load: &load, tell: None, interrupted: None })
        .unwrap();
    simulation.card()
}

/// Law: velocity Verlet runs an oscillator ahead by `(omega h)^2/24` of its phase (Hairer, Lubich, Wanner, *Geometric Numerical
/// Integration*, 2nd ed. 2006, I.5), so that its error grows with time. Of the long run only the beginning is made again, and the error is
/// that until then. The end of the part falls on some phase, whose sine changes what is seen by a factor of 2 at most after several
/// periods.
#[test]
fn the_error_of_the_beginning_is_that_until_then() {
    let (omega, tick, duration) = (10.0_f64, 1e-4, 200.0);
    let text = format!(
        "Scene(format: 1, clock: (duration: {duration}, tick: {tick}, method: VelocityVerlet),
            bodies: [(name: \"mass\", at: (1, 0), atoms: Disc(radius: 0.1, mass: 1))],
            forces: [Spring(a: \"mass\", b: World, stiffness: {}, length: 0)])",
        omega * omega
    );
    let card = estimated(&text, EstimateRequest::default());
    assert!(card.notes.iter().any(|note| note.contains("With --estimate they cover all")), "{:?}", card.notes);
    let error = card.error.unwrap();
    let (found, until) = (error.position.discretisation.unwrap(), error.horizon.unwrap());
    assert!(until < duration / 2.0, "{until}");
    let exact = omega * until * (omega * tick).powi(2) / 24.0;
    assert!((0.5..2.0).contains(&(found / exact)), "{found:e} {exact:e}");
}

/// Law: a contact lasts `pi sqrt(m/k)`, by which a body comes back later than from a hard wall: its place is off by that times
/// its speed. With four times the stiffness it is half of that, so the estimate is the error but for that of the ticks: 2 %.
#[test]
fn the_error_of_the_model_is_that_of_soft_contacts() {
    let text = "Scene(format: 1, clock: (duration: 2, tick: 1e-4, method: VelocityVerlet),
        materials: { \"elastic\": (stiffness: 4000, restitution: 1) },
        walls: [(name: \"wall\", left: (0, 0), right: (0, 1), material: \"elastic\")],
        bodies: [(name: \"ball\", at: (1, 0.5), velocity: (-1, 0), material: \"elastic\", atoms: Disc(radius: 0.1, mass: 1))])";
    let card = estimated(text, EstimateRequest { effort: Effort::None, model: true, rounding: false });
    let found = card.error.unwrap().position.model.unwrap();
    let exact = std::f64::consts::PI / 4000.0_f64.sqrt();
    assert!((found / exact - 1.0).abs() < 0.02, "{found} {exact}");
}

/// Law: `n` ticks whose velocity and place are wrong by a last bit, `u v` and `u x`, leave a place wrong by the sum of random
/// steps: `u v t sqrt(n/3)` by velocities, and `u x sqrt(n)`. Tolerance: the greatest of three samples of a normal
/// distribution at the end of the run lies between a tenth of its width and five widths but for one in a thousand, and last
/// bits are between half and the whole of `u`.
#[test]
fn rounding_walks_at_random() {
    let text = "Scene(format: 1, clock: (duration: 10, tick: 1e-3, method: VelocityVerlet),
        bodies: [(name: \"ball\", at: (1, 0), velocity: (1, 0), atoms: Disc(radius: 0.1, mass: 1))])";
    let card = estimated(text, EstimateRequest { effort: Effort::None, rounding: true, model: false });
    let found = card.error.unwrap().position.rounding.unwrap();
    let (ticks, duration) = (1e4_f64, 10.0);
    let width = f64::EPSILON * (duration * (ticks / 3.0).sqrt()).hypot(duration * ticks.sqrt());
    assert!((0.05 * width..5.0 * width).contains(&found), "{found:e} {width:e}");
}

/// Law: orders 2 and 4 on smooth motion. Tolerance: half an order.
#[test]
fn the_observed_order_is_that_of_the_method() {
    let spring = |method: &str| {
        format!(
            "Scene(format: 1, clock: (duration: 5, tick: 0.02, method: {method}),
            bodies: [(name: \"mass\", at: (1, 0), atoms: Disc(radius: 0.1, mass: 1))],
            forces: [Spring(a: \"mass\", b: World, stiffness: 25, length: 0)])"
        )
    };
    for (method, order) in [("VelocityVerlet", 2.0), ("RungeKutta4", 4.0)] {
        let card = estimated(&spring(method), EstimateRequest { effort: Effort::Full, ..EstimateRequest::default() });
        let observed = card.error.unwrap().observed_order.unwrap();
        assert!((observed - order).abs() < 0.5, "{method}: {observed}");
    }
}

/// Law: a limit, a rope and a break that are seen at the ends of ticks make an error of order 1, which depends on where in a tick they fall.
/// The estimate knows of it wherever that is. Source: free fall onto a limit with restitution `e`, `y = e v (1 - t) - g (1 - t)^2/2` behind
/// the blow at `t = v/g`. Tolerance: a factor of 3 below, as for all estimates; the velocity of the blow is that of the end of its tick.
#[test]
fn limits_between_ticks_are_in_the_estimate() {
    for height in [2.511_821_624_700_256_7_f64, 2.4, 1.9, 1.37, 3.1, 2.05] {
        let text = format!(
            "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\", method: VelocityVerlet), gravity: (0, -10), contacts: None,
            bodies: [(name: \"p\", at: (0, {height:?}), mass: 1, atoms: Disc(radius: 0.05))],
            joints: [Prismatic(a: World, anchor_a: (0, 0), b: \"p\", axis: (0, 1), limits: (0, 5), restitution: 0.6)])"
        );
        let source = Source::new("limit.ron", &text);
        let mut simulation = Simulation::load_with(&source, &Overrides::default(), |_| {}).unwrap();
        simulation.run_to_end().unwrap();
        let blow = (0.2 * height).sqrt();
        let exact = 0.6 * 10.0 * blow * (1.0 - blow) - 5.0 * (1.0 - blow) * (1.0 - blow);
        let error = (simulation.bodies().position[0].y - exact).abs();
        let stated = estimated(&text, EstimateRequest::default())
            .error
            .and_then(|error| error.position.discretisation)
            .unwrap_or_default();
        println!("{height}: {error:.1e} m, {stated:.1e} m stated");
        assert!(3.0 * stated >= error, "{height}: {error:e} m, {stated:e} m stated");
    }
}
