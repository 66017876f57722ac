//! Measurements for people, for spreadsheets and for programs.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::cli::columns::{aligned, quoted};
use crate::cli::say::number;
use crate::output::csv;
use crate::report::measure::{Measured, NORM, NoReference};
use crate::report::work_precision::{Advice, Cost, Deviation, MethodChoice, Setting, SettingOutcome};
use crate::tick::FailureKind;

/// Three digits are enough for a measurement.
fn rounded(value: f64) -> String {
    number(format!("{value:.2e}").parse().unwrap_or(value))
}

/// An error is known to two digits at the best.
fn error_in_words(measured: &Measured, setting: &Setting) -> String {
    match (setting.error(), measured.settings.claimed(setting)) {
        (Some(error), Some(claimed)) if error < claimed => format!("< {claimed:.1e}"),
        (Some(error), _) => format!("{error:.1e}"),
        (None, _) => String::new(),
    }
}

/// Its distance from the reference, in m and m/s.
fn apart(setting: &Setting) -> Option<(f64, f64)> {
    if let SettingOutcome::Measured(Deviation { apart, .. }) = setting.outcome { apart } else { None }
}

/// Its outcome, in a word.
fn word(setting: &Setting) -> &'static str {
    match setting.outcome {
        SettingOutcome::Measured(_) => "measured",
        SettingOutcome::Unknown => "unknown",
        SettingOutcome::Failed(_) => "failed",
        SettingOutcome::Refused(_) => "refused",
        SettingOutcome::Stopped(_) => "stopped",
    }
}

/// The notes beside the numbers.
fn note(setting: &Setting) -> String {
    let first = match &setting.outcome {
        SettingOutcome::Measured(_) => None,
        SettingOutcome::Unknown => Some("reaches its end, its error is unknown".to_owned()),
        SettingOutcome::Failed(failure) => {
            let what = match failure.wrong {
                FailureKind::Crossed(_) => format!("`{}` passes through the wall `{}`", failure.body, failure.other),
                FailureKind::Behind(_) => format!("`{}` comes through `{}` from behind", failure.body, failure.other),
                FailureKind::Sunk(_) => {
                    format!("corners sink too deep, between `{}` and `{}`", failure.body, failure.other)
                }
                FailureKind::NotFinite(quantity) => {
                    format!("the {quantity} of `{}` is infinite or NaN", failure.body)
                }
                FailureKind::Steps(step) => {
                    format!("steps have become as short as {step:.1e} s near `{}`", failure.body)
                }
                FailureKind::Jumps { step, .. } => format!("steps have become as short as {step:.1e} s between jumps"),
                FailureKind::Contradiction => {
                    format!("motors and joints ask for different motions of `{}`", failure.body)
                }
                FailureKind::Joint { meters, .. } => format!("a joint of `{}` is open by {meters:.1e} m", failure.body),
                FailureKind::Energy(_) => "energy comes out of nowhere".to_owned(),
                FailureKind::Pairs(most) => format!("more than {most} pairs of atoms lie near each other"),
                FailureKind::Stopped => "it was ended".to_owned(),
                FailureKind::Torn(list) => format!("the packed list `{list}` of bodies does not fit the others"),
                FailureKind::Lost(component) => format!("`{}` has lost its component `{component}`", failure.body),
                FailureKind::Gone(name) => format!("{name} is gone"),
            };
            Some(format!("fails at t = {} s: {what}", number(failure.time)))
        }
        SettingOutcome::Refused(why) => Some(format!("refused: {why}")),
        SettingOutcome::Stopped(share) => {
            Some(format!("stopped at {:.0} % of the run: the budget is used up", 100.0 * share))
        }
    };
    first.iter().chain(&setting.notes).map(String::as_str).collect::<Vec<_>>().join("; ")
}

/// The command that runs a scene with a setting.
fn command(run: &str, setting: &Setting) -> String {
    // Fifteen digits are enough, and leave out what rounding makes of a sixteenth.
    let tick = format!("{:.14e}", setting.tick).parse().unwrap_or(setting.tick);
    format!("{run} --method {} --tick {}", setting.course.method, csv::number(tick))
}

/// Table, reference run and advice; `run` is the command that runs the scene.
pub(super) fn text(measured: &Measured, run: &str) -> String {
    let mut text = aligned(
        &["method", "tick in s", "error", "s/s", "evaluations/s", ""],
        measured.settings.all.iter().map(|setting| {
            let star = if measured.settings.is_best(setting) { " *" } else { "" };
            let runs = setting.evaluations > 0.0;
            vec![
                format!("{}{star}", setting.course.method),
                rounded(setting.tick),
                error_in_words(measured, setting),
                setting.seconds.map_or_else(String::new, rounded),
                if runs { rounded(setting.evaluations) } else { String::new() },
                note(setting),
            ]
        }),
    );
    text.push_str("\nThe end of the sequence of ticks:\n");
    let ends = measured.settings.ends.iter().map(|(course, why)| vec![course.method.to_owned(), why.clone()]);
    let ends = aligned(&["method", ""], ends);
    text.push_str(ends.split_once('\n').map_or("", |(_, rest)| rest));
    text.push('\n');
    let _ = writeln!(text, "Error: {NORM}.");
    let _ = writeln!(
        text,
        "s/s and evaluations/s: seconds, and evaluations of all forces, per second of physics. A star: no other setting is more exact for \
         less {}.",
        cost(measured)
    );
    match &measured.reference {
        Ok(reference) => {
            let _ = writeln!(
                text,
                "Reference: {}. Its own error is about {:.0e} at most, so the table claims no error below {:.0e}.",
                reference.words,
                reference.floor,
                reference.claim()
            );
            if let Some(why) = &reference.why_until {
                let _ = writeln!(
                    text,
                    "Compared until t = {} s of {} s: {why}.",
                    number(rough(reference.until)),
                    number(measured.duration)
                );
            }
            if let Some(scatter) = &reference.scatter {
                let _ = writeln!(
                    text,
                    "For the rest, the table compares means over time and all bodies. There, reference runs differ by {}: \
                     chaos, not error.",
                    scatter.words()
                );
            }
            if let Some(warning) = &reference.warning {
                let _ = writeln!(text, "warning: {warning}");
            }
        }
        Err(_) => text.push_str("Reference: none. No errors are known.\n"),
    }
    let advice = measured.settings.advice();
    if measured.reference.is_ok() {
        // Common advice for several errors is printed once.
        let mut parts: Vec<(String, String)> = Vec::new();
        for advice in &advice {
            let (target, (lead, what)) = (format!("{:.0e}", advice.target), told(measured, advice));
            match parts.last_mut().filter(|(_, said)| *said == what) {
                Some((targets, _)) => *targets = format!("{}, {target}", targets),
                None => parts.push((format!("{lead} {target}"), what)),
            }
        }
        let parts: Vec<String> = parts.into_iter().map(|(targets, what)| format!("{targets} {what}")).collect();
        let known = |error: f64| measured.reference.as_ref().is_ok_and(|reference| reference.claim() <= error);
        let missed = advice.iter().any(|advice| advice.reached.is_none() && known(advice.target));
        let more = if missed { "; a larger --budget tries finer ticks" } else { "" };
        let _ = writeln!(text, "\nAdvice: {}{more}.", parts.join("; "));
        let mut lines: Vec<String> = Vec::new();
        for setting in advice.iter().filter_map(|advice| advice.reached.or(advice.nearest)) {
            let line = format!("  {}", command(run, setting));
            if !lines.contains(&line) {
                lines.push(line);
            }
        }
        text.push_str(&lines.join("\n"));
        text.push('\n');
    }
    text
}

fn rough(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

fn cost(measured: &Measured) -> &'static str {
    match measured.settings.cost {
        Cost::Time => "time",
        Cost::Evaluations => "evaluations",
    }
}

/// The advice for an error, as two parts of a sentence around the error.
fn told(measured: &Measured, advice: &Advice) -> (&'static str, String) {
    let price = |setting: &Setting| {
        let spent = match measured.settings.cost {
            Cost::Time => setting.seconds.map(|seconds| format!("{} s", rounded(seconds))),
            Cost::Evaluations => Some(format!("{} evaluations", rounded(setting.evaluations))),
        };
        let spent = spent.map_or_else(String::new, |spent| format!(", {spent} per second"));
        let limits: String = setting.notes.iter().map(|note| format!("; {note}")).collect();
        format!(
            "{} with ticks of {} s (error {}{spent}{limits})",
            setting.course.method,
            rounded(setting.tick),
            error_in_words(measured, setting)
        )
    };
    match (advice.reached, advice.nearest) {
        (Some(setting), _) => ("for an error of", price(setting)),
        (None, Some(setting)) => {
            let below = measured.reference.as_ref().is_ok_and(|reference| reference.claim() > advice.target);
            let why = if below { "the reference run does not tell so small errors" } else { "no setting reaches it" };
            ("for", format!("{why}, nearest comes {}", price(setting)))
        }
        (None, None) => ("for", "no setting is useful".to_owned()),
    }
}

/// All settings as comma-separated values.
pub(super) fn csv(measured: &Measured) -> String {
    let mut text = "method,tick [s],located,outcome,error,error_claimed,position_error [m],velocity_error [m/s],seconds_per_second,\
                    evaluations_per_second [1/s],best,note\n"
        .to_owned();
    let or_empty = |value: Option<f64>| value.map_or_else(String::new, csv::number);
    for setting in &measured.settings.all {
        let apart = apart(setting);
        let cells = [
            setting.course.method.to_owned(),
            csv::number(setting.tick),
            setting.located.to_string(),
            word(setting).to_owned(),
            or_empty(setting.error()),
            or_empty(measured.settings.claimed(setting)),
            or_empty(apart.map(|(distance, _)| distance)),
            or_empty(apart.map(|(_, speed)| speed)),
            or_empty(setting.seconds),
            csv::number(setting.evaluations),
            measured.settings.is_best(setting).to_string(),
            quoted(&note(setting)),
        ];
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// The measurement, for programs.
pub(super) fn json(scene: &str, measured: &Measured, run: &str) -> Value {
    let setting = |setting: &Setting| {
        let apart = apart(setting);
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        json!({
            "method": setting.course.method,
            "tick": setting.tick,
            "located": setting.located,
            "outcome": word(setting),
            "error": finite(setting.error()),
            "error_claimed": finite(measured.settings.claimed(setting)),
            "position_error": finite(apart.map(|(distance, _)| distance)),
            "velocity_error": finite(apart.map(|(_, speed)| speed)),
            "seconds_per_second": setting.seconds,
            "evaluations_per_second": setting.evaluations,
            "best": measured.settings.is_best(setting),
            "note": note(setting),
        })
    };
    let advice = |advice: &Advice| {
        let taken = advice.reached.or(advice.nearest);
        json!({
            "target": advice.target,
            "reached": advice.reached.is_some(),
            "method": taken.map(|setting| setting.course.method),
            "tick": taken.map(|setting| setting.tick),
            "error_claimed": taken.and_then(|setting| measured.settings.claimed(setting)),
            "command": taken.map(|setting| command(run, setting)),
        })
    };
    let reference = match &measured.reference {
        Ok(reference) => json!({
            "made_by": reference.words,
            "error": reference.floor,
            "smallest_claimed": reference.claim(),
            "horizon": reference.horizon,
            "compared_until": reference.until,
            "why_until": reference.why_until,
            "scatter_beyond": reference.scatter.map(|apart| json!({ "speed": apart.speed, "place": apart.place })),
            "warning": reference.warning,
        }),
        Err(NoReference::Failed(failure)) => json!({ "missing": failure.to_string() }),
        Err(_) => json!({ "missing": "there is none" }),
    };
    let end = |(course, why): &(MethodChoice, String)| json!({ "method": course.method, "why": why });
    json!({
        "scene": scene,
        "time": measured.duration,
        "norm": NORM,
        "cost": cost(measured),
        "reference": reference,
        "settings": measured.settings.all.iter().map(setting).collect::<Vec<_>>(),
        "ends": measured.settings.ends.iter().map(end).collect::<Vec<_>>(),
        "advice": if measured.reference.is_ok() { measured.settings.advice().iter().map(advice).collect() } else { Vec::new() },
        "seconds_spent": measured.spent,
    })
}
