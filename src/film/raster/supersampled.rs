//! Comparison of small pictures, one shape each, with supersampling: 16 x 16 samples in each pixel, mixed as light.
//!
//! Tolerance: the distance to an edge replaces the share of the pixel behind it. The worst straight edge is at 45
//! degrees. Its share is `(1/sqrt 2 - d)^2` at the distance d, and differs from `1/2 - d` by at most 0.043. A pixel
//! that two edges cross (a line and its fill) may have that twice. Each time the contrast is at most 255, which makes
//! 22 levels. The samples miss an edge by up to a 32nd of a pixel, on average far less: 4 levels. Together that is 26.
//! At a kink between two arcs a quarter of the pixel may be missed, because two edges share it. That adds 64 levels
//! within 1.5 pixels of the kink. Differences are those of light and not of sRGB values. In the dark up to five sRGB
//! values share one level of light. Not tested: text and lines drawn by tiny-skia.

use glam::DVec2;
use tiny_skia::Pixmap;

use super::canvas::{Canvas, Ink, fill};
use super::layers::{arrows, walls};
use super::silhouette::{Field, Silhouette, Stand};
use super::{Camera, Theme};
use jostle_frames::frame::{Disc, Rgb, WallLook};

/// Levels of light of 255; see above.
const TOLERANCE: f64 = 26.0;
const AT_KINKS: f64 = TOLERANCE + 64.0;

const PAPER: Rgb = Rgb(250, 249, 246);
const INK: Ink = Ink { fill: Rgb(86, 180, 233), outline: Rgb(30, 36, 48), width: 2.0 };
const SIDE: u32 = 48;

fn light(value: u8) -> f64 {
    let s = f64::from(value) / 255.0;
    255.0 * if s <= 0.04045 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) }
}

/// A picture that `draw` makes on paper.
fn drawn(draw: impl Fn(&mut Pixmap)) -> Pixmap {
    let mut picture = Pixmap::new(SIDE, SIDE).expect("small");
    fill(picture.data_mut(), PAPER);
    draw(&mut picture);
    picture
}

/// The largest difference of light from a colour that is known at each point (pixels, y down). One value is for points
/// away from the kinks, the other for points near them.
fn errors(picture: &Pixmap, kinks: &[DVec2], truth: impl Fn(DVec2) -> Rgb) -> (f64, f64) {
    let (mut away, mut near) = (0.0_f64, 0.0_f64);
    for (row, column) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column))) {
        let corner = DVec2::new(f64::from(column), f64::from(row));
        let mut wanted = [0.0; 3];
        for sample in 0..256 {
            let place = DVec2::new(f64::from(sample % 16) + 0.5, f64::from(sample / 16) + 0.5) / 16.0;
            let Rgb(red, green, blue) = truth(corner + place);
            for (sum, value) in wanted.iter_mut().zip([red, green, blue]) {
                *sum += light(value) / 256.0;
            }
        }
        let seen = picture.pixel(column, row).expect("inside");
        let seen = [seen.red(), seen.green(), seen.blue()].map(light);
        let error = (0..3).map(|channel| (seen[channel] - wanted[channel]).abs()).fold(0.0, f64::max);
        let middle = corner + DVec2::splat(0.5);
        let kink = kinks.iter().any(|kink| kink.distance(middle) <= 1.5);
        let worst = if kink { &mut near } else { &mut away };
        *worst = worst.max(error);
    }
    (away, near)
}

fn assert_true(what: &str, picture: &Pixmap, kinks: &[DVec2], truth: impl Fn(DVec2) -> Rgb) {
    let (away, near) = errors(picture, kinks, truth);
    assert!(away <= TOLERANCE && near <= AT_KINKS, "{what}: off by {away:.1}, at kinks by {near:.1}");
}

/// The colour of an outlined shape. `inside` decides whether a point lies in the shape after it shrinks by a number of
/// pixels.
fn shaded(ink: &Ink, inside: impl Fn(f64) -> bool) -> Rgb {
    match (inside(0.0), inside(f64::from(ink.width))) {
        (false, _) => PAPER,
        (true, false) => ink.outline,
        (true, true) => ink.fill,
    }
}

/// Whether a point of the picture lies in one of the strips between two discs each, shrunk by so much.
type Inside = Box<dyn Fn(DVec2, f64, &[(usize, usize)]) -> bool>;

/// A body drawn at one pixel per metre, and the function that decides whether a point is inside.
fn body(discs: &[Disc], ink: Ink) -> (Pixmap, Inside) {
    let stand = Stand { x: 21.3, y: 25.6, cosine: 0.8, sine: 0.6 };
    let picture = drawn(|picture| {
        Silhouette::new(discs, &[], 1.0).draw(&stand, &ink, &mut Canvas::new(picture), &mut Field::default());
    });
    let discs = discs.to_vec();
    let inside = move |place: DVec2, shrunk: f64, bonds: &[(usize, usize)]| {
        let (x, y) = (place.x - 21.3, 25.6 - place.y);
        let own = DVec2::new(0.8 * x + 0.6 * y, 0.8 * y - 0.6 * x);
        let near = |&(a, b): &(usize, usize)| {
            let (from, along) = (discs[a].offset, discs[b].offset - discs[a].offset);
            let share = if a == b { 0.0 } else { ((own - from).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
            own.distance(from + share * along) <= discs[a].radius - shrunk
        };
        bonds.iter().any(near)
    };
    (picture, Box::new(inside))
}

fn disc(x: f64, y: f64, radius: f64) -> Disc {
    Disc { offset: DVec2::new(x, y), radius }
}

#[test]
fn a_disc() {
    for (x, y, radius) in [(24.0, 24.0, 12.0), (17.3, 21.8, 9.37), (3.2, 46.5, 6.0), (20.5, 20.5, 3.0)] {
        let picture = drawn(|picture| Canvas::new(picture).disc(x, y, radius, &INK));
        let center = DVec2::new(f64::from(x), f64::from(y));
        assert_true(&format!("disc {x}, {y}, {radius}"), &picture, &[], |place| {
            shaded(&INK, |shrunk| place.distance(center) <= f64::from(radius) - shrunk)
        });
    }
}

/// A line of a third of a pixel is drawn with a third of its light.
#[test]
fn an_outline_thinner_than_a_pixel() {
    let ink = Ink { width: 0.35, ..INK };
    let picture = drawn(|picture| Canvas::new(picture).disc(22.4, 25.7, 14.2, &ink));
    let center = DVec2::new(f64::from(22.4_f32), f64::from(25.7_f32));
    assert_true("thin line", &picture, &[], |place| shaded(&ink, |shrunk| place.distance(center) <= 14.2 - shrunk));
}

/// Two atoms of one body: one silhouette, without a line in the overlap.
#[test]
fn two_overlapping_atoms() {
    let discs = [disc(-6.0, 0.0, 9.0), disc(7.0, 2.0, 7.0)];
    let (picture, inside) = body(&discs, INK);
    // The crossings of the two circles, at both sides of the line: radii 9 and 7, then 7 and 5.
    let mut kinks = Vec::new();
    for shrunk in [0.0, 2.0] {
        let (a, b) = (9.0_f64 - shrunk, 7.0_f64 - shrunk);
        let apart = discs[1].offset - discs[0].offset;
        let along = (apart.length_squared() + a * a - b * b) / (2.0 * apart.length());
        let across = (a * a - along * along).max(0.0).sqrt();
        let unit = apart.normalize();
        for side in [-1.0, 1.0] {
            let own = discs[0].offset + along * unit + side * across * unit.perp();
            kinks.push(DVec2::new(21.3 + 0.8 * own.x - 0.6 * own.y, 25.6 - (0.6 * own.x + 0.8 * own.y)));
        }
    }
    assert_true("two atoms", &picture, &kinks, |place| shaded(&INK, |shrunk| inside(place, shrunk, &[(0, 0), (1, 1)])));
}

/// Atoms of one size that touch are joined by the strip between them: no gap is left at the bond.
#[test]
fn a_rod_of_bonded_atoms() {
    let (picture, inside) = body(&[disc(-14.0, 0.0, 7.0), disc(0.0, 0.0, 7.0), disc(14.0, 0.0, 7.0)], INK);
    assert_true("rod", &picture, &[], |place| shaded(&INK, |shrunk| inside(place, shrunk, &[(0, 1), (1, 2)])));
}

/// A block of 3 x 3 atoms is a square with round corners: nothing shows where its atoms meet.
#[test]
fn an_outlined_block() {
    let discs: Vec<Disc> = (0..9).map(|k| disc(f64::from(k % 3 - 1) * 9.0, f64::from(k / 3 - 1) * 9.0, 4.5)).collect();
    let (picture, inside) = body(&discs, INK);
    // The whole square of centres, grown by a radius.
    let square = |place: DVec2, shrunk: f64| {
        let (x, y) = (place.x - 21.3, 25.6 - place.y);
        let own = DVec2::new(0.8 * x + 0.6 * y, 0.8 * y - 0.6 * x);
        own.distance(own.clamp(DVec2::splat(-9.0), DVec2::splat(9.0))) <= 4.5 - shrunk
    };
    assert_true("block", &picture, &[], |place| shaded(&INK, |shrunk| square(place, shrunk)));
    // Checks the truth itself: the strips along the bonds leave only pinholes of the square open, which are closed.
    let rows = [(0, 2), (3, 5), (6, 8), (0, 6), (1, 7), (2, 8)];
    assert!(inside(DVec2::new(21.3, 25.6), 2.0, &rows));
}

/// A wall that slants: its edge, its line, its band and the ground behind.
#[test]
fn a_wall() {
    let theme = Theme::named("paper").expect("shipped");
    let camera = Camera::look(DVec2::ZERO, f64::from(SIDE), (SIDE, SIDE));
    let (left, right) = (DVec2::new(20.0, 7.0), DVec2::new(-20.0, -13.0));
    let wall = WallLook { name: String::new(), left, right, thickness: None, points: Vec::new(), color: None };
    let picture = drawn(|picture| walls::draw(picture, std::slice::from_ref(&wall), &camera, &theme, 9.0, 1.5));
    let line = Ink { fill: theme.wall, outline: theme.outline.of(theme.wall), width: 1.5 };
    assert_true("wall", &picture, &[], |place| {
        let world = DVec2::new(place.x - 24.0, 24.0 - place.y);
        let along = (right - left).normalize();
        let depth = (world - left).perp_dot(along).abs() * (world - left).perp_dot(along).signum();
        // From the open side the left point is on the left: behind the wall the sign is the other one.
        let behind = -depth;
        if behind > 9.0 { theme.ground } else { shaded(&line, |shrunk| behind >= shrunk) }
    });
}

/// An arrow within its halo, as a polygon of seven corners.
#[test]
fn an_arrow() {
    for (from, to) in [((6.3, 40.2), (41.0, 9.7)), ((5.0, 24.0), (43.0, 24.0)), ((20.0, 30.0), (27.0, 33.0))] {
        let (from, to) = (DVec2::from(from), DVec2::from(to));
        let (color, halo, width) = (Rgb(200, 16, 46), Rgb(255, 255, 255), 2.2);
        let picture = drawn(|picture| arrows::arrow(picture, (from, to), 1, (color, halo), width as f32));
        let scale = (0.6 * from.distance(to) / 5.6).min(width);
        let along = (to - from).normalize();
        let neck = to - along * 5.6 * scale;
        let half = [(from, 0.75), (neck, 0.75), (neck, 2.6), (to, 0.0)];
        let side = |sign: f64| half.map(|(at, aside): (DVec2, f64)| at + sign * aside * scale * along.perp());
        let (one, mut other) = (side(1.0), side(-1.0));
        other.reverse();
        let corners: Vec<DVec2> = one.into_iter().chain(other).collect();
        let edges = || (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]));
        let to_edge = |place: DVec2| {
            let distance = |(a, b): (DVec2, DVec2)| {
                let share = ((place - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
                place.distance(a + share * (b - a))
            };
            edges().map(distance).fold(f64::INFINITY, f64::min)
        };
        let inside = |place: DVec2| {
            let crossed = |(a, b): &(DVec2, DVec2)| {
                (a.y > place.y) != (b.y > place.y) && place.x < a.x + (place.y - a.y) / (b.y - a.y) * (b.x - a.x)
            };
            edges().filter(crossed).count() % 2 == 1
        };
        assert_true("arrow", &picture, &corners, |place| {
            if inside(place) {
                color
            } else if to_edge(place) <= 0.7 * scale {
                halo
            } else {
                PAPER
            }
        });
    }
}

/// The comparison must be able to fail. It finds edges as wide as two pixels, a line half as thick, and a seam between
/// two atoms. It also finds a shape half a pixel aside.
#[test]
fn wrong_pictures_are_found() {
    let center = DVec2::splat(24.0);
    let truth = |place: DVec2| shaded(&INK, |shrunk| place.distance(center) <= 12.0 - shrunk);
    let off = |draw: &dyn Fn(&mut Canvas)| {
        let picture = drawn(|picture| draw(&mut Canvas::new(picture)));
        errors(&picture, &[], truth).0
    };
    assert!(off(&|canvas| canvas.disc(24.0, 24.0, 12.0, &INK)) <= TOLERANCE);
    assert!(off(&|canvas| canvas.disc(24.5, 24.0, 12.0, &INK)) > TOLERANCE);
    assert!(off(&|canvas| canvas.disc(24.0, 24.0, 11.8, &INK)) > TOLERANCE);
    assert!(off(&|canvas| canvas.disc(24.0, 24.0, 12.0, &Ink { width: 1.5, ..INK })) > TOLERANCE);
    // A seam: two atoms drawn one after the other.
    let discs = [disc(-6.0, 0.0, 9.0), disc(7.0, 0.0, 7.0)];
    let (_, inside) = body(&discs, INK);
    let seamed = drawn(|picture| {
        for atom in &discs {
            let (x, y) = (21.3 + 0.8 * atom.offset.x, 25.6 - 0.6 * atom.offset.x);
            Canvas::new(picture).disc(x as f32, y as f32, atom.radius as f32, &INK);
        }
    });
    let (away, _) = errors(&seamed, &[], |place| shaded(&INK, |shrunk| inside(place, shrunk, &[(0, 0), (1, 1)])));
    assert!(away > AT_KINKS, "{away}");
}
