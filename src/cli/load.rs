//! Reading of scenes for the commands, and reports of their mistakes.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use super::inputs::is_same_file;
use super::reading::Reading;
use super::say::{print_json, say, say_mistakes};
use super::{Exit, examples};
use crate::cli::author;
use crate::scene::{SceneError, SceneErrors, Source};
use crate::simulation::{Overrides, Simulation};

/// The prefix of scenes that come with the program.
pub(super) const EXAMPLE: &str = "example:";

/// Whether scenes may read files that lie elsewhere (`--allow-outside`).
static OUTSIDE: AtomicBool = AtomicBool::new(false);

/// Says for all scenes of this program whether they may read files that lie elsewhere.
pub(super) fn allow_outside(allowed: bool) {
    OUTSIDE.store(allowed, Ordering::Relaxed);
}

/// A scene as the command line names it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Request<'a> {
    /// The name as given: a path, or `example:NAME`.
    pub name: &'a str,
    /// Whether results and mistakes are printed as JSON.
    pub json: bool,
    /// Whether nothing tells of the progress of long work.
    pub silent: bool,
}

impl Request<'_> {
    /// Reads and prepares the scene; prints its mistakes. It also returns the source, because a second run cannot read a pipe
    /// again.
    pub fn load(self, settings: &[(String, String)], overrides: &Overrides) -> Result<(Source, Simulation), Exit> {
        self.read(settings, overrides).map_err(|errors| self.refuse_scene(&errors))
    }

    /// Reads and prepares the scene; prints nothing.
    pub fn read(
        self,
        settings: &[(String, String)],
        overrides: &Overrides,
    ) -> Result<(Source, Simulation), SceneErrors> {
        let source = source(self.name)?.with_settings(settings);
        let _sign = Reading::begin(self.name, self.silent);
        let simulation = Simulation::load_with(&source, overrides, author::plugin)?;
        Ok((source, simulation))
    }

    /// Reports the mistakes of the scene.
    pub fn refuse_scene(self, errors: &SceneErrors) -> Exit {
        say_mistakes(errors);
        let exit = if self.is_missing() { Exit::Usage } else { Exit::SceneWrong };
        if self.json { print_json(&errors.to_json()).worse(exit) } else { exit }
    }

    /// Whether there is no scene of that name, which is a mistake of the command line.
    pub fn is_missing(self) -> bool {
        match self.name.strip_prefix(EXAMPLE) {
            Some(name) => !examples::SCENES.iter().any(|(known, _)| *known == name),
            None => !Path::new(self.name).exists(),
        }
    }

    /// Reports a mistake in a value of the scene that only shows at this point, with its place.
    pub fn refuse_value(self, exit: Exit, simulation: &Simulation, error: SceneError) -> Exit {
        self.refuse_scene(&simulation.refused(error));
        exit
    }

    /// Reports why the scene or the command line does not suit the command.
    pub fn refuse(self, exit: Exit, path: &str, message: &str, help: &str) -> Exit {
        let message = message.to_owned();
        let error = SceneError::new(path, message).with_help(help);
        let errors = SceneErrors::new(Source::new(self.name, ""), vec![error], Vec::new());
        self.refuse_scene(&errors);
        exit
    }

    /// Reports that the command does not suit this scene: its output cannot be written, or a flag does not fit.
    pub fn usage(self, message: &str) -> Exit {
        say(&format!("error: {message}"));
        if self.json {
            let errors = vec![SceneError::new("", message)];
            print_json(&SceneErrors::new(Source::new(self.name, ""), errors, Vec::new()).to_json());
        }
        Exit::Usage
    }

    /// The name without folders and ending: what its film is called.
    pub fn stem(self) -> String {
        let name = self.name.strip_prefix(EXAMPLE).unwrap_or(self.name);
        Path::new(name).file_stem().map_or_else(|| "film".to_owned(), |stem| stem.to_string_lossy().into_owned())
    }

    /// Whether a path leads to the scene's own file.
    pub fn is_at(self, path: &Path) -> bool {
        !self.name.starts_with(EXAMPLE) && is_same_file(path, Path::new(self.name))
    }
}

/// Reads the text of a scene from a file.
pub(super) fn file(path: &Path) -> Result<Source, SceneErrors> {
    Ok(Source { outside: OUTSIDE.load(Ordering::Relaxed), ..Source::read(path)? })
}

/// Reads the text of a scene: a file, or `example:NAME`.
pub(super) fn source(scene: &str) -> Result<Source, SceneErrors> {
    let Some(name) = scene.strip_prefix(EXAMPLE) else { return file(Path::new(scene)) };
    let found = examples::SCENES.iter().find(|(known, _)| *known == name);
    found.map(|(_, text)| Source::new(scene, *text)).ok_or_else(|| {
        let known: Vec<&str> = examples::SCENES.iter().map(|(name, _)| *name).collect();
        let error = SceneError::new("", format!("there is no example `{name}`"));
        let help = format!("examples: {}", known.join(", "));
        SceneErrors::new(Source::new(scene, ""), vec![error.with_help(help)], Vec::new())
    })
}
