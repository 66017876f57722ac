//! Hundreds of bodies of four shapes and three materials, poured into a bin: they come to rest, and stay. SI units.
//!
//! The floor is of gravel. On a smooth one a lone disc rightly rolls forever, because no torque resists rolling.

use std::error::Error;
use std::fmt::Write;

use super::{Case, Extent, Readings, golden, load};

/// The case.
pub const CASE: Case = Case {
    name: "pile",
    what: "a pile of 500 mixed bodies comes to rest and stays for a minute",
    source: "set-valued force laws at rest (Moreau 1988)",
    cheap: false,
    short: "200 bodies, ten seconds of rest",
    run,
};

/// `count` bodies, `columns` of them side by side.
pub fn scene(count: usize, columns: usize) -> String {
    let width = 0.25 * columns as f64 + 0.2;
    let stones = (10.0 * width).round() as u32 + 1;
    let gravel: Vec<String> =
        (0..stones).map(|index| format!("(at: ({:?}, 0), radius: 0.06)", 0.1 * f64::from(index))).collect();
    let mut bodies = format!(
        "(name: \"gravel\", fixed: true, datum: Origin, material: \"stone\", atoms: List([{}])),",
        gravel.join(", ")
    );
    let mut chance = golden();
    let mut next = || chance.next().unwrap_or_default();
    for number in 0..count {
        let (x, y) = (0.2 + 0.25 * (number % columns) as f64 + 0.05 * next(), 0.3 + 0.27 * (number / columns) as f64);
        let (angle, speed) = (6.0 * next(), next() - 0.5);
        let atoms = match number % 4 {
            0 => format!("Disc(radius: {:?})", 0.06 + 0.04 * next()),
            1 => "Picture(spacing: 0.09, mass: 0.01, rows: [\"##\", \"##\"])".to_owned(),
            2 => "List([(at: (0, 0), radius: 0.07, mass: 0.02), (at: (0.07, 0.03), radius: 0.05, mass: 0.01)])"
                .to_owned(),
            _ => "Picture(spacing: 0.08, mass: 0.01, rows: [\"###\"])".to_owned(),
        };
        let material = ["wood", "stone", "rubber"][(number / 4 + number) % 3];
        let _ = write!(
            bodies,
            "(name: \"body_{number}\", at: ({x:?}, {y:?}), angle: {angle:?}, velocity: ({speed:?}, 0),
              material: \"{material}\", atoms: {atoms}),"
        );
    }
    format!(
        "Scene(format: 1, clock: (duration: 100, tick: 1e-3, method: VelocityVerlet), gravity: (0, -9.81),
        materials: {{
            \"wood\": (stiffness: 2000, friction: 0.4, inelasticity: 0.4, density: 1),
            \"stone\": (stiffness: 4000, friction: 0.6, inelasticity: 0.3, density: 2),
            \"rubber\": (stiffness: 1000, friction: (static: 0.8, dynamic: 0.7), inelasticity: 0.2, density: 1.5),
        }},
        walls: [
            (name: \"floor\", left: (1, 0), right: (0, 0), material: \"stone\"),
            (name: \"left\", left: (0, 0), right: (0, 1), material: \"wood\"),
            (name: \"right\", left: ({width:?}, 1), right: ({width:?}, 0), material: \"wood\"),
        ],
        bodies: [{bodies}])"
    )
}

fn run(extent: Extent, readings: &mut Readings) -> Result<(), Box<dyn Error>> {
    let (count, columns, settled, still) = extent.pick((200, 14, 20.0, 10.0), (500, 22, 30.0, 60.0));
    readings.rests(&format!("{count} bodies"), &mut load(&scene(count, columns))?, settled, still)
}
