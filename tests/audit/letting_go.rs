//! Law: a slider on a support with dry friction. The loads give it the acceleration `a` in the frame of its support. It sticks
//! while `|a(t)| <= mu_s g`, and slides by `u' = a(t) - mu_d g sign(u)`. If `u` becomes zero, it sticks or turns round. Source:
//! Coulomb 1785; den Hartog, *Transactions of the ASME* 53, 1931.
//!
//! The reference is that law, integrated here. The acceleration depends on time alone, so Simpson's rule is enough. Bisection
//! finds the times at which sliding begins, turns and ends.
//!
//! Tolerances: a contact at rest along its normal holds without compliance, so only the ticks differ from the law. Methods that
//! locate events have nothing else than the error of the location and of the reference. From tick to tick, each event is seen up
//! to a tick late. A late event leaves a velocity of at most the jump of the acceleration times the tick. The contact breathes
//! with the compliance `mu N/k_t`, which bounds the rest.
//!
//! Not tested: sliders that tip, and normal forces that change.

use std::fmt::Write;

use jostle::Simulation;
use jostle::problems::hard::golden;
use jostle::scene::Source;
use jostle::simulation::Overrides;

const GRAVITY: f64 = 9.81;
/// Tangential over normal stiffness of the default law.
const RATIO: f64 = 0.8;
/// Steps of the reference.
const STEPS: u32 = 40_000;

/// Two coefficients of friction: static, dynamic.
type Coefficients = (f64, f64);

/// The motion relative to the support, and the number of events on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Motion {
    way: f64,
    velocity: f64,
    events: u32,
}

/// Acceleration at both ends and in the middle of `step` seconds: velocity and way after them.
fn advance(load: &impl Fn(f64) -> f64, (time, step): (f64, f64), friction: f64, velocity: f64) -> (f64, f64) {
    let [a, b, c] = [0.0, 0.5, 1.0].map(|share| load(time + share * step) + friction);
    (velocity + step / 6.0 * (a + 4.0 * b + c), step * (velocity + step / 6.0 * (a + 2.0 * b)))
}

/// The share of a step, by bisection, from which on `is_over`.
fn first_share(is_over: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if is_over(middle) { high = middle } else { low = middle }
    }
    high
}

/// The rigid law, for an acceleration `load(t)` without friction.
fn slider(load: impl Fn(f64) -> f64, (static_, dynamic): Coefficients, velocity: f64, duration: f64) -> Motion {
    let (most, slips) = (static_ * GRAVITY, dynamic * GRAVITY);
    let mut motion = Motion { way: 0.0, velocity, events: 0 };
    // The direction in which it slides; zero if it sticks.
    let mut sign = if velocity == 0.0 { 0.0 } else { velocity.signum() };
    let whole = duration / f64::from(STEPS);
    for number in 0..STEPS {
        let (mut now, end) = (f64::from(number) * whole, f64::from(number + 1) * whole);
        while now < end {
            let left = end - now;
            if sign == 0.0 {
                if load(end).abs() <= most {
                    break;
                }
                now += left * first_share(|share| load(now + share * left).abs() > most);
                sign = load(end).signum();
                motion.events += 1;
                continue;
            }
            let before = motion.velocity;
            let after = |share: f64| advance(&load, (now, share * left), -slips * sign, before);
            let turned = |share: f64| after(share).0 * sign < 0.0;
            let turns = turned(1.0);
            let share = if turns { first_share(turned) } else { 1.0 };
            let (velocity, way) = after(share);
            motion.way += way;
            motion.velocity = velocity;
            if turns {
                now += share * left;
                motion.velocity = 0.0;
                motion.events += 1;
                sign = if load(now).abs() <= most { 0.0 } else { load(now).signum() };
            } else {
                now = end;
            }
        }
    }
    motion
}

/// The support of the slider.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Support {
    Floor,
    /// With this velocity in m/s.
    Belt(f64),
    /// To and fro by so many metres, in so many seconds each way.
    Platform(f64, f64),
}

/// A slider of 1 kg.
#[derive(Clone, Copy, Debug)]
struct Case {
    support: Support,
    coefficients: Coefficients,
    /// Amplitude in N and frequency in Hz of its load.
    load: (f64, f64),
    stiffness: f64,
    is_box: bool,
    duration: f64,
}

impl Case {
    /// A case by number.
    fn drawn(number: usize, support: fn(f64, f64) -> Support) -> Self {
        let mut numbers = golden().skip(7 * number + 3);
        let mut between = |low: f64, high: f64| low + (high - low) * numbers.next().unwrap_or_default();
        let dynamic = between(0.2, 0.6);
        let static_ = if number.is_multiple_of(2) { dynamic } else { dynamic * between(1.05, 1.6) };
        let amplitude = static_ * GRAVITY * between(1.2, 3.0);
        Self {
            support: support(between(0.0, 1.0), between(0.0, 1.0)),
            coefficients: (static_, dynamic),
            load: (amplitude, between(0.4, 2.0)),
            stiffness: 10.0_f64.powf(between(4.5, 6.0)),
            is_box: number % 4 > 1,
            duration: 3.0,
        }
    }

    fn push(&self, time: f64) -> f64 {
        self.load.0 * libm::sin(std::f64::consts::TAU * self.load.1 * time)
    }

    /// Acceleration of the loads in the frame of the support.
    fn acceleration(&self, time: f64) -> f64 {
        let inertial = match self.support {
            Support::Floor | Support::Belt(_) => 0.0,
            Support::Platform(way, half) => {
                let there = (time / half).rem_euclid(2.0);
                let bend = 6.0 * way / (half * half) * (1.0 - 2.0 * there.fract());
                if there < 1.0 { bend } else { -bend }
            }
        };
        self.push(time) - inertial
    }

    fn truth(&self) -> Motion {
        let velocity = if let Support::Belt(velocity) = self.support { -velocity } else { 0.0 };
        slider(|time| self.acceleration(time), self.coefficients, velocity, self.duration)
    }

    /// Relative way of the support in the end.
    fn carried(&self) -> f64 {
        match self.support {
            Support::Floor => 0.0,
            Support::Belt(velocity) => velocity * self.duration,
            Support::Platform(way, half) => {
                let there = (self.duration / half).rem_euclid(2.0);
                let s = there.fract();
                way * if there < 1.0 { s * s * (3.0 - 2.0 * s) } else { 1.0 - s * s * (3.0 - 2.0 * s) }
            }
        }
    }

    /// Elongation in metres of a tangential spring that slips.
    fn compliance(&self) -> f64 {
        let in_series = if matches!(self.support, Support::Platform(..)) { 0.5 } else { 1.0 };
        self.coefficients.0 * GRAVITY / (RATIO * in_series * self.stiffness)
    }

    fn text(&self) -> String {
        let Self {
            support,
            coefficients: (static_, dynamic),
            load: (amplitude, frequency),
            stiffness,
            is_box,
            duration,
        } = *self;
        let in_series = if matches!(support, Support::Platform(..)) { 0.5 } else { 1.0 };
        let contacts = if is_box { 2.0 } else { 1.0 };
        let height = 0.1 - GRAVITY / (contacts * in_series * stiffness);
        let body = if is_box {
            "shape: Rectangle(width: 0.4, height: 0.2, rounding: 0.01)"
        } else {
            "inertia: 1e9, atoms: Disc(radius: 0.1)"
        };
        let mut text = format!(
            "Scene(format: 1, clock: (duration: {duration:?}), gravity: (0, -{GRAVITY:?}),
            materials: {{ \"m\": (stiffness: {stiffness:?}, restitution: 0, friction: (static: {static_:?}, dynamic: {dynamic:?})) }},
            forces: [Drive(of: \"b\", force: ({amplitude:?}, 0), course: Sine(frequency: {frequency:?}))],"
        );
        let platform = match support {
            Support::Floor => {
                text += "walls: [(name: \"floor\", left: (1, 0), right: (0, 0), material: \"m\")],";
                String::new()
            }
            Support::Belt(velocity) => {
                let _ = write!(
                    text,
                    "walls: [(name: \"belt\", left: (1, 0), right: (0, 0), material: \"m\", surface_velocity: ({velocity:?}, 0))],"
                );
                String::new()
            }
            Support::Platform(way, half) => format!(
                "(name: \"table\", at: (0, -0.5), kinematic: (path: [(time: {half:?}, by: ({way:?}, 0)),
                (time: {:?}, by: (0, 0))], repeat: true), material: \"m\", shape: Rectangle(width: 60, height: 1)),",
                2.0 * half
            ),
        };
        let _ =
            write!(text, "bodies: [(name: \"b\", at: (0, {height:?}), mass: 1, material: \"m\", {body}), {platform}])");
        text
    }
}

/// The way of the slider beyond that of its support, and the tick of the run.
fn found(case: &Case, overrides: &Overrides) -> (f64, f64) {
    let source = Source::new("letting_go.ron", case.text());
    let mut simulation =
        Simulation::load_with(&source, overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}\n{}", case.text()));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}\n{}", case.text()));
    (simulation.bodies().position[0].x - case.carried(), simulation.clock().dt)
}

fn supports() -> [fn(f64, f64) -> Support; 3] {
    [
        |_, _| Support::Floor,
        |a, b| Support::Belt((0.2 + 0.8 * a) * if b < 0.5 { 1.0 } else { -1.0 }),
        |a, b| Support::Platform(0.1 + 0.9 * a, 0.3 + 0.7 * b),
    ]
}

#[test]
fn from_tick_to_tick_friction_lets_go_without_a_kick() {
    let mut wrong = String::new();
    for (kind, support) in supports().into_iter().enumerate() {
        for number in 0..8 {
            let case = Case::drawn(number + 8 * kind, support);
            let truth = case.truth();
            let (found, tick) = found(&case, &Overrides::default());
            let jump = 2.0 * (case.coefficients.0 * GRAVITY + case.load.0);
            let events = f64::from(truth.events + 1);
            let allowed = events * (jump * tick * case.duration + 4.0 * case.compliance());
            let error = (found - truth.way).abs();
            println!("{error:.2e} of {allowed:.2e}, {} events, tick {tick}: {case:?}", truth.events);
            if error > allowed {
                let _ = writeln!(
                    wrong,
                    "{found} instead of {}: off by {error:e}, {allowed:e} allowed\n{case:?}",
                    truth.way
                );
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn located_events_let_friction_go_and_turn_round_without_a_kick() {
    let clocks = [("Dop853", Some(2e-3), None), ("RungeKutta4", Some(2e-3), None), ("Dop853", None, Some(1e-7))];
    let mut wrong = String::new();
    for (kind, support) in supports().into_iter().enumerate() {
        for number in 0..4 {
            let case = Case { duration: 2.0, ..Case::drawn(number + 4 * kind, support) };
            let truth = case.truth();
            for (name, tick, tolerance) in clocks {
                let by_name = tolerance.is_none().then(|| name.to_owned());
                let (found, _) = found(&case, &Overrides { method: by_name, tick, tolerance, ..Overrides::default() });
                // The tolerance is a share of the way. So is the error of Runge-Kutta, (w h)^4 with w of 2 Hz. The reference is
                // rigid: in each event the spring of a contact may give as far as friction draws it, and swing by as much.
                let give = 4.0 * case.compliance() * f64::from(truth.events + 1);
                let allowed = 1e-6 * (1.0 + truth.way.abs()) + give;
                let error = (found - truth.way).abs();
                println!("{error:.2e} of {allowed:.2e}, {name} {tick:?} {tolerance:?}: {case:?}");
                if error > allowed {
                    let _ =
                        writeln!(wrong, "{name} {tick:?} {tolerance:?}: {found} instead of {}\n{case:?}", truth.way);
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// A slider on its tangential spring: the law of Cundall and Strack. The normal force is that of its weight. The spring sticks up
/// to `mu_s N` and slips with `mu_d N`. `squared`: its stiffness over the mass. Returns the way, and the number of slips.
fn sprung(load: impl Fn(f64) -> f64, (static_, dynamic): Coefficients, squared: f64, duration: f64) -> (f64, u32) {
    let whole = duration / f64::from(STEPS);
    // Way and velocity along the support; elongation as an acceleration; the direction of slip.
    let (mut way, mut velocity, mut pull, mut sign, mut slips) = (0.0, 0.0, 0.0_f64, 0.0_f64, 0);
    for number in 0..STEPS {
        let (now, middle) = (f64::from(number) * whole, (f64::from(number) + 0.5) * whole);
        // The spring swings about the load in the middle of the step. That is exact for a load that does not change.
        let (before, acceleration) = (velocity, load(middle));
        if sign == 0.0 {
            let omega = squared.sqrt();
            let (sin, cos) = libm::sincos(omega * whole);
            let off = (pull - acceleration) / squared;
            velocity = before * cos - off * omega * sin;
            let after = acceleration + squared * (off * cos + before * sin / omega);
            way += (after - pull) / squared;
            pull = after;
            if pull.abs() > static_ * GRAVITY {
                sign = pull.signum();
                pull = dynamic * GRAVITY * sign;
                slips += 1;
            }
        } else {
            velocity += (load(now) + 4.0 * acceleration + load(now + whole) - 6.0 * pull) / 6.0 * whole;
            way += 0.5 * (before + velocity) * whole;
            if velocity * sign < 0.0 {
                sign = 0.0;
            }
        }
    }
    (way, slips)
}

/// Under a dashpot the normal force at rest has one value, and so has friction: that of its spring. A table that moves shows it.
#[test]
fn under_a_dashpot_springs_carry_friction_on_a_table_that_moves() {
    let mut wrong = String::new();
    for number in 0..8 {
        let mut numbers = golden().skip(5 * number + 1);
        let mut between = |low: f64, high: f64| low + (high - low) * numbers.next().unwrap_or_default();
        let case =
            Case { load: (0.0, 1.0), ..Case::drawn(number, |a, b| Support::Platform(0.1 + 0.3 * a, 0.2 + 0.4 * b)) };
        let case = Case { stiffness: between(4e3, 4e4), is_box: false, ..case };
        let squared = RATIO * 0.5 * case.stiffness;
        let (truth, slips) = sprung(|time| case.acceleration(time), case.coefficients, squared, case.duration);
        let text =
            case.text().replace("forces: [Drive", "contacts: Penalty(normal: Dashpot, damping: 35), forces: [Drive");
        let source = Source::new("letting_go.ron", &text);
        let mut simulation = Simulation::load_with(&source, &Overrides::default(), |_| {})
            .unwrap_or_else(|errors| panic!("{errors}\n{text}"));
        simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}"));
        let tick = simulation.clock().dt;
        // A slip that begins late by a tick leaves a velocity of the jump of the force times the tick. If friction does not jump,
        // its rate does, and the order is two.
        let (static_, dynamic) = case.coefficients;
        let late = GRAVITY * tick * ((static_ - dynamic) + 2.0 * static_ * squared.sqrt() * tick);
        let allowed = f64::from(2 * slips + 1) * late * case.duration + 1e-5;
        let found = simulation.bodies().position[0].x - case.carried();
        println!("{:.2e} of {allowed:.2e}: {slips} slips, tick {tick}", (found - truth).abs());
        if (found - truth).abs() > allowed {
            let _ = writeln!(wrong, "{found} instead of {truth}, {allowed:e} allowed\n{case:?}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

fn end(name: &str, overrides: &Overrides) -> f64 {
    let path = format!("{}/assets/defects/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|wrong| panic!("{path}: {wrong}"));
    let source = Source::new(name, &text);
    let mut simulation = Simulation::load_with(&source, overrides, |_| {}).unwrap_or_else(|errors| panic!("{errors}"));
    simulation.run_to_end().unwrap_or_else(|failure| panic!("{failure}"));
    let bodies = simulation.bodies();
    let moves = (0..bodies.len()).find(|&body| bodies.dynamic[body]).unwrap_or_default();
    bodies.position[moves].x
}

fn tolerance(tolerance: f64) -> Overrides {
    Overrides { tolerance: Some(tolerance), ..Overrides::default() }
}

/// As sliding ends on a belt, forces decide the way on, not the rounding of the moment. Two tolerances then differ by the larger one,
/// which is a share of the motion of less than a metre.
#[test]
fn what_follows_the_end_of_sliding_does_not_depend_on_rounding() {
    for name in ["belt_two_solutions", "belt_box"] {
        let ends = [1e-7, 1e-8, 1e-9].map(|wanted| end(name, &tolerance(wanted)));
        let apart = ends.iter().fold(0.0_f64, |most, x| most.max((x - ends[0]).abs()));
        assert!(apart <= 1e-6, "{name}: {ends:?}");
    }
}

/// The places are those of event-driven solutions of one degree of freedom. A tick of 1e-4 s has an error of order two, but where a
/// force jumps.
#[test]
fn sliders_on_moving_tables_are_where_their_springs_bring_them() {
    for (name, place) in [("slider_on_table", 0.032_904_17), ("shaken_block", 0.269_367_358)] {
        let found = end(name, &Overrides { tick: Some(1e-4), ..Overrides::default() });
        assert!((found - place).abs() < 1e-5, "{name}: {found} instead of {place}");
    }
}

/// The rigid law ends at 0.275035 m. The box drops onto its springs at the start, so it keeps some times `mu N/k_t` of compliance.
#[test]
fn a_box_pushed_by_a_sine_goes_as_far_as_dry_friction_lets_it() {
    let compliance = 0.5 * GRAVITY / (RATIO * 1e5);
    let found = end("default_slip", &Overrides::default());
    assert!((found - 0.275_035).abs() < 4.0 * compliance, "{found}");
}
