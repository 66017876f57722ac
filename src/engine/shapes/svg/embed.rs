//! `shape: Svg(..)`: the drawing is read, and its outlines are added to the entry.

use std::fmt::Write;
use std::path::Path;

use jostle_language::numbers::number;

use super::size::MOST_TEXT;
use super::{Outlines, Size, Wrong};
use crate::scene::embed::{Door, Embed, Embedded, Embedding, EmbeddingPlace, FileRequest, UnfitFile};
use crate::scene::{exact, read_value};
use crate::shapes::outline::{Sided, SvgShape};

/// `shape: Svg(..)`.
pub(crate) const EMBEDDING: Embedding = Embedding {
    name: "Svg",
    place: EmbeddingPlace::Shape,
    fields: &["file", "id", "height", "unit", "tolerance", "rounding", "at", "angle", "mass", "density", "collides"],
    required: &["file"],
    example: SvgShape::EXAMPLE,
    reader: || Box::<Drawings>::default(),
};
const DRAWING: FileRequest =
    FileRequest { most: MOST_TEXT as u64, noun: "an SVG file", smaller: "make the drawing simpler" };

/// So many bytes of a file take as long as one value. Each entry reads its file.
const BYTES_READ: usize = 64;

/// The drawings that were read, so that each note appears once.
#[derive(Default)]
struct Drawings(Vec<(String, Outlines)>);

impl Embed for Drawings {
    fn embed(&mut self, entry: &str, folder: Option<&Path>, door: &Door) -> Result<Option<Embedded>, UnfitFile> {
        // The shape's reader reports its mistakes in its words.
        let Ok(shape) = read_value::<SvgShape>(entry) else { return Ok(None) };
        let told = |(message, help, field): Wrong| UnfitFile { message, help, field };
        let size = size(&shape).map_err(told)?;
        let name = &shape.file;
        let (outlines, length) = read(&shape, size, folder, door).map_err(told)?;
        let mut fields = String::from("outlines: [");
        for polygon in &outlines.polygons {
            fields.push('[');
            for at in polygon {
                // Writing to a text cannot fail.
                let _ = write!(fields, "({:?}, {:?}),", at.x, at.y);
            }
            fields.push_str("],");
        }
        fields.push(']');
        let known = (name.clone(), outlines.clone());
        let note = (!self.0.contains(&known)).then(|| note(&shape, &outlines));
        self.0.push(known);
        Ok(Some(Embedded { work: fields.len() / 16 + length / BYTES_READ, fields, note, data: None }))
    }
}

/// Its size in the scene.
fn size(shape: &SvgShape) -> Result<Size, Wrong> {
    let numbers = [("height", shape.height), ("unit", shape.unit), ("tolerance", shape.tolerance)];
    for (field, length) in numbers {
        if let Some(length) = length.map(f64::from).filter(|length| !(*length > 0.0 && length.is_finite())) {
            return Err((
                format!("must be above zero, got {} m", exact(length)),
                "for example: height: 0.2".to_owned(),
                field,
            ));
        }
    }
    let help = "`height: 0.2` is the height of the drawing in metres, `unit: \"1 mm\"` the length of one of its units";
    match (shape.height, shape.unit) {
        (Some(height), None) => Ok(Size::Height(height.si())),
        (None, Some(unit)) => Ok(Size::Unit(unit.si())),
        (Some(_), Some(_)) => Err(("`height` and `unit` exclude each other".to_owned(), help.to_owned(), "unit")),
        (None, None) => Err(("the field `height` or `unit` is missing".to_owned(), help.to_owned(), "file")),
    }
}

fn read(shape: &SvgShape, size: Size, folder: Option<&Path>, door: &Door) -> Result<(Outlines, usize), Wrong> {
    let name = &shape.file;
    let Some(folder) = folder else {
        let message = "this scene is in no file, so no drawing can be found from it";
        return Err((message.to_owned(), "save it as a file, or write a `Polygon`".to_owned(), "file"));
    };
    let bytes = DRAWING.read(door, &folder.join(name), name).map_err(|(message, help)| (message, help, "file"))?;
    Outlines::read(&bytes, shape.id.as_deref(), size, shape.tolerance.map(f64::from))
        .map(|outlines| (outlines, bytes.len()))
        .map_err(|(message, help, field)| (format!("`{name}`: {message}"), help, field))
}

fn note(shape: &SvgShape, outlines: &Outlines) -> String {
    let Outlines { polygons, tolerance, lost, left_out } = outlines;
    let points: usize = polygons.iter().map(Vec::len).sum();
    let made = SvgShape { outlines: pairs(polygons), ..shape.clone() }.made();
    let parts = made.map_or_else(|_| String::new(), |made| format!(" in {}", counted(made.hulls.len(), "convex part")));
    let left_out = if left_out.is_empty() { String::new() } else { format!(". Not read: {}", left_out.join(", ")) };
    format!(
        "{}: {} of {points} points{parts}. Points lie within {} m of the curves, and {:.3} % of the area is lost{left_out}",
        shape.file,
        counted(polygons.len(), "outline"),
        number(*tolerance),
        100.0 * lost,
    )
}

fn pairs(polygons: &[Vec<glam::DVec2>]) -> Vec<Vec<(f64, f64)>> {
    polygons.iter().map(|polygon| polygon.iter().map(|at| (at.x, at.y)).collect()).collect()
}

fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}
