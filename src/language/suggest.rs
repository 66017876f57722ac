//! The known name that is nearest to an unknown one.

/// Longer names, in letters, are not compared: that takes time and memory as the product of both lengths.
const LONGEST: usize = 200;

/// The known name that is most like the given one, if it is near enough to be meant.
pub fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let lower = name.to_lowercase();
    let length = name.chars().count();
    if length > LONGEST {
        return None;
    }
    let allowed = 1 + length / 4;
    known
        .map(|other| {
            // Names are at least as far apart as their lengths.
            let apart = other.chars().take(2 * LONGEST).count().abs_diff(length);
            let near = apart <= allowed;
            let distance = if near { strsim::damerau_levenshtein(&lower, &other.to_lowercase()) } else { apart };
            // A word that begins like the known one (or the known one like it) is a likely abbreviation.
            let short = lower.len().min(other.len()) >= 3;
            let begins =
                short && (other.to_lowercase().starts_with(&lower) || lower.starts_with(&other.to_lowercase()));
            // Things from templates and files are known by the last part of their names.
            let part =
                name.len() < other.len() && other.ends_with(name) && other[..other.len() - name.len()].ends_with('/');
            let distance = if begins { distance.min(allowed) } else { distance };
            (if part { 0 } else { distance }, other)
        })
        .filter(|&(distance, _)| distance <= allowed)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, other)| other)
}

/// Help for an unknown name: the nearest known name, and the list of all names if it is short. `quote` surrounds the
/// names.
pub fn among<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone, plural: &str, quote: char) -> String {
    const LISTED: usize = 24;
    listed(name, known, plural, quote, LISTED)
}

/// The same with the list of all names, however long.
pub fn among_all<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone, plural: &str, quote: char) -> String {
    listed(name, known, plural, quote, usize::MAX)
}

fn listed<'a>(
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
    plural: &str,
    quote: char,
    most: usize,
) -> String {
    let near = nearest(name, known.clone()).map(|near| format!("did you mean {quote}{near}{quote}? "));
    let mut list: Vec<String> = known.clone().take(most).map(|name| format!("{quote}{name}{quote}")).collect();
    let more = known.count().saturating_sub(most);
    if more > 0 {
        list.push(format!("and {more} more"));
    }
    let known =
        if list.is_empty() { format!("there are no {plural}") } else { format!("{plural}: {}", list.join(", ")) };
    near.unwrap_or_default() + &known
}

/// The plural of the name of a list of words: `color`, `quantity`.
pub fn plural(list: &str) -> String {
    list.strip_suffix('y').map_or_else(|| format!("{list}s"), |stem| format!("{stem}ies"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_found_and_strangers_are_not() {
        let known = || ["gravity", "forces", "film", "bodies"].into_iter();
        assert_eq!(nearest("gravty", known()), Some("gravity"));
        assert_eq!(nearest("Force", known()), Some("forces"));
        assert_eq!(nearest("grav", known()), Some("gravity"));
        assert_eq!(nearest("zebra", known()), None);
        assert_eq!(nearest("b_0", ["c_0", "s_0/b_0", "s_0/b_01"].into_iter()), Some("s_0/b_0"));
        assert_eq!(["color", "quantity"].map(plural), ["colors", "quantities"]);
        assert_eq!(
            among("flim", known(), "sections", '`'),
            "did you mean `film`? sections: `gravity`, `forces`, `film`, `bodies`"
        );
    }
}
