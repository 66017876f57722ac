//! The theme of a film: that of the command line, else that of the scene, else the first one.

use std::path::{Path, PathBuf};

use super::Exit;
use super::load::Request;
use crate::raster::Theme;
use crate::record::sections::LookSection;
use crate::scene::embed::{Door, FileRequest, told};
use crate::scene::{SceneError, Source};
use crate::simulation::Simulation;

/// A file with the colours of a film.
const THEME: FileRequest = FileRequest { most: 1 << 20, noun: "a theme", smaller: "a theme is a short text" };

/// The theme in the scene.
fn of_scene(simulation: &Simulation) -> Option<&str> {
    simulation.get_resource::<LookSection>().and_then(|look| look.theme.as_deref())
}

/// The file of the theme, if it does not come with the program.
pub(super) fn file(source: &Source, simulation: &Simulation, asked: Option<&str>) -> Option<PathBuf> {
    let name = asked.or(of_scene(simulation)).filter(|name| LookSection::is_file(name))?;
    let folder = source.folder.as_deref().filter(|_| asked.is_none());
    Some(folder.unwrap_or(Path::new("")).join(name))
}

/// The colours. A file from the command line (`asked`) is relative to the current directory. One from the scene lies
/// beside the scene.
pub(super) fn theme(
    request: Request,
    source: &Source,
    simulation: &Simulation,
    asked: Option<&str>,
) -> Result<Theme, Exit> {
    let Some(name) = asked.or(of_scene(simulation)) else {
        return Ok(Theme::named(Theme::names()[0]).expect("a program without a theme fails its tests"));
    };
    if let Some(theme) = Theme::named(name) {
        return Ok(theme);
    }
    let known = Theme::names().join(", ");
    let file = file(source, simulation, asked);
    let read = match &file {
        Some(path) => {
            let shown = path.display().to_string();
            let bytes = match asked {
                Some(_) => THEME.take(path, &shown, ""),
                None => THEME.read(&Door::of(source), path, &shown),
            };
            let text = bytes.map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).map_err(told);
            text.and_then(|text| Theme::read(&text).map_err(|mistake| format!("`{shown}` is no theme: {mistake}")))
        }
        None => Err(format!("`{name}` is no theme")),
    };
    read.map_err(|message| {
        let help = format!("themes are {known}, or a file that ends with .ron: `--theme mine.ron`");
        match asked {
            Some(_) => request.usage(&format!("{message}; {help}")),
            None => {
                let error = SceneError::new("look.theme", message).with_help(help);
                request.refuse_value(Exit::SceneWrong, simulation, error)
            }
        }
    })
}
