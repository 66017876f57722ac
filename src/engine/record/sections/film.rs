//! `film`: the part of the run that is drawn. It never changes the physics.

use bevy_app::App;
use bevy_ecs::resource::Resource;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::units::{Rate, Scalar, Time};
use crate::scene::values::WholeNumber;
use crate::scene::{Diagnostics, NameKind, Outline, Section, exact};

/// The largest width and height of a film, in pixels.
pub const LARGEST_SIZE: u64 = 8192;

/// The part of the run that the film shows. It never changes the physics.
#[derive(Resource, Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Film")]
pub struct FilmSection {
    /// Frames per second of the film, from 0.01 to 1000. Default: 30.
    #[serde(default)]
    pub fps: Option<Rate>,
    /// Width and height in pixels, each from 16 to 8192. Default: (1280, 720).
    #[serde(default)]
    pub size: Option<(WholeNumber, WholeNumber)>,
    /// Seconds of physics per second of film. Below zero the film runs backwards. Default: 1.
    #[serde(default)]
    pub speed: Option<Scalar>,
    /// First moment drawn, in s of physics. Default: 0.
    #[serde(default)]
    pub from: Option<Time>,
    /// Last moment drawn, in s of physics, after `from`. A moment after the end of the run means the end. Default: the end
    /// of the run.
    #[serde(default)]
    pub to: Option<Time>,
    /// The moments at which the film stands still. Default: none.
    #[serde(default)]
    pub freeze: Vec<FreezeEntry>,
}

/// A moment at which the film stands still: a time, or a contact.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Freeze")]
pub struct FreezeEntry {
    /// The moment, in s of physics, from the film's beginning to its end. Default: from `touch`.
    #[serde(default)]
    pub at: Option<Time>,
    /// Two bodies, or a body and a wall. The film stands still at their first contact in it, to a tick. Default: from `at`.
    #[serde(default)]
    pub touch: Option<(String, String)>,
    /// The duration of the still, in s of film. Above zero.
    #[serde(rename = "for")]
    pub lasts: Time,
}

impl FreezeEntry {
    fn check(&self, film: &FilmSection, outline: &Outline, report: &mut Diagnostics) {
        report.positive("for", self.lasts);
        match (&self.at, &self.touch) {
            (Some(at), None) => {
                let (begin, end) = (film.begin(), film.end());
                if report.not_negative("at", *at) && !(begin..=end).contains(&at.si()) {
                    let lasts = if end.is_finite() { format!("to {} s", exact(end)) } else { "on".to_owned() };
                    let message = format!(
                        "must be a moment of the film, which shows {} s {lasts}, got {} s",
                        exact(begin),
                        exact(at.si())
                    );
                    report.error("at", message).help("change it, or the film's `from` and `to`");
                }
            }
            (None, Some((a, b))) => {
                let kinds = [NameKind::BODY, NameKind::WALL];
                let found_a = outline.require_any(&kinds, a, "touch[0]", report);
                let found_b = outline.require_any(&kinds, b, "touch[1]", report);
                let wall = |name| outline.position(NameKind::WALL, name).is_some();
                if found_a && found_b && (a == b || wall(a) && wall(b)) {
                    let message = format!("`{a}` and `{b}` never touch");
                    report.error("touch", message).help("name two bodies, or a body and a wall");
                }
            }
            (Some(_), Some(_)) => {
                let help = "leave out `at` to wait for the contact, or `touch` to give the time";
                report.error("", "`at` and `touch` exclude each other").help(help);
            }
            (None, None) => {
                let help = "add `at: 1.5` (s of physics) or `touch: (\"ball\", \"floor\")`";
                report.error("", "the moment at which the film stands still is missing").help(help);
            }
        }
    }
}

impl FilmSection {
    /// Frames per second of the film. Default: 30.
    pub fn frames_per_second(&self) -> f64 {
        self.fps.map_or(30.0, Rate::si)
    }

    /// Width and height in pixels. Default: 1280 x 720.
    pub fn size(&self) -> (u32, u32) {
        self.size.map_or((1280, 720), |(width, height)| (width.0 as u32, height.0 as u32))
    }

    /// Seconds of physics per second of film, whichever way it runs. Default: 1.
    pub fn speed(&self) -> f64 {
        self.speed.map_or(1.0, Scalar::si).abs()
    }

    /// Whether the film runs backwards.
    pub fn is_backwards(&self) -> bool {
        self.speed.is_some_and(|speed| speed.si() < 0.0)
    }

    /// First moment drawn, in seconds of physics. Default: 0.
    pub fn begin(&self) -> f64 {
        self.from.unwrap_or_default().si()
    }

    /// Last moment drawn, in seconds of physics. Default: infinity, which means the end of the run.
    pub fn end(&self) -> f64 {
        self.to.map_or(f64::INFINITY, Time::si)
    }
}

impl Section for FilmSection {
    const NAME: &'static str = "film";
    const EXAMPLE: &'static str = "film: (fps: 30, size: (1280, 720), speed: 0.5, freeze: [(at: 1.5, for: 2)])";

    /// Reports rates, sizes and moments that give no film.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        if let Some(fps) = self.fps {
            report.between("fps", fps, 0.01, 1000.0);
        }
        if let Some((width, height)) = self.size {
            for (path, pixels) in [("size[0]", width.0), ("size[1]", height.0)] {
                if !(16..=LARGEST_SIZE).contains(&pixels) {
                    report.error(path, format!("must be from 16 to {LARGEST_SIZE} pixels, got {pixels}"));
                }
            }
        }
        if let Some(speed) = self.speed
            && report.finite("speed", speed)
            && speed.si() == 0.0
        {
            let help = "0.1 is slow motion, -1 backwards; a film that stands still for a while has `freeze: [(at: 1.5, for: 2)]`";
            report.error("speed", "must not be zero: the film would never end").help(help);
        }
        let from = self.from.unwrap_or_default();
        let begins = report.not_negative("from", from);
        if let Some(to) = self.to
            && report.positive("to", to)
            && begins
            && to.si() <= from.si()
        {
            report.error(
                "to",
                format!("must be after `from`, which is {} s, got {} s", exact(from.si()), exact(to.si())),
            );
        }
        for (index, freeze) in self.freeze.iter().enumerate() {
            report.within(&format!("freeze[{index}]"), |report| freeze.check(self, outline, report));
        }
    }

    fn install(self, _: &Outline, app: &mut App) {
        app.insert_resource(self);
    }
}
