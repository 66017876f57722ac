//! Blows: jumps of velocities when joints reach limits, ropes become taut, friction sticks, or motors reach their
//! rates.

use super::State;
use super::stabilisation::{FromOutside, find_rows};
use crate::constraints::{Row, Rows};
use crate::world::Bodies;

/// A jump of velocities.
#[derive(Clone, Debug, PartialEq)]
pub enum Blow {
    /// They become velocities that all joints allow, except for rows that give way. The energy counts as inelasticity.
    Stops,
    /// The same with a row whose rate is part of that, without force from then on.
    Rebounds(Box<Row>),
    /// They become those that all rows allow. The energy counts as friction.
    Sticks,
    /// The same for a motor that has reached its rate: the energy counts as its work.
    Grips,
}

/// Which rows velocities jump to.
#[derive(Clone, Copy, Debug)]
pub(super) enum Jump<'a> {
    /// Those without a bound, and these.
    Stops(&'a [Row]),
    /// All but those with these indices.
    Sticks(&'a [usize]),
}

/// A bounded row may need this many times the impulse of its bound in a tick to stick. In the tick before, it gave its
/// bound, and the driving force at most as much again.
const MOST_TO_STICK: f64 = 2.0;

/// A rate counts as held if its deviation is below this share of the speeds.
const STUCK: f64 = 1e-12;

/// A share of the greatest impulse, or of speeds, that is rounding.
const NO_PULL: f64 = 1e-12;

impl State {
    /// From [`Model::begin_step`](super::Model::begin_step): before the step begins, velocities jump, and places with them.
    pub fn strike(&mut self, blow: Blow) {
        let by = self.roles.begin_step.get(self.acting).copied().unwrap_or(usize::MAX);
        self.blows.push((by, blow));
    }

    /// Changes velocities by jumps, for models that request it.
    pub(super) fn take_blows(&mut self, time: f64) {
        if self.blows.is_empty() {
            return;
        }
        self.bodies.catch_up();
        let mut blows = std::mem::take(&mut self.blows);
        self.break_joints(time, &mut blows);
        let blows: Vec<Blow> = blows.into_iter().map(|(_, blow)| blow).collect();
        let (sticks, grips) = (blows.contains(&Blow::Sticks), blows.contains(&Blow::Grips));
        let back = |blow: &Blow| if let Blow::Rebounds(row) = blow { Some(**row) } else { None };
        let back: Vec<Row> = blows.iter().filter_map(back).collect();
        if blows.iter().any(|blow| !matches!(blow, Blow::Sticks | Blow::Grips)) {
            let lost = self.jump(time, Jump::Stops(&back));
            self.ledger.inelasticity.add(lost);
            self.tell_of_blow();
        }
        if sticks || grips {
            let slip = self.rows_that_slip(time);
            let lost = self.jump(time, Jump::Sticks(&slip));
            if sticks {
                self.ledger.friction.add(lost)
            } else {
                self.ledger.book_work(-lost)
            }
            if !slip.is_empty() {
                self.tell_of_blow();
            }
        }
        self.change_rows();
    }

    /// The indices of the rows with a bound that do not stick. Each is tried alone among the rows without a bound. It
    /// slips if it would need more impulse to hold its rate than its bound gives in a tick. If the rate of a joint
    /// changes its sign while the others move on, its friction reverses.
    fn rows_that_slip(&mut self, time: f64) -> Vec<usize> {
        let most = MOST_TO_STICK * self.clock.dt;
        let mut rows = Rows::default();
        let Self { models, roles, bodies, projection, .. } = self;
        find_rows(models, &roles.rows, (bodies, time), &mut rows);
        let all = rows.all().iter().copied().enumerate();
        let bounded: Vec<(usize, Row)> = all.filter(|(_, row)| row.gives_way()).collect();
        rows.retain(|row| !row.gives_way());
        let driven = rows.all().iter().chain(bounded.iter().map(|(_, row)| row)).any(|row| row.rate != 0.0);
        let (others, solver) = rows.prepared(bodies);
        let missing = |row: &Row| (row.rate - row.velocity(bodies)).abs();
        let held = |row: &Row| missing(row) <= STUCK * row.speeds(bodies);
        let mut slips = |row: &Row| {
            !held(row) && missing(row) > most * row.bound * projection.compliance(row, others, solver, bodies)
        };
        let (mut slip, mut stick): (Vec<_>, Vec<_>) = bounded.into_iter().partition(|(_, row)| slips(row));
        if driven {
            // Two rates that follow from each other and disagree are not held both. The one that was held before stays.
            stick.iter().filter(|(_, row)| held(row)).for_each(|(_, row)| rows.add(*row));
            stick.retain(|(_, row)| !held(row));
            for (index, row) in stick {
                let (others, solver) = rows.prepared(bodies);
                if projection.compliance(&row, others, solver, bodies) > 0.0 {
                    rows.add(row);
                } else {
                    slip.push((index, row));
                }
            }
        }
        slip.into_iter().map(|(index, _)| index).collect()
    }

    /// Velocities jump to those that rows allow. Returns the energy in J that this takes.
    fn jump(&mut self, time: f64, jump: Jump) -> f64 {
        let kinetic = |bodies: &Bodies| (0..bodies.len()).map(|body| bodies.kinetic_energy(body)).sum::<f64>();
        let before = kinetic(&self.bodies);
        let outside = self.project_with(time, Some(jump));
        outside.book(&mut self.ledger);
        self.ledger.book_work(outside.work);
        before + outside.work - kinetic(&self.bodies)
    }

    /// The same in a blow: rows that only push give no impulse that pulls. The row that would pull most is released,
    /// then the next. A released row is held again if its bodies would move beyond it. These are the active sets of
    /// Nocedal and Wright, *Numerical Optimization*, 2006, 16.5. Also returns the impulses, with the places of their rows at the
    /// beginning.
    pub(super) fn push_apart(&mut self, rows: &mut Rows, time: f64) -> (FromOutside, Vec<(usize, f64)>) {
        let most = 4 * rows.all().iter().filter(|row| row.pushes != 0.0).count();
        let before = (most > 0).then(|| (self.bodies.velocity.clone(), self.bodies.spin.clone()));
        let mut free: Vec<(usize, Row)> = Vec::new();
        let mut places: Vec<usize> = (0..rows.len()).collect();
        let (mut impulses, mut changes) = (Vec::new(), 0);
        loop {
            impulses.clear();
            impulses.resize(rows.len(), 0.0);
            let (outside, refused) = self.change_velocities(rows, |row, impulse| impulses[row] += impulse);
            let greatest = impulses.iter().fold(0.0_f64, |most, impulse| most.max(impulse.abs()));
            let pulls = rows.all().iter().zip(&impulses).map(|(row, impulse)| -row.pushes * impulse).enumerate();
            let worst = pulls.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, pull)| *pull > NO_PULL * greatest);
            let goes_on = |row: &Row| row.pushes * row.velocity(&self.bodies) < -NO_PULL * row.speeds(&self.bodies);
            let again = free.iter().position(|(_, row)| goes_on(row));
            match (worst, again) {
                (Some((worst, _)), _) if changes < most => {
                    free.push((places.remove(worst), rows.all()[worst]));
                    let mut indices = 0..;
                    rows.retain(|_| indices.next() != Some(worst));
                }
                (None, Some(again)) if changes < most => {
                    let (place, row) = free.remove(again);
                    places.push(place);
                    rows.add(row);
                }
                _ => {
                    self.note_contradiction(refused, rows, time);
                    return (outside, places.into_iter().zip(impulses).collect());
                }
            }
            changes += 1;
            if let Some((velocity, spin)) = &before {
                self.bodies.velocity.clone_from(velocity);
                self.bodies.spin.clone_from(spin);
            }
        }
    }
}
