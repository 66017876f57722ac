//! Contact laws from outside: models beside which the engine keeps that they are contact laws, and under which name.
//!
//! The law itself stands in the list of models, not a wrapper around it. So no method of it can be lost.

use std::any::{Any, TypeId};

use super::State;
use super::model::{Energies, Model};
use super::steady::SteadySpring;

/// The contact laws from outside.
#[derive(Default)]
pub(super) struct OutsideLaws {
    /// The types of models that are contact laws, with their names in scenes.
    names: Vec<(TypeId, &'static str)>,
    /// Models look at the end of a tick: one of them is not in its place.
    pub acting: bool,
}

impl OutsideLaws {
    /// The name of the contact law that a model is, if it is one.
    pub fn law_of(&self, model: &dyn Model) -> Option<&'static str> {
        let own: &dyn Any = model;
        let named = || self.names.iter().find(|(id, _)| *id == own.type_id()).map(|(_, name)| *name);
        model.contact_law().or_else(named)
    }
}

impl State {
    /// Adds a contact law from outside, with its name in scenes.
    pub(crate) fn add_contact_law<L: Model>(&mut self, law: L, name: &'static str) {
        self.outside.names.push((TypeId::of::<L>(), name));
        self.add_model(law);
    }

    /// The name of the contact law that a model is, if it is one.
    pub fn law_of(&self, model: &dyn Model) -> Option<&'static str> {
        self.outside.law_of(model)
    }

    /// Models look at the state at the end of a tick. Each sees the others in it.
    pub(super) fn show_to_models(&mut self) {
        if self.roles.end_tick.is_empty() {
            return;
        }
        self.outside.acting = true;
        for number in 0..self.roles.end_tick.len() {
            let index = self.roles.end_tick[number];
            let mut model = std::mem::replace(&mut self.models[index], Box::new(Vacant));
            model.end_tick(self);
            self.models[index] = model;
        }
        self.outside.acting = false;
    }
}

/// The place of a model that looks at the state.
struct Vacant;

impl Model for Vacant {
    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}
}
