//! `report::measure` says how wrong a setting is: its errors are those against the exact answer.

use std::f64::consts::TAU;

use jostle::Simulation;
use jostle::problems::{ProblemSetting, kepler};
use jostle::report::measure::{MeasureRequest, Way, measure};
use jostle::report::work_precision::{Cost, SettingOutcome};
use jostle::scene::Source;
use jostle::simulation::Overrides;

/// Seconds: the planet passes the sun after half a turn.
const DURATION: f64 = 0.6 * TAU;
/// Moments at which `measure` compares, at most.
const MOMENTS: u64 = 100;

fn overrides(method: &str, tick: f64) -> Overrides {
    Overrides { method: Some(method.to_owned()), tick: Some(tick), ..Overrides::default() }
}

/// The error of a setting by the closed form: places over the farthest from the beginning, velocities over the fastest.
fn true_error(source: &Source, method: &str, tick: f64) -> f64 {
    let mut simulation = Simulation::load_with(source, &overrides(method, tick), |_| {}).unwrap();
    let stride = (simulation.ticks() / MOMENTS).max(1);
    let (mut far, mut fast, mut distance, mut squares) = (0.0_f64, 0.0_f64, 0.0_f64, Vec::new());
    let begin = kepler::state(0.0).0;
    for moment in 0..=simulation.ticks() / stride {
        simulation.run_to_tick(moment * stride).unwrap();
        let (place, velocity) = kepler::state(simulation.clock().time());
        (far, fast) = (far.max((place - begin).length()), fast.max(velocity.length()));
        distance = distance.max((simulation.bodies().position[1] - place).length());
        squares.push((simulation.bodies().velocity[1] - velocity).length_squared());
    }
    let mean = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    // Of the fastest moment a coarse grid sees nothing: that of `measure` is of the same hundred moments for all settings.
    let fastest = (0..=MOMENTS).map(|moment| kepler::state(DURATION * moment as f64 / MOMENTS as f64).1.length());
    let farthest =
        (0..=MOMENTS).map(|moment| (kepler::state(DURATION * moment as f64 / MOMENTS as f64).0 - begin).length());
    let (far, fast) = (farthest.fold(far, f64::max), fastest.fold(fast, f64::max));
    (distance / far).max(mean / fast)
}

/// Law: the reference errs by no more than a third of the smallest error that is claimed, so what is claimed is within 4/3 of the
/// truth; a factor of 2 leaves room for how far and how fast the body goes, of which a coarse setting sees fewer moments.
#[test]
fn measured_errors_are_those_against_the_exact_answer() {
    let source =
        Source::new("kepler.ron", kepler::scene_of(&ProblemSetting::default(), DURATION, kepler::ECCENTRICITY));
    let load = |way: Way| match way {
        Way::Plan(plan) => {
            Simulation::load_with(&source, &Overrides { plan: Some(plan.clone()), ..Overrides::default() }, |_| {})
        }
        Way::Flags(method, tick) => Simulation::load_with(&source, &overrides(method, tick), |_| {}),
    };
    let methods = ["VelocityVerlet", "RungeKutta4", "Dop853", "ImplicitMidpoint"].map(str::to_owned).to_vec();
    let order = MeasureRequest { budget: 600.0, rungs: 10, methods, cost: Cost::Evaluations };
    let measured = measure(&load, &order, &|_| {}).unwrap_or_else(|why| panic!("{why:?}"));
    let reference = measured.reference.as_ref().unwrap_or_else(|why| panic!("{why:?}"));
    assert!(reference.floor < 1e-8 && reference.until == measured.duration, "{reference:?}");
    let (mut compared, mut smallest) = (0, f64::INFINITY);
    for setting in &measured.settings.all {
        // Coarse ticks may give the planet energy out of nowhere beside the sun.
        let SettingOutcome::Measured(deviation) = setting.outcome else { continue };
        if deviation.error < reference.claim() {
            continue;
        }
        let exact = true_error(&source, setting.course.method, setting.tick);
        let ratio = deviation.error / exact;
        assert!(
            (0.5..=2.0).contains(&ratio),
            "{} {}: {} {exact}",
            setting.course.method,
            setting.tick,
            deviation.error
        );
        compared += 1;
        smallest = smallest.min(exact);
    }
    assert!(compared >= 20 && smallest < 1e-4, "{compared} {smallest}");
}
