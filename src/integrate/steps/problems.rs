//! Motions with exact answers, on which the methods of this folder show their order. SI units, all scales near 1.

use std::f64::consts::TAU;

use super::{Flow, OneStep, Start};

/// A motion whose state is known at all times.
#[derive(Clone, Copy)]
pub(super) struct Motion {
    pub(super) name: &'static str,
    pub(super) coordinates: usize,
    pub(super) dimension: usize,
    pub(super) velocity_dependent: bool,
    /// Seconds over which the error is taken.
    pub(super) duration: f64,
    /// Steps over the duration at which a method of order 4 is well inside its asymptotic range.
    pub(super) steps: f64,
    pub(super) rates: fn(f64, &[f64], &mut [f64]),
    pub(super) exact: fn(f64) -> Vec<f64>,
    /// Energy of a state, where it is kept.
    pub(super) energy: fn(&[f64]) -> f64,
}

/// `q'' = -q`.
pub(super) const OSCILLATOR: Motion = Motion {
    name: "oscillator",
    coordinates: 1,
    dimension: 2,
    velocity_dependent: false,
    duration: 7.0,
    steps: 40.0,
    rates: |_, state, rates| {
        rates[0] = state[1];
        rates[1] = -state[0];
    },
    exact: |time| {
        let (sin, cos) = libm::sincos(time);
        vec![cos, -sin]
    },
    energy: |state| 0.5 * (state[0] * state[0] + state[1] * state[1]),
};

/// Eccentricity of [`KEPLER`].
const ECCENTRICITY: f64 = 0.6;

/// A planet on an ellipse about a fixed sun from its nearest point, `G M = 1`, `a = 1` (Kepler's equation by Newton). It
/// ends well behind the second passage: over whole orbits the leading errors of one side cancel those of the other.
pub(super) const KEPLER: Motion = Motion {
    name: "kepler",
    coordinates: 2,
    dimension: 4,
    velocity_dependent: false,
    duration: 1.3 * TAU,
    steps: 520.0,
    rates: |_, state, rates| {
        let square = state[0] * state[0] + state[1] * state[1];
        let cube = square * square.sqrt();
        rates[..2].copy_from_slice(&state[2..]);
        rates[2] = -state[0] / cube;
        rates[3] = -state[1] / cube;
    },
    exact: |time| {
        let mut eccentric = time + ECCENTRICITY * libm::sin(time);
        for _ in 0..20 {
            let (sin, cos) = libm::sincos(eccentric);
            eccentric -= (eccentric - ECCENTRICITY * sin - time) / (1.0 - ECCENTRICITY * cos);
        }
        let (sin, cos) = libm::sincos(eccentric);
        let minor = (1.0 - ECCENTRICITY * ECCENTRICITY).sqrt();
        let rate = 1.0 / (1.0 - ECCENTRICITY * cos);
        vec![cos - ECCENTRICITY, minor * sin, -sin * rate, minor * cos * rate]
    },
    energy: |state| {
        let square = state[0] * state[0] + state[1] * state[1];
        0.5 * (state[2] * state[2] + state[3] * state[3]) - 1.0 / square.sqrt()
    },
};

/// A fall with quadratic drag, `q'' = 1 - v |v|`, from a tenth of the terminal velocity: `v = tanh(t + c)`.
pub(super) const DRAG: Motion = Motion {
    name: "quadratic drag",
    coordinates: 1,
    dimension: 2,
    velocity_dependent: true,
    duration: 2.0,
    steps: 18.0,
    rates: |_, state, rates| {
        rates[0] = state[1];
        rates[1] = 1.0 - state[1] * state[1].abs();
    },
    exact: |time| {
        let begun = libm::atanh(0.1);
        vec![libm::log(libm::cosh(time + begun) / libm::cosh(begun)), libm::tanh(time + begun)]
    },
    energy: |_| f64::NAN,
};

/// A driven oscillator, `q'' = -4 q + cos(3 t)`: the difference of its own motion and the forced one, `-cos(3 t)/5`.
pub(super) const DRIVEN: Motion = Motion {
    name: "driven oscillator",
    coordinates: 1,
    dimension: 2,
    velocity_dependent: false,
    duration: 5.0,
    steps: 60.0,
    rates: |time, state, rates| {
        rates[0] = state[1];
        rates[1] = libm::cos(3.0 * time) - 4.0 * state[0];
    },
    exact: |time| {
        let ((sin, cos), (forced_sin, forced_cos)) = (libm::sincos(2.0 * time), libm::sincos(3.0 * time));
        vec![0.3 * sin + 1.2 * cos - 0.2 * forced_cos, 0.6 * cos - 2.4 * sin + 0.6 * forced_sin]
    },
    energy: |_| f64::NAN,
};

/// A spring that hardens with a state of its own, `z' = 2 q v`, so `z = q^2`: `q'' = q - z q` is Duffing's equation, and
/// `q = sqrt(2) sech(t - 1)` its motion from one side of the saddle to the other.
pub(super) const HARDENING: Motion = Motion {
    name: "hardening spring",
    coordinates: 1,
    dimension: 3,
    velocity_dependent: false,
    duration: 2.0,
    steps: 20.0,
    rates: |_, state, rates| {
        rates[0] = state[1];
        rates[1] = state[0] - state[2] * state[0];
        rates[2] = 2.0 * state[0] * state[1];
    },
    exact: |time| {
        let place = std::f64::consts::SQRT_2 / libm::cosh(time - 1.0);
        vec![place, -place * libm::tanh(time - 1.0), place * place]
    },
    energy: |state| 0.5 * (state[1] * state[1] - state[0] * state[0]) + 0.25 * state[2] * state[2],
};

/// Everything at once: damping, a force in time, and a state that lags, `z' = v - z`, and pulls: `q'' = -q - v/2 - z + f(t)`
/// with `f` such that `q = sin t`, and so `z = (cos t + sin t)/2 - e^-t/2`.
pub(super) const LAGGING: Motion = Motion {
    name: "damped and lagging",
    coordinates: 1,
    dimension: 3,
    velocity_dependent: true,
    duration: 3.0,
    steps: 24.0,
    rates: |time, state, rates| {
        let exact = (LAGGING.exact)(time);
        rates[0] = state[1];
        rates[1] = (0.5 * exact[1] + exact[2]) - state[0] - 0.5 * state[1] - state[2];
        rates[2] = state[1] - state[2];
    },
    exact: |time| {
        let (sin, cos) = libm::sincos(time);
        vec![sin, cos, 0.5 * (cos + sin - libm::exp(-time))]
    },
    energy: |_| f64::NAN,
};

/// An oscillator whose spring is a state of its own, as a tangential spring of a contact: `q'' = -z`, `z' = v`.
pub(super) const ELONGATION: Motion = Motion {
    name: "spring with a state",
    coordinates: 1,
    dimension: 3,
    velocity_dependent: false,
    duration: TAU,
    steps: 40.0,
    rates: |_, state, rates| {
        rates[0] = state[1];
        rates[1] = -state[2];
        rates[2] = state[1];
    },
    exact: |time| {
        let (sin, cos) = libm::sincos(time);
        vec![cos, -sin, cos]
    },
    energy: |state| 0.5 * (state[1] * state[1] + state[2] * state[2]),
};

/// Those that show orders.
pub(super) const MOTIONS: [Motion; 6] = [OSCILLATOR, KEPLER, DRAG, DRIVEN, HARDENING, LAGGING];

/// A motion that counts how often its rates are asked for.
pub(super) struct Counted {
    pub(super) motion: Motion,
    pub(super) evaluations: usize,
}

impl Flow for Counted {
    fn coordinates(&self) -> usize {
        self.motion.coordinates
    }

    fn dimension(&self) -> usize {
        self.motion.dimension
    }

    fn velocity_dependent(&self) -> bool {
        self.motion.velocity_dependent
    }

    fn rates(&mut self, time: f64, state: &[f64], rates: &mut [f64]) {
        self.evaluations += 1;
        (self.motion.rates)(time, state, rates);
    }
}

/// A run with equal steps. Changes are added with compensation (Kahan 1965), so that rounding does not grow with their
/// number.
pub(super) struct Run {
    pub(super) flow: Counted,
    pub(super) time: f64,
    pub(super) state: Vec<f64>,
    lost: Vec<f64>,
    lost_time: f64,
    rates: Vec<f64>,
    change: Vec<f64>,
}

impl Run {
    /// At the beginning of a motion.
    pub(super) fn of(motion: Motion) -> Self {
        Self::at(motion, 0.0)
    }

    /// At some time of a motion.
    pub(super) fn at(motion: Motion, time: f64) -> Self {
        Self::from(motion, time, (motion.exact)(time))
    }

    /// From another time and state.
    pub(super) fn from(motion: Motion, time: f64, state: Vec<f64>) -> Self {
        let zero = vec![0.0; state.len()];
        let flow = Counted { motion, evaluations: 0 };
        Self { flow, time, state, lost: zero.clone(), lost_time: 0.0, rates: zero.clone(), change: zero }
    }

    /// One step. The rates at its beginning are taken here and not counted.
    pub(super) fn step(&mut self, method: &mut dyn OneStep, length: f64) {
        (self.flow.motion.rates)(self.time, &self.state, &mut self.rates);
        let start = Start { time: self.time, state: &self.state, rates: &self.rates };
        method.step(&mut self.flow, start, length, &mut self.change);
        for ((state, lost), change) in self.state.iter_mut().zip(&mut self.lost).zip(&self.change) {
            add(state, lost, *change);
        }
        add(&mut self.time, &mut self.lost_time, length);
    }

    /// Largest difference of a number of the state from the exact motion.
    pub(super) fn error(&self) -> f64 {
        distance(&self.state, &(self.flow.motion.exact)(self.time))
    }
}

/// Adds with compensation.
fn add(sum: &mut f64, lost: &mut f64, change: f64) {
    let change = change + *lost;
    let next = *sum + change;
    *lost = change - (next - *sum);
    *sum = next;
}

/// Largest difference of two numbers at the same place.
pub(super) fn distance(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).fold(0.0, |most, (left, right)| (left - right).abs().max(most))
}

/// Slope of a straight line through points, by least squares.
pub(super) fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let (mut above, mut below) = (0.0, 0.0);
    for point in points {
        above += (point.0 - x) * (point.1 - y);
        below += (point.0 - x) * (point.0 - x);
    }
    above / below
}

/// Measured order of a method on a motion: slope of the logarithm of the error, its root of the mean square over all steps,
/// over that of the length, from six lengths. `fineness` is how many times the steps of a method of order 4 are taken at
/// first, `ratio` that of steps from then on.
fn measured_order(method: &mut dyn OneStep, motion: Motion, fineness: f64, ratio: f64) -> f64 {
    let points: Vec<_> = (0..6)
        .map(|number| {
            let steps = (motion.steps * fineness * libm::pow(ratio, f64::from(number))).round();
            let length = motion.duration / steps;
            let mut run = Run::of(motion);
            let mut squares = 0.0;
            for _ in 0..steps as usize {
                run.step(method, length);
                squares += run.error() * run.error();
            }
            (libm::log(length), 0.5 * libm::log(squares / steps))
        })
        .collect();
    slope(&points)
}

/// Demands the order of a method on all motions, to a quarter.
pub(super) fn demand_order(method: &mut dyn OneStep, order: u32, fineness: f64, ratio: f64) {
    for motion in MOTIONS {
        let measured = measured_order(method, motion, fineness, ratio);
        let off = (measured - f64::from(order)).abs();
        assert!(off <= 0.25, "{}: order {measured:.3} instead of {order}", motion.name);
    }
}

/// Demands that energy swings in the last hundred of 10 000 periods of 2 pi as far as in the first hundred, to a tenth: the
/// phases at which a hundred periods are sampled differ by less. A drift, even one that is not seen in the first hundred,
/// would make it a hundred times as far.
pub(super) fn demand_bounded_energy(method: &mut dyn OneStep, motion: Motion, steps_per_period: f64) {
    let length = TAU / steps_per_period;
    let mut run = Run::of(motion);
    let beginning = (motion.energy)(&run.state);
    let hundred = (100.0 * steps_per_period) as usize;
    let (mut first, mut last) = (0.0_f64, 0.0_f64);
    for number in 0..100 * hundred {
        run.step(method, length);
        let off = ((motion.energy)(&run.state) - beginning).abs();
        if number < hundred {
            first = first.max(off);
        } else if number >= 99 * hundred {
            last = last.max(off);
        }
    }
    assert!(first > 0.0 && last <= 1.1 * first, "{}: energy is off by {first:e}, later {last:e}", motion.name);
}

/// Demands that as many steps backwards return to the start, to eight roundings for each step times the condition number
/// of the way back (measured: how much larger a small displacement becomes on it).
pub(super) fn demand_reversible(method: &mut dyn OneStep, fineness: f64) {
    for motion in MOTIONS {
        let steps = (motion.steps * fineness).round();
        let length = motion.duration / steps;
        let mut run = Run::of(motion);
        for _ in 0..steps as usize {
            run.step(method, length);
        }
        let displacement = 1e-6;
        let mut displaced = Run::from(motion, run.time, run.state.iter().map(|number| number + displacement).collect());
        for _ in 0..steps as usize {
            run.step(method, -length);
            displaced.step(method, -length);
        }
        let condition = (distance(&displaced.state, &run.state) / displacement).max(1.0);
        let off = distance(&run.state, &(motion.exact)(0.0));
        let allowed = 16.0 * steps * f64::EPSILON * condition;
        assert!(off <= allowed, "{}: {off:e} off after the way back, {allowed:e} would be rounding", motion.name);
    }
}
