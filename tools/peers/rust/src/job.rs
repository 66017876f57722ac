//! What is asked and what is answered: one line of JSON each. `problems.py` says what a scene means.

use serde::{Deserialize, Serialize};

#[derive(Deserialize)]
pub struct Job {
    pub engine: String,
    pub settings: Settings,
    /// Length of a step in s.
    pub step: f64,
    /// Numbers of steps after which the state is told, ascending.
    pub samples: Vec<u64>,
    pub scene: Scene,
    /// Runs, of which the fastest counts.
    pub repeats: u32,
}

/// What is not given stays at the engine's default.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Box2D: substeps of a step. Rapier: `num_solver_iterations`, which are its substeps.
    pub substeps: u32,
    pub sleep: bool,
    /// Box2D: `restitutionThreshold`, m/s.
    pub restitution_threshold: Option<f64>,
    /// Frequency in Hz with which contacts push overlaps out.
    pub contact_hertz: Option<f64>,
    pub contact_damping: Option<f64>,
    /// Cap of the speed with which contacts push overlaps out, m/s.
    pub push_speed: Option<f64>,
    /// Whether contacts of pairs that hardly moved are taken over from the step before.
    pub recycling: bool,
    /// Box2D: `enableContinuous`. Rapier: `max_ccd_substeps` above 0.
    pub continuous: bool,
    /// Box2D: `enableSpeculative`.
    pub speculative: bool,
    /// Rapier: `normalized_prediction_distance`, m.
    pub prediction: Option<f64>,
    /// Rapier: `num_internal_pgs_iterations`.
    pub iterations: Option<u32>,
    pub warm_start: bool,
    /// The spring as a joint of the engine, or as a force that the caller applies before each step.
    pub spring_joint: bool,
    /// The same of servos: a spring of the joint, or a torque of the caller.
    pub servo_joint: bool,
    /// Rapier: hinges in reduced coordinates. A hinge that closes a loop stays an impulse joint.
    pub multibody: bool,
    /// Box2D: `constraintHertz` of hinges.
    pub joint_hertz: Option<f64>,
    /// Box2D: `constraintDampingRatio` of hinges. Rapier: damping of hinges in reduced coordinates, N m s/rad; it has some of its own.
    pub joint_damping: Option<f64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            substeps: 4,
            sleep: true,
            restitution_threshold: None,
            contact_hertz: None,
            contact_damping: None,
            push_speed: None,
            recycling: true,
            continuous: true,
            speculative: true,
            prediction: None,
            iterations: None,
            warm_start: true,
            spring_joint: true,
            servo_joint: true,
            multibody: false,
            joint_hertz: None,
            joint_damping: None,
        }
    }
}

#[derive(Deserialize)]
pub struct Scene {
    pub bodies: Vec<Disc>,
    pub gravity: [f64; 2],
    pub material: Material,
    pub floor: bool,
    /// The width in m of a box with a floor and two high walls, from x = 0 on.
    #[serde(default)]
    pub width: Option<f64>,
    pub drag: f64,
    pub spring: Option<f64>,
    pub joints: Vec<Joint>,
}

/// A hinge. Anchors count from the centres of bodies; without `a` it holds a place of the world.
#[derive(Deserialize)]
pub struct Joint {
    pub a: Option<usize>,
    pub anchor_a: [f64; 2],
    pub b: usize,
    pub anchor_b: [f64; 2],
    pub servo: Option<Servo>,
}

/// The torque `kp (target - angle) - kd rate` on `b`, the opposite on `a`; the angle is that of `b` less that of `a`.
#[derive(Clone, Copy, Deserialize)]
pub struct Servo {
    pub target: f64,
    pub kp: f64,
    pub kd: f64,
}

#[derive(Deserialize)]
pub struct Disc {
    pub at: [f64; 2],
    pub velocity: [f64; 2],
    pub spin: f64,
    pub radius: f64,
    pub mass: f64,
    pub turns: bool,
    pub angle: f64,
    /// None: that of a disc.
    pub inertia: Option<f64>,
}

impl Disc {
    pub fn inertia(&self) -> f64 {
        self.inertia.unwrap_or(self.mass * self.radius * self.radius / 2.0)
    }
}

#[derive(Deserialize)]
pub struct Material {
    pub friction: f64,
    pub restitution: f64,
}

/// x, y, angle, vx, vy, spin.
pub type State = [f64; 6];

#[derive(Default, Serialize)]
pub struct Answer {
    /// At each sample, of each body.
    pub states: Vec<Vec<State>>,
    /// CPU time of the steps in s, of the fastest run.
    pub seconds: f64,
    /// Why there are no states.
    pub failed: Option<String>,
}

/// A world of an engine, ready to step.
pub trait World {
    fn step(&mut self);
    /// Adds to the angles what the discs turned since it was last called: less than half a turn.
    fn follow(&mut self);
    fn states(&self) -> Vec<State>;
}

/// CPU time of this thread in s.
fn clock() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is to a timespec of our own.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Makes the world anew for each repeat; only its steps are timed.
pub fn run<W: World>(job: &Job, make: impl Fn() -> W) -> Answer {
    let mut answer = Answer { seconds: f64::INFINITY, ..Answer::default() };
    // Often enough for 100 rad/s, and otherwise not: it is no part of the engines.
    let follow_every = ((0.01 / job.step) as u64).max(1);
    for _ in 0..job.repeats {
        let mut world = make();
        let mut states = Vec::new();
        let (mut done, mut seconds) = (0, 0.0);
        for &sample in &job.samples {
            let start = clock();
            while done < sample {
                let next = sample.min(done + follow_every);
                for _ in done..next {
                    world.step();
                }
                world.follow();
                done = next;
            }
            seconds += clock() - start;
            states.push(world.states());
        }
        answer.seconds = answer.seconds.min(seconds);
        answer.states = states;
    }
    if answer.states.iter().flatten().flatten().any(|number| !number.is_finite()) {
        answer.states.clear();
        answer.failed = Some("numbers stopped being finite".into());
    }
    answer
}
