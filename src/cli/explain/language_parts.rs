//! The meaning of a field or of a choice of the scene language, with every place that may hold it.

use crate::scene::schema::LanguagePart;

/// The endings of fields that there are for both bodies of a joint or spring: `anchor` means `anchor_a` and `anchor_b`.
const SIDES: [&str; 2] = ["_a", "_b"];

/// The texts about the fields and choices of a name, in capitals or not.
pub(super) fn told(what: &str, parts: &[LanguagePart]) -> Vec<String> {
    let is_meant = |part: &&LanguagePart| {
        let side = || SIDES.iter().any(|side| part.is_field && part.name.strip_suffix(side) == Some(what));
        part.name.eq_ignore_ascii_case(what) || side()
    };
    let mut texts = Vec::new();
    let mut others = String::new();
    for part in parts.iter().filter(is_meant) {
        let LanguagePart { name, places, told, is_field } = part;
        if !is_field {
            texts.push(format!("`{name}` is a choice of {}.\n{told}{}", listed(places), fields_of(part, parts)));
            continue;
        }
        let (sections, inner): (Vec<_>, Vec<_>) = places.iter().cloned().partition(|place| is_section(place));
        for section in sections {
            texts.push(format!("`{section}.{name}` is a field of the section `{section}`.\n{told}"));
        }
        if !inner.is_empty() {
            others.push_str(&format!("\n  {}\n    {told}", listed(&inner)));
        }
    }
    if !others.is_empty() {
        texts.push(format!("`{what}` is a field of:{others}"));
    }
    texts
}

fn is_section(place: &str) -> bool {
    !place.contains(['.', ':'])
}

fn listed(places: &[String]) -> String {
    let quoted: Vec<String> = places.iter().map(|place| format!("`{place}`")).collect();
    quoted.join(", ")
}

/// A line for each field of a choice.
fn fields_of(choice: &LanguagePart, parts: &[LanguagePart]) -> String {
    let own: Vec<String> = choice.places.iter().map(|place| format!("{place}: {}", choice.name)).collect();
    let held = parts.iter().filter(|part| part.is_field && part.places.iter().any(|place| own.contains(place)));
    held.map(|part| format!("\n  {}", part.told)).collect()
}
