//! The smallest box that holds all changes between two pictures of palette indices.

/// The box of pixels that changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Patch {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Patch {
    /// The whole of a picture.
    pub(super) fn whole(width: usize, height: usize) -> Patch {
        Patch { left: 0, top: 0, width, height }
    }

    /// The changes from one picture to the next, both `width` wide; `None` without a change.
    pub(super) fn between(before: &[u8], after: &[u8], width: usize) -> Option<Patch> {
        let rows = || before.chunks_exact(width).zip(after.chunks_exact(width));
        let top = rows().position(|(before, after)| before != after)?;
        let bottom = rows().rposition(|(before, after)| before != after)?;
        let (mut left, mut right) = (width, 0);
        for (before, after) in rows().take(bottom + 1).skip(top) {
            let differ = |(before, after): (&u8, &u8)| before != after;
            // Only what lies outside the box so far can widen it.
            left = before[..left].iter().zip(&after[..left]).position(differ).unwrap_or(left);
            let beyond = before[right..].iter().zip(&after[right..]).rposition(differ);
            right = beyond.map_or(right, |index| right + index + 1);
        }
        Some(Patch { left, top, width: right - left, height: bottom + 1 - top })
    }

    /// Copies this box out of a picture `width` wide.
    pub(super) fn cut<'a>(&self, picture: &'a [u8], width: usize) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let Patch { left, top, width: columns, height } = *self;
        picture.chunks_exact(width).skip(top).take(height).map(move |row| &row[left..left + columns])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_patch_is_the_smallest_box_of_all_changes() {
        let before = vec![0; 70];
        assert_eq!(Patch::between(&before, &before, 10), None);
        let mut after = before.clone();
        after[23] = 1;
        assert_eq!(Patch::between(&before, &after, 10), Some(Patch { left: 3, top: 2, width: 1, height: 1 }));
        after[48] = 1;
        after[31] = 1;
        let patch = Patch::between(&before, &after, 10).expect("changes");
        assert_eq!(patch, Patch { left: 1, top: 2, width: 8, height: 3 });
        let cut: Vec<u8> = patch.cut(&after, 10).flatten().copied().collect();
        assert_eq!(cut.iter().filter(|pixel| **pixel == 1).count(), 3);
        after[0] = 1;
        after[69] = 1;
        assert_eq!(Patch::between(&before, &after, 10), Some(Patch::whole(10, 7)));
    }
}
