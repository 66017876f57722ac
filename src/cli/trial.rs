//! The end of one of many runs: a word with the reason.

use crate::SimulationExt;
use std::path::PathBuf;

use super::Exit;
use crate::expect::ExpectationOutcome;
use crate::scene::{SceneErrors, visible_line};
use crate::simulation::Simulation;
use crate::tick::Failure;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It meets its expectations, or has none.
    Good,
    /// It breaks an expectation.
    Broken,
    /// The scene is wrong.
    Refused,
    /// The run failed.
    Failed,
}

impl Verdict {
    /// Every verdict, the best first.
    pub const ALL: [Self; 4] = [Self::Good, Self::Broken, Self::Refused, Self::Failed];

    /// The word in tables and JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Broken => "broken",
            Self::Refused => "refused",
            Self::Failed => "failed",
        }
    }

    /// The end of a command that made this run.
    pub fn exit(self) -> Exit {
        match self {
            Self::Good => Exit::Good,
            Self::Broken | Self::Refused => Exit::SceneWrong,
            Self::Failed => Exit::RunWrong,
        }
    }
}

/// A run that is over.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub verdict: Verdict,
    /// The reason for which it is not good, in a line; empty if it is.
    pub reason: String,
    /// The mistakes of a scene that was refused.
    pub errors: Option<SceneErrors>,
    pub expect: Vec<ExpectationOutcome>,
    /// Whether the run came to its end. Otherwise expectations speak of a part of it at most.
    pub completed: bool,
    pub warnings: Vec<String>,
    /// The hash of the last state.
    pub hash: Option<String>,
    /// Seconds spent computing.
    pub seconds: f64,
    /// The files that were read for it, except the scene's own.
    pub files: Vec<PathBuf>,
}

impl Trial {
    /// The result of a wrong scene.
    pub fn refused(errors: SceneErrors) -> Self {
        let first = errors.errors().first();
        let line = |error: &crate::scene::SceneError| {
            let path = if error.path.is_empty() { String::new() } else { format!("{}: ", error.path) };
            format!("{path}{}", error.message)
        };
        let mut reason = first.map_or_else(String::new, line);
        if errors.errors().len() > 1 {
            reason.push_str(&format!(" (and {} more)", errors.errors().len() - 1));
        }
        Self {
            verdict: Verdict::Refused,
            reason,
            errors: Some(errors),
            expect: Vec::new(),
            completed: false,
            warnings: Vec::new(),
            hash: None,
            seconds: 0.0,
            files: Vec::new(),
        }
    }

    /// The result of an ended run. With `strict` an untrusted run counts as failed.
    pub fn of(simulation: &Simulation, failure: Option<&Failure>, strict: bool) -> Self {
        let card = simulation.card();
        let expect = simulation.outcomes();
        let broken: Vec<String> = expect.iter().filter(|outcome| !outcome.holds).map(told).collect();
        let (verdict, reason) = match failure {
            Some(failure) => (Verdict::Failed, format!("{failure}; {}", card.why.as_deref().unwrap_or_default())),
            None if strict && card.is_distrusted() => (Verdict::Failed, card.verdict.clone()),
            None if broken.is_empty() => (Verdict::Good, String::new()),
            None => (Verdict::Broken, broken.join("; ")),
        };
        Self {
            verdict,
            reason,
            errors: None,
            expect,
            completed: failure.is_none(),
            hash: Some(card.hash),
            warnings: card.warnings,
            seconds: simulation.seconds_spent(),
            files: simulation.header().files.clone(),
        }
    }

    /// The number of expectations that hold.
    pub fn held(&self) -> usize {
        self.expect.iter().filter(|outcome| outcome.holds).count()
    }
}

/// A broken expectation in a line.
pub(super) fn told(outcome: &ExpectationOutcome) -> String {
    format!("{}: {}", visible_line(&outcome.text), outcome.measured)
}
