//! The theme of a film: that of the command line, else that of the scene, else the first one.

use std::path::Path;

use super::Exit;
use super::load::Request;
use crate::raster::Theme;
use crate::record::sections::LookSection;
use crate::scene::Source;
use crate::simulation::Simulation;

/// The colours. A file that the command line names (`asked`) lies where it says, one that the scene names beside the scene.
pub(super) fn theme(
    request: Request,
    source: &Source,
    simulation: &Simulation,
    asked: Option<&str>,
) -> Result<Theme, Exit> {
    let scene = simulation.get_resource::<LookSection>().and_then(|look| look.theme.as_deref());
    let folder = Path::new(&source.name).parent().filter(|_| asked.is_none());
    let Some(name) = asked.or(scene) else {
        return Ok(Theme::named(Theme::names()[0]).expect("a program without a theme fails its tests"));
    };
    if let Some(theme) = Theme::named(name) {
        return Ok(theme);
    }
    let known = Theme::names().join(", ");
    let path = folder.unwrap_or_else(|| Path::new("")).join(name);
    let read = if LookSection::is_file(name) {
        let text = std::fs::read_to_string(&path).map_err(|cause| format!("cannot be read: {cause}"));
        text.and_then(|text| Theme::read(&text).map_err(|mistake| format!("is no theme: {mistake}")))
    } else {
        Err("is no theme".to_owned())
    };
    read.map_err(|why| {
        let message = format!("`{}` {why}", path.display());
        let help = format!("themes are {known}, or a file that ends with .ron: `--theme mine.ron`");
        match asked {
            Some(_) => request.usage(&format!("{message}; {help}")),
            None => request.refuse(Exit::SceneWrong, "look.theme", &message, &help),
        }
    })
}
