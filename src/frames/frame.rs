//! The content of a film, as plain data. The cast holds shapes and colours, which stay the same. The frames hold time
//! and poses, which change.

use std::sync::Arc;

use glam::DVec2;

use super::mark::Mark;

/// A colour as red, green and blue, each 0 to 255, in sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Rgb(pub u8, pub u8, pub u8);

/// One disc of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Centre in the body's own frame, from its centre of mass, in metres.
    pub offset: DVec2,
    /// Radius in metres.
    pub radius: f64,
}

/// A part of a body with sides: the convex hull of its corners, grown by a radius.
#[derive(Clone, Debug, PartialEq)]
pub struct HullLook {
    /// Two corners and more, counter-clockwise, in the body's own frame from its centre of mass, in metres.
    pub corners: Vec<DVec2>,
    /// The sides that are cuts, behind which another part of the body lies. Side i begins at corner i.
    pub cuts: Vec<bool>,
    /// Radius of the corners in metres.
    pub radius: f64,
}

/// How one body looks.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyLook {
    /// The body's name in the scene.
    pub name: String,
    /// Its discs.
    pub discs: Vec<Disc>,
    /// Its parts with sides.
    pub hulls: Vec<HullLook>,
    /// The colour of its material, as a name of the theme's palette (`"teal"`) or `"#rrggbb"`. `None`: the theme
    /// chooses by the body's index in the scene.
    pub color: Option<String>,
    /// Whether the body never moves.
    pub fixed: bool,
}

/// The look of one wall. It is a half-plane behind a line, a strip about a line, or a line of many pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct WallLook {
    /// The wall's name in the scene.
    pub name: String,
    /// Seen from the open side, the left point, in metres.
    pub left: DVec2,
    /// Seen from the open side, the right point, in metres.
    pub right: DVec2,
    /// Thickness in metres of a strip with round ends; `None`: a half-plane, or a line.
    pub thickness: Option<f64>,
    /// The points of a line in metres, open to the left of the way from the first to the last. Empty for other walls.
    pub points: Vec<DVec2>,
    /// The colour its material asks for; see [`BodyLook::color`].
    pub color: Option<String>,
}

/// The constant content of a film: bodies, walls, title.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cast {
    /// The scene's title, or an empty text.
    pub title: String,
    /// The bodies in canonical order.
    pub bodies: Vec<BodyLook>,
    /// The walls in canonical order.
    pub walls: Vec<WallLook>,
}

/// The position and angle of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyPose {
    /// Centre of mass in metres.
    pub position: DVec2,
    /// Angle in radians, counter-clockwise, continuous (not wrapped).
    pub angle: f64,
}

/// One picture's worth of motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Time in seconds.
    pub time: f64,
    /// The bodies, walls and title.
    pub cast: Arc<Cast>,
    /// One pose for each body of the cast, in the same order.
    pub poses: Vec<BodyPose>,
    /// The marks of the layers, from back to front.
    pub marks: Vec<Mark>,
    /// The centre of a moving camera, in metres. `None`: the centre of the film's camera.
    pub center: Option<DVec2>,
}
