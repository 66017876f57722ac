//! Verdicts on the runs of a scene. No truth is known. Runs that agree within the sum of their stated errors support each
//! other. The run with most support stands for the truth.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::chance::Chance;
use crate::laws;
use crate::run::{Outcome, Ran, in_pieces, run};
use crate::ways::{self, Way};

/// Two runs may differ by this factor of what both state...
pub const USUAL: f64 = 3.0;
/// ... and a difference beyond this one is grave.
pub const GRAVE: f64 = 10.0;
/// Places in m that differ by no more are rounding, of which runs state nothing unless asked.
pub const ROUNDING: f64 = 1e-10;

/// The kind of a broken promise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A trusted run goes elsewhere than velocity Verlet with ever finer ticks.
    Apart,
    /// A run is wrong by more than three times what it states.
    Understated,
    /// By more than ten times.
    Grave,
    /// By more than ten times, and the verdict trusts it.
    Critical,
    /// Most runs exclude each other.
    Divided,
    /// A run fails where most do not.
    Fails,
    /// A run in pieces ends with other bits.
    Bits,
    /// A number is not finite, and the run does not say so.
    NotFinite,
    /// A run takes more evaluations than allowed.
    Long,
    /// The program panics.
    Panics,
}

/// A broken promise.
#[derive(Clone, Debug)]
pub struct Find {
    /// Its kind.
    pub kind: Kind,
    /// The way that is wrong.
    pub way: String,
    /// How, beside which other way, and both verdicts.
    pub how: String,
}

impl fmt::Display for Find {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:?}: {}: {}", self.kind, self.way, self.how)
    }
}

/// All that is known of the runs of a scene.
#[derive(Default)]
pub struct Judged {
    /// Broken promises.
    pub finds: Vec<Find>,
    /// For each way whose statement can be judged: the error over the stated one, and whether the verdict trusts it.
    pub statements: Vec<(String, f64, bool)>,
    /// The verdict of each way, or why there is none.
    pub verdicts: Vec<(String, String)>,
    /// The number of runs.
    pub runs: u64,
    /// Runs that the engine refuses or that fail.
    pub refused: u64,
    /// Runs that state nothing.
    pub silent: u64,
    /// Evaluations of all forces, without trials and estimates.
    pub evaluations: u64,
}

fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned())).unwrap_or_default()
    })
}

/// The tick in s that the engine chooses for a scene.
fn default_tick(text: &str) -> Option<f64> {
    let source = jostle::scene::Source::new("drawn.ron", text);
    let simulation = jostle::Simulation::load(&source).ok()?;
    Some(simulation.clock().dt)
}

/// Runs a scene in all ways that are wanted, by their numbers or names, and compares the runs. Each way is told before it begins.
/// `by_laws`: trusted runs are compared with the limit of velocity Verlet too.
pub fn judge(
    text: &str,
    (wanted, by_laws): (impl Fn(usize, &Way) -> bool, bool),
    most: u64,
    chance: &mut Chance,
    tell: impl Fn(&str),
) -> Judged {
    let mut judged = Judged::default();
    let tick = match guarded(|| default_tick(text)) {
        Ok(Some(tick)) => tick,
        Ok(None) => return judged,
        Err(panic) => {
            judged.found(Kind::Panics, "(default)", panic);
            return judged;
        }
    };
    let ways = ways::all(tick).into_iter().enumerate().filter(|(index, way)| wanted(*index, way));
    let mut ran: Vec<(Way, Box<Ran>)> = Vec::new();
    let mut failed: Vec<(String, String)> = Vec::new();
    for (_, way) in ways {
        judged.runs += 1;
        tell(&way.name);
        match guarded(|| run(text, &way.overrides, most)) {
            Err(panic) => judged.found(Kind::Panics, &way.name, panic),
            Ok(Outcome::Refused(why)) => {
                judged.refused += 1;
                judged.verdicts.push((way.name, why));
            }
            Ok(Outcome::Failed(why)) => {
                judged.refused += 1;
                judged.verdicts.push((way.name.clone(), why.clone()));
                failed.push((way.name, why));
            }
            Ok(Outcome::Long) => judged.found(Kind::Long, &way.name, format!("more than {most} evaluations")),
            Ok(Outcome::NotFinite) => judged.found(Kind::NotFinite, &way.name, "a number is not finite".to_owned()),
            Ok(Outcome::Ran(run)) => {
                judged.evaluations += run.evaluations;
                judged.silent += u64::from(!run.states());
                judged.verdicts.push((way.name.clone(), run.verdict.clone()));
                ran.push((way, run));
            }
        }
    }
    if 2 * failed.len() < ran.len() {
        for (way, why) in failed {
            judged.found(Kind::Fails, &way, why);
        }
    }
    tell("in pieces");
    judged.bits(text, &ran, chance);
    judged.compare(&ran);
    if by_laws {
        tell("laws");
        // Finer ticks take more evaluations.
        match guarded(|| laws::apart(text, tick, 32 * most, &ran)) {
            Ok(finds) => judged.finds.extend(finds),
            Err(panic) => judged.found(Kind::Panics, "laws", panic),
        }
    }
    judged
}

/// Whether two runs differ by no more than both state; by which factor of that they differ.
fn excess(a: &Ran, b: &Ran) -> (f64, f64) {
    let apart = a.apart(b);
    let stated = a.stated.unwrap_or_default() + b.stated.unwrap_or_default();
    ((apart - ROUNDING).max(0.0) / stated.max(f64::MIN_POSITIVE), apart)
}

impl Judged {
    fn found(&mut self, kind: Kind, way: &str, how: String) {
        self.finds.push(Find { kind, way: way.to_owned(), how });
    }

    /// A third of the ways run in pieces too.
    fn bits(&mut self, text: &str, ran: &[(Way, Box<Ran>)], chance: &mut Chance) {
        for (way, run) in ran {
            if !chance.happens(1.0 / 3.0) {
                continue;
            }
            self.runs += 2;
            let piece = || chance.below(1 << 20) as u64;
            match guarded(|| in_pieces(text, &way.overrides, &run.hash, piece)) {
                Ok(None) => {}
                Ok(Some(how)) => self.found(Kind::Bits, &way.name, how),
                Err(panic) => self.found(Kind::Panics, &way.name, format!("in pieces: {panic}")),
            }
        }
    }

    fn compare(&mut self, ran: &[(Way, Box<Ran>)]) {
        let stating: Vec<&(Way, Box<Ran>)> = ran.iter().filter(|(_, run)| run.states()).collect();
        let agree = |a: &Ran, b: &Ran| excess(a, b).0 <= USUAL;
        let support = |run: &Ran| stating.iter().filter(|(_, other)| agree(run, other)).count();
        let best = stating.iter().enumerate().max_by(|(first, (_, a)), (second, (_, b))| {
            let finer = b.stated.partial_cmp(&a.stated).unwrap_or(std::cmp::Ordering::Equal);
            support(a).cmp(&support(b)).then(finer).then(second.cmp(first))
        });
        let Some((index, (best_way, truth))) = best else { return };
        if stating.len() < 2 {
            return;
        }
        let divided = 2 * support(truth) < stating.len() || support(truth) < 2;
        for (other, (way, run)) in stating.iter().enumerate() {
            if other == index {
                self.statements.push((way.name.clone(), 0.0, run.is_trusted()));
                continue;
            }
            let (excess, apart) = excess(run, truth);
            self.statements.push((way.name.clone(), excess, run.is_trusted()));
            if excess <= USUAL {
                continue;
            }
            let kind = match excess {
                _ if divided => Kind::Divided,
                _ if excess <= GRAVE => Kind::Understated,
                _ if run.is_trusted() => Kind::Critical,
                _ => Kind::Grave,
            };
            let how = format!(
                "{apart:.2e} m from {} ({} of {} runs agree with it), {:.1e} and {:.1e} stated. {:?} beside {:?}",
                best_way.name,
                support(truth),
                stating.len(),
                run.stated.unwrap_or_default(),
                truth.stated.unwrap_or_default(),
                run.verdict,
                truth.verdict,
            );
            self.found(kind, &way.name, how);
        }
    }
}
