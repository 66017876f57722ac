//! What does it cost that plugins are there which a scene does not need? Runs `scenes/projectile.ron` with the standard
//! plugins (`all`) or with nothing but what the scene names (`needed`), for so many seconds of physics. The difference
//! between two durations is the cost of ticks alone. `tools/pay_for_what_you_use` counts the instructions.

use bevy_app::App;
use jostle::forces::Targets;
use jostle::forces::drag::DragForce;
use jostle::forces::gravity;
use jostle::scene::units::{AccelerationPair, Damping};
use jostle::scene::values::Names;
use jostle::scene::{Arity, Entry, Outline, SceneAppExt, Section, Source, WrittenEntry};
use jostle::simulation::Overrides;
use jostle::tick::TickAppExt;
use jostle::world::hash::state_hash;
use jostle::{Simulation, expect, integrate, plugins, sensors, world};

#[derive(serde::Deserialize, schemars::JsonSchema)]
struct FreeFall(AccelerationPair);

impl Section for FreeFall {
    const NAME: &'static str = "gravity";
    const EXAMPLE: &'static str = "gravity: (0, -9.81)";

    fn install(self, _: &Outline, app: &mut App) {
        gravity::install(self.0.si(), app);
    }
}

#[derive(serde::Deserialize, schemars::JsonSchema)]
struct Drag {
    linear: Damping,
    of: Names,
}

impl Entry for Drag {
    const SECTION: &'static str = "forces";
    const NAME: &'static str = "Drag";
    const EXAMPLE: &'static str = "Drag(linear: 0.1, of: \"ball\")";

    fn install(entries: Vec<WrittenEntry<Self>>, outline: &Outline, app: &mut App) {
        for WrittenEntry { value, .. } in entries {
            let of = Targets::named(Some(&value.of), outline);
            app.add_model(DragForce { linear: value.linear.si(), quadratic: 0.0, of });
        }
    }
}

fn needed(app: &mut App) {
    plugins::run_and_film(app);
    integrate::plugin(app);
    world::plugin(app);
    app.register_entry_section("forces", Arity::List, "forces: [Drag(linear: 0.1)]");
    app.register_section::<FreeFall>().register_entry::<Drag>();
    sensors::plugin(app);
    expect::plugin(app);
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [which, duration] = &arguments[..] else { return Err("usage: all|needed SECONDS".into()) };
    let source = Source::new("projectile.ron", include_str!("../../scenes/projectile.ron"));
    let overrides = Overrides { duration: Some(duration.parse()?), ..Overrides::default() };
    let mut simulation = match which.as_str() {
        "all" => Simulation::load_only(&source, &overrides, plugins::standard)?,
        "needed" => Simulation::load_only(&source, &overrides, needed)?,
        _ => return Err("the first argument is `all` or `needed`".into()),
    };
    simulation.run_to_end()?;
    println!("{:016x}", state_hash(simulation.bodies()));
    Ok(())
}
