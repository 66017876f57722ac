//! `walls`: half-planes that nothing enters.

use serde::Deserialize;

use crate::scene::units::Position;
use crate::scene::{Kind, Obstacle, Outline, Report};
use crate::world::material;

/// One wall: the half-plane behind the line through two points.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "")]
pub struct WallEntry {
    /// The name, for sensors and messages.
    pub name: String,
    /// Seen from the open side, the point to the left, in m.
    pub left: Position,
    /// Seen from the open side, the point to the right, in m.
    pub right: Position,
    /// The name of its material. Default: `default`.
    #[serde(default)]
    pub material: Option<String>,
}

/// The section `walls`.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct WallsSection(pub Vec<WallEntry>);

impl WallsSection {
    /// The section's name.
    pub const NAME: &'static str = "walls";
    /// One correct use.
    pub const EXAMPLE: &'static str = "walls: [(name: \"floor\", left: (6, 0), right: (0, 0), material: \"rock\")]";

    /// Declares the walls' names.
    pub fn declare(&self, outline: &mut Outline) {
        for (index, wall) in self.0.iter().enumerate() {
            outline.declare(Kind::WALL, &wall.name, &format!("[{index}].name"));
            outline.occupy(Obstacle::Wall { left: wall.left.si(), right: wall.right.si() });
        }
    }

    /// Reports two points in one place and unknown materials.
    pub fn check(&self, outline: &Outline, report: &mut Report) {
        for (index, wall) in self.0.iter().enumerate() {
            report.within(&format!("[{index}]"), |report| wall.check(outline, report));
        }
    }
}

impl WallEntry {
    fn check(&self, outline: &Outline, report: &mut Report) {
        let (left, right) = (self.left.si(), self.right.si());
        let finite = report.finite_pair("left", left) & report.finite_pair("right", right);
        let length = (right - left).length();
        if finite && !(length > 0.0 && length.is_finite()) {
            let message = format!("must differ from `left`, got ({}, {}) for both", right.x, right.y);
            report.error("right", message).help("a wall is the line through two points, seen from the open side");
        }
        material::require(self.material.as_deref(), outline, report);
    }
}
