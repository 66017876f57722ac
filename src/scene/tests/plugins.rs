//! Small plugins to read scenes with; they only write down what was installed.

use bevy_app::App;
use bevy_ecs::resource::Resource;
use serde::Deserialize;

use crate::scene::units::{Length, Mass, Position, QuadraticDamping, Speed};
use crate::scene::values::Names;
use crate::scene::{Arity, Entry, Kind, Outline, Report, SceneAppExt, Section, Written};

#[derive(Resource, Default)]
pub(super) struct Log(pub(super) Vec<String>);

fn log(app: &mut App, line: String) {
    app.world_mut().get_resource_or_init::<Log>().0.push(line);
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Point {
    name: String,
    at: Position,
    #[serde(default)]
    mass: Option<Mass>,
}

/// Bodies without shape.
#[derive(Deserialize)]
struct Points(Vec<Point>);

impl Section for Points {
    const NAME: &'static str = "points";
    const EXAMPLE: &'static str = "points: [(name: \"p\", at: (0, 0), mass: 1)]";

    fn declare(&self, outline: &mut Outline) {
        for (index, point) in self.0.iter().enumerate() {
            outline.declare(Kind::BODY, &point.name, &format!("[{index}].name"));
        }
    }

    fn check(&self, _outline: &Outline, report: &mut Report) {
        for (index, point) in self.0.iter().enumerate() {
            report.within(&format!("[{index}]"), |report| {
                let at = point.at.si();
                let finite = report.finite("at", at.x) && report.finite("at", at.y);
                if let Some(mass) = point.mass {
                    report.positive("mass", mass);
                } else if finite {
                    report.note(format!("\"{}\" has mass 1 kg", point.name));
                }
            });
        }
    }

    fn install(self, _outline: &Outline, app: &mut App) {
        for point in self.0 {
            log(app, format!("point {}", point.name));
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Clock {
    duration: f64,
}

impl Section for Clock {
    const NAME: &'static str = "clock";
    const EXAMPLE: &'static str = "clock: (duration: 20)";

    fn install(self, _outline: &Outline, app: &mut App) {
        log(app, format!("clock {}", self.duration));
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Wind {
    speed: Speed,
    #[serde(default)]
    gusts: Vec<Gust>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Gust {
    at: f64,
    strength: Strength,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum Strength {
    Weak,
    Strong { factor: f64 },
}

impl Section for Wind {
    const NAME: &'static str = "wind";
    const EXAMPLE: &'static str = "wind: (speed: 3, gusts: [(at: 1, strength: Weak)])";

    fn check(&self, _outline: &Outline, report: &mut Report) {
        report.between("speed", self.speed, 0.0, 100.0);
        for (index, gust) in self.gusts.iter().enumerate() {
            report.within(&format!("gusts[{index}]"), |report| {
                report.not_negative("at", gust.at);
                if let Strength::Strong { factor } = gust.strength {
                    report.between("strength.factor", factor, 1.0, 10.0);
                }
            });
        }
    }

    fn install(self, _outline: &Outline, app: &mut App) {
        log(app, "wind".into());
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Drag {
    #[serde(default)]
    quadratic: QuadraticDamping,
    #[serde(default)]
    of: Names,
}

impl Entry for Drag {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Drag";
    const EXAMPLE: &'static str = "Drag(quadratic: 0.02, of: [\"p\"])";

    fn check(&self, outline: &Outline, report: &mut Report) {
        report.not_negative("quadratic", self.quadratic);
        self.of.require(Kind::BODY, outline, "of", report);
    }

    fn install(entries: Vec<Written<Self>>, outline: &Outline, app: &mut App) {
        for entry in entries {
            let of = entry.value.of.matching(Kind::BODY, outline);
            log(app, format!("{} of {of:?}", entry.text));
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fit {
    #[serde(default)]
    margin: Length,
}

impl Entry for Fit {
    const SECTION: &'static str = "camera";
    const NAME: &'static str = "Fit";
    const EXAMPLE: &'static str = "Fit(margin: 0.05)";

    fn install(entries: Vec<Written<Self>>, _outline: &Outline, app: &mut App) {
        log(app, format!("fit {:?} {}", entries[0].value.margin, entries.len()));
    }
}

/// An app that reads a small language: clock, points, wind; forces, camera, contacts; some reserved names.
pub(super) fn app() -> App {
    let mut app = App::empty();
    app.register_entry_section("camera", Arity::One, "camera: Fit(margin: 0.05)")
        .register_entry::<Fit>()
        .reserve_entry("camera", "Follow")
        .register_section::<Clock>()
        .register_section::<Points>()
        .register_section::<Wind>()
        .register_entry_section("forces", Arity::List, "forces: [Drag(quadratic: 0.02)]")
        .register_entry::<Drag>()
        .register_entry_section("contacts", Arity::OneOrNone, "contacts: None")
        .reserve_section("joints");
    app
}
