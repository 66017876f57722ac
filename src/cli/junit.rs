//! Results as JUnit XML for build servers. Each scene is a suite, with the run and each of its expectations.

use std::fmt::Write;

use super::trial::{Trial, Verdict};
use crate::scene::{is_hidden, visible_line};

/// A result by name, or the reason for which there is none.
pub(super) type Named<'a> = (&'a str, Result<&'a Trial, &'static str>);

/// The whole report; `seconds` were spent in all.
pub(super) fn report(results: &[Named], seconds: f64) -> String {
    let mut suites = String::new();
    let mut all = Counts::default();
    for &(name, trial) in results {
        let mut cases = String::new();
        let counts = match trial {
            Ok(trial) => cases_of(name, trial, &mut cases),
            Err(why) => {
                case(&mut cases, name, "runs", 0.0, &Answer::Skipped(why));
                Counts { tests: 1, skipped: 1, ..Counts::default() }
            }
        };
        let spent = trial.map_or(0.0, |trial| trial.seconds);
        let _ =
            writeln!(suites, "  <testsuite name=\"{}\" {}>\n{cases}  </testsuite>", escaped(name), counts.shown(spent));
        all = all.plus(counts);
    }
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"jostle\" {}>\n{suites}</testsuites>\n",
        all.shown(seconds)
    )
}

enum Answer<'a> {
    Passed,
    Skipped(&'a str),
    /// An expectation that does not hold.
    Failure(&'a str),
    /// A run that was not made, or not to its end.
    Error(&'a str),
}

fn cases_of(name: &str, trial: &Trial, cases: &mut String) -> Counts {
    let answer = match trial.verdict {
        Verdict::Good | Verdict::Broken => Answer::Passed,
        Verdict::Refused | Verdict::Failed => Answer::Error(&trial.reason),
    };
    case(cases, name, "runs", trial.seconds, &answer);
    for outcome in &trial.expect {
        let answer = if outcome.holds { Answer::Passed } else { Answer::Failure(&outcome.measured) };
        case(cases, name, &visible_line(&outcome.text), 0.0, &answer);
    }
    Counts {
        tests: 1 + trial.expect.len(),
        failures: trial.expect.len() - trial.held(),
        errors: usize::from(matches!(answer, Answer::Error(_))),
        skipped: 0,
    }
}

fn case(cases: &mut String, suite: &str, name: &str, seconds: f64, answer: &Answer) {
    let (suite, name) = (escaped(suite), escaped(name));
    let _ = write!(cases, "    <testcase classname=\"{suite}\" name=\"{name}\" time=\"{seconds:.3}\"");
    let _ = match answer {
        Answer::Passed => writeln!(cases, "/>"),
        Answer::Skipped(why) => writeln!(cases, "><skipped message=\"{}\"/></testcase>", escaped(why)),
        Answer::Failure(why) => writeln!(cases, "><failure message=\"{}\"/></testcase>", escaped(why)),
        Answer::Error(why) => writeln!(cases, "><error message=\"{}\"/></testcase>", escaped(why)),
    };
}

#[derive(Clone, Copy, Default)]
struct Counts {
    tests: usize,
    failures: usize,
    errors: usize,
    skipped: usize,
}

impl Counts {
    fn plus(self, other: Self) -> Self {
        Self {
            tests: self.tests + other.tests,
            failures: self.failures + other.failures,
            errors: self.errors + other.errors,
            skipped: self.skipped + other.skipped,
        }
    }

    fn shown(self, seconds: f64) -> String {
        let Self { tests, failures, errors, skipped } = self;
        format!(
            "tests=\"{tests}\" failures=\"{failures}\" errors=\"{errors}\" skipped=\"{skipped}\" time=\"{seconds:.3}\""
        )
    }
}

/// A text as the value of an attribute. Hidden characters become escapes, and others that XML 1.0 cannot hold a replacement
/// character.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' | '\r' => out.push(' '),
            '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ if is_hidden(letter) => out.extend(letter.escape_unicode()),
            _ => out.push(letter),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expect::ExpectationOutcome;

    #[test]
    fn what_is_broken_stands_beside_what_holds() {
        let outcome = |text: &str, holds| ExpectationOutcome {
            text: text.into(),
            holds,
            measured: "1 < 2 & \"3\"".into(),
            judged: true,
        };
        let trial = Trial {
            files: Vec::new(),
            verdict: Verdict::Broken,
            reason: String::new(),
            errors: None,
            expect: vec![outcome("A(of: \"b\")", true), outcome("C(\n    d: 1)", false)],
            completed: true,
            warnings: Vec::new(),
            hash: None,
            seconds: 0.25,
        };
        let report = report(&[("a.ron", Ok(&trial)), ("theme.ron", Err("not a scene"))], 1.5);
        let expected = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>
<testsuites name=\"jostle\" tests=\"4\" failures=\"1\" errors=\"0\" skipped=\"1\" time=\"1.500\">
  <testsuite name=\"a.ron\" tests=\"3\" failures=\"1\" errors=\"0\" skipped=\"0\" time=\"0.250\">
    <testcase classname=\"a.ron\" name=\"runs\" time=\"0.250\"/>
    <testcase classname=\"a.ron\" name=\"A(of: &quot;b&quot;)\" time=\"0.000\"/>
    <testcase classname=\"a.ron\" name=\"C( d: 1)\" time=\"0.000\"><failure message=\"1 &lt; 2 &amp; &quot;3&quot;\"/></testcase>
  </testsuite>
  <testsuite name=\"theme.ron\" tests=\"1\" failures=\"0\" errors=\"0\" skipped=\"1\" time=\"0.000\">
    <testcase classname=\"theme.ron\" name=\"runs\" time=\"0.000\"><skipped message=\"not a scene\"/></testcase>
  </testsuite>
</testsuites>
";
        assert_eq!(report, expected);
        assert_eq!(escaped("\u{7}\n"), "\\u{7} ");
    }
}
