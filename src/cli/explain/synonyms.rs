//! Words of everyday speech and of other programs for what scenes call otherwise.

/// A name of the scene language, and other words for it.
const SYNONYMS: &[(&str, &[&str])] = &[
    ("Revolute", &["hinge", "pivot", "pin", "pin joint", "axle", "bearing"]),
    ("Prismatic", &["slider", "slide", "piston", "rail"]),
    ("Distance", &["rod", "link", "strut"]),
    ("Weld", &["glue", "fixed joint", "rigid joint"]),
    ("Rope", &["cable", "string", "tether"]),
    ("GearPair", &["gear train", "transmission"]),
    ("Servo", &["pid", "position control"]),
    ("Motor", &["engine", "velocity control"]),
    ("Actuator", &["force control"]),
    ("TorsionSpring", &["rotational spring", "angular spring"]),
    ("Spring", &["elastic band", "bungee"]),
    ("Drag", &["air resistance", "viscosity"]),
    ("Attraction", &["coulomb", "newtonian gravity", "charge"]),
    ("Thrust", &["rocket", "push"]),
    ("walls", &["ground", "floor", "terrain", "boundary"]),
    ("fill", &["particles", "gas", "grains"]),
    ("Disc", &["circle", "ball", "sphere", "wheel"]),
    ("Rectangle", &["box", "square", "brick"]),
    ("Regular", &["hexagon", "triangle"]),
    ("Compound", &["composite", "clump"]),
    ("restitution", &["bounciness", "bounce", "coefficient of restitution"]),
    ("stiffness", &["spring constant", "young modulus"]),
    ("spin", &["angular velocity", "rotation"]),
    ("tick", &["time step", "timestep", "dt", "step size"]),
    ("method", &["integrator", "solver"]),
    ("VelocityVerlet", &["verlet", "leapfrog"]),
    ("SemiImplicitEuler", &["symplectic euler", "euler"]),
    ("RungeKutta4", &["rk4", "runge kutta"]),
    ("Dop853", &["dormand prince"]),
    ("params", &["variables", "constants", "parameters"]),
    ("Repeat", &["loop", "array", "grid"]),
    ("kinematic", &["moving wall", "prescribed"]),
    ("Repose", &["angle of repose", "heap angle"]),
    ("Mean", &["average"]),
    ("ContactForce", &["contact force", "normal force"]),
    ("inertia", &["moment of inertia"]),
    ("contacts", &["collision", "collisions", "impact"]),
    ("rolling", &["rolling resistance", "rolling friction"]),
    ("LogNormal", &["distribution", "polydisperse"]),
    ("state hash", &["checksum", "fingerprint"]),
];

/// The name that a scene has for a word.
pub(super) fn named(word: &str) -> Option<&'static str> {
    let is_word = |other: &&str| other.eq_ignore_ascii_case(word);
    SYNONYMS.iter().find(|(_, words)| words.iter().any(is_word)).map(|(name, _)| *name)
}

/// All of them, for suggestions.
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    SYNONYMS.iter().flat_map(|(_, words)| words.iter().copied())
}

#[cfg(test)]
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    SYNONYMS.iter().map(|(name, _)| *name)
}
