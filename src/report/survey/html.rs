//! The report as one HTML page that needs nothing beside itself.

use super::markdown::{HOW, capital, reached};
use super::{GRADES, Sheet, diagram, machine};
use crate::report::card::number;

const STYLE: &str = "body{font-family:sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;color:#222}\
table{border-collapse:collapse;font-size:.9rem}td,th{border-bottom:1px solid #ddd;padding:.25rem .6rem;text-align:left}\
summary{cursor:pointer;color:#555}svg{width:100%;height:auto}";

/// The page.
pub fn page(sheets: &[Sheet]) -> String {
    let mut rows = String::new();
    for sheet in sheets {
        let cells: String =
            GRADES.iter().map(|(_, bound)| format!("<td>{}</td>", escaped(&reached(sheet, *bound)))).collect();
        let name = sheet.problem.name;
        rows.push_str(&format!("<tr><td><a href=\"#{name}\">{name}</a></td>{cells}</tr>\n"));
    }
    let heads: String = GRADES.iter().map(|(name, bound)| format!("<th>{name}, {bound:e}</th>")).collect();
    let problems: String = sheets.iter().map(problem).collect();
    format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Jostle: speed against error</title><style>{STYLE}</style>\n\
         <h1>Speed against error</h1><p>{}. {HOW}</p>\n<table><tr><th>problem</th>{heads}</tr>\n{rows}</table>\n{problems}</html>\n",
        escaped(&machine())
    )
}

fn problem(sheet: &Sheet) -> String {
    let mut rows = String::new();
    for cell in &sheet.cells {
        let rest = match &cell.outcome {
            Ok(reached) => {
                let grade = sheet.grade(reached.error).unwrap_or("");
                format!("<td>{:.2e}</td><td>{:.2e}</td><td>{grade}</td>", reached.error, reached.cost)
            }
            Err(reason) => format!("<td colspan=\"3\">does not run: {}</td>", escaped(reason)),
        };
        rows.push_str(&format!("<tr><td>{}</td><td>{}</td>{rest}</tr>\n", cell.course.name(), number(cell.tick)));
    }
    let problem = &sheet.problem;
    format!(
        "<h2 id=\"{0}\">{0}</h2><p>{1}. Source: {2}.</p>\n{3}<details><summary>all settings</summary>\
         <table><tr><th>method</th><th>tick in s</th><th>error</th><th>s per s</th><th>grade</th></tr>\n{rows}</table></details>\n",
        problem.name,
        escaped(&capital(problem.law)),
        escaped(problem.source),
        diagram(sheet)
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
