//! The loads on bodies before the first tick: all forces but those of contacts.

use super::{Evaluation, EvaluationMode, Rates, State};
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

    /// For each body whether a joint holds it at the start; empty without joints.
    pub(crate) fn jointed_at_start(&mut self) -> Vec<bool> {
        self.find_roles();
        self.rows.clear();
        self.add_joint_rows();
        self.rows.clear();
        std::mem::take(&mut self.bodies.jointed)
    }
}
