//! `tolerance`: the error that a scene is allowed is the error that it has, on all problems whose answer is known.
//!
//! The allowed error is a share of how far bodies go and how fast they are; the norms of the problems are such shares too,
//! of sizes of their own, so that three times the tolerance is asked of them (the sizes differ by less). What remains below
//! the rounding of a problem cannot be asked.
//!
//! Cost is counted in evaluations of all forces. The run that is chosen is compared with the cheapest of the runs with equal
//! ticks, of four methods and of numbers of ticks that double up to a thousand: those that the tolerance allows. An evaluation for each frame
//! at which the run is looked at is left out, and so are trials, which come on top; the card says how many.

use jostle::Simulation;
use jostle::problems::{ALL, EventTiming, Problem, Setting};
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::Evaluation;

/// Evaluations that are too few to count: a dozen steps. They are made to look at the beginning.
const FEW: u64 = 150;

fn load(problem: &Problem, text: &str, tolerance: Option<f64>) -> Simulation {
    let overrides = Overrides { tolerance, ..Overrides::default() };
    let source = Source::new(format!("{}.ron", problem.name), text);
    Simulation::load_with(&source, &overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

/// Problems left out: bodies that move by micrometres or nanometres at a metre from the origin, where rounding of places is 1e-9 and 1e-7
/// of the motion; and a ball that bounces for ever smaller, whose error does not fall evenly (found: 60 times the tolerance of 1e-5).
const UNEVEN: [&str; 3] = ["tangential_impact", "frictional_collision", "settling_bounce"];

/// All other problems, those that turn or swing for long cut short.
fn problems() -> impl Iterator<Item = Problem> {
    ALL.iter().filter(|problem| !UNEVEN.contains(&problem.name)).map(|problem| problem.within_ticks(20_000.0))
}

/// Error at the end, and evaluations.
fn run(problem: &Problem, simulation: &mut Simulation) -> (f64, u64) {
    simulation.run_to_end().expect("numbers stay finite");
    let error = (problem.error)(simulation, problem.duration(), 0.0);
    (error, simulation.world().resource::<Evaluation>().count)
}

fn scene(problem: &Problem, method: &str, tick: f64, events: EventTiming) -> String {
    (problem.scene)(&Setting { method, tick, shift: 0.0, events }, problem.duration())
}

fn without_tick(problem: &Problem) -> String {
    let tick = problem.duration();
    scene(problem, "Auto", tick, EventTiming::Auto).replace(&format!("tick: {tick:?}, "), "")
}

#[test]
fn the_error_of_a_run_is_no_more_than_what_is_allowed() {
    let mut wrong = Vec::new();
    for problem in &problems().collect::<Vec<_>>() {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let mut simulation = load(problem, &without_tick(problem), Some(tolerance));
            let (error, _) = run(problem, &mut simulation);
            let rounding = (problem.rounding)(problem.tick);
            let allowed = 3.0 * tolerance + rounding;
            if error.is_nan() || error > allowed {
                wrong.push(format!("{} with {tolerance:e}: {error:e} > {allowed:e}", problem.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_run_costs_at_most_three_times_the_cheapest_with_equal_ticks() {
    let ways = [
        ("VelocityVerlet", EventTiming::Auto),
        ("VelocityVerlet", EventTiming::Located),
        ("RungeKutta4", EventTiming::Located),
        ("Symplectic4", EventTiming::Located),
        ("Dop853", EventTiming::Located),
    ];
    // The ring's norm does not see along which way its bodies are late; the sled has its error from the rounding of its stops.
    let unlike = ["rotating_ring", "coulomb_oscillator"];
    let mut wrong = Vec::new();
    for problem in &problems().filter(|problem| !unlike.contains(&problem.name)).collect::<Vec<_>>() {
        let mut known = Vec::new();
        for (method, events) in ways {
            let mut ticks = 1.0_f64;
            while ticks < 1500.0 {
                let text = scene(problem, method, problem.duration() / ticks.round(), events);
                let mut simulation = load(problem, &text, None);
                if simulation.run_to_end().is_ok() {
                    let error = (problem.error)(&simulation, problem.duration(), 0.0);
                    known.push((error, simulation.world().resource::<Evaluation>().count));
                }
                ticks *= 2.0;
            }
        }
        for tolerance in [1e-4, 1e-8] {
            let Some(cheapest) = known.iter().filter(|(error, _)| *error <= tolerance).map(|(_, cost)| *cost).min()
            else {
                continue;
            };
            let mut simulation = load(problem, &without_tick(problem), Some(tolerance));
            let (_, cost) = run(problem, &mut simulation);
            let cost = cost.saturating_sub(simulation.ticks());
            if cost > 3 * cheapest + FEW {
                wrong.push(format!("{} with {tolerance:e}: {cost} > 3 x {cheapest}", problem.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_card_says_how_wrong_the_run_is() {
    let problem = jostle::problems::kepler::PROBLEM;
    let mut simulation = load(&problem, &without_tick(&problem), Some(1e-8));
    let (error, _) = run(&problem, &mut simulation);
    let card = simulation.card();
    let known = card.error.and_then(|error| error.position.discretisation).expect("the error is known");
    assert!(error <= 10.0 * known && known <= 3e-8, "{error:e} {known:e}");
    assert!(card.verdict.starts_with("Trust it: places to about"), "{}", card.verdict);
    assert!(card.notes.iter().any(|note| note.starts_with("tolerance 1e-8: Dop853")), "{:?}", card.notes);
}

/// Bodies that move by nanometres at a metre from the origin: rounding of places is 1e-7 of the motion. Asked for less, the card
/// does not say that it was reached.
#[test]
fn a_tolerance_below_rounding_is_not_said_to_be_reached() {
    let problem = jostle::problems::frictional_collision::PROBLEM;
    let simulation = load(&problem, &without_tick(&problem), Some(1e-12));
    let card = simulation.card();
    let told =
        card.warnings.iter().any(|warning| warning.contains("tolerance of 1e-12 is not reached: rounding of places"));
    assert!(told, "{:?}", card.warnings);
    assert!(card.verdict.starts_with("Do not trust its last digits"), "{}", card.verdict);
}

#[test]
fn a_reference_run_states_an_error_that_it_has() {
    for problem in &problems().collect::<Vec<_>>() {
        let text = scene(problem, "Reference", problem.duration() / 64.0, EventTiming::Auto);
        let mut simulation = load(problem, &text, None);
        let (error, _) = run(problem, &mut simulation);
        let known = simulation.card().error.expect("it is known");
        let stated = known.position.discretisation.expect("the run went well") + known.position.rounding.unwrap_or(0.0);
        let velocity = known.velocity.discretisation.expect("the run went well");
        // Norms are shares of sizes of 1 mm and more.
        let allowed = 1e3 * (stated + velocity) + (problem.rounding)(problem.tick);
        assert!(error <= allowed, "{}: {error:e} > {allowed:e}", problem.name);
    }
}

/// Two bodies of a billiard lose all digits after a dozen collisions; a pendulum-like spring never does.
#[test]
fn a_reference_run_tells_chaos_from_order() {
    let order = scene(&jostle::problems::spring_mass::PROBLEM, "Reference", 1e-2, EventTiming::Auto);
    let simulation = load(&jostle::problems::spring_mass::PROBLEM, &order, None);
    assert_eq!(simulation.card().error.and_then(|error| error.horizon), None);
    let chaos = r#"Scene(format: 1, clock: (duration: 6, tick: 0.01, method: Reference),
        materials: {"m": (stiffness: 1e4)},
        walls: [(name: "floor", left: (2, 0), right: (0, 0), material: "m"), (name: "top", left: (0, 2), right: (2, 2), material: "m"),
                (name: "west", left: (0, 0), right: (0, 2), material: "m"), (name: "east", left: (2, 2), right: (2, 0), material: "m")],
        bodies: [
            (name: "a", at: (0.5, 0.6), velocity: (2, 1.1), material: "m", atoms: Disc(radius: 0.2, mass: 1)),
            (name: "b", at: (1.4, 1.3), velocity: (-1, 1.7), material: "m", atoms: Disc(radius: 0.2, mass: 1)),
            (name: "c", at: (1.2, 0.5), velocity: (0.3, -1.7), material: "m", atoms: Disc(radius: 0.2, mass: 1)),
        ])"#;
    let simulation = load(&jostle::problems::spring_mass::PROBLEM, chaos, None);
    let horizon = simulation.card().error.and_then(|error| error.horizon).expect("discs that collide are chaotic");
    assert!(horizon > 3.0 && horizon < 60.0, "{horizon}");
}
