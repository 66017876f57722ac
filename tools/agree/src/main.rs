//! Draws scenes from the registry, runs each in several ways, and stores those whose runs disagree.
//!
//! Each scene runs in a process of its own, which the system ends after some seconds of processor time.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

use clap::Parser;
use jostle_agree::chance::Chance;
use jostle_agree::judge::{Judged, judge};
use jostle_agree::language::Language;
use jostle_agree::minimise::minimise;
use jostle_agree::scene::{self, Drawn};
use jostle_agree::ways::Way;
use jostle_agree::written::scene as written_scene;

/// Evaluations of all forces that a run may take, in a scene of a second and four bodies.
const MOST_EVALUATIONS: u64 = 2_000_000;
/// The exit code of a hunt that found something.
const EXIT_FOUND: u8 = 1;

/// Draws scenes from all that the registry lists. Each runs under the default, three tolerances, `Reference`, and two
/// ticks of `Dop853` and `RungeKutta4`. Two runs that differ by more than three times what both state are a
/// find. So are panics, numbers that are not finite, endless runs, and other bits of a run in pieces.
///
/// Exit codes: 0 nothing found, 1 something found, 2 a file cannot be written.
#[derive(Parser, Debug)]
#[command(name = "jostle_agree")]
struct Flags {
    /// Seed of chance: the same seed gives the same scenes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The number of the first scene
    #[arg(long, default_value_t = 0)]
    from: u64,
    /// How many scenes
    #[arg(long, default_value_t = 1000)]
    count: u64,
    /// Seconds after which no further scene begins
    #[arg(long, default_value_t = u64::MAX)]
    seconds: u64,
    /// The longest run, in s of physics
    #[arg(long, default_value_t = 1.0)]
    longest: f64,
    /// Seconds of processor time that a scene may take
    #[arg(long, default_value_t = 60)]
    patience: u64,
    /// Folder for finds: SEED_NUMBER.ron, with the find in its first lines
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print the scene of `--from` and end
    #[arg(long)]
    print: bool,
    /// Judge this file instead of scenes of chance
    #[arg(long)]
    only: Option<PathBuf>,
    /// The ways to compare, as they are printed; default: all
    #[arg(long)]
    ways: Vec<String>,
    /// Compare trusted runs with the limit of velocity Verlet too. Both differ by depths of springs where they are right
    #[arg(long)]
    laws: bool,
    /// Seconds of processor time to make a find smaller
    #[arg(long, default_value_t = 0)]
    smaller: u64,
    /// The number of the scene of a child
    #[arg(long, hide = true)]
    child: Option<u64>,
}

impl Flags {
    fn wants(&self, way: &Way) -> bool {
        self.ways.is_empty() || self.ways.contains(&way.name)
    }
}

/// Prints a line. A reader that reads no further needs to be told nothing.
macro_rules! say {
    ($($words:tt)*) => {
        let _ = writeln!(std::io::stdout(), $($words)*);
    };
}

fn main() -> ExitCode {
    let flags = Flags::parse();
    if let Some(file) = &flags.only {
        let Ok(text) = std::fs::read_to_string(file) else {
            say!("{} cannot be read", file.display());
            return ExitCode::from(2);
        };
        let judged = judge(
            &text,
            (|_, way| flags.wants(way), flags.laws),
            MOST_EVALUATIONS,
            &mut Chance::new(flags.seed, 0),
            |_| {},
        );
        for (way, verdict) in &judged.verdicts {
            say!("{way}: {verdict}");
        }
        tell(&judged);
        return ExitCode::from(if judged.finds.is_empty() { 0 } else { EXIT_FOUND });
    }
    if flags.print {
        let drawn = scene::scene(&Language::standard(), (flags.seed, flags.from), flags.longest);
        say!("{}", drawn.text());
        return ExitCode::SUCCESS;
    }
    if let Some(number) = flags.child {
        child(&flags, number);
        return ExitCode::SUCCESS;
    }
    match hunt(&flags) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(EXIT_FOUND),
        Err(error) => {
            say!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Prints the lines that the parent reads of a child.
fn tell(judged: &Judged) {
    for (way, excess, trusted) in &judged.statements {
        say!("statement\t{way}\t{excess:e}\t{trusted}");
    }
    for find in &judged.finds {
        say!("find\t{:?}\t{}\t{}", find.kind, find.way, find.how.replace(['\n', '\t'], " "));
    }
    let Judged { runs, refused, silent, evaluations, .. } = judged;
    say!("runs\t{runs}\t{refused}\t{silent}\t{evaluations}");
}

/// Draws a scene, and tells the parent what its runs do.
fn child(flags: &Flags, number: u64) {
    let drawn = scene::scene(&Language::standard(), (flags.seed, number), flags.longest);
    for (section, (all, refused)) in &drawn.counts {
        say!("drawn\t{section}\t{all}\t{refused}");
    }
    let chance = || Chance::new(flags.seed ^ 0x5eed, number);
    let judged =
        judge(&drawn.text(), (|_, way| flags.wants(way), flags.laws), MOST_EVALUATIONS, &mut chance(), |way| {
            // The last line of a child that is ended.
            say!("at\t{way}");
        });
    tell(&judged);
    let (Some(folder), Some(gravest)) = (&flags.out, judged.finds.iter().max_by_key(|find| find.kind)) else { return };
    let text = if flags.smaller > 0 { written_scene(&small(flags, &drawn, &judged)) } else { drawn.text() };
    let file = folder.join(format!("{}_{number}.ron", flags.seed));
    let again = format!("jostle_agree --seed {} --from {number} --count 1 --longest {:?}", flags.seed, flags.longest);
    let finds: String =
        judged.finds.iter().map(|find| format!("// {}\n", find.to_string().replace('\n', " "))).collect();
    let head = format!("// {:?}. {again}\n{finds}", gravest.kind);
    if let Err(error) = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(&file, head + &text)) {
        say!("error\t{error}");
    }
}

/// A smaller scene with a find of the same kind and way.
fn small(flags: &Flags, drawn: &Drawn, judged: &Judged) -> Vec<(String, jostle_agree::written::Written)> {
    let Some(gravest) = judged.finds.iter().max_by_key(|find| find.kind) else { return drawn.sections.clone() };
    minimise(drawn.sections.clone(), Duration::from_secs(flags.smaller), |sections| {
        let judged = judge(
            &written_scene(sections),
            (|_, _| true, flags.laws),
            MOST_EVALUATIONS,
            &mut Chance::new(flags.seed ^ 0x5eed, 0),
            |_| {},
        );
        judged
            .finds
            .iter()
            .any(|find| find.kind == gravest.kind && find.way.split(' ').next() == gravest.way.split(' ').next())
    })
}

/// The statements of one way, and those of them that are too small.
#[derive(Default)]
struct Shares {
    all: u64,
    usual: u64,
    grave: u64,
    trusted: u64,
}

/// Sums over scenes.
#[derive(Default)]
struct Sums {
    scenes: u64,
    runs: [u64; 4],
    drawn: BTreeMap<String, (u64, u64)>,
    ways: BTreeMap<String, Shares>,
    finds: BTreeMap<String, u64>,
}

/// Goes through scenes; says whether nothing was found.
fn hunt(flags: &Flags) -> std::io::Result<bool> {
    let (begin, mut sums) = (Instant::now(), Sums::default());
    let own = std::env::current_exe()?;
    for number in flags.from..flags.from.saturating_add(flags.count) {
        if begin.elapsed() > Duration::from_secs(flags.seconds) {
            break;
        }
        let mut child = Command::new("sh");
        child.args(["-c", "ulimit -t \"$0\"; exec \"$@\"", &(flags.patience + flags.smaller).to_string()]).arg(&own);
        child.arg(format!("--child={number}")).arg(format!("--seed={}", flags.seed));
        child.arg(format!("--longest={:?}", flags.longest)).arg(format!("--smaller={}", flags.smaller));
        if flags.laws {
            child.arg("--laws");
        }
        if let Some(out) = &flags.out {
            child.arg("--out").arg(out);
        }
        let output = child.output()?;
        sums.scenes += 1;
        let (told, mut last) = (String::from_utf8_lossy(&output.stdout), "");
        for line in told.lines() {
            match line.strip_prefix("at\t") {
                Some(way) => last = way,
                None => sums.add(number, line),
            }
        }
        if !output.status.success() {
            say!("{number}\tEndless: {last}: {} after {} s of processor time", output.status, flags.patience);
            *sums.finds.entry("Endless".to_owned()).or_default() += 1;
        }
    }
    sums.tell();
    Ok(sums.finds.is_empty())
}

impl Sums {
    fn add(&mut self, number: u64, line: &str) {
        let parts: Vec<&str> = line.split('\t').collect();
        match &parts[..] {
            ["statement", way, excess, trusted] => {
                // Ticks of methods differ from scene to scene.
                let way = way.split(" --tick").next().unwrap_or(way).to_owned();
                let (excess, shares) = (excess.parse().unwrap_or(0.0), self.ways.entry(way).or_default());
                let grave = excess > jostle_agree::judge::GRAVE;
                shares.all += 1;
                shares.usual += u64::from(excess > jostle_agree::judge::USUAL);
                shares.grave += u64::from(grave);
                shares.trusted += u64::from(grave && *trusted == "true");
            }
            ["find", kind, way, how] => {
                *self.finds.entry((*kind).to_owned()).or_default() += 1;
                say!("{number}\t{kind}: {way}: {how}");
            }
            ["runs", counts @ ..] => {
                for (sum, count) in self.runs.iter_mut().zip(counts) {
                    *sum += count.parse::<u64>().unwrap_or(0);
                }
            }
            ["drawn", section, all, refused] => {
                let sum = self.drawn.entry((*section).to_owned()).or_default();
                sum.0 += all.parse::<u64>().unwrap_or(0);
                sum.1 += refused.parse::<u64>().unwrap_or(0);
            }
            _ => {
                say!("{number}\t{line}");
            }
        }
    }

    fn tell(&self) {
        let [runs, refused, silent, evaluations] = self.runs;
        say!(
            "{} scenes, {runs} runs: {refused} refused or failed, {silent} state nothing; {evaluations} evaluations",
            self.scenes
        );
        for (section, (all, refused)) in &self.drawn {
            say!("  {section}: {refused} of {all} draws refused by the reader");
        }
        for (way, Shares { all, usual, grave, trusted }) in &self.ways {
            say!(
                "  {way}: {all} statements, {usual} more than 3 times too small, {grave} more than 10 times, {trusted} of these trusted"
            );
        }
        for (kind, times) in &self.finds {
            say!("  {times} x {kind}");
        }
    }
}
