//! Names that most programs and plugins need: `use jostle::prelude::*`.

pub use crate::cli::main_with;
pub use crate::record::{FilmAppExt, Layer, Mark, MarkShape};
pub use crate::report::{Card, SimulationExt};
pub use crate::scene::values::Names;
pub use crate::scene::{
    Diagnostics, Entry, NameKind, Outline, SceneAppExt, SceneErrors, Section, Source, WrittenEntry,
};
pub use crate::sensors::{Channel, Channels, SensorAppExt};
pub use crate::simulation::{Overrides, Recorder, Simulation};
pub use crate::tick::kept::SnapshotAppExt;
pub use crate::tick::{Energies, Evaluate, Model, SimTick, Stage, State, TickAppExt};
pub use crate::world::{Bodies, Body, Force, Name, Position, Velocity};
