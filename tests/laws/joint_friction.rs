//! Laws of friction in linkages: it keeps to its bound where other joints and motors move the joint on.
//!
//! Friction in a joint takes its bound times the way of the joint as long as it moves. The rate of the joint may change
//! its sign while the linkage moves on, at dead points. Then friction reverses, because to stick there would take more
//! than its bound. Reference values: closed forms, or one equation for the one angle that is free (Lagrange),
//! integrated here by the classical Runge-Kutta method in steps of 1e-5 s, whose error is below 1e-9. Tolerance: under
//! methods from tick to tick friction turns at the end of a tick, so that it is wrong for one tick at each turn: the
//! loss by the bound times the way of that tick, the angle by what passes within a tick.

use jostle::scene::Source;
use jostle::tick::FailureKind;
use jostle::{Simulation, SimulationExt};

const METHODS: [&str; 4] = ["VelocityVerlet", "SemiImplicitEuler", "RungeKutta4", "Dop853"];
const TICK: f64 = 1e-3;

fn text(method: &str, scene: &str) -> Source {
    let clock = format!("format: 1, clock: (duration: 1, tick: {TICK:?}, method: {method}), contacts: None");
    Source::new("friction.ron", format!("Scene({clock}, {scene})"))
}

fn load(method: &str, scene: &str) -> Simulation {
    Simulation::load(&text(method, scene)).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Radius of the crank in m, length of the rod in m, friction of the slide in N.
const CRANK: f64 = 0.1;
const ROD_SQUARED: f64 = 0.17;
const FRICTION: f64 = 0.5;

fn slider_crank(motor: &str) -> String {
    format!(
        "bodies: [(name: \"crank\", at: (0, {CRANK}), angle: \"90 deg\", spin: 6, mass: 1, inertia: 0.01, atoms: Disc(radius: 0.02)),
            (name: \"piston\", at: (0.4, 0), mass: 1, atoms: Disc(radius: 0.05))],
        joints: [Revolute(name: \"hub\", a: World, anchor_a: (0, 0), b: \"crank\", anchor_b: (-{CRANK}, 0)),
            Distance(name: \"rod\", a: \"crank\", b: \"piston\"),
            Prismatic(name: \"slide\", a: World, b: \"piston\", axis: (1, 0), friction: {FRICTION})], {motor}"
    )
}

/// The place of the piston at an angle of the crank, its derivative and the second one: `r cos a + sqrt(l^2 - r^2 sin^2 a)`.
fn piston(angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let rod = (ROD_SQUARED - (CRANK * sin).powi(2)).sqrt();
    let slope = -CRANK * sin - CRANK * CRANK * sin * cos / rod;
    let bend = -CRANK * cos
        - CRANK * CRANK * (cos * cos - sin * sin) / rod
        - CRANK.powi(4) * (sin * cos).powi(2) / rod.powi(3);
    [CRANK * cos + rod, slope, bend]
}

/// Angle of the crank in rad and energy lost in J after one second: `(I + m r^2 + m x'^2) a'' + m x' x'' a'^2 = -f sign(x' a') x'`.
fn truth() -> (f64, f64) {
    let rates = |[angle, spin, _]: [f64; 3]| {
        let [_, slope, bend] = piston(angle);
        let friction = FRICTION * (slope * spin).signum();
        let inertia = 0.01 + CRANK * CRANK + slope * slope;
        [spin, (-slope * bend * spin * spin - friction * slope) / inertia, friction * slope * spin]
    };
    // The joints leave 0.01 x 6 N m s of momentum to 0.03 kg m2.
    let mut state = [std::f64::consts::FRAC_PI_2, 2.0, 0.0];
    let h = 1e-5;
    for _ in 0..100_000 {
        let plus = |rates: [f64; 3], share: f64| std::array::from_fn(|at| state[at] + share * h * rates[at]);
        let first = rates(state);
        let second = rates(plus(first, 0.5));
        let third = rates(plus(second, 0.5));
        let fourth = rates(plus(third, 1.0));
        state = std::array::from_fn(|at| {
            state[at] + h / 6.0 * (first[at] + 2.0 * second[at] + 2.0 * third[at] + fourth[at])
        });
    }
    (state[0] - std::f64::consts::FRAC_PI_2, state[2])
}

#[test]
fn a_linkage_runs_down_by_the_friction_of_its_slide() {
    let (turned, lost) = truth();
    for method in METHODS {
        let mut simulation = load(method, &slider_crank(""));
        let begin = simulation.bodies().angle[0];
        simulation.run_to_end().expect("numbers stay finite");
        let found = simulation.bodies().angle[0] - begin;
        let energy = simulation.card().energy;
        let staged = method == "RungeKutta4" || method == "Dop853";
        let allowed = if staged { 1e-8 } else { 2.0 * TICK };
        assert!((found - turned).abs() <= allowed, "{method}: {found} instead of {turned}");
        let allowed = if staged { 1e-9 } else { FRICTION * 0.3 * TICK };
        assert!((energy.friction - lost).abs() <= allowed, "{method}: {} J instead of {lost} J", energy.friction);
    }
}

/// A motor turns the crank at 6 rad/s: the slide goes to and fro, and friction takes its bound times the way.
#[test]
fn a_motor_drives_a_slide_with_friction_through_its_dead_points() {
    let way: f64 = (0..1_000_000)
        .map(|step| 6e-6 * piston(std::f64::consts::FRAC_PI_2 + 6e-6 * (f64::from(step) + 0.5))[1].abs())
        .sum();
    for method in METHODS {
        let mut simulation =
            load(method, &slider_crank("controllers: [Motor(name: \"drive\", of: \"hub\", speed: 6)]"));
        let begin = simulation.bodies().angle[0];
        simulation.run_to_end().expect("numbers stay finite");
        let (turned, energy) = (simulation.bodies().angle[0] - begin, simulation.card().energy);
        // The hub goes along chords of its circle: of the angle the square of what passes in a tick is missing at most.
        let passes = 6.0 * TICK;
        assert!((turned - 6.0).abs() < 6.0 * passes * passes, "{method}: {turned}");
        let allowed = 2.0 * FRICTION * 0.65 * TICK;
        assert!((energy.friction - FRICTION * way).abs() < allowed, "{method}: {} J of {way} m", energy.friction);
        // Of order 1 under semi-implicit Euler: what passes in a tick, of the greatest kinetic energy, 0.55 J.
        assert!(energy.residual.abs() < 0.55 * passes, "{method}: {} J", energy.residual);
    }
}

/// Two slides, a rod between them: the motor of one moves the other against its friction over one metre.
#[test]
fn a_motor_moves_a_slide_with_friction_through_a_rod() {
    for method in METHODS {
        let mut simulation = load(
            method,
            "bodies: [(name: \"p\", at: (0, 0), mass: 1, atoms: Disc(radius: 0.05)), (name: \"q\", at: (1, 0), mass: 1, atoms: Disc(radius: 0.05))],
             joints: [Prismatic(name: \"s\", a: World, b: \"p\", axis: (1, 0)), Distance(a: \"p\", b: \"q\"),
                Prismatic(name: \"f\", a: World, b: \"q\", axis: (1, 0), friction: 0.5)],
             controllers: [Motor(name: \"m\", of: \"s\", speed: 1)]",
        );
        simulation.run_to_end().expect("numbers stay finite");
        let energy = simulation.card().energy;
        // A thousand ticks round once each.
        assert!((energy.friction - 0.5).abs() < 1e-12 && (energy.work - 0.5).abs() < 1e-12, "{method}: {energy:?}");
    }
}

const TWO_SLIDES: &str = "bodies: [(name: \"p\", at: (0, 0), mass: 1, atoms: Disc(radius: 0.05)), (name: \"q\", at: (1, 0), mass: 1, atoms: Disc(radius: 0.05))]";

/// A motor without a limit drives one slide, and the other one comes to its limit: no motion suits both, and the run says so then.
#[test]
fn a_motor_that_jams_ends_the_run() {
    let scene = format!(
        "{TWO_SLIDES}, joints: [Prismatic(name: \"s\", a: World, b: \"p\", axis: (1, 0)), Distance(a: \"p\", b: \"q\"),
            Prismatic(name: \"f\", a: World, b: \"q\", axis: (1, 0), limits: (-1, 0.3))],
         controllers: [Motor(of: \"s\", speed: 1)]"
    );
    for method in METHODS {
        let failure = load(method, &scene).run_to_end().expect_err("a jam");
        assert_eq!(failure.wrong, FailureKind::Contradiction, "{method}: {failure}");
        assert!((failure.time - 0.3).abs() <= 2.0 * TICK, "{method}: {failure}");
    }
    // With a limit the motor stands.
    let bounded = scene.replace("speed: 1)", "speed: 1, limit: 5)");
    let mut simulation = load("VelocityVerlet", &bounded);
    simulation.run_to_end().expect("the motor gives way");
    assert!((simulation.bodies().position[1].x - 1.3).abs() < 1e-9, "{:?}", simulation.bodies().position);
}

/// Two motors of one joint that ask for different rates, and a motor on a body that is welded down.
#[test]
fn motors_that_contradict_each_other_are_refused() {
    let wheel = "bodies: [(name: \"w\", at: (0, 0), mass: 1, inertia: 0.1, atoms: Disc(radius: 0.1))]";
    let two = "joints: [Revolute(name: \"h\", a: World, b: \"w\")], controllers: [Motor(of: \"h\", speed: 1), Motor(of: \"h\", speed: 2)]";
    let welded = "joints: [Revolute(name: \"h\", a: World, b: \"w\"), Weld(a: World, b: \"w\")], controllers: [Motor(of: \"h\", speed: 1)]";
    for scene in [two, welded] {
        let refused = Simulation::load(&text("VelocityVerlet", &format!("{wheel}, {scene}"))).err().expect("refused");
        let told = refused.to_string();
        assert!(told.contains("motors and joints ask for different motions of `w`"), "{told}");
    }
    let agreed = two.replace("speed: 2", "speed: 1");
    let mut simulation = load("VelocityVerlet", &format!("{wheel}, {agreed}"));
    simulation.run_to_end().expect("both ask for the same");
}

/// Law: with `events: PerTick` friction turns round, motors come off their limit and joints break at the ends of ticks, under methods with
/// stages too. Scenes: a block on a spring with friction, which loses `2 F/k` of its amplitude in each half swing and stops after 17 of
/// them at 0.02 m; a motor with a limit and friction, which reaches its speed after 1.667 s; a rod that breaks at 20 N, after `T = 3 m g
/// sin a`, by 0.394 s. Tolerance: friction is wrong for a tick at each turn, which changes the
/// speed by `2 F dt/m`, and the amplitude by that over `w` = 10 rad/s; the loss by the bound times the way in a tick at 10 m/s.
#[test]
fn joints_switch_at_ticks_under_all_methods() {
    for method in ["VelocityVerlet", "SemiImplicitEuler", "RungeKutta4", "Dop853", "Symplectic4", "ImplicitMidpoint"] {
        let run = |duration: f64, gravity: f64, scene: &str| {
            let clock = format!("duration: {duration:?}, tick: {TICK:?}, method: {method}, events: PerTick");
            let text =
                format!("Scene(format: 1, clock: ({clock}), gravity: (0, {gravity:?}), contacts: None, {scene})");
            let mut simulation =
                Simulation::load(&Source::new("per_tick.ron", text)).unwrap_or_else(|errors| panic!("{errors}"));
            simulation.run_to_end().unwrap();
            simulation
        };
        let block = run(
            7.0,
            0.0,
            "bodies: [(name: \"block\", at: (1, 0), mass: 1, atoms: Disc(radius: 0.1))],
            joints: [Prismatic(a: World, anchor_a: (0, 0), b: \"block\", axis: (1, 0), friction: \"3 N\")],
            forces: [Spring(a: \"block\", b: World, stiffness: 100, length: 0)]",
        );
        let (at, lost) = (block.bodies().position[0].x, block.card().energy.friction);
        assert!((at.abs() - 0.02).abs() < 17.0 * 2.0 * 3.0 * TICK / 10.0, "{method}: stops at {at} m");
        assert!((lost - 49.98).abs() < 17.0 * 10.0 * TICK * 3.0, "{method}: {lost} J");
        let wheel = run(
            3.0,
            0.0,
            "bodies: [(name: \"b\", at: (0, 0), mass: 1, inertia: 0.2, atoms: Disc(radius: 0.1))],
            joints: [Revolute(name: \"hub\", a: World, anchor_a: (0, 0), b: \"b\", friction: \"0.5 N m\")],
            forces: [Torque(of: \"b\", value: -0.3)], controllers: [Motor(of: \"hub\", speed: 10, limit: 2)]",
        );
        assert!((wheel.bodies().spin[0] - 10.0).abs() < 1e-9, "{method}: {} rad/s", wheel.bodies().spin[0]);
        let rod = run(
            1.0,
            -9.81,
            "bodies: [(name: \"b\", at: (1, 0), mass: 1, inertia: 0.1, atoms: Disc(radius: 0.1))],
            joints: [Distance(a: World, anchor_a: (0, 0), b: \"b\", break_force: 20)]",
        );
        let note = rod.card().notes.iter().any(|note| note.contains("broke"));
        assert!(note && rod.bodies().position[0].length() > 1.5, "{method}: {:?}", rod.card().notes);
    }
}

/// Law: bounds of friction in joints that a gear couples add up, in both directions, whatever slipped before, and at a limit too. A torque
/// `A sin(w t)` on wheels of together `I` makes them slip from `A sin(w t) = F` on, until `A (cos(w b) - cos(w t))/w = F (t - b)`, or to the
/// limit, and in the next half of the period as far back. Tolerance: events are located to 1e-12 of a turn.
#[test]
fn frictions_that_a_gear_couples_add_up_in_both_directions() {
    const AMPLITUDE: f64 = 1.25;
    const SUM: f64 = 1.0;
    const INERTIA: f64 = 0.4;
    const PACE: f64 = std::f64::consts::PI;
    let scene = |clock: &str, share: f64, (low, high): (f64, f64)| {
        let (less, more) = (share * SUM, (1.0 - share) * SUM);
        format!(
            "Scene(format: 1, clock: (duration: 6, {clock}), contacts: None,
             bodies: [(name: \"a\", at: (0, 0), mass: 1, inertia: 0.1, atoms: Disc(radius: 0.1)),
                (name: \"b\", at: (1, 0), mass: 1, inertia: 0.3, atoms: Disc(radius: 0.1))],
             joints: [Revolute(name: \"pin\", a: World, b: \"a\", friction: {less:?}),
                Revolute(name: \"hub\", a: World, b: \"b\", friction: {more:?}, limits: ({low:?}, {high:?})),
                GearPair(of: (\"pin\", \"hub\"), ratio: -1)],
             controllers: [Actuator(of: \"hub\", force: Sine(amplitude: {AMPLITUDE:?}, frequency: 0.5))])"
        )
    };
    let begin = (SUM / AMPLITUDE).asin() / PACE;
    let spin = |t: f64| (AMPLITUDE * ((PACE * begin).cos() - (PACE * t).cos()) / PACE - SUM * (t - begin)) / INERTIA;
    let (mut moves, mut stands) = (0.5, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (moves + stands);
        *(if spin(middle) > 0.0 { &mut moves } else { &mut stands }) = middle;
    }
    let slips = stands - begin;
    let swing = slips * (PACE * begin).cos() - ((PACE * stands).sin() - (PACE * begin).sin()) / PACE;
    let way = (AMPLITUDE * swing / PACE - 0.5 * SUM * slips * slips) / INERTIA;
    // The way after 0.4 s of a half of the period.
    let begun = AMPLITUDE * (0.4 - begin) * (PACE * begin).cos() / PACE
        - AMPLITUDE * ((PACE * 0.4).sin() - (PACE * begin).sin()) / (PACE * PACE)
        - 0.5 * SUM * (0.4 - begin).powi(2);
    let begun = begun / INERTIA;
    assert!(begun > 1e-4 && begun < 0.03 && way > 0.05, "{begun} {way}");
    let limits = [(-9.0, 9.0), (-9.0, 0.03), (-0.02, 0.03)];
    let cases = limits.into_iter().flat_map(|limits| CLOCKS.map(|clock| (limits, clock)));
    for (limits, clock, share) in
        cases.flat_map(|(limits, clock)| [0.1, 0.3, 0.5, 0.95].map(|share| (limits, clock, share)))
    {
        let source = Source::new("gears.ron", scene(clock, share, limits));
        let mut simulation = Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"));
        let mut at = 0.0_f64;
        for half in 0..6 {
            let way_to = |way: f64| if half % 2 == 0 { (at + way).min(limits.1) } else { (at - way).max(limits.0) };
            for (time, exact) in [(0.4, way_to(begun)), (1.0, way_to(way))] {
                let tick = ((f64::from(half) + time) / simulation.card().tick).round() as u64;
                simulation.run_to_tick(tick).unwrap_or_else(|failure| panic!("{failure}"));
                let off = simulation.bodies().angle[1] - exact;
                let of = format!("{clock}, limits {limits:?}, share {share}, half {half}");
                assert!(off.abs() < 1e-11, "{of} after {time} s: {exact}, off by {off:e}");
            }
            at = way_to(way);
        }
    }
}

const CLOCKS: [&str; 4] = [
    "method: RungeKutta4, tick: 1e-3",
    "method: Dop853, tick: 2e-3",
    "method: Dop853, tick: 0.02",
    "method: Reference",
];

/// Law: a joint whose greatest friction is zero turns as one without, to the last bit: a sweep may begin there.
#[test]
fn friction_of_zero_is_none() {
    let hash = |friction: &str| {
        let scene = format!(
            "Scene(format: 1, clock: (duration: 1, tick: \"1 ms\", method: VelocityVerlet), gravity: (0, -9.81), contacts: None,
             bodies: [(name: \"rod\", at: (0.5, 0), mass: 2, inertia: 0.1, atoms: Disc(radius: 0.1)), (name: \"sled\", at: (0, 3), mass: 1, atoms: Disc(radius: 0.1))],
             joints: [Revolute(a: World, anchor_a: (0, 0), b: \"rod\", anchor_b: (-0.5, 0){friction}),
                      Prismatic(a: World, b: \"sled\", axis: (1, -1){friction})])"
        );
        let mut simulation =
            Simulation::load(&Source::new("free.ron", scene)).unwrap_or_else(|errors| panic!("{errors}"));
        simulation.run_to_tick(200).unwrap();
        simulation.card().hash
    };
    assert_eq!(hash(", friction: 0"), hash(""));
    assert_ne!(hash(", friction: 0.1"), hash(""));
}
