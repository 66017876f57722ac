//! The cost of scenes that name things often, in numbers of readings.

use std::sync::atomic::{AtomicU64, Ordering};

use bevy_app::App;
use bevy_ecs::world::World;
use jostle::Simulation;
use jostle::scene::Source;
use jostle::sensors::{Channel, Channels, SensorAppExt};
use jostle::simulation::Overrides;

static READINGS: AtomicU64 = AtomicU64::new(0);

fn probe(_: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    (quantity == "probe").then(|| {
        Channel::of_state(format!("{owner}.{quantity}"), "", |_| {
            READINGS.fetch_add(1, Ordering::Relaxed);
            1.0
        })
    })
}

/// A scene of expressions. Each is a sum of later ones, and the last is a sum of a channel.
fn scene(count: usize, next: &[usize]) -> String {
    let sum = |index: usize| {
        let names = next.iter().map(|step| match index + step {
            other if other < count => format!("e{other}.value"),
            _ => "a.probe".to_owned(),
        });
        names.collect::<Vec<_>>().join(" + ")
    };
    let sensors: String =
        (0..count).map(|index| format!("Expression(name: \"e{index}\", of: \"{}\"),", sum(index))).collect();
    format!(
        "Scene(format: 1, clock: (duration: 0.01, tick: 0.001), sensors: [{sensors}],
            bodies: [(name: \"a\", at: (0, 0), atoms: Disc(radius: 0.1))])"
    )
}

/// Law: if each expression names the next one twice, the first is a power of 2. If each names the next two, it is a Fibonacci
/// number. Each expression reads its channel once. Worked out anew for each name, the channel is read as often as the value says.
#[test]
fn expressions_that_name_each_other_are_worked_out_once() {
    for (next, growth) in [(&[1, 1][..], 2.0), (&[1, 2], 1.618_033_988_749_895)] {
        let text = scene(48, next);
        let plugin = |app: &mut App| {
            app.add_quantities(&["probe"], probe);
        };
        READINGS.store(0, Ordering::Relaxed);
        let simulation = Simulation::load_with(&Source::new("chain", text), &Overrides::default(), plugin);
        let simulation = simulation.unwrap_or_else(|errors| panic!("{errors}"));
        let channels = simulation.get_resource::<Channels>().expect("sensors of the scene");
        let values = simulation.values(channels.iter());
        let ratio = values[0] / values[1];
        assert!((ratio / growth - 1.0).abs() < 1e-12 && values[0] > 1e9, "{values:?}");
        // Two expressions name the channel at most. It is read while the scene is put together, and for the row.
        let readings = READINGS.load(Ordering::Relaxed);
        assert!(readings <= 4, "{next:?}: {readings}");
        // One by one, each expression is still worked out once for its own value.
        let first = channels.iter().next().expect("an expression");
        assert_eq!(simulation.value(first), values[0]);
        assert!(READINGS.load(Ordering::Relaxed) - readings <= 2);
    }
}

/// Law: the note on overlaps at the start looks at a bounded number of sides and corners, and says that it has
/// not seen all. These gears have more than that.
#[test]
fn the_note_on_overlaps_says_where_it_ends() {
    let gears: String = (0..24)
        .map(|index| {
            format!(
                "(name: \"g{index}\", at: ({:?}, 0), mass: 1, shape: Gear(teeth: 600, module: 0.01)),",
                0.1 * f64::from(index)
            )
        })
        .collect();
    let text = format!("Scene(format: 1, clock: (duration: 0.001, tick: 0.001), bodies: [{gears}])");
    let simulation = Simulation::load_with(&Source::new("gears", text), &Overrides::default(), |_| {});
    let simulation = simulation.unwrap_or_else(|errors| panic!("{errors}"));
    let noted = simulation.notes().iter().any(|note| note.contains("at least") && note.contains("pairs overlap"));
    assert!(noted, "{:?}", simulation.notes());
}
