//! Tests of the coefficients, of the motion, and of the error estimate.

use super::super::problems::{MOTIONS, ProblemMotion};
use super::super::rooted_trees::Trees;
use super::super::trials::{TrialRun, demand_order, distance, slope};
use super::*;

/// A sum as a list of the weights of all stages.
fn row(sum: Sum) -> Vec<f64> {
    let mut row = vec![0.0; ALL_STAGES];
    for &(stage, weight) in sum {
        row[stage] = weight;
    }
    row
}

fn trees(order: usize) -> Trees {
    let stages = STEP.iter().chain(&DENSE).map(|stage| row(stage.weights));
    let rows: Vec<_> = std::iter::once(row(&[])).chain(stages).collect();
    Trees::new(&rows, order)
}

/// Law: the weights of a stage sum to its node, and name only stages before it. Tolerance: rounding.
#[test]
fn rows_sum_to_nodes() {
    for (number, stage) in (1..).zip(STEP.iter().chain(&DENSE)) {
        let sum: f64 = stage.weights.iter().map(|(_, weight)| weight).sum();
        let size: f64 = stage.weights.iter().map(|(_, weight)| weight.abs()).sum();
        assert!((sum - stage.node).abs() <= 8.0 * f64::EPSILON * size, "stage {number}: {sum}");
        assert!(stage.weights.iter().all(|&(other, _)| other < number), "stage {number}");
    }
}

/// Law: conditions of order of all 200 trees to order 8, and not of all the 286 of order 9. Tolerance: rounding.
#[test]
fn the_result_has_order_8() {
    let trees = trees(9);
    assert_eq!(trees.count(), 486);
    assert_eq!(trees.order(&row(RESULT), |_| 1.0), 8);
}

/// Law: the estimates are differences of the result from others, of order 5 and of order 3. Tolerance: rounding.
#[test]
fn estimates_have_orders_5_and_3() {
    let trees = trees(8);
    assert_eq!(trees.order(&row(ERROR_5), |_| 0.0), 5);
    assert_eq!(trees.order(&row(RESULT_3), |_| 1.0), 3);
}

/// Law: the dense output satisfies the conditions of order 7 with its weights for the rates of the stages. They stand
/// in section II.6 of the source. At the ends it equals the beginning and the result. Tolerance: rounding.
#[test]
fn the_dense_output_has_order_7() {
    let trees = trees(8);
    // As many numbers as stages, each with a rate in its own stage only: their changes are the weights.
    let mut method = Dop853 { length: 1.0, state: vec![0.0; ALL_STAGES], ..Dop853::default() };
    method.rates = vec![0.0; ALL_STAGES * ALL_STAGES];
    for stage in 0..ALL_STAGES {
        method.rates[stage * ALL_STAGES + stage] = 1.0;
    }
    method.interpolate();
    let mut weights = vec![0.0; ALL_STAGES];
    for share in [0.05, 0.3, 0.5, 0.77, 0.95] {
        method.dense(share, &mut weights);
        assert_eq!(trees.order(&weights, |order| libm::pow(share, f64::from(order))), 7, "{share}");
    }
    method.dense(1.0, &mut weights);
    assert_eq!(weights, row(RESULT));
    method.dense(0.0, &mut weights);
    assert_eq!(weights, row(&[]));
}

/// Law: order 8 on smooth motion (section II.5 of the source). Tolerance: a quarter of an order.
#[test]
fn the_order_is_8() {
    demand_order(&mut Dop853::default(), 8, 0.6, 1.15);
}

/// Law: with dense output of order 7 the error inside a step falls with the eighth power of its length. So does the
/// estimate. Tolerance: a quarter of an order.
#[test]
fn errors_inside_and_estimates_fall_with_the_eighth_power() {
    for motion in MOTIONS {
        let points = |error: fn(&mut TrialRun, f64) -> f64, longest: f64| -> Vec<_> {
            let longest = longest * motion.duration / motion.steps;
            let lengths = (0..6).map(|number| longest / libm::pow(1.15, f64::from(number)));
            lengths.map(|length| (libm::log(length), libm::log(mean_error(motion, |run| error(run, length))))).collect()
        };
        for (what, points) in [("inside", points(error_inside, 2.5)), ("estimate", points(estimate, 0.8))] {
            let measured = slope(&points);
            assert!((measured - 8.0).abs() <= 0.25, "{}, {what}: {measured}", motion.name);
        }
    }
}

/// The mean estimate over 16 starts equals the error to a factor of 30 both ways, from 1e-6 to 1e-10. A method that
/// chooses its steps by it errs by less than a factor of 1.53 in their length. Not tested: single steps at which the
/// estimate happens to pass through zero.
#[test]
fn the_estimate_is_realistic() {
    for motion in MOTIONS {
        for allowed in [1e-6, 1e-8, 1e-10] {
            let error = mean_error(motion, |run| {
                let (time, state) = (run.time, run.state.clone());
                let mut length = motion.duration / motion.steps;
                // The length at which the estimate reaches the allowance: it is a power of the length.
                for _ in 0..40 {
                    *run = TrialRun::from(motion, time, state.clone());
                    length *= libm::pow(allowed / estimate(run, length).max(1e-8 * allowed), 1.0 / 8.0);
                }
                *run = TrialRun::from(motion, time, state);
                run.step(&mut Dop853::default(), length);
                run.error()
            });
            assert!((1.0 / 30.0..30.0).contains(&(error / allowed)), "{}: {error:e} for {allowed:e}", motion.name);
        }
    }
}

/// The estimate is in units of the allowance, and numbers without a bound do not count.
#[test]
fn the_estimate_looks_at_bounded_numbers_only() {
    let mut run = TrialRun::of(MOTIONS[0]);
    let mut method = Dop853::default();
    run.step(&mut method, 0.5);
    let of = |scale: [f64; 2]| method.error(&scale).unwrap();
    assert!(of([1.0, 1.0]) > 0.0);
    assert_eq!(of([0.5, 0.5]), 2.0 * of([1.0, 1.0]));
    assert_eq!(of([f64::INFINITY; 2]), 0.0);
    let (place, velocity) = (of([1.0, f64::INFINITY]), of([f64::INFINITY, 1.0]));
    let both = of([1.0, 1.0]);
    assert!(both >= place.min(velocity) && both <= place.max(velocity), "{both} of {place} and {velocity}");
    assert_eq!(run.flow.evaluations, 11);
}

/// The largest error inside a step, at nine places.
fn error_inside(run: &mut TrialRun, length: f64) -> f64 {
    let (motion, state, time) = (run.flow.motion, run.state.clone(), run.time);
    let (mut rates, mut change) = (vec![0.0; state.len()], vec![0.0; state.len()]);
    (motion.rates)(time, &state, &mut rates);
    let start = Start { time, state: &state, rates: &rates };
    let mut method = Dop853::default();
    method.step(&mut run.flow, start, length, &mut change);
    method.make_dense(&mut run.flow, start, length);
    (1..10).fold(0.0_f64, |most, tenth| {
        let share = f64::from(tenth) / 10.0;
        method.dense(share, &mut change);
        let inside: Vec<f64> = state.iter().zip(&change).map(|(state, change)| state + change).collect();
        most.max(distance(&inside, &(motion.exact)(time + share * length)))
    })
}

/// The estimated error of a step.
fn estimate(run: &mut TrialRun, length: f64) -> f64 {
    let mut method = Dop853::default();
    run.step(&mut method, length);
    method.error(&vec![1.0; run.state.len()]).unwrap()
}

/// Root of the mean square of an error over starts at 16 times of a motion.
fn mean_error(motion: ProblemMotion, mut error: impl FnMut(&mut TrialRun) -> f64) -> f64 {
    let squares = (0..16).map(|phase| {
        let error = error(&mut TrialRun::at(motion, motion.duration * (f64::from(phase) + 0.31) / 16.0));
        error * error
    });
    (squares.sum::<f64>() / 16.0).sqrt()
}
