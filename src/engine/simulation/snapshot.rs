//! Snapshots: a run saved between two ticks, to continue later, elsewhere, or several times.
//!
//! A snapshot holds all data that decides the future of a run, and all data of its card. It keeps them to the last bit.
//! It does not hold the scene. It continues in a run of the same scene, read by the same version with the same plugins.
//! The number of threads and the vector instructions may differ.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{Overrides, Simulation};
use crate::expect::Expectations;
use crate::scene::SceneErrors;
use crate::tick::snapshot::{UnfitSnapshot, Unsaved, recall};
use crate::tick::{Notes, State, kept, open, systems_of_users};
use jostle_language::digest;

/// The first bytes of a snapshot.
const MAGIC: &[u8; 16] = b"jostle snapshot\n";

/// Counts changes of what snapshots hold.
const FORMAT: u32 = 5;

/// A run between two ticks. See [`Simulation::snapshot`].
#[derive(Clone, PartialEq, Eq)]
pub struct Snapshot {
    header: Header,
    body: Vec<u8>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Header {
    /// The version of the engine.
    version: String,
    /// The digest of the scene's text with all that it includes.
    scene: u64,
    /// The plan of the run: method, tick, steps.
    plan: String,
    /// Systems of users in the tick.
    systems: Vec<String>,
    ticks: u64,
    /// The number of times that forces were evaluated so far.
    evaluations: u64,
}

#[derive(Serialize, Deserialize)]
struct Body {
    state: Vec<u8>,
    kept: Vec<Option<Vec<u8>>>,
    notes: Vec<String>,
    expectations: Vec<Option<Vec<u8>>>,
}

impl fmt::Debug for Snapshot {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "Snapshot(after {} ticks, {} bytes)", self.header.ticks, self.body.len())
    }
}

impl Snapshot {
    /// Ticks that the run had done.
    pub fn ticks(&self) -> u64 {
        self.header.ticks
    }

    /// As bytes for a file, with a checksum.
    pub fn to_bytes(&self) -> Vec<u8> {
        // A header of texts and numbers can always be written.
        let header = postcard::to_stdvec(&self.header).unwrap_or_default();
        let mut bytes = MAGIC.to_vec();
        bytes.extend(FORMAT.to_le_bytes());
        bytes.extend((header.len() as u64).to_le_bytes());
        bytes.extend(header);
        bytes.extend(&self.body);
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        bytes
    }

    /// From the bytes of a file.
    ///
    /// # Errors
    /// If the bytes are no snapshot, are damaged, or were written by another version.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, UnfitSnapshot> {
        let damaged = || UnfitSnapshot("the snapshot is damaged: its checksum is wrong".to_owned());
        let Some(rest) = bytes.strip_prefix(MAGIC) else { return Err(UnfitSnapshot("this is no snapshot".to_owned())) };
        let (format, _) = rest.split_first_chunk().ok_or_else(damaged)?;
        if u32::from_le_bytes(*format) != FORMAT {
            return Err(UnfitSnapshot("the snapshot was written by another version of jostle".to_owned()));
        }
        let (whole, sum) = bytes.split_last_chunk().ok_or_else(damaged)?;
        if crc32fast::hash(whole) != u32::from_le_bytes(*sum) {
            return Err(damaged());
        }
        let (length, rest) = whole[MAGIC.len() + 4..].split_first_chunk().ok_or_else(damaged)?;
        let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| damaged())?;
        let (header, body) = rest.split_at_checked(length).ok_or_else(damaged)?;
        Ok(Self { header: recall(header)?, body: body.to_vec() })
    }
}

/// Why a run cannot be forked.
#[derive(Debug)]
pub enum ForkError {
    /// It cannot be set down.
    Unsaved(Unsaved),
    /// Its scene is unreadable, because an included file has changed.
    Scene(SceneErrors),
    /// A run of its scene cannot continue from it. Bodies were spawned or removed, systems were added, or an included
    /// file has changed.
    Unfit(UnfitSnapshot),
}

impl fmt::Display for ForkError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Unsaved(why) => why.fmt(f),
            Self::Scene(why) => why.fmt(f),
            Self::Unfit(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for ForkError {}

impl Simulation {
    /// A second, independent run that continues from here with the same bits.
    ///
    /// The scene is read once more, which takes longer than the rest. For many rollouts from one state fork once for
    /// each thread. Then [`restore`](Self::restore) a snapshot in the forks as often as needed.
    ///
    /// # Errors
    /// As [`Simulation::snapshot`]; if bodies were spawned or removed, or systems added, since the scene was read.
    ///
    /// ```
    /// # extern crate jostle_engine as jostle;
    /// use jostle::{Simulation, scene::Source};
    ///
    /// let scene = r#"Scene(
    ///     format: 1,
    ///     clock: (duration: 2),
    ///     gravity: (0, -10),
    ///     bodies: [(name: "ball", at: (0, 5), atoms: Disc(radius: 0.1))],
    /// )"#;
    /// let mut simulation = Simulation::load(&Source::new("fall.ron", scene))?;
    /// simulation.run_to_tick(100)?;
    /// let mut fork = simulation.fork()?;
    /// simulation.run_to_end()?;
    /// fork.run_to_end()?;
    /// assert_eq!(fork.bodies().position, simulation.bodies().position);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn fork(&mut self) -> Result<Self, ForkError> {
        let snapshot = self.snapshot().map_err(ForkError::Unsaved)?;
        let bodies = self.bodies();
        let (level, threads) = (Some(bodies.level), Some(bodies.threads.count()));
        let overrides = Overrides { plan: self.plan().cloned(), level, threads, ..self.origin.overrides.clone() };
        let mut fork = Self::read(&self.origin, &overrides).map_err(ForkError::Scene)?;
        fork.restore(&snapshot).map_err(ForkError::Unfit)?;
        Ok(fork)
    }

    /// Saves the current run between two ticks.
    ///
    /// Systems of plugins that remember something of their own (`Local`) are not seen.
    ///
    /// # Errors
    /// If a model, an integrator, a resource or a component of a plugin does not declare its memory. Also after a
    /// failure.
    pub fn snapshot(&mut self) -> Result<Snapshot, Unsaved> {
        if self.failure.is_some() {
            return Err(Unsaved { name: "a run that went wrong".to_owned() });
        }
        if self.get_resource::<State>().is_some_and(|state| state.stopped_at().is_some()) {
            return Err(Unsaved { name: "a run that was ended inside a tick".to_owned() });
        }
        if !self.contains_resource::<State>() {
            return Err(Unsaved { name: "a world without its resource `State`".to_owned() });
        }
        let world = &mut self.world;
        open(world);
        let kept = kept::save(world)?;
        let state = world.resource::<State>().save()?;
        let notes = world.get_resource::<Notes>().map_or_else(Vec::new, |notes| notes.0.clone());
        let expectations = world.get_resource::<Expectations>().map_or(Ok(Vec::new()), Expectations::save)?;
        let body = postcard::to_stdvec(&Body { state, kept, notes, expectations }).unwrap_or_default();
        Ok(Snapshot { header: self.identity(), body })
    }

    /// Continues from a snapshot of the same scene, with the same bits as then. If it does not fit, nothing changes,
    /// unless a plugin's reader fails.
    ///
    /// # Errors
    /// If the snapshot is of another scene, version, method or tick, or the plugins are others.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), UnfitSnapshot> {
        if !self.contains_resource::<State>() {
            return Err(UnfitSnapshot("this run has lost its resource `State`: load the scene again".to_owned()));
        }
        open(&mut self.world);
        let Header { version, scene, plan, systems, .. } = self.identity();
        let of = &snapshot.header;
        if of.version != version {
            return Err(UnfitSnapshot(format!(
                "version {} wrote the snapshot, and this is version {version}",
                of.version
            )));
        }
        if of.scene != scene {
            return Err(UnfitSnapshot(
                "the snapshot is of another scene, or of another text of this one, be it only a comment".to_owned(),
            ));
        }
        if of.plan != plan {
            let words = |plan: &str| plan.split(" (").next().unwrap_or_default().to_owned();
            let (theirs, own) = (words(&of.plan), words(&plan));
            return Err(UnfitSnapshot(if theirs == own {
                format!(
                    "both runs go by {own}, but with other steps inside them. A tolerance chooses these from the whole run: \
                     give both runs the same tolerance and duration"
                )
            } else {
                format!("the snapshot's run goes by {theirs}, this one by {own}")
            }));
        }
        if of.systems != systems {
            let (theirs, own) = (of.systems.join(", "), systems.join(", "));
            return Err(UnfitSnapshot(format!(
                "the snapshot's run has other systems in the tick: [{theirs}] instead of [{own}]"
            )));
        }
        let Body { state, kept, notes, expectations } = recall(&snapshot.body)?;
        let world = &mut self.world;
        open(world);
        let mut present = world.resource_mut::<State>();
        present.load(&state, of.ticks)?;
        present.evaluation.count = of.evaluations;
        kept::load(world, &kept)?;
        world.insert_resource(Notes(notes));
        if let Some(mut own) = world.get_resource_mut::<Expectations>() {
            own.load(&expectations)?;
        }
        open(world);
        self.failure = None;
        Ok(())
    }

    /// A hash of all data that decides the future of the run. Two runs of a scene with the same hash continue alike.
    ///
    /// # Errors
    /// As [`Simulation::snapshot`].
    pub fn future_hash(&mut self) -> Result<u64, Unsaved> {
        Ok(digest::of_bytes(self.snapshot()?.body))
    }

    fn identity(&self) -> Header {
        let plan = self.plan().map_or_else(String::new, |plan| {
            let (pace, detail, events) = (plan.pace, plan.detail, plan.events);
            format!("{} with ticks of {:?} s ({pace:?}, {detail:?}, {events:?})", plan.method, plan.tick)
        });
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Header {
            version,
            scene: self.header.digest,
            plan,
            systems: systems_of_users(&self.world),
            ticks: self.clock().ticks,
            evaluations: self.state().evaluation.count,
        }
    }
}
