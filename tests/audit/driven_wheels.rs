//! Law: energy is kept. What motors give and gravity gives is kinetic, elastic or lost, to the error of the steps. Wheels whose motors
//! hold one rate each cannot all roll without slip on a bent line: springs of friction give, friction slips, or a motor gives its limit.

use super::ran::end;

/// A frame on two driven wheels rolls into a valley of four pieces and out of it.
fn scene(clock: &str, limit: f64, friction: &str) -> String {
    format!(
        "Scene(format: 1, clock: (duration: 1.2, {clock}), gravity: (0, -9.81), film: (fps: 50),
            materials: {{ \"ground\": ({friction}, restitution: 0.1),
                          \"rubber\": (stiffness: 8e4, {friction}, restitution: 0.2, density: 60) }},
            walls: [(name: \"ground\", line: [(-8, 1.9), (-1, 0.05), (-0.3, 0), (0.6, 0.1), (8, 1.6)], material: \"ground\")],
            bodies: [
                (name: \"frame\", at: (-2, 1), mass: 6, material: \"rubber\", shape: Rectangle(width: 0.8, height: 0.1)),
                (name: \"rear\", at: (-2.36, 1), mass: 3.6, material: \"rubber\", atoms: Disc(radius: 0.14)),
                (name: \"front\", at: (-1.64, 1), mass: 3.6, material: \"rubber\", atoms: Disc(radius: 0.14)),
            ],
            joints: [
                Revolute(name: \"rear_axle\", a: \"frame\", anchor_a: (-0.36, 0), b: \"rear\", collide: false),
                Revolute(name: \"front_axle\", a: \"frame\", anchor_a: (0.36, 0), b: \"front\", collide: false),
            ],
            controllers: [
                Motor(of: \"rear_axle\", speed: -16, limit: {limit:?}),
                Motor(of: \"front_axle\", speed: -16, limit: {limit:?}),
            ])"
    )
}

/// Some 300 J change form. A tolerance allows that share of it. `Reference` rounds sums of 1e5 terms, and steps of 1e-4 s err by
/// 1e-7 J in each of a dozen swings.
#[test]
fn wheels_that_motors_drive_through_a_valley_keep_energy() {
    const CHANGED: f64 = 300.0;
    let clocks =
        [("tolerance: 1e-6", 1e-6 * CHANGED), ("method: Reference", 1e-9), ("method: RungeKutta4, tick: 1e-4", 1e-6)];
    for friction in ["friction: 1", "friction: (static: 0.9, dynamic: 0.7)"] {
        for limit in [7.0, 9.0, 12.0] {
            for (clock, most) in clocks {
                let ran = end(&scene(clock, limit, friction)).expect("a run to its end");
                let residual = ran.card.energy.residual;
                assert!(residual.abs() < most, "{friction}, limit {limit} {clock}: {residual:e} J");
            }
        }
    }
}

/// Rigid friction does not give, so no motion satisfies two motors on a bent line. One motor has a motion.
#[test]
fn rigid_friction_that_contradicts_motors_is_not_trusted() {
    let rigid = |scene: String| scene.replacen("materials", "contacts: Penalty(tangential: Exact), materials", 1);
    let unlimited = |scene: String| scene.replace(", limit: 12.0", "");
    let both = scene("method: Dop853, tick: 1e-3", 12.0, "friction: 1");
    let rear = both.replace("Motor(of: \"front_axle\", speed: -16, limit: 12.0),", "");
    for (name, scene, contradicts) in [
        ("limited motors", rigid(both.clone()), true),
        ("motors", rigid(unlimited(both.clone())), true),
        ("one motor", rigid(unlimited(rear)), false),
        ("springs of friction", unlimited(both), false),
    ] {
        let verdict = end(&scene).expect("a run to its end").card.verdict;
        let found = verdict.starts_with("Do not trust it: from t = ") && verdict.contains("`tangential: Exact` hold");
        assert_eq!(found, contradicts, "{name}: {verdict}");
    }
}
