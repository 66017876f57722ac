//! The outlines of a drawing: elements of the file become contours in its frame.

use glam::{DMat2, DVec2};
use roxmltree::{Document, Node, ParsingOptions};
use svgtypes::{Length, LengthUnit, PointsParser, Transform};

use super::curve::{Affine, Curve};
use super::path::{self, Contour};
use super::{MOST_POINTS, size};

/// Groups in groups are followed so deep.
const DEEPEST: usize = 64;
/// The most elements of a drawing.
const MOST_NODES: u32 = 1 << 20;
const SVG: &str = "http://www.w3.org/2000/svg";

/// The contours of a file.
#[derive(Debug, Default)]
pub(super) struct Drawing {
    pub contours: Vec<Contour>,
    /// The number of curves of all contours. Each needs a point at least.
    curves: usize,
    /// Names of elements that are seen but have no outline here.
    pub left_out: Vec<String>,
}

/// A mistake, and what to do.
type Wrong = (String, String);

impl Drawing {
    /// Reads a file, or one element of it.
    ///
    /// # Errors
    /// A file that is no drawing; an element that is not there; numbers and paths that mean nothing.
    pub fn read(bytes: &[u8], id: Option<&str>) -> Result<Self, Wrong> {
        let text = std::str::from_utf8(bytes).map_err(|_| no_drawing("is no text"))?;
        size::check(text)?;
        let options = ParsingOptions { allow_dtd: true, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options)
            .map_err(|error| no_drawing(&format!("is no SVG file: {error}")))?;
        let root = document.root_element();
        if root.tag_name().name() != "svg" {
            return Err(no_drawing("is no SVG file: its first element is not `svg`"));
        }
        let mut drawing = Self::default();
        match id {
            None => drawing.children(root, Affine::IDENTITY, 0)?,
            Some(id) => {
                let named = root.descendants().find(|node| node.attribute("id") == Some(id));
                let node = named.ok_or_else(|| {
                    (format!("has no element with the id `{id}`"), "ids stand in the file as `id=\"..\"`".to_owned())
                })?;
                let above: Vec<Node> = node.ancestors().skip(1).filter(Node::is_element).collect();
                let map = above
                    .iter()
                    .rev()
                    .try_fold(Affine::IDENTITY, |map, node| Ok::<_, Wrong>(map.after(transform(*node)?)))?;
                drawing.element(node, map, 0)?;
            }
        }
        Ok(drawing)
    }

    fn children(&mut self, node: Node, map: Affine, depth: usize) -> Result<(), Wrong> {
        if depth == DEEPEST {
            return Err((format!("has groups in groups, more than {DEEPEST} deep"), "ungroup them".to_owned()));
        }
        node.children().filter(Node::is_element).try_for_each(|child| self.element(child, map, depth + 1))
    }

    fn element(&mut self, node: Node, map: Affine, depth: usize) -> Result<(), Wrong> {
        let name = node.tag_name().name();
        let foreign = node.tag_name().namespace().is_some_and(|namespace| namespace != SVG);
        if foreign || node.attribute("display") == Some("none") || style(node).contains("display:none") {
            return Ok(());
        }
        let contours = match name {
            "g" | "a" | "switch" => return self.children(node, map.after(transform(node)?), depth),
            "path" => path::contours(node.attribute("d").unwrap_or_default()).map_err(|error| {
                (format!("{}: {error}", told(node)), "save the file anew, or mend its `d`".to_owned())
            })?,
            "polygon" | "polyline" => {
                let points = PointsParser::from(node.attribute("points").unwrap_or_default());
                let points = points.map(|(x, y)| DVec2::new(x, y)).take(MOST_POINTS + 2);
                vec![Contour::polygon(&points.collect::<Vec<_>>())]
            }
            "rect" => vec![rectangle(node)?],
            "circle" | "ellipse" => vec![ellipse(node)?],
            "use" | "text" | "image" | "foreignObject" | "svg" | "line" => {
                self.left_out.push(name.to_owned());
                return Ok(());
            }
            // Definitions, titles and the like are not seen.
            _ => return Ok(()),
        };
        let map = map.after(transform(node)?);
        let drawn = contours.iter().filter(|contour| !contour.curves.is_empty());
        for contour in drawn {
            self.curves += contour.curves.len();
            self.contours.push(contour.mapped(map));
        }
        if self.curves > MOST_POINTS {
            let message =
                format!("has more than {MOST_POINTS} lines and curves: outlines can have {MOST_POINTS} points");
            return Err((message, "make the drawing simpler, or choose one element with `id`".to_owned()));
        }
        Ok(())
    }
}

fn no_drawing(what: &str) -> Wrong {
    (what.to_owned(), "an SVG file begins with `<svg`; programs for drawing write it as `plain SVG`".to_owned())
}

/// The name of an element in messages.
fn told(node: Node) -> String {
    let name = node.tag_name().name();
    node.attribute("id")
        .map_or_else(|| format!("has a wrong `{name}`"), |id| format!("has a wrong `{name}`, with the id `{id}`"))
}

/// The style of an element without blanks.
fn style(node: Node) -> String {
    node.attribute("style").unwrap_or_default().chars().filter(|letter| !letter.is_whitespace()).collect()
}

fn transform(node: Node) -> Result<Affine, Wrong> {
    if style(node).contains("transform:") {
        return Err((format!("{}: its style has a transform", told(node)), "save the file as `plain SVG`".to_owned()));
    }
    let Some(text) = node.attribute("transform") else { return Ok(Affine::IDENTITY) };
    let found: Transform = text
        .parse()
        .map_err(|error| (format!("{}: its `transform` means nothing: {error}", told(node)), "mend it".to_owned()))?;
    let matrix = DMat2::from_cols(DVec2::new(found.a, found.b), DVec2::new(found.c, found.d));
    Ok(Affine { matrix, shift: DVec2::new(found.e, found.f) })
}

/// A number of an element in units of the drawing.
fn number(node: Node, name: &str) -> Result<Option<f64>, Wrong> {
    let Some(text) = node.attribute(name) else { return Ok(None) };
    let plain = |length: &Length| matches!(length.unit, LengthUnit::None | LengthUnit::Px);
    let length: Option<Length> = text.parse().ok().filter(plain);
    let help = "only numbers without a unit are read: save the file as `plain SVG`, in pixels";
    length
        .map(|length| Some(length.number))
        .ok_or_else(|| (format!("{}: `{name}` is `{text}`", told(node)), help.to_owned()))
}

/// A rectangle, perhaps with round corners.
fn rectangle(node: Node) -> Result<Contour, Wrong> {
    let given = |name| number(node, name);
    let (x, y) = (given("x")?.unwrap_or(0.0), given("y")?.unwrap_or(0.0));
    let size = DVec2::new(given("width")?.unwrap_or(0.0), given("height")?.unwrap_or(0.0));
    let (rx, ry) = (given("rx")?, given("ry")?);
    let radii =
        DVec2::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0)).clamp(DVec2::ZERO, size.max(DVec2::ZERO) / 2.0);
    let low = DVec2::new(x, y);
    if radii.x == 0.0 || radii.y == 0.0 {
        let corners = [low, low + DVec2::new(size.x, 0.0), low + size, low + DVec2::new(0.0, size.y)];
        return Ok(Contour::polygon(&corners));
    }
    // Counter-clockwise seen with y down: each corner by its place, and where its arc begins and ends.
    let (across, along) = (DVec2::new(radii.x, 0.0), DVec2::new(0.0, radii.y));
    let corners = [
        (low + DVec2::new(size.x, 0.0), -across, along),
        (low + size, -along, -across),
        (low + DVec2::new(0.0, size.y), across, -along),
        (low, along, across),
    ];
    let mut contour = Contour { start: low + across, curves: Vec::new() };
    for (corner, before, behind) in corners {
        contour.curves.push(Curve::line(contour.end(), corner + before));
        contour.curves.push(Curve::arc(corner + before, corner + behind, radii, 0.0, (false, true)));
    }
    Ok(contour)
}

/// A circle or an ellipse: two halves.
fn ellipse(node: Node) -> Result<Contour, Wrong> {
    let given = |name| number(node, name);
    let center = DVec2::new(given("cx")?.unwrap_or(0.0), given("cy")?.unwrap_or(0.0));
    let round = given("r")?;
    let radii = DVec2::new(given("rx")?.or(round).unwrap_or(0.0), given("ry")?.or(round).unwrap_or(0.0));
    let (right, left) = (center + DVec2::new(radii.x, 0.0), center - DVec2::new(radii.x, 0.0));
    let half = |from, to| Curve::arc(from, to, radii, 0.0, (false, true));
    let curves = if radii.x > 0.0 && radii.y > 0.0 { vec![half(right, left), half(left, right)] } else { Vec::new() };
    Ok(Contour { start: right, curves })
}
