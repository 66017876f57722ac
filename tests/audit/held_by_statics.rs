//! Law: a body between several contacts stands as long as some forces within all cones balance its loads, and it lets go when there are
//! none. Source: Coulomb's law and the balance of forces. The forces are not determined, so no spring decides.
//!
//! A ladder leans on a wall. Both its cones cross in a polygon. It stands while the line of its load passes that polygon. With static
//! coefficients its corner lies farther out than with a wall that slides.
//!
//! Tolerance: the ladder turns by the give of both springs over its height, which a factor of twenty covers. A fall turns it by a
//! radian. The foot needs shares of its cone that leave room for the swing of the springs.
//!
//! Not tested: loads that change within a swing of the springs.

use jostle::simulation::Overrides;

use super::begins_at_rest::{GRAVITY, load, ways};

const RADIUS: f64 = 0.03;

/// A ladder with a foot on the floor at the origin and its head at a wall.
struct Ladder {
    length: f64,
    /// In radians from the floor.
    angle: f64,
    mass: f64,
    coefficients: (f64, f64),
    restitution: f64,
    stiffness: f64,
    /// The place of the push, as a share of the way from the foot to the head.
    place: f64,
}

impl Ladder {
    fn across(&self) -> f64 {
        self.length * libm::cos(self.angle)
    }

    fn height(&self) -> f64 {
        self.length * libm::sin(self.angle)
    }

    /// The coefficient that the foot needs under a push down in newtons, if the head is at its static cone.
    fn needs(&self, push: f64) -> f64 {
        let (x, y, mu) = (self.across() + RADIUS, self.height() + RADIUS, self.coefficients.0);
        let weight = self.mass * GRAVITY;
        let head = (weight * 0.5 + push * self.place) * self.across() / (y + mu * x);
        head / (weight + push - mu * head)
    }

    /// The push under which the foot needs a coefficient, by bisection.
    fn push(&self, coefficient: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1e5);
        assert!(self.needs(low) < coefficient && coefficient < self.needs(high), "no push needs {coefficient}");
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.needs(middle) < coefficient { low = middle } else { high = middle }
        }
        low
    }

    fn scene(&self, course: &str) -> String {
        let Self { length, angle, mass, coefficients: (held, slips), restitution, stiffness, place } = self;
        let (half, wall) = (length / 2.0, self.across() + RADIUS);
        format!(
            "Scene(format: 1, clock: (duration: 1.6), gravity: (0, -{GRAVITY:?}), \
             materials: {{\"m\": (stiffness: {stiffness:?}, restitution: {restitution:?}, friction: (static: {held:?}, dynamic: {slips:?}))}}, \
             walls: [(name: \"floor\", left: (9, 0), right: (-9, 0), material: \"m\"), \
             (name: \"wall\", left: ({wall:?}, 9), right: ({wall:?}, -1), material: \"m\")], \
             bodies: [(name: \"ladder\", at: ({:?}, {:?}), angle: {angle:?}, mass: {mass:?}, material: \"m\", \
             shape: Capsule(from: ({:?}, 0), to: ({half:?}, 0), radius: {RADIUS:?}))], \
             forces: [Drive(of: \"ladder\", at: ({:?}, 0), force: (0, -1), course: {course})])",
            0.5 * self.across(),
            0.5 * self.height() + RADIUS,
            -half,
            length * (place - 0.5),
        )
    }
}

const LADDERS: [Ladder; 4] = [
    Ladder {
        length: 3.0,
        angle: 1.13,
        mass: 6.0,
        coefficients: (0.4, 0.3),
        restitution: 0.0,
        stiffness: 2e5,
        place: 0.9,
    },
    Ladder {
        length: 2.2,
        angle: 1.0,
        mass: 9.0,
        coefficients: (0.5, 0.3),
        restitution: 0.3,
        stiffness: 1e6,
        place: 0.93,
    },
    Ladder {
        length: 1.87,
        angle: 0.875,
        mass: 10.8,
        coefficients: (0.507, 0.336),
        restitution: 0.3,
        stiffness: 9e7,
        place: 0.917,
    },
    Ladder {
        length: 3.6,
        angle: 1.21,
        mass: 12.0,
        coefficients: (0.3, 0.28),
        restitution: 0.1,
        stiffness: 3e5,
        place: 0.88,
    },
];

/// Courses that end at the load in newtons: one begins with a part of it, and one comes back to it.
fn courses(load: f64) -> [String; 2] {
    let part = 0.3 * load;
    [
        format!("Piecewise([(0, {part:?}), (0.3, {part:?}), (0.6, {load:?}), (2, {load:?})])"),
        format!("Piecewise([(0, 0), (0.3, {load:?}), (0.7, {part:?}), (1.1, {load:?}), (2, {load:?})])"),
    ]
}

fn turned(text: &str, overrides: &Overrides) -> f64 {
    let mut simulation = load(text, overrides);
    let begin = simulation.bodies().angle[0];
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
    (simulation.bodies().angle[0] - begin).abs()
}

#[test]
fn a_ladder_stands_as_long_as_statics_holds_it() {
    for (number, ladder) in LADDERS.iter().enumerate() {
        for (share, falls) in [(0.85, false), (0.96, false), (1.02, true)] {
            let push = ladder.push(share * ladder.coefficients.0);
            for course in courses(push) {
                let text = ladder.scene(&course);
                for (name, overrides) in &ways() {
                    let turned = turned(&text, overrides);
                    let give = (push + ladder.mass * GRAVITY) / ladder.stiffness / ladder.height();
                    let told = format!("{number}, {name}, {share} of the cone: {turned:e} rad\n{text}");
                    assert!(if falls { turned > 0.1 } else { turned < 20.0 * give }, "{told}");
                }
            }
        }
    }
}

/// A disc of `masses.0` is pushed against a box of `masses.1` on a floor, with a force in newtons at its centre.
fn pushed_disc(masses: (f64, f64), coefficient: f64, push: f64) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 1.2), gravity: (0, -{GRAVITY:?}), \
         materials: {{\"m\": (stiffness: 3e5, restitution: 0.1, friction: {coefficient:?})}}, \
         walls: [(name: \"floor\", left: (9, 0), right: (-9, 0), material: \"m\")], \
         bodies: [(name: \"disc\", at: (0, 0.2), mass: {:?}, material: \"m\", atoms: Disc(radius: 0.2)), \
         (name: \"box\", at: (0.45, 0.15), mass: {:?}, material: \"m\", shape: Rectangle(width: 0.5, height: 0.3))], \
         forces: [Drive(of: \"disc\", force: (1, 0), course: Piecewise([(0, 0), (0.8, {push:?}), (2, {push:?})]))])",
        masses.0, masses.1,
    )
}

/// Law: the disc cannot roll, since the box rubs on it. Its friction on the floor and that on the box are equal, as its spin rests. If both
/// are `mu N`, the box bears `N = F/(1 + mu)`, and slides from `F = mu m g/(1 - mu)` on.
///
/// Tolerance: springs give by the push over their stiffness, and the disc rolls on the give of the box.
#[test]
fn a_disc_that_its_friction_chocks_holds_up_to_the_cone_of_the_box() {
    for (masses, coefficient) in [((6.0, 4.0), 0.4), ((9.0, 3.0), 0.3), ((12.0, 5.0), 0.5)] {
        let limit = coefficient * masses.1 * GRAVITY / (1.0 - coefficient);
        assert!(limit < masses.0 * GRAVITY, "the disc would slip on the floor");
        for (share, slides) in [(0.8, false), (0.96, false), (1.04, true)] {
            let text = pushed_disc(masses, coefficient, share * limit);
            for (name, overrides) in &ways() {
                let mut simulation = load(&text, overrides);
                let begin = simulation.bodies().position[1];
                simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{text}"));
                let way = (simulation.bodies().position[1].x - begin.x).abs();
                let give = 4.0 * limit / 3e5;
                assert!(
                    if slides { way > 2.0 * give } else { way < give },
                    "{name}, {share} of the limit: {way:e} m\n{text}"
                );
            }
        }
    }
}
