//! Frames that wait in a file, for films that are played backwards or several times.
//!
//! A frame takes 24 bytes for each body; memory holds only one at a time. The file is a temporary one without a name,
//! so that it disappears however the program ends.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec2;

use super::frame::{BodyPose, Cast, Frame};
use super::mark::{Corner, Mark, MarkShape};

/// Bytes of the length before and after each frame.
const LENGTH: u64 = 8;

/// Frames in the order they were taken.
#[derive(Debug)]
pub struct Spool {
    file: BufWriter<File>,
    /// The casts of the frames, each once.
    casts: Vec<Arc<Cast>>,
    frames: u64,
    bytes: u64,
}

impl Spool {
    /// The directory of temporary files.
    pub fn folder() -> PathBuf {
        std::env::temp_dir()
    }

    /// An empty one, in the directory of temporary files.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn new() -> io::Result<Self> {
        let file = BufWriter::with_capacity(1 << 16, tempfile::tempfile_in(Self::folder())?);
        Ok(Self { file, casts: Vec::new(), frames: 0, bytes: 0 })
    }

    /// The number of frames.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// If the system refuses to write.
    pub fn push(&mut self, frame: &Frame) -> io::Result<()> {
        if !self.casts.last().is_some_and(|cast| Arc::ptr_eq(cast, &frame.cast)) {
            self.casts.push(frame.cast.clone());
        }
        let packed = pack(frame, self.casts.len() - 1);
        let length = (packed.len() as u64).to_le_bytes();
        for part in [&length[..], &packed, &length] {
            self.file.write_all(part)?;
        }
        self.bytes += packed.len() as u64 + 2 * LENGTH;
        self.frames += 1;
        Ok(())
    }

    /// The frames as they were taken.
    ///
    /// # Errors
    /// If the system refuses to write or read.
    pub fn forwards(&mut self) -> io::Result<impl Iterator<Item = io::Result<Frame>>> {
        self.file.flush()?;
        self.file.get_mut().seek(SeekFrom::Start(0))?;
        let Self { file, casts, frames, .. } = self;
        let mut reader = BufReader::with_capacity(1 << 16, file.get_mut());
        Ok((0..*frames).map(move |_| {
            let frame = read(&mut reader, casts)?;
            number(&mut reader)?;
            Ok(frame)
        }))
    }

    /// The frames from the last to the first.
    ///
    /// # Errors
    /// If the system refuses to write or read.
    pub fn backwards(&mut self) -> io::Result<impl Iterator<Item = io::Result<Frame>>> {
        self.file.flush()?;
        let Self { file, casts, frames, bytes, .. } = self;
        let (file, mut end) = (file.get_mut(), *bytes);
        Ok((0..*frames).map(move |_| {
            file.seek(SeekFrom::Start(end - LENGTH))?;
            end -= number(file)? + 2 * LENGTH;
            file.seek(SeekFrom::Start(end))?;
            read(file, casts)
        }))
    }
}

/// A frame as bytes, its cast as a number.
fn pack(frame: &Frame, cast: usize) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(32 + 24 * frame.poses.len());
    let count = |bytes: &mut Vec<u8>, number: usize| bytes.extend((number as u64).to_le_bytes());
    let real = |bytes: &mut Vec<u8>, number: f64| bytes.extend(number.to_le_bytes());
    count(&mut bytes, cast);
    real(&mut bytes, frame.time);
    count(&mut bytes, frame.poses.len());
    for pose in &frame.poses {
        [pose.position.x, pose.position.y, pose.angle].into_iter().for_each(|number| real(&mut bytes, number));
    }
    count(&mut bytes, frame.marks.len());
    for mark in &frame.marks {
        let (kind, numbers, text) = parts(&mark.shape);
        for number in [kind, numbers.len(), text.len(), mark.color.as_ref().map_or(0, |color| color.len() + 1)] {
            count(&mut bytes, number);
        }
        numbers.into_iter().for_each(|number| real(&mut bytes, number));
        bytes.extend(text.as_bytes());
        bytes.extend(mark.color.as_deref().unwrap_or_default().as_bytes());
    }
    bytes
}

/// A shape as its kind, its numbers and its text.
fn parts(shape: &MarkShape) -> (usize, Vec<f64>, &str) {
    let pair = |a: &DVec2, b: &DVec2| vec![a.x, a.y, b.x, b.y];
    match shape {
        MarkShape::Line(from, to) => (0, pair(from, to), ""),
        MarkShape::Arrow(from, to) => (1, pair(from, to), ""),
        MarkShape::LongArrow(from, to) => (2, pair(from, to), ""),
        MarkShape::Circle(center, radius) => (3, vec![center.x, center.y, *radius], ""),
        MarkShape::Dot(at) => (4, vec![at.x, at.y], ""),
        MarkShape::Rectangle(low, high) => (5, pair(low, high), ""),
        MarkShape::Trail { body, points, step } => {
            // A place is a whole number that `f64` counts exactly.
            let numbers = [*body as f64, *step].into_iter().chain(points.iter().flat_map(|point| [point.x, point.y]));
            (6, numbers.collect(), "")
        }
        MarkShape::Label { at, clear, text } => (7, vec![at.x, at.y, *clear], text),
        MarkShape::Key { length, text } => (8, vec![*length], text),
        MarkShape::ScaleBar => (9, Vec::new(), ""),
        MarkShape::Time => (10, Vec::new(), ""),
        MarkShape::Inset { center, height, corner, share } => {
            let [right, bottom] = [corner.right, corner.bottom].map(|side| f64::from(u8::from(side)));
            (11, vec![center.x, center.y, *height, *share, right, bottom], "")
        }
    }
}

/// The shape that has these parts.
fn shape(kind: u64, numbers: &[f64], text: String) -> Option<MarkShape> {
    let point = |index: usize| Some(DVec2::new(*numbers.get(index)?, *numbers.get(index + 1)?));
    Some(match kind {
        0 => MarkShape::Line(point(0)?, point(2)?),
        1 => MarkShape::Arrow(point(0)?, point(2)?),
        2 => MarkShape::LongArrow(point(0)?, point(2)?),
        3 => MarkShape::Circle(point(0)?, *numbers.get(2)?),
        4 => MarkShape::Dot(point(0)?),
        5 => MarkShape::Rectangle(point(0)?, point(2)?),
        6 => {
            let points = numbers.get(2..)?.chunks_exact(2).map(|pair| DVec2::new(pair[0], pair[1])).collect();
            MarkShape::Trail { body: *numbers.first()? as usize, points, step: *numbers.get(1)? }
        }
        7 => MarkShape::Label { at: point(0)?, clear: *numbers.get(2)?, text },
        8 => MarkShape::Key { length: *numbers.first()?, text },
        9 => MarkShape::ScaleBar,
        10 => MarkShape::Time,
        11 => {
            let [height, share, right, bottom] = *numbers.get(2..)?.first_chunk()?;
            let corner = Corner { right: right != 0.0, bottom: bottom != 0.0 };
            MarkShape::Inset { center: point(0)?, height, corner, share }
        }
        _ => return None,
    })
}

/// Reads a frame with the length before it.
fn read(file: &mut impl Read, casts: &[Arc<Cast>]) -> io::Result<Frame> {
    let length = number(file)?;
    let mut bytes = vec![0; length as usize];
    file.read_exact(&mut bytes)?;
    let rest = &mut bytes.as_slice();
    let cast = casts.get(number(rest)? as usize).cloned().ok_or(io::ErrorKind::InvalidData)?;
    let time = real(rest)?;
    let poses = (0..number(rest)?)
        .map(|_| Ok(BodyPose { position: point(rest)?, angle: real(rest)? }))
        .collect::<io::Result<Vec<_>>>()?;
    let marks = (0..number(rest)?).map(|_| mark(rest)).collect::<io::Result<Vec<_>>>()?;
    Ok(Frame { time, cast, poses, marks, center: None })
}

fn mark(rest: &mut &[u8]) -> io::Result<Mark> {
    let (kind, numbers, letters, color) = (number(rest)?, number(rest)?, number(rest)?, number(rest)?);
    let numbers = (0..numbers).map(|_| real(rest)).collect::<io::Result<Vec<_>>>()?;
    let text = text(rest, letters)?;
    let shape = shape(kind, &numbers, text).ok_or(io::ErrorKind::InvalidData)?;
    // A length above zero means that there is a colour, even if its name is empty.
    let color = color.checked_sub(1).map(|length| self::text(rest, length)).transpose()?;
    Ok(Mark { shape, color })
}

fn text(rest: &mut &[u8], length: u64) -> io::Result<String> {
    let mut bytes = vec![0; length as usize];
    rest.read_exact(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn number(file: &mut impl Read) -> io::Result<u64> {
    let mut bytes = [0; 8];
    file.read_exact(&mut bytes).map(|()| u64::from_le_bytes(bytes))
}

fn real(file: &mut impl Read) -> io::Result<f64> {
    number(file).map(f64::from_bits)
}

fn point(file: &mut impl Read) -> io::Result<DVec2> {
    Ok(DVec2::new(real(file)?, real(file)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames() -> Vec<Frame> {
        let (one, two) = (Arc::new(Cast::default()), Arc::new(Cast { title: "other".into(), ..Cast::default() }));
        let pose = |x| BodyPose { position: DVec2::new(x, -0.0), angle: 1.0 / 3.0 };
        let mark = |shape, color: Option<&str>| Mark { shape, color: color.map(str::to_owned) };
        let marks = vec![
            mark(MarkShape::Line(DVec2::X, DVec2::Y), None),
            mark(MarkShape::Arrow(DVec2::Y, DVec2::ONE), Some("teal")),
            mark(MarkShape::LongArrow(DVec2::Y, DVec2::ONE), None),
            mark(MarkShape::Circle(DVec2::ONE, 0.25), Some("")),
            mark(MarkShape::Dot(DVec2::X), Some("force")),
            mark(MarkShape::Rectangle(DVec2::X, DVec2::ONE), None),
            mark(MarkShape::Trail { body: 3, points: vec![DVec2::X, DVec2::Y], step: 0.1 }, None),
            mark(MarkShape::Label { at: DVec2::X, clear: 0.5, text: "Bär".into() }, None),
            mark(MarkShape::Key { length: 0.3, text: "2 µN".into() }, Some("force")),
            mark(MarkShape::ScaleBar, None),
            mark(MarkShape::Time, None),
            mark(
                MarkShape::Inset {
                    center: DVec2::X,
                    height: 0.5,
                    corner: Corner { right: true, bottom: false },
                    share: 0.4,
                },
                None,
            ),
        ];
        let frame = |time: u32| {
            let (cast, poses) = if time < 3 { (&one, time) } else { (&two, 1) };
            let marks = if time == 2 { marks.clone() } else { Vec::new() };
            let poses = (0..poses).map(|index| pose(f64::from(index))).collect();
            Frame { time: f64::from(time), cast: cast.clone(), poses, marks, center: None }
        };
        (0..6).map(frame).collect()
    }

    #[test]
    fn frames_come_back_forwards_and_backwards_as_often_as_asked() {
        let mut spool = Spool::new().expect("a temporary file");
        frames().iter().for_each(|frame| spool.push(frame).expect("room"));
        for _ in 0..2 {
            let forwards: Vec<Frame> = spool.forwards().expect("readable").map(|frame| frame.expect("whole")).collect();
            assert_eq!(forwards, frames());
            let mut backwards: Vec<Frame> =
                spool.backwards().expect("readable").map(|frame| frame.expect("whole")).collect();
            backwards.reverse();
            assert_eq!(backwards, frames());
            // Frames of one cast share it, which tells the painter that the cast is the same.
            assert!(Arc::ptr_eq(&forwards[0].cast, &backwards[2].cast));
        }
        assert_eq!(spool.frames(), 6);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_file_has_no_name() {
        use std::os::unix::fs::MetadataExt;
        let spool = Spool::new().expect("a temporary file");
        assert_eq!(spool.file.get_ref().metadata().expect("a file").nlink(), 0);
    }
}
