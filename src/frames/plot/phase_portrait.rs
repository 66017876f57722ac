//! The channel over which each curve of a phase portrait is drawn. Names are `owner.quantity`.

use std::collections::BTreeSet;

use jostle_language::fits;

/// The channel over which `channel` is drawn. It is `x`, or with `*` in its owner the same quantity of the channel's own owner.
/// `None` if that owner does not fit.
pub fn beside(x: &str, channel: &str) -> Option<String> {
    let Some((pattern, quantity)) = x.split_once('.').filter(|(pattern, _)| pattern.contains('*')) else {
        return Some(x.to_owned());
    };
    let (owner, _) = channel.split_once('.')?;
    fits(pattern, owner).then(|| format!("{owner}.{quantity}"))
}

/// A channel that would be drawn over a quantity of another owner. Beside it stands the same quantity of the owner of `x`. A
/// reader would take both for curves over their own.
pub fn over_another<'a>(x: &str, channels: impl Iterator<Item = &'a str> + Clone) -> Option<&'a str> {
    let (owner, _) = x.split_once('.')?;
    let parts = |channel: &'a str| channel.split_once('.');
    let owned: BTreeSet<&str> =
        channels.clone().filter_map(parts).filter(|(other, _)| *other == owner).map(|(_, quantity)| quantity).collect();
    let beside_owned = |(other, quantity): (&str, &str)| other != owner && owned.contains(quantity);
    channels.into_iter().find(|channel| parts(channel).is_some_and(beside_owned))
}

/// The mistake of drawing `channel` over `x`, in words, and the remedy.
pub fn told(x: &str, channel: &str) -> (String, String) {
    let (owner, quantity) = x.split_once('.').unwrap_or(("", x));
    let message = format!("`{channel}` would be drawn over `{x}`, which is of `{owner}` and not of its own body");
    (message, format!("write `*.{quantity}`: each channel is drawn over that of its own body; or make a plot for each"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_the_owner_of_each_channel() {
        for (x, channel, expected) in [
            ("a.position.x", "b.position.y", Some("a.position.x")),
            ("*.position.x", "b.position.y", Some("b.position.x")),
            ("ball_*.spin", "ball_7.velocity.x", Some("ball_7.spin")),
            ("ball_*.spin", "peg.velocity.x", None),
            ("time", "b.position.y", Some("time")),
        ] {
            assert_eq!(beside(x, channel).as_deref(), expected, "{x} {channel}");
        }
    }

    #[test]
    fn two_bodies_over_the_place_of_one_are_found() {
        let found = |x: &str, channels: &'static [&str]| over_another(x, channels.iter().copied());
        assert_eq!(found("a.position.x", &["a.position.y", "b.position.y"]), Some("b.position.y"));
        assert_eq!(found("a.position.x", &["b.position.y", "c.position.y"]), None);
        assert_eq!(found("a.position.x", &["a.position.y", "energy.total"]), None);
        assert_eq!(found("*.position.x", &["a.position.y", "b.position.y"]), None);
        assert_eq!(found("time", &["a.position.y", "b.position.y"]), None);
    }
}
