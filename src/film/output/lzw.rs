//! The compression of GIF: Lempel-Ziv-Welch with codes of growing width.
//!
//! Two properties of films make it fast and small here. Pixels come in runs. The codes of each symbol's runs are at
//! hand, so a match begins with the longest known run at once. The output equals that of the plain greedy encoder. An
//! unchanged pixel may be coded as transparent or by its colour, whichever prolongs the match.

/// The widest codes GIF allows, in bits.
const WIDEST: u32 = 12;
const CODES: u32 = 1 << WIDEST;

/// Slots of the hash table: four for each code, so that chains stay short.
const SLOTS: usize = 4 * CODES as usize;
const EMPTY: u32 = u32::MAX;

/// Packs pictures. Kept from picture to picture to spare allocations.
#[derive(Debug)]
pub(super) struct Packer {
    /// Each slot holds 20 bits of key (code of the prefix, next symbol) and 12 bits of code.
    table: Box<[u32; SLOTS]>,
    /// For each symbol the codes of its runs of 1, 2, 3 ...
    runs: Vec<Vec<u16>>,
}

impl Default for Packer {
    fn default() -> Packer {
        Packer { table: Box::new([EMPTY; SLOTS]), runs: vec![Vec::new(); 256] }
    }
}

impl Packer {
    /// Packs `symbols`, which are all below two to the `bits` (2 to 8). If the symbol is `loose`, the symbol at the
    /// same index of `alternatives` means the same picture. The result begins with the code size, as the format
    /// requires.
    pub(super) fn pack(&mut self, symbols: &[u8], alternatives: &[u8], loose: u8, bits: u32) -> Vec<u8> {
        let clear = 1 << bits;
        let mut output = Bits { bytes: vec![bits as u8], pending: 0, count: 0, width: bits + 1 };
        output.push(clear);
        let mut next = self.forget(clear);
        let mut index = 0;
        while let Some(&first) = symbols.get(index) {
            let (mut code, length) = self.longest_run(&symbols[index..], first);
            index += length;
            // Prolong the match as far as known.
            let missing = loop {
                let Some(&symbol) = symbols.get(index) else { break None };
                let prolonged = self.find(code, symbol).or_else(|| {
                    let other = (symbol == loose).then(|| alternatives.get(index)).flatten()?;
                    self.find(code, *other)
                });
                match prolonged {
                    Some(longer) => code = longer,
                    None => break Some(symbol),
                }
                index += 1;
            };
            output.push(code);
            // The reader's table is one entry behind: it widens its codes when this many are known.
            if next == 1 << output.width && output.width < WIDEST {
                output.width += 1;
            }
            let Some(symbol) = missing else { break };
            if next < CODES {
                self.insert(code, symbol, next);
                next += 1;
            } else {
                output.push(clear);
                output.width = bits + 1;
                next = self.forget(clear);
            }
        }
        output.push(clear + 1);
        output.finish()
    }

    /// Empties the table except for the single symbols, and returns the first free code.
    fn forget(&mut self, clear: u32) -> u32 {
        self.table.fill(EMPTY);
        for (symbol, runs) in self.runs.iter_mut().enumerate() {
            runs.clear();
            runs.push(symbol as u16);
        }
        clear + 2
    }

    /// The code and the length of the longest known run that `symbols` begins with.
    fn longest_run(&self, symbols: &[u8], first: u8) -> (u32, usize) {
        let runs = &self.runs[usize::from(first)];
        let reach = &symbols[..symbols.len().min(runs.len())];
        let (words, _) = reach.as_chunks::<8>();
        let mut length = 8 * words.iter().take_while(|word| **word == [first; 8]).count();
        length += reach[length..].iter().take_while(|symbol| **symbol == first).count();
        (u32::from(runs[length - 1]), length)
    }

    fn find(&self, prefix: u32, symbol: u8) -> Option<u32> {
        let key = prefix << 8 | u32::from(symbol);
        let mut slot = slot(key);
        loop {
            let entry = self.table[slot];
            if entry == EMPTY {
                return None;
            }
            if entry >> WIDEST == key {
                return Some(entry & (CODES - 1));
            }
            slot = (slot + 1) % SLOTS;
        }
    }

    fn insert(&mut self, prefix: u32, symbol: u8, code: u32) {
        let key = prefix << 8 | u32::from(symbol);
        let mut slot = slot(key);
        while self.table[slot] != EMPTY {
            slot = (slot + 1) % SLOTS;
        }
        self.table[slot] = key << WIDEST | code;
        let runs = &mut self.runs[usize::from(symbol)];
        if runs.last().is_some_and(|longest| u32::from(*longest) == prefix) {
            runs.push(code as u16);
        }
    }
}

/// The first slot for a key, by multiplicative hashing with the golden ratio (Fibonacci hashing).
fn slot(key: u32) -> usize {
    (key.wrapping_mul(0x9E37_79B1) >> (32 - SLOTS.trailing_zeros())) as usize
}

/// Codes of changing width, packed from the lowest bit on.
struct Bits {
    bytes: Vec<u8>,
    pending: u64,
    count: u32,
    width: u32,
}

impl Bits {
    fn push(&mut self, code: u32) {
        self.pending |= u64::from(code) << self.count;
        self.count += self.width;
        while self.count >= 8 {
            self.bytes.push(self.pending as u8);
            self.pending >>= 8;
            self.count -= 8;
        }
    }

    fn finish(mut self) -> Vec<u8> {
        if self.count > 0 {
            self.bytes.push(self.pending as u8);
        }
        self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// The output of a decoder that is independent of this file.
    fn unpack(packed: Vec<u8>, length: usize) -> Vec<u8> {
        let mut file = Vec::new();
        let palette: Vec<u8> = (0..=255_u8).flat_map(|level| [level; 3]).collect();
        let mut encoder = gif::Encoder::new(&mut file, length as u16, 1, &palette).expect("a header");
        let frame = gif::Frame { width: length as u16, height: 1, buffer: packed.into(), ..gif::Frame::default() };
        encoder.write_lzw_pre_encoded_frame(&frame).expect("a frame");
        drop(encoder);
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::Indexed);
        let mut decoder = options.read_info(file.as_slice()).expect("a header");
        decoder.read_next_frame().expect("good codes").expect("a frame").buffer.to_vec()
    }

    #[test]
    fn any_symbols_come_back() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut packer = Packer::default();
        for bits in 2..=8 {
            for length in [1, 2, 3, 255, 4096, 5000, 60000] {
                // Noise fills the table again and again; runs of any length exercise the short cut.
                let noise: Vec<u8> = (0..length).map(|_| (random.next_u32() % (1 << bits)) as u8).collect();
                let mut runs = Vec::with_capacity(length);
                while runs.len() < length {
                    let symbol = (random.next_u32() % (1 << bits)) as u8;
                    let count = random.random_range(1..200).min(length - runs.len());
                    runs.extend(std::iter::repeat_n(symbol, count));
                }
                for symbols in [noise, runs, vec![3; length]] {
                    let packed = packer.pack(&symbols, &symbols, 0, bits);
                    assert_eq!(unpack(packed, length), symbols, "{bits} bits, {length} symbols");
                }
            }
        }
    }

    #[test]
    fn loose_symbols_come_back_as_themselves_or_their_alternative() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        // A pattern with random gaps. With the alternatives an encoder finds the pattern again, and without them it
        // sees noise.
        let alternatives: Vec<u8> = (0..50_000).map(|index| [0, 1, 2, 0, 3, 1, 1][index % 7]).collect();
        let gap = |symbol: &u8| if random.next_u32() % 10 == 0 { 7 } else { *symbol };
        let symbols: Vec<u8> = alternatives.iter().map(gap).collect();
        let mut packer = Packer::default();
        let packed = packer.pack(&symbols, &alternatives, 7, 3);
        let strict = packer.pack(&symbols, &symbols, 7, 3);
        assert!(packed.len() < strict.len() / 2, "{} of {} bytes", packed.len(), strict.len());
        for ((seen, symbol), alternative) in unpack(packed, 50_000).iter().zip(&symbols).zip(&alternatives) {
            assert!(seen == symbol || (*symbol == 7 && seen == alternative));
        }
    }

    #[test]
    fn a_long_run_is_tiny() {
        // A run of n symbols takes about sqrt(2 n) codes.
        let symbols = vec![1; 60_000];
        assert!(Packer::default().pack(&symbols, &symbols, 0, 8).len() < 600);
    }
}
