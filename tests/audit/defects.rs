//! Scenes with earlier defects of the engine, each with the right result.

use jostle::problems::hard::kinetic;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

use super::ran::{Ran, run};

fn text(name: &str) -> String {
    let path = format!("{}/assets/defects/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|wrong| panic!("{path}: {wrong}"))
}

fn load(name: &str, overrides: &Overrides) -> Simulation {
    let source = Source::new(name, text(name));
    Simulation::load_with(&source, overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}"))
}

fn end(name: &str, overrides: &Overrides) -> Simulation {
    let mut simulation = load(name, overrides);
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{name}: {failure}"));
    simulation
}

fn method(name: &str) -> Overrides {
    Overrides { method: Some(name.to_owned()), ..Overrides::default() }
}

fn tolerance(tolerance: f64) -> Overrides {
    Overrides { tolerance: Some(tolerance), ..Overrides::default() }
}

fn ran(name: &str) -> Ran {
    run(&text(name), 1).unwrap_or_else(|why| panic!("{name}: {why}"))
}

/// The normal force drops at the turn from loading to unloading: a spring that holds more than the cone slips at once. The spins
/// are those of an event-driven solution.
#[test]
fn friction_keeps_to_the_cone_where_the_normal_force_jumps() {
    for (name, overrides, spin) in [
        ("coulomb_tolerance", tolerance(1e-8), 3.723_493_773),
        ("coulomb_tolerance", method("Dop853"), 3.723_493_773),
        ("dashpot_located", method("Reference"), -8.680_013_421),
        ("dashpot_located", method("RungeKutta4"), -8.680_013_421),
    ] {
        let found = end(name, &overrides).bodies().spin[0];
        assert!((found - spin).abs() < 1e-5, "{name}: {found} instead of {spin}");
    }
    let two =
        [method("Reference"), method("Dop853")].map(|overrides| end("coulomb_reference", &overrides).bodies().spin[0]);
    assert!((two[0] - two[1]).abs() < 1e-9, "{two:?}");
}

/// A disc that stands on a slope at the start, a little too steep for its friction: it slides from the beginning with
/// `(g_x m - mu g_y m)/m` under all methods. Its inertia is so great that it does not roll.
#[test]
fn a_contact_at_the_start_slides_with_the_same_force_under_all_methods() {
    for name in ["VelocityVerlet", "SemiImplicitEuler", "RungeKutta4", "Dop853", "ImplicitMidpoint"] {
        let simulation = end("start_at_rest", &method(name));
        let acceleration = 4.052_554_456_578_755 - 0.45 * 8.933_806_712_508_598;
        let (x, time) = (simulation.bodies().position[0].x, simulation.clock().time());
        let exact = 0.5 * acceleration * time * time;
        // Order 1 of the semi-implicit method: half a tick of the final speed.
        let allowed = 1e-9 + 0.5 * simulation.clock().dt * acceleration * time * f64::from(name == "SemiImplicitEuler");
        assert!((x - exact).abs() <= allowed, "{name}: {x} instead of {exact}");
    }
}

#[test]
fn friction_without_a_spring_may_have_a_tolerance() {
    let two = [1e-6, 1e-9].map(|wanted| end("exact_tolerance", &tolerance(wanted)).bodies().position[0]);
    assert!((two[0] - two[1]).length() < 1e-6, "{two:?}");
}

/// Where the static coefficient is above the dynamic one Verlet converges to what located events give, wherever in a tick the
/// collision turns.
#[test]
fn verlet_converges_where_friction_falls_as_it_slips() {
    let exact = end("vv_static_dynamic", &method("Dop853")).bodies().position[0];
    for place in 0..40 {
        let tick = 1e-6 * 20.0_f64.powf((f64::from(place) * 0.618).fract());
        let found = end("vv_static_dynamic", &Overrides { tick: Some(tick), ..method("VelocityVerlet") });
        // The impact ends at about 2 m/s, and another tick may shift it by a few ticks.
        let (place, time) = (found.bodies().position[0], found.clock().time());
        let ends = time - 0.1;
        let wrong = (place - exact - found.bodies().velocity[0] * ends).length();
        assert!(wrong < 20.0 * tick, "{wrong:e} m at ticks of {tick:e} s");
    }
}

/// A contact that fits inside one tick is resolved by shorter steps, its error is stated, and the tick is warned of.
#[test]
fn a_contact_inside_one_tick_is_resolved_and_warned_of() {
    let exact = end("blind", &Overrides { tick: Some(1e-5), ..method("Dop853") }).bodies().velocity[0];
    let coarse = ran("blind");
    let error = coarse.card.error.expect("estimated").velocity.discretisation.expect("estimated");
    let wrong = (coarse.seen[0].1[0].velocity - exact).length();
    assert!(error > wrong / 10.0, "{error:e} stated, {wrong:e} wrong");
    assert!(coarse.card.largest_overlap.meters > 0.0);
    assert!(
        coarse.card.warnings.iter().any(|warning| warning.contains("above the critical one")),
        "{:?}",
        coarse.card.warnings
    );
    let bullet = ran("bullet_free_Dop_bigtick");
    let truth = end("bullet_free_Dop_bigtick", &Overrides { tick: Some(1e-5), ..method("Dop853") });
    let wrong = (bullet.seen[0].1[0].velocity - truth.bodies().velocity[0]).length();
    // The impact changes the velocity by up to 2 v.
    assert!(wrong < 1.0, "{wrong} m/s: the contact was jumped");
}

/// A swing of 30 Hz, seen at 30 frames a second, and a drive of 60 Hz: errors and sizes are those of the run.
#[test]
fn film_rates_do_not_blind_the_estimate() {
    // `x = 1 + A sin(omega t)` has the amplitude 0.02 m, and 3.77/188.5 = 0.02 m.
    for name in ["strobe_kick30", "strobe_rest30"] {
        for wanted in [1e-4, 1e-8] {
            let simulation = end(name, &tolerance(wanted));
            let body = simulation.bodies();
            let error = simulation.card().error.expect("known").position.discretisation.expect("known");
            // Whole periods: the state is that of the beginning.
            let begin = load(name, &Overrides::default());
            let wrong = (body.position[0] - begin.bodies().position[0]).length();
            assert!(
                wrong <= 3.0 * wanted * 0.04 && error <= wanted * 0.04 * 3.0,
                "{name}: {wrong:e}, {error:e} stated"
            );
        }
    }
    let simulation = end("strobe_drive", &tolerance(1e-6));
    let error = simulation.card().error.expect("known").position.discretisation.expect("known");
    // `100 N / (1 kg (2 pi 60 Hz)^2)` is 0.7 mm.
    assert!(error < 1e-5, "{error:e}");
}

/// Impacts are short: velocities are compared inside them, too.
#[test]
fn velocities_of_impacts_are_within_their_tolerance() {
    let (coarse, fine) = (end("billiards3", &tolerance(1e-5)), end("billiards3", &tolerance(1e-10)));
    let stated = coarse.card().error.expect("known").velocity.discretisation.expect("known");
    let apart = coarse.bodies().velocity.iter().zip(&fine.bodies().velocity).map(|(a, b)| (*a - *b).length());
    let apart = apart.fold(0.0, f64::max);
    assert!(apart <= 3.0 * stated, "{apart:e} apart, {stated:e} stated");
}

/// The gravest cause speaks: energy that is missing, not an overlap at the start.
#[test]
fn the_gravest_cause_speaks() {
    let verdict = ran("shadow").card.verdict;
    assert!(verdict.starts_with("Do not trust it"), "{verdict}");
}

#[test]
fn without_an_estimate_places_are_not_trusted() {
    let simulation = end("verdict_energy", &Overrides::default());
    assert!(kinetic(simulation.bodies()) > 0.0);
    let verdict = simulation.card().verdict;
    assert!(!verdict.starts_with("Trust it") && verdict.contains("Do not trust places"), "{verdict}");
}

#[test]
fn a_statement_ends_where_the_comparison_ends() {
    let by_ticks = text("comet").replace("clock: (", "clock: (method: Symplectic4, tick: 0.001, ");
    let comet = run(&by_ticks, 1).unwrap_or_else(|why| panic!("{why}"));
    assert!(comet.card.verdict.starts_with("Do not trust it"), "{}", comet.card.verdict);
    let until = comet.stated().map(|(_, until)| until).unwrap_or(0.0);
    // At the time of the passage, half a period of 2 pi, nothing is known.
    assert!(until < 12.0, "{until}");
}

/// Errors greater than the motion are no errors but a horizon.
#[test]
fn no_error_is_greater_than_the_motion() {
    for overrides in [tolerance(1e-3), tolerance(1e-6), method("Reference")] {
        let card = end("absurd_estimate", &overrides).card();
        let error = card.error.expect("known").position;
        let parts = [error.discretisation, error.rounding, error.model];
        assert!(parts.iter().flatten().all(|part| *part < 10.0), "{error:?}: {}", card.verdict);
    }
}

/// Two bodies in one place attract each other without bound and without a direction: the scene is refused.
#[test]
fn attraction_of_two_bodies_in_one_place_is_refused() {
    let refused = run(&text("nanv"), 1).err().expect("refused");
    assert!(refused.contains("`p` and `q` stand in one place") && refused.contains("softening"), "{refused}");
}

/// A fall into an attraction without softening has no end: the run stops with a sentence. To look at the scene is to try nothing.
#[test]
fn steps_that_lead_nowhere_end_the_run() {
    let mut simulation = load("attr_headon_tol", &Overrides::default());
    let failure = simulation.run_to_end().expect_err("no end");
    assert!(failure.to_string().contains("steps have become too short to pass time"), "{failure}");
    let why = simulation.card().why.expect("a cause");
    assert!(why.contains("softening"), "{why}");
    assert_eq!(simulation.card().error, None);
    let read = load("head3", &Overrides { untried: true, ..Overrides::default() });
    assert_eq!(read.bodies().len(), 2);
}

/// Two bodies that pass each other at 5 nm, three times: trials that lead nowhere are given up, and the next one is finer.
#[test]
fn a_fall_past_each_other_is_followed_and_its_error_stated() {
    for wanted in [1e-3, 1e-4, 1e-5, 1e-9] {
        let simulation = end("head3", &tolerance(wanted));
        let card = simulation.card();
        let error = card.error.and_then(|error| error.position.discretisation).expect("stated");
        // Kepler's equation for the relative orbit, solved with 40 digits.
        let wrong = (simulation.bodies().position[0].x + 0.570259814982807 / 2.0).abs();
        assert!(error < 2e-3 && wrong < 3.0 * error, "{wrong:e} m wrong, {error:e} m stated\n{card}");
        let told = card.warnings.iter().any(|warning| warning.contains("is not reached"));
        assert!(told || wrong < wanted, "{wrong:e} m wrong\n{card}");
    }
}

/// A disc that lands with friction that falls as it slips keeps its drawn spring: the tick in which the collision turned had made
/// it slide without one, against the motion.
#[test]
fn a_landing_keeps_the_spring_that_slipped() {
    let text = "Scene(format: 1, clock: (duration: 0.021), gravity: (0, -9.81),
        materials: {\"m\": (stiffness: 5000, friction: (static: 1.2, dynamic: 0.6), restitution: 0.3)},
        walls: [(name: \"floor\", left: (4, 0), right: (0, 0), material: \"m\")],
        bodies: [(name: \"b\", at: (0, 0.0851), velocity: (0.6, -0.7), material: \"m\", atoms: Disc(radius: 0.085, mass: 1.05))])";
    let end = |overrides: &Overrides| {
        let mut simulation = Simulation::load_with(&Source::new("landing.ron", text), overrides, |_| {}).unwrap();
        simulation.run_to_end().unwrap();
        (simulation.bodies().position[0], simulation.bodies().velocity[0])
    };
    let exact = end(&Overrides { tick: Some(1e-4), ..method("Dop853") });
    // The turn lies anywhere within its tick: velocities differ by what all friction, at the deepest overlap, does in one.
    let strongest = 1.2 * 5000.0 * 0.00871 / 1.05;
    for tick in [1e-5, 3.3e-6, 1e-6] {
        let verlet = end(&Overrides { tick: Some(tick), ..method("VelocityVerlet") });
        let wrong = ((verlet.0 - exact.0).length(), (verlet.1 - exact.1).length());
        let bound = strongest * tick;
        assert!(wrong.0 < bound * 0.021 && wrong.1 < bound, "ticks of {tick}: off by {wrong:?}, {verlet:?}");
    }
}

/// Ticks with too many events go on by another method: two trials that both do so tell nothing of their error.
#[test]
fn overloaded_trials_reach_no_tolerance() {
    let text = "Scene(format: 1, clock: (duration: 0.2), gravity: (0, -9.81),
        contacts: Penalty(normal: Dashpot, tangential: Exact),
        materials: {\"m\": (stiffness: 20000, friction: (static: 1.2, dynamic: 0.6), restitution: 0.3)},
        walls: [(name: \"floor\", left: (4, 0), right: (0, 0), material: \"m\")],
        bodies: [(name: \"b\", at: (0, 0.25), velocity: (0.252, -3.054), spin: -8.21, material: \"m\", atoms: List([
            (at: (0, 0), radius: 0.1, mass: 0.4), (at: (0.15, 0), radius: 0.08, mass: 0.3),
            (at: (-0.15, 0), radius: 0.06, mass: 0.2)]))])";
    let run = |overrides: &Overrides| {
        let mut simulation = Simulation::load_with(&Source::new("clump.ron", text), overrides, |_| {}).unwrap();
        simulation.run_to_end().unwrap();
        simulation
    };
    let exact = run(&method("Dop853")).bodies().position[0];
    for wanted in [1e-3, 1e-4] {
        let simulation = run(&tolerance(wanted));
        let wrong = (simulation.bodies().position[0] - exact).length();
        let told = simulation.card().warnings.iter().any(|warning| warning.contains("is not reached"));
        assert!(wrong < wanted || told, "{wanted:e}: {wrong:e} m off\n{}", simulation.card());
    }
}

/// A force whose impulse is lost or wrong because it begins and ends between two ticks: whatever the estimate of the error says, the
/// run is not the scene. Its remedy gives `v = F t/m`: rounding of 4000 steps.
#[test]
fn a_force_between_two_ticks_is_not_trusted() {
    let scene = |clock: &str, force: &str| {
        format!(
            "Scene(format: 1, clock: (duration: 2{clock}), walls: [(name: \"floor\", left: (10, -5), right: (-10, -5))],
            bodies: [(name: \"b\", at: (0, 0), atoms: Disc(radius: 0.1, mass: 1))], forces: [{force}])"
        )
    };
    for (force, speed) in [
        ("Thrust(of: \"b\", force: (0, 500), from: 0.5006, to: 0.5014)", 0.4),
        ("Thrust(of: \"b\", force: (0, 2000), from: 0.50012, to: 0.50025)", 0.26),
        ("Drive(of: \"b\", force: (0, 1000), course: Piecewise([(0.5001, 0), (0.5005, 1), (0.5009, 0)]))", 0.4),
    ] {
        let verdict = run(&scene("", force), 1).unwrap().card.verdict;
        assert!(verdict.starts_with("Do not trust it: ") && verdict.contains("`forces[0]`"), "{force}: {verdict}");
        assert!(verdict.contains("Use `events: Located`"), "{verdict}");
        let mended = run(&scene(", events: Located", force), 1).unwrap();
        assert!(mended.card.verdict.starts_with("Trust it"), "{}", mended.card.verdict);
        let source = Source::new("mended.ron", scene(", events: Located", force));
        let mut simulation = Simulation::load(&source).unwrap();
        simulation.run_to_end().unwrap();
        let found = simulation.bodies().velocity[0].y;
        assert!((found - speed).abs() < 4000.0 * f64::EPSILON, "{force}: {found}");
    }
}

/// The stiffness that the verdict advises for a bullet that runs through a disc stops it within about a tenth of a radius, with the
/// tick that it names.
#[test]
fn advice_for_what_runs_through_something_stops_it() {
    let scene = |stiffness: f64, tick: f64| {
        format!(
            "Scene(format: 1, clock: (duration: 0.2, tick: {tick:?}, method: VelocityVerlet),
            materials: {{\"m\": (stiffness: {stiffness:?})}}, bodies: [
            (name: \"bullet\", at: (-5, 0.005), material: \"m\", atoms: Disc(radius: 0.01), velocity: (50, 0)),
            (name: \"w\", at: (0.123, 0), material: \"m\", atoms: Disc(radius: 0.02), fixed: true)])"
        )
    };
    let verdict = run(&scene(1000.0, 1e-6), 1).unwrap().card.verdict;
    let after = |word: &str| -> f64 {
        let rest = verdict.split_once(word).unwrap_or_else(|| panic!("{verdict}")).1;
        let number = rest.split([' ', ':']).next().unwrap();
        number.parse().unwrap_or_else(|_| panic!("{number} in {verdict}"))
    };
    let (times, tick) = (after("a `stiffness` some "), after("--tick "));
    let mut simulation = Simulation::load(&Source::new("stiff.ron", scene(1000.0 * times, tick))).unwrap();
    simulation.run_to_end().unwrap();
    let card = simulation.card();
    assert!((0.02..0.2).contains(&card.largest_overlap.share_of_radius), "{verdict}\n{card}");
    assert!(card.critical_tick.unwrap() > 10.0 * tick, "{card}");
}

/// A disc that grazes another one by less than the last digit of its place meets nothing worth a warning.
#[test]
fn a_contact_that_grazes_is_no_lack_of_digits() {
    let scene = "Scene(format: 1, clock: (duration: 1, tick: 1e-3, method: VelocityVerlet), bodies: [
        (name: \"a\", at: (0, 0), velocity: (1, 0), atoms: Disc(radius: 0.25)),
        (name: \"b\", at: (0.5, 0.4999999999999999), atoms: Disc(radius: 0.25), fixed: true)])";
    let found = run(scene, 1).unwrap();
    assert!(!found.card.verdict.contains("from the origin"), "{}", found.card.verdict);
}

/// A place behind the last body is nobody's mistake that a program should end for.
#[test]
fn an_index_without_a_body_has_no_name() {
    let scene =
        "Scene(format: 1, clock: (duration: 1), bodies: [(name: \"ball\", at: (0, 0), atoms: Disc(radius: 1))])";
    let simulation = Simulation::load(&Source::new("one", scene)).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!([0, 1, 99].map(|index| simulation.name(index)), ["ball", "", ""]);
}
