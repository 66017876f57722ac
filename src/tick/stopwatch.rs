//! Where the time of a tick goes: systems between the stages that look at the clock. They are there only for who asks
//! with [`watch`]; a run that nobody watches has none of them.

use std::time::{Duration, Instant};

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, Schedules};

use super::registered::{Registered, register};
use super::{Evaluate, EvaluateStage, FindPairs, Modes, SearchPairs, SimTick, Stage};

/// Parts of a tick, in the order in which it goes through them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// [`Stage::Begin`].
    Begin,
    /// [`EvaluateStage::Forces`] of [`Modes`].
    ModesOfForces,
    /// [`EvaluateStage::Contacts`] of [`Modes`].
    ModesOfContacts,
    /// [`EvaluateStage::Bounds`].
    Bounds,
    /// [`EvaluateStage::Forces`].
    Forces,
    /// The search for pairs in [`EvaluateStage::Contacts`].
    Search,
    /// What is left of [`EvaluateStage::Contacts`]: contact laws.
    Contacts,
    /// [`EvaluateStage::Joints`].
    Joints,
    /// What is left of [`Stage::Integrate`]: the integrator itself.
    Integrate,
    /// [`Stage::Observe`].
    Observe,
    /// Between two ticks.
    Between,
}

impl Part {
    /// All parts of a tick, in order.
    pub const ALL: [Self; 11] = [
        Self::Begin,
        Self::ModesOfForces,
        Self::ModesOfContacts,
        Self::Bounds,
        Self::Forces,
        Self::Search,
        Self::Contacts,
        Self::Joints,
        Self::Integrate,
        Self::Observe,
        Self::Between,
    ];

    /// The name of its schedule and stage.
    pub fn name(self) -> &'static str {
        match self {
            Self::Begin => "Begin",
            Self::ModesOfForces => "Modes: Forces",
            Self::ModesOfContacts => "Modes: Contacts",
            Self::Bounds => "Evaluate: Bounds",
            Self::Forces => "Evaluate: Forces",
            Self::Search => "Evaluate: Search",
            Self::Contacts => "Evaluate: Contacts",
            Self::Joints => "Evaluate: Joints",
            Self::Integrate => "Integrate",
            Self::Observe => "Observe",
            Self::Between => "between ticks",
        }
    }
}

/// The time spent in each part of the ticks so far.
#[derive(Resource, Clone, Debug)]
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

    /// From now on the time counts for another part.
    pub(super) fn turn_to(&mut self, part: Part) {
        let now = Instant::now();
        self.spent[self.part as usize] += now - self.since;
        (self.part, self.since) = (part, now);
    }
}

/// A system that counts the time from now on for the part of that number.
fn turn_to<const PART: usize>(mut watch: ResMut<Stopwatch>) {
    watch.turn_to(Part::ALL[PART]);
}

const BEGIN: usize = Part::Begin as usize;
const MODES_OF_FORCES: usize = Part::ModesOfForces as usize;
const MODES_OF_CONTACTS: usize = Part::ModesOfContacts as usize;
const BOUNDS: usize = Part::Bounds as usize;
const FORCES: usize = Part::Forces as usize;
const SEARCH: usize = Part::Search as usize;
const CONTACTS: usize = Part::Contacts as usize;
const JOINTS: usize = Part::Joints as usize;
const INTEGRATE: usize = Part::Integrate as usize;
const OBSERVE: usize = Part::Observe as usize;
const BETWEEN: usize = Part::Between as usize;

/// Measures the ticks of a world from now on: to be called once, before the first of them. It costs a look at the clock
/// before and after each stage.
pub fn watch(world: &mut World) {
    use EvaluateStage as Of;
    let now = Stopwatch { part: Part::Between, since: Instant::now(), spent: [Duration::ZERO; Part::ALL.len()] };
    world.insert_resource(now);
    let in_tick = (
        turn_to::<BEGIN>.before(Stage::Begin),
        turn_to::<INTEGRATE>.after(Stage::Begin).before(Stage::Integrate),
        turn_to::<OBSERVE>.after(Stage::Integrate).before(Stage::Observe),
        turn_to::<BETWEEN>.after(Stage::Observe),
    );
    let in_evaluation = (
        turn_to::<BOUNDS>.before(Of::Bounds),
        turn_to::<FORCES>.after(Of::Bounds).before(Of::Forces),
        turn_to::<SEARCH>.after(Of::Forces).before(Of::Contacts),
        // Laws run after all that finds pairs.
        turn_to::<CONTACTS>.in_set(Of::Contacts).in_set(FindPairs).after(SearchPairs),
        turn_to::<JOINTS>.after(Of::Contacts).before(Of::Joints),
        turn_to::<INTEGRATE>.after(Of::Joints),
    );
    let in_modes = (
        turn_to::<MODES_OF_FORCES>.before(Of::Forces),
        turn_to::<MODES_OF_CONTACTS>.after(Of::Forces).before(Of::Contacts),
        turn_to::<INTEGRATE>.after(Of::Contacts),
    );
    let mark = Registered::mark(world);
    register(world, SimTick, true, |schedule| {
        schedule.add_systems(in_tick);
    });
    register(world, Evaluate, true, |schedule| {
        schedule.add_systems(in_evaluation);
    });
    // A schedule without systems is not run at all.
    if world.resource::<Schedules>().get(Modes).is_some_and(|schedule| !schedule.graph().systems.is_empty()) {
        register(world, Modes, true, |schedule| {
            schedule.add_systems(in_modes);
        });
    }
    // Direct forms tell the time on their own.
    Registered::cover(world, mark);
}

/// The names of the systems of each part, in the order in which they run. Only a world that is watched and has run at least
/// one tick knows it.
pub fn systems(world: &World) -> Vec<(Part, Vec<String>)> {
    let Some(schedules) = world.get_resource::<Schedules>() else { return Vec::new() };
    let mut parts: Vec<(Part, Vec<String>)> = Part::ALL.map(|part| (part, Vec::new())).to_vec();
    let own = |name: &str| {
        let number = name.strip_prefix(concat!(module_path!(), "::turn_to<"))?.strip_suffix('>')?;
        // A number of type usize may be written with its type.
        number.trim_end_matches("usize").parse::<usize>().ok()
    };
    for label in [SimTick.intern(), Modes.intern(), Evaluate.intern()] {
        let mut part = Part::Between as usize;
        let Some(Ok(systems)) = schedules.get(label).map(|schedule| schedule.systems()) else { continue };
        for (_, system) in systems {
            let name = system.name().to_string();
            match own(&name) {
                Some(number) => part = number.min(parts.len() - 1),
                None => parts[part].1.push(name),
            }
        }
    }
    parts
}
