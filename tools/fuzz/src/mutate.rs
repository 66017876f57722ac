//! Mutants: scene number `n` of a seed is the same on every machine.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::corpus::{Corpus, Seed};
use crate::tokens::{Form, Token, closing, joined};

/// No mutant is longer, in bytes.
const LONGEST: usize = 200_000;

/// Numbers at the edges of what a number can be, and of what a scene is likely to bear.
const EXTREMES: [&str; 38] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "3",
    "0.5",
    "10",
    "16",
    "100",
    "1000",
    "100000",
    "1000000",
    "1000001",
    "8192",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "18446744073709551615",
    "18446744073709551616",
    "1e-3",
    "1e-9",
    "1e-18",
    "1e-100",
    "1e-300",
    "1e-320",
    "-1e-320",
    "1e9",
    "1e15",
    "1e18",
    "1e100",
    "1e154",
    "1e300",
    "1e308",
    "-1e308",
    "NaN",
    "inf",
    "-inf",
];

/// Texts where a quantity or a name may stand.
const TEXTS: [&str; 28] = [
    "\"\"",
    "\"*\"",
    "\"**\"",
    "\"0 s\"",
    "\"1e400 m\"",
    "\"-1 kg\"",
    "\"1 ms\"",
    "\"1e-320 m\"",
    "\"1e308 N/m\"",
    "\"3 rpm\"",
    "\"1e300 km/h\"",
    "\"NaN\"",
    "\"inf m\"",
    "\"m\"",
    "\"1 m/s/s/s/s/s\"",
    "\"1e309 deg\"",
    "\"é\"",
    "\"\\u{0}\"",
    "\"\\n\"",
    "\"default\"",
    "\"gas_1\"",
    "\"energy.kinetic\"",
    "\"T.position.x\"",
    "\"########\"",
    "\"#fff\"",
    "r#\"x\"#",
    "\"1 000 m\"",
    "\"\u{202e}abc\"",
];

/// Pieces that may stand anywhere.
const PIECES: [&str; 30] = [
    "(", ")", "[", "]", "{", "}", ",", ":", "\"", "'", "//", "/*", "*/", "None", "Some(1)", "true", "false", "()",
    "[]", "{}", "#", "\\", "\u{0}", "\u{a0}", "\u{feff}", "é", "..", "-", "r#\"", "Scene(",
];

/// Chance with what mutations ask for.
pub struct Chance(ChaCha8Rng);

impl Chance {
    /// The chance of mutant `number` of a seed.
    pub fn of(seed: u64, number: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(number);
        Self(random)
    }

    /// A whole number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.0.next_u64() % end.max(1) as u64) as usize
    }

    /// One of these.
    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// A scene to begin with: mostly a good one, so that many mutants are still good enough to run.
    fn seed<'a>(&mut self, corpus: &'a Corpus) -> &'a Seed {
        let wrong = corpus.good.is_empty() || !corpus.wrong.is_empty() && self.below(8) == 0;
        let seeds = if wrong { &corpus.wrong } else { &corpus.good };
        &seeds[self.below(seeds.len())]
    }

    /// A place for which `wanted` holds, if there is one.
    fn index(&mut self, tokens: &[Token], wanted: impl Fn(&Token) -> bool) -> Option<usize> {
        let indices: Vec<usize> = (0..tokens.len()).filter(|&index| wanted(&tokens[index])).collect();
        (!indices.is_empty()).then(|| self.pick(&indices))
    }
}

/// Mutant `number` of a seed: a scene with one to five changes.
pub fn mutant(corpus: &Corpus, seed: u64, number: u64) -> String {
    let mut chance = Chance::of(seed, number);
    let mut scene = chance.seed(corpus).clone();
    let changes = 1 + chance.below(5).min(chance.below(5));
    for _ in 0..changes {
        if scene.is_empty() {
            break;
        }
        let other = chance.seed(corpus);
        change(&mut scene, other, &mut chance);
    }
    let mut text = joined(&scene);
    if chance.below(12) == 0 {
        scramble(&mut text, &mut chance);
    }
    if text.len() > LONGEST {
        let end = (0..=LONGEST).rev().find(|&end| text.is_char_boundary(end)).unwrap_or(0);
        text.truncate(end);
    }
    text
}

/// One change. Those that leave a scene readable are the more likely ones: what stands behind the reader is to be
/// reached too.
fn change(scene: &mut Vec<Token>, other: &[Token], chance: &mut Chance) {
    match chance.below(40) {
        0..8 => replace(scene, Form::Number, chance.pick(&EXTREMES), chance),
        8..14 => scale(scene, chance),
        14..17 => replace(scene, Form::Text, chance.pick(&TEXTS), chance),
        17..19 => replace(scene, Form::Number, chance.pick(&TEXTS), chance),
        19..26 => graft(scene, other, chance),
        26..29 => double(scene, chance),
        29..31 => remove(scene, chance),
        31..33 => splice(scene, other, chance),
        33..35 => {
            let index = chance.below(scene.len());
            scene.insert(index, token(Form::Other, chance.pick(&PIECES)));
        }
        35 => {
            let index = chance.below(scene.len());
            scene.remove(index);
        }
        36 => {
            let (a, b) = (chance.below(scene.len()), chance.below(scene.len()));
            scene.swap(a, b);
        }
        37 => nest(scene, chance),
        _ => {
            if let Some(from) = chance.index(other, |token| token.form == Form::Word) {
                replace(scene, Form::Word, &other[from].text, chance);
            }
        }
    }
}

fn token(form: Form, text: &str) -> Token {
    Token { form, text: text.to_owned() }
}

fn replace(scene: &mut [Token], form: Form, by: &str, chance: &mut Chance) {
    if let Some(index) = chance.index(scene, |token| token.form == form) {
        by.clone_into(&mut scene[index].text);
    }
}

/// Makes a number larger or smaller by powers of ten, or negates it.
fn scale(scene: &mut [Token], chance: &mut Chance) {
    let Some(index) = chance.index(scene, |token| token.form == Form::Number) else { return };
    let Ok(value) = scene[index].text.parse::<f64>() else { return };
    let factor = [-1.0, 0.1, 0.5, 0.99, 1.01, 2.0, 10.0, 1e3, 1e-3, 1e6, 1e-6, 1e12, 1e-12];
    scene[index].text = format!("{}", value * chance.pick(&factor));
}

/// Gives a field the value that a field of the same name has in another scene.
fn graft(scene: &mut Vec<Token>, other: &[Token], chance: &mut Chance) {
    let Some(into) = chance.index(scene, |token| token.form == Form::Word) else { return };
    let same = |token: &Token| token.form == Form::Word && token.text == scene[into].text;
    let Some(from) = chance.index(other, same) else { return };
    let (into, from) = (value(scene, into), value(other, from));
    if let (Some(into), Some(from)) = (into, from) {
        scene.splice(into, other[from].iter().cloned());
    }
}

/// The pieces after `name:` up to the comma or bracket that ends the field.
fn value(tokens: &[Token], name: usize) -> Option<std::ops::Range<usize>> {
    let colon = (name + 1..tokens.len()).find(|&index| tokens[index].form != Form::Blank)?;
    if tokens[colon].text != ":" {
        return None;
    }
    let mut index = colon + 1;
    while index < tokens.len() {
        match tokens[index].form {
            Form::Open => index = closing(tokens, index),
            Form::Close => break,
            Form::Other if tokens[index].text == "," => break,
            _ => {}
        }
        index += 1;
    }
    Some(colon + 1..index.min(tokens.len()))
}

/// A pair of brackets with what stands in them and the name before them.
fn group(scene: &[Token], chance: &mut Chance) -> Option<std::ops::Range<usize>> {
    let open = chance.index(scene, |token| token.form == Form::Open)?;
    let begin = if open > 0 && scene[open - 1].form == Form::Word { open - 1 } else { open };
    Some(begin..closing(scene, open) + 1)
}

/// Repeats a group of brackets, now and then many times.
fn double(scene: &mut Vec<Token>, chance: &mut Chance) {
    let Some(group) = group(scene, chance) else { return };
    let mut copy = vec![token(Form::Other, ",")];
    copy.extend_from_slice(&scene[group.clone()]);
    let times = chance.pick(&[1, 1, 1, 1, 2, 5, 40]);
    let copies = copy.iter().cycle().take(copy.len() * times).cloned();
    let copies: Vec<Token> = copies.take(100_000).collect();
    scene.splice(group.end..group.end, copies);
}

/// Removes a group of brackets, and the comma after it.
fn remove(scene: &mut Vec<Token>, chance: &mut Chance) {
    let Some(mut group) = group(scene, chance) else { return };
    if scene.get(group.end).is_some_and(|token| token.text == ",") {
        group.end += 1;
    }
    scene.drain(group);
}

/// Puts some pieces of another scene over some pieces of this one.
fn splice(scene: &mut Vec<Token>, other: &[Token], chance: &mut Chance) {
    if other.is_empty() {
        return;
    }
    let (from, into) = (chance.below(other.len()), chance.below(scene.len()));
    let (many, few) = (chance.below(40), chance.below(20));
    let pieces = other[from..(from + many).min(other.len())].iter().cloned();
    scene.splice(into..(into + few).min(scene.len()), pieces);
}

/// Puts many brackets around a value or a group, or opens many and closes none.
fn nest(scene: &mut Vec<Token>, chance: &mut Chance) {
    let index = chance.below(scene.len());
    let depth = chance.pick(&[1, 2, 10, 100, 127, 128, 129, 1000, 20_000]);
    let (open, close) = chance.pick(&[("[", "]"), ("(", ")"), ("{", "}"), ("Some(", ")"), ("(a:", ")"), ("[(", ")]")]);
    if chance.below(4) > 0 {
        scene.insert(index + 1, token(Form::Close, &close.repeat(depth)));
    }
    scene.insert(index, token(Form::Open, &open.repeat(depth)));
}

/// Changes single bytes; what is no longer UTF-8 becomes the sign for it.
fn scramble(text: &mut String, chance: &mut Chance) {
    let mut bytes = std::mem::take(text).into_bytes();
    for _ in 0..1 + chance.below(8) {
        if bytes.is_empty() {
            break;
        }
        let index = chance.below(bytes.len());
        match chance.below(4) {
            0 => bytes[index] ^= 1 << chance.below(8),
            1 => bytes[index] = chance.below(256) as u8,
            2 => bytes.truncate(index),
            _ => bytes.insert(index, chance.below(256) as u8),
        }
    }
    *text = String::from_utf8_lossy(&bytes).into_owned();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tokens::tokens;

    fn corpus() -> Corpus {
        let scenes = ["Scene(format: 1, clock: (duration: 2), bodies: [(name: \"a\", at: (0, 1))])", "f([1, 2], x: 3)"];
        Corpus { good: vec![tokens(scenes[0])], wrong: vec![tokens(scenes[1])] }
    }

    #[test]
    fn the_same_number_gives_the_same_scene_on_every_machine() {
        let first: Vec<String> = (0..300).map(|number| mutant(&corpus(), 7, number)).collect();
        let again: Vec<String> = (0..300).map(|number| mutant(&corpus(), 7, number)).collect();
        assert_eq!(first, again);
        let different = first.iter().collect::<std::collections::BTreeSet<_>>().len();
        assert!(different > 200, "only {different} of 300 mutants differ");
        assert!(first.iter().all(|text| text.len() <= LONGEST));
    }

    #[test]
    fn a_field_gets_the_value_of_its_namesake() {
        let scene = tokens("(clock: (duration: [1, (2)]), x: 3)");
        let name = scene.iter().position(|token| token.text == "duration").unwrap();
        assert_eq!(joined(&scene[value(&scene, name).unwrap()]), " [1, (2)]");
        let name = scene.iter().position(|token| token.text == "x").unwrap();
        assert_eq!(joined(&scene[value(&scene, name).unwrap()]), " 3");
    }
}
