//! APNG films: true colours, lossless, endless, and only the changes from frame to frame.
//!
//! The `png` crate packs the pictures. This file writes the chunks of the animation. The crate would need the number of
//! frames beforehand, and packs one picture at a time. The number is written at the end, when it is known.
//!
//! Source: PNG specification, third edition (W3C 2025), chunks acTL, fcTL and fdAT.

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::delta::Patch;
use super::partial_file::{PartFile, Unfinished};
use super::stream::{Closed, Sink, Stream};
use super::{FilmSettings, Format, Opened, OutputError};
use crate::raster::View;

pub(super) const FORMAT: Format = Format { ending: ".apng", open };

const SIGNATURE: [u8; 8] = [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n'];

/// First byte of the chunk with the number of frames. The signature and the header precede it (13 bytes in a chunk of
/// 12).
const COUNT_AT: u64 = 8 + 13 + 12;

/// A frame stores its duration as 16 bits of these parts of a second, which limits the durations.
const FINE: f64 = 10_000.0;
const COARSE: f64 = 100.0;
const MOST: f64 = u16::MAX as f64;

fn open(path: &Path, settings: &FilmSettings, view: View) -> Opened {
    let (rate, allowed) = (settings.frames_per_second, (COARSE / MOST, 1000.0));
    if !(allowed.0..=allowed.1).contains(&rate) {
        return Err(OutputError::Rate { frames_per_second: rate, allowed });
    }
    let (width, height) = view.size();
    let file = PartFile::create(path, Unfinished::Removed)?;
    let sink = Apng { path: path.to_path_buf(), file, width, height, rate, frames: 0, sequence: 0 };
    Ok(Box::new(Stream::new(path.to_path_buf(), settings, view, sink)?))
}

struct Apng {
    path: PathBuf,
    file: PartFile,
    width: u32,
    height: u32,
    rate: f64,
    frames: u64,
    /// The number of the next chunk of the animation.
    sequence: u32,
}

/// The changed box, and its packed pixels.
struct Packed {
    patch: Patch,
    data: Vec<u8>,
}

impl Sink for Apng {
    type Packed = Packed;
    const COMPARES: bool = true;

    /// Pixels of the box that did not change are transparent: they pack to next to nothing.
    fn pack(&self, before: &[u8], picture: Cow<[u8]>) -> io::Result<Packed> {
        let width = self.width as usize;
        if before.is_empty() {
            let patch = Patch::whole(width, self.height as usize);
            return Ok(Packed { data: packed(&picture, self.width, self.height)?, patch });
        }
        // Every frame must be there for its time to pass, and no frame may be empty.
        let patch = pixels(Patch::between(before, &picture, 4 * width)).unwrap_or(Patch::whole(1, 1));
        let bytes = Patch { left: 4 * patch.left, width: 4 * patch.width, ..patch };
        let mut changed = Vec::with_capacity(bytes.width * bytes.height);
        for (before, after) in bytes.cut(before, 4 * width).zip(bytes.cut(&picture, 4 * width)) {
            let pairs = before.as_chunks::<4>().0.iter().zip(after.as_chunks::<4>().0);
            changed.extend(pairs.flat_map(|(before, after)| if before == after { [0; 4] } else { *after }));
        }
        Ok(Packed { data: packed(&changed, patch.width as u32, patch.height as u32)?, patch })
    }

    fn write(&mut self, Packed { patch, data }: Packed) -> Result<(), OutputError> {
        self.write_frame(&patch, &data).map_err(|cause| OutputError::io(&self.path, cause))
    }

    fn close(mut self, frames: u64) -> Result<Closed, OutputError> {
        let mut count = Vec::new();
        chunk(&mut count, b"acTL", &[&(frames as u32).to_be_bytes(), &0_u32.to_be_bytes()]);
        let mut end = Vec::new();
        chunk(&mut end, b"IEND", &[]);
        let written = self.file.write_all(&end).and_then(|()| self.file.overwrite(COUNT_AT, &count));
        written.map_err(|cause| OutputError::io(&self.path, cause))?;
        let (parts, seconds) = (parts(self.rate), end_of(frames, self.rate));
        Ok(Closed { bytes: self.file.bytes(), file: Some(self.file), seconds: seconds / parts })
    }
}

impl Apng {
    fn write_frame(&mut self, patch: &Patch, data: &[u8]) -> io::Result<()> {
        let mut chunks = Vec::with_capacity(data.len() + 256);
        if self.frames == 0 {
            chunks.extend(SIGNATURE);
            // Eight bits each of red, green, blue and opacity; no interlacing.
            let kind = [8, 6, 0, 0, 0];
            chunk(&mut chunks, b"IHDR", &[&self.width.to_be_bytes(), &self.height.to_be_bytes(), &kind]);
            chunk(&mut chunks, b"acTL", &[&[0; 8]]);
        }
        let delay = (end_of(self.frames + 1, self.rate) - end_of(self.frames, self.rate)) as u16;
        let parts = parts(self.rate) as u16;
        let [width, height, left, top] = [patch.width, patch.height, patch.left, patch.top].map(|n| n as u32);
        let mut control = Vec::with_capacity(26);
        for number in [self.sequence, width, height, left, top] {
            control.extend(number.to_be_bytes());
        }
        control.extend(delay.to_be_bytes());
        control.extend(parts.to_be_bytes());
        // The picture stays, and the next is laid over it.
        control.extend([0, 1]);
        chunk(&mut chunks, b"fcTL", &[&control]);
        self.sequence += 1;
        if self.frames == 0 {
            chunk(&mut chunks, b"IDAT", &[data]);
        } else {
            chunk(&mut chunks, b"fdAT", &[&self.sequence.to_be_bytes(), data]);
            self.sequence += 1;
        }
        self.frames += 1;
        self.file.write_all(&chunks)
    }
}

/// A box of bytes as the box of pixels, four bytes each, that holds it.
fn pixels(bytes: Option<Patch>) -> Option<Patch> {
    bytes.map(|bytes| {
        let left = bytes.left / 4;
        Patch { left, width: (bytes.left + bytes.width).div_ceil(4) - left, ..bytes }
    })
}

/// The parts of a second that count the durations of frames. A whole rate is exact for every frame, other rates on
/// average.
fn parts(rate: f64) -> f64 {
    if rate.fract() == 0.0 && rate >= 1.0 {
        rate
    } else if rate >= 1.0 {
        FINE
    } else {
        COARSE
    }
}

/// When so many frames have been shown, in [`parts`].
fn end_of(frames: u64, rate: f64) -> f64 {
    (frames as f64 * parts(rate) / rate + 1e-6).floor()
}

/// Packs pixels as the data of a PNG. Fast compression wants the Paeth filter: see there.
fn packed(pixels: &[u8], width: u32, height: u32) -> io::Result<Vec<u8>> {
    let mut file = Vec::with_capacity(pixels.len() / 8);
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Paeth);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(data_of(&file))
}

/// The data in all chunks of pixels of a PNG.
fn data_of(file: &[u8]) -> Vec<u8> {
    let mut data = Vec::with_capacity(file.len());
    let mut rest = file.get(SIGNATURE.len()..).unwrap_or_default();
    while let Some((head, tail)) = rest.split_first_chunk::<8>() {
        let [a, b, c, d, kind @ ..] = *head;
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        if &kind == b"IDAT" {
            data.extend_from_slice(tail.get(..length).unwrap_or_default());
        }
        // The check sum of the data follows them.
        rest = tail.get(length + 4..).unwrap_or_default();
    }
    data
}

/// Adds a chunk: length, kind, data, check sum.
fn chunk(file: &mut Vec<u8>, kind: &[u8; 4], data: &[&[u8]]) {
    let length: usize = data.iter().map(|part| part.len()).sum();
    file.extend((length as u32).to_be_bytes());
    let begin = file.len();
    file.extend(kind);
    for part in data {
        file.extend_from_slice(part);
    }
    let sum = crc32fast::hash(&file[begin..]);
    file.extend(sum.to_be_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_add_up_to_the_length_of_the_film() {
        for (rate, frames, seconds) in [(30.0, 600, 20.0), (24.0, 7, 7.0 / 24.0), (12.5, 250, 20.0), (0.5, 10, 20.0)] {
            assert!((end_of(frames, rate) / parts(rate) - seconds).abs() < 1e-12, "{frames} frames at {rate}");
            let longest = (0..frames).map(|frame| end_of(frame + 1, rate) - end_of(frame, rate)).fold(0.0, f64::max);
            assert!((1.0..=MOST).contains(&longest));
        }
    }
}
