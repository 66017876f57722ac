//! A stopwatch for the parts of a tick. It measures only runs for which [`watch`] was called.

use std::time::{Duration, Instant};

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, Schedules};

use super::{Evaluate, Modes, SimTick, State};

/// Parts of a tick, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// [`Stage::Begin`](super::Stage::Begin).
    Begin,
    /// [`Modes`]: all models but contact laws.
    Modes,
    /// The same schedule: contact laws, which look for the forces that keep bodies at rest.
    Rest,
    /// [`EvaluateStage::Bounds`](super::EvaluateStage::Bounds): bounding boxes.
    Bounds,
    /// The same stage: the search for candidate pairs.
    Pairs,
    /// [`EvaluateStage::Forces`](super::EvaluateStage::Forces): all models but contact laws.
    Forces,
    /// The same stage: contact laws.
    Contacts,
    /// [`EvaluateStage::Constraints`](super::EvaluateStage::Constraints).
    Constraints,
    /// [`EvaluateStage::Settle`](super::EvaluateStage::Settle).
    Settle,
    /// The rest of [`Stage::Integrate`](super::Stage::Integrate): the integrator itself.
    Integrate,
    /// [`Stage::Observe`](super::Stage::Observe).
    Observe,
    /// Between two ticks.
    Between,
}

impl Part {
    /// All parts of a tick, in order.
    pub const ALL: [Self; 12] = [
        Self::Begin,
        Self::Modes,
        Self::Rest,
        Self::Bounds,
        Self::Pairs,
        Self::Forces,
        Self::Contacts,
        Self::Constraints,
        Self::Settle,
        Self::Integrate,
        Self::Observe,
        Self::Between,
    ];

    /// The name of its schedule and stage.
    pub fn name(self) -> &'static str {
        match self {
            Self::Begin => "Begin",
            Self::Modes => "Modes",
            Self::Rest => "Modes: search for rest",
            Self::Bounds => "Evaluate: Bounds",
            Self::Pairs => "Evaluate: Pairs",
            Self::Forces => "Evaluate: Forces",
            Self::Contacts => "Evaluate: Contacts",
            Self::Constraints => "Evaluate: Constraints",
            Self::Settle => "Evaluate: Settle",
            Self::Integrate => "Integrate",
            Self::Observe => "Observe",
            Self::Between => "between ticks",
        }
    }
}

/// The time spent in each part of the ticks so far.
#[derive(Clone, Debug)]
pub struct Stopwatch {
    part: Part,
    since: Instant,
    spent: [Duration; Part::ALL.len()],
}

impl Stopwatch {
    /// The time spent in a part.
    pub fn spent(&self, part: Part) -> Duration {
        self.spent[part as usize]
    }

    /// Counts the time from here on for another part.
    pub(super) fn turn_to(&mut self, part: Part) {
        let now = Instant::now();
        self.spent[self.part as usize] += now - self.since;
        (self.part, self.since) = (part, now);
    }
}

/// Starts to measure the ticks of a world. It reads the clock before and after each stage.
pub fn watch(world: &mut World) {
    let now = Stopwatch { part: Part::Between, since: Instant::now(), spent: [Duration::ZERO; Part::ALL.len()] };
    world.resource_mut::<State>().stopwatch = Some(now);
}

/// The names of the systems and models of each part, in the order in which they run. Only a world that has run at least
/// one tick has them.
pub fn systems(world: &World) -> Vec<(Part, Vec<String>)> {
    let Some(schedules) = world.get_resource::<Schedules>() else { return Vec::new() };
    let mut parts: Vec<(Part, Vec<String>)> = Part::ALL.map(|part| (part, Vec::new())).to_vec();
    for (label, first) in
        [(SimTick.intern(), Part::Begin), (Modes.intern(), Part::Modes), (Evaluate.intern(), Part::Bounds)]
    {
        let mut part = first;
        let Some(Ok(systems)) = schedules.get(label).map(|schedule| schedule.systems()) else { continue };
        for (_, system) in systems {
            let name = system.name().to_string();
            part = part_of(&name).unwrap_or(part);
            parts[part as usize].1.push(name);
            // Systems behind the integrator observe.
            if part == Part::Integrate {
                part = Part::Observe;
            }
        }
    }
    let state = world.resource::<State>();
    for model in state.models() {
        let part = match (model.contact_law(), model.finds_pairs()) {
            (Some(_), _) => Part::Contacts,
            (None, true) => Part::Pairs,
            (None, false) => Part::Forces,
        };
        parts[part as usize].1.push(model.name().to_owned());
    }
    parts
}

/// The part to which a stage of the engine belongs, by the name of its system.
fn part_of(name: &str) -> Option<Part> {
    let parts = [
        ("tick::stages::begin_step", Part::Modes),
        ("tick::stages::update_bounding_boxes", Part::Bounds),
        ("tick::stages::apply_forces", Part::Forces),
        ("tick::stages::solve_constraints", Part::Constraints),
        ("tick::stages::settle", Part::Settle),
        ("tick::step::integrate", Part::Integrate),
        ("tick::step::integrate_among_systems", Part::Integrate),
    ];
    parts.into_iter().find(|(end, _)| name.ends_with(end)).map(|(_, part)| part)
}
