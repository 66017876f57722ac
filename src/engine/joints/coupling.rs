//! A coupling of two joints, `second = ratio first + constant`, as one row between the bodies that both joints move.
//!
//! The constant is that of the start. Bodies that do not move by forces drop out. So a row has two sides if at most two
//! other bodies are involved.
//!
//! Gears give torques and no force, because a ratio does not determine the position of teeth. Teeth of a rack push
//! along the slide at the pitch point, which lies `radius` from the pin. They are spur gears without pressure angle
//! (Shigley, Mechanical Engineering Design, chapter 13). The row of a rack combines both motions. It adds the rows of
//! pin and slide, with factors that leave no force on their frame.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use super::KnownJoints;
use super::ends::{Along, EndPair, JointEnds};
use super::law::{Freedom, Held, JointLaw};
use crate::constraints::{Row, RowKind as Holds, RowSide, Rows};
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneError};
use crate::tick::snapshot::{Memory, UnfitSnapshot, recall};
use crate::tick::{Energies, ForceOn, ForcePart, LoadErrors, Model, State, SteadySpring, TickAppExt};
use crate::world::Bodies;
use std::sync::Arc;

/// Reports joints that are not there, or one twice.
pub(super) fn check(of: &(String, String), outline: &Outline, report: &mut Diagnostics) {
    for (name, path) in [(&of.0, "of[0]"), (&of.1, "of[1]")] {
        outline.require(NameKind::JOINT, name, path, report);
    }
    if of.0 == of.1 {
        report.error("of", format!("both joints are \"{}\"", of.0)).help("name two joints");
    }
}

/// A member of a coupling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Member {
    Hinge,
    Slide,
}

impl Member {
    /// Whether a joint with this law is one.
    fn is(self, law: &dyn JointLaw) -> bool {
        let free = if self == Self::Hinge { "angle" } else { "travel" };
        law.freedom_name().0 == free && !law.needs_distance()
    }

    fn called(self) -> &'static str {
        if self == Self::Hinge { "hinge (`Revolute`)" } else { "slide (`Prismatic`)" }
    }
}

/// A coupling as the scene asks for it.
pub(super) struct Asked {
    pub name: Option<String>,
    pub of: (String, String),
    pub ratio: f64,
}

/// Adds the couplings of one kind.
pub(super) fn install<E: Entry>(
    app: &mut App,
    outline: &Outline,
    members: [Member; 2],
    couplings: impl Iterator<Item = Asked>,
) {
    super::close_at_start(app);
    let mentions = outline.entries(E::SECTION).iter().filter(|mention| mention.name == E::NAME);
    for (Asked { name, of, ratio }, mention) in couplings.zip(mentions) {
        let (path, kind) = (mention.path.clone(), E::NAME);
        let name = name.unwrap_or_else(|| path.clone());
        app.add_model(Coupling {
            name,
            of,
            ratio,
            path,
            kind,
            members,
            sides: None,
            mesh: None,
            offset: 0.0,
            row: None,
            force: 0.0,
        });
    }
}

type Coupled = (JointEnds, Arc<dyn JointLaw>);

/// The axis of a slide, in the world.
fn axis(travel: &Along) -> DVec2 {
    travel.sides[1].0
}

/// A coupling of two joints.
pub struct Coupling {
    /// Its name, or its path in the scene, such as `joints[2]`.
    pub name: String,
    /// Its action on `b` of the second joint in the last evaluation. For gears it is the torque in N m, for a rack the
    /// force in N along the slide.
    pub force: f64,
    of: (String, String),
    ratio: f64,
    path: String,
    kind: &'static str,
    members: [Member; 2],
    sides: Option<[Coupled; 2]>,
    /// The meeting point of the teeth of a rack; `None` for gears.
    mesh: Option<Mesh>,
    offset: f64,
    /// The index of its row in the present evaluation.
    row: Option<usize>,
}

/// How a pinion meets its rack.
#[derive(Clone, Copy, Debug)]
struct Mesh {
    /// The end of the hinge that is the pinion, and the end of the slide that is the rack. The other two are their frame.
    pinion: usize,
    rack: usize,
    /// From anchor B of the slide to the pitch point, across the axis, in m.
    lever: f64,
}

impl Mesh {
    /// The mesh of a hinge and a slide with a body in common, which is their frame. All bodies that do not move by
    /// forces count as one body.
    fn of(hinge: &EndPair, slide: &EndPair, bodies: &Bodies) -> Option<Self> {
        let moving = |pair: &EndPair| [pair.a, pair.b].map(|end| end.body.filter(|&body| bodies.moves[body]));
        let (hinge, slide) = (moving(hinge), moving(slide));
        let mut ways = [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter();
        let (one, two) = ways.find(|&(one, two)| hinge[one] == slide[two])?;
        Some(Self { pinion: 1 - one, rack: 1 - two, lever: 0.0 })
    }

    /// The signs of the pinion in the angle and of the rack in the travel.
    fn signs(self) -> [f64; 2] {
        [self.pinion, self.rack].map(|end| if end == 1 { 1.0 } else { -1.0 })
    }

    /// The pitch point in metres, for an axis and a radius.
    fn point(self, hinge: &EndPair, axis: DVec2, radius: f64) -> DVec2 {
        let [pinion, rack] = self.signs();
        let pin = if self.pinion == 1 { hinge.b } else { hinge.a };
        pin.position - pinion * rack * radius * axis.perp()
    }

    /// Removes the motion of the frame from a row, by means of the rows of the hinge and the slide.
    fn hold(self, sum: &mut Sum, axis: DVec2, [(hinge, pin), (slide, rail)]: [(&EndPair, &dyn JointLaw); 2]) {
        let [pinion, rack] = self.signs();
        pin.hold(hinge, &mut |held| sum.add(hinge, &held, -pinion * rack * held.along.sides[1].0.dot(axis)));
        rail.hold(slide, &mut |held| {
            let turns = held.along.sides[1].0 == DVec2::ZERO;
            sum.add(slide, &held, if turns { self.lever } else { 0.0 });
        });
        let frame = [[hinge.b, hinge.a][self.pinion].body, [slide.b, slide.a][self.rack].body];
        sum.sides.retain(|side| !frame.contains(&Some(side.body)));
    }
}

/// A row as a sum of directions.
struct Sum {
    row: Row,
    sides: Vec<RowSide>,
}

impl Sum {
    fn add(&mut self, pair: &EndPair, Held { along, gap, size }: &Held, factor: f64) {
        self.row.gap += factor * gap;
        self.row.size += factor.abs() * size;
        self.row.inertial += factor * along.inertial;
        for (end, (direction, lever)) in [(pair.a, along.sides[0]), (pair.b, along.sides[1])] {
            let Some(body) = end.body else { continue };
            let (direction, lever) = (direction * factor, lever * factor);
            match self.sides.iter_mut().find(|side| side.body == body) {
                Some(side) => (side.direction, side.lever) = (side.direction + direction, side.lever + lever),
                None => self.sides.push(RowSide { body, direction, lever, force: DVec2::ZERO, torque: 0.0 }),
            }
        }
    }
}

/// Both joints in the current state, each with its freedom.
type Now<'a> = [(EndPair, &'a dyn JointLaw, Freedom); 2];

impl Coupling {
    /// The name and unit of the channel of its action.
    pub fn gives(&self) -> (&'static str, &'static str) {
        if self.members[1] == Member::Slide { ("force", "N") } else { ("torque", "N m") }
    }

    fn now(&self, bodies: &Bodies) -> Option<Now<'_>> {
        let now = |(ends, law): &'_ Coupled| -> Option<_> {
            let pair = ends.pair(bodies)?;
            Some((pair, law.freedom(&pair)?))
        };
        let [first, second] = self.sides.as_ref()?;
        let ((one, turn), (two, shift)) = (now(first)?, now(second)?);
        Some([(one, &*first.1, turn), (two, &*second.1, shift)])
    }

    /// The row in the present state; `None` if a body is gone.
    fn held(&self, bodies: &Bodies) -> Option<Result<Row, usize>> {
        let row = Row { kind: Holds::Position, gap: -self.offset, grounded: true, ..Row::default() };
        let mut sum = Sum { row, sides: Vec::with_capacity(4) };
        let [first, second] = self.now(bodies)?;
        for ((pair, _, Freedom { along, value }), factor) in [(&first, -self.ratio), (&second, 1.0)] {
            sum.add(pair, &Held { along: *along, gap: *value, size: value.abs() + 1.0 }, factor);
        }
        if let Some(mesh) = self.mesh {
            let axis = axis(&second.2.along);
            mesh.hold(&mut sum, axis, [(&first.0, first.1), (&second.0, second.1)]);
        }
        let Sum { mut row, mut sides } = sum;
        sides.retain(|side| bodies.moves[side.body]);
        if sides.len() > 2 {
            return Some(Err(sides.len()));
        }
        sides.iter_mut().for_each(|side| (side.force, side.torque) = (side.direction, side.lever));
        let mut sides = sides.into_iter();
        row.sides = [sides.next(), sides.next()];
        Some(Ok(row))
    }

    /// The pitch point of a rack, in metres.
    fn pitch_point(&self, bodies: &Bodies) -> Option<DVec2> {
        let [(hinge, ..), (_, _, shift)] = self.now(bodies)?;
        Some(self.mesh?.point(&hinge, axis(&shift.along), self.ratio))
    }

    /// Finds the teeth of a rack. Says whether its joints have a frame in common.
    fn find_mesh(&mut self, bodies: &Bodies) -> bool {
        let Some([(hinge, ..), (slide, _, shift)]) = self.now(bodies) else { return true };
        let Some(mesh) = Mesh::of(&hinge, &slide, bodies) else { return false };
        let axis = axis(&shift.along);
        let lever = (mesh.point(&hinge, axis, self.ratio) - slide.b.position).perp_dot(axis);
        self.mesh = Some(Mesh { lever, ..mesh });
        true
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
        let point = self.pitch_point(state.bodies()).unwrap_or(state.bodies().position[body]);
        Some(ForceOn { part: ForcePart::Joint, force: side.force * amount, point })
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
        let [first, second] = [&self.of.0, &self.of.1].map(|name| (name, named(name)));
        for (name, found) in [&first, &second] {
            if found.is_none() {
                return self.refuse(
                    world,
                    format!("`{name}` couples joints itself"),
                    "name the joints that it couples",
                );
            }
        }
        let ((_, Some(first)), (_, Some(second))) = (first, second) else { return };
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
        if self.members[1] == Member::Slide && !self.find_mesh(&world.resource::<State>().bodies) {
            let help = "hold the pinion and the rack to one body, or both to the world";
            return self.refuse(world, "its hinge and its slide have no body in common".to_owned(), help);
        }
        let bodies = &world.resource::<State>().bodies;
        match self.held(bodies) {
            Some(Ok(row)) => self.offset = row.gap,
            Some(Err(count)) => {
                let help = "hold the frame of both joints to the world, or to a body that is fixed or has a path";
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
        self.force = 0.0;
        if let Some(row) = self.row {
            state.apply_rows(row..row + 1);
            self.force = state.rows().force(row);
        }
    }

    fn save(&self) -> Memory {
        Memory::of(&(self.row, self.force))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        (self.row, self.force) = recall(bytes)?;
        Ok(())
    }
}
