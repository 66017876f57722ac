//! Tables in files, read and replaced by `Piecewise([..])` with their points. Examples: `course: Csv("drive.csv")`,
//! `target: Csv(file: "arm.csv", column: "angle")`.

use std::borrow::Cow;
use std::fmt::Write;

use super::door::{Door, FileMistake, FileRequest};
use super::emit::{Context, WORK};
use super::expansion::Buffer;
use super::{Expander, Outcome};
use crate::syntax::{Form, Id};
use crate::{cells, count, drop_empty_ends, separator, suggest};

/// The leading name of a table in a file, and the fields that may hold one.
pub(super) const NAME: &str = "Csv";
pub(super) const FIELDS: [&str; 3] = ["course", "target", "force"];
const EXAMPLE: &str = "for example: course: Csv(\"drive.csv\")";
const EXAMPLE_OF_COLUMNS: &str = "Csv(file: \"arm.csv\", time: \"t\", column: \"angle\")";
const TABLE: FileRequest = FileRequest {
    most: 16 << 20,
    noun: "a table of numbers, one line each",
    smaller: "keep fewer points: between them the course is linear",
};

/// The columns that a scene asks for by name.
pub(super) struct Columns {
    /// Default: the first one.
    pub(super) time: Option<String>,
    pub(super) value: String,
}

/// The meaning of the numbers of a table, in words.
pub(super) struct Words {
    /// The content of a line without names of columns, with an example.
    pub(super) line: &'static str,
    /// The mistake if the first numbers do not ascend.
    pub(super) back: &'static str,
    /// The text that can replace a file.
    pub(super) written_out: &'static str,
}

const COURSE: Words = Words {
    line: "a time in seconds and a value, such as `0.5, 2`",
    back: "goes back in time",
    written_out: "Piecewise([(0, 1), (2, 0)])",
};

impl Expander {
    /// Writes the points of the file that a `Csv(..)` names.
    pub(super) fn table(&mut self, context: &Context, out: &mut Buffer, id: Id) -> Outcome<()> {
        let tree = &context.file.tree;
        let (child, columns) = match tree.children(id) {
            [child, ..] if !tree.key(*child).is_empty() => {
                self.fields(context, id, &["file", "column", "time"], EXAMPLE_OF_COLUMNS)?;
                let child = self.required(context, id, "file", EXAMPLE_OF_COLUMNS)?;
                let value = self.required(context, id, "column", EXAMPLE_OF_COLUMNS)?;
                let value = self.quoted_text(context, value, "the name of a column in quotes", EXAMPLE_OF_COLUMNS)?;
                let time = self.field(context, id, "time");
                let time = time
                    .map(|time| self.quoted_text(context, time, "the name of a column in quotes", EXAMPLE_OF_COLUMNS));
                (child, Some(Columns { time: time.transpose()?, value }))
            }
            [child] => (*child, None),
            _ => return Err(Box::new(self.wrong_value(context, id, "one file in `Csv(..)`").with_help(EXAMPLE))),
        };
        let name = self.quoted_text(context, child, "a file name in quotes", EXAMPLE)?;
        let points = self.points_of_file(context, child, &name, columns.as_ref(), &COURSE)?;
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

    /// The points of the file with this name; `id` is its value in the scene.
    pub(super) fn points_of_file(
        &self,
        context: &Context,
        id: Id,
        name: &str,
        columns: Option<&Columns>,
        words: &Words,
    ) -> Outcome<Vec<(f64, f64)>> {
        read_points(&self.door, context, name, columns, words).map_err(|(message, help)| {
            let mut error = self.wrong(context, context.file.tree.span(id), message);
            error.path = context.file.tree.path(id, &context.file.source.text);
            error.label = "this value".into();
            Box::new(error.with_help(help))
        })
    }

    /// A text in quotes, with the expressions in braces evaluated.
    pub(super) fn quoted_text(&mut self, context: &Context, id: Id, expected: &str, example: &str) -> Outcome<String> {
        let is_text = context.file.tree.node(id).form == Form::Text;
        let Some((text, shift)) = context.text(id).filter(|_| is_text) else {
            return Err(Box::new(self.wrong_value(context, id, expected).with_help(example)));
        };
        self.filled(context, id, &text, shift).map(|filled| filled.text)
    }
}

fn read_points(
    door: &Door,
    context: &Context,
    name: &str,
    columns: Option<&Columns>,
    words: &Words,
) -> Result<Vec<(f64, f64)>, FileMistake> {
    let Some(folder) = &context.file.source.folder else {
        let message = "this scene is in no file, so no table can be found from it".to_owned();
        return Err((message, format!("save it as a file, or write the points out: `{}`", words.written_out)));
    };
    let bytes = TABLE.read(door, &folder.join(name), name)?;
    let text = String::from_utf8(bytes).map_err(|error| {
        (format!("cannot read `{name}` as text: {error}"), "it has to be a table of numbers, one line each".to_owned())
    })?;
    points_of(&text, columns, words.back).map_err(|Fault { line, why, help }| {
        let usual = match columns {
            None => format!("each line holds {}; the first may hold names instead", words.line),
            Some(_) => "the first line names the columns; each other line holds a number for each of them".to_owned(),
        };
        (format!("line {line} of `{name}` {why}"), help.unwrap_or(usual))
    })
}

/// The mistake in a table: its line, the reason, and a remedy unless it is the usual one.
#[derive(Debug, PartialEq)]
struct Fault {
    line: usize,
    why: String,
    help: Option<String>,
}

/// How the lines of a table are read.
struct Layout {
    separator: char,
    /// The number of columns, and which of them hold the time and the value.
    count: usize,
    indices: [usize; 2],
}

impl Layout {
    /// That of a table whose first line is one of names.
    fn named(names: &[Cow<str>], separator: char, columns: &Columns) -> Result<Self, (String, Option<String>)> {
        // Tables that runs write have units behind the names: `hip.angle [rad]`.
        let plain = |cell: &str| cell.split(" [").next().unwrap_or_default().to_owned();
        let index = |wanted: &str| {
            let mut found = (0..names.len()).filter(|index| names[*index] == wanted || plain(&names[*index]) == wanted);
            match (found.next(), found.next()) {
                (Some(index), None) => Ok(index),
                (Some(_), Some(_)) => Err((format!("names the column `{wanted}` twice"), None)),
                (None, _) => {
                    let known = names.iter().map(|name| &**name);
                    Err((format!("names no column `{wanted}`"), Some(suggest::among(wanted, known, "columns", '`'))))
                }
            }
        };
        let time = columns.time.as_ref().map_or(Ok(0), |time| index(time))?;
        Ok(Self { separator, count: names.len(), indices: [time, index(&columns.value)?] })
    }
}

/// The points of a table, or its mistake.
fn points_of(text: &str, columns: Option<&Columns>, back: &str) -> Result<Vec<(f64, f64)>, Fault> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    let mut layout: Option<Layout> = None;
    let mut named = false;
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let wrong = |why: String| Fault { line: index + 1, why, help: None };
        let separator = layout.as_ref().map_or_else(|| separator(line), |layout| layout.separator);
        let Some(mut found) = cells(line, separator) else {
            return Err(wrong("has a quote that is not closed".into()));
        };
        drop_empty_ends(&mut found, layout.as_ref().map_or(2, |layout| layout.count));
        if let (Some(columns), None) = (columns, &layout) {
            let named = Layout::named(&found, separator, columns);
            layout = Some(named.map_err(|(why, help)| Fault { line: index + 1, why, help })?);
            continue;
        }
        let (count_of, [time, value]) = layout.as_ref().map_or((2, [0, 1]), |layout| (layout.count, layout.indices));
        if found.len() != count_of {
            let wanted = if count_of == 2 { "two".to_owned() } else { count_of.to_string() };
            return Err(wrong(format!("has {}, not {wanted}", count(found.len(), "column", "columns"))));
        }
        let numbers = (found[time].parse::<f64>(), found[value].parse::<f64>());
        let (Ok(time), Ok(value)) = numbers else {
            if layout.is_none() && points.is_empty() && !named && numbers.0.is_err() && numbers.1.is_err() {
                named = true;
                continue;
            }
            return Err(wrong(format!("holds no two numbers: `{line}`")));
        };
        if !(time.is_finite() && value.is_finite()) {
            return Err(wrong(format!("holds a number that is NaN or infinite: `{line}`")));
        }
        if points.last().is_some_and(|before| time <= before.0) {
            return Err(wrong(format!("{back}: `{line}`")));
        }
        points.push((time, value));
    }
    let none = || Fault { line: 1, why: "holds no point, and all lines after it hold none".into(), help: None };
    if points.is_empty() { Err(none()) } else { Ok(points) }
}

#[cfg(test)]
mod tests {
    use super::{COURSE, Columns};

    fn points_of(text: &str, columns: Option<&Columns>) -> Result<Vec<(f64, f64)>, super::Fault> {
        super::points_of(text, columns, COURSE.back)
    }

    #[test]
    fn tables_are_read_and_mistakes_told_with_their_line() {
        assert_eq!(points_of("\"t\";\"f\";\n0;1\n", None), Ok(vec![(0.0, 1.0)]));
        assert_eq!(points_of("t, f\n0, 1\n# then\n\n0.5, -2e3\n", None), Ok(vec![(0.0, 1.0), (0.5, -2000.0)]));
        for (text, line) in
            [("0,1\n0,2", 2), ("t,f\nu,g", 2), ("0,1,2", 1), ("", 1), ("0,1\n1,x", 2), ("0,inf", 1), ("0,\"1", 1)]
        {
            assert_eq!(points_of(text, None).map_err(|wrong| wrong.line), Err(line), "{text:?}");
        }
    }

    #[test]
    fn columns_are_found_by_name_with_or_without_their_unit() {
        let columns = |time: Option<&str>| Columns { time: time.map(str::to_owned), value: "hip.angle".to_owned() };
        let text = "# a run\ntime [s],hip.rate [rad/s],hip.angle [rad],t\n0,5,1,-1\n2,5,3,-0.5\n";
        assert_eq!(points_of(text, Some(&columns(None))), Ok(vec![(0.0, 1.0), (2.0, 3.0)]));
        assert_eq!(points_of(text, Some(&columns(Some("t")))), Ok(vec![(-1.0, 1.0), (-0.5, 3.0)]));
        for (text, line, why) in [
            ("t,hip.angel\n0,1", 1, "names no column `hip.angle`"),
            ("t,hip.angle,hip.angle [rad]\n0,1,2", 1, "names the column `hip.angle` twice"),
            ("t,x,hip.angle\n0,1", 2, "has 2 columns, not 3"),
            ("t,x,hip.angle\n0,1,2\n-1,1,2", 3, "goes back in time: `-1,1,2`"),
            ("t,x,hip.angle\n0,1,NaN", 2, "holds a number that is NaN or infinite: `0,1,NaN`"),
            ("t,hip.angle\na,b", 2, "holds no two numbers: `a,b`"),
        ] {
            let fault = points_of(text, Some(&columns(None))).unwrap_err();
            assert_eq!((fault.line, fault.why.as_str()), (line, why), "{text:?}");
        }
        let fault = points_of("t,hip.angel\n0,1", Some(&columns(None))).unwrap_err();
        assert!(fault.help.unwrap().starts_with("did you mean `hip.angel`?"));
    }
}
