//! `atoms: Png(..)`: the picture is read, and the discs that cover its silhouette are added to the entry.

use std::fmt::Write;
use std::path::Path;

use super::{Covering, Fineness, Mask};
use crate::scene::embed::{Door, Embed, Embedded, Embedding, EmbeddingPlace, FileRequest, UnfitFile};
use crate::scene::values::WholeNumber;
use crate::scene::{Diagnostics, exact, read_value, suggest};
use crate::shapes::png::{MOST_ATOMS, Png};

/// `atoms: Png(..)`.
pub(crate) const EMBEDDING: Embedding = Embedding {
    name: "Png",
    place: EmbeddingPlace::Atoms,
    fields: &["file", "height", "count", "radius", "stiffness"],
    required: &["file", "height"],
    example: Png::EXAMPLE,
    reader: || Box::<Pictures>::default(),
};
/// The prefix of pictures that come with the program.
const SHIPPED: &str = "example:";
/// Name and contents of each picture in `assets/silhouettes/`.
const PICTURES: &[(&str, &[u8])] = &[("cow.png", include_bytes!("../../../../assets/silhouettes/cow.png"))];
const PICTURE: FileRequest =
    FileRequest { most: 16 << 20, noun: "a PNG picture", smaller: "make it smaller: 400 pixels a side are enough" };
/// The most different silhouettes of a scene, each of which takes up to half a second.
const MOST_DIFFERENT: usize = 50;

/// The discs of earlier silhouettes.
#[derive(Default)]
struct Pictures(Vec<Known>);

struct Known {
    file: String,
    fineness: Fineness,
    covering: Covering,
}

/// A mistake: its words, what to do, and the field it is about.
type Wrong = (String, String, &'static str);

impl Embed for Pictures {
    fn embed(&mut self, entry: &str, folder: Option<&Path>, door: &Door) -> Result<Option<Embedded>, UnfitFile> {
        // The shape's reader and check report their mistakes in their words.
        let Some(png) = read_value::<Png>(entry).ok().filter(|png| png.numbers_are_good(&mut Diagnostics::new()))
        else {
            return Ok(None);
        };
        let (found, note) =
            self.covering(folder, door, &png).map_err(|(message, help, field)| UnfitFile { message, help, field })?;
        let (height, covered) = (png.height.si(), &self.0[found].covering.discs);
        let mut fields = String::from("discs: [");
        for disc in covered {
            let (x, y, radius) = (disc.x * height, disc.y * height, disc.radius * height);
            // Writing to a text cannot fail.
            let _ = write!(fields, "({x:?}, {y:?}, {radius:?}),");
        }
        fields.push(']');
        Ok(Some(Embedded { fields, work: covered.len(), note, data: None }))
    }
}

impl Pictures {
    /// The discs of a silhouette: which of the known ones, and a note if it was not known before.
    fn covering(&mut self, folder: Option<&Path>, door: &Door, png: &Png) -> Result<(usize, Option<String>), Wrong> {
        let shipped = png.file.starts_with(SHIPPED);
        let file = match folder {
            Some(folder) if !shipped => folder.join(&png.file).display().to_string(),
            _ => png.file.clone(),
        };
        let fineness = match (png.count, png.radius) {
            (Some(WholeNumber(count)), _) => Fineness::Count(count as usize),
            (None, radius) => Fineness::Radius(radius.unwrap_or_default().si() / png.height.si()),
        };
        if let Some(known) = self.0.iter().position(|known| known.file == file && known.fineness == fineness) {
            return Ok((known, None));
        }
        if self.0.len() == MOST_DIFFERENT {
            let message = format!("the scene has more than {MOST_DIFFERENT} different silhouettes");
            return Err((message, "use the same picture and `count` again".into(), "file"));
        }
        let name = &png.file;
        let bytes = match name.strip_prefix(SHIPPED) {
            Some(shipped) => shipped_picture(shipped)?.to_vec(),
            None if folder.is_none() => {
                let message = "this scene is in no file, so no picture can be found from it";
                let help = "save it as a file, or use a picture that comes with the program: `example:cow.png`";
                return Err((message.into(), help.into(), "file"));
            }
            None => PICTURE.read(door, Path::new(&file), name).map_err(|(message, help)| (message, help, "file"))?,
        };
        let mask = Mask::read(&bytes).map_err(|(why, help)| (format!("`{name}` {why}"), help.to_owned(), "file"))?;
        let covering = cover(&mask, fineness, png)?;
        let note = note(name, fineness, &covering);
        self.0.push(Known { file, fineness, covering });
        Ok((self.0.len() - 1, Some(note)))
    }
}

fn shipped_picture(name: &str) -> Result<&'static [u8], Wrong> {
    let found = PICTURES.iter().find(|(known, _)| *known == name).map(|(_, bytes)| *bytes);
    found.ok_or_else(|| {
        let names = PICTURES.iter().map(|(name, _)| *name);
        (format!("no picture `{name}` comes with the program"), suggest::among(name, names, "pictures", '`'), "file")
    })
}

fn cover(mask: &Mask, fineness: Fineness, png: &Png) -> Result<Covering, Wrong> {
    let height = png.height.si();
    if let Fineness::Radius(radius) = fineness {
        let pixel = mask.resolution() * height;
        let estimate = mask.estimate(radius);
        if estimate > MOST_ATOMS as f64 {
            let message =
                format!("about {} atoms of this radius are needed, more than {MOST_ATOMS}", exact(estimate.round()));
            return Err((message, "a larger `radius`, or `count` with discs of different sizes".into(), "radius"));
        }
        if radius < mask.resolution() {
            let message = format!("the radius is smaller than the finest detail of the picture, {pixel:.3} m");
            return Err((message, "a larger `radius`, or a thicker silhouette".into(), "radius"));
        }
    }
    mask.cover(fineness).ok_or_else(|| {
        let message = format!("no atom of this radius fits a silhouette {} m high", exact(height));
        (message, "a smaller `radius`, or `count` with discs of different sizes".into(), "radius")
    })
}

fn note(name: &str, fineness: Fineness, covering: &Covering) -> String {
    let Covering { discs, uncovered, outside, distance } = covering;
    let fewer = match fineness {
        Fineness::Count(asked) if discs.len() < asked => format!(" (of {asked}: more would cover nothing)"),
        _ => String::new(),
    };
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let atoms = if discs.len() == 1 { "atom covers" } else { "atoms cover" };
    format!(
        "{name}: {} {atoms} {} of the silhouette{fewer}, and {} of its area outside. The outlines are up to {} of the height \
         apart",
        discs.len(),
        percent(1.0 - uncovered),
        percent(*outside),
        percent(*distance),
    )
}

#[cfg(test)]
mod tests {
    /// A picture that is not listed would be missing from an installed program.
    #[test]
    fn every_picture_of_the_folder_is_listed() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/silhouettes");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .filter_map(|entry| entry.unwrap().file_name().to_str().map(str::to_owned))
            .collect();
        files.sort();
        let listed: Vec<&str> = super::PICTURES.iter().map(|(name, _)| *name).collect();
        assert_eq!(files, listed);
    }
}
