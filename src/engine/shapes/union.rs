//! The exact area of a union of discs, with its centre and polar moment (Green's theorem).
//!
//! By Green's theorem an integral over an area equals one along its boundary. The boundary consists of the arcs of the
//! circles that lie in no other disc. With x = cx + r cos t and y = cy + r sin t,
//!
//! * area = 1/2 of the integral of x dy - y dx,
//! * first moments = 1/2 of the integrals of x^2 dy and -y^2 dx,
//! * polar moment = 1/3 of the integral of x^3 dy - y^3 dx,
//!
//! all of which are polynomials in cos t and sin t. The sums are taken about the middle of the discs, so that a far
//! origin costs no digits.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::AtomSpec;

/// Area, centroid and polar moment about the centroid.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AreaMoments {
    /// In m2.
    pub(crate) area: f64,
    /// In m.
    pub(crate) centroid: DVec2,
    /// In m4.
    pub(crate) polar: f64,
}

/// Whether the moments take more than so many looks at pairs of discs.
pub(crate) fn takes_more(atoms: &[AtomSpec], most: usize) -> bool {
    let mut places: Vec<f64> = atoms.iter().map(|atom| atom.offset.x).collect();
    places.sort_by(f64::total_cmp);
    let widest = atoms.iter().map(|atom| atom.radius).fold(0.0, f64::max);
    let mut looks = 0;
    atoms.iter().any(|atom| {
        let reach = atom.radius + widest;
        let begin = places.partition_point(|other| *other < atom.offset.x - reach);
        looks += places.partition_point(|other| *other <= atom.offset.x + reach).saturating_sub(begin);
        looks > most
    })
}

/// The moments of the area that the atoms cover.
pub(crate) fn area_moments(atoms: &[AtomSpec]) -> AreaMoments {
    let low = atoms.iter().fold(DVec2::INFINITY, |low, atom| low.min(atom.offset));
    let high = atoms.iter().fold(DVec2::NEG_INFINITY, |high, atom| high.max(atom.offset));
    let middle = (low + high) / 2.0;
    let mut discs: Vec<(DVec2, f64)> = atoms.iter().map(|atom| (atom.offset - middle, atom.radius)).collect();
    // Sorted along x, only a window of discs can touch one; the order is a function of the values alone.
    discs.sort_by(|(a, r), (b, s)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(r.total_cmp(s)));
    let widest = discs.iter().map(|(_, radius)| *radius).fold(0.0, f64::max);
    let (mut area, mut first, mut polar) = (0.0, DVec2::ZERO, 0.0);
    for (index, &(center, radius)) in discs.iter().enumerate() {
        let begin = discs.partition_point(|(other, _)| other.x < center.x - radius - widest);
        let end = discs.partition_point(|(other, _)| other.x <= center.x + radius + widest);
        let Some(covered) = covered_arcs(&discs, index, begin..end) else { continue };
        for (from, to) in free_arcs(covered) {
            let arc = Arc { center, radius, from, to };
            area += arc.area();
            first += arc.first_moments();
            polar += arc.polar_moment();
        }
    }
    let centroid = first / area;
    AreaMoments { area, centroid: centroid + middle, polar: polar - area * centroid.length_squared() }
}

/// The parts of a circle that lie in other discs, as angles from -pi to pi; `None`: all of it.
fn covered_arcs(discs: &[(DVec2, f64)], index: usize, near: std::ops::Range<usize>) -> Option<Vec<(f64, f64)>> {
    let (center, radius) = discs[index];
    let mut covered = Vec::new();
    for other_index in near {
        let (other_center, other_radius) = discs[other_index];
        let across = other_center - center;
        let distance = across.length();
        if other_index == index || distance >= radius + other_radius || distance + other_radius < radius {
            continue;
        }
        let same = distance == 0.0 && radius == other_radius;
        if same && index < other_index {
            continue;
        }
        if same || distance + radius <= other_radius {
            return None;
        }
        let cosine = (distance * distance + radius * radius - other_radius * other_radius) / (2.0 * distance * radius);
        let half = libm::acos(cosine.clamp(-1.0, 1.0));
        let direction = libm::atan2(across.y, across.x);
        let (from, to) = (direction - half, direction + half);
        if from < -PI {
            covered.push((from + TAU, PI));
            covered.push((-PI, to));
        } else if to > PI {
            covered.push((from, PI));
            covered.push((-PI, to - TAU));
        } else {
            covered.push((from, to));
        }
    }
    Some(covered)
}

/// The remaining arcs of a circle, from -pi to pi.
fn free_arcs(mut covered: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    covered.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut free = Vec::new();
    let mut at = -PI;
    for (from, to) in covered {
        if from > at {
            free.push((at, from));
        }
        at = at.max(to);
    }
    if at < PI {
        free.push((at, PI));
    }
    free
}

struct Arc {
    center: DVec2,
    radius: f64,
    from: f64,
    to: f64,
}

impl Arc {
    /// The integrals of cos t to cos^4 t and sin t to sin^4 t along the arc.
    fn powers(&self) -> ([f64; 4], [f64; 4]) {
        let at = |t: f64| {
            let (s, c) = libm::sincos(t);
            let (double, fourfold) = (libm::sin(2.0 * t) / 4.0, libm::sin(4.0 * t) / 32.0);
            (
                [s, t / 2.0 + double, s - s * s * s / 3.0, 0.375 * t + double + fourfold],
                [-c, t / 2.0 - double, c * c * c / 3.0 - c, 0.375 * t - double + fourfold],
            )
        };
        let ((c_to, s_to), (c_from, s_from)) = (at(self.to), at(self.from));
        (std::array::from_fn(|n| c_to[n] - c_from[n]), std::array::from_fn(|n| s_to[n] - s_from[n]))
    }

    fn area(&self) -> f64 {
        let ([c1, ..], [s1, ..]) = self.powers();
        let Self { center, radius: r, from, to } = *self;
        0.5 * r * (r * (to - from) + center.x * c1 + center.y * s1)
    }

    fn first_moments(&self) -> DVec2 {
        let ([c1, c2, c3, _], [s1, s2, s3, _]) = self.powers();
        let Self { center: DVec2 { x, y }, radius: r, .. } = *self;
        let along_x = x * x * c1 + 2.0 * x * r * c2 + r * r * c3;
        let along_y = y * y * s1 + 2.0 * y * r * s2 + r * r * s3;
        0.5 * r * DVec2::new(along_x, along_y)
    }

    fn polar_moment(&self) -> f64 {
        let ([c1, c2, c3, c4], [s1, s2, s3, s4]) = self.powers();
        let Self { center: DVec2 { x, y }, radius: r, .. } = *self;
        let along_x = x * x * x * c1 + 3.0 * x * x * r * c2 + 3.0 * x * r * r * c3 + r * r * r * c4;
        let along_y = y * y * y * s1 + 3.0 * y * y * r * s2 + 3.0 * y * r * r * s3 + r * r * r * s4;
        r / 3.0 * (along_x + along_y)
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    fn atoms(discs: &[(f64, f64, f64)]) -> Vec<AtomSpec> {
        let atom = |&(x, y, radius): &(f64, f64, f64)| AtomSpec {
            offset: DVec2::new(x, y),
            radius,
            mass: None,
            stiffness: None,
        };
        discs.iter().map(atom).collect()
    }

    /// Area, centroid and polar moment by counting `count` random points of a square.
    fn counted(atoms: &[AtomSpec], half: f64, count: u32) -> AreaMoments {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut next = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 * half - half;
        let (mut area, mut first, mut polar) = (0.0, DVec2::ZERO, 0.0);
        for _ in 0..count {
            let point = DVec2::new(next(), next());
            if atoms.iter().any(|atom| (atom.offset - point).length() <= atom.radius) {
                area += 1.0;
                first += point;
                polar += point.length_squared();
            }
        }
        let share = 4.0 * half * half / f64::from(count);
        let centroid = first / area;
        AreaMoments { area: area * share, centroid, polar: (polar - area * centroid.length_squared()) * share }
    }

    #[test]
    fn overlapping_discs_agree_with_counting_points() {
        // A ring with a hole, a disc inside another, two equal discs, one apart, one touching from inside.
        let ring: Vec<_> =
            (0..6).map(|k| f64::from(k) * TAU / 6.0).map(|t| (libm::cos(t), libm::sin(t), 0.6)).collect();
        let mut discs = ring;
        discs.extend([(1.0, 0.1, 0.2), (1.0, 0.0, 0.6), (-2.4, -2.0, 0.5), (-2.1, -2.0, 0.2), (0.3, 2.2, 0.5)]);
        let atoms = atoms(&discs);
        let exact = area_moments(&atoms);
        let count = 2_000_000;
        let counted = counted(&atoms, 3.0, count);
        // Five standard deviations of the counts: sqrt(p (1 - p) / n) of the square for the area. For the moments it is
        // the like with lengths up to 3 m.
        let share = exact.area / 36.0;
        let deviation = 36.0 * (share * (1.0 - share) / f64::from(count)).sqrt();
        assert!((exact.area - counted.area).abs() < 5.0 * deviation, "{exact:?} {counted:?}");
        assert!((exact.centroid - counted.centroid).length() < 5.0 * 3.0 * deviation / exact.area);
        assert!((exact.polar - counted.polar).abs() < 5.0 * 9.0 * deviation);
    }

    #[test]
    fn two_discs_have_the_area_of_the_lens_less() {
        let (radius, distance) = (1.0_f64, 1.2_f64);
        let half = libm::acos(distance / (2.0 * radius));
        let lens = 2.0 * radius * radius * half - distance * (radius * radius - distance * distance / 4.0).sqrt();
        let exact = area_moments(&atoms(&[(10.0, 5.0, radius), (10.0 + distance, 5.0, radius)]));
        assert!((exact.area - (TAU - lens)).abs() < 1e-14 * TAU);
        assert!((exact.centroid - DVec2::new(10.6, 5.0)).length() < 1e-14 * 20.0);
    }

    #[test]
    fn place_and_order_do_not_matter() {
        let discs = [(0.0, 0.0, 1.0), (0.5, 0.8, 0.7), (1.2, -0.1, 0.4)];
        let near = area_moments(&atoms(&discs));
        let mut moved = discs.map(|(x, y, radius)| (x + 1024.0, y - 512.0, radius));
        moved.reverse();
        let far = area_moments(&atoms(&moved));
        // Rounding of the moved places: 1e3 times the unit of the last place.
        assert!((near.area - far.area).abs() < 1e-12);
        assert!((near.polar - far.polar).abs() < 1e-12);
        assert!((near.centroid + DVec2::new(1024.0, -512.0) - far.centroid).length() < 1e-12);
    }
}
