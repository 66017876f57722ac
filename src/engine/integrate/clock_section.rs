//! The section `clock`: duration, steps and method of a run.

use bevy_app::App;
use bevy_ecs::resource::Resource;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::scene::units::{Scalar, Time};
use crate::scene::values::Word;
use crate::scene::{Diagnostics, Outline, SceneAppExt, Section, exact};

/// When forces jump (touch, part, stick, slip), inside a tick or at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum EventTiming {
    /// The engine chooses, and names its choice on the card.
    #[default]
    Auto,
    /// At the moment itself.
    Located,
    /// At the end of the tick in which it happens.
    PerTick,
}

/// The duration, the steps and the method of the run.
#[derive(Resource, Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Clock")]
pub struct ClockSection {
    /// Length of the run, in s of physics. Above zero.
    pub duration: Time,
    /// Length of one tick, in s. Above zero and not longer than the run. Default: chosen from the scene.
    #[serde(default)]
    pub tick: Option<Time>,
    /// The integration method. With `Auto` the engine chooses. Default: `Auto`.
    #[serde(default = "auto")]
    #[schemars(extend("x-words" = "method"))]
    pub method: Word,
    /// The allowed error, instead of `tick`: the engine finds steps that stay below it. For positions it is a share of
    /// the distance that bodies go, for velocities a share of their speed. Default: none.
    #[serde(default)]
    pub tolerance: Option<Scalar>,
    /// The moments at which forces jump. Default: `Auto`.
    #[serde(default)]
    pub events: EventTiming,
}

fn auto() -> Word {
    Word(ClockSection::AUTO.into())
}

impl ClockSection {
    /// The open list of words the method is checked against: integrators add their names with
    /// [`register_word`](crate::scene::SceneAppExt::register_word).
    pub const METHODS: &'static str = "method";
    /// The method that leaves the choice to the engine; it must be registered too.
    pub const AUTO: &'static str = "Auto";
    /// The method with the smallest possible error, which it also estimates. It must be registered too.
    pub const REFERENCE: &'static str = "Reference";
    /// The reason for which a tolerance does not go with it.
    pub(crate) const REFERENCE_HAS_NONE: &'static str =
        "`Reference` makes the smallest error there is: it takes no tolerance";
}

impl Section for ClockSection {
    const NAME: &'static str = "clock";
    const EXAMPLE: &'static str = "clock: (duration: 20, tick: \"1 ms\", method: VelocityVerlet)";

    /// Reports times that are not above zero and a tick longer than the run. Reports unknown methods and methods that
    /// are not available yet.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        let long = report.positive("duration", self.duration);
        if let Some(tick) = self.tick
            && report.positive("tick", tick)
            && long
            && tick.si() > self.duration.si()
        {
            let message = format!(
                "the tick of {} s is longer than the whole run of {} s",
                exact(tick.si()),
                exact(self.duration.si())
            );
            report.error("tick", message).help("a tick is some milliseconds: write `tick: \"1 ms\"`, or leave it out");
        }
        self.method.check(outline, Self::METHODS, "method", report);
        let Some(tolerance) = self.tolerance else { return };
        if !report.positive("tolerance", tolerance) {
            return;
        }
        if self.tick.is_some() {
            report
                .error("tolerance", "`tick` and `tolerance` exclude each other: a tolerance chooses the steps itself")
                .help("leave out one of the two");
        } else if self.method.0 == Self::REFERENCE {
            report
                .error("tolerance", Self::REFERENCE_HAS_NONE)
                .help("leave out the tolerance, or write `method: Auto`");
        } else if tolerance.si() >= 1.0 {
            report
                .error(
                    "tolerance",
                    format!("an error of {} times the motion itself says nothing", exact(tolerance.si())),
                )
                .help("write a share such as 1e-6: places are then wrong by a millionth of how far bodies go");
        }
    }

    fn install(self, _: &Outline, app: &mut App) {
        app.insert_resource(self);
    }
}

/// Registers the section, and the words that name no method of their own.
pub(crate) fn plugin(app: &mut App) {
    app.register_word(ClockSection::METHODS, ClockSection::AUTO);
    app.register_word(ClockSection::METHODS, ClockSection::REFERENCE);
    app.register_section::<ClockSection>();
}
