//! `tolerance`: the error of a scene keeps to the allowed one, on all problems with known answers.
//!
//! The allowed error is a share of how far bodies go and how fast they are; the norms of the problems are such shares too,
//! of sizes of their own, so that three times the tolerance is asked of them (the sizes differ by less). What remains below
//! the rounding of a problem cannot be asked; the run then has to say so.
//!
//! Cost is counted in evaluations of all forces. The chosen run is compared with the cheapest allowed run with equal
//! ticks, of four methods and of numbers of ticks that double up to four thousand. Readings of the run are left out,
//! and so are trials, which come on top; the card gives their number.

use jostle::problems::{ALL, EventTiming, Problem, ProblemSetting, rotating_ring, settling_bounce};
use jostle::scene::Source;
use jostle::simulation::{Overrides, Plan};
use jostle::{Simulation, SimulationExt};

/// Evaluations that are too few to count: a dozen steps. They are made to look at the beginning.
const FEW: u64 = 150;

/// Where bodies swing so fast that stability sets the steps, `Dop853` takes 12 evaluations for each 5.96 of `w h`, velocity Verlet 1 for
/// each 2: so many times as many.
const STABLE: f64 = 12.0 / 5.96 * 2.0;
/// Links of a rope with a heavy load swing so fast. Contacts of a ladder, a slider and a block hardly swing at all, and the swing of a plank
/// is over at the end: there any stable tick is good.
const STIFF: [&str; 5] = ["loaded_rope", "falling_ladder", "leaving_cylinder", "rocking_block", "plank"];

/// Tolerances from 1e-3 to 1e-10.
const DECADES: [f64; 8] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

fn load_by(problem: &Problem, text: &str, tolerance: Option<f64>, plan: Option<Plan>) -> Simulation {
    let overrides = Overrides { tolerance, plan, ..Overrides::default() };
    let source = Source::new(format!("{}.ron", problem.name), text);
    Simulation::load_with(&source, &overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

fn load(problem: &Problem, text: &str, tolerance: Option<f64>) -> Simulation {
    load_by(problem, text, tolerance, None)
}

/// All problems, those that turn or swing for long cut short.
fn problems() -> impl Iterator<Item = Problem> {
    ALL.iter().map(|problem| problem.within_ticks(20_000.0))
}

/// Error at the end, and evaluations.
fn run(problem: &Problem, simulation: &mut Simulation) -> (f64, u64) {
    simulation.run_to_end().expect("numbers stay finite");
    let error = (problem.error)(simulation, problem.duration(), 0.0);
    (error, simulation.state().evaluation().count)
}

fn scene(problem: &Problem, method: &str, tick: f64, events: EventTiming) -> String {
    (problem.scene)(&ProblemSetting { method, tick, shift: 0.0, events }, problem.duration())
}

fn without_tick(problem: &Problem) -> String {
    let tick = problem.duration();
    scene(problem, "Auto", tick, EventTiming::Auto).replace(&format!("tick: {tick:?}, "), "")
}

/// Whether a run says that it does not reach its tolerance.
fn warns(simulation: &Simulation) -> bool {
    simulation.card().warnings.iter().any(|warning| warning.contains("is not reached"))
}

/// A run that warns of rounding is let off, where the bound of the problem's rounding is above a tenth of the tolerance, which is
/// what the finer of two trials asks for: bodies that move by micrometres or nanometres at a metre from the origin.
#[test]
fn the_error_of_a_run_is_no_more_than_what_is_allowed() {
    let mut wrong = Vec::new();
    for problem in &problems().collect::<Vec<_>>() {
        for tolerance in DECADES {
            let mut simulation = load(problem, &without_tick(problem), Some(tolerance));
            let (error, _) = run(problem, &mut simulation);
            let let_off = warns(&simulation) && (problem.rounding)(problem.tick) > 0.1 * tolerance;
            if !let_off && (warns(&simulation) || error.is_nan() || error > 3.0 * tolerance) {
                wrong.push(format!("{} with {tolerance:e}: {error:e}", problem.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A ball that bounces ever smaller, a dozen times, until it rests: which bounce a run ends in changes how its error falls with
/// its steps, and errors of located events scatter. Its place is known in closed form at all times.
#[test]
fn errors_that_fall_unevenly_are_no_larger() {
    let mut wrong = Vec::new();
    for samples in [&[0.9], &[1.1], &[1.7], &[2.0], &[2.3], &[2.6], &[2.9], &[3.5]] {
        let problem = Problem { samples, ..settling_bounce::PROBLEM };
        for tolerance in DECADES {
            let mut simulation = load(&problem, &without_tick(&problem), Some(tolerance));
            let (error, _) = run(&problem, &mut simulation);
            if error.is_nan() || error > 3.0 * tolerance {
                wrong.push(format!("{} s with {tolerance:e}: {error:e}", problem.duration()));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Two or three tries of twelve evaluations, four more to look inside and some guesses: about fifty for each event. Lists of
/// candidates are not made anew for where the stages of a step that was refused went astray: that took 250.
#[test]
fn an_event_costs_a_few_steps() {
    let problem = settling_bounce::PROBLEM;
    for tolerance in [1e-3, 1e-4, 1e-5] {
        let mut simulation = at_once(&problem, &load(&problem, &without_tick(&problem), Some(tolerance)), tolerance);
        let (_, cost) = run(&problem, &mut simulation);
        let events = simulation.state().located().count;
        assert!(events >= 6 && cost <= 60 * events, "{tolerance:e}: {cost} for {events}");
    }
}

/// The same run again, looked at only at its end: its steps do not end at ticks, or it is exact with any.
fn at_once(problem: &Problem, found: &Simulation, tolerance: f64) -> Simulation {
    let plan = found.plan().expect("a tolerance has a plan");
    let free = plan.method == "Dop853" || plan.notes.iter().any(|note| note.ends_with("so that it is exact"));
    assert!(free, "{plan:?}");
    let plan = Plan { tick: problem.duration(), ..plan.clone() };
    load_by(problem, &without_tick(problem), Some(tolerance), Some(plan))
}

/// The problem as its cost is compared: at an end that shows what went wrong on the way. The sled comes to rest at the right place
/// even if all its swings were late, so it is looked at while it moves.
fn telling(problem: Problem) -> Problem {
    let samples = if problem.name == "coulomb_oscillator" { &problem.samples[..3] } else { problem.samples };
    Problem { samples, ..problem }
}

/// The error, and for the ring also how late its first mass is: after a whole turn it is back where it began, while the norm of the
/// problem sees its distance from the middle only.
fn error_with_phase(problem: &Problem, simulation: &Simulation) -> f64 {
    let error = (problem.error)(simulation, problem.duration(), 0.0);
    if problem.name != "rotating_ring" {
        return error;
    }
    let radius = rotating_ring::radius();
    error.max((simulation.bodies().position[0] - glam::DVec2::new(radius, 0.0)).length() / radius)
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
    let mut wrong = Vec::new();
    for problem in &problems().map(telling).collect::<Vec<_>>() {
        let mut known = Vec::new();
        for (method, events) in ways {
            let mut ticks = 1.0_f64;
            while ticks < 5000.0 {
                let text = scene(problem, method, problem.duration() / ticks.round(), events);
                let mut simulation = load(problem, &text, None);
                if simulation.run_to_end().is_ok() {
                    let error = error_with_phase(problem, &simulation);
                    known.push((error, simulation.state().evaluation().count));
                    // Nothing that is finer is cheaper.
                    if error < 1e-11 {
                        break;
                    }
                }
                ticks *= 2.0;
            }
        }
        for tolerance in DECADES {
            let Some(cheapest) = known.iter().filter(|(error, _)| *error <= tolerance).map(|(_, cost)| *cost).min()
            else {
                continue;
            };
            let found = load(problem, &without_tick(problem), Some(tolerance));
            let (_, cost) = run(problem, &mut at_once(problem, &found, tolerance));
            let dearer = if STIFF.contains(&problem.name) { STABLE } else { 1.0 };
            if cost as f64 > 3.0 * dearer * cheapest as f64 + FEW as f64 {
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
    assert!(card.verdict.contains("Do not trust its last digits"), "{}", card.verdict);
}

/// At the finest tolerances trials end at the finest steps. The stated error covers the true one, and is neither zero nor absurd: a
/// problem of smooth motion is solved to 1e-8 of its size by any steps near rounding.
#[test]
fn the_finest_tolerances_state_an_error_that_it_has() {
    for problem in [jostle::problems::spring_mass::PROBLEM, jostle::problems::kepler::PROBLEM] {
        for tolerance in [1e-12, 3e-13, 1e-13] {
            let mut simulation = load(&problem, &without_tick(&problem), Some(tolerance));
            let (error, _) = run(&problem, &mut simulation);
            let known = simulation.card().error.expect("it is known").position;
            let stated = known.discretisation.expect("smooth motion") + known.rounding.unwrap_or(0.0);
            assert!(stated > 0.0 && stated < 1e-8, "{} {tolerance:e}: {stated:e}", problem.name);
            // Norms are shares of sizes of 1 mm and more.
            assert!(
                error <= 1e3 * stated + (problem.rounding)(problem.tick),
                "{}: {error:e}, {stated:e}",
                problem.name
            );
        }
    }
}

/// Two swings of a double pendulum part exponentially: no steps keep to a tolerance for sixty seconds. The card says until when its error
/// holds, and a run with another tolerance keeps to it until then. Both may err by what is stated: a factor of two. Afterwards they
/// differ by more, so the time is needed.
#[test]
fn the_error_of_a_chaotic_run_holds_until_the_stated_time() {
    let source = Source::read("scenes/double_pendulum.ron".as_ref()).unwrap();
    let with = |tolerance: f64| {
        let (tolerance, duration) = (Some(tolerance), Some(60.0));
        let overrides = Overrides { tolerance, duration, ..Overrides::default() };
        Simulation::load_with(&source, &overrides, |_| {}).unwrap()
    };
    let (mut run, mut other) = (with(1e-6), with(1e-10));
    let (mut before, mut after) = (0.0_f64, 0.0_f64);
    let horizon = run.card().error.and_then(|error| error.horizon).expect("chaos");
    for tick in 1..=run.ticks() {
        run.run_to_tick(tick).unwrap();
        other.run_to_tick(tick).unwrap();
        let time = run.clock().time();
        assert_eq!(time, other.clock().time());
        let places = run.bodies().position.iter().zip(&other.bodies().position);
        let apart = places.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let greatest = if time <= horizon { &mut before } else { &mut after };
        *greatest = greatest.max(apart);
    }
    let card = run.card();
    let stated = card.error.and_then(|error| error.position.discretisation).expect("it is known until then");
    assert!(
        (5.0..55.0).contains(&horizon) && before <= 2.0 * stated && after > 2.0 * stated,
        "{before} {after} {stated}"
    );
    assert!(card.verdict.contains("Do not trust places after about t = "), "{}", card.verdict);
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
        // Where rounding bounds the steps it knows no error, and says so.
        let let_off = simulation.card().warnings.iter().any(|warning| warning.contains("bounds the steps"));
        assert!(error <= allowed || let_off, "{}: {error:e} > {allowed:e}", problem.name);
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
