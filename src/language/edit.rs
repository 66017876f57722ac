//! Replaces one value in the text of a scene, by the path of that value.

use super::lexer::{lex, skip_blank};
use super::source::Source;
use super::suggest;
use super::syntax::{Form, Id, Step, Tree};

impl Source {
    /// The scene's own parameters (`params`), in the order of the file.
    pub fn params(&self) -> Vec<String> {
        let tree = lex(&self.text).tree;
        let Ok(params) = tree.trace("params", &self.text) else { return Vec::new() };
        let names = tree.children(params).iter().map(|&id| self.text[tree.key(id)].trim_matches('"').to_owned());
        names.collect()
    }

    /// The same scene with another value at a path. A path is `clock.tick`, `gravity[1]`, `fill[0].seed`,
    /// `bodies.ball.spin` (by the name of an item) or `materials.rock.friction`. A field that is absent is added to its
    /// bracket. `value` is a number, a bracket, a word such as `VelocityVerlet`, or a text, which gets its quotes.
    ///
    /// # Errors
    /// The message names the mistake in the path, and how far the path leads.
    pub fn with_value(&self, path: &str, value: &str) -> Result<Self, String> {
        let found = lex(&self.text);
        if let Some(fault) = found.fault {
            return Err(fault.message);
        }
        let (tree, text) = (&found.tree, &self.text);
        let (span, written) = match tree.trace(path, text) {
            Ok(0) => return Err("a path is missing, such as `clock.tick`".to_owned()),
            Ok(node) => (tree.span(node), as_written(value, Some((tree, node)), path, text)?),
            Err((parent, steps)) => match (&steps[..], tree.node(parent).form) {
                (&[Step::Field(field)], Form::Round) if takes_fields(tree, parent) => {
                    let open = tree.span(parent).start + tree.name(parent, text).len();
                    let open = skip_blank(text, open).unwrap_or(open) + 1;
                    let comma = if tree.children(parent).is_empty() { "" } else { ", " };
                    (open..open, format!("{field}: {}{comma}", as_written(value, None, path, text)?))
                }
                _ => return Err(nowhere(tree, parent, &steps, text)),
            },
        };
        let mut edited = self.clone();
        edited.text.replace_range(span, &written);
        Ok(edited)
    }
}

fn takes_fields(tree: &Tree, id: Id) -> bool {
    tree.children(id).iter().all(|&child| !tree.key(child).is_empty())
}

/// The value as the text needs it in place of the old one.
fn as_written(value: &str, there: Option<(&Tree, Id)>, path: &str, text: &str) -> Result<String, String> {
    let is_number = value.parse::<f64>().is_ok_and(f64::is_finite);
    let bracket = value.starts_with(['(', '[', '{', '"']);
    let form = there.map(|(tree, id)| tree.node(id).form);
    if let Some((tree, id)) = there
        && matches!(form, Some(Form::Round | Form::List | Form::Braces))
        && tree.name(id, text).is_empty()
        && !bracket
    {
        let inside = tree.children(id).last().copied();
        let example = inside.map_or_else(String::new, |inside| {
            let key = &text[tree.key(inside)];
            let step = if key.is_empty() {
                format!("[{}]", tree.node(inside).index)
            } else {
                format!(".{}", key.trim_matches('"'))
            };
            format!(", such as `{path}{step}`")
        });
        return Err(format!("`{path}` is {}: say which part of it{example}", tree.describe(id, text)));
    }
    let word = value.starts_with(|first: char| first.is_ascii_uppercase()) || ["true", "false"].contains(&value);
    if is_number || bracket || word && form != Some(Form::Text) {
        return Ok(value.to_owned());
    }
    Ok(format!("\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\"")))
}

/// The reason for which a path leads nowhere.
fn nowhere(tree: &Tree, parent: Id, steps: &[Step], text: &str) -> String {
    let path = tree.path(parent, text);
    let place = if path.is_empty() { "the scene".to_owned() } else { format!("`{path}`") };
    match steps.first() {
        Some(Step::Index(index)) => {
            let count = tree.children(parent).len();
            format!("{place} has no [{index}]: it has {count} value{}", if count == 1 { "" } else { "s" })
        }
        Some(Step::Field(name) | Step::Key(name)) => {
            let called = |&child: &Id| {
                let own = tree.children(child).iter().find(|&&field| &text[tree.key(field)] == "name");
                let key = own.map_or_else(|| tree.key(child), |&own| tree.span(own));
                text[key].trim_matches('"')
            };
            let list = tree.node(parent).form == Form::List;
            let fields = tree.children(parent).iter();
            let known: Vec<&str> = if list {
                fields.map(called).collect()
            } else {
                fields.map(|&field| text[tree.key(field)].trim_matches('"')).collect()
            };
            let known = known.into_iter().filter(|known| !known.is_empty()).collect::<Vec<_>>();
            let what = if list { "names" } else { "fields" };
            format!("{place} has no `{name}`; {}", suggest::among(name, known.into_iter(), what, '`'))
        }
        None => format!("{place} leads nowhere"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "Scene(clock: (duration: 1), gravity: (0, -9.81), empty: (),
        materials: { \"rock\": (friction: 0.5) },
        bodies: [(name: \"ball\", material: \"L\", atoms: Disc(radius: \"2 cm\"))], fill: [(seed: 7)])";

    fn edited(path: &str, value: &str) -> Result<String, String> {
        Source::new("a.ron", SCENE).with_value(path, value).map(|source| source.text)
    }

    #[test]
    fn values_are_found_by_place_name_and_key() {
        for (path, value, from, to) in [
            ("gravity[1]", "-3", "-9.81", "-3"),
            ("gravity", "(1, 2)", "(0, -9.81)", "(1, 2)"),
            ("materials.rock.friction", "0.1", "0.5", "0.1"),
            ("materials[\"rock\"].friction", "0.1", "0.5", "0.1"),
            ("bodies.ball.atoms.radius", "3 cm", "\"2 cm\"", "\"3 cm\""),
            ("bodies[0].atoms.radius", "0.03", "\"2 cm\"", "0.03"),
            ("bodies.ball.material", "T", "\"L\"", "\"T\""),
            ("bodies.ball.atoms", "Disc(radius: 1)", "Disc(radius: \"2 cm\")", "Disc(radius: 1)"),
            ("fill[0].seed", "8", "7", "8"),
        ] {
            assert_eq!(edited(path, value), Ok(SCENE.replace(from, to)), "{path}");
        }
    }

    #[test]
    fn fields_that_are_not_there_are_added() {
        for (path, value, from, to) in [
            ("clock.tick", "1 ms", "(duration", "(tick: \"1 ms\", duration"),
            ("clock.method", "VelocityVerlet", "(duration", "(method: VelocityVerlet, duration"),
            ("empty.a", "1", "()", "(a: 1)"),
            ("bodies.ball.collides", "false", "(name", "(collides: false, name"),
            ("film", "(fps: 5)", "Scene(", "Scene(film: (fps: 5), "),
        ] {
            assert_eq!(edited(path, value), Ok(SCENE.replace(from, to)), "{path}");
        }
    }

    #[test]
    fn paths_that_lead_nowhere_say_how_far_they_lead() {
        for (path, message) in [
            ("gravity", "`gravity` is a round bracket with 2 values: say which part of it, such as `gravity[1]`"),
            ("gravity[2]", "`gravity` has no [2]: it has 2 values"),
            ("bodies.bal.spin", "`bodies` has no `bal`; did you mean `ball`? names: `ball`"),
            ("materials.rok.friction", "`materials` has no `rok`; did you mean `rock`? fields: `rock`"),
            ("", "a path is missing, such as `clock.tick`"),
        ] {
            assert_eq!(edited(path, "1"), Err(message.to_owned()), "{path}");
        }
    }
}
