//! The list of mistakes that checks find, and the checks that every section needs.

use glam::DVec2;

use super::number::exact;
use super::outline::join;

/// A cost of reading that all patterns of a scene share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PatternCost {
    /// Comparisons of a name with a part of a pattern. The bound takes a few seconds.
    Comparisons,
    /// Names that patterns stand for. A sensor takes up to a microsecond and a hundred bytes for each.
    Names,
}

impl PatternCost {
    fn most(self) -> usize {
        match self {
            Self::Comparisons => 50_000_000,
            Self::Names => 2_000_000,
        }
    }

    /// The mistake of a scene beyond the bound, and its remedy.
    fn told(self) -> (String, &'static str) {
        let most = self.most();
        match self {
            Self::Comparisons => (
                format!("with this one, names are compared with patterns more than {most} times"),
                "name bodies in fewer patterns: one with `*` may stand for many",
            ),
            Self::Names => (
                format!("with this one, patterns stand for more than {most} names in all"),
                "use fewer patterns with `*`, or let them fit fewer names",
            ),
        }
    }
}

/// A mistake found by a check. Its place in the text is looked up only when it is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// The path, such as `bodies[0].mass`.
    pub path: String,
    /// The mistake, and what the check found.
    pub message: String,
    /// The remedy.
    pub help: Option<String>,
    /// The name of the absent field, if that is the mistake.
    pub missing: Option<String>,
    /// A second path, and its part in the mistake.
    pub also: Option<(String, String)>,
}

impl Diagnostic {
    /// Adds what to do about it.
    pub fn help(&mut self, help: impl Into<String>) -> &mut Self {
        self.help = Some(help.into());
        self
    }

    /// Adds a second place. `path` is counted from the whole scene.
    pub fn also(&mut self, path: impl Into<String>, label: impl Into<String>) -> &mut Self {
        self.also = Some((path.into(), label.into()));
        self
    }
}

/// Collects mistakes and notes. Paths are relative to the section or entry that is checked.
///
/// ```
/// # use jostle_language::Diagnostics;
/// let mut report = Diagnostics::new();
/// report.within("[3]", |report| {
///     report.positive("mass", -1.5);
/// });
/// assert_eq!(report.problems()[0].path, "[3].mass");
/// assert_eq!(report.problems()[0].message, "must be a finite number above zero, got -1.5");
/// ```
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    scope: String,
    problems: Vec<Diagnostic>,
    notes: Vec<String>,
    /// The costs of patterns so far, by [`PatternCost`].
    patterns: [usize; 2],
}

impl Diagnostics {
    /// A report without mistakes, whose paths begin at the scene.
    pub fn new() -> Self {
        Self::default()
    }

    /// Writes down a mistake at a path (`""`: the scope itself).
    pub fn error(&mut self, path: &str, message: impl Into<String>) -> &mut Diagnostic {
        let path = join(&self.scope, path);
        self.error_at(path, message.into())
    }

    /// Reports an absent field. `help` says what to write.
    pub fn missing(&mut self, field: &str, help: impl Into<String>) {
        let problem = self.error("", format!("the field `{field}` is missing"));
        problem.missing = Some(field.to_owned());
        problem.help(help);
    }

    pub(crate) fn error_at(&mut self, path: String, message: String) -> &mut Diagnostic {
        // Handing out a reference to what was just pushed, without a way to fail.
        self.problems.push(Diagnostic { path, message, help: None, missing: None, also: None });
        let last = self.problems.len() - 1;
        &mut self.problems[last]
    }

    /// Reports a fact that the author should know although it is no mistake. The run's error card shows it.
    pub fn note(&mut self, text: impl Into<String>) {
        self.notes.push(text.into());
    }

    /// Counts a cost of a pattern. If all costs exceed the bound, that is a mistake, which is reported once. Returns whether they do not.
    pub(crate) fn may_cost(&mut self, path: &str, cost: PatternCost, amount: usize) -> bool {
        let (sum, most) = (&mut self.patterns[cost as usize], cost.most());
        let before = *sum;
        *sum = before.saturating_add(amount);
        let within = *sum <= most;
        if !within && before <= most {
            let (message, help) = cost.told();
            self.error(path, message).help(help);
        }
        within
    }

    /// Runs checks whose paths begin at `scope`, such as `"[3]"` or `"atoms"`.
    pub fn within<R>(&mut self, scope: &str, checks: impl FnOnce(&mut Self) -> R) -> R {
        let inner = join(&self.scope, scope);
        let outer = std::mem::replace(&mut self.scope, inner);
        let result = checks(self);
        self.scope = outer;
        result
    }

    /// A number must be finite. Returns whether it is.
    pub fn finite(&mut self, path: &str, value: impl Into<f64>) -> bool {
        let value = value.into();
        self.must(path, value.is_finite(), "must be a finite number", value)
    }

    /// A number must be finite and above zero. Returns whether it is.
    pub fn positive(&mut self, path: &str, value: impl Into<f64>) -> bool {
        let value = value.into();
        self.must(path, value.is_finite() && value > 0.0, "must be a finite number above zero", value)
    }

    /// A number that may be left out must be finite and above zero. Returns whether it is, or is left out.
    pub fn positive_if_given(&mut self, path: &str, value: Option<impl Into<f64>>) -> bool {
        value.is_none_or(|value| self.positive(path, value))
    }

    /// Both parts of a pair must be finite. Returns whether they are.
    pub fn finite_pair(&mut self, path: &str, value: DVec2) -> bool {
        let x = self.finite(&format!("{path}[0]"), value.x);
        let y = self.finite(&format!("{path}[1]"), value.y);
        x && y
    }

    /// A number must be finite and not below zero. Returns whether it is.
    pub fn not_negative(&mut self, path: &str, value: impl Into<f64>) -> bool {
        let value = value.into();
        self.must(path, value.is_finite() && value >= 0.0, "must be a finite number, zero or above", value)
    }

    /// A number must lie from `low` to `high`, both included. Returns whether it does.
    pub fn between(&mut self, path: &str, value: impl Into<f64>, low: f64, high: f64) -> bool {
        let value = value.into();
        self.must(
            path,
            value >= low && value <= high,
            &format!("must be from {} to {}", exact(low), exact(high)),
            value,
        )
    }

    fn must(&mut self, path: &str, holds: bool, rule: &str, value: f64) -> bool {
        if !holds {
            self.error(path, format!("{rule}, got {}", exact(value)));
        }
        holds
    }

    /// Whether no mistake was written down.
    pub fn is_clean(&self) -> bool {
        self.problems.is_empty()
    }

    /// The mistakes so far.
    pub fn problems(&self) -> &[Diagnostic] {
        &self.problems
    }

    /// Runs checks and returns whether they found no mistake.
    pub fn all_good(&mut self, checks: impl FnOnce(&mut Self)) -> bool {
        let before = self.problems.len();
        checks(self);
        self.problems.len() == before
    }

    /// The notes so far.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
}
