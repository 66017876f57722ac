use glam::DVec2;

use super::*;

/// Each operation on numbers that are hard to round, as bits.
struct Everything<'a> {
    numbers: &'a [f64; BLOCK],
    others: &'a [f64; BLOCK],
}

impl Kernel for Everything<'_> {
    type Output = Vec<u64>;

    #[inline(always)]
    fn run<V: Lanes>(self) -> Vec<u64> {
        let mut results = vec![[0.0; BLOCK]; 22];
        let mut bits = [0_u8; 5];
        let records: Vec<Record> = (0..BLOCK)
            .map(|row| Record(std::array::from_fn(|column| self.numbers[row] + (10 * column) as f64)))
            .collect();
        let (indices, second) = ([3_u32, 0, 7, 1, 6, 2, 5, 4], [1_u32, 1, 0, 6, 7, 4, 2, 3]);
        let mut twins = PairBlocks::default();
        twins.list(indices.into_iter().zip(second));
        let pairs_of_records = twins.records(&records);
        let pairs: Vec<DVec2> = (0..BLOCK).map(|index| DVec2::new(self.numbers[index], self.others[index])).collect();
        let mut swapped = [DVec2::ZERO; BLOCK];
        let mut written = [Record::default(); BLOCK];
        let mut lane = 0;
        while lane < BLOCK {
            let (a, b) = (V::load(&self.numbers[lane..]), V::load(&self.others[lane..]));
            let transposed = V::records(&records, &indices[lane..]);
            let (apart, own) = pairs_of_records.load::<V>(0, lane);
            let chosen = V::mask(0b1011_0010 >> lane);
            let both = V::load_pairs(&pairs[lane..]);
            V::store_pairs(both.1, both.0, &mut swapped[lane..]);
            let twos = [0, 2, 4, 6].map(|number| Vectors::of(transposed[number], transposed[number + 1]));
            V::store_records(twos, &mut written[lane..]);
            let made = [
                a + b,
                a - b,
                a * b,
                a / b,
                -a,
                a.sqrt(),
                a.abs(),
                a.copysign(b),
                a.at_least_zero(),
                a.only(chosen),
                V::select(chosen, a, b),
                transposed[0],
                transposed[5],
                transposed[7],
                both.0,
                V::splat(1.5) * both.1,
                apart[0],
                apart[5],
                apart[6],
                apart[7],
                own[0],
                own[1],
            ];
            for (result, made) in results.iter_mut().zip(made) {
                made.store(&mut result[lane..]);
            }
            let masks = [a.lt(b), a.gt(b), !chosen, chosen & a.lt(b), chosen | a.lt(b)];
            let kept = ((1_u16 << V::COUNT) - 1) as u8;
            for (bits, mask) in bits.iter_mut().zip(masks) {
                *bits |= (V::bits(mask) & kept) << lane;
            }
            lane += V::COUNT;
        }
        let swapped = swapped.iter().flat_map(|pair| [pair.x, pair.y]);
        let written = written.into_iter().flat_map(|record| record.0);
        let numbers = results.into_iter().flatten().chain(swapped).chain(written).map(f64::to_bits);
        numbers.chain(bits.map(u64::from)).collect()
    }
}

/// Promise: all levels give the same bits. A NaN may have any of its bit patterns.
#[test]
fn all_levels_give_the_same_bits() {
    let numbers = [1.0 / 3.0, -0.0, f64::MIN_POSITIVE / 8.0, -2.5e300, f64::INFINITY, f64::NAN, 7.0, 0.0];
    let others = [-1.0 / 7.0, 0.0, 3.0, 2.5e300, 1.0, 1.0, 7.0, -0.0];
    let same = |bits: &u64| if f64::from_bits(*bits).is_nan() { u64::MAX } else { *bits };
    let expected = run(Level::Scalar, Everything { numbers: &numbers, others: &others });
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        let found = run(level, Everything { numbers: &numbers, others: &others });
        assert!(found.iter().map(same).eq(expected.iter().map(same)), "{level}: {found:x?}, not {expected:x?}");
    }
    // The scalar level itself.
    assert_eq!(f64::from_bits(expected[0]), 1.0 / 3.0 - 1.0 / 7.0);
    assert_eq!(expected[expected.len() - 5], 0b0000_1100);
}

/// Promise: if only the records of a few indices are listed, pairs keep their sides and bodies their indices.
#[test]
fn records_that_stand_elsewhere_are_found() {
    let record = |index: u32| Record(std::array::from_fn(|column| f64::from(index * 10) + column as f64));
    let listed = [(2, 9), (4, 2), (9, 11)];
    let mut pairs = PairBlocks::default();
    pairs.list(listed.into_iter());
    let all: Vec<Record> = (0..12).map(record).collect();
    let expected: Vec<_> = (0..3).map(|lane| pairs.records(&all).load::<f64>(0, lane)).collect();
    let needed = [2, 4, 9, 11];
    let mut of = [0; 12];
    (0..).zip(needed).for_each(|(index, needed)| of[needed as usize] = index);
    pairs.find_records(&of, needed.len());
    let few: Vec<Record> = needed.into_iter().map(record).collect();
    let sides = pairs.records(&few);
    assert_eq!((0..3).map(|lane| sides.load::<f64>(0, lane)).collect::<Vec<_>>(), expected);
    assert_eq!([0, 1, 2].map(|lane| sides.pairs(0).get(lane)), listed);
    assert_eq!([0, 1, 2].map(|lane| pairs.side(0).get(lane)), [(0, 2), (1, 0), (2, 3)]);
    pairs.list(listed.into_iter());
    assert_eq!(pairs.side(0).get(1), (4, 2));
}

#[test]
#[should_panic(expected = "a pair of what is not there")]
fn records_that_are_not_there_are_refused() {
    let mut pairs = PairBlocks::default();
    pairs.list([(0, 1)].into_iter());
    pairs.find_records(&[0, 7], 7);
}

#[test]
fn a_level_is_named_by_its_word() {
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        assert_eq!(level.name().parse(), Ok(level));
    }
    assert!("sse9".parse::<Level>().unwrap_err().contains("`avx2`"));
}

/// The pushes of a block of pairs on bodies in a row, and whether they were given.
fn given(indices: [(u32, u32); BLOCK], first: usize, len: usize) -> (bool, Vec<DVec2>) {
    let mut pairs = PairBlocks::default();
    pairs.list(indices.into_iter());
    let records = vec![Record::default(); indices.iter().flat_map(|&(a, b)| [a, b]).max().unwrap() as usize + 1];
    let (mut force, mut torque) = (vec![DVec2::ZERO; len], vec![0.0; len]);
    let pushes = Pushes { force: [DVec2::X; BLOCK], ..Pushes::NONE };
    let done = pushes.give(&pairs.records(&records), 0, u8::MAX, (first, &mut force, &mut torque));
    (done, force)
}

#[test]
fn pushes_reach_no_body_outside_the_row() {
    let indices = std::array::from_fn(|lane| (3 + lane as u32 % 2, 5));
    assert!(given(indices, 3, 3).0);
    assert!(given(indices, 0, 6).0);
    for (first, len) in [(3, 2), (4, 3), (0, 5), (1 << 29, 9), ((1 << 29) - 2, 9), (usize::MAX, 9), (0, 0)] {
        let (done, force) = given(indices, first, len);
        assert!(!done, "{first} {len}");
        assert!(force.iter().all(|force| *force == DVec2::ZERO));
    }
    assert_eq!(given(indices, 3, 3).1, [DVec2::new(-4.0, 0.0), DVec2::new(-4.0, 0.0), DVec2::new(8.0, 0.0)]);
}

/// The message of a call that panics.
fn panics(call: impl FnOnce()) -> bool {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(call)).is_err()
}

#[test]
fn lists_that_cannot_be_leave_nothing_behind_that_kernels_trust() {
    let mut pairs = PairBlocks::default();
    pairs.list([(0, 1), (1, 2)].into_iter());
    assert!(panics(|| pairs.list([(0, 1 << 29)].into_iter())));
    assert!(panics(|| pairs.list([(0, u32::MAX)].into_iter())));
    let _ = pairs.records(&[]);
    pairs.list([(0, 1), (1, 2)].into_iter());
    let listed = [pairs.side(0).get(0), pairs.side(0).get(1)];
    for (of, count) in [(&[0, 1, 3][..], 3), (&[0, 1], 3), (&[0, 1, 1 << 29], 9), (&[0, 1, u32::MAX], usize::MAX)] {
        assert!(panics(|| pairs.find_records(of, count)));
        assert_eq!([pairs.side(0).get(0), pairs.side(0).get(1)], listed);
    }
    pairs.find_records(&[2, 1, 0], 3);
    assert!(panics(|| _ = pairs.records(&[Record::default(); 2])));
    let records: [Record; 3] = std::array::from_fn(|index| Record([index as f64; BLOCK]));
    let (apart, _) = pairs.records(&records).load::<f64>(0, 0);
    assert_eq!(apart[0], -1.0);
}

/// Quads of two lists of indices, and the quads after both sides were written back with other numbers.
struct Swapped<'a>(&'a mut [Quad], &'a QuadPairs);

impl Kernel for Swapped<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let mut paired = self.1.of(self.0);
        for block in 0..self.1.len() {
            let mut lane = 0;
            while lane < BLOCK {
                let [a, b] = paired.load::<V>(block, lane);
                paired.store(block, lane, [[b[1], b[0], b[2] + a[3], b[3]], [a[0], a[1], a[3], a[2] - b[0]]]);
                lane += V::COUNT;
            }
        }
    }
}

#[test]
fn quads_are_loaded_and_stored_alike_at_all_levels() {
    let quads: Vec<Quad> = (0..20).map(|index| Quad(std::array::from_fn(|k| (10 * index + k) as f64))).collect();
    let mut pairs = QuadPairs::default();
    pairs.push([[3, 0, 7, 1, 6, 2, 5, 4], [8, 19, 10, 11, 12, 13, 14, 15]]);
    pairs.push([[16, 17, 18, 9, 1, 2, 3, 4], [5, 6, 7, 8, 10, 11, 12, 13]]);
    let results: Vec<Vec<Quad>> = (Level::ALL.into_iter().filter(|level| level.is_available()))
        .map(|level| {
            let mut quads = quads.clone();
            run(level, Swapped(&mut quads, &pairs));
            quads
        })
        .collect();
    // Index 0 occurs in one pair, as the first with 19. It has the numbers that the kernel makes of both.
    assert_eq!(results[0][0], Quad([191.0, 190.0, 195.0, 193.0]));
    assert_eq!(results[0][19], Quad([0.0, 1.0, 3.0, -188.0]));
    assert!(results.iter().all(|result| *result == results[0]));
}

#[test]
#[should_panic(expected = "a pair of what is not there")]
fn quads_that_are_not_there_are_refused() {
    let mut pairs = QuadPairs::default();
    pairs.push([[0; BLOCK], [3; BLOCK]]);
    run(Level::Scalar, Swapped(&mut [Quad::default(); 3], &pairs));
}
