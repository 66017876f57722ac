//! The loads on bodies before the first tick: all forces but those of contacts.

use super::{Evaluation, EvaluationMode, Rates, State};
use crate::constraints::Row;
use crate::constraints::spring_network::Twist;

impl State {
    /// The force and torque on each body at the beginning of the run, without contacts and joints. It leaves no
    /// trace but the pose of the atoms.
    pub(crate) fn loads_at_start(&mut self, loads: &mut Vec<Twist>) {
        self.find_roles();
        let before = (self.evaluation, self.rates);
        self.evaluation = Evaluation { mode: EvaluationMode::Frozen, count: before.0.count, ..Evaluation::default() };
        self.rates = Rates::default();
        (self.bodies.posed, self.bodies.recorded) = (false, false);
        self.bodies.pose();
        self.rows.clear();
        let mut models = std::mem::take(&mut self.models);
        models[..self.roles.others].iter_mut().for_each(|model| model.apply_forces(self));
        self.models = models;
        self.rows.clear();
        (self.evaluation, self.rates) = before;
        self.bodies.posed = false;
        let forces = self.bodies.force.iter().zip(&self.bodies.torque);
        loads.clear();
        loads.extend(forces.map(|(&linear, &angular)| Twist { linear, angular }));
    }

    /// The rows of joints in the present places, before the first tick.
    pub(crate) fn joint_rows_at_start(&mut self) -> Vec<Row> {
        self.find_roles();
        self.rows.clear();
        self.add_joint_rows();
        let rows = self.rows.all().to_vec();
        self.rows.clear();
        self.bodies.jointed.clear();
        rows
    }

    /// The least distance of joints from where their modes end, before the first tick: below zero beyond a limit.
    pub(crate) fn least_room_at_start(&mut self) -> f64 {
        let (mut told, mut least) = (Vec::new(), f64::INFINITY);
        let mut models = std::mem::take(&mut self.models);
        for &index in self.roles.rows.iter().filter(|index| **index < self.roles.others) {
            let Some(events) = models[index].events() else { continue };
            told.clear();
            events.tell(self, &mut told);
            least = told.iter().map(|indicator| indicator.value + indicator.rounding).fold(least, f64::min);
        }
        self.models = models;
        least
    }
}
