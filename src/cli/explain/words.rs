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
        "the rule by which a tick advances the state. Its order says how the error falls: with order 2, half the tick has \
         a quarter of the error. `jostle list methods` shows all methods.",
    ),
    word(
        "tick",
        "the time in seconds of one step of the state, `clock.tick` or `--tick`. If the scene has none, the engine \
         chooses one, and the card says why. The stiffest single contact then lasts at least 40 ticks.",
    ),
    word(
        "critical tick",
        "the longest tick that the method bears: limit/omega. Here omega is the largest angular frequency of all \
         contacts of the run together, with their masses and lever arms. Beyond this tick each contact gains \
         energy, and the run is worthless. At a few per cent of it, the run resolves contacts. Softer or heavier bodies \
         have a longer one.",
    ),
    word(
        "steps",
        "the number of steps inside ticks or beyond them, and the length of the longest one. The card also counts the \
         steps that the engine made again because their error was too large. Methods that go from tick to tick make one \
         step a tick, and then the card has no such row.",
    ),
    word(
        "events located",
        "the number of steps that ended at a jump of a force: a touch, a parting, sticking or slipping. The next step began \
         there. `clock.events` and the method decide whether the engine locates events.",
    ),
    word(
        "tolerance",
        "the error that a run may have, as a share of how far and how fast bodies go, `clock.tolerance` or `--tolerance`. \
         The engine first runs the scene a few times in coarser steps. Their differences show which steps reach the \
         tolerance. The card names the expected error, and warns if no steps reach it.",
    ),
    word(
        "Reference",
        "a run with the smallest error there is, `method: Reference` or `--method Reference`. A coarser run shows its \
         error. A run that begins very near to it shows its horizon.",
    ),
    word(
        "horizon",
        "the time in seconds until which places are known. After it, runs with a finer tick differ by a tenth of the \
         motion. Or they end there, as a note then says. In `Reference` runs, rounding alone has grown to a thousandth of the motion by then. No engine knows places after it. `--json` writes `null` if there is no horizon.",
    ),
    word(
        "chaos",
        "motion in which a disturbance of the beginning grows exponentially. No engine knows places beyond the horizon: \
         see `jostle explain horizon`.",
    ),
    word(
        "energy that changed form",
        "the energy in J with which the card compares the residual. It has four parts. They are the greatest energy of motion \
         and springs, and the energy that fields released. The others are the energy lost, and the work of drives in either direction.",
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
        "the energy in J that thrust, torque, wind, prescribed bodies, belts and plugins have put in or taken out.",
    ),
    word(
        "energy residual",
        "the energy in J that the accounts miss. It is energy at the end and energy lost, less energy at the start and work \
         of drives. It is the error of the integration, and should be a small share of the energy that changed form. \
         A shorter tick makes it smaller.",
    ),
    word(
        "momentum residual",
        "momentum at the end, less the momentum at the start and the impulse from outside, per axis in N s. The same \
         follows for angular momentum in N m s. Forces come in pairs, so the residual is rounding. One thing adds to it: \
         each tick puts a joint that stays at its limit back onto it. That may change the angular momentum, and a shorter \
         tick changes it less.",
    ),
    word(
        "largest overlap, overlap, largest share",
        "the greatest depth of two bodies, or of a body and a wall, in each other. The card gives it in m, and as a share \
         of the smaller radius. Another pair may have a greater share: then that stands in `largest share`. \
         Contacts are springs, so some overlap carries the load. A higher `stiffness` makes it smaller, and asks for \
         a shorter tick.",
    ),
    word(
        "joint drift",
        "the greatest distance of a joint from its constraint, in m. Angles count at the farthest point of a body. Each \
         step ends on the constraints, so the drift is only rounding. It does not show the error of the motion.",
    ),
    word(
        "largest travel",
        "the greatest distance that any point of a body moved in one tick, as a share of the smallest radius. Beyond a \
         radius, a body may pass through another one unseen.",
    ),
    word(
        "rest",
        "the state of bodies whose contacts bear every load. Such bodies do not move at all, to the last bit, until a \
         body touches them or a load changes. The engine computes whether contacts can bear the load, and stops no slow \
         body. If contacts lose no energy (`restitution: 1`), no body comes to rest. The expectation `AtRest` checks \
         whether bodies rest. docs/methods.md has more under Rest.",
    ),
    word(
        "asleep, sleep",
        "the state of bodies at rest if no force changes with time or motion. Then gravity and contacts act alone, \
         without belts and prescribed bodies. Ticks leave such bodies out, so they cost nothing, and a touch wakes them. \
         Sleep has no threshold of speed or time, and no switch. Without it, bodies come to the same places at the same \
         times. If fewer than one in sixteen of the moving bodies rest, ticks go over all of them, which is cheaper.",
    ),
    word(
        "free flight, flight",
        "the motion of discs that touch nothing, and on which gravity alone acts. The engine moves them along their \
         parabolas at once instead of tick by tick. It does so under `VelocityVerlet` with events at the ends of ticks, \
         if most bodies are such discs. The engine knows beforehand when two of them meet, so they cost nothing until \
         then. Their rounding is less than that of ticks. Flight has no switch. A system that only reads bodies changes \
         nothing. If a plugin borrows the packed state to write, bodies move tick by tick until the next lists of pairs.",
    ),
    word(
        "vector instructions",
        "instructions of the processor that work on two, four or eight numbers at once: the levels `baseline`, `avx2` and \
         `avx512`. The level `scalar` works on one. All commands that run scenes take the best level of the processor, or \
         the one that `--simd LEVEL` names. The results are the same to the bit at all levels. The program refuses a \
         level that the processor lacks.",
    ),
    word(
        "verdict",
        "the last sentences of the card. They name first the parts of the run to trust, then the parts to doubt, with causes \
         and a remedy. `Trust it`: the engine looked for causes of doubt and found none. `Do not trust \
         it`: the run does not compute the scene, and the verdict names the cause. Otherwise you can trust energy, \
         statistics, rest and places, except for those that it doubts. It doubts `the model at contacts` if bodies \
         overlap by more than a tenth of a radius: such contacts are too soft for the scene. Causes come before \
         their effects. They are a tick above the critical one, overlaps at the start, drag, and places too far from the \
         origin. They are also forces that swing too fast, missing energy, a tolerance not reached, deep overlaps, and \
         brief contacts. The last ones are travel beyond a radius, chaos, a tick too long for the motion, and no estimate.",
    ),
    word(
        "error",
        "the distance of the run from the exact solution, as the engine estimates it. `tick` comes from the same run with \
         finer steps, which take about a second, or 3 % of the work of a long run. With `--estimate` they take as long as they \
         need, and with `--no-estimate` there are none. `rounding` comes from runs with wrong last bits (`--rounding`). `model` comes from a run with contacts four times as stiff (`--model`). In `--json` these are `discretisation`, \
         `rounding` and `model`. Under a `tolerance` and `Reference`, the runs that find the steps give the first. The \
         error of places is the greatest distance of any point of a body, in m. The error of velocities is the root of \
         its mean square over time, in m/s. `until t = ..`: the error holds until then. After it, finer runs go \
         elsewhere, as chaotic ones do. Or they end there, as a note then says.",
    ),
    word(
        "state hash",
        "a fingerprint of all positions, angles, velocities and spins at the end, bit by bit. The same scene and program \
         give the same hash, on every machine and with any number of threads.",
    ),
    word(
        "note",
        "a choice that the engine made, a limit that it applied, or a warning about the scene. The engine chooses, clamps \
         and leaves out nothing without a note.",
    ),
    word(
        "near",
        "pairs of atoms of different bodies, and of atoms and walls, within the margin of the search (`jostle bench`). Each \
         tick looks at all these pairs. `touching` counts the pairs that overlap.",
    ),
    word(
        "scatter",
        "the time of the slowest round less that of the fastest, as a share of the median (`jostle bench`). It comes from \
         other work of the computer, and from changes in the scene during the run.",
    ),
    word(
        "plain loop",
        "the program that `jostle bench` runs beside the engine from the same state. It has arrays, a grid of cells, \
         springs with dashpots and friction, and velocity Verlet. It has no accounts, no rest and no vector instructions. \
         `plain` is its time in nanoseconds per atom and tick, and `x plain` the time of the engine over it.",
    ),
    word(
        "bytes per atom",
        "the memory that a process takes to read a scene and run a round of it, for each atom (`jostle bench`). Below 1000 \
         atoms there is no such number, because the program itself takes most of the memory.",
    ),
    word(
        "expectation",
        "a claim of the scene about its own physics, under `expect`. A broken one ends a command with exit code 1.",
    ),
];
