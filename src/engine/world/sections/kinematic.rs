//! `kinematic`: the motion of a body that no force moves.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::units::{Angle, LengthPair, SpeedPair, Spin, Time};
use crate::scene::{Diagnostics, exact};
use crate::world::kinematic::{Path, PathPoint};

/// The motion of a body that no force pushes: evenly, `kinematic: (velocity: (1, 0), spin: 2)`, or from point to point,
/// `kinematic: (path: [(time: 1, by: (2, 0)), (time: 2, by: (0, 0))], repeat: true)`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "", default)]
#[schemars(rename = "Kinematic")]
pub struct KinematicEntry {
    /// The velocity at the start, in m/s. Without a path it stays so. Default: (0, 0).
    pub velocity: SpeedPair,
    /// The spin at the start, in rad/s. Without a path it stays so. Default: 0.
    pub spin: Spin,
    /// The points of its path. Default: none.
    pub path: Vec<PathEntry>,
    /// Whether the path begins again at its last point, from its position there. Default: `false`.
    pub repeat: bool,
}

/// A point of a path.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "PathPoint")]
pub struct PathEntry {
    /// The time of the point, in s. Above that of the point before.
    pub time: Time,
    /// The displacement from the start, in m. Default: (0, 0).
    #[serde(default)]
    pub by: LengthPair,
    /// Its turn from its angle at the start, in rad. Default: 0.
    #[serde(default)]
    pub turn: Angle,
    /// Its velocity there, in m/s. With (0, 0) the body stops. Default: (0, 0).
    #[serde(default)]
    pub velocity: SpeedPair,
    /// Its spin there, in rad/s. Default: 0.
    #[serde(default)]
    pub spin: Spin,
}

impl KinematicEntry {
    pub(super) fn check(&self, report: &mut Diagnostics) {
        report.finite_pair("velocity", self.velocity.si());
        report.finite("spin", self.spin);
        let mut before = 0.0;
        for (index, point) in self.path.iter().enumerate() {
            report.within(&format!("path[{index}]"), |report| {
                report.finite_pair("by", point.by.si());
                report.finite("turn", point.turn);
                report.finite_pair("velocity", point.velocity.si());
                report.finite("spin", point.spin);
                let time = point.time.si();
                if report.positive("time", point.time) && time <= before {
                    let message =
                        format!("must be above the time before it, {} s, got {} s", exact(before), exact(time));
                    report.error("time", message).help("the points of a path stand in the order of their times");
                }
                before = time;
            });
        }
        match self.path.last() {
            None if self.repeat => {
                report.error("repeat", "there is no path to repeat").help("add `path: [(time: 1, by: (2, 0))]`");
            }
            Some(last) if self.repeat && (last.velocity != self.velocity || last.spin != self.spin) => {
                let message = "a path that is repeated must end with the velocity and spin it begins with";
                report
                    .error("repeat", message)
                    .help("give its last point the same `velocity` and `spin` as the start; both are zero by default");
            }
            _ => {}
        }
    }

    /// The motion it describes.
    pub fn path(&self) -> Path {
        let point = |point: &PathEntry| PathPoint {
            time: point.time.si(),
            by: point.by.si(),
            turn: point.turn.si(),
            velocity: point.velocity.si(),
            spin: point.spin.si(),
        };
        let points: Vec<PathPoint> = self.path.iter().map(point).collect();
        Path::new(self.velocity.si(), self.spin.si(), &points, self.repeat)
    }
}
