//! `course: Csv("drive.csv")`: the file is read, and `Piecewise([..])` with its points takes its place.

use std::fmt::Write;

use super::door::{Door, Wanted, Wrong};
use super::emit::{Context, WORK};
use super::write::Buffer;
use super::{Expander, Outcome};
use crate::tree::{Form, Id};
use crate::{cells, count, drop_empty_ends, separator};

/// The leading name of a table in a file, and the field in which it stands.
pub(super) const NAME: &str = "Csv";
pub(super) const FIELD: &str = "course";
const EXAMPLE: &str = "for example: course: Csv(\"drive.csv\")";
const TABLE: Wanted = Wanted {
    most: 16 << 20,
    noun: "a table of numbers, one line each",
    smaller: "keep fewer points: between them the course is linear",
};

impl Expander {
    /// Writes the points of the file that a `Csv(..)` names.
    pub(super) fn table(&mut self, context: &Context, out: &mut Buffer, id: Id) -> Outcome<()> {
        let tree = &context.file.tree;
        let &[child] = tree.children(id) else {
            return Err(Box::new(self.wrong_value(context, id, "one file in `Csv(..)`").with_help(EXAMPLE)));
        };
        let is_text = tree.node(child).form == Form::Text && tree.key(child).is_empty();
        let Some((mut name, shift)) = context.text(child).filter(|_| is_text) else {
            return Err(Box::new(self.wrong_value(context, child, "a file name in quotes").with_help(EXAMPLE)));
        };
        if name.contains(['{', '}']) {
            name = self.filled(context, child, &name, shift)?.text;
        }
        let points = read_points(&self.door, context, &name).map_err(|(message, help)| {
            let mut error = self.wrong(context, context.file.tree.span(child), message);
            error.path = context.file.tree.path(child, &context.file.source.text);
            error.label = "this value".into();
            Box::new(error.with_help(help))
        })?;
        let mut text = String::from("Piecewise([");
        for (time, value) in &points {
            // Writing to a text cannot fail.
            let _ = write!(text, "({time:?}, {value:?}),");
        }
        text.push_str("])");
        self.notes.push(format!("{name}: a course of {}", count(points.len(), "point", "points")));
        self.spend(context, id, 0, WORK * points.len() + text.len())?;
        out.made(&text, context.file.number, context.file.tree.head(id), context.step);
        Ok(())
    }
}

fn read_points(door: &Door, context: &Context, name: &str) -> Result<Vec<(f64, f64)>, Wrong> {
    let Some(folder) = &context.file.source.folder else {
        let message = "this scene is in no file, so no table can be found from it".to_owned();
        return Err((message, "save it as a file, or write the points out: `Piecewise([(0, 1), (2, 0)])`".into()));
    };
    let bytes = TABLE.read(door, &folder.join(name), name)?;
    let text = String::from_utf8(bytes).map_err(|error| {
        (format!("cannot read `{name}` as text: {error}"), "it has to be a table of numbers, one line each".to_owned())
    })?;
    points_of(&text).map_err(|(line, why)| {
        let help = "each line holds a time in seconds and a value, such as `0.5, 2`; the first may hold names instead";
        (format!("line {line} of `{name}` {why}"), help.to_owned())
    })
}

/// The points of a table; or the number of the line that is wrong, and why.
fn points_of(text: &str) -> Result<Vec<(f64, f64)>, (usize, String)> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    let mut named = false;
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let wrong = |why: String| (index + 1, why);
        let Some(mut columns) = cells(line, separator(line)) else {
            return Err(wrong("has a quote that is not closed".into()));
        };
        drop_empty_ends(&mut columns, 2);
        let [time, value] = columns.as_slice() else {
            return Err(wrong(format!("has {}, not two", count(columns.len(), "column", "columns"))));
        };
        let numbers = (time.parse::<f64>(), value.parse::<f64>());
        let (Ok(time), Ok(value)) = numbers else {
            if points.is_empty() && !named && numbers.0.is_err() && numbers.1.is_err() {
                named = true;
                continue;
            }
            return Err(wrong(format!("holds no two numbers: `{line}`")));
        };
        if !(time.is_finite() && value.is_finite()) {
            return Err(wrong(format!("holds a number that is not finite: `{line}`")));
        }
        if points.last().is_some_and(|before| time <= before.0) {
            return Err(wrong(format!("goes back in time: `{line}`")));
        }
        points.push((time, value));
    }
    if points.is_empty() { Err((1, "holds no point, nor do those behind it".into())) } else { Ok(points) }
}

#[cfg(test)]
mod tests {
    use super::points_of;

    #[test]
    fn tables_are_read_and_mistakes_told_with_their_line() {
        assert_eq!(points_of("\"t\";\"f\";\n0;1\n"), Ok(vec![(0.0, 1.0)]));
        assert_eq!(points_of("t, f\n0, 1\n# then\n\n0.5, -2e3\n"), Ok(vec![(0.0, 1.0), (0.5, -2000.0)]));
        for (text, line) in
            [("0,1\n0,2", 2), ("t,f\nu,g", 2), ("0,1,2", 1), ("", 1), ("0,1\n1,x", 2), ("0,inf", 1), ("0,\"1", 1)]
        {
            assert_eq!(points_of(text).map_err(|wrong| wrong.0), Err(line), "{text:?}");
        }
    }
}
