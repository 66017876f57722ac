//! The two ends of a joint, and the directions along which it holds them.
//!
//! Velocities and accelerations of points of bodies: `v = V + w x r`, `a = A + w' x r - w^2 r` (Goldstein, Classical
//! Mechanics, section 4.9). The part of the accelerations that does not depend on forces is the inertial term of a row.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec2;

use crate::constraints::{Row, RowKind, RowSide};
use crate::tick::State;
use crate::world::Bodies;

/// Two ends as they are given, found again when bodies come or go.
#[derive(Clone, Debug)]
pub struct JointEnds {
    /// Keys of the bodies; `None`: the world.
    pub keys: [Option<u64>; 2],
    /// In the frame of the body from its centre of mass; in the world for the world. In metres.
    pub anchors: [DVec2; 2],
    generation: u64,
    indices: Option<[Option<usize>; 2]>,
    /// A flag that all copies of these ends share: a broken joint has no ends.
    severed: Arc<AtomicBool>,
}

/// An end in the present state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointEnd {
    /// The index of its body; `None`: the world.
    pub body: Option<usize>,
    /// From the centre of mass of the body to the anchor, in metres.
    pub arm: DVec2,
    /// The anchor, in metres.
    pub position: DVec2,
    /// Its velocity in m/s.
    pub velocity: DVec2,
    /// Angle of the body in rad, cosine and sine of it, and spin in rad/s.
    pub angle: f64,
    /// The first axis of the body's frame.
    pub axis: DVec2,
    /// Spin of the body in rad/s.
    pub spin: f64,
    /// Acceleration of the centre in m/s2 and rate of the spin in rad/s2, where these are prescribed.
    pub prescribed: (DVec2, f64),
}

impl JointEnd {
    fn of(body: Option<usize>, anchor: DVec2, bodies: &Bodies) -> Self {
        let Some(body) = body else { return Self { position: anchor, axis: DVec2::X, ..Self::default() } };
        let (angle, spin) = (bodies.angle[body], bodies.spin[body]);
        let (sin, cos) = libm::sincos(angle);
        let axis = DVec2::new(cos, sin);
        let arm = axis.rotate(anchor);
        let prescribed = match bodies.dynamic[body] {
            true => Default::default(),
            false => bodies.prescribed.acceleration(body),
        };
        Self {
            body: Some(body),
            arm,
            position: bodies.position[body] + arm,
            velocity: bodies.velocity_at(body, arm),
            angle,
            axis,
            spin,
            prescribed,
        }
    }
}

impl JointEnds {
    /// Ends at anchors of bodies with these keys, `None` for the world.
    pub fn new(keys: [Option<u64>; 2], anchors: [DVec2; 2]) -> Self {
        Self { keys, anchors, generation: 0, indices: None, severed: Arc::default() }
    }

    /// Looks the bodies up again if some have come or gone.
    pub fn refresh(&mut self, bodies: &Bodies) {
        if self.generation != bodies.generation {
            (self.generation, self.indices) = (bodies.generation, self.look_up(bodies));
        }
    }

    fn look_up(&self, bodies: &Bodies) -> Option<[Option<usize>; 2]> {
        let index = |key: Option<u64>| match key {
            Some(key) => bodies.key.find(key).map(Some),
            None => Some(None),
        };
        Some([index(self.keys[0])?, index(self.keys[1])?])
    }

    /// If `severed`, these ends and all copies of them lose their effect.
    pub fn sever(&self, severed: bool) {
        self.severed.store(severed, Ordering::Relaxed);
    }

    /// Whether the joint has broken.
    pub fn is_severed(&self) -> bool {
        self.severed.load(Ordering::Relaxed)
    }

    /// Both ends in the present state; `None` if one of the bodies is gone or the joint has broken.
    pub fn pair(&self, bodies: &Bodies) -> Option<EndPair> {
        if self.is_severed() {
            return None;
        }
        let [a, b] = if self.generation == bodies.generation { self.indices } else { self.look_up(bodies) }?;
        Some(EndPair { a: JointEnd::of(a, self.anchors[0], bodies), b: JointEnd::of(b, self.anchors[1], bodies) })
    }
}

/// Both ends in the present state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndPair {
    /// End A.
    pub a: JointEnd,
    /// End B.
    pub b: JointEnd,
}

/// A direction of relative motion: how its rate depends on the velocity and the spin of each body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Along {
    /// Direction and lever of each side.
    pub sides: [(DVec2, f64); 2],
    /// The part of the relative acceleration that comes from velocities and prescribed motions.
    pub inertial: f64,
}

impl EndPair {
    /// From anchor A to anchor B in metres.
    pub fn between(&self) -> DVec2 {
        self.b.position - self.a.position
    }

    /// The velocity of anchor B relative to anchor A in m/s.
    pub fn parting(&self) -> DVec2 {
        self.b.velocity - self.a.velocity
    }

    /// The size of the numbers from which gaps are found, in metres.
    pub fn size(&self) -> f64 {
        let of = |end: &JointEnd| end.position.abs().max_element() + end.arm.abs().max_element();
        of(&self.a) + of(&self.b) + f64::MIN_POSITIVE
    }

    /// Anchor B relative to anchor A along a direction that does not turn.
    pub fn point(&self, direction: DVec2) -> Along {
        let centripetal = self.a.arm * self.a.spin.powi(2) - self.b.arm * self.b.spin.powi(2);
        let sides = [(-direction, -self.a.arm.perp_dot(direction)), (direction, self.b.arm.perp_dot(direction))];
        self.with_prescribed(Along { sides, inertial: centripetal.dot(direction) })
    }

    /// Anchor B relative to anchor A along a direction that turns with body A.
    pub fn across(&self, direction: DVec2) -> Along {
        let (between, spin) = (self.between(), self.a.spin);
        let Along { sides: [(_, lever), b], inertial } = self.point(direction);
        let lever_a = lever - between.perp_dot(direction);
        let coriolis = 2.0 * spin * direction.perp().dot(self.parting()) - spin * spin * direction.dot(between);
        // The prescribed turn of A acts at the longer lever.
        let turned = -between.perp_dot(direction) * self.a.prescribed.1;
        Along { sides: [(-direction, lever_a), b], inertial: inertial + coriolis + turned }
    }

    /// The distance of both anchors, which is not zero.
    pub fn stretch(&self) -> Along {
        let (between, parting) = (self.between(), self.parting());
        let distance = between.length();
        let direction = between / distance;
        let across = parting.perp_dot(direction);
        let along = self.point(direction);
        Along { inertial: along.inertial + across * across / distance, ..along }
    }

    /// The angle of body B relative to body A.
    pub fn turn(&self) -> Along {
        let inertial = self.b.prescribed.1 - self.a.prescribed.1;
        Along { sides: [(DVec2::ZERO, -1.0), (DVec2::ZERO, 1.0)], inertial }
    }

    fn with_prescribed(&self, along: Along) -> Along {
        let of = |end: &JointEnd, (direction, lever): (DVec2, f64)| {
            direction.dot(end.prescribed.0) + lever * end.prescribed.1
        };
        let [a, b] = along.sides;
        Along { inertial: along.inertial + of(&self.a, a) + of(&self.b, b), ..along }
    }

    /// The rate along a direction, in m/s or rad/s.
    pub fn rate(&self, along: &Along) -> f64 {
        let of = |end: &JointEnd, (direction, lever): (DVec2, f64)| {
            let center = end.velocity - end.arm.perp() * end.spin;
            direction.dot(center) + lever * end.spin
        };
        of(&self.a, along.sides[0]) + of(&self.b, along.sides[1])
    }

    /// The sum of the speeds from which a rate is found, in m/s and rad/s.
    pub fn speeds(&self, along: &Along) -> f64 {
        let of = |end: &JointEnd, (direction, lever): (DVec2, f64)| {
            let center = end.velocity - end.arm.perp() * end.spin;
            direction.length() * center.length() + (lever * end.spin).abs()
        };
        of(&self.a, along.sides[0]) + of(&self.b, along.sides[1])
    }

    /// The bound of the second derivative of a holding force that swings with `amplitude`, per second squared. Forces
    /// swing as fast as the clock drives a force, or as either body turns.
    pub fn bend(&self, amplitude: f64, state: &State) -> f64 {
        let fastest = state.fastest_rhythm().max(self.a.spin.abs()).max(self.b.spin.abs());
        amplitude * fastest * fastest
    }

    /// The same bound for the force of a row. If other rows yield, this row also bears their excess. So the sum of all
    /// pulls of rows on it counts.
    pub fn bend_of_row(&self, row: &Row, amplitude: f64, state: &State) -> f64 {
        if state.fastest_rhythm() == 0.0 {
            return self.bend(amplitude, state);
        }
        let bodies = state.bodies();
        let pulled = state.rows().pulls(row, bodies) / row.response(row, bodies);
        self.bend(amplitude + 2.0 * pulled, state)
    }

    /// Adds a force in N, or a torque in N m, along a direction. Returns the power in W that it gives to bodies that move by forces.
    pub fn push(&self, along: &Along, amount: f64, state: &mut State) -> f64 {
        let (bodies, rates) = state.bodies_and_rates();
        let inside = [self.a, self.b].iter().all(|end| end.body.is_some_and(|body| bodies.dynamic[body]));
        let mut power = 0.0;
        for (end, (direction, lever)) in [(self.a, along.sides[0]), (self.b, along.sides[1])] {
            let Some(body) = end.body.filter(|&body| bodies.dynamic[body]) else { continue };
            let (force, torque) = (direction * amount, lever * amount);
            bodies.force[body] += force;
            bodies.torque[body] += torque;
            power += force.dot(bodies.velocity[body]) + torque * bodies.spin[body];
            if !inside {
                rates.outside(bodies.position[body], force, torque);
            }
        }
        power
    }

    /// The row that holds a direction.
    pub fn row(&self, along: &Along, kind: RowKind) -> Row {
        let side = |end: &JointEnd, (direction, lever): (DVec2, f64)| {
            end.body.map(|body| RowSide { body, direction, lever, force: direction, torque: lever })
        };
        let sides = [side(&self.a, along.sides[0]), side(&self.b, along.sides[1])];
        Row { sides, inertial: along.inertial, kind, ..Row::default() }
    }
}
