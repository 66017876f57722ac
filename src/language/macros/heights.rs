//! `heights` from a file or a function, replaced by the list of their points. Examples: `heights: (file:
//! "ground.csv")`, `heights: (of: "0.1 * sin(3 * x)", from: -10, to: 10, pieces: 200)`.

use std::fmt::Write;

use super::emit::{Context, WORK, WORK_OF_TEXT};
use super::expansion::Buffer;
use super::quantity::Number;
use super::scope::{Scope, Value};
use super::table_file::{Columns, Words};
use super::{Expander, MOST_WORK, Outcome};
use crate::syntax::{Form, Id};
use crate::{count, exact};

/// The field that holds them.
pub(super) const FIELD: &str = "heights";
const OF_FILE: &str =
    "heights: (file: \"ground.csv\"), or with names of columns (file: \"ground.csv\", x: \"x\", column: \"height\")";
const OF_FUNCTION: &str = "heights: (of: \"0.1 * sin(3 * x)\", from: -10, to: 10, pieces: 200)";
const MOST_PIECES: f64 = 100_000.0;
const TABLE: Words = Words {
    line: "an x and a height in metres, such as `0.5, 2`",
    back: "does not lie to the right of the point before it",
    written_out: "heights: [(0, 0), (1, 0.1)]",
};

impl Expander {
    /// Whether a value is one that is made here.
    pub(super) fn is_heights(context: &Context, id: Id, key: &str) -> bool {
        let tree = &context.file.tree;
        key == FIELD && tree.node(id).form == Form::Round && tree.name(id, &context.file.source.text).is_empty()
    }

    /// Writes the points of a file or a function.
    pub(super) fn heights(&mut self, context: &Context, out: &mut Buffer, id: Id) -> Outcome<()> {
        let points = match self.field(context, id, "of") {
            Some(of) => self.points_of_function(context, id, of)?,
            None => self.points_of_table(context, id)?,
        };
        let mut text = String::from("[");
        for (x, height) in &points {
            // Writing to a text cannot fail.
            let _ = write!(text, "({x:?}, {height:?}),");
        }
        text.push(']');
        self.spend(context, id, 0, WORK * points.len() + text.len())?;
        out.made(&text, context.file.number, context.file.tree.head(id), context.step);
        Ok(())
    }

    fn points_of_table(&mut self, context: &Context, id: Id) -> Outcome<Vec<(f64, f64)>> {
        self.fields(context, id, &["file", "x", "column"], OF_FILE)?;
        let file = self.required(context, id, "file", OF_FILE)?;
        let name = self.quoted_text(context, file, "a file name in quotes", OF_FILE)?;
        let mut column = |field: &str| {
            let id = self.field(context, id, field);
            let text = id.map(|id| self.quoted_text(context, id, "the name of a column in quotes", OF_FILE));
            text.transpose()
        };
        let columns = match (column("x")?, column("column")?) {
            (None, None) => None,
            (time, Some(value)) => Some(Columns { time, value }),
            (Some(_), None) => return self.required(context, id, "column", OF_FILE).map(|_| Vec::new()),
        };
        let points = self.points_of_file(context, file, &name, columns.as_ref(), &TABLE)?;
        self.notes.push(format!("{name}: a ground of {}", count(points.len(), "point", "points")));
        Ok(points)
    }

    fn points_of_function(&mut self, context: &Context, id: Id, of: Id) -> Outcome<Vec<(f64, f64)>> {
        self.fields(context, id, &["of", "from", "to", "pieces"], OF_FUNCTION)?;
        let mut value = |field: &str| {
            let id = self.required(context, id, field, OF_FUNCTION)?;
            Ok::<_, Box<crate::error::SceneError>>((id, self.number(context, id)?))
        };
        let ((_, from), (to_id, to), (pieces_id, pieces)) = (value("from")?, value("to")?, value("pieces")?);
        if !(pieces.is_plain() && pieces.si.fract() == 0.0 && (1.0..=MOST_PIECES).contains(&pieces.si)) {
            let error = self.wrong_value(context, pieces_id, &format!("a whole number from 1 to {MOST_PIECES}"));
            return Err(Box::new(error.with_help(format!("for example: {OF_FUNCTION}"))));
        }
        if from.si >= to.si {
            let error =
                self.wrong_value(context, to_id, &format!("a place to the right of `from`, {} m", exact(from.si)));
            return Err(Box::new(error.with_help("a ground goes from left to right")));
        }
        self.foresee(context, pieces_id, of, pieces.si as usize)?;
        let mut points = Vec::new();
        for index in 0..=pieces.si as u32 {
            let share = f64::from(index) / pieces.si;
            let x = Number { si: from.si * (1.0 - share) + to.si * share, ..from };
            let mut scope = Scope::around(context.scope);
            scope.set("x", Value::Number(x));
            self.scopes.push(scope);
            let inner = Context { scope: self.scopes.len() - 1, ..context.clone() };
            let height = self.number(&inner, of);
            if !self.opening {
                self.scopes.pop();
            }
            points.push((x.si, height?.si));
        }
        Ok(points)
    }

    /// Counts the work of a function before it is done.
    fn foresee(&mut self, context: &Context, pieces_id: Id, of: Id, pieces: usize) -> Outcome<()> {
        let length = context.file.tree.span(of).len();
        let one = WORK + WORK_OF_TEXT * length;
        let most = (MOST_WORK.saturating_sub(self.work) / one).saturating_sub(1);
        if pieces > most {
            let span = context.file.tree.span(pieces_id);
            let message = format!("{pieces} pieces of a function of {length} bytes take too long: there can be {most}");
            let help = "take fewer pieces, a shorter function, or a table: heights: (file: \"ground.csv\")";
            return Err(Box::new(self.wrong(context, span, message).with_help(help)));
        }
        self.spend(context, of, 0, one * (pieces + 1))
    }
}
