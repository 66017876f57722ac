//! The pixels of a picture that belong to its silhouette.

use std::io::Cursor;

use image::{ImageFormat, ImageReader, Limits};

/// The largest picture, in pixels a side.
const LARGEST: u32 = 4096;
/// The longer side of the grid has at least this many pixels, and at most twice as many.
const SIDE: usize = 256;

/// A silhouette on a grid without margins; row 0 is the lowest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Mask {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) inside: Vec<bool>,
}

impl Mask {
    /// Reads a PNG picture.
    ///
    /// # Errors
    /// The mistake, and the remedy.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, (String, &'static str)> {
        if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
            return Err((
                "is not a PNG picture".into(),
                "save it as PNG; the name of a file alone does not make it one",
            ));
        }
        let mut limits = Limits::default();
        limits.max_image_width = Some(LARGEST);
        limits.max_image_height = Some(LARGEST);
        limits.max_alloc = Some(256 << 20);
        let mut reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
        reader.limits(limits);
        let picture = match reader.decode() {
            Ok(picture) => picture.into_luma_alpha8(),
            Err(image::ImageError::Limits(_)) => {
                let message = format!("is larger than {LARGEST} x {LARGEST} pixels");
                return Err((message, "make it smaller: 400 pixels a side are enough"));
            }
            Err(error) => return Err((format!("cannot be read: {error}"), "save it anew as PNG")),
        };
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let transparent = picture.pixels().any(|pixel| pixel.0[1] < 255);
        let ink: Vec<u8> =
            picture.pixels().map(|pixel| if transparent { pixel.0[1] } else { 255 - pixel.0[0] }).collect();
        Self::of_ink(&ink, width, height).ok_or_else(|| {
            let found = if transparent { "nothing in it is half opaque" } else { "nothing in it is darker than grey" };
            (
                format!("has no silhouette: {found}"),
                "opaque parts are the silhouette; in a picture without transparency, dark parts are",
            )
        })
    }

    /// The silhouette of all pixels with at least half the ink, rows from the top.
    fn of_ink(ink: &[u8], width: usize, height: usize) -> Option<Self> {
        let longer = width.max(height);
        let (up, down) = (SIDE.div_ceil(longer), longer.div_ceil(2 * SIDE));
        let (columns, rows) = (width.div_ceil(down), height.div_ceil(down));
        let mut dark = vec![false; columns * rows];
        for row in 0..rows {
            for column in 0..columns {
                let ys = row * down..((row + 1) * down).min(height);
                let xs = column * down..((column + 1) * down).min(width);
                let sum: u64 = ys.flat_map(|y| xs.clone().map(move |x| u64::from(ink[y * width + x]))).sum();
                dark[row * columns + column] = 2 * sum > 255 * (down * down) as u64;
            }
        }
        let rows_used: Vec<usize> = (0..rows).filter(|row| (0..columns).any(|c| dark[row * columns + c])).collect();
        let columns_used: Vec<usize> = (0..columns).filter(|c| (0..rows).any(|row| dark[row * columns + c])).collect();
        let (&top, &bottom) = (rows_used.first()?, rows_used.last()?);
        let (&left, &right) = (columns_used.first()?, columns_used.last()?);
        let mut mask = Self { columns: (right - left + 1) * up, rows: (bottom - top + 1) * up, inside: Vec::new() };
        for row in 0..mask.rows {
            let above = (bottom - row / up) * columns;
            mask.inside.extend((0..mask.columns).map(|column| dark[above + left + column / up]));
        }
        Some(mask)
    }

    /// The number of pixels that it has.
    pub(super) fn area(&self) -> usize {
        self.inside.iter().filter(|inside| **inside).count()
    }

    /// The same on a grid with a margin of empty pixels on each side.
    pub(super) fn with_margin(&self, margin: usize) -> Self {
        let (columns, rows) = (self.columns + 2 * margin, self.rows + 2 * margin);
        let mut inside = vec![false; columns * rows];
        for row in 0..self.rows {
            let start = (row + margin) * columns + margin;
            inside[start..start + self.columns]
                .copy_from_slice(&self.inside[row * self.columns..(row + 1) * self.columns]);
        }
        Self { columns, rows, inside }
    }

    /// For each pixel the squared distance to the nearest pixel inside the silhouette (`to: true`) or outside of it. It
    /// is exact, and counts between middles. Far above all squares if there is no such pixel.
    pub(super) fn squared_distances(&self, to: bool) -> Vec<u64> {
        let far = (self.columns + self.rows) as u64;
        let (columns, rows) = (self.columns, self.rows);
        // Along each column, then the lower envelope of parabolas along each row.
        let mut along = vec![far; columns * rows];
        for column in 0..columns {
            for direction in [false, true] {
                let mut distance = far;
                for step in 0..rows {
                    let row = if direction { rows - 1 - step } else { step };
                    let at = row * columns + column;
                    distance = if self.inside[at] == to { 0 } else { (distance + 1).min(far) };
                    along[at] = along[at].min(distance);
                }
            }
        }
        let mut squares = vec![0; columns * rows];
        let mut hull: Vec<(usize, i64)> = Vec::new();
        for row in 0..rows {
            let height = |column: usize| (along[row * columns + column] * along[row * columns + column]) as i64;
            // The first column from which on the parabola of `right` is below that of `left` (distance transform).
            let meets = |left: usize, right: usize| {
                let (l, r) = (left as i64, right as i64);
                let twice = height(right) + r * r - height(left) - l * l;
                twice.div_euclid(2 * (r - l)) + 1
            };
            hull.clear();
            for column in 0..columns {
                let mut from = 0;
                while let Some(&(before, since)) = hull.last() {
                    from = meets(before, column);
                    if from > since {
                        break;
                    }
                    hull.pop();
                    from = 0;
                }
                if from < columns as i64 {
                    hull.push((column, from));
                }
            }
            let mut lowest = 0;
            for column in 0..columns {
                while lowest + 1 < hull.len() && hull[lowest + 1].1 <= column as i64 {
                    lowest += 1;
                }
                let nearest = hull[lowest].0;
                let across = nearest.abs_diff(column) as u64;
                squares[row * columns + column] = across * across + height(nearest) as u64;
            }
        }
        squares
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn margins_do_not_count_and_small_pictures_are_magnified() {
        let ink = [0, 0, 0, 0, 255, 0, 0, 255, 200, 0, 0, 0];
        let mask = Mask::of_ink(&ink, 3, 4).unwrap();
        assert_eq!((mask.columns, mask.rows), (2 * 64, 2 * 64));
        // The lower left is inked, the lower right too; above only the left.
        assert!(mask.inside[0] && mask.inside[127] && mask.inside[127 * 128]);
        assert!(!mask.inside[127 * 128 + 127]);
        assert_eq!(Mask::of_ink(&[127; 12], 3, 4), None);
    }

    #[test]
    fn large_pictures_are_averaged() {
        let mask = Mask::of_ink(&vec![255; 1030 * 515], 1030, 515).unwrap();
        assert_eq!((mask.columns, mask.rows), (343, 172));
    }

    #[test]
    fn distances_are_those_of_looking_at_every_pixel() {
        let (columns, rows) = (23, 17);
        let inside: Vec<bool> = (0..columns * rows).map(|at| (at * at * 7 + at / 5) % 11 < 6).collect();
        let mask = Mask { columns, rows, inside };
        for to in [false, true] {
            let found = mask.squared_distances(to);
            for (at, found) in found.into_iter().enumerate() {
                let square = |other: usize| {
                    let across = (at % columns).abs_diff(other % columns);
                    let along = (at / columns).abs_diff(other / columns);
                    (across * across + along * along) as u64
                };
                let nearest = (0..columns * rows).filter(|other| mask.inside[*other] == to).map(square).min();
                assert_eq!(Some(found), nearest);
            }
        }
    }
}
