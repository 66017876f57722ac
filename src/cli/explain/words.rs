//! The words of the error card.

/// A word and what it means.
pub(super) struct Word {
    pub word: &'static str,
    pub meaning: &'static str,
}

const fn word(word: &'static str, meaning: &'static str) -> Word {
    Word { word, meaning }
}

/// Every row of the card, and what stands in it.
pub(super) const WORDS: &[Word] = &[
    word(
        "method",
        "how the state is advanced by a tick. Its order says how the error falls: with order 2 a tick half as long has a \
         quarter of the error. `jostle list methods` shows them all.",
    ),
    word(
        "tick",
        "the time in seconds by which the state is advanced at once, `clock.tick` or `--tick`. If the scene names none, the \
         stiffest single contact lasts at least 40 of them, and the card says so.",
    ),
    word(
        "critical tick",
        "the longest tick that the method bears: limit/omega, with the largest angular frequency omega that the contacts of \
         the run had together, masses and lever arms included. Beyond it each contact gains energy and the run is worthless; \
         well below it (some per cent) contacts are resolved. Softer or heavier bodies have a longer one.",
    ),
    word(
        "real time",
        "seconds of physics for each second of computing. It is measured on your computer and is no part of the result.",
    ),
    word(
        "ns per atom and tick",
        "the cost of the run on your computer, nanoseconds for each atom and tick; to compare scenes and machines by.",
    ),
    word(
        "energy",
        "what is there in the end, in J: kinetic, potential (gravity and other fields) and elastic (in springs and contacts).",
    ),
    word(
        "energy lost",
        "what has gone, in J: to friction, to the inelasticity of contacts, to drag. It is booked where it is lost.",
    ),
    word(
        "work of drives",
        "the energy in J that thrust, torque, wind, prescribed bodies, belts and forces of plugins have put in (or taken).",
    ),
    word(
        "energy residual",
        "energy in the end, and what was lost, less the energy at the start and the work of drives: what the books do not \
         account for, in J. It is the error of the integration, and should be small beside the energy that went round; a \
         tick half as long makes it smaller.",
    ),
    word(
        "momentum residual",
        "momentum in the end less that at the start and the impulse from outside, per axis in N s, and the same for angular \
         momentum in N m s. Forces come in pairs, so it is rounding and nothing else.",
    ),
    word(
        "largest overlap",
        "how deep two bodies, or a body and a wall, were in each other at worst, in m and as a share of the smaller radius. \
         Contacts are springs, so some overlap is what carries the load; a higher `stiffness` makes it smaller, and asks for \
         a shorter tick.",
    ),
    word(
        "largest travel",
        "how far any point of a body moved in one tick at most, as a share of the smallest radius. Beyond a radius a body \
         may pass through another unseen.",
    ),
    word(
        "state hash",
        "a fingerprint of all positions, angles, velocities and spins in the end, bit by bit. The same scene and program \
         give the same hash, on every machine and with any number of threads.",
    ),
    word(
        "note",
        "a choice the engine made, a limit it applied, or something the scene should be warned of. Nothing is chosen, \
         clamped or left out without one.",
    ),
    word(
        "expectation",
        "a claim of the scene about its own physics, under `expect`. A broken one ends a command with exit code 1.",
    ),
];
