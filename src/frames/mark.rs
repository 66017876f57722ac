//! Marks: what layers add to a picture.

use glam::DVec2;

/// Something drawn beside the bodies. Lengths are in metres, line widths are the film's own.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its shape.
    pub shape: MarkShape,
    /// A name of the theme's palette (`"teal"`), `"force"`, `"velocity"` or `"quiet"`, or `"#rrggbb"`; `None`: the theme's
    /// ink.
    pub color: Option<String>,
}

/// The shape of a mark. All but trails are in front of the bodies.
#[derive(Clone, Debug, PartialEq)]
pub enum MarkShape {
    /// A line between two points.
    Line(DVec2, DVec2),
    /// An arrow with its head at the second point.
    Arrow(DVec2, DVec2),
    /// An arrow with two heads: what it stands for is larger than it could show.
    LongArrow(DVec2, DVec2),
    /// A circle by its centre and radius.
    Circle(DVec2, f64),
    /// A dot whose size does not depend on the camera.
    Dot(DVec2),
    /// An upright rectangle by its lower left and upper right corner.
    Rectangle(DVec2, DVec2),
    /// Where a body came along: it fades and tapers. Its colour is that of the body, whatever the mark says.
    Trail {
        /// The body's place in the cast.
        body: usize,
        /// From early to late.
        points: Vec<DVec2>,
        /// From point to point, as a share of the trail's whole length in time: the last point has age 0, and at age 1
        /// nothing is left to see.
        step: f64,
    },
    /// A text above something.
    Label {
        /// The middle of what it names.
        at: DVec2,
        /// How far that reaches up and down.
        clear: f64,
        /// The text.
        text: String,
    },
    /// States the scale of arrows, in the corner of the picture.
    Key {
        /// The length of an arrow.
        length: f64,
        /// What an arrow of that length stands for, such as `10 N`.
        text: String,
    },
    /// The scale of the picture, in its corner.
    ScaleBar,
    /// The time of the frame, in the corner of the picture.
    Time,
}

impl Mark {
    /// A mark in a colour.
    pub fn new(shape: MarkShape, color: &str) -> Self {
        Self { shape, color: Some(color.to_owned()) }
    }

    /// A mark in the theme's ink.
    pub fn plain(shape: MarkShape) -> Self {
        Self { shape, color: None }
    }
}
