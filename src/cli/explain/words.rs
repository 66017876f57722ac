//! The words of the error card, and of what `jostle bench` measures.

/// A word and what it means.
pub(super) struct Word {
    /// The word, and others for the same, separated by commas.
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
        "the time in seconds up to which places can be told: from then on runs with a finer tick are elsewhere by a tenth of the \
         motion, or were not made, as a note says. `Reference` runs tell when rounding alone has grown to a thousandth of it, which no engine can tell beyond. `null` in \
         `--json` where there is none.",
    ),
    word(
        "chaos",
        "motion in which a disturbance of the beginning grows exponentially, so that no engine can tell places beyond the \
         horizon; see `jostle explain horizon`.",
    ),
    word(
        "what went round",
        "the energy in J that the residual is compared with: motion and springs at their greatest as far as they were looked \
         at, what fields released, what was lost, and the work of drives whichever way it went.",
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
         momentum in N m s. Forces come in pairs, so it is rounding. But from tick to tick, a joint that stays at its limit is put \
         back onto it: that may change the angular momentum, the less the shorter the tick.",
    ),
    word(
        "largest overlap",
        "how deep two bodies, or a body and a wall, were in each other at worst, in m and as a share of the smaller radius. Another \
         pair may have a greater share: then that stands in `largest share`. \
         Contacts are springs, so some overlap is what carries the load; a higher `stiffness` makes it smaller, and asks for \
         a shorter tick.",
    ),
    word(
        "joint drift",
        "how far a joint was at most from what it holds, in m, angles at the farthest point of a body. Each step ends on what joints \
         hold, so it is rounding and nothing else. It says nothing of the error of the motion.",
    ),
    word(
        "largest travel",
        "how far any point of a body moved in one tick at most, as a share of the smallest radius. Beyond a radius a body \
         may pass through another unseen.",
    ),
    word(
        "rest",
        "the state of bodies whose contacts bear every load: nothing moves at all, to the last bit, until something touches \
         them or a load changes. It is found, not waited for, and no slow body is stopped. Where contacts lose nothing \
         (`restitution: 1`) nothing comes to rest. The expectation `AtRest` looks whether bodies do; docs/methods.md has more \
         under Rest.",
    ),
    word(
        "asleep, sleep",
        "bodies at rest are asleep where no force changes with time or motion (gravity and contacts alone; no belt, no \
         prescribed body): ticks leave them out, so they cost nothing, and a touch wakes them. No speed or time is set for \
         it, and there is nothing to switch on or off: where bodies stay and what wakes them is as it would be without. Where \
         fewer than one in sixteen of those that move by forces rest, ticks go over all of them, which is cheaper.",
    ),
    word(
        "free flight, flight",
        "discs that touch nothing, and on which nothing but gravity acts, are moved along their parabolas at once instead of tick by \
         tick, under `VelocityVerlet` with events at the ends of ticks, where they are most of all bodies. When two of them \
         meet is known beforehand, so they cost nothing until then, and rounding is less than that of the ticks. There is \
         nothing to switch on or off. What looks at bodies changes nothing; a plugin that writes into the packed state, or takes \
         it as if it would, has all bodies moved tick by tick again until the next lists of pairs.",
    ),
    word(
        "vector instructions",
        "instructions of the processor that work on two, four or eight numbers at once (levels `baseline`, `avx2` and \
         `avx512`; `scalar`: on one). All commands that run scenes take the best the processor has, or what `--simd LEVEL` \
         says; the results are the same to the bit at all of them. A level that the processor lacks is refused.",
    ),
    word(
        "verdict",
        "the last sentences of the card: what of the run can be trusted, then what cannot, with body and time where that began, and \
         then what would help. `Trust it`: nothing that the engine looks for was found. `Do not trust it`: what was computed is not \
         the scene, for the cause that is told. Else energy, statistics, rest and places are trusted as far as nothing speaks against \
         them. `The model at contacts` is doubted where bodies overlap by more than half a radius: softer contacts than those of the \
         scene's things. Causes come before what they bring about: a tick above the critical one, overlaps at the start, drag, places \
         too far from the origin, forces that swing too fast, missing energy, a tolerance not reached, deep overlaps, brief contacts, \
         travel beyond a radius, chaos, a tick too long for the motion, places that no estimate tells.",
    ),
    word(
        "error",
        "how far the run is from the exact solution, as the engine estimates it: `tick` by the same run with finer steps, \
         as far as that takes 3 % of the work or half a second (`--estimate` takes all it needs, `--no-estimate` none); \
         `rounding` by runs with wrong last bits (`--rounding`); `model` by a run with contacts four times as stiff \
         (`--model`). In `--json` these are `discretisation`, `rounding` and `model`; under a `tolerance` and `Reference` the runs that find \
         the steps tell the first. Places: the greatest distance of any point of a body, in m; velocities: the root of its mean square \
         over time, in m/s. `until t = ..`: the error is that until then; finer runs go elsewhere from then on, as chaotic ones \
         do, or were not made for longer, as a note says.",
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
        "near",
        "pairs of atoms of different bodies, and of atoms and walls, whose distance is less than the margin of the search \
         (`jostle bench`): candidate pairs, each of which is looked at in every tick. `touching` counts those that overlap.",
    ),
    word(
        "scatter",
        "how much longer the slowest round took than the fastest, as a share of the median (`jostle bench`): what the computer \
         did beside, and what changed in the scene while it ran.",
    ),
    word(
        "plain loop",
        "what `jostle bench` runs beside the engine from the same state: arrays, a grid of cells, springs with dashpots and \
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
