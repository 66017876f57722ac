//! Changes of bytes: snapshots and pictures, whose checksums are repaired, and lines of text.

use crate::mutate::Chance;

/// Lengths of runs of bytes, and how often such a run or a line is repeated.
const LENGTHS: [usize; 6] = [1, 2, 4, 8, 9, 64];
const REPEATS: [usize; 5] = [1, 2, 40, 1000, 20_000];
/// No mutant is longer, in bytes.
const LONGEST: usize = 4_000_000;
/// The first bytes of a PNG.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// One change from byte `from` on: a bit, a step up or down, an edge of a byte, a number, a length, a run of bytes
/// repeated, removed or copied elsewhere, or a shorter file.
fn change(bytes: &mut Vec<u8>, from: usize, chance: &mut Chance) {
    if bytes.len() <= from + 1 {
        return;
    }
    let place = from + chance.below(bytes.len() - from);
    let end = (place + chance.pick(&LENGTHS)).min(bytes.len());
    match chance.below(12) {
        0..2 => bytes[place] ^= 1 << chance.below(8),
        2 => bytes[place] = bytes[place].wrapping_add(1),
        3 => bytes[place] = bytes[place].wrapping_sub(1),
        4 => bytes[place] = chance.pick(&[0, 1, 127, 128, 254, 255]),
        5..7 => {
            let number = chance.pick(&[f64::NAN, f64::INFINITY, 0.0, -1.0, 1e300, 1e-300, f64::MAX]);
            let number = number.to_le_bytes();
            let end = (place + 8).min(bytes.len());
            bytes[place..end].copy_from_slice(&number[..end - place]);
        }
        7 => {
            // A length as postcard writes it.
            let length: &[u8] = chance.pick(&[
                &[0x80, 0x80, 0x01][..],
                &[0x80, 0x80, 0x80, 0x80, 0x01],
                &[255, 255, 255, 255, 15],
                &[255, 255, 255, 255, 255, 255, 255, 255, 31],
                &[255, 255, 255, 255, 255, 255, 255, 255, 255, 1],
            ]);
            let end = (place + length.len()).min(bytes.len());
            bytes[place..end].copy_from_slice(&length[..end - place]);
        }
        8 => {
            let run = bytes[place..end].to_vec();
            bytes.splice(place..place, run);
        }
        9 => {
            bytes.drain(place..end);
        }
        10 => {
            let run = bytes[place..end].to_vec();
            let into = from + chance.below(bytes.len() - from - run.len() + 1);
            bytes[into..into + run.len()].copy_from_slice(&run);
        }
        _ => bytes.truncate(place),
    }
}

/// A mutant with a CRC-32 at its end, which is right.
pub fn checked(seed_bytes: &[u8], from: usize, seed: u64, number: u64) -> Vec<u8> {
    let mut chance = Chance::of(seed, number);
    let mut bytes = seed_bytes[..seed_bytes.len().saturating_sub(4)].to_vec();
    for _ in 0..1 + chance.below(3) {
        change(&mut bytes, from, &mut chance);
    }
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    bytes
}

/// A mutant of a picture. The checksums of its chunks are mostly right.
pub fn png(pictures: &[Vec<u8>], seed: u64, number: u64) -> Vec<u8> {
    let mut chance = Chance::of(seed, number);
    let mut bytes = pictures[chance.below(pictures.len())].clone();
    if chance.below(4) == 0 && bytes.len() > 24 {
        let side = chance.pick(&[0_u32, 1, 4096, 30_000, 1 << 20, u32::MAX >> 1, u32::MAX]).to_be_bytes();
        let place = chance.pick(&[16, 20]);
        bytes[place..place + 4].copy_from_slice(&side);
    }
    for _ in 0..chance.below(4) {
        change(&mut bytes, PNG.len(), &mut chance);
    }
    if chance.below(8) > 0 {
        repair_chunks(&mut bytes);
    }
    bytes
}

/// Puts the right checksum at the end of each chunk of a PNG.
fn repair_chunks(bytes: &mut [u8]) {
    let mut begin = PNG.len();
    while let Some(length) = bytes.get(begin..begin + 4).and_then(|length| length.try_into().ok()) {
        let end = (begin + 8).saturating_add(u32::from_be_bytes(length) as usize);
        if bytes.len() < end.saturating_add(4) {
            return;
        }
        let sum = crc32fast::hash(&bytes[begin + 4..end]).to_be_bytes();
        bytes[end..end + 4].copy_from_slice(&sum);
        begin = end + 4;
    }
}

/// Now and then repeats lines of a text, up to thousands of times, or changes its bytes.
pub fn lines(text: String, seed: u64, number: u64) -> Vec<u8> {
    let mut chance = Chance::of(seed ^ 1, number);
    if chance.below(3) == 0 {
        let lines: Vec<&str> = text.split_inclusive('\n').collect();
        let begin = chance.below(lines.len());
        let some = lines[begin..(begin + 1 + chance.below(3)).min(lines.len())].concat();
        let times = chance.pick(&REPEATS).min(LONGEST / some.len().max(1));
        let ends = lines[begin..].concat();
        return [lines[..begin].concat(), some.repeat(times), ends].concat().into_bytes();
    }
    let mut bytes = text.into_bytes();
    if chance.below(8) == 0 {
        change(&mut bytes, 0, &mut chance);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_right_and_mutants_repeat() {
        let whole: Vec<u8> = (0..200).collect();
        for number in 0..200 {
            let mutant = checked(&whole, 20, 3, number);
            let (bytes, sum) = mutant.split_last_chunk::<4>().unwrap();
            assert_eq!(crc32fast::hash(bytes), u32::from_le_bytes(*sum));
            assert_eq!(bytes[..20.min(bytes.len())], whole[..20.min(bytes.len())]);
            assert_eq!(mutant, checked(&whole, 20, 3, number));
        }
    }

    #[test]
    fn chunks_get_the_checksum_of_their_bytes() {
        // The last chunk of every PNG: no content, and a known checksum.
        let mut bytes = [PNG, &[0, 0, 0, 0], b"IEND", &[1, 2, 3, 4]].concat();
        repair_chunks(&mut bytes);
        assert_eq!(bytes[16..], [0xAE, 0x42, 0x60, 0x82]);
    }
}
