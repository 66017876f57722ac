//! The paths of the films of a command, which are settled before any run.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::Exit;
use super::load::Request;
use super::say::say;
use crate::output::{OutputError, OutputTarget};

/// Endings of what `render` writes.
const PICTURES: [&str; 6] = ["gif", "png", "apng", "mp4", "webm", "rgba"];

/// Whether a path ends as a film or a picture does.
pub(super) fn ends_as_picture(path: &Path) -> bool {
    path.extension().is_some_and(|ending| PICTURES.iter().any(|picture| ending.eq_ignore_ascii_case(picture)))
}

/// The request of the command line for the paths of films.
pub(super) struct Wish<'a> {
    /// `-o`.
    pub output: Option<&'a Path>,
    /// The flag by which only one picture is drawn: `--at`, `--strip` or `--sheet`.
    pub still: Option<&'static str>,
    /// `--png`.
    pub png: bool,
}

/// The path of one film.
#[derive(Debug)]
pub(super) struct Place {
    pub target: OutputTarget,
    /// A directory that the command line names and that may have to be made first. The directory of a single file
    /// is not made: its name is more likely misspelt.
    pub folder: Option<PathBuf>,
}

/// The place of each scene's film. Two scenes never share one: the second film would overwrite the first.
pub(super) fn places(scenes: &[Request], wish: &Wish) -> Result<Vec<Place>, Exit> {
    let mut taken: BTreeMap<PathBuf, &str> = BTreeMap::new();
    let mut places: Vec<Place> = Vec::new();
    for scene in scenes {
        let place = wish.place(*scene, scenes.len()).map_err(usage)?;
        let target = &place.target;
        if let Some(scene) = scenes.iter().find(|scene| scene.is_at(target.path())) {
            return Err(usage(format!("`{}` is a scene: say with -o where its film is to go", scene.name)));
        }
        if let Some(other) = taken.insert(target.path().to_owned(), scene.name) {
            let path = target.path().display();
            return Err(usage(if other == scene.name {
                format!("`{other}` is named twice")
            } else {
                format!(
                    "`{other}` and `{}` would both go to `{path}`. Render them with two commands and an `-o` each",
                    scene.name
                )
            }));
        }
        places.push(place);
    }
    Ok(places)
}

fn usage(message: String) -> Exit {
    say(&format!("error: {message}"));
    Exit::Usage
}

impl Wish<'_> {
    fn place(&self, scene: Request, scenes: usize) -> Result<Place, String> {
        let stem = scene.stem();
        let file = if self.still.is_some() {
            format!("{stem}.png")
        } else if self.png {
            format!("{stem}/")
        } else {
            format!("{stem}.gif")
        };
        let mut folder = None;
        let path = match self.output {
            None => PathBuf::from(&file),
            // A sequence of one scene needs no separate folder.
            Some(output) if scenes == 1 && !(self.still.is_some() && is_directory(output)) => output.to_owned(),
            Some(output) if is_directory(output) => {
                folder = Some(output.to_owned());
                output.join(&file)
            }
            Some(output) if output == Path::new("-") => {
                return Err(format!("standard output takes one film, not {scenes}; name one scene"));
            }
            Some(output) => {
                let better = output.with_extension("");
                return Err(format!("{scenes} scenes need a directory: `-o {}/`", better.display()));
            }
        };
        let target = OutputTarget::new(path).map_err(|error| match error {
            OutputError::UnknownFormat { path, .. } => format!(
                "the ending of `{}` names no format. .gif, .apng, .mp4 and .webm are films. .png is one picture, with --at, \
                 --strip or --sheet. A / at the end means a directory of pictures. .rgba or the name - (standard output) means raw pictures",
                path.display()
            ),
            error => error.to_string(),
        })?;
        self.check(&target)?;
        if target.path().is_dir() && !file.ends_with('/') && self.output != Some(target.path()) {
            let path = target.path().display();
            return Err(format!("`{path}` is a directory; say with -o where the file is to go"));
        }
        Ok(Place { target, folder })
    }

    fn check(&self, target: &OutputTarget) -> Result<(), String> {
        let path = target.path();
        if target.is_standard_output() {
            return match self.still.or(self.png.then_some("--png")) {
                Some(flag) => Err(format!("{flag} makes PNG files; standard output (`-o -`) takes raw films")),
                None => Ok(()),
            };
        }
        if let Some(message) = is_special(path) {
            return Err(message);
        }
        let directory = is_directory(path);
        if directory && ends_as_picture(path) && self.output == Some(path) && !ends_with_separator(path) {
            let path = path.display();
            return Err(format!(
                "`{path}` is a directory: take another name for the film, or write pictures into it with `-o {path}/`"
            ));
        }
        let picture = !directory && path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
        if let Some(flag) = self.still.filter(|_| !picture) {
            return Err(format!("{flag} makes one picture: write it to a .png instead of `{}`", path.display()));
        }
        if self.still.is_none() && picture {
            return Err(
                "a .png holds one picture: add --at T, --strip T,T,T or --sheet 4x3. Or write a film to a .gif or .apng"
                    .to_owned(),
            );
        }
        if self.png && self.still.is_none() && !directory {
            let path = path.display();
            return Err(format!(
                "--png makes pictures: they need a directory instead of `{path}`, such as `-o frames/`"
            ));
        }
        Ok(())
    }
}

/// The objection to this name for a finished file. It would replace a scene, a device or a pipe, or has no directory.
pub(super) fn takes_no_file(path: &Path) -> Option<String> {
    let directory = path.parent().filter(|directory| !directory.as_os_str().is_empty() && !directory.is_dir());
    let missing = directory.map(|directory| {
        let (path, directory) = (path.display(), directory.display());
        format!("`{path}` could not be written: there is no `{directory}`; create its directory first")
    });
    missing.or_else(|| is_special(path)).or_else(|| is_scene(path))
}

/// The objection to a name for scenes, also behind a link.
fn is_scene(path: &Path) -> Option<String> {
    let ends = |path: &Path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ron"));
    let scene = ends(path) || std::fs::canonicalize(path).is_ok_and(|real| ends(&real));
    scene.then(|| format!("`{}` has the name of a scene, but the output is none: take another ending", path.display()))
}

/// The objection to the name of a device or a pipe.
fn is_special(path: &Path) -> Option<String> {
    let kind = std::fs::metadata(path).ok()?.file_type();
    let special = !kind.is_file() && !kind.is_dir();
    special.then(|| format!("`{}` is a device or a pipe: name a file", path.display()))
}

/// Whether a path is, or is meant to be, a directory.
pub(super) fn is_directory(path: &Path) -> bool {
    path.is_dir() || ends_with_separator(path)
}

fn ends_with_separator(path: &Path) -> bool {
    path.as_os_str().to_string_lossy().ends_with(std::path::is_separator)
}
