//! The order of runs in a work-precision series: every course has ticks from coarse to fine. The cheapest tick of all courses is next. The
//! series ends when errors reach the floor of the reference, or time is up.

use super::{Budget, MethodChoice, Setting, SettingOutcome, USELESS};
use jostle_language::numbers::number;

/// Courses that fail so many times one after the other are left.
const MOST_FAILURES: u32 = 12;
/// Errors below this that fall no more are rounding.
const ROUNDING: f64 = 1e-7;
/// A course is abandoned if another one has no larger error for this share of its evaluations.
const BEHIND: f64 = 1.0 / 64.0;
/// ... but not before this many of its settings are measured. Nor is it abandoned while its errors are above the next
/// number, or fall by the factor behind it. That is the factor of order 3 with half the tick.
const SEEN: usize = 4;
const TELLS: f64 = 0.1;
const STEEP: f64 = 8.0;

/// The ticks of a course in seconds.
pub(crate) struct Rungs<I: Iterator<Item = f64>> {
    /// From coarse to fine.
    pub ticks: I,
    /// Longer ticks, from fine to coarse. They are tried after the first of the others. Each must be useful and take no
    /// more evaluations than the one before.
    pub trials: Vec<f64>,
}

impl<I: Iterator<Item = f64>> From<I> for Rungs<I> {
    fn from(ticks: I) -> Self {
        Self { ticks, trials: Vec::new() }
    }
}

/// The object that runs in the series.
pub(crate) trait Subject {
    /// Why it cannot go on.
    type Wrong;

    /// Runs it with a tick; the setting, with its time if that is known, and the seconds that it took.
    fn run(&self, course: MethodChoice, tick: f64) -> Result<(Setting, f64), Self::Wrong>;

    /// The reason why smaller errors than this have no meaning at a tick, if there is one.
    fn is_floor(&self, error: f64, tick: f64) -> Option<String>;
}

/// When to go no further.
pub(crate) struct Rules {
    /// Ticks that each course tries at the most, trials apart.
    pub rungs: usize,
    /// Whether courses that others leave far behind go on.
    pub leaves_behind: bool,
}

/// A course of the series.
struct Climber<I: Iterator<Item = f64>> {
    course: MethodChoice,
    ticks: std::iter::Peekable<I>,
    trials: Vec<f64>,
    settings: Vec<Setting>,
    /// The number of trials among the settings: they come first.
    trials_of_use: usize,
    /// Seconds and tick of the last one.
    last: Option<(f64, f64)>,
    failures: u32,
    /// The reason why it ends.
    end: Option<String>,
}

/// Climbs; returns the settings, and the reasons why courses ended. Each comes with its rungs.
#[expect(clippy::type_complexity, reason = "two lists")]
pub(crate) fn climb<S: Subject, I: Iterator<Item = f64>>(
    subject: &S,
    courses: impl Iterator<Item = (MethodChoice, Rungs<I>)>,
    rules: &Rules,
    budget: &Budget,
) -> Result<(Vec<Setting>, Vec<(MethodChoice, String)>), S::Wrong> {
    let climber = |(course, rungs): (MethodChoice, Rungs<I>)| Climber {
        course,
        ticks: rungs.ticks.peekable(),
        trials: rungs.trials,
        settings: Vec::new(),
        trials_of_use: 0,
        last: None,
        failures: 0,
        end: None,
    };
    let mut climbers: Vec<Climber<I>> = courses.map(climber).collect();
    loop {
        for climber in &mut climbers {
            // The others have used of the budget meanwhile.
            climber.end = climber.end.take().or_else(|| climber.reason_to_end(subject, rules, budget));
        }
        // The cheapest first, by what does not depend on the computer: a dear course leaves the others their time.
        let climbing = climbers.iter_mut().filter(|climber| climber.end.is_none());
        let foreseen = climbing.map(|climber| (climber.foreseen(), climber));
        let Some((_, next)) = foreseen.min_by(|(a, _), (b, _)| a.total_cmp(b)) else { break };
        next.step(subject)?;
        next.end = next.reason_to_end(subject, rules, budget);
        for index in 0..climbers.len() {
            if rules.leaves_behind && climbers[index].end.is_none() && behind(&climbers, index) {
                climbers[index].end =
                    Some("it takes 64 times the evaluations that others take for this error".to_owned());
            }
        }
    }
    let ends = climbers.iter().map(|climber| (climber.course, climber.end.clone().unwrap_or_default())).collect();
    Ok((climbers.into_iter().flat_map(|climber| climber.settings).collect(), ends))
}

/// Whether another course is as good as the last setting of this one for far fewer evaluations.
fn behind<I: Iterator<Item = f64>>(climbers: &[Climber<I>], index: usize) -> bool {
    let own = &climbers[index].settings;
    let measured = own.iter().filter(|setting| setting.error().is_some()).count();
    let Some((last, error)) = own.last().and_then(|last| Some((last, last.error()?))) else { return false };
    let others = climbers.iter().flat_map(|climber| &climber.settings);
    let better = |other: &Setting| {
        other.error().is_some_and(|share| share <= error) && other.evaluations <= BEHIND * last.evaluations
    };
    // A course whose errors are still useless, or fall steeply, may overtake all others.
    let before = own.iter().rev().skip(1).find_map(Setting::error).unwrap_or(f64::INFINITY);
    measured >= SEEN && error < TELLS && before < STEEP * error && others.into_iter().any(better)
}

impl<I: Iterator<Item = f64>> Climber<I> {
    /// The predicted evaluations of all forces per second of physics for the next tick; zero before the first run.
    fn foreseen(&mut self) -> f64 {
        let last = self.settings.last().map(|last| (last.evaluations, last.tick));
        last.zip(self.ticks.peek()).map_or(0.0, |((evaluations, tick), next)| evaluations * tick / next)
    }

    /// Tries the next tick, and after the first one longer ones.
    fn step<S: Subject>(&mut self, subject: &S) -> Result<(), S::Wrong> {
        let Some(tick) = self.ticks.next() else { return Ok(()) };
        let (setting, spent) = subject.run(self.course, tick)?;
        match setting.outcome {
            SettingOutcome::Failed(_) => self.failures += 1,
            _ => self.failures = 0,
        }
        self.last = Some((spent, tick));
        self.settings.push(setting);
        for tick in std::mem::take(&mut self.trials) {
            // The measure is not time, because then each run would try and report other settings.
            let cost =
                |setting: &Setting| setting.error().filter(|error| *error < USELESS).map(|_| setting.evaluations);
            let Some(before) = cost(&self.settings[0]) else { break };
            let (trial, _) = subject.run(self.course, tick)?;
            if cost(&trial).is_none_or(|cost| cost > before) {
                break;
            }
            self.settings.insert(0, trial);
            self.trials_of_use += 1;
        }
        Ok(())
    }

    /// The reason for which it should go no further.
    fn reason_to_end<S: Subject>(&mut self, subject: &S, rules: &Rules, budget: &Budget) -> Option<String> {
        let Some(next) = self.ticks.peek().copied() else {
            return Some("its sequence has no finer ticks".to_owned());
        };
        let last = self.settings.last()?;
        let error = match &last.outcome {
            SettingOutcome::Refused(_) => return Some("it cannot run this scene".to_owned()),
            SettingOutcome::Stopped(_) => return Some("the budget is used up".to_owned()),
            SettingOutcome::Failed(_) if self.failures >= MOST_FAILURES => {
                return Some("all its runs go wrong".to_owned());
            }
            SettingOutcome::Failed(_) => f64::INFINITY,
            SettingOutcome::Unknown if self.settings.len() >= SEEN => {
                return Some("there is no reference run".to_owned());
            }
            SettingOutcome::Unknown => f64::INFINITY,
            SettingOutcome::Measured(deviation) => deviation.error,
        };
        if let Some(why) = subject.is_floor(error, last.tick) {
            return Some(why);
        }
        let before = self.settings.iter().rev().map_while(Setting::error).take(3).collect::<Vec<_>>();
        if let [now, once, twice] = before[..]
            && twice < ROUNDING
            && now > 0.5 * once
            && once > 0.5 * twice
        {
            return Some("its errors fall no more: rounding".to_owned());
        }
        if self.settings.len() - self.trials_of_use >= rules.rungs {
            return Some(format!("it tried {} ticks, as many as asked for", rules.rungs));
        }
        let (spent, tick) = self.last?;
        // It is run once to be compared, and timed.
        let runs = if last.seconds.is_some() && self.failures == 0 { 2.0 } else { 1.0 };
        let needed = spent * tick / next;
        (needed * runs > budget.left())
            .then(|| format!("the next finer tick would take {} s a run", number(rounded(needed))))
    }
}

/// Two digits are enough for a prediction.
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
