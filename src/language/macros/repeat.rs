//! `Repeat(count: 5, make: ..)` in place of an item of a list: on a line, a grid or a circle, or just counted.

use std::rc::Rc;

use super::emit::Context;
use super::quantity::Number;
use super::scope::{Scope, Value};
use super::{Cause, Expander, MOST_MADE, Outcome};
use crate::syntax::{Form, Id};
use crate::units::Powers;

const EXAMPLE: &str =
    "Repeat(count: 5, line: (from: (0, 1), to: (4, 1)), make: (name: \"ball_{i}\", at: (\"x\", \"y\"), ..))";
const FIELDS: [&str; 6] = ["count", "as", "line", "grid", "circle", "make"];

/// Does something with an item.
pub(super) type Act<'a> = &'a mut dyn FnMut(&mut Expander, &Context, Id) -> Outcome<()>;

/// The places of the things.
enum Layout {
    Counted,
    Line { from: [Number; 2], to: [Number; 2] },
    Grid { from: [Number; 2], step: [Number; 2] },
    Circle { center: [Number; 2], radius: Number, start: Number },
}

impl Expander {
    /// Visits the items of a list; a `Repeat` stands for all items that it makes.
    pub(super) fn each(&mut self, context: &Context, items: &[Id], act: Act) -> Outcome<()> {
        for &item in items {
            let tree = &context.file.tree;
            let name = tree.name(item, &context.file.source.text);
            if tree.node(item).form == Form::Round && name == "Repeat" {
                self.repeat(context, item, act)?;
            } else if name.eq_ignore_ascii_case("repeat") && self.field(context, item, "make").is_some() {
                let error = self.wrong(context, tree.head(item), format!("the name `{name}` means nothing here"));
                return Err(Box::new(error.with_help(format!("did you mean `Repeat`? For example: {EXAMPLE}"))));
            } else {
                act(self, context, item)?;
            }
        }
        Ok(())
    }

    fn repeat(&mut self, context: &Context, id: Id, act: Act) -> Outcome<()> {
        self.fields(context, id, &FIELDS, EXAMPLE)?;
        let tree = &context.file.tree;
        let make = self.required(context, id, "make", EXAMPLE)?;
        let items = if tree.node(make).form == Form::List { tree.children(make) } else { std::slice::from_ref(&make) };
        let (columns, rows) = self.count(context, id)?;
        let names: Rc<[String]> = self.index_names(context, id, rows.is_some())?.into();
        let layout = self.layout(context, id, rows.is_some())?;
        let head = tree.head(id);
        let head = if tree.key(id).is_empty() { head } else { tree.span(id).start..tree.span(id).start + 6 };
        for j in 0..rows.unwrap_or(1) {
            for i in 0..columns {
                self.spend(context, id, 1, 0)?;
                let cause = Cause::Repetition { names: Rc::clone(&names), i, j: rows.map(|_| j) };
                let step = self.step(context, head.clone(), cause)?;
                let mut scope = Scope::around(context.scope);
                for (name, index) in names.iter().zip([i, j]) {
                    scope.set(name, Value::Number(Number::plain(index as f64)));
                }
                let places =
                    layout.place(i, j, columns).map_err(|why| Box::new(self.wrong(context, head.clone(), why)))?;
                for (name, number) in places {
                    scope.set(name, Value::Number(number));
                }
                self.scopes.push(scope);
                let inner = Context { scope: self.scopes.len() - 1, step, ..context.clone() };
                let done = self.each(&inner, items, act);
                if !self.opening {
                    self.scopes.pop();
                }
                done?;
            }
        }
        Ok(())
    }

    /// `count: 5` or, for rows of columns, `count: (5, 3)`.
    fn count(&mut self, context: &Context, id: Id) -> Outcome<(u64, Option<u64>)> {
        let count = self.required(context, id, "count", EXAMPLE)?;
        let tree = &context.file.tree;
        match (tree.node(count).form, tree.children(count)) {
            (Form::Round, &[columns, rows]) => Ok((self.whole(context, columns)?, Some(self.whole(context, rows)?))),
            (Form::Round, _) => {
                let error = self.wrong_value(context, count, "a number, or two `(columns, rows)`");
                Err(Box::new(error.with_help(format!("for example: {EXAMPLE}"))))
            }
            _ => Ok((self.whole(context, count)?, None)),
        }
    }

    fn whole(&mut self, context: &Context, id: Id) -> Outcome<u64> {
        let number = self.number(context, id)?;
        let good = number.is_plain() && number.si >= 0.0 && number.si.fract() == 0.0 && number.si <= MOST_MADE as f64;
        if good {
            return Ok(number.si as u64);
        }
        let message = format!("expected a whole number from 0 to {MOST_MADE}, got {}", number.shown());
        let mut error = self.wrong(context, context.file.tree.span(id), message);
        error.path = context.file.tree.path(id, &context.file.source.text);
        error.label = "not a count".into();
        let rounded = if number.si.fract() == 0.0 { None } else { Some("`round(..)` makes a whole number".to_owned()) };
        error.help = rounded;
        Err(Box::new(error))
    }

    /// The names of the indices: `i`, and `j` for rows, or the names in the field `as`.
    fn index_names(&mut self, context: &Context, id: Id, rows: bool) -> Outcome<Vec<String>> {
        let Some(field) = self.field(context, id, "as") else {
            return Ok(if rows { vec!["i".into(), "j".into()] } else { vec!["i".into()] });
        };
        let tree = &context.file.tree;
        let items =
            if tree.node(field).form == Form::Round { tree.children(field) } else { std::slice::from_ref(&field) };
        let is_name = |text: &str| !text.is_empty() && super::expression::name_length(text) == text.len();
        let names: Vec<String> = items
            .iter()
            .filter_map(|&item| context.text(item))
            .map(|(text, _)| text)
            .filter(|text| is_name(text))
            .collect();
        if names.len() == items.len() && names.len() == 1 + usize::from(rows) {
            return Ok(names);
        }
        let expected = if rows { "two names `(\"i\", \"j\")`" } else { "a name such as \"k\"" };
        Err(Box::new(
            self.wrong_value(context, field, expected).with_help("it is the name of the index in expressions"),
        ))
    }

    fn layout(&mut self, context: &Context, id: Id, rows: bool) -> Outcome<Layout> {
        let named =
            ["line", "grid", "circle"].into_iter().filter_map(|name| Some((name, self.field(context, id, name)?)));
        let given: Vec<(&str, Id)> = named.collect();
        let &[(name, at)] = &given[..] else {
            return match given.get(1) {
                None => Ok(Layout::Counted),
                Some((name, at)) => {
                    let message = format!("`{name}` is one layout too many: `{}` is there already", given[0].0);
                    let error = self.wrong(context, context.file.tree.key(*at), message);
                    Err(Box::new(error.with_help("keep one of them; a `Repeat` may stand in the `make` of another")))
                }
            };
        };
        let wants_rows = name == "grid";
        if rows != wants_rows {
            let help = if rows { "write `count: 5`" } else { "a grid has columns and rows: write `count: (5, 3)`" };
            let count = self.required(context, id, "count", EXAMPLE)?;
            let error =
                self.wrong_value(context, count, if rows { "one number" } else { "two numbers `(columns, rows)`" });
            return Err(Box::new(error.with_help(help)));
        }
        let (fields, example): (&[&str], &str) = match name {
            "line" => (&["from", "to"], "line: (from: (0, 1), to: (4, 1))"),
            "grid" => (&["from", "step"], "grid: (from: (0, 0), step: (0.5, 0.5))"),
            _ => (&["center", "radius", "start"], "circle: (center: (0, 0), radius: 2, start: \"90 deg\")"),
        };
        self.fields(context, at, fields, example)?;
        let first = self.required(context, at, fields[0], example)?;
        let second = self.required(context, at, fields[1], example)?;
        let first = self.pair(context, first)?;
        Ok(match name {
            "line" => Layout::Line { from: first, to: self.pair(context, second)? },
            "grid" => Layout::Grid { from: first, step: self.pair(context, second)? },
            _ => {
                let radius = self.number(context, second)?;
                let start = match self.field(context, at, "start") {
                    Some(start) => self.number(context, start)?,
                    None => Number::default(),
                };
                Layout::Circle { center: first, radius, start }
            }
        })
    }

    fn pair(&mut self, context: &Context, id: Id) -> Outcome<[Number; 2]> {
        let tree = &context.file.tree;
        match (tree.node(id).form, tree.children(id)) {
            (Form::Round, &[x, y]) if tree.key(x).is_empty() => {
                Ok([self.number(context, x)?, self.number(context, y)?])
            }
            _ => Err(Box::new(self.wrong_value(context, id, "two values `(x, y)`"))),
        }
    }
}

impl Layout {
    /// The values of `x`, `y` and on a circle `angle` at one place.
    fn place(&self, i: u64, j: u64, count: u64) -> Result<Vec<(&'static str, Number)>, String> {
        let plus = |a: Number, b: Number| {
            Ok::<_, String>(Number::new(a.si + b.si, a.common(b, "add").map_err(|why| why.message)?))
        };
        let scaled = |a: Number, share: f64| Number { si: a.si * share, ..a };
        let minus = |a: Number, b: Number| plus(a, scaled(b, -1.0));
        match *self {
            Self::Counted => Ok(Vec::new()),
            Self::Line { from, to } => {
                let along = |from: Number, to: Number| {
                    let whole = minus(to, from)?;
                    // A single thing on a line stands at the beginning of the line.
                    let si = whole.si * i as f64 / count.saturating_sub(1).max(1) as f64;
                    plus(from, Number { si, ..whole })
                };
                Ok(vec![("x", along(from[0], to[0])?), ("y", along(from[1], to[1])?)])
            }
            Self::Grid { from, step } => {
                let x = plus(from[0], scaled(step[0], i as f64))?;
                Ok(vec![("x", x), ("y", plus(from[1], scaled(step[1], j as f64))?)])
            }
            Self::Circle { center, radius, start } => {
                let radian = Powers { radian: 1, ..Powers::default() };
                if !start.is_plain() && start.powers != radian {
                    return Err(format!("`start` must be an angle, got {}", start.kind()));
                }
                let angle = start.si + std::f64::consts::TAU * i as f64 / count as f64;
                let (sine, cosine) = libm::sincos(angle);
                let x = plus(center[0], scaled(radius, cosine))?;
                let y = plus(center[1], scaled(radius, sine))?;
                Ok(vec![("x", x), ("y", y), ("angle", Number::plain(angle))])
            }
        }
    }
}
