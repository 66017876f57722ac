//! Law: a box on a rail that bears its weight slides as if the floor that it just meets were not there, with friction on the floor or
//! without. The overlap is rounding alone, and so is the force of the floor.
//!
//! The truth is a closed form. A sine and the friction of the rail give parabolas plus sines, and bisection finds where they stop.
//!
//! Tolerance: three times what the run states, 1e-12 m, and the way of a friction under the force of one unit in the last place of
//! the way, from the beginning to the end. Not tested: floors that bear a part of the weight.

use std::f64::consts::TAU;

use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::{Simulation, SimulationExt};

const STATED: f64 = 3.0;

/// A force along a rail, `force sin(2 pi frequency t + phase) + constant`, on a mass with dry friction.
struct Slide {
    mass: f64,
    force: f64,
    constant: f64,
    frequency: f64,
    phase: f64,
    friction: f64,
}

impl Slide {
    fn angle(&self, time: f64) -> f64 {
        TAU * self.frequency * time + self.phase
    }

    fn push(&self, time: f64) -> f64 {
        self.force * libm::sin(self.angle(time)) + self.constant
    }

    /// Velocity and way after a slide from rest between two times, in the direction of a sign.
    fn slid(&self, from: f64, to: f64, sign: f64) -> (f64, f64) {
        let (omega, time) = (TAU * self.frequency, to - from);
        let steady = self.constant - sign * self.friction;
        let (cosine, sine) = (libm::cos(self.angle(from)), libm::sin(self.angle(from)));
        let velocity = self.force / omega * (cosine - libm::cos(self.angle(to))) + steady * time;
        let turns = (libm::sin(self.angle(to)) - sine) / omega;
        let way = self.force / omega * (cosine * time - turns) + 0.5 * steady * time * time;
        (velocity / self.mass, way / self.mass)
    }

    /// The first moment of a grid at which a condition holds, found by bisection between two of its points.
    fn first(from: f64, end: f64, holds: impl Fn(f64) -> bool) -> f64 {
        let step = 1e-4;
        let mut high = from + step;
        while high < end && !holds(high) {
            high += step;
        }
        let (mut low, mut high) = (high - step, high.min(end));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if holds(middle) { high = middle } else { low = middle }
        }
        high
    }

    /// The way from rest at time zero up to a time.
    fn way(&self, end: f64) -> f64 {
        let (mut time, mut way) = (0.0, 0.0);
        while time < end {
            if self.push(time).abs() <= self.friction + 1e-9 {
                time = Self::first(time, end, |time| self.push(time).abs() > self.friction);
            }
            if time >= end {
                break;
            }
            let sign = self.push(time + 1e-9).signum();
            let stop = Self::first(time, end, |now| sign * self.slid(time, now, sign).0 < 0.0);
            way += self.slid(time, stop, sign).1;
            time = stop;
        }
        way
    }
}

#[test]
fn a_box_on_a_rail_slides_along_a_floor_that_it_just_meets() {
    let mut slides = Vec::new();
    for (mass, force, frequency, friction) in [(1.0, 10.0, 1.3, 1.0), (0.2, 2.5, 1.35, 0.2), (2.0, 15.0, 0.9, 3.0)] {
        for (height, incline, grip) in [(0.2, 0.0, 0.0), (0.1742, 0.0, 0.4), (0.06, 0.0, 0.9), (0.2, 0.3, 0.4)] {
            let sine = Slide { mass, force, constant: 0.0, frequency, phase: 0.3, friction };
            slides.push((sine, height, incline, grip));
        }
    }
    for (slide, height, incline, grip) in slides {
        let (across, along) = (libm::sin(incline), libm::cos(incline));
        let scene = |floor: &str| {
            format!(
                "Scene(format: 1, clock: (duration: 1.5), gravity: (0, -9.81),
                materials: {{ \"m\": (stiffness: 1e6, restitution: 0.3, friction: {grip:?}) }}, {floor}
                bodies: [(name: \"b\", at: ({:?}, {:?}), angle: {incline:?}, material: \"m\",
                          shape: Rectangle(width: 0.3, height: {height:?}, rounding: 0.002, mass: {:?}))],
                joints: [Prismatic(name: \"rail\", a: World, b: \"b\", axis: ({along:?}, {across:?}),
                                   friction: {:?})],
                forces: [Drive(of: \"b\", force: ({:?}, 0),
                               course: Sine(amplitude: 1, frequency: {:?}, phase: {:?}))])",
                -0.5 * height * across,
                0.5 * height * along,
                slide.mass,
                slide.friction,
                slide.force,
                slide.frequency,
                slide.phase,
            )
        };
        let on_rail = Slide { force: slide.force * along, constant: -9.81 * slide.mass * across, ..slide };
        let truth = on_rail.way(1.5) * along - 0.5 * height * across;
        let floor =
            format!("walls: [(name: \"floor\", left: ({along:?}, {across:?}), right: (0, 0), material: \"m\")],");
        let of = |method: &str, tick: Option<f64>| Overrides {
            method: Some(method.to_owned()),
            tick,
            ..Overrides::default()
        };
        let tolerance = |share: f64| Overrides { tolerance: Some(share), ..Overrides::default() };
        // An error that a way may state where no floor is in its way. With a tick that is given it states none.
        for (overrides, most) in [
            (of("Reference", None), 1e-8),
            (of("Dop853", Some(1e-3)), 1e-10),
            (tolerance(1e-4), 1e-3),
            (tolerance(1e-6), 1e-5),
            (tolerance(1e-9), 1e-8),
        ] {
            let text = scene(&floor);
            let mut run = Simulation::load_with(&Source::new("rail.ron", &text), &overrides, |_| {}).unwrap();
            run.run_to_end().unwrap();
            let stated = run.card().error.and_then(|error| error.position.discretisation).unwrap_or_default();
            let stated = if overrides.tick.is_some() { most } else { stated };
            // Rounding of places makes an overlap, and so friction, all the time.
            let drag = grip * 2e6 * f64::EPSILON * 1.3;
            let rounding = 1e-12 + 0.5 * drag / slide.mass * 1.5 * 1.5;
            let off = (run.bodies().position[0].x - truth).abs();
            assert!(off <= STATED * stated + rounding, "{overrides:?}: {off:e} m off, {stated:e} stated\n{text}");
            assert!(stated <= most, "{overrides:?}: {stated:e} stated, as if the floor were in the way\n{text}");
        }
    }
}
