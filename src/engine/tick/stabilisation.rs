//! Constraint stabilisation of joints in a step. Positions and velocities are brought back onto the rows of the current
//! state.

use glam::DVec2;

use super::blows::Jump;
use super::context::Tick;
use super::drifted::Drifted;
use super::failure::{FailureKind, Trouble};
use super::stopwatch::TickPart;
use super::{Ledger, Model, State};
use crate::constraints::{DeadPoints, Gap, Row, RowKind, RowSide, Rows, Standing};
use crate::world::{Bodies, finite};
use serde::{Deserialize, Serialize};

/// The largest joint drift so far: the distance of a joint from its constraint after the projection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointDrift {
    /// In metres; for an angle at the farthest point of its bodies.
    pub meters: f64,
    /// The index of the model that holds it.
    pub model: usize,
    /// The time in seconds.
    pub time: f64,
}

/// An impulse in N s and an angular impulse about the origin in N m s that came from outside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FromOutside {
    /// Impulse.
    pub impulse: DVec2,
    /// Angular impulse.
    pub angular: f64,
    /// Work in J of drives and prescribed motions.
    pub work: f64,
}

impl FromOutside {
    /// Adds `amount` of a row's unit force on the bodies at their current poses. It does so if one side does not move
    /// by forces.
    fn add(&mut self, row: &Row, amount: f64, bodies: &Bodies) {
        let driven = if row.kind == RowKind::Velocity { row.rate } else { 0.0 };
        self.work += amount * (row.powers(bodies)[2] + driven);
        if row.is_inside(bodies) {
            return;
        }
        for side in row.sides.iter().flatten().filter(|side| bodies.dynamic[side.body]) {
            self.impulse += side.force * amount;
            self.angular += (bodies.position[side.body].perp_dot(side.force) + side.torque) * amount;
        }
    }

    fn include(&mut self, other: Self) {
        self.impulse += other.impulse;
        self.angular += other.angular;
        self.work += other.work;
    }

    pub(super) fn book(&self, ledger: &mut Ledger) {
        ledger.impulse[0].add(self.impulse.x);
        ledger.impulse[1].add(self.impulse.y);
        ledger.angular_impulse.add(self.angular);
    }
}

/// Searches with new directions where those of the beginning of a drift do not lead back onto a loop.
const MOST_TURNS: usize = 8;

/// A gap in m that rounding of a full turn may leave.
const FULL_TURN: f64 = 1e-12;

/// Rows that hold places only.
fn keep_places(rows: &mut Rows) {
    rows.retain(|row| row.kind == RowKind::Position);
}

/// Adds the rows of joints in the present places and velocities of bodies.
pub(super) fn find_rows(
    models: &mut [Box<dyn Model>],
    indices: &[usize],
    (bodies, time): (&Bodies, f64),
    rows: &mut Rows,
) {
    indices.iter().for_each(|index| models[*index].add_rows(bodies, time, rows));
}

impl State {
    /// The rows of joints in the present state are added to those there are.
    pub(super) fn add_joint_rows(&mut self) {
        let Self { models, roles, bodies, rows, evaluation, .. } = self;
        find_rows(models, &roles.rows, (bodies, evaluation.time), rows);
        let Bodies { jointed, entity, .. } = bodies;
        jointed.clear();
        if rows.has_joints() {
            jointed.resize(entity.len(), false);
            let sides = rows.all().iter().filter(|row| row.kind != RowKind::Acceleration).flat_map(|row| row.sides);
            sides.flatten().for_each(|side| jointed[side.body] = true);
        }
    }

    /// The largest joint drift so far, with the model of the joint; `None` without joints.
    pub fn joint_drift(&self) -> Option<(JointDrift, &dyn Model)> {
        let model = self.models.get(self.joint_drift.model).filter(|_| self.has_joints())?;
        Some((self.joint_drift, &**model))
    }

    /// The dead points of loops of joints so far.
    pub fn dead_points(&self) -> &DeadPoints {
        &self.dead_points
    }

    /// Whether joints hold something in the present state.
    pub fn has_joints(&self) -> bool {
        !self.bodies.jointed.is_empty()
    }

    /// Whether joints hold places and nothing else is held, and no body moves as prescribed.
    pub(super) fn is_only_held(&self) -> bool {
        self.has_joints() && self.rows.all_in_place() && self.bodies.prescribed.motions.is_empty()
    }

    /// Moves bodies along the directions of `along`, rows that hold places, until no joint has a gap.
    fn hold_places(&mut self, along: &mut Rows, time: f64, stay: Standing) {
        let gap = self.close(along, time, stay);
        self.note_gap_of(gap, along, time);
    }

    fn close(&mut self, along: &mut Rows, time: f64, stay: Standing) -> Gap {
        let Self { models, roles, bodies, projection, .. } = self;
        let (rows, solver) = along.prepared(bodies);
        projection.place(rows, solver, (bodies, stay), |found, bodies| {
            find_rows(models, &roles.rows, (bodies, time), found);
            keep_places(found);
        })
    }

    fn note_gap_of(&mut self, gap: Gap, rows: &Rows, time: f64) {
        if let Some(row) = rows.all().get(gap.row) {
            self.note_gap(gap, *row, time);
        }
    }

    /// Moves bodies that have drifted for `elapsed` seconds back along the directions of the beginning, and adapts the
    /// velocities. Across a dead point these directions lead away from the constraints of a loop. There the directions
    /// of the end are used. Returns the external impulse.
    fn hold_drifted(&mut self, along: &mut Rows, (elapsed, time): (f64, f64), stay: Standing) -> FromOutside {
        let loops = along.prepared(&self.bodies).1.least_pivot().is_some();
        let drifted = loops.then(|| Drifted::of(&self.bodies));
        let gap = self.close(along, time, stay);
        let Some(drifted) = drifted.filter(|_| gap.failed) else {
            self.note_gap_of(gap, along, time);
            return self.follow_places(along, elapsed);
        };
        drifted.put_back(&mut self.bodies);
        let (mut rows, mut gap) = (Rows::default(), gap);
        for _ in 0..MOST_TURNS {
            self.find_places(&mut rows, time);
            gap = self.close(&mut rows, time, Standing::Moves);
            if !gap.failed {
                break;
            }
        }
        self.note_gap_of(gap, &rows, time);
        drifted.follow(&mut self.bodies, elapsed)
    }

    fn note_gap(&mut self, gap: Gap, row: Row, time: f64) {
        let sides = || row.sides.iter().flatten();
        let reach = match sides().all(|side| side.direction == DVec2::ZERO) {
            true => sides().map(|side| self.bodies.extent(side.body)).fold(0.0, f64::max),
            false => 1.0,
        };
        let meters = gap.left * reach;
        // A trial step that overflows is made again. If the run itself does, the end of the tick tells which number.
        if (gap.failed || !meters.is_finite()) && finite::first_not_finite(&self.bodies).is_some() {
            return;
        }
        if meters > self.joint_drift.meters || gap.failed {
            self.joint_drift = JointDrift { meters, model: self.model_of(gap.row, time), time };
        }
        if gap.failed {
            let body = sides().map(|side| side.body).next_back();
            let wrong = FailureKind::Joint { meters, dead: self.dead_points.is_near() };
            let tick = self.clock.ticks + 1;
            self.progress.trouble.get_or_insert(Trouble { body, entity: None, wrong, tick, time });
        }
    }

    /// The index of the model that adds this one of the rows that hold places.
    fn model_of(&mut self, row: usize, time: f64) -> usize {
        let Self { models, roles, bodies, .. } = self;
        let mut rows = Rows::default();
        let mut adds = |index: &usize| {
            find_rows(models, &[*index], (bodies, time), &mut rows);
            keep_places(&mut rows);
            rows.len() > row
        };
        roles.rows.iter().copied().find(|index| adds(index)).unwrap_or_default()
    }

    /// Sees whether a loop has passed a dead point.
    fn look_for_dead_points(&mut self, rows: &mut Rows, time: f64) {
        if let Some(pivot) = rows.prepared(&self.bodies).1.least_pivot() {
            self.dead_points.look(time, pivot);
        }
    }

    /// Changes velocities until those that `rows` hold have their required values. Returns the external impulse.
    fn hold_velocities(&mut self, rows: &mut Rows, time: f64) -> FromOutside {
        let (outside, refused) = self.change_velocities(rows, |_, _| {});
        self.note_contradiction(refused, rows, time);
        outside
    }

    /// The same with a function that receives the impulses of each row. Returns also the index of a row whose rate
    /// contradicts the others.
    pub(super) fn change_velocities(
        &mut self,
        rows: &mut Rows,
        mut told: impl FnMut(usize, f64),
    ) -> (FromOutside, Option<usize>) {
        let Self { bodies, projection, .. } = self;
        let (rows, solver) = rows.prepared(bodies);
        let mut outside = FromOutside::default();
        let refused = projection.speed(rows, solver, bodies, |bodies, row, impulse| {
            outside.add(&rows[row], impulse, bodies);
            told(row, impulse);
        });
        (outside, refused)
    }

    pub(super) fn note_contradiction(&mut self, refused: Option<usize>, rows: &Rows, time: f64) {
        if let Some(row) = refused {
            let body = rows.all()[row].sides.iter().flatten().map(|side| side.body).next_back();
            let trouble =
                Trouble { body, entity: None, wrong: FailureKind::Contradiction, tick: self.clock.ticks + 1, time };
            self.progress.trouble.get_or_insert(trouble);
        }
    }

    /// Brings the present state back onto the joints: places along the directions in which these push, then velocities. Returns the
    /// impulse from outside.
    pub(super) fn project(&mut self, time: f64) -> FromOutside {
        self.project_with(time, None)
    }

    /// The same, in a jump of velocities.
    pub(super) fn project_with(&mut self, time: f64, jump: Option<Jump>) -> FromOutside {
        self.turn_to(TickPart::Constraints);
        let mut rows = std::mem::take(&mut self.projected);
        for hold_places in [true, false] {
            rows.clear();
            find_rows(&mut self.models, &self.roles.rows, (&self.bodies, time), &mut rows);
            if hold_places {
                keep_places(&mut rows);
                self.hold_places(&mut rows, time, Standing::Moves);
            }
        }
        match jump {
            Some(Jump::Stops(more)) => {
                rows.retain(|row| !row.gives_way());
                more.iter().for_each(|row| rows.add(*row));
            }
            Some(Jump::Sticks(less)) => {
                let mut indices = 0..;
                rows.retain(|_| indices.next().is_some_and(|index| !less.contains(&index)));
            }
            None => {}
        }
        self.look_for_dead_points(&mut rows, time);
        let outside = match jump {
            Some(Jump::Stops(_)) => self.push_apart(&mut rows, time).0,
            _ => self.hold_velocities(&mut rows, time),
        };
        self.projected = rows;
        self.turn_to(TickPart::Integrate);
        outside
    }

    /// From [`Model::begin_step`](super::Model::begin_step): announces that the constraints of a model have changed.
    pub fn change_rows(&mut self) {
        (self.evaluation.stale, self.evaluation.other_rows) = (true, true);
    }

    /// Before the first tick: brings the bodies of a scene onto its joints.
    ///
    /// # Errors
    /// The reason why that is impossible, and the body that shows it.
    pub(crate) fn assemble(&mut self) -> Result<(), (FailureKind, Option<usize>)> {
        self.find_roles();
        let turned = self.bodies.angle.clone();
        self.project_with(0.0, Some(Jump::Stops(&[])));
        self.take_back_turns(&turned);
        // The velocities of the scene may have been different. Friction and motors use the new ones.
        self.tell_of_blow();
        let trouble = self.progress.trouble.take();
        self.joint_drift = JointDrift::default();
        trouble.map_or(Ok(()), |trouble| Err((trouble.wrong, trouble.body)))
    }

    /// Undoes full turns of bodies in the search for closed joints. Bodies of joints that this opens keep theirs, such as those of
    /// gears.
    fn take_back_turns(&mut self, before: &[f64]) {
        let mut rows = Rows::default();
        self.find_places(&mut rows, 0.0);
        let closed = rows.all().iter().fold(FULL_TURN, |most, row| most.max(row.gap.abs()));
        let turns = |(after, before): (&f64, &f64)| ((after - before) / std::f64::consts::TAU).round();
        let mut turns: Vec<f64> = self.bodies.angle.iter().zip(before).map(turns).collect();
        let found = self.bodies.angle.clone();
        loop {
            for (angle, (found, turns)) in self.bodies.angle.iter_mut().zip(found.iter().zip(&turns)) {
                *angle = found - turns * std::f64::consts::TAU;
            }
            if turns.iter().all(|&turns| turns == 0.0) {
                break;
            }
            self.find_places(&mut rows, 0.0);
            let mut open = rows.all().iter().filter(|row| row.gap.abs() > closed).peekable();
            if open.peek().is_none() {
                break;
            }
            let sides = open.flat_map(|row| row.sides.iter().flatten());
            let opened: Vec<usize> = sides.map(|side| side.body).filter(|&body| turns[body] != 0.0).collect();
            if opened.is_empty() {
                turns.fill(0.0);
            }
            opened.into_iter().for_each(|body| turns[body] = 0.0);
        }
        (self.bodies.posed, self.bodies.recorded) = (false, false);
    }

    /// Called inside a tick, after `elapsed` seconds of it. Positions are brought back along the directions of the
    /// beginning, and velocities follow. This is the constrained step of RATTLE (Andersen 1983; Hairer, Lubich, Wanner,
    /// section VII.1.4).
    pub(super) fn hold_after_drift(&mut self, elapsed: f64, time: f64) {
        self.turn_to(TickPart::Constraints);
        let mut rows = std::mem::take(&mut self.rows);
        if !rows.all_in_place() {
            keep_places(&mut rows);
        }
        // At the poses of the directions, because bodies have moved since.
        self.note_levers(&rows, elapsed);
        self.hold_drifted(&mut rows, (elapsed, time), Standing::Stays).book(&mut self.ledger);
        self.rows = rows;
        self.turn_to(TickPart::Integrate);
    }

    /// Bodies move for `length` seconds from their current state. They are brought back onto joints along the
    /// directions in which these pushed, and velocities follow. `settled`: velocities are brought onto joints as well.
    /// Returns the external impulse.
    pub(super) fn slide(&mut self, time: f64, length: f64, settled: bool) -> FromOutside {
        self.turn_to(TickPart::Constraints);
        let mut rows = std::mem::take(&mut self.projected);
        self.find_places(&mut rows, time);
        self.note_levers(&rows, 0.0);
        self.bodies.coast(length);
        let mut outside = self.hold_drifted(&mut rows, (length, time + length), Standing::Moves);
        if settled {
            self.find_places(&mut rows, time + length);
            outside.include(self.hold_velocities(&mut rows, time + length));
        }
        self.projected = rows;
        self.turn_to(TickPart::Integrate);
        outside
    }

    /// The rows that hold places, of the present state.
    fn find_places(&mut self, rows: &mut Rows, time: f64) {
        rows.clear();
        find_rows(&mut self.models, &self.roles.rows, (&self.bodies, time), rows);
        keep_places(rows);
    }

    /// Notes the lever of each row about the origin, where its bodies were `elapsed` seconds before.
    fn note_levers(&mut self, rows: &Rows, elapsed: f64) {
        let Self { bodies, projection, .. } = self;
        projection.noted.clear();
        projection.noted.extend(rows.all().iter().map(|row| about_origin(row, bodies, elapsed)));
    }

    /// Velocities follow places that were brought back onto `rows` after a drift of `elapsed` seconds. Returns the impulse from outside.
    fn follow_places(&mut self, rows: &Rows, elapsed: f64) -> FromOutside {
        let Self { bodies, projection, .. } = self;
        let mut outside = FromOutside::default();
        for ((row, &sum), about_origin) in rows.all().iter().zip(projection.sums()).zip(&projection.noted) {
            let impulse = sum / elapsed;
            for side in row.sides.iter().flatten() {
                let (by, turned) =
                    (bodies.inverse_mass(side.body) * impulse, bodies.inverse_inertia(side.body) * impulse);
                bodies.velocity[side.body] += side.force * by;
                bodies.spin[side.body] += side.torque * turned;
                if let Some(velocity) = bodies.estimated_velocity.get_mut(side.body) {
                    *velocity += side.force * by;
                    bodies.estimated_spin[side.body] += side.torque * turned;
                }
            }
            if !row.is_inside(bodies) {
                let force = |side: &RowSide| if bodies.dynamic[side.body] { side.force } else { DVec2::ZERO };
                let force = row.sides.iter().flatten().map(force).fold(DVec2::ZERO, |sum, force| sum + force);
                outside.include(FromOutside { impulse: force * impulse, angular: about_origin * impulse, work: 0.0 });
            }
        }
        outside
    }

    /// At the end of a tick: velocities are brought back onto the joints.
    pub(super) fn hold_at_end(&mut self) {
        self.turn_to(TickPart::Constraints);
        let mut rows = std::mem::take(&mut self.rows);
        self.look_for_dead_points(&mut rows, self.evaluation.time);
        let time = self.evaluation.time;
        let outside = if rows.some_give_their_bounds() {
            // A row that gives its bound gives no additional impulse.
            let mut others = std::mem::take(&mut self.projected);
            others.clear();
            let held = rows.all().iter().enumerate().filter(|(index, _)| !rows.gives_its_bound(*index));
            held.for_each(|(_, row)| others.add(*row));
            let outside = self.hold_velocities(&mut others, time);
            self.projected = others;
            outside
        } else {
            self.hold_velocities(&mut rows, time)
        };
        outside.book(&mut self.ledger);
        self.ledger.book_work(outside.work);
        rows.still(&mut self.bodies, self.clock.dt);
        self.rows = rows;
        self.turn_to(TickPart::Integrate);
    }
}

/// The torque about the origin of one unit of a row on its bodies, at their positions `elapsed` seconds earlier. Zero
/// for rows between two such bodies.
fn about_origin(row: &Row, bodies: &Bodies, elapsed: f64) -> f64 {
    if row.is_inside(bodies) {
        return 0.0;
    }
    let of = |side: &RowSide| {
        let was = bodies.position[side.body] - bodies.velocity[side.body] * elapsed;
        was.perp_dot(side.force) + side.torque
    };
    row.sides.iter().flatten().filter(|side| bodies.dynamic[side.body]).map(of).fold(0.0, |sum, term| sum + term)
}

/// The notes on joints before a trial of a step.
#[derive(Clone, Copy, Debug)]
pub struct Noted {
    drift: JointDrift,
    trouble: Option<Trouble>,
}

impl Tick<'_> {
    /// The notes on joints so far. A trial of a step may end where no joint can be closed, and then it is discarded.
    pub fn noted(&self) -> Noted {
        Noted { drift: self.state.joint_drift, trouble: self.state.progress.trouble }
    }

    /// Discards the notes on joints of the last trial.
    pub fn forget_trial(&mut self, noted: Noted) {
        (self.state.joint_drift, self.state.progress.trouble) = (noted.drift, noted.trouble);
    }

    /// Whether joints hold something.
    pub fn has_joints(&self) -> bool {
        self.state.has_joints()
    }

    /// Brings velocities back onto the joints. An integrator that goes from tick to tick calls it last, unless it ends
    /// with [`Tick::kick_at_end`].
    pub fn hold_velocities(&mut self) {
        if self.has_joints() {
            self.bodies();
            self.state.hold_at_end();
        }
    }

    /// Brings the state that a step has reached at `time` seconds back onto the joints. Returns the impulse from outside.
    pub(super) fn project(&mut self, time: f64) -> FromOutside {
        let begin = self.begin;
        let bodies = self.bodies();
        if !bodies.prescribed.motions.is_empty() {
            bodies.prescribe(begin, time);
        }
        self.state.project(time)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use crate::Simulation;
    use crate::scene::Source;
    use crate::tick::State;

    /// Two gears close with 1 and 2.4 turns. Undoing 1 and 2 of them would open the pair by 0.4 of a turn, and both
    /// keep theirs. A free disc loses its turn, alone and beside them.
    #[test]
    fn full_turns_are_undone_unless_a_gear_needs_them() {
        let scene = "Scene(format: 1, clock: (duration: 1, tick: 1e-3),
            bodies: [(name: \"a\", at: (0, 0), atoms: Disc(radius: 0.1, mass: 1)),
                (name: \"b\", at: (1, 0), atoms: Disc(radius: 0.1, mass: 1)),
                (name: \"c\", at: (2, 0), atoms: Disc(radius: 0.1, mass: 1))],
            joints: [Revolute(name: \"ha\", a: World, b: \"a\"), Revolute(name: \"hb\", a: World, b: \"b\"),
                Revolute(name: \"hc\", a: World, b: \"c\"), GearPair(of: (\"ha\", \"hb\"), ratio: 2.4)])";
        for free in [0.0, 1.0] {
            let mut simulation = Simulation::load(&Source::new("gears.ron", scene)).unwrap_or_else(|e| panic!("{e}"));
            let mut state = simulation.world_mut().resource_mut::<State>();
            let before = state.bodies.angle.clone();
            for (angle, turns) in state.bodies.angle.iter_mut().zip([1.0, 2.4, free]) {
                *angle += turns * TAU;
            }
            let found = state.bodies.angle.clone();
            state.take_back_turns(&before);
            assert_eq!(state.bodies.angle[..2], found[..2]);
            assert!((state.bodies.angle[2] - before[2]).abs() < 1e-12, "{:?}", state.bodies.angle);
        }
    }
}
