//! Names of curves: a plot's channels share words, which each curve then omits.

/// The common words of all names, and the rest of each. `energy.kinetic` and `energy.total` share `energy`,
/// `T.position.x` and `S.position.x` share `position.x`. A single name is left as it is.
pub fn common(names: &[&str]) -> (String, Vec<String>) {
    let parts: Vec<Vec<&str>> = names.iter().map(|name| name.split('.').collect()).collect();
    let whole = || names.iter().map(|&name| name.to_owned()).collect();
    let [first, others @ ..] = parts.as_slice() else { return (String::new(), Vec::new()) };
    if others.is_empty() || others.iter().all(|other| other == first) {
        return (names[0].to_owned(), whole());
    }
    // At least one word is left of every name.
    let most = parts.iter().map(Vec::len).min().unwrap_or(1) - 1;
    let shared = |place: &dyn Fn(&Vec<&str>) -> String| others.iter().all(|other| place(other) == place(first));
    let head = (0..most).take_while(|&n| shared(&|parts| parts[n].to_owned())).count();
    let tail = (0..most - head).take_while(|&n| shared(&|parts| parts[parts.len() - 1 - n].to_owned())).count();
    let left = parts.iter().map(|parts| parts[head..parts.len() - tail].join(".")).collect();
    let words = first[..head].iter().chain(&first[first.len() - tail..]);
    (words.copied().collect::<Vec<_>>().join("."), left)
}

/// The first words that two names share, and the rest of each, which has at least one word.
pub fn headed(names: [&str; 2]) -> (String, [String; 2]) {
    let [one, other] = names.map(|name| name.split('.').collect::<Vec<_>>());
    let most = one.len().min(other.len()) - 1;
    let head = one.iter().zip(&other).take(most).take_while(|(a, b)| a == b).count();
    (one[..head].join("."), [one[head..].join("."), other[head..].join(".")])
}

/// A label with its unit in brackets, if it has one.
pub fn with_unit(label: &str, unit: &str) -> String {
    match (label, unit) {
        (label, "") => label.to_owned(),
        ("", unit) => format!("({unit})"),
        (label, unit) => format!("{label} ({unit})"),
    }
}

#[cfg(test)]
mod tests {
    use super::{common, headed};

    #[test]
    fn what_names_share_stands_once() {
        for (names, shared, left) in [
            (&["energy.kinetic", "energy.total"][..], "energy", &["kinetic", "total"][..]),
            (&["T.position.x", "S.position.x"], "position.x", &["T", "S"]),
            (&["T.position.x", "T.position.y"], "T.position", &["x", "y"]),
            (&["T.position.x", "T.velocity.x"], "T.x", &["position", "velocity"]),
            (&["T.spin", "energy.total"], "", &["T.spin", "energy.total"]),
            (&["T.spin"], "T.spin", &["T.spin"]),
            (&["height", "height"], "height", &["height", "height"]),
            (&["a", "a.b"], "", &["a", "a.b"]),
            (&[], "", &[]),
        ] {
            let (found, labels) = common(names);
            assert_eq!((found.as_str(), labels), (shared, left.iter().map(|&l| l.to_owned()).collect()), "{names:?}");
        }
    }

    #[test]
    fn two_axes_share_their_owner() {
        let (owner, left) = headed(["ball.position.y", "ball.velocity.y"]);
        assert_eq!((owner.as_str(), left), ("ball", ["position.y".to_owned(), "velocity.y".to_owned()]));
        assert_eq!(headed(["ball.spin", "energy"]).0, "");
    }
}
