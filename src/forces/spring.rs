//! A spring and a damper between two points (Hooke 1678; Kelvin and Voigt): with the distance `l` of its ends, both are
//! pulled towards each other by `F = k (l - l0) + c dl/dt`, in newtons. Elastic energy `k (l - l0)^2/2`; the damper takes
//! `c (dl/dt)^2` watts, booked as `damping`.
//!
//! In a place without distance the force of the spring has no direction: a spring that has a length of its own pushes
//! nowhere then, and one of no length does not push at all; the damper acts along the motion of one end against the other,
//! the limit of ends that run through each other.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use super::link::{self, DAMPING, End, Link, Partner};
use crate::scene::units::{Damping, Length, Position, Stiffness};
use crate::scene::{Entry, Outline, Report, SceneAppExt, SceneError, Written};
use crate::tick::response;
use crate::tick::snapshot::{Memory, Unfit, recall};
use crate::tick::{Dependence, Energies, ForcePart, LoadErrors, Loss, Model, State, SteadySpring, TickAppExt};

/// A spring, and a damper beside it, between points of two bodies or of a body and the world. It pulls its ends together by
/// `stiffness (distance - length) + damping d(distance)/dt`, and pushes where that is negative.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Spring {
    /// The body at one end.
    a: String,
    /// The body at the other end, or `World`.
    b: Partner,
    /// Where it holds `a`, in the body's frame from its centre of mass, in metres. Default: (0, 0), the centre of mass.
    #[serde(default)]
    anchor_a: Position,
    /// Where it holds `b`, in the body's frame from its centre of mass, in metres; with `World` a place in the world.
    /// Default: (0, 0), the centre of mass or the origin.
    #[serde(default)]
    anchor_b: Position,
    /// Force over lengthening in N/m. Not negative.
    stiffness: Stiffness,
    /// Force over speed of lengthening in N s/m. Not negative. `2 sqrt(k m)` lets a mass `m` on it come to rest without a
    /// swing. Default: 0.
    #[serde(default)]
    damping: Damping,
    /// Length without force in metres. Not negative. Default: the distance of its ends at the start.
    length: Option<Length>,
}

impl Entry for Spring {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Spring";
    const EXAMPLE: &'static str = "Spring(a: \"left\", b: \"right\", stiffness: 100, damping: 0.5)";

    fn schema(generator: &mut SchemaGenerator) -> Option<Schema> {
        Some(generator.subschema_for::<Self>())
    }

    fn check(&self, outline: &Outline, report: &mut Report) {
        link::check_ends(&self.a, &self.b, outline, report);
        link::check_holds(self.stiffness, self.damping, report);
        if let Some(length) = self.length {
            report.not_negative("length", length);
        }
    }

    fn install(entries: Vec<Written<Self>>, outline: &Outline, app: &mut App) {
        let paths = outline.entries(Self::SECTION).iter().filter(|mention| mention.name == Self::NAME);
        for (Written { value, .. }, mention) in entries.into_iter().zip(paths) {
            app.add_model(SpringForce {
                link: Link::named(&value.a, &value.b, (value.anchor_a.si(), value.anchor_b.si()), outline),
                stiffness: value.stiffness.si(),
                damping: value.damping.si(),
                power: 0.0,
                force: DVec2::ZERO,
                length: value.length.map(Length::si),
                path: mention.path.clone(),
            });
        }
    }
}

/// One entry, ready to be applied.
#[derive(Clone, Debug)]
pub struct SpringForce {
    /// Its ends.
    pub link: Link,
    /// Stiffness in N/m.
    pub stiffness: f64,
    /// Damping in N s/m.
    pub damping: f64,
    /// Power that the damper took in the last evaluation, in watts.
    power: f64,
    /// Its force on end A in the last evaluation, in newtons.
    force: DVec2,
    /// Length without force in metres; `None`: the distance of the ends at the start, which takes its place then.
    pub length: Option<f64>,
    /// Where it stands in the scene, such as `forces[0]`.
    pub path: String,
}

pub(super) fn plugin(app: &mut App) {
    app.register_entry::<Spring>();
}

/// The state of a spring: direction from A to B, distance in m, and speed of lengthening in m/s.
fn stretch(a: &End, b: &End) -> (DVec2, f64, f64) {
    let (between, parting) = (b.position - a.position, b.velocity - a.velocity);
    let distance = between.length();
    let direction = if distance > 0.0 { between / distance } else { parting.normalize_or_zero() };
    (direction, distance, parting.dot(direction))
}

impl SpringForce {
    fn lengthening(&self, distance: f64) -> f64 {
        distance - self.length.unwrap_or(distance)
    }
}

impl Model for SpringForce {
    fn dependence(&self) -> Dependence {
        if self.damping > 0.0 { Dependence::Velocity } else { Dependence::Position }
    }

    /// Takes the distance at the start for a length that the scene does not give.
    fn start(&mut self, world: &mut World) {
        let Some((a, b)) = self.link.ends(&world.resource::<State>().bodies) else { return };
        let distance = (b.position - a.position).length();
        let length = *self.length.get_or_insert(distance);
        if distance == 0.0 && length > 0.0 {
            let path = format!("{}.length", self.path);
            let message = format!("both ends are in one place: in which direction should {length} m lie?");
            let help = "move an end or an anchor, or give the spring no length: `length: 0`";
            let error = SceneError::new(path, message).with_help(help);
            world.get_resource_or_init::<LoadErrors>().0.push(error);
        }
    }

    fn loss(&self) -> Option<Loss> {
        (self.damping > 0.0).then_some(Loss { account: DAMPING, power: self.power })
    }

    fn save(&self) -> Memory {
        Memory::of(&(self.power, self.force, self.length))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), Unfit> {
        (self.power, self.force, self.length) = recall(bytes)?;
        Ok(())
    }

    fn energies(&self, state: &State) -> Energies {
        let stretched =
            self.link.ends(&state.bodies).map(|(a, b)| self.lengthening((b.position - a.position).length()));
        Energies { potential: 0.0, elastic: 0.5 * self.stiffness * stretched.unwrap_or(0.0).powi(2) }
    }

    /// Along the spring it has its stiffness, across it that of its tension, `F/l`, where it pulls.
    fn stiffness(&self, state: &State, list: &mut Vec<SteadySpring>) {
        let Some((a, b)) = self.link.ends(&state.bodies) else { return };
        let (direction, distance, _) = stretch(&a, &b);
        let tension = if distance > 0.0 { self.lengthening(distance) / distance } else { 1.0 };
        let across = self.stiffness * tension.max(0.0);
        let normal = if direction == DVec2::ZERO { DVec2::X } else { direction };
        let Some((a, b)) = link::sides(&a, &b) else { return };
        let spring = response::Spring { a, b, normal, stiffness: (self.stiffness, across), damped: 0.0, turning: 0.0 };
        list.push(SteadySpring { spring, damping: self.damping, turning_damping: 0.0 });
    }

    fn force_on(&self, state: &State, body: usize) -> Option<(ForcePart, DVec2)> {
        let (a, b) = self.link.ends(&state.bodies)?;
        let of = |end: &End, sign: f64| if end.body == Some(body) { sign } else { 0.0 };
        Some((ForcePart::Spring, self.force * (of(&a, 1.0) + of(&b, -1.0))))
    }

    fn apply_forces(&mut self, state: &mut State) {
        let (bodies, rates) = state.bodies_and_rates();
        (self.power, self.force) = (0.0, DVec2::ZERO);
        self.link.refresh(bodies);
        let Some((a, b)) = self.link.ends(bodies) else { return };
        let (direction, distance, speed) = stretch(&a, &b);
        let elastic = if distance > 0.0 { self.stiffness * self.lengthening(distance) } else { 0.0 };
        self.power = self.damping * speed * speed;
        self.force = direction * (elastic + self.damping * speed);
        link::pull(&a, &b, self.force, bodies, rates);
    }
}

#[cfg(test)]
mod tests {
    use crate::Simulation;
    use crate::scene::Source;

    fn load(forces: &str, bodies: &str) -> Simulation {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\"), bodies: [{bodies}], forces: [{forces}], contacts: None)"
        );
        Simulation::load(&Source::new("spring.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"))
    }

    const BLOCK: &str =
        "(name: \"block\", at: (3, 0), angle: \"90 deg\", mass: 2, inertia: 0.5, atoms: Disc(radius: 0.1))";

    /// Force and torque of one evaluation against numbers by hand; rounding only.
    #[test]
    fn a_spring_pulls_at_its_anchors() {
        // The anchor (0, -1) of the turned block stands at (4, 0); the other end at (4, 3).
        let spring = "Spring(a: \"block\", b: World, anchor_a: (0, -1), anchor_b: (4, 3), stiffness: 10, length: 1)";
        let mut simulation = load(spring, BLOCK);
        simulation.run_to_tick(1).unwrap();
        let bodies = simulation.bodies();
        // 20 N upwards, 1 m to the right of the centre; half a tick's motion changes that by less than 1e-5.
        assert!((bodies.velocity[0].y - 20.0 / 2.0 * 1e-3).abs() < 1e-7, "{}", bodies.velocity[0]);
        assert!((bodies.spin[0] - 20.0 / 0.5 * 1e-3).abs() < 1e-6, "{}", bodies.spin[0]);
    }

    /// Without `length` a spring begins without force: nothing moves, to the last bit.
    #[test]
    fn the_length_is_the_distance_at_the_start() {
        let other = "(name: \"other\", at: (0.1, 0.7), atoms: Disc(radius: 0.1))";
        let mut simulation =
            load("Spring(a: \"block\", b: \"other\", stiffness: 1000, damping: 3)", &format!("{BLOCK}, {other}"));
        simulation.run_to_end().unwrap();
        assert_eq!(simulation.bodies().velocity[0], glam::DVec2::ZERO);
        assert_eq!(simulation.card().energy.elastic, 0.0);
    }

    /// A damped pair that is pulled by a prescribed body: what the drive brings is there or was lost. Tolerance: order 2,
    /// `(omega dt)^2 = 1e-4` of what went round.
    #[test]
    fn what_a_moving_end_brings_is_booked() {
        let cart = "(name: \"cart\", at: (0, 0), kinematic: (velocity: (2, 0)), atoms: Disc(radius: 0.1))";
        let mut simulation = load(
            "Spring(a: \"cart\", b: \"block\", anchor_a: (0.2, 0.3), anchor_b: (0.1, 0.2), stiffness: 200, damping: 4)",
            &format!("{BLOCK}, {cart}"),
        );
        simulation.run_to_end().unwrap();
        let card = simulation.card();
        assert!(card.energy.work > 1.0 && card.energy.accounts["damping"] > 0.1, "{:?}", card.energy);
        assert!(card.energy_error() < 1e-4, "{:e}", card.energy_error());
        assert!(card.momentum_residual[0].abs() < 1e-12 && card.angular_momentum_residual.abs() < 1e-12);
    }

    /// The frequency of two masses on a spring, `sqrt(k (1/m1 + 1/m2))`, is exact after two products.
    #[test]
    fn a_stiff_spring_shortens_the_tick_and_stands_on_the_card() {
        let scene = "Scene(format: 1, clock: (duration: 1, method: VelocityVerlet), contacts: None,
            bodies: [(name: \"a\", at: (0, 0), mass: 2, atoms: Disc(radius: 0.1)),
                     (name: \"b\", at: (1, 0), mass: 2, atoms: Disc(radius: 0.1))],
            forces: [Spring(a: \"a\", b: \"b\", stiffness: 1e6)])";
        let mut simulation = Simulation::load(&Source::new("stiff.ron", scene)).unwrap();
        // pi/(40 x 1000/s) = 7.9e-5 s, rounded down to 5e-5.
        assert_eq!(simulation.clock().dt, 5e-5);
        simulation.run_to_tick(3).unwrap();
        let critical = simulation.card().critical_tick.unwrap();
        assert!((critical - 2e-3).abs() < 1e-12, "{critical}");
    }
}
