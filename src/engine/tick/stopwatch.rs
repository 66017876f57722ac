//! A stopwatch for the parts of a tick. It measures only runs for which [`watch`] was called.

use std::time::{Duration, Instant};

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, Schedules};

use super::{Evaluate, Modes, SimTick, State};

/// Parts of a tick, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TickPart {
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

impl TickPart {
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
    part: TickPart,
    since: Instant,
    spent: [Duration; TickPart::ALL.len()],
}

impl Stopwatch {
    /// The time spent in a part.
    pub fn spent(&self, part: TickPart) -> Duration {
        self.spent[part as usize]
    }

    /// Counts the time from here on for another part.
    pub(super) fn turn_to(&mut self, part: TickPart) {
        let now = Instant::now();
        self.spent[self.part as usize] += now - self.since;
        (self.part, self.since) = (part, now);
    }
}

/// Starts to measure the ticks of a world. It reads the clock before and after each stage.
pub fn watch(world: &mut World) {
    let now =
        Stopwatch { part: TickPart::Between, since: Instant::now(), spent: [Duration::ZERO; TickPart::ALL.len()] };
    world.resource_mut::<State>().stopwatch = Some(now);
}

/// The names of the systems and models of each part, in the order in which they run. Only a world that has run at least
/// one tick has them.
pub fn systems(world: &World) -> Vec<(TickPart, Vec<String>)> {
    let Some(schedules) = world.get_resource::<Schedules>() else { return Vec::new() };
    let mut parts: Vec<(TickPart, Vec<String>)> = TickPart::ALL.map(|part| (part, Vec::new())).to_vec();
    for (label, first) in
        [(SimTick.intern(), TickPart::Begin), (Modes.intern(), TickPart::Modes), (Evaluate.intern(), TickPart::Bounds)]
    {
        let mut part = first;
        let Some(Ok(systems)) = schedules.get(label).map(|schedule| schedule.systems()) else { continue };
        for (_, system) in systems {
            let name = system.name().to_string();
            part = part_of(&name).unwrap_or(part);
            parts[part as usize].1.push(name);
            // Systems behind the integrator observe.
            if part == TickPart::Integrate {
                part = TickPart::Observe;
            }
        }
    }
    let state = world.resource::<State>();
    for model in state.models() {
        let part = match (state.law_of(model), model.finds_pairs()) {
            (Some(_), _) => TickPart::Contacts,
            (None, true) => TickPart::Pairs,
            (None, false) => TickPart::Forces,
        };
        parts[part as usize].1.push(model.name().to_owned());
    }
    parts
}

/// The part to which a stage of the engine belongs, by the name of its system.
fn part_of(name: &str) -> Option<TickPart> {
    let parts = [
        ("tick::stages::begin_step", TickPart::Modes),
        ("tick::stages::update_bounding_boxes", TickPart::Bounds),
        ("tick::stages::apply_forces", TickPart::Forces),
        ("tick::stages::solve_constraints", TickPart::Constraints),
        ("tick::stages::settle", TickPart::Settle),
        ("tick::step::integrate", TickPart::Integrate),
        ("tick::step::integrate_among_systems", TickPart::Integrate),
    ];
    parts.into_iter().find(|(end, _)| name.ends_with(end)).map(|(_, part)| part)
}
