//! Whether the colours of the themes differ enough: for dichromats, in print without colour, and as text on its ground.
//!
//! Sources: the vision of dichromats is simulated in linear sRGB with the matrices of Machado, Oliveira, Fernandes.
//! They stand in IEEE TVCG 15, 1291 (2009), table 1, severity 1. Distances of colours are Euclidean in OKLab (Ottosson
//! 2020), where 0.02 is just noticeable (CSS Color Module Level 4). Contrast is that of WCAG 2.2. Not tested: people
//! with three kinds of cones one of which is shifted, because they see more than dichromats. Not tested either: small
//! areas, which all eyes see less well.

use super::Theme;
use jostle_frames::frame::Rgb;

/// Rows for red, green, blue.
type Matrix = [[f64; 3]; 3];

const EYES: [(&str, Matrix); 4] = [
    ("all cones", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    ("protanopia", [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]),
    (
        "deuteranopia",
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    ),
    ("tritanopia", [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]),
];

/// Four just noticeable steps: colours that differ at a glance, not only side by side.
const APART: f64 = 4.0 * 0.02;

fn linear(Rgb(red, green, blue): Rgb) -> [f64; 3] {
    [red, green, blue].map(|channel| {
        let value = f64::from(channel) / 255.0;
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    })
}

fn times(matrix: &Matrix, [x, y, z]: [f64; 3]) -> [f64; 3] {
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

fn oklab(linear: [f64; 3]) -> [f64; 3] {
    const CONES: Matrix = [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ];
    const LAB: Matrix = [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ];
    times(&LAB, times(&CONES, linear).map(f64::cbrt))
}

fn distance(eyes: &Matrix, a: Rgb, b: Rgb) -> f64 {
    let seen = |color| oklab(times(eyes, linear(color)).map(|channel| channel.clamp(0.0, 1.0)));
    let (a, b) = (seen(a), seen(b));
    (0..3).map(|part| (a[part] - b[part]).powi(2)).sum::<f64>().sqrt()
}

fn contrast(a: Rgb, b: Rgb) -> f64 {
    let luminance = |color| {
        let [red, green, blue] = linear(color);
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    };
    let (a, b): (f64, f64) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

fn themes() -> impl Iterator<Item = (&'static str, Theme)> {
    Theme::names().into_iter().map(|name| (name, Theme::named(name).expect("shipped")))
}

fn cycle(theme: &Theme) -> Vec<(String, Rgb)> {
    theme.cycle.iter().map(|name| (name.clone(), theme.color(name).expect("in the palette"))).collect()
}

/// Known values: black and white are 21 to 1. Red, green and blue in OKLab have Ottosson's values, to his three digits.
#[test]
fn the_measures_agree_with_their_sources() {
    let (black, white) = (Rgb(0, 0, 0), Rgb(255, 255, 255));
    assert!((contrast(black, white) - 21.0).abs() < 1e-9);
    for (color, expected) in [
        (white, [1.0, 0.0, 0.0]),
        (Rgb(255, 0, 0), [0.628, 0.225, 0.126]),
        (Rgb(0, 255, 0), [0.866, -0.234, 0.179]),
        (Rgb(0, 0, 255), [0.452, -0.032, -0.312]),
    ] {
        let found = oklab(linear(color));
        assert!((0..3).all(|part| (found[part] - expected[part]).abs() < 6e-4), "{color:?}: {found:?}");
    }
    // Rows of a matrix sum to one: grey stays grey.
    for (eyes, matrix) in EYES {
        assert!(matrix.iter().all(|row| (row.iter().sum::<f64>() - 1.0).abs() < 2e-6), "{eyes}");
    }
}

/// All eyes distinguish the colours that bodies take by turns: at least six of them, all of the cycle.
#[test]
fn the_colours_of_bodies_stay_apart_for_all_eyes() {
    for (name, theme) in themes() {
        let colors = cycle(&theme);
        assert!(colors.len() >= 6, "{name}");
        for (eyes, matrix) in &EYES {
            for (index, (a, first)) in colors.iter().enumerate() {
                for (b, second) in &colors[index + 1..] {
                    let found = distance(matrix, *first, *second);
                    assert!(found >= APART, "{name}: {a} and {b} are {found:.3} apart with {eyes}");
                }
            }
        }
    }
}

/// In print the lightness alone distinguishes the first six colours.
#[test]
fn the_colours_of_print_stay_apart_without_colour() {
    let theme = Theme::named("print").expect("shipped");
    let mut lightness: Vec<f64> = cycle(&theme).iter().map(|(_, color)| oklab(linear(*color))[0]).collect();
    lightness.sort_by(f64::total_cmp);
    for pair in lightness.windows(2) {
        assert!(pair[1] - pair[0] >= APART, "{lightness:?}");
    }
}

/// 4.5 to 1 is level AA for text, 3 to 1 for graphical objects (WCAG 2.2, criteria 1.4.3 and 1.4.11).
#[test]
fn text_and_arrows_stand_out_from_their_ground() {
    for (name, theme) in themes() {
        for ground in [theme.background, theme.ground] {
            for ink in [theme.ink, theme.quiet_ink] {
                assert!(contrast(ink, ground) >= 4.5, "{name}: {ink:?} on {ground:?}: {}", contrast(ink, ground));
            }
            for arrow in [theme.force, theme.velocity] {
                assert!(contrast(arrow, ground) >= 3.0, "{name}: {arrow:?} on {ground:?}");
            }
        }
        let roles = distance(&EYES[0].1, theme.force, theme.velocity);
        assert!(roles >= APART, "{name}: forces and velocities are {roles:.3} apart");
    }
}

/// The outline of a body and the young end of its trail contrast with the background for all eyes. The fill may be as
/// pale as it likes. A trail covers 0.92 of the ground there.
#[test]
fn outlines_and_trails_stand_out_from_the_background() {
    for (name, theme) in themes() {
        for (color, fill) in cycle(&theme) {
            for (eyes, matrix) in &EYES {
                let outline = distance(matrix, theme.outline.of(fill), theme.background);
                let trail = distance(matrix, theme.trail.of(fill), theme.background);
                assert!(outline >= 2.0 * APART, "{name}: outline of {color}: {outline:.3} with {eyes}");
                assert!(trail >= 1.1 * APART, "{name}: trail of {color}: {trail:.3} with {eyes}");
            }
        }
    }
}
