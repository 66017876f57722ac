//! Marks that layers add to a picture.

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
    /// An arrow with two heads: its value is larger than the arrow could show.
    LongArrow(DVec2, DVec2),
    /// A circle by its centre and radius.
    Circle(DVec2, f64),
    /// A dot whose size does not depend on the camera.
    Dot(DVec2),
    /// An upright rectangle by its lower left and upper right corner.
    Rectangle(DVec2, DVec2),
    /// The past path of a body: it fades and tapers. Its colour is that of the body, whatever the mark says.
    Trail {
        /// The body's place in the cast.
        body: usize,
        /// From early to late.
        points: Vec<DVec2>,
        /// The age of one segment, as a share of the duration of the whole trail. The last point has age 0, and at age
        /// 1 the trail is invisible.
        step: f64,
    },
    /// A text above something.
    Label {
        /// The middle of the named thing.
        at: DVec2,
        /// Its reach up and down.
        clear: f64,
        /// The text.
        text: String,
    },
    /// States the scale of arrows, in the corner of the picture.
    Key {
        /// The length of an arrow.
        length: f64,
        /// The value of an arrow of that length, such as `10 N`.
        text: String,
    },
    /// A square part of the world, enlarged in a corner of the picture. All frames of a film have the same ones.
    Inset {
        /// Its middle.
        center: DVec2,
        /// Its height and width.
        height: f64,
        /// The corner of the picture.
        corner: Corner,
        /// Its height there, as a share of the shorter side of the picture.
        share: f64,
    },
    /// The scale of the picture, in its corner.
    ScaleBar,
    /// The time of the frame, in the corner of the picture.
    Time,
}

/// A corner of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// On the right, not on the left.
    pub right: bool,
    /// Below, not above.
    pub bottom: bool,
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
