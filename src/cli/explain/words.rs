//! The words of the error card, and of the measurements of `jostle bench`.

/// A word and its meaning.
pub(super) struct Word {
    /// The word, and others for the same, separated by commas.
    pub word: &'static str,
    pub meaning: &'static str,
}

const fn word(word: &'static str, meaning: &'static str) -> Word {
    Word { word, meaning }
}

/// Every row of the card, with its meaning.
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
        "steps",
        "how many steps were made inside ticks or beyond them, how long the longest was, and how many were made again because \
         their error was too large. Methods that go from tick to tick make one a tick, and the card says nothing of it.",
    ),
    word(
        "events located",
        "how often a step ended where forces jump (touch, part, stick, slip) and the next one began there. `clock.events` and \
         the method decide whether events are located.",
    ),
    word(
        "tolerance",
        "the error that a run may have, as a share of how far and how fast bodies go, `clock.tolerance` or `--tolerance`. The \
         engine runs the scene a few times in coarser steps, whose differences show which steps reach it; the card says what \
         it expects, and warns if no steps do.",
    ),
    word(
        "Reference",
        "a run with the smallest error there is, `method: Reference` or `--method Reference`. It is compared with a coarser \
         one, which shows its error, and with one that begins a hair beside it, which shows its horizon.",
    ),
    word(
        "horizon",
        "the time in seconds up to which places can be told. After it, runs with a finer tick are elsewhere by a tenth of the \
         motion, or were not made, as a note says. `Reference` runs tell when rounding alone has grown to a thousandth of the \
         motion: no engine can tell places after that. `--json` writes `null` if there is none.",
    ),
    word(
        "chaos",
        "motion in which a disturbance of the beginning grows exponentially, so that no engine can tell places beyond the \
         horizon; see `jostle explain horizon`.",
    ),
    word(
        "what went round",
        "the energy in J that the residual is compared with. It has four parts: the greatest energy of motion and springs \
         that was seen, the energy that fields released, the energy lost, and the work of drives in either direction.",
    ),
    word(
        "real time",
        "seconds of physics for each second of computing. It is measured on your computer and is no part of the result.",
    ),
    word(
        "ns per atom and tick",
        "the cost of the run on your computer, in nanoseconds for each atom and tick. It compares scenes and machines.",
    ),
    word(
        "energy",
        "the energy at the end, in J: kinetic, potential (gravity and other fields) and elastic (in springs and contacts).",
    ),
    word(
        "energy lost",
        "the energy in J that friction, the inelasticity of contacts and drag have taken. Each of them books its own loss.",
    ),
    word(
        "work of drives",
        "the energy in J that thrust, torque, wind, prescribed bodies, belts and forces of plugins have put in (or taken).",
    ),
    word(
        "energy residual",
        "the energy in J that the accounts miss: energy at the end and energy lost, less the energy at the start and the work \
         of drives. It is the error of the integration, and should be small beside the energy that went round. A shorter \
         tick makes it smaller.",
    ),
    word(
        "momentum residual",
        "momentum at the end less that at the start and the impulse from outside, per axis in N s, and the same for angular \
         momentum in N m s. Forces come in pairs, so it is rounding. One thing adds to it: each tick puts a joint that stays at \
         its limit back onto it. That may change the angular momentum, and a shorter tick changes it less.",
    ),
    word(
        "largest overlap, overlap, largest share",
        "how deep two bodies, or a body and a wall, were in each other at worst, in m and as a share of the smaller radius. Another \
         pair may have a greater share: then that stands in `largest share`. \
         Contacts are springs, so some overlap carries the load. A higher `stiffness` makes it smaller, and asks for \
         a shorter tick.",
    ),
    word(
        "joint drift",
        "how far a joint was at most from its constraint, in m; angles count at the farthest point of a body. Each step ends on \
         the constraints, so the drift is rounding and nothing else. It says nothing of the error of the motion.",
    ),
    word(
        "largest travel",
        "how far any point of a body moved in one tick at most, as a share of the smallest radius. Beyond a radius a body \
         may pass through another unseen.",
    ),
    word(
        "rest",
        "the state of bodies whose contacts bear every load: nothing moves at all, to the last bit, until a body touches \
         them or a load changes. The engine computes whether contacts can bear the load, and stops no slow body. If contacts \
         lose nothing (`restitution: 1`), no body comes to rest. The expectation `AtRest` looks whether bodies rest; \
         docs/methods.md has more under Rest.",
    ),
    word(
        "asleep, sleep",
        "the state of bodies at rest if no force changes with time or motion (gravity and contacts alone; no belt, no \
         prescribed body): ticks leave them out, so they cost nothing, and a touch wakes them. No speed or time is set for \
         it, and it has no switch: bodies come to the same places and leave them at the same times without it. If \
         fewer than one in sixteen of the bodies that move by forces rest, ticks go over all of them, which is cheaper.",
    ),
    word(
        "free flight, flight",
        "the motion of discs that touch nothing, and on which gravity alone acts: they move along their parabolas at once \
         instead of tick by tick. This happens under `VelocityVerlet` with events at the ends of ticks, if such discs are most of \
         all bodies. The engine knows beforehand when two of them meet, so they cost nothing until then, and rounding is less than \
         that of the ticks. It has no switch. A system that only reads bodies changes nothing. If a plugin borrows the packed \
         state to write, all bodies move tick by tick until the next lists of pairs.",
    ),
    word(
        "vector instructions",
        "instructions of the processor that work on two, four or eight numbers at once (levels `baseline`, `avx2` and \
         `avx512`; `scalar`: on one). All commands that run scenes take the best level of the processor, or the one that \
         `--simd LEVEL` names; the results are the same to the bit at all of them. A level that the processor lacks is refused.",
    ),
    word(
        "verdict",
        "the last sentences of the card. They tell which parts of the run can be trusted, then which cannot, with the body and time \
         at which that began, and then a remedy. `Trust it`: the engine looked for causes of doubt and found none. `Do not trust \
         it`: the run does not compute the scene, for the cause that is told. Otherwise energy, statistics, rest and places are \
         trusted as far as no cause speaks against them. `The model at contacts` is doubted if bodies overlap by more than half a \
         radius: such contacts are too soft for the things of the scene. Causes come before their effects: a tick above the critical \
         one, overlaps at the start, drag, places too far from the origin, forces that swing too fast, missing energy, a tolerance \
         not reached, deep overlaps, brief contacts, travel beyond a radius, chaos, a tick too long for the motion, places that no \
         estimate tells.",
    ),
    word(
        "error",
        "how far the run is from the exact solution, as the engine estimates it. `tick` comes from the same run with finer steps, \
         as far as that takes 3 % of the work or half a second (`--estimate` takes all it needs, `--no-estimate` none). \
         `rounding` comes from runs with wrong last bits (`--rounding`), and `model` from a run with contacts four times as stiff \
         (`--model`). In `--json` these are `discretisation`, `rounding` and `model`. Under a `tolerance` and `Reference` the runs \
         that find the steps tell the first. Places: the greatest distance of any point of a body, in m. Velocities: the root of \
         its mean square over time, in m/s. `until t = ..`: the error is that until then. After it, finer runs go elsewhere, as \
         chaotic ones do, or were not made, as a note says.",
    ),
    word(
        "state hash",
        "a fingerprint of all positions, angles, velocities and spins in the end, bit by bit. The same scene and program \
         give the same hash, on every machine and with any number of threads.",
    ),
    word(
        "note",
        "a choice the engine made, a limit it applied, or a warning about the scene. The engine chooses, \
         clamps and leaves out nothing without one.",
    ),
    word(
        "near",
        "pairs of atoms of different bodies, and of atoms and walls, whose distance is less than the margin of the search \
         (`jostle bench`): candidate pairs, each of which is looked at in every tick. `touching` counts those that overlap.",
    ),
    word(
        "scatter",
        "how much longer the slowest round took than the fastest, as a share of the median (`jostle bench`). It comes from other \
         work of the computer, and from changes in the scene during the run.",
    ),
    word(
        "plain loop",
        "the program that `jostle bench` runs beside the engine from the same state: arrays, a grid of cells, springs with dashpots and \
         friction, velocity Verlet, without accounts, rest and vector instructions. `x plain` is the time of the engine over \
         that of this loop, `plain` its nanoseconds per atom and tick.",
    ),
    word(
        "bytes per atom",
        "by how much the memory of a process grows when it reads a scene and runs a round of it, over the number of atoms \
         (`jostle bench`). Below 1000 atoms it is not told: the memory of the program itself is most of it there.",
    ),
    word(
        "expectation",
        "a claim of the scene about its own physics, under `expect`. A broken one ends a command with exit code 1.",
    ),
];
