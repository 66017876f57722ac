//! Two joints whose motions are coupled: `second = ratio first + constant`. One row between the bodies that both joints move.
//!
//! The constant is that of the start. Bodies that do not move by forces drop out, so a row has two sides as long as no more than two
//! others are involved.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use super::KnownJoints;
use super::ends::Ends;
use super::law::{Freedom, Law};
use crate::constraints::{Kind as Holds, Row, Rows, Side};
use crate::scene::{Entry, Kind, Outline, Report, SceneError};
use crate::tick::snapshot::{Memory, Unfit, recall};
use crate::tick::{Energies, ForceOn, ForcePart, LoadErrors, Model, State, SteadySpring, TickAppExt};
use crate::world::Bodies;
use std::sync::Arc;

/// Reports joints that are not there, or one twice.
pub(super) fn check(of: &(String, String), outline: &Outline, report: &mut Report) {
    for (name, path) in [(&of.0, "of[0]"), (&of.1, "of[1]")] {
        outline.require(Kind::JOINT, name, path, report);
    }
    if of.0 == of.1 {
        report.error("of", format!("both joints are \"{}\"", of.0)).help("name two joints");
    }
}

/// What a coupling couples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Member {
    Hinge,
    Slide,
}

impl Member {
    /// Whether a joint with this law is one.
    fn is(self, law: &dyn Law) -> bool {
        let free = if self == Self::Hinge { "angle" } else { "travel" };
        law.freedom_name().0 == free && !law.needs_distance()
    }

    fn called(self) -> &'static str {
        if self == Self::Hinge { "hinge (`Revolute`)" } else { "slide (`Prismatic`)" }
    }
}

/// Adds the couplings of one kind: the names of two joints each, and the ratio of their rates.
pub(super) fn install<E: Entry>(
    app: &mut App,
    outline: &Outline,
    members: [Member; 2],
    couplings: impl Iterator<Item = ((String, String), f64)>,
) {
    super::close_at_start(app);
    let mentions = outline.entries(E::SECTION).iter().filter(|mention| mention.name == E::NAME);
    for ((of, ratio), mention) in couplings.zip(mentions) {
        let (path, kind) = (mention.path.clone(), E::NAME);
        app.add_model(Coupling { of, ratio, path, kind, members, sides: None, offset: 0.0, row: None });
    }
}

type Coupled = (Ends, Arc<dyn Law>);

/// A coupling of two joints.
pub struct Coupling {
    of: (String, String),
    ratio: f64,
    path: String,
    kind: &'static str,
    members: [Member; 2],
    sides: Option<[Coupled; 2]>,
    offset: f64,
    /// The index of its row in the present evaluation.
    row: Option<usize>,
}

impl Coupling {
    /// The row in the present state; `None` if a body is gone.
    fn held(&self, bodies: &Bodies) -> Option<Result<Row, usize>> {
        let [first, second] = self.sides.as_ref()?;
        let mut row = Row { kind: Holds::Position, gap: -self.offset, grounded: true, ..Row::default() };
        let mut sides: Vec<Side> = Vec::with_capacity(4);
        for ((ends, law), factor) in [(first, -self.ratio), (second, 1.0)] {
            let pair = ends.pair(bodies)?;
            let Freedom { along, value } = law.freedom(&pair)?;
            row.gap += factor * value;
            row.size += (factor * value).abs() + factor.abs();
            row.inertial += factor * along.inertial;
            for (end, (direction, lever)) in [(pair.a, along.sides[0]), (pair.b, along.sides[1])] {
                let Some(body) = end.body else { continue };
                let (direction, lever) = (direction * factor, lever * factor);
                match sides.iter_mut().find(|side| side.body == body) {
                    Some(side) => (side.direction, side.lever) = (side.direction + direction, side.lever + lever),
                    None => sides.push(Side { body, direction, lever, force: DVec2::ZERO, torque: 0.0 }),
                }
            }
        }
        sides.retain(|side| bodies.moves[side.body]);
        if sides.len() > 2 {
            return Some(Err(sides.len()));
        }
        sides.iter_mut().for_each(|side| (side.force, side.torque) = (side.direction, side.lever));
        let mut sides = sides.into_iter();
        row.sides = [sides.next(), sides.next()];
        Some(Ok(row))
    }

    fn refuse(&self, world: &mut World, message: String, help: &str) {
        let error = SceneError::new(format!("{}.of", self.path), message).with_help(help);
        world.get_resource_or_init::<LoadErrors>().0.push(error);
    }
}

impl Model for Coupling {
    fn name(&self) -> &'static str {
        self.kind
    }

    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn force_on(&self, state: &State, body: usize) -> Option<ForceOn> {
        let index = self.row.filter(|row| *row < state.rows().len())?;
        let (row, amount) = (state.rows().row(index), state.rows().force(index));
        let side = row.sides.iter().flatten().find(|side| side.body == body)?;
        Some(ForceOn { part: ForcePart::Joint, force: side.force * amount, point: state.bodies().position[body] })
    }

    fn has_rows(&self) -> bool {
        true
    }

    fn start(&mut self, world: &mut World) {
        let named = |name: &str| {
            world
                .get_resource::<KnownJoints>()
                .and_then(|known| known.named(name))
                .map(|known| (known.ends.clone(), known.law.clone()))
        };
        let (Some(first), Some(second)) = (named(&self.of.0), named(&self.of.1)) else { return };
        for (member, (name, (_, law))) in self.members.into_iter().zip([(&self.of.0, &first), (&self.of.1, &second)]) {
            if !member.is(&**law) {
                let [one, two] = self.members.map(Member::called);
                let help = if one == two {
                    "name two hinges (`Revolute`)".to_owned()
                } else {
                    format!("name a {one} first, then a {two}")
                };
                return self.refuse(world, format!("`{name}` is no {}", member.called()), &help);
            }
        }
        self.sides = Some([first, second]);
        let bodies = &world.resource::<State>().bodies;
        match self.held(bodies) {
            Some(Ok(row)) => self.offset = row.gap,
            Some(Err(count)) => {
                let help =
                    "hold the frame of both joints to the world, or let it be a body that is fixed or has a path";
                let message = format!("its joints move {count} bodies together: only two can be coupled so far");
                self.refuse(world, message, help);
            }
            None => {
                let help = "look at the bodies of both joints";
                self.refuse(world, "one of the joints has lost a body".to_owned(), help);
            }
        }
    }

    fn add_rows(&mut self, bodies: &Bodies, _: f64, rows: &mut Rows) {
        self.row = None;
        if let Some(Ok(row)) = self.held(bodies) {
            self.row = Some(rows.len());
            rows.add(row);
        }
    }

    fn take_rows(&mut self, state: &mut State) {
        if let Some(row) = self.row {
            state.apply_rows(row..row + 1);
        }
    }

    fn save(&self) -> Memory {
        Memory::of(&self.row)
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), Unfit> {
        self.row = recall(bytes)?;
        Ok(())
    }
}
