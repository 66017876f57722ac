//! The engine's sections, and a section and some entries of a plugin, for reading scenes. They build nothing, and only
//! record their installation.

use std::borrow::Cow;

use bevy_app::App;
use bevy_ecs::resource::Resource;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer};

use crate::integrate::ClockSection;
use crate::record::sections::{FilmSection, FitCamera, LookCamera, camera};
use crate::scene::units::{LengthPair, QuadraticDamping, Speed};
use crate::scene::values::Names;
use crate::scene::{Arity, Diagnostics, Entry, NameKind, Outline, SceneAppExt, Section, WrittenEntry};
use crate::world::material::{MaterialsSection, PairsSection};
use crate::world::sections::{BodiesSection, FillSection, WallsSection};

#[derive(Resource, Default)]
pub(super) struct Log(pub(super) Vec<String>);

fn log(app: &mut App, line: String) {
    app.world_mut().get_resource_or_init::<Log>().0.push(line);
}

/// A type that is read and described as another one.
macro_rules! read_as {
    ($name:ident, $data:ty) => {
        struct $name($data);

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
                <$data>::deserialize(reader).map(Self)
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                <$data>::schema_name()
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                <$data>::json_schema(generator)
            }
        }
    };
}

// The models install these sections; here they are only read and checked.
macro_rules! section {
    ($name:ident, $data:ty) => {
        read_as!($name, $data);

        impl Section for $name {
            const NAME: &'static str = <$data>::NAME;
            const EXAMPLE: &'static str = <$data>::EXAMPLE;

            fn declare(&self, outline: &mut Outline) {
                self.0.declare(outline);
            }

            fn check(&self, outline: &Outline, report: &mut Diagnostics) {
                self.0.check(outline, report);
            }

            fn install(self, _outline: &Outline, app: &mut App) {
                log(app, Self::NAME.to_owned());
            }
        }
    };
}

section!(Clock, ClockSection);
section!(Film, FilmSection);
section!(Walls, WallsSection);
section!(Bodies, BodiesSection);
section!(Fill, FillSection);
section!(Materials, MaterialsSection);
section!(Pairs, PairsSection);

macro_rules! camera {
    ($name:ident, $data:ty) => {
        read_as!($name, $data);

        impl Entry for $name {
            const SECTION: &'static str = camera::SECTION;
            const NAME: &'static str = <$data>::NAME;
            const EXAMPLE: &'static str = <$data>::EXAMPLE;

            fn check(&self, outline: &Outline, report: &mut Diagnostics) {
                self.0.check(outline, report);
            }

            fn install(entries: Vec<WrittenEntry<Self>>, _outline: &Outline, app: &mut App) {
                log(app, format!("camera {}", entries[0].text));
            }
        }
    };
}

camera!(Fit, FitCamera);
camera!(Look, LookCamera);

#[derive(Deserialize, JsonSchema)]
struct Gravity(LengthPair);

impl Section for Gravity {
    const NAME: &'static str = "gravity";
    const EXAMPLE: &'static str = "gravity: (0, -9.81)";

    fn install(self, _outline: &Outline, app: &mut App) {
        log(app, format!("gravity {}", self.0.si()));
    }
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Wind {
    speed: Speed,
    #[serde(default)]
    gusts: Vec<Gust>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Gust {
    at: f64,
    strength: Strength,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
enum Strength {
    Weak,
    Strong { factor: f64 },
}

impl Section for Wind {
    const NAME: &'static str = "wind";
    const EXAMPLE: &'static str = "wind: (speed: 3, gusts: [(at: 1, strength: Weak)])";

    fn check(&self, _outline: &Outline, report: &mut Diagnostics) {
        report.between("speed", self.speed, 0.0, 100.0);
        for (index, gust) in self.gusts.iter().enumerate() {
            report.within(&format!("gusts[{index}]"), |report| {
                report.not_negative("at", gust.at);
                if let Strength::Strong { factor } = gust.strength {
                    report.between("strength.factor", factor, 1.0, 10.0);
                }
            });
        }
        if self.gusts.is_empty() {
            report.note("the wind has no gusts");
        }
    }

    fn install(self, _outline: &Outline, app: &mut App) {
        log(app, "wind".into());
    }
}

#[derive(Deserialize, JsonSchema)]
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
    const EXAMPLE: &'static str = "Drag(quadratic: 0.02, of: [\"ball\"])";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        report.not_negative("quadratic", self.quadratic);
        self.of.require(NameKind::BODY, outline, "of", report);
    }

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for entry in entries {
            let of = entry.value.of.matching(NameKind::BODY, outline);
            log(app, format!("{} of {of:?}", entry.text));
        }
    }
}

/// An app that reads the engine's sections, a plugin's `wind` and `forces: [Drag(..)]`, and reserved names.
pub(super) fn app() -> App {
    let mut app = App::empty();
    for color in jostle_frames::color_names::COLOR_NAMES {
        app.register_word(crate::world::material::COLORS, color);
    }
    app.register_entry_section(camera::SECTION, Arity::One, camera::EXAMPLE)
        .register_entry::<Fit>()
        .register_entry::<Look>()
        .reserve_entry(camera::SECTION, "Follow")
        .register_section::<Clock>()
        .register_section::<Film>()
        .register_section::<Gravity>()
        .register_section::<Materials>()
        .register_section::<Pairs>()
        .register_section::<Walls>()
        .register_section::<Bodies>()
        .register_section::<Fill>()
        .register_section::<Wind>()
        .register_entry_section("forces", Arity::List, "forces: [Drag(quadratic: 0.02)]")
        .register_entry::<Drag>()
        .reserve_entry("forces", "Aim")
        .register_entry_section("contacts", Arity::OneOrNone, "contacts: None")
        .reserve_section("joints")
        .register_word("method", "Auto")
        .register_word("method", "SemiImplicitEuler")
        .register_word("method", "VelocityVerlet")
        .reserve_word("method", "Reference");
    app
}
