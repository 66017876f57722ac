//! Scene text of mechanisms of uniform bars. The problems of joints share it.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write;

use glam::DVec2;

use jostle_engine::Simulation;

/// A uniform bar: its x axis points from one end to the other, its inertia is `m l^2/12`. Ends in m, mass in kg.
pub fn bar(name: &str, from: DVec2, to: DVec2, mass: f64) -> String {
    let (middle, along) = (0.5 * (from + to), to - from);
    turned_bar(name, middle, libm::atan2(along.y, along.x), (mass, along.length()))
}

/// The same by middle in m, angle to the x axis in rad, mass in kg and length in m.
fn turned_bar(name: &str, middle: DVec2, angle: f64, (mass, length): (f64, f64)) -> String {
    format!(
        "(name: \"{name}\", at: ({:?}, {:?}), angle: {angle:?}, mass: {mass:?}, inertia: {:?}, atoms: Disc(radius: 0.005)),",
        middle.x,
        middle.y,
        mass * length * length / 12.0
    )
}

/// The direction of a bar that hangs at an angle in rad from the downward vertical.
pub fn hanging(angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(sin, -cos)
}

/// A link of a chain.
#[derive(Clone, Copy, Debug)]
pub struct ChainLink {
    /// In kg.
    pub mass: f64,
    /// In m.
    pub length: f64,
    /// At the start, in rad from the downward vertical.
    pub angle: f64,
}

/// The scene text of a chain.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Its bodies, `<name>0` and so on.
    pub bodies: String,
    /// Its joints, `<name>_pin0` and so on. Each pin holds the upper end of the link of its number.
    pub joints: String,
    /// The end of its last link, in m.
    pub end: DVec2,
}

/// A chain that hangs in the origin.
pub fn chain(name: &str, links: &[ChainLink]) -> Chain {
    let mut chain = Chain { bodies: String::new(), joints: String::new(), end: DVec2::ZERO };
    for (number, ChainLink { mass, length, angle }) in links.iter().copied().enumerate() {
        let along = hanging(angle) * length;
        let middle = chain.end + 0.5 * along;
        chain.bodies += &turned_bar(&format!("{name}{number}"), middle, angle - FRAC_PI_2, (mass, length));
        let upper = match number.checked_sub(1) {
            None => "a: World, anchor_a: (0, 0)".to_owned(),
            Some(before) => format!("a: \"{name}{before}\", anchor_a: ({:?}, 0)", 0.5 * links[before].length),
        };
        let _ = write!(
            chain.joints,
            "Revolute(name: \"{name}_pin{number}\", {upper}, b: \"{name}{number}\", anchor_b: ({:?}, 0)),",
            -0.5 * length
        );
        chain.end += along;
    }
    chain
}

/// The greatest difference in rad of the bodies' angles from those of `exact`, which count from the downward vertical. Whole turns
/// do not count: reference values lie within one.
pub fn turned_off(simulation: &Simulation, first: usize, exact: &[f64]) -> f64 {
    let found = simulation.bodies().angle[first..].iter().map(|angle| angle + FRAC_PI_2);
    let off = found.zip(exact).map(|(found, exact)| found - exact);
    greatest(off.map(|off| off - TAU * (off / TAU).round()))
}

/// The greatest absolute value; NaN if one is.
pub fn greatest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    numbers.into_iter().map(f64::abs).fold(0.0, |most, number| if number <= most { most } else { number })
}
