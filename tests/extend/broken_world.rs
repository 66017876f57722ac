//! Plugins or programs that remove or break parts of the world: runs end with an error that names the part, never in a
//! panic.
//!
//! Not tested: models that change lengths of lists while they act; `Bodies` says that they may panic.

use bevy_ecs::prelude::*;
use bevy_ecs::schedule::Schedules;
use glam::DVec2;
use jostle::Simulation;
use jostle::SimulationExt;
use jostle::contacts::ContactEvents;
use jostle::expect::Expectations;
use jostle::integrate::{ChosenMethod, Methods, StepPace};
use jostle::scene::Source;
use jostle::sensors::{self, Channels};
use jostle::simulation::{Overrides, Plan, Recorder};
use jostle::tick::{Evaluate, EvaluateStage, Failure, FailureKind, Modes, Notes, SimTick, Stage, State, TickAppExt};
use jostle::world::{Bodies, Mass, Materials, Position, Velocity};

/// A ball that lies on a floor beside a brick and a belt, with a sensor and an expectation of each kind that keeps something.
fn scene(clock: &str) -> Source {
    let text = format!(
        r#"Scene(
            format: 1,
            clock: (duration: 0.2, {clock}),
            gravity: (0, -10),
            walls: [(name: "floor", left: (-3, 0), right: (3, 0), surface_velocity: (0.1, 0))],
            bodies: [
                (name: "ball", at: (0, 0.1), atoms: Disc(radius: 0.1)),
                (name: "brick", at: (1, 0.3), atoms: Picture(spacing: 0.1, rows: [".##"])),
                (name: "lift", at: (2, 2), kinematic: (velocity: (0, 0.1)), atoms: Disc(radius: 0.1)),
            ],
            sensors: [Contacts(of: "ball")],
            expect: [Channel(name: "energy.residual", below: 1e9)],
        )"#
    );
    Source::new("broken.ron", text)
}

const CLOCKS: [&str; 3] = ["tick: 0.001", "tick: 0.001, method: RungeKutta4", "tick: 0.001, method: Dop853"];

fn load(clock: &str) -> Simulation {
    Simulation::load(&scene(clock)).unwrap_or_else(|errors| panic!("{errors}"))
}

/// All that a program may ask of a simulation.
fn ask_everything(simulation: &mut Simulation) {
    let _ = (simulation.notes(), simulation.header(), simulation.film(), simulation.ticks(), simulation.duration());
    let _ = (simulation.name(0), simulation.name(99), simulation.name(usize::MAX), simulation.frame_step());
    let _ = (simulation.outcomes(), simulation.failure(), simulation.seconds_spent(), simulation.plan());
    let _ = (simulation.clock(), simulation.card().to_string(), simulation.bodies().len());
    for name in ["ball.contacts", "ball.contacts.begun", "ball.position.x", "energy.kinetic", "absent.x", ""] {
        if let Some(channel) = sensors::find(simulation.world_mut(), name) {
            let _ = simulation.value(&channel);
        }
    }
    let _ = Recorder::default().frame(simulation, 0.1);
    let _ = simulation.snapshot().map(|snapshot| simulation.restore(&snapshot));
    let _ = (simulation.future_hash(), simulation.fork().map(|mut fork| fork.run_to_end()));
}

/// A run from which something was taken after some ticks.
fn without(clock: &str, ticks: u64, take: impl Fn(&mut World)) -> (Simulation, Result<(), Failure>) {
    let mut simulation = load(clock);
    simulation.run_to_tick(ticks).unwrap();
    take(simulation.world_mut());
    let ran = simulation.run_to_end();
    (simulation, ran)
}

#[test]
fn a_resource_that_ticks_need_is_named_when_it_is_gone() {
    type Take = fn(&mut World);
    let takes: [(&str, Take); 5] = [
        ("the resource `State` is gone", |world| _ = world.remove_resource::<State>()),
        ("the resource `Schedules` is gone", |world| _ = world.remove_resource::<Schedules>()),
        ("the schedule `Evaluate` is gone", |world| _ = world.resource_mut::<Schedules>().remove(Evaluate)),
        ("the schedule `Modes` is gone", |world| _ = world.resource_mut::<Schedules>().remove(Modes)),
        ("the method of integration", |world| world.insert_resource(State::default())),
    ];
    for clock in CLOCKS {
        for (message, take) in takes {
            for ticks in [0, 5] {
                let (mut simulation, ran) = without(clock, ticks, take);
                let failure = ran.expect_err(message);
                assert!(matches!(failure.wrong, FailureKind::Gone(_)), "{failure:?}");
                let said = failure.to_string();
                assert!(said.contains(message) && said.contains("Put it back"), "{said}");
                assert_eq!(simulation.failure(), Some(&failure));
                if simulation.contains_resource::<State>() {
                    ask_everything(&mut simulation);
                } else {
                    assert!(simulation.snapshot().is_err() && simulation.fork().is_err());
                    let _ = simulation.world();
                    let _ = (simulation.notes(), simulation.outcomes());
                }
            }
        }
    }
}

/// What was put back as it was goes on as if nothing had been.
#[test]
fn what_is_put_back_goes_on() {
    let mut simulation = load(CLOCKS[0]);
    simulation.run_to_tick(5).unwrap();
    let state = simulation.world_mut().remove_resource::<State>().unwrap();
    simulation.run_to_tick(7).unwrap_err();
    simulation.world_mut().insert_resource(state);
    simulation.run_to_end().unwrap();
    let mut other = load(CLOCKS[0]);
    other.run_to_end().unwrap();
    assert_eq!(simulation.bodies().position, other.bodies().position);
}

#[test]
fn resources_that_only_tell_may_go() {
    type Take = fn(&mut World);
    let takes: [(&str, Take); 9] = [
        ("Notes", |world| _ = world.remove_resource::<Notes>()),
        ("Materials", |world| _ = world.remove_resource::<Materials>()),
        ("no materials", |world| world.resource_mut::<Materials>().by_index.clear()),
        ("ChosenMethod", |world| _ = world.remove_resource::<ChosenMethod>()),
        ("Methods", |world| _ = world.remove_resource::<Methods>()),
        ("Expectations", |world| _ = world.remove_resource::<Expectations>()),
        ("Channels", |world| _ = world.remove_resource::<Channels>()),
        ("Plan", |world| _ = world.remove_resource::<Plan>()),
        ("no models", |world| _ = world.resource_mut::<State>().retain_models(|_| false)),
    ];
    for (name, take) in takes {
        for clock in CLOCKS {
            let (mut simulation, ran) = without(clock, 5, take);
            ran.unwrap_or_else(|failure| panic!("{name}: {failure}"));
            ask_everything(&mut simulation);
        }
    }
}

/// Contact events are found by a system in the tick. Bevy names the system and what it misses.
#[test]
#[should_panic(expected = "ContactEvents")]
fn a_resource_of_a_system_in_the_tick_is_named_by_bevy() {
    let _ = without(CLOCKS[0], 5, |world| {
        sensors::find(world, "ball.contacts");
        world.remove_resource::<ContactEvents>();
    });
}

type Tear = fn(&mut Bodies);

const TEARS: [(&str, Tear); 17] = [
    ("entity", |bodies| bodies.entity.clear()),
    ("position", |bodies| bodies.position.clear()),
    ("velocity", |bodies| bodies.velocity.truncate(1)),
    ("force", |bodies| bodies.force.push(DVec2::ONE)),
    ("mass", |bodies| bodies.mass = Vec::new()),
    ("angle_residual", |bodies| bodies.angle_residual.clear()),
    ("dynamic", |bodies| bodies.dynamic.clear()),
    ("collides", |bodies| bodies.collides.clear()),
    ("atom_radius", |bodies| bodies.atom_radius.clear()),
    ("walls", |bodies| bodies.walls.clear()),
    ("belts", |bodies| bodies.belts.truncate(0)),
    ("key", |bodies| bodies.key = Default::default()),
    ("lone_discs", |bodies| bodies.lone_discs = true),
    ("all_dynamic", |bodies| bodies.all_dynamic = true),
    ("prescribed", |bodies| bodies.prescribed.motions.iter_mut().for_each(|(body, _)| *body = 99)),
    ("asleep", |bodies| bodies.asleep = vec![0; 77]),
    ("awake", |bodies| (bodies.asleep, bodies.awake) = (vec![0], vec![4000])),
];

fn assert_torn(list: &'static str, place: &str, ran: Result<(), Failure>, simulation: &mut Simulation) {
    // Belts may all be stopped at once.
    if list == "belts" {
        return ran.unwrap_or_else(|failure| panic!("{failure}"));
    }
    let failure = ran.expect_err(&format!("{list}, {place}"));
    assert_eq!(failure.wrong, FailureKind::Torn(list), "{place}");
    assert!(failure.to_string().contains(&format!("`{list}`")), "{failure}");
    let count = simulation.bodies().len();
    assert_eq!((count, simulation.bodies().position.len()), (3, 3), "{list}");
    ask_everything(simulation);
}

/// Between ticks and in systems, before and after the integrator, and within evaluations.
#[test]
fn lists_of_bodies_that_do_not_fit_are_named() {
    #[derive(Resource)]
    struct Wanted(Tear);
    fn tear(mut state: ResMut<State>, wanted: Res<Wanted>) {
        if state.clock().ticks >= 5 {
            wanted.0(state.bodies_mut());
        }
    }
    for (list, tears) in TEARS {
        for clock in CLOCKS {
            let (mut simulation, ran) = without(clock, 5, |world| tears(world.resource_mut::<State>().bodies_mut()));
            assert_torn(list, "between", ran, &mut simulation);
            // The bodies were read from their components again, and the run can go on.
            simulation.run_to_end().unwrap_or_else(|failure| panic!("{list}: {failure}"));
            for place in ["begin", "observe", "evaluate", "components"] {
                let plugin = move |app: &mut bevy_app::App| {
                    app.insert_resource(Wanted(tears));
                    match place {
                        "begin" => app.add_packed_systems(SimTick, tear.in_set(Stage::Begin)),
                        "observe" => app.add_packed_systems(SimTick, tear.in_set(Stage::Observe)),
                        "evaluate" => app.add_packed_systems(Evaluate, tear.in_set(EvaluateStage::Systems)),
                        _ => app.add_systems(SimTick, tear.in_set(Stage::Begin)),
                    };
                };
                let mut simulation = Simulation::load_with(&scene(clock), &Overrides::default(), plugin).unwrap();
                let ran = simulation.run_to_end();
                assert_torn(list, place, ran, &mut simulation);
            }
        }
    }
}

#[test]
fn lists_that_were_taken_are_missed() {
    let (mut simulation, ran) =
        without(CLOCKS[0], 5, |world| _ = std::mem::take(world.resource_mut::<State>().bodies_mut()));
    assert_eq!(ran.unwrap_err().wrong, FailureKind::Torn("all of them"));
    assert_eq!(simulation.bodies().len(), 3);
    ask_everything(&mut simulation);
}

/// A component that each body has.
#[test]
fn a_component_that_a_body_has_lost_is_named() {
    let (mut simulation, ran) = without(CLOCKS[0], 5, |world| {
        let ball = world.resource::<State>().bodies().entity[0];
        world.entity_mut(ball).remove::<Mass>();
        let brick = world.resource::<State>().bodies().entity[1];
        world.despawn(brick);
    });
    let failure = ran.unwrap_err();
    assert_eq!((failure.body.as_str(), failure.wrong), ("ball", FailureKind::Lost("Mass")));
    let said = failure.to_string();
    assert!(said.contains("`ball` has lost its component `Mass` at t = ") && said.contains(": put it back"), "{said}");
    ask_everything(&mut simulation);
    let ball = simulation.bodies().entity[0];
    simulation.world_mut().despawn(ball);
    simulation.run_to_end().unwrap();
    assert_eq!(simulation.bodies().len(), 1);
}

/// Bodies and walls that go, all at once or one at a time, are no mistake.
#[test]
fn bodies_may_go_at_any_time() {
    for clock in CLOCKS {
        for at_once in [false, true] {
            let (mut simulation, ran) = without(clock, 5, |world| {
                let bodies = world.resource::<State>().bodies();
                let mut all = bodies.entity.clone();
                all.extend(bodies.walls.iter().map(|wall| wall.entity));
                for entity in if at_once { all } else { all[..1].to_vec() } {
                    world.despawn(entity);
                }
            });
            ran.unwrap();
            assert_eq!(simulation.bodies().len(), if at_once { 0 } else { 2 });
            ask_everything(&mut simulation);
        }
    }
}

/// A component that holds NaN or an infinite number ends the run with the name of the body.
#[test]
fn nan_and_infinite_values_are_told() {
    for clock in CLOCKS {
        for wrong in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
            for spoil in [
                (|world: &mut World, ball, wrong| world.get_mut::<Position>(ball).unwrap().0.x = wrong)
                    as fn(&mut World, Entity, f64),
                |world, ball, wrong| world.get_mut::<Velocity>(ball).unwrap().0.y = wrong,
                |world, _, wrong| world.resource_mut::<State>().bodies_mut().position[0].y = wrong,
            ] {
                let (mut simulation, ran) = without(clock, 5, |world| {
                    let ball = world.resource::<State>().bodies().entity[0];
                    spoil(world, ball, wrong);
                });
                let failure = ran.unwrap_err();
                assert!(matches!(failure.wrong, FailureKind::NotFinite(_)), "{failure}");
                assert_eq!(failure.body, "ball");
                ask_everything(&mut simulation);
            }
        }
    }
}

/// A plugin that puts all bodies into one place, or makes them so large that all touch.
#[test]
fn heaps_that_plugins_make_end_the_run() {
    let text = r#"Scene(format: 1, clock: (duration: 1, tick: 0.001), bodies: [Repeat(count: (60, 30),
        grid: (from: (0, 0), step: (1, 1)), make: (name: "b_{i}_{j}", at: ("x", "y"), atoms: Disc(radius: 0.4)))])"#;
    for change in [
        (|bodies| bodies.position.fill(DVec2::ONE)) as Tear,
        |bodies| bodies.atom_radius.fill(100.0),
        |bodies| bodies.atom_radius[3] = f64::INFINITY,
        |bodies| bodies.atom_radius[3] = f64::NAN,
        |bodies| bodies.atom_radius.fill(f64::NAN),
        |bodies| bodies.atom_radius.fill(-1.0),
        |bodies| bodies.atom_radius.fill(0.0),
    ] {
        for threads in [1, 2] {
            let overrides = Overrides { threads: Some(threads), ..Overrides::default() };
            let mut simulation = Simulation::load_with(&Source::new("heap.ron", text), &overrides, |_| {}).unwrap();
            simulation.run_to_tick(2).unwrap();
            let mut state = simulation.world_mut().resource_mut::<State>();
            change(state.bodies_mut());
            state.bodies_mut().touched = true;
            state.bodies_mut().generation += 1;
            let ran = simulation.run_to_tick(4);
            let changed = simulation.bodies().atom_radius[0];
            if changed == 100.0 || simulation.bodies().position[0] == DVec2::ONE {
                let failure = ran.unwrap_err();
                assert_eq!(failure.wrong, FailureKind::Pairs(1 << 19));
                assert_eq!(failure.body, "b_0_0");
                assert!(simulation.snapshot().is_err());
            }
            ask_everything(&mut simulation);
        }
    }
}

/// Values that a program may pass by mistake: an error, or a run.
#[test]
fn overrides_that_cannot_be_are_refused() {
    let odd = [f64::NAN, f64::INFINITY, -f64::INFINITY, -1.0, 0.0, 1e-300, 1e300];
    let load = |overrides: Overrides| {
        let _ = Simulation::load_with(&scene(CLOCKS[0]), &overrides, |_| {}).map(|mut simulation| {
            let _ = simulation.run_to_tick(3);
        });
    };
    for value in odd {
        load(Overrides { tick: Some(value), ..Overrides::default() });
        load(Overrides { duration: Some(value), ..Overrides::default() });
        load(Overrides { stiffness: Some(value), ..Overrides::default() });
        load(Overrides { tolerance: Some(value), untried: true, ..Overrides::default() });
    }
    for threads in [0, 1, 1000] {
        load(Overrides { threads: Some(threads), ..Overrides::default() });
    }
    for word in ["", "Nonsense", "\0"] {
        load(Overrides { method: Some(word.to_owned()), ..Overrides::default() });
        load(Overrides { layers: Some(vec![word.to_owned()]), ..Overrides::default() });
    }
    let plan = Simulation::load(&scene(CLOCKS[0])).unwrap().plan().cloned().unwrap();
    for value in odd {
        load(Overrides { plan: Some(Plan { tick: value, ..plan.clone() }), ..Overrides::default() });
    }
    load(Overrides { plan: Some(Plan { pace: StepPace::Even(0), ..plan.clone() }), ..Overrides::default() });
    load(Overrides { plan: Some(Plan { method: "Nonsense".to_owned(), ..plan }), ..Overrides::default() });
    let nothing = Simulation::load_only(&scene(CLOCKS[0]), &Overrides::default(), |_| {});
    assert!(nothing.is_err());
}

#[test]
#[should_panic(expected = "its time has to be a finite number")]
fn a_frame_of_no_time_panics_as_documented() {
    let _ = Recorder::default().frame(&mut load(CLOCKS[0]), f64::NAN);
}
