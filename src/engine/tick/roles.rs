//! The models of each stage, found when the list of models changes.

use super::model::{Dependence, Model};
use super::outside::OutsideLaws;

/// The roles of models, which do not change while they act.
#[derive(Default)]
pub(super) struct Roles {
    /// Places of those that take part in a stage.
    pub find_pairs: Vec<usize>,
    pub rows: Vec<usize>,
    pub settle: Vec<usize>,
    pub begin_step: Vec<usize>,
    pub end_tick: Vec<usize>,
    pub events: Vec<usize>,
    pub edges: Vec<usize>,
    /// Places of models with an account of their own, and of that account in the ledger.
    pub accounts: Vec<(usize, usize)>,
    /// The number of those that are neither contact laws nor their search for pairs; those follow.
    pub others: usize,
    pub velocity_dependent: bool,
    pub velocity_forces: bool,
    /// Whether forces depend on velocities where rows of joints do not.
    pub velocity_beside_joints: bool,
    pub changing_forces: bool,
    pub flies: bool,
    /// The fastest angular frequency in rad/s at which a force oscillates in time; zero if none does.
    pub rhythm: f64,
    /// [`Progress::version`] for which all of this was found out.
    pub version: Option<u64>,
}

impl Roles {
    pub fn of(models: &mut [Box<dyn Model>], outside: &OutsideLaws) -> Self {
        let with_events = models.iter_mut().enumerate().filter_map(|(index, model)| model.events().map(|_| index));
        let events = with_events.collect();
        let indices = |is: fn(&dyn Model) -> bool| -> Vec<usize> {
            models.iter().enumerate().filter(|(_, model)| is(&***model)).map(|(index, _)| index).collect()
        };
        let others = models.iter().filter(|model| !belongs_to_contacts(&***model, outside)).count();
        let depends =
            |models: &[Box<dyn Model>], on: &[Dependence]| models.iter().any(|m| on.contains(&m.dependence()));
        Self {
            find_pairs: indices(|model| model.finds_pairs()),
            rows: indices(|model| model.has_rows()),
            settle: indices(|model| model.settles()),
            begin_step: indices(|model| model.has_modes()),
            end_tick: indices(|model| model.looks_at_ticks()),
            events,
            edges: indices(|model| model.has_edges()),
            accounts: Vec::new(),
            others,
            velocity_dependent: depends(models, &[Dependence::Velocity]),
            velocity_beside_joints: models
                .iter()
                .filter(|model| !model.has_rows() || outside.law_of(&***model).is_some())
                .any(|model| model.dependence() == Dependence::Velocity),
            velocity_forces: depends(&models[..others], &[Dependence::Velocity]),
            changing_forces: depends(&models[..others], &[Dependence::Velocity, Dependence::Position]),
            flies: models.iter().all(|model| model.flies()),
            rhythm: models.iter().filter_map(|model| model.rhythm()).map(|r| r.angular_frequency).fold(0.0, f64::max),
            version: None,
        }
    }
}

/// Whether a model is a contact law, or the search for pairs that contact laws go by: these act last.
pub(super) fn belongs_to_contacts(model: &dyn Model, outside: &OutsideLaws) -> bool {
    outside.law_of(model).is_some() || model.finds_pairs()
}
