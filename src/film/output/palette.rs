//! The colours of a GIF: 255 for the whole film. The flat colours of the scene stay exact. The blends at edges share
//! the rest, and sampled frames decide which blends matter most.

use std::collections::HashMap;

use jostle_frames::frame::Rgb;

/// Colours beside the transparent one.
const MOST_COLORS: usize = 255;

/// The share of palette entries for flat colours, in quarters. The rest is for blends, without which every edge would
/// be ragged.
const PINNED_QUARTERS: usize = 3;

/// How often each colour occurs.
#[derive(Debug, Default)]
pub(super) struct Histogram {
    counts: HashMap<u32, u64>,
}

impl Histogram {
    /// Counts the pixels of a picture, four bytes each.
    pub(super) fn count(&mut self, pixels: &[u8]) {
        for run in pixels.as_chunks::<4>().0.chunk_by(|a, b| a == b) {
            *self.counts.entry(number(run[0])).or_default() += run.len() as u64;
        }
    }

    /// Adds the counts of another.
    pub(super) fn merge(&mut self, other: Histogram) {
        for (color, count) in other.counts {
            *self.counts.entry(color).or_default() += count;
        }
    }

    /// All colours with their counts, in an order that depends on nothing else.
    fn sorted(self) -> Vec<(u32, u64)> {
        let mut sorted: Vec<_> = self.counts.into_iter().collect();
        sorted.sort_unstable();
        sorted
    }
}

/// The colours of a film, and after them one place for transparent pixels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Palette {
    colors: Vec<Rgb>,
    /// The colours with their places, sorted by green: the search for the nearest one begins there.
    by_green: Vec<(Rgb, u8)>,
}

impl Palette {
    /// Takes the pinned colours first, and then repeatedly the sampled colour with the worst match. A match is rated by
    /// the distance to the nearest taken colour, times the square root of the count. So large areas and rare but strong
    /// edges both get their share.
    pub(super) fn new(pinned: &[Rgb], sampled: Histogram, most: usize) -> Palette {
        let most = most.clamp(3, MOST_COLORS);
        let mut colors: Vec<Rgb> = pinned.iter().copied().take(most * PINNED_QUARTERS / 4).collect();
        let mut open: Vec<Served> = sampled.sorted().into_iter().map(|color| Served::new(color, &colors)).collect();
        while colors.len() < most {
            let worst = open.iter().max_by(|a, b| a.need().total_cmp(&b.need()).then(b.color.cmp(&a.color)));
            let Some(worst) = worst.filter(|worst| worst.error > 0) else { break };
            let color = worst.color;
            colors.push(color);
            for served in &mut open {
                served.error = served.error.min(error(served.color, color));
            }
        }
        let mut by_green: Vec<(Rgb, u8)> = colors.iter().copied().zip(0..=u8::MAX).collect();
        by_green.sort_by_key(|(color, index)| (color.1, *index));
        Palette { colors, by_green }
    }

    /// The place of transparent pixels.
    pub(super) fn transparent(&self) -> u8 {
        self.colors.len() as u8
    }

    /// The number of bits that a place takes: 2 to 8.
    pub(super) fn bits(&self) -> u32 {
        (self.colors.len() + 1).next_power_of_two().trailing_zeros().clamp(2, 8)
    }

    /// The colour table of the file, three bytes for each place.
    pub(super) fn table(&self) -> Vec<u8> {
        let mut table: Vec<u8> = self.colors.iter().flat_map(|color| [color.0, color.1, color.2]).collect();
        table.resize(3 << self.bits(), 0);
        table
    }

    /// The place of the nearest colour, the first of equals.
    fn nearest(&self, color: Rgb) -> u8 {
        let (below, above) = self.by_green.split_at(self.by_green.partition_point(|(own, _)| own.1 < color.1));
        let mut best = u32::MAX;
        let mut try_on = |&(own, index): &(Rgb, u8)| {
            best = best.min(error(color, own) << 8 | u32::from(index));
            // Further on the green alone is worse than the best so far.
            error(Rgb(0, color.1, 0), Rgb(0, own.1, 0)) <= best >> 8
        };
        // `all` stops at the first false.
        above.iter().all(&mut try_on);
        below.iter().rev().all(&mut try_on);
        best as u8
    }
}

/// How well a sampled colour is served by those taken.
struct Served {
    color: Rgb,
    weight: f32,
    error: u32,
}

impl Served {
    fn new((color, count): (u32, u64), colors: &[Rgb]) -> Served {
        let [_, red, green, blue] = color.to_be_bytes();
        let color = Rgb(red, green, blue);
        let error = colors.iter().map(|taken| error(color, *taken)).min().unwrap_or(u32::MAX >> 8);
        Served { color, weight: (count as f32).sqrt(), error }
    }

    fn need(&self) -> f32 {
        self.weight * self.error as f32
    }
}

/// The squared distance of two colours, weighted as the eye does: green most, blue least. Below two to the 24.
fn error(a: Rgb, b: Rgb) -> u32 {
    let square = |a: u8, b: u8| u32::from(a.abs_diff(b)).pow(2);
    2 * square(a.0, b.0) + 4 * square(a.1, b.1) + square(a.2, b.2)
}

fn number([red, green, blue, _]: [u8; 4]) -> u32 {
    u32::from_be_bytes([0, red, green, blue])
}

/// Pixels compared at once with the backdrop.
const BLOCK: usize = 16;

/// Slots of the memory of a [`Matcher`].
const SLOTS: usize = 1 << 16;

/// Finds the places of pixels in a palette, and remembers them: the same blends come back in every frame.
#[derive(Debug)]
pub(super) struct Matcher {
    /// Each slot holds 24 bits of colour and 8 bits of place.
    memory: Box<[u32; SLOTS]>,
}

impl Default for Matcher {
    fn default() -> Matcher {
        // White at place 255 is nowhere: the last place of a colour is 254.
        Matcher { memory: Box::new([u32::MAX; SLOTS]) }
    }
}

impl Matcher {
    /// The place of each pixel (four bytes).
    pub(super) fn match_all(&mut self, palette: &Palette, pixels: &[u8], indices: &mut [u8]) {
        let mut last = ([0; 4], 0);
        for (pixel, index) in pixels.as_chunks::<4>().0.iter().zip(indices) {
            if *pixel != last.0 {
                last = (*pixel, self.index(palette, *pixel));
            }
            *index = last.1;
        }
    }

    /// The place of each pixel, given a backdrop whose places are known: most of a frame is backdrop.
    pub(super) fn match_over(
        &mut self,
        palette: &Palette,
        pixels: &[u8],
        backdrop: (&[u8], &[u8]),
        indices: &mut [u8],
    ) {
        let known = backdrop.0.chunks(4 * BLOCK).zip(backdrop.1.chunks(BLOCK));
        for ((pixels, indices), known) in pixels.chunks(4 * BLOCK).zip(indices.chunks_mut(BLOCK)).zip(known) {
            if pixels == known.0 {
                indices.copy_from_slice(known.1);
            } else {
                self.match_all(palette, pixels, indices);
            }
        }
    }

    fn index(&mut self, palette: &Palette, pixel: [u8; 4]) -> u8 {
        let color = number(pixel);
        let slot = &mut self.memory[(color.wrapping_mul(0x9E37_79B1) >> (32 - SLOTS.trailing_zeros())) as usize];
        if *slot >> 8 != color || *slot == u32::MAX {
            *slot = color << 8 | u32::from(palette.nearest(Rgb(pixel[0], pixel[1], pixel[2])));
        }
        *slot as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey_ramp() -> Histogram {
        let mut histogram = Histogram::default();
        for level in 0..=255 {
            histogram.count(&[level, level, level, 255]);
        }
        histogram
    }

    #[test]
    fn pinned_colours_stay_exact_and_the_rest_is_near() {
        let pinned = [Rgb(1, 2, 3), Rgb(255, 255, 255), Rgb(0, 158, 115)];
        let mut histogram = grey_ramp();
        for red in 0..=255 {
            histogram.count(&[red, 0, 0, 255]);
        }
        let palette = Palette::new(&pinned, histogram, MOST_COLORS);
        assert_eq!(palette.colors.len(), MOST_COLORS);
        assert_eq!((palette.transparent(), palette.bits(), palette.table().len()), (255, 8, 768));
        for (index, color) in pinned.into_iter().enumerate() {
            assert_eq!(usize::from(palette.nearest(color)), index);
        }
        // 512 colours share 252 places: no grey is more than two levels off.
        for level in 0..=255 {
            let near = palette.colors[usize::from(palette.nearest(Rgb(level, level, level)))];
            assert!(near.0.abs_diff(level) <= 2 && near.1.abs_diff(level) <= 2 && near.2.abs_diff(level) <= 2);
        }
    }

    #[test]
    fn few_colours_make_a_small_palette() {
        let palette = Palette::new(&[Rgb(0, 0, 0), Rgb(9, 9, 9)], Histogram::default(), MOST_COLORS);
        assert_eq!((palette.transparent(), palette.bits()), (2, 2));
    }

    #[test]
    fn places_are_the_same_with_and_without_backdrop_and_memory() {
        let palette = Palette::new(&[Rgb(250, 249, 246)], grey_ramp(), MOST_COLORS);
        let backdrop: Vec<u8> = (0..1000_u32).flat_map(|index| [(index / 5) as u8, 7, 9, 255]).collect();
        let mut pixels = backdrop.clone();
        for index in (0..4000).step_by(37) {
            pixels[index] = pixels[index].wrapping_add(91);
        }
        let mut matcher = Matcher::default();
        let (mut known, mut all, mut over) = (vec![0; 1000], vec![0; 1000], vec![0; 1000]);
        matcher.match_all(&palette, &backdrop, &mut known);
        matcher.match_all(&palette, &pixels, &mut all);
        Matcher::default().match_over(&palette, &pixels, (&backdrop, &known), &mut over);
        assert_eq!(all, over);
        for (pixel, index) in pixels.chunks_exact(4).zip(all) {
            let off = |own: &Rgb| error(*own, Rgb(pixel[0], pixel[1], pixel[2]));
            // `min_by_key` gives the first of equals.
            let nearest = palette.colors.iter().enumerate().min_by_key(|(_, own)| off(own));
            assert_eq!(nearest.map(|(nearest, _)| nearest), Some(usize::from(index)));
        }
    }
}
