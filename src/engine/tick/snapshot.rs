//! Serialisation of the state of a run: all data that decides its future, and all its results.
//!
//! Parameters are excluded, because they follow from the scene, which is read again. So only a run of the same scene
//! with the same models in the same order can load the bytes. Numbers are kept to the last bit.

use std::fmt;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::State;

/// The memory of a model or an integrator beside its parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Memory {
    /// The model does not declare its memory. A snapshot refuses, with its name.
    Untold,
    /// No memory: the parameters suffice.
    Nothing,
    /// These bytes, see [`Memory::of`].
    Bytes(Vec<u8>),
}

impl Memory {
    /// The memory that a value holds.
    pub fn of(value: &impl Serialize) -> Self {
        // Only lists of unknown length and values that refuse cannot be written: derived types have neither.
        postcard::to_stdvec(value).map_or(Self::Untold, Self::Bytes)
    }

    /// The bytes, if there is any memory.
    ///
    /// # Errors
    /// An error with the name if the memory is not declared.
    pub fn bytes(self, name: impl FnOnce() -> String) -> Result<Option<Vec<u8>>, Unsaved> {
        match self {
            Self::Untold => Err(Unsaved { name: name() }),
            Self::Nothing => Ok(None),
            Self::Bytes(bytes) => Ok(Some(bytes)),
        }
    }
}

/// Brings back what [`Memory::of`] wrote.
///
/// # Errors
/// If the bytes are those of another type.
pub fn recall<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, UnfitSnapshot> {
    match postcard::take_from_bytes(bytes) {
        Ok((value, [])) => Ok(value),
        Ok(_) => Err(UnfitSnapshot("there are more bytes than this version writes".to_owned())),
        Err(_) => Err(UnfitSnapshot("the bytes are not those that this version writes".to_owned())),
    }
}

/// Why a state cannot be saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unsaved {
    /// The name of the type that does not declare its memory.
    pub name: String,
}

impl fmt::Display for Unsaved {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "`{}` does not say what it remembers", self.name)
    }
}

impl std::error::Error for Unsaved {}

/// Why bytes do not fit a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnfitSnapshot(pub String);

impl fmt::Display for UnfitSnapshot {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for UnfitSnapshot {}

/// Demands that a part of a snapshot fits the run that reads it.
///
/// # Errors
/// If it does not, with the name of the part and the remedy.
pub fn demand(fits: bool, part: &str) -> Result<(), UnfitSnapshot> {
    if fits {
        return Ok(());
    }
    Err(UnfitSnapshot(format!("{part} do not fit this run. Write the snapshot again with this program and this scene")))
}

/// The parts of a saved state.
#[derive(Serialize, Deserialize)]
struct Saved {
    state: Vec<u8>,
    method: Option<Vec<u8>>,
    models: Vec<Option<Vec<u8>>>,
}

impl State {
    /// All of the run as bytes. The world must be open.
    pub(crate) fn save(&self) -> Result<Vec<u8>, Unsaved> {
        let method = self.progress.method.as_ref().map_or(Memory::Nothing, |method| method.0.save());
        let bytes = |memory: Memory| memory.bytes(|| "State".to_owned()).map(Option::unwrap_or_default);
        let saved = Saved {
            state: bytes(Memory::of(self))?,
            method: method.bytes(|| "the integrator".to_owned())?,
            models: self
                .models
                .iter()
                .map(|model| model.save().bytes(|| model.name().to_owned()))
                .collect::<Result<_, _>>()?,
        };
        bytes(Memory::of(&saved))
    }

    /// Goes on from bytes of [`State::save`], in a run of the same scene. The world must be open; components follow. If
    /// the bytes do not fit, the state is as before. `ticks` are those of the run that was saved.
    pub(crate) fn load(&mut self, bytes: &[u8], ticks: u64) -> Result<(), UnfitSnapshot> {
        let (before, own) = (self.save(), self.clock.ticks);
        let loaded = self.take_up(bytes, ticks);
        if let (Err(_), Ok(before)) = (&loaded, before) {
            self.take_up(&before, own)?;
        }
        loaded
    }

    fn take_up(&mut self, bytes: &[u8], ticks: u64) -> Result<(), UnfitSnapshot> {
        let Saved { state, method, models } = recall(bytes)?;
        let state: Self = recall(&state)?;
        self.demand_same_bodies(&state)?;
        demand(state.clock.ticks == ticks, "the ticks of the clock")?;
        self.demand_fit(&state)?;
        if models.len() != self.models.len() {
            return Err(UnfitSnapshot(format!("it has {} models, this run {}", models.len(), self.models.len())));
        }
        for (model, bytes) in self.models.iter_mut().zip(&models) {
            if let Some(bytes) = bytes {
                model.load(bytes).map_err(|UnfitSnapshot(why)| UnfitSnapshot(format!("{}: {why}", model.name())))?;
            }
        }
        if let (Some(method), Some(bytes)) = (&mut self.progress.method, &method) {
            method.0.load(bytes)?;
        }
        self.take_over(state);
        for model in &self.models {
            model.fits(self).map_err(|UnfitSnapshot(why)| UnfitSnapshot(format!("{}: {why}", model.name())))?;
        }
        self.progress.method.as_ref().map_or(Ok(()), |method| method.0.fits(self))
    }

    fn demand_same_bodies(&self, other: &Self) -> Result<(), UnfitSnapshot> {
        let (own, others) = (&self.bodies, &other.bodies);
        let same =
            own.entity == others.entity && Memory::of(&own.key) == Memory::of(&others.key) && own.walls == others.walls;
        let accounts = self.ledger.accounts.len() == other.ledger.accounts.len();
        if same && accounts {
            Ok(())
        } else {
            Err(UnfitSnapshot("it has other bodies, walls or accounts than this run".to_owned()))
        }
    }

    /// Takes over another state, except for the parts that belong to this process.
    fn take_over(&mut self, other: Self) {
        let Self { bodies, progress, models, roles, outside, stopwatch, ledger, .. } = std::mem::replace(self, other);
        (self.bodies.level, self.bodies.threads) = (bodies.level, bodies.threads);
        self.bodies.counts = bodies.counts;
        (self.models, self.roles, self.outside, self.stopwatch) = (models, roles, outside, stopwatch);
        for (account, (name, _)) in self.ledger.accounts.iter_mut().zip(ledger.accounts) {
            account.0 = name;
        }
        let own = &mut self.progress;
        (own.method, own.version, own.shown, own.shown_at) =
            (progress.method, progress.version + 1, progress.shown, progress.shown_at);
        (own.alone, own.looked_at, own.forces_read) = (progress.alone, progress.looked_at, progress.forces_read);
        (own.published_at, own.behind) = (progress.published_at, true);
    }
}
