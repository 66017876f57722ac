//! A plugin from outside that listens to contact events, and the sensor that counts them.
//!
//! Law: a pair touches while its overlap is positive. So in each tick the begun pairs are those that touch by their
//! positions and did not before. The test computes them from positions and radii alone. No tolerance: the same
//! comparison. Times of an elastic ball's impacts are those of free fall and of half a swing (textbook), to a share
//! `s^2`, `s = w dt`, of all speeds (see `bounce` among the laws).
//!
//! Laws from outside that do not note touching pairs: see `axis_wise`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;
use jostle::Simulation;
use jostle::contacts::events::{FindContactEvents, watch};
use jostle::contacts::{ContactEvents, ContactEventsAppExt};
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::tick::{SimTick, Stage, State};
use jostle::world::{Atom, Bodies, MaterialIndex, Name, NewBody};

/// What the plugin heard: the tick, whether it began, and both names.
type Heard = (u64, bool, String, String);

/// The plugin's own state.
#[derive(Resource, Default)]
struct Diary(Vec<Heard>);

fn keep_diary(events: Res<ContactEvents>, state: Res<State>, names: Query<&Name>, mut diary: ResMut<Diary>) {
    // Between the integrator and the observers the clock stands at the end of the tick.
    assert_eq!(events.time, state.time());
    let name = |entity| names.get(entity).map_or_else(|_| "(gone)".to_owned(), Name::to_string);
    for (list, begun) in [(&events.begun, true), (&events.ended, false)] {
        diary.0.extend(list.iter().map(|pair| (state.clock().ticks, begun, name(pair.a), name(pair.b))));
    }
}

fn listener(app: &mut App) {
    app.watch_contacts().watch_contacts().init_resource::<Diary>();
    app.add_systems(SimTick, keep_diary.in_set(Stage::Observe).after(FindContactEvents));
}

fn load(text: &str, plugins: impl Fn(&mut App) + Send + Sync + 'static) -> Simulation {
    let source = Source::new("events.ron", text);
    Simulation::load_with(&source, &Overrides::default(), plugins).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

fn run(simulation: &mut Simulation, ticks: u64) {
    simulation.run_to_tick(ticks).expect("numbers stay finite");
}

fn diary(simulation: &Simulation) -> &[Heard] {
    &simulation.resource::<Diary>().0
}

/// A channel by its name.
fn channel(simulation: &mut Simulation, name: &str) -> f64 {
    let channel = jostle::sensors::find(simulation.world_mut(), name).expect("the channel exists");
    simulation.value(&channel)
}

const WALLS: &str = "(name: \"floor\", left: (2, 0), right: (0, 0)), (name: \"left\", left: (0, 0), right: (0, 1)),
    (name: \"right\", left: (2, 1), right: (2, 0))";

fn scene(sections: &str, bodies: &str) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 100, tick: 2e-4, method: VelocityVerlet), gravity: (0, -9.81), {sections}
        materials: {{ \"default\": (stiffness: 1e5, friction: 0.3, restitution: 0.7), \"ivory\": (stiffness: 1e5) }},
        walls: [{WALLS}], bodies: [{bodies}])"
    )
}

#[test]
fn a_bouncing_ball_begins_and_ends_once_for_each_bounce() {
    let (radius, drop, stiffness, dt): (f64, f64, f64, f64) = (0.1, 0.2, 1e5, 2e-4);
    let ball = "(name: \"ball\", at: (1, 0.3), material: \"ivory\", atoms: Disc(radius: 0.1, mass: 1))";
    let floor = WALLS.replace("right: (0, 0))", "right: (0, 0), material: \"ivory\")");
    let text = scene("sensors: [Contacts(of: \"ball\"), Contacts(of: \"floor\")],", ball).replace(WALLS, &floor);
    let mut simulation = load(&text, listener);
    // Falls, swings half a period about its place of rest and the arcs to it, rises: and so on.
    let omega = stiffness.sqrt();
    let speed = (2.0 * 9.81 * drop).sqrt();
    let (fall, contact) = (speed / 9.81, 2.0 / omega * (std::f64::consts::PI - libm::atan2(speed * omega, 9.81)));
    let (mut touching, mut bounces) = (false, 0.0);
    for tick in 1..=20_000 {
        run(&mut simulation, tick);
        let now = simulation.bodies().position[0].y < radius;
        let heard: Vec<_> = diary(&simulation).iter().filter(|heard| heard.0 == tick).cloned().collect();
        if now == touching {
            assert_eq!(heard, []);
        } else {
            assert_eq!(heard, [(tick, now, "ball".to_owned(), "floor".to_owned())]);
            bounces += f64::from(u8::from(now));
            let exact = fall + (bounces - 1.0) * (2.0 * fall + contact) + if now { 0.0 } else { contact };
            let off = 2.0 * bounces * (omega * dt).powi(2) * fall;
            let found = tick as f64 * dt;
            assert!(found - exact >= -off && found - exact <= dt + off, "bounce {bounces}: {found} s, exact {exact} s");
        }
        touching = now;
        if tick % 97 == 0 {
            for owner in ["ball", "floor"] {
                assert_eq!(channel(&mut simulation, &format!("{owner}.contacts")), f64::from(u8::from(now)));
                assert_eq!(channel(&mut simulation, &format!("{owner}.contacts.begun")), bounces);
            }
        }
    }
    let expected = ((4.0 - fall) / (2.0 * fall + contact)).floor() + 1.0;
    assert_eq!(bounces, expected, "in four seconds");
}

/// Twelve discs and clumps that fall in a heap.
fn crowd(world: &World) -> Vec<NewBody> {
    let material = MaterialIndex::new(world.resource::<jostle::world::Materials>().index(None));
    let atom = |x: f64| Atom { offset: DVec2::new(x, 0.0), radius: 0.07, mass: 0.1, stiffness: 1e5, material };
    let body = |number: usize| {
        let atoms = if number.is_multiple_of(3) { vec![atom(-0.05), atom(0.05)] } else { vec![atom(0.0)] };
        let mass = 0.1 * atoms.len() as f64;
        NewBody {
            name: format!("body_{number}"),
            position: DVec2::new(
                0.3 + 0.4 * (number % 4) as f64 + 0.02 * number as f64,
                0.2 + 0.3 * (number / 4) as f64,
            ),
            velocity: DVec2::new(0.5 - 0.1 * number as f64, 0.0),
            mass,
            inertia: mass * 4e-3,
            atoms,
            ..NewBody::default()
        }
    };
    (0..12).map(body).collect()
}

const PEG: &str = "(name: \"peg\", fixed: true, at: (1, 0.05), atoms: Disc(radius: 0.05))";

/// The heap, spawned in the order given, with keys by number.
fn heap(order: impl Iterator<Item = usize>) -> Simulation {
    let mut simulation = load(&scene("", PEG), listener);
    let mut bodies: Vec<Option<NewBody>> = crowd(simulation.world()).into_iter().map(Some).collect();
    for number in order {
        let body = bodies[number].take().expect("each once");
        body.spawn_with_key(simulation.world_mut(), 10 + number as u64);
    }
    simulation
}

/// Places of the pairs that touch, by positions alone, walls behind the bodies; in canonical order.
fn touching(bodies: &Bodies) -> Vec<(bool, usize, usize)> {
    let atoms = |body: usize| bodies.atoms_of(body);
    let mut pairs = Vec::new();
    for a in 0..bodies.len() {
        for b in a + 1..bodies.len() {
            let touch = atoms(a).any(|i| {
                atoms(b).any(|j| {
                    let between = bodies.atom_place(j) - bodies.atom_place(i);
                    bodies.atom_radius[i] + bodies.atom_radius[j] - between.length() > 0.0
                })
            });
            if touch && (bodies.dynamic[a] || bodies.dynamic[b]) {
                pairs.push((false, a, b));
            }
        }
    }
    for body in (0..bodies.len()).filter(|&body| bodies.dynamic[body]) {
        for (index, wall) in bodies.walls.iter().enumerate() {
            let height = |i: usize| (bodies.atom_place(i) - wall.point).dot(wall.normal);
            if atoms(body).any(|i| bodies.atom_radius[i] - height(i) > 0.0) {
                pairs.push((true, body, index));
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

#[test]
fn a_heap_tells_who_touches_by_positions_alone_in_canonical_order() {
    let mut simulation = heap(0..12);
    let (mut known, mut changes) = (Vec::new(), 0);
    let mut lists = 0;
    for tick in 1..=4000 {
        run(&mut simulation, tick);
        let now = touching(simulation.bodies());
        let world = simulation.world();
        let pair = |&(is_wall, a, b): &(bool, usize, usize)| {
            let bodies = world.resource::<State>().bodies();
            let name = |entity| world.get::<Name>(entity).unwrap().to_string();
            (name(bodies.entity[a]), name(if is_wall { bodies.walls[b].entity } else { bodies.entity[b] }))
        };
        let begun = now.iter().filter(|&touch| !known.contains(touch)).map(pair).map(|(a, b)| (tick, true, a, b));
        let ended = known.iter().filter(|&touch| !now.contains(touch)).map(pair).map(|(a, b)| (tick, false, a, b));
        let expected: Vec<Heard> = begun.chain(ended).collect();
        let heard: Vec<Heard> = diary(&simulation).iter().filter(|heard| heard.0 == tick).cloned().collect();
        assert_eq!(heard, expected);
        assert_eq!(simulation.resource::<ContactEvents>().present.len(), now.len());
        changes += expected.len();
        known = now;
        lists = simulation.state().pairs().unwrap().version;
    }
    assert!(changes > 100 && lists > 10, "too quiet to prove anything: {changes} events, {lists} lists");
}

#[test]
fn the_order_of_spawning_changes_nothing_of_what_is_heard() {
    let heard = |order: &mut dyn Iterator<Item = usize>| {
        let mut simulation = heap(order);
        run(&mut simulation, 4000);
        diary(&simulation).to_vec()
    };
    let forward = heard(&mut (0..12));
    assert!(forward.len() > 100, "{}", forward.len());
    assert_eq!(forward, heard(&mut (0..12).rev()));
    assert_eq!(forward, heard(&mut (0..12).map(|number| number * 5 % 12)));
}

/// A runner beside two blocks, one on the other, makes the lists anew again and again; their contacts go on, one for each
/// pair of bodies, however many atoms touch.
#[test]
fn what_rests_keeps_its_contacts_whatever_happens_beside() {
    let block = "atoms: Picture(spacing: 0.1, mass: 0.1, rows: [\"####\"])";
    let bodies = format!(
        "(name: \"lower\", at: (0.5, 0.05), {block}), (name: \"upper\", at: (0.5, 0.15), {block}),
        (name: \"runner\", at: (1.5, 0.02), atoms: Disc(radius: 0.02)),"
    );
    let sensors = "sensors: [Contacts(of: [\"floor\", \"*er\"])],";
    let mut simulation = load(&scene(sensors, &bodies), listener);
    run(&mut simulation, 10_000);
    let settled = diary(&simulation).len();
    let version = |simulation: &Simulation| simulation.state().pairs().unwrap().version;
    let lists = version(&simulation);
    for (channel_name, expected) in [("upper.contacts", 1.0), ("lower.contacts", 2.0)] {
        assert_eq!(channel(&mut simulation, channel_name), expected);
    }
    let channels: Vec<_> = simulation.resource::<jostle::sensors::Channels>().iter().collect();
    let names: Vec<&str> = channels.iter().step_by(2).map(|channel| &*channel.name).collect();
    assert_eq!(names, ["floor", "lower", "upper", "runner"].map(|owner| format!("{owner}.contacts")));
    // Thrown up, the runner flies and lands again.
    let runner = simulation.bodies().entity[2];
    simulation.world_mut().get_mut::<jostle::world::Velocity>(runner).unwrap().0 = DVec2::new(0.0, 8.0);
    run(&mut simulation, 20_000);
    assert!(version(&simulation) > lists + 20, "no new lists: {lists} and {}", version(&simulation));
    let others: Vec<_> = diary(&simulation)[settled..].iter().filter(|heard| heard.2 != "runner").collect();
    assert!(others.is_empty(), "{others:?}");
    assert!(diary(&simulation).len() > settled, "the runner left the floor");
    for (channel_name, expected) in [("upper.contacts", 1.0), ("lower.contacts", 2.0)] {
        assert_eq!(channel(&mut simulation, channel_name), expected);
    }
}

/// A body that goes ends its contacts; whoever asks late hears of all that touch.
#[test]
fn events_follow_what_goes_and_may_be_asked_for_late() {
    let bodies = "(name: \"lower\", at: (0.5, 0.1), atoms: Disc(radius: 0.1)),
        (name: \"upper\", at: (0.5, 0.3), atoms: Disc(radius: 0.1)),";
    let mut simulation = load(&scene("", bodies), |_| {});
    run(&mut simulation, 10_000);
    watch(simulation.world_mut());
    run(&mut simulation, 10_001);
    let (lower, upper) = (simulation.bodies().entity[0], simulation.bodies().entity[1]);
    let events = simulation.resource::<ContactEvents>().clone();
    assert_eq!((events.begun.len(), events.ended.len(), events.present.len()), (2, 0, 2));
    assert_eq!((events.count(lower), events.count(upper)), (2, 1));
    simulation.world_mut().despawn(upper);
    run(&mut simulation, 10_002);
    let events = simulation.resource::<ContactEvents>();
    assert_eq!(events.ended.iter().map(|pair| (pair.a, pair.b)).collect::<Vec<_>>(), [(lower, upper)]);
    assert_eq!((events.begun.len(), events.count(lower), events.count(upper)), (0, 1, 0));
}

/// A ball that falls by 1 m is back after `2 sqrt(2 h/g)`, and so on without loss: impacts at `t1 (2 n + 1)` with `t1 = 0.447 s`,
/// four in 3.5 s, each `pi sqrt(m/k)`, 3 ms, long, a tenth of a frame. Both its atoms touch at once, and it is one touch. No
/// tolerance: they are counted. Not tested: crowds, whose events are not located.
#[test]
fn touches_between_two_frames_are_counted_where_they_are_located() {
    for clock in ["tolerance: 1e-6", "method: Reference", "tick: 0.001, method: RungeKutta4"] {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 3.5, {clock}), gravity: (0, -10),
            materials: {{ \"m\": (stiffness: 5e5) }},
            walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],
            bodies: [(name: \"ball\", at: (0.5, 1.1), material: \"m\", mass: 1,
                      atoms: List([(at: (-0.2, 0), radius: 0.1), (at: (0.2, 0), radius: 0.1)]))],
            sensors: [Contacts(of: \"ball\")])"
        );
        let mut simulation = load(&scene, listener);
        let ticks = simulation.ticks();
        run(&mut simulation, ticks);
        assert_eq!(channel(&mut simulation, "ball.contacts.begun"), 4.0, "{clock}");
        for begun in [true, false] {
            assert_eq!(diary(&simulation).iter().filter(|heard| heard.1 == begun).count(), 4, "{clock}");
        }
    }
}

#[test]
fn where_nobody_asks_nothing_is_watched() {
    let mut simulation = load(&scene("sensors: [Pose(of: \"*\"), ContactForce(on: \"floor\")],", PEG), |_| {});
    run(&mut simulation, 10);
    assert!(!simulation.contains_resource::<ContactEvents>());
    assert!(simulation.state().touches().is_none());
}

/// Asking changes no bit of the physics.
#[test]
fn listening_disturbs_nothing() {
    let hash = |plugins: fn(&mut App)| {
        let mut simulation = load(&scene("", PEG), plugins);
        for (number, body) in crowd(simulation.world()).into_iter().enumerate() {
            body.spawn_with_key(simulation.world_mut(), 10 + number as u64);
        }
        run(&mut simulation, 4000);
        jostle::world::hash::state_hash(simulation.bodies())
    };
    assert_eq!(hash(|_| {}), hash(listener));
}
