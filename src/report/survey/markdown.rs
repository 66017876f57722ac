//! The report as Markdown.

use super::{GRADES, Sheet, machine};
use crate::report::card::number;

/// The page: what was measured with, a summary, and each problem. Diagrams stand beside it, as `NAME.svg`.
pub fn page(sheets: &[Sheet]) -> String {
    let mut text = format!("# Speed against error\n\n{}. {}\n\n", machine(), HOW);
    text.push_str("| problem | its law |");
    for (name, bound) in GRADES {
        text.push_str(&format!(" {name}, {bound:e} |"));
    }
    text.push_str("\n|---|---|---|---|---|\n");
    for sheet in sheets {
        text.push_str(&format!("| [{0}](#{0}) | {1} |", sheet.problem.name, sheet.problem.law));
        for (_, bound) in GRADES {
            text.push_str(&format!(" {} |", reached(sheet, bound)));
        }
        text.push('\n');
    }
    for sheet in sheets {
        text.push_str(&problem(sheet));
    }
    text
}

pub(super) const HOW: &str = "Seconds of computing for each second of physics with which an error is reached, and how: the \
                   cheapest of all methods and ticks. `located`: events are found inside ticks. Errors are the greatest at the samples of a problem, against its exact answer. Runs of more than a million ticks, with --quick 30 000, are left out.";

/// The cheapest setting for an error.
pub(super) fn reached(sheet: &Sheet, error: f64) -> String {
    sheet.cheapest(error).map_or_else(
        || "none".to_owned(),
        |(cell, reached)| format!("{:.1e}: {}, {} s", reached.cost, cell.course.name(), number(cell.tick)),
    )
}

fn problem(sheet: &Sheet) -> String {
    let problem = &sheet.problem;
    let mut text = format!("\n## {}\n\n{}. Source: {}.", problem.name, capital(problem.law), problem.source);
    if let Some(hash) = &sheet.hash {
        text.push_str(&format!(" State hash of `Auto` at a tick of {} s: `{hash}`.", number(problem.tick)));
    }
    text.push_str(&format!("\n\n![cost over error]({}.svg)\n\n", problem.name));
    let unit = if problem.unit == "1" { String::new() } else { format!(" in {}", problem.unit) };
    text.push_str(&format!("| method | tick in s | error{unit} | s per s | grade |\n|---|---|---|---|---|\n"));
    for cell in &sheet.cells {
        let rest = match &cell.outcome {
            Ok(reached) => {
                let grade = sheet.grade(reached.error).unwrap_or("");
                format!("{:.2e} | {:.2e} | {grade}", reached.error, reached.cost)
            }
            Err(reason) => format!("does not run: {} | | ", reason.replace('|', "/")),
        };
        text.push_str(&format!("| {} | {} | {rest} |\n", cell.course.name(), number(cell.tick)));
    }
    text
}

pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
