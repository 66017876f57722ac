//! Several frames in one PNG, row by row: a strip of chosen moments, or a contact sheet. Each frame shows its time.

use std::io::Write;
use std::path::PathBuf;

use tiny_skia::{Pixmap, PremultipliedColorU8};

use super::partial_file::{PartFile, Unfinished};
use super::studio::{Easel, Studio};
use super::{Draft, Film, OutputError, OutputTarget, WrittenFilm, png};
use crate::raster::View;
use jostle_frames::frame::Frame;

/// Pixels between two frames.
pub const GAP: u32 = 6;

/// Few programs show more pixels than this, which is the size of the largest frame.
const MOST_PIXELS: u64 = 8192 * 8192;

/// The size in pixels of a sheet of `columns` x `rows` frames of one size.
pub fn size(frame: (u32, u32), (columns, rows): (u32, u32)) -> (u64, u64) {
    let side = |side: u32, count: u32| {
        let (side, count) = (u64::from(side), u64::from(count));
        side * count + u64::from(GAP) * count.saturating_sub(1)
    };
    (side(frame.0, columns), side(frame.1, rows))
}

/// Begins a sheet of `columns` x `rows` frames, each of the size of the view's camera. Frames beyond that are left out,
/// places beyond the last frame stay empty.
///
/// # Errors
/// If a sheet of that size cannot be made, or the file cannot be created.
pub fn open(target: &OutputTarget, view: View, (columns, rows): (u32, u32)) -> Result<Box<dyn Film>, OutputError> {
    let (width, height) = size(view.size(), (columns, rows));
    // No side of so few pixels is longer than 32 bits count.
    let fits = width.saturating_mul(height) <= MOST_PIXELS;
    let whole = fits.then(|| Pixmap::new(width as u32, height as u32)).flatten();
    let Some(mut sheet) = whole else {
        return Err(OutputError::Sheet { width, height, frames: (columns, rows) });
    };
    let color = view.theme.wall;
    let between = PremultipliedColorU8::from_rgba(color.0, color.1, color.2, 255);
    sheet.pixels_mut().fill(between.unwrap_or(PremultipliedColorU8::TRANSPARENT));
    let path = target.path().to_path_buf();
    let file = PartFile::create(&path, Unfinished::Removed)?;
    let studio = Studio::new(view);
    Ok(Box::new(Sheet { easel: studio.easel()?, path, file, studio, sheet, columns, rows, frames: 0 }))
}

struct Sheet {
    path: PathBuf,
    file: PartFile,
    studio: Studio,
    easel: Easel,
    sheet: Pixmap,
    columns: u32,
    rows: u32,
    frames: u32,
}

impl Film for Sheet {
    fn push(&mut self, frame: Frame) -> Result<(), OutputError> {
        Studio::check(&frame)?;
        if self.frames >= self.columns * self.rows {
            return Ok(());
        }
        let painter = self.studio.painter(&frame)?;
        self.easel.paint(&painter, &frame);
        let picture = &self.easel.picture;
        let (width, height) = (picture.width(), picture.height());
        let left = (self.frames % self.columns * (width + GAP)) as usize;
        let top = (self.frames / self.columns * (height + GAP)) as usize;
        let across = self.sheet.width() as usize;
        let rows = self.sheet.data_mut().chunks_exact_mut(4 * across).skip(top);
        for (below, row) in rows.zip(picture.data().chunks_exact(4 * width as usize)) {
            below[4 * left..4 * left + row.len()].copy_from_slice(row);
        }
        self.frames += 1;
        Ok(())
    }

    fn close(mut self: Box<Self>) -> Result<Draft, OutputError> {
        if self.frames == 0 {
            return Err(OutputError::NoFrames { path: self.path });
        }
        let packed = png::pack(&self.sheet, &mut Vec::new()).map_err(|cause| OutputError::io(&self.path, cause))?;
        self.file.write_all(&packed).map_err(|cause| OutputError::io(&self.path, cause))?;
        let (frames, bytes) = (u64::from(self.frames), self.file.bytes());
        let written = WrittenFilm { path: self.path, frames, bytes, seconds: 0.0, left_over: 0 };
        Ok(Draft { written, file: Some(self.file) })
    }
}
