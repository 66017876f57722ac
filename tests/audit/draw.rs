//! Random impacts of a disc on a wall, for the engine and for the reference solution.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::impact::{Disc, Impact, Normal, Rolling, Tangential};

/// Seeded random numbers, the same on every machine.
pub struct Draw(ChaCha8Rng);

impl Draw {
    /// The scene of number `seed`.
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Evenly between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// Evenly between the logarithms of two numbers.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.between(libm::log(low), libm::log(high)))
    }

    /// True in this share of all draws.
    pub fn happens(&mut self, share: f64) -> bool {
        self.between(0.0, 1.0) < share
    }
}

/// An impact, and the words of its laws in a scene.
#[derive(Clone, Debug)]
pub struct Drawn {
    pub impact: Impact,
}

/// A single oblique impact with any of the laws.
pub fn impact(seed: u64) -> Drawn {
    let mut draw = Draw::new(seed);
    let radius = draw.scale(0.03, 0.3);
    let mass = draw.scale(0.1, 3.0);
    let inertia = 0.5 * mass * radius * radius * if draw.happens(0.3) { draw.scale(0.4, 2.5) } else { 1.0 };
    let stiffness = draw.scale(3e3, 3e6);
    let inelasticity = if draw.happens(0.15) { 0.0 } else { draw.between(0.02, 0.9) };
    let normal = match draw.happens(0.35) {
        true => Normal::Dashpot(draw.scale(0.02, 1.2) * (stiffness * mass).sqrt()),
        false => Normal::Inelasticity(inelasticity),
    };
    let tangential = match draw.between(0.0, 1.0) {
        share if share < 0.1 => Tangential::None,
        share if share < 0.25 => Tangential::Exact,
        share if share < 0.7 => Tangential::Spring(0.8),
        _ => Tangential::Spring(draw.scale(0.2, 1.5)),
    };
    let rolling: Rolling = draw.happens(0.3).then(|| (draw.scale(0.01, 0.5), draw.scale(0.2, 1.0)));
    let dynamic = draw.scale(0.03, 1.2);
    let fixed = if draw.happens(0.5) { dynamic } else { dynamic * draw.between(1.0, 2.0) };
    let gravity = match draw.between(0.0, 1.0) {
        share if share < 0.4 => (0.0, 0.0),
        share if share < 0.7 => (0.0, -9.81),
        _ => (draw.between(-5.0, 5.0), draw.between(-12.0, -3.0)),
    };
    let belt = if draw.happens(0.25) { draw.between(-3.0, 3.0) } else { 0.0 };
    let down = draw.scale(0.1, 5.0);
    let omega = (stiffness / mass).sqrt();
    let height = radius + draw.between(0.01, 0.4) * down.max(0.3) * 0.1;
    let begin = Disc {
        y: height,
        vx: draw.between(-1.0, 1.0) * draw.scale(0.05, 6.0),
        vy: -down,
        spin: draw.between(-1.0, 1.0) * draw.scale(0.05, 6.0) / radius,
        ..Disc::default()
    };
    let duration = 1.2 * (height - radius) / down + draw.between(0.9, 4.0) * std::f64::consts::PI / omega;
    let impact = Impact {
        radius,
        mass,
        inertia,
        stiffness,
        normal,
        tangential,
        rolling,
        friction: (fixed, dynamic),
        gravity,
        belt,
        begin,
        duration,
    };
    Drawn { impact }
}

impl Drawn {
    /// The scene, with a clock of its own.
    pub fn scene(&self, clock: &str) -> String {
        let Impact {
            radius,
            mass,
            inertia,
            stiffness,
            friction: (fixed, moving),
            gravity: (gx, gy),
            belt,
            begin,
            duration,
            ..
        } = self.impact;
        let Disc { x, y, vx, vy, spin, .. } = begin;
        let normal = match self.impact.normal {
            Normal::Inelasticity(_) => "Inelasticity".to_owned(),
            Normal::Dashpot(damping) => format!("Dashpot, damping: {damping:?}"),
        };
        let tangential = match self.impact.tangential {
            Tangential::None => "None".to_owned(),
            Tangential::Exact => "Exact".to_owned(),
            Tangential::Spring(ratio) => format!("Spring(ratio: {ratio:?})"),
        };
        let rolling = match self.impact.rolling {
            None => "None".to_owned(),
            Some((friction, ratio)) => format!("Spring(friction: {friction:?}, ratio: {ratio:?})"),
        };
        let loss = match self.impact.normal {
            Normal::Inelasticity(mu) => format!(", inelasticity: {mu:?}"),
            Normal::Dashpot(_) => String::new(),
        };
        format!(
            "Scene(format: 1, clock: (duration: {duration:?}{clock}), gravity: ({gx:?}, {gy:?}),
            contacts: Penalty(normal: {normal}, tangential: {tangential}, rolling: {rolling}),
            materials: {{ \"m\": (stiffness: {stiffness:?}, friction: (static: {fixed:?}, dynamic: {moving:?}){loss}) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\", surface_velocity: ({belt:?}, 0))],
            bodies: [(name: \"b\", at: ({x:?}, {y:?}), velocity: ({vx:?}, {vy:?}), spin: {spin:?}, material: \"m\",
                      inertia: {inertia:?}, atoms: Disc(radius: {radius:?}, mass: {mass:?}))],
            sensors: [Pose(of: \"b\")])"
        )
    }
}
