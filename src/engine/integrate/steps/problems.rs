//! Motions with exact answers, on which the methods of this folder show their order. SI units, all scales near 1.

use std::f64::consts::TAU;

use crate::tick::Flow;

/// A motion whose state is known at all times.
#[derive(Clone, Copy)]
pub(super) struct ProblemMotion {
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
    /// Energy of a state, if the motion keeps it.
    pub(super) energy: fn(&[f64]) -> f64,
}

/// `q'' = -q`.
pub(super) const OSCILLATOR: ProblemMotion = ProblemMotion {
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

/// A planet on an ellipse about a fixed sun from its nearest point, `G M = 1`, `a = 1` (Kepler's equation by Newton).
/// It ends well behind the second passage, because over whole orbits the leading errors of both sides cancel.
pub(super) const KEPLER: ProblemMotion = ProblemMotion {
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
pub(super) const DRAG: ProblemMotion = ProblemMotion {
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

/// A driven oscillator, `q'' = -4 q + cos(3 t)`: the difference of its free motion and the forced one, `-cos(3 t)/5`.
pub(super) const DRIVEN: ProblemMotion = ProblemMotion {
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

/// A spring that hardens with a state of a model, `z' = 2 q v`, so `z = q^2`. Then `q'' = q - z q` is Duffing's
/// equation. Its motion from one side of the saddle to the other is `q = sqrt(2) sech(t - 1)`.
pub(super) const HARDENING: ProblemMotion = ProblemMotion {
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

/// A combination of damping, a force in time, and a state that lags, `z' = v - z`, and pulls. The equation is
/// `q'' = -q - v/2 - z + f(t)` with `f` such that `q = sin t`. So `z = (cos t + sin t)/2 - e^-t/2`.
pub(super) const LAGGING: ProblemMotion = ProblemMotion {
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

/// An oscillator whose spring is a state of a model, as a tangential spring of a contact: `q'' = -z`, `z' = v`.
pub(super) const ELONGATION: ProblemMotion = ProblemMotion {
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
pub(super) const MOTIONS: [ProblemMotion; 6] = [OSCILLATOR, KEPLER, DRAG, DRIVEN, HARDENING, LAGGING];

/// A motion that counts how often its rates are asked for.
pub(super) struct Counted {
    pub(super) motion: ProblemMotion,
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
