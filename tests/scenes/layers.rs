//! Layers of films show the state and change nothing.

use jostle::Simulation;
use jostle::record::MarkShape;
use jostle::record::frame::Frame;
use jostle::record::layers::PictureHeight;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle::simulation::Recorder;
use jostle::world::hash::state_hash;

fn load(sections: &str, look: &str) -> Simulation {
    let text = format!("Scene(format: 1, clock: (duration: 4, tick: \"1 ms\"), {sections}, {look})");
    Simulation::load(&Source::new("layers.ron", text)).unwrap_or_else(|errors| panic!("{errors}"))
}

const FLIGHT: &str = "gravity: (0, -10), bodies: [
    (name: \"ball\", at: (0, 0), velocity: (3, 20), collides: false, atoms: Disc(radius: 0.1))]";

const PILE: &str = "gravity: (0, -10),
    materials: { \"m\": (stiffness: 2000, friction: 0.5, inelasticity: 0.4) },
    walls: [(name: \"floor\", left: (5, 0), right: (0, 0), material: \"m\")],
    bodies: [
        (name: \"low\", at: (2, 0.21), material: \"m\", atoms: Picture(spacing: 0.2, mass: 0.05, rows: [\"####\", \"####\"])),
        (name: \"high\", at: (2, 0.62), material: \"m\", atoms: Picture(spacing: 0.2, mass: 0.05, rows: [\"####\", \"####\"])),
    ]";

fn frame(simulation: &mut Simulation, recorder: &mut Recorder, time: f64) -> Frame {
    recorder.frame(simulation, time).expect("numbers stay finite")
}

fn trail(frame: &Frame) -> (Vec<glam::DVec2>, f64) {
    let mut trails = frame.marks.iter().filter_map(|mark| match &mark.shape {
        MarkShape::Trail { points, step, .. } => Some((points.clone(), *step)),
        _ => None,
    });
    trails.next_back().expect("a trail")
}

/// Law: `x = v t - g t^2/2`, which velocity Verlet meets to rounding. Tolerance: 1e-9 of the way, for some thousand sums.
/// Points lie on the path, no farther apart in time than a 256th of the trail or a tick, and their number does not grow.
#[test]
fn a_trail_is_the_way_the_body_came() {
    let mut simulation = load(FLIGHT, "look: (layers: [Trails(seconds: 0.5)])");
    let mut recorder = Recorder::default();
    let mut counts = Vec::new();
    for time in [0.0, 0.7, 1.0, 1.01, 2.345_67, 3.9] {
        let (points, step) = trail(&frame(&mut simulation, &mut recorder, time));
        counts.push(points.len());
        let spacing = step * 0.5;
        // 0.5 s in 256 parts are 1.95 ms: two ticks.
        assert!((spacing - 0.002).abs() < 1e-12, "{spacing}");
        for (index, point) in points.iter().enumerate() {
            let t = point.x / 3.0;
            assert!((point.y - (20.0 * t - 5.0 * t * t)).abs() < 1e-9 * 80.0, "{point} at {time}");
            // The end of the tick in which the frame lies; the youngest step may be shorter than the others.
            let age = (points.len() - 1 - index) as f64 * spacing;
            assert!(t <= time + 0.001 + 1e-9 && t >= time - age - 0.002 - 1e-9, "{t} of a frame at {time}, age {age}");
        }
    }
    assert_eq!(counts[0], 2, "where the body is, twice");
    assert!(counts[1..].iter().all(|count| (251..=257).contains(count)), "{counts:?}");
}

/// Newton's first law: what lies still is borne with its weight. Two blocks of eight atoms of 50 g lie on each other: 4 N
/// between them, 8 N on the floor at 10 m/s2. With 4 N for a tenth of a picture 3 m high the arrows are 0.3 m and 0.6 m
/// long; with 2 N they would be 0.6 m and 1.2 m, which is cut. Tolerance: at rest forces balance to rounding; 1e-6 m is far
/// above that and far below any other sum of forces.
#[test]
fn arrows_of_forces_at_rest_are_as_long_as_the_weight_they_bear() {
    let arrows = |scale: &str| {
        let mut simulation = load(PILE, &format!("look: (layers: [ContactForces(scale: \"{scale}\")])"));
        simulation.world_mut().insert_resource(PictureHeight(3.0));
        let marks = frame(&mut simulation, &mut Recorder::default(), 3.5).marks;
        marks.into_iter().map(|mark| mark.shape).collect::<Vec<_>>()
    };
    let whole = arrows("4 N");
    let Some(MarkShape::Key { length, text }) = whole.first() else { panic!("{whole:?}") };
    assert!((length - 0.3).abs() < 1e-12 && text == "4 N", "{length} {text}");
    let mut found: Vec<f64> = Vec::new();
    for shape in &whole[1..] {
        let MarkShape::Arrow(from, to) = shape else { panic!("{shape:?}") };
        assert!((to.x - from.x).abs() < 1e-6, "{shape:?}");
        found.push(to.y - from.y);
    }
    found.sort_by(f64::total_cmp);
    assert_eq!(found.len(), 2, "{whole:?}");
    assert!((found[0] - 0.3).abs() < 1e-6 && (found[1] - 0.6).abs() < 1e-6, "{found:?}");
    // An arrow that would be longer than three tenths of the picture is cut, and says so.
    let cut = arrows("2 N");
    assert!(
        matches!(
            cut[1..],
            [MarkShape::Arrow(..), MarkShape::LongArrow(..)] | [MarkShape::LongArrow(..), MarkShape::Arrow(..)]
        ),
        "{cut:?}"
    );
}

/// Newton's first law on an incline: the slope is 30 degrees steep and rough enough to hold the block, so that the normal force is
/// `m g cos 30` across the slope, friction `m g sin 30` up the slope, and weight `m g` down: 1 kg, 10 m/s2. The picture is 10 m high and
/// 10 N are a tenth of it, so that an arrow of 1 m stands for 10 N. Tolerance: at rest forces balance to rounding; 1e-6 is far above that.
#[test]
fn a_free_body_diagram_shows_weight_normal_force_and_friction() {
    let slope = "gravity: (0, -10), materials: { \"m\": (stiffness: 1e5, friction: 0.9, restitution: 0) },
        walls: [(name: \"slope\", left: (8.660254037844386, 5), right: (0, 0), material: \"m\")],
        bodies: [(name: \"block\", at: (4.2, 2.6), angle: \"30 deg\", material: \"m\",
            atoms: Picture(spacing: 0.2, mass: 0.125, rows: [\"####\", \"####\"]))]";
    let mut simulation = load(slope, "look: (layers: [FreeBody(of: \"block\", scale: \"10 N\")])");
    simulation.world_mut().insert_resource(PictureHeight(10.0));
    let marks = frame(&mut simulation, &mut Recorder::default(), 3.9).marks;
    let shown = |name: &str| {
        let labelled = marks.windows(2).filter_map(|pair| match (&pair[0].shape, &pair[1].shape) {
            (MarkShape::Arrow(from, to), MarkShape::Label { text, .. }) if text == name => Some(*to - *from),
            _ => None,
        });
        labelled.collect::<Vec<_>>()
    };
    let (sin, cos) = (0.5, 0.75_f64.sqrt());
    let along = glam::DVec2::new(cos, sin);
    for (name, expected) in [("weight", -glam::DVec2::Y), ("normal", along.perp() * cos), ("friction", along * sin)] {
        let found = shown(name);
        assert!(matches!(found[..], [arrow] if (arrow - expected).length() < 1e-6), "{name}: {found:?} {expected}");
    }
    assert_eq!(shown("spring").len() + shown("joint").len(), 0);
}

/// A weight on a rod: the joint pulls at its anchor with `m g`, and nothing else but the weight acts. As above 1 m for 10 N.
#[test]
fn a_free_body_diagram_shows_joints_at_their_anchors() {
    let hung = "gravity: (0, -10), contacts: None,
        bodies: [(name: \"bob\", at: (0, -1), mass: 2, inertia: 1, atoms: Disc(radius: 0.1))],
        joints: [Revolute(name: \"pin\", a: World, anchor_a: (0, 0.5), b: \"bob\", anchor_b: (0, 1.5))]";
    let mut simulation = load(hung, "look: (layers: [FreeBody(parts: [Joint], names: false, scale: \"10 N\")])");
    simulation.world_mut().insert_resource(PictureHeight(10.0));
    let marks = frame(&mut simulation, &mut Recorder::default(), 1.0).marks;
    let arrows: Vec<_> = marks.iter().filter(|mark| matches!(mark.shape, MarkShape::Arrow(..))).collect();
    let [mark] = arrows[..] else { panic!("{marks:?}") };
    let MarkShape::Arrow(from, to) = mark.shape else { panic!("{mark:?}") };
    assert!((from - glam::DVec2::new(0.0, 0.5)).length() < 1e-9, "{from}");
    assert!((to - from - glam::DVec2::new(0.0, 2.0)).length() < 1e-9, "{to}");
    assert!(!marks.iter().any(|mark| matches!(mark.shape, MarkShape::Label { .. })));
}

/// With all layers a film takes the run through the same states as without one, to the last bit.
#[test]
fn layers_change_nothing_of_the_run() {
    let all = "look: (layers: [Trails, Trails(of: \"high\", seconds: 0.37), ContactForces, FreeBody, Velocities, ContactPoints, Boxes, Names, ScaleBar, Time])";
    let mut bare = load(PILE, "");
    bare.run_to_tick(2500).expect("numbers stay finite");
    let mut filmed = load(PILE, all);
    let mut recorder = Recorder::default();
    for number in 0..=75 {
        frame(&mut filmed, &mut recorder, f64::from(number) / 30.0);
    }
    filmed.run_to_tick(2500).expect("numbers stay finite");
    assert_eq!(state_hash(bare.bodies()), state_hash(filmed.bodies()));
}

/// What a film shows without being told, with a list, and with the wishes of the caller.
#[test]
fn films_show_the_layers_that_are_asked_for() {
    let shown = |look: &str, wanted: Option<&[&str]>| {
        let text = format!("Scene(format: 1, clock: (duration: 1), {FLIGHT}, {look})");
        let layers = wanted.map(|words| words.iter().map(|word| (*word).to_owned()).collect());
        let overrides = Overrides { layers, ..Overrides::default() };
        let mut simulation =
            Simulation::load_with(&Source::new("layers.ron", text), &overrides, |_| {}).expect("a correct scene");
        let marks = frame(&mut simulation, &mut Recorder::default(), 0.5).marks;
        let word = |shape: &MarkShape| match shape {
            MarkShape::ScaleBar => "scale",
            MarkShape::Time => "time",
            MarkShape::Trail { .. } => "trail",
            MarkShape::Label { .. } => "name",
            _ => "other",
        };
        marks.iter().map(|mark| word(&mark.shape)).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(shown("", None), "scale time");
    assert_eq!(shown("look: (theme: \"night\")", None), "scale time");
    assert_eq!(shown("look: (layers: [])", None), "");
    assert_eq!(shown("look: (layers: [Names])", None), "name");
    assert_eq!(shown("look: (layers: [Names])", Some(&["trails", "names", "time"])), "name trail time");
    assert_eq!(shown("", Some(&["names"])), "name scale time");
    assert_eq!(shown("look: (layers: [Names, Time])", Some(&[])), "");
}
