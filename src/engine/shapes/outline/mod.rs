//! `shape: Rectangle(..)`: shapes with sides. Each is the convex hull of its corners grown by a radius, or several such
//! hulls.
//!
//! A shape is one file with its fields and its hulls by [`jostle_shapes`], and one line in the list below.

mod capsule;
mod disc;
mod gear;
mod polygon;
mod rack;
mod rectangle;
mod regular;
mod svg;

pub(crate) use svg::SvgShape;

use glam::DVec2;
use jostle_shapes as shapes;
use jostle_shapes::{Hull, ShapeError};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::Diagnostics;

/// The largest number of shapes of a compound.
const MOST_SHAPES: usize = 4000;

/// The largest number of pairs of convex parts of a compound whose boxes touch. Each is cut from the other. Eight million took 14 s to
/// read, so these take half a second.
const MOST_PAIRS: usize = 1 << 18;

/// A convex part of a body, or a concave one in convex pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlinePart {
    /// Convex hulls, in the frame of the body.
    pub hulls: Vec<Hull>,
    /// The mass in kg; `None`: density times area.
    pub mass: Option<f64>,
    /// The density in kg/m2; `None`: that of the material.
    pub density: Option<f64>,
    /// Whether it touches others.
    pub collides: bool,
}

/// The parts of a shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutlineParts {
    /// Its parts, in the order of the scene.
    pub parts: Vec<OutlinePart>,
    /// The corrections of the numbers of the scene.
    pub mended: Vec<String>,
}

impl OutlineParts {
    /// Whether too many of its convex parts lie in each other.
    fn is_crowded(&self) -> bool {
        let hulls: Vec<&Hull> = self.parts.iter().flat_map(|part| &part.hulls).collect();
        shapes::has_more_near_pairs(&hulls, MOST_PAIRS)
    }
}

/// The position of a shape in its body, and its mass or density.
pub(crate) struct Common {
    at: DVec2,
    angle: f64,
    mass: Option<f64>,
    density: Option<f64>,
    collides: bool,
}

/// The fields that all shapes have.
pub(crate) trait Placed {
    fn common(&self) -> Common;
}

/// A shape with sides.
pub(crate) trait Sided: Placed {
    /// Its hulls about its own origin.
    ///
    /// # Errors
    /// Numbers of which no shape can be made.
    fn made(&self) -> Result<shapes::Shape, ShapeError>;

    /// An example for scenes.
    fn example(&self) -> &'static str;
}

fn yes() -> bool {
    true
}

/// Declares the fields of a shape: its own, and those that all shapes have.
macro_rules! sided {
    ($(#[$about:meta])* $name:ident, $title:literal { $($(#[$about_field:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$about])*
        #[derive(Clone, Debug, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields, rename = "")]
        #[schemars(rename = $title)]
        pub struct $name {
            $($(#[$about_field])* pub $field: $type,)*
            /// Its origin in the frame of the body, in m. Default: (0, 0).
            #[serde(default)]
            pub at: crate::scene::units::LengthPair,
            /// Its turn about that point, in rad, counter-clockwise. Default: 0.
            #[serde(default)]
            pub angle: crate::scene::units::Angle,
            /// The mass in kg. Above zero. Default: density times area.
            #[serde(default)]
            pub mass: Option<crate::scene::units::Mass>,
            /// The density in kg/m2. Above zero. Default: that of the material.
            #[serde(default)]
            pub density: Option<crate::scene::units::Density>,
            /// Whether it touches other bodies and walls. If not, it is still visible and has its mass. Default: `true`.
            #[serde(default = "super::yes")]
            pub collides: bool,
        }

        impl super::Placed for $name {
            fn common(&self) -> super::Common {
                super::Common {
                    at: self.at.si(),
                    angle: self.angle.si(),
                    mass: self.mass.map(f64::from),
                    density: self.density.map(f64::from),
                    collides: self.collides,
                }
            }
        }
    };
}
use sided;

macro_rules! list {
    ($($(#[$about:meta])* $name:ident($fields:ty),)*) => {
        /// A shape with sides, or a disc. Measures are those of the outside. `rounding` goes inwards and makes corners
        /// round.
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        #[schemars(rename = "Shape")]
        pub enum OutlineShape {
            $($(#[$about])* $name($fields),)*
            /// `Compound([Rectangle(width: 1, height: 0.2), Disc(at: (0.5, 0), radius: 0.1)])`: several shapes as one body.
            Compound(Vec<OutlineShape>),
        }

        impl OutlineShape {
            fn as_sided(&self) -> Result<&dyn Sided, &[OutlineShape]> {
                match self {
                    $(Self::$name(shape) => Ok(shape),)*
                    Self::Compound(shapes) => Err(shapes),
                }
            }
        }
    };
}

// The list of shapes: one line each.
list! {
    /// `Disc(radius: 0.2)`: a disc about the origin.
    Disc(disc::DiscShape),
    /// `Capsule(from: (-0.5, 0), to: (0.5, 0), radius: 0.02)`: a bar with round ends.
    Capsule(capsule::CapsuleShape),
    /// `Rectangle(width: 0.4, height: 0.2, rounding: 0.005)`: a rectangle about the origin.
    Rectangle(rectangle::RectangleShape),
    /// `Regular(sides: 6, radius: 0.1)`: a regular polygon about the origin, with a corner at +x.
    Regular(regular::RegularShape),
    /// `Polygon(points: [(0, 0), (1, 0), (0, 1)])`: a polygon. The engine cuts a concave one into convex parts.
    Polygon(polygon::PolygonShape),
    /// `Svg(file: "part.svg", height: 0.2)`: the outlines of a drawing, cut into convex parts.
    Svg(svg::SvgShape),
    /// `Gear(teeth: 24, module: "5 mm")`: a spur gear with involute teeth about the origin. One tooth points along +x.
    Gear(gear::GearShape),
    /// `Rack(teeth: 12, module: "5 mm")`: a bar with teeth above, its pitch line along x through the origin.
    Rack(rack::RackShape),
}

impl OutlineShape {
    /// Reports numbers of which no shape can be made.
    pub fn check(&self, report: &mut Diagnostics) {
        let shape = match self.as_sided() {
            Err([]) => {
                let help = "for example: Compound([Rectangle(width: 1, height: 0.2), Disc(at: (0.5, 0), radius: 0.1)])";
                report.error("", "a compound needs at least one shape").help(help);
                return;
            }
            Err(shapes) if shapes.len() > MOST_SHAPES => {
                let message = format!("a compound of {} shapes: there can be {MOST_SHAPES} at most", shapes.len());
                report.error("", message).help("make several bodies of it, or give it fewer and larger shapes");
                return;
            }
            Err(shapes) => {
                for (index, shape) in shapes.iter().enumerate() {
                    report.within(&format!("[{index}]"), |report| shape.check(report));
                }
                if self.made().is_crowded() {
                    let message = format!(
                        "in a compound of {} shapes more than {MOST_PAIRS} pairs of convex parts lie in each other",
                        shapes.len()
                    );
                    report.error("", message).help("give it fewer shapes, or draw its outline as one `Polygon`");
                }
                return;
            }
            Ok(shape) => shape,
        };
        let Common { at, angle, mass, density, .. } = shape.common();
        report.finite_pair("at", at);
        report.finite("angle", angle);
        report.positive_if_given("mass", mass);
        report.positive_if_given("density", density);
        if mass.is_some() && density.is_some() {
            report.error("density", "its `mass` is given already").help("remove `mass` or `density`");
        }
        if let Err(error) = shape.made() {
            report
                .error("", error.to_string())
                .help(remedy(error).map_or_else(|| format!("for example: {}", shape.example()), str::to_owned));
        }
    }

    /// Its parts; empty if it cannot be made.
    pub fn parts(&self) -> OutlineParts {
        let parts = self.made();
        if self.as_sided().is_err() && parts.is_crowded() { OutlineParts::default() } else { parts }
    }

    fn made(&self) -> OutlineParts {
        let mut parts = OutlineParts::default();
        self.add_to(&mut parts, "");
        parts
    }

    /// Adds its parts; `place` is its path in messages.
    fn add_to(&self, parts: &mut OutlineParts, place: &str) {
        let shape = match self.as_sided() {
            Ok(shape) => shape,
            Err(shapes) if shapes.len() > MOST_SHAPES => return,
            Err(shapes) => {
                let each = shapes.iter().enumerate();
                return each.for_each(|(index, shape)| shape.add_to(parts, &format!("part {}: ", index + 1)));
            }
        };
        let Ok(made) = shape.made() else { return };
        let Common { at, angle, mass, density, collides } = shape.common();
        parts.mended.extend(made.mended.iter().map(|mended| format!("{place}{mended}")));
        let hulls = if angle == 0.0 && at == DVec2::ZERO { made.hulls } else { made.turned(angle).moved(at).hulls };
        parts.parts.push(OutlinePart { hulls, mass, density, collides });
    }
}

fn remedy(error: ShapeError) -> Option<&'static str> {
    Some(match error {
        ShapeError::EqualPoints { .. } => "give each corner once, and a capsule two different ends",
        ShapeError::TooFewPoints { .. } | ShapeError::ZeroArea => {
            "a polygon is a list of corners in order: Polygon(points: [(0, 0), (1, 0), (0, 1)])"
        }
        ShapeError::SelfCrossing { .. } => "give the corners in order, around the outline",
        ShapeError::RoundingTooLarge { .. } => "make `rounding` smaller, or the shape larger",
        ShapeError::TooMany { .. } => "take fewer of them, or divide the shape into several",
        _ => return None,
    })
}
