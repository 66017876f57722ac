//! Mixing of colours in linear light. sRGB values (IEC 61966-2-1) pass through two constant tables. So an edge that
//! covers half of a pixel gives half of the light. The bytes are the same on every machine.

use jostle_frames::frame::Rgb;

/// Light of each sRGB value, from 0 to 65535.
static LIGHT: [u16; 256] = light();

/// The sRGB value nearest to each sixteenth step of light. Two neighbouring values are at least 19 steps apart, so every
/// value comes back as itself.
static VALUE: [u8; 4097] = values();

/// From one colour to another, with a share from 0 (the first) to 256 (the second).
pub(super) fn mix(Rgb(red, green, blue): Rgb, to: Rgb, share: u32) -> Rgb {
    Rgb(mix_value(red, to.0, share), mix_value(green, to.1, share), mix_value(blue, to.2, share))
}

/// The same for one channel.
pub(super) fn mix_value(from: u8, to: u8, share: u32) -> u8 {
    let (from, to) = (u32::from(LIGHT[usize::from(from)]), u32::from(LIGHT[usize::from(to)]));
    VALUE[((from * (256 - share) + to * share + (1 << 11)) >> 12) as usize]
}

const fn light() -> [u16; 256] {
    let mut table = [0; 256];
    let mut value = 0;
    while value < 256 {
        let s = value as f64 / 255.0;
        let light = if s <= 0.04045 { s / 12.92 } else { power((s + 0.055) / 1.055) };
        table[value] = (65535.0 * light + 0.5) as u16;
        value += 1;
    }
    table
}

/// `x` to the power 2.4: its square times the fifth root of its square, by Newton's method from above. While the program
/// is compiled there is no other way.
const fn power(x: f64) -> f64 {
    let square = x * x;
    let mut root = 1.0;
    let mut step = 0;
    while step < 40 {
        let fourth = root * root * root * root;
        root -= (root * fourth - square) / (5.0 * fourth);
        step += 1;
    }
    square * root
}

const fn values() -> [u8; 4097] {
    let light = light();
    let mut table = [0; 4097];
    let (mut index, mut value) = (0, 0);
    while index < 4097 {
        while value < 255 && 32 * index as u32 >= light[value] as u32 + light[value + 1] as u32 {
            value += 1;
        }
        table[index] = value as u8;
        index += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The formula of the standard, to half a step of the table.
    #[test]
    fn the_table_is_that_of_the_standard() {
        for (value, light) in LIGHT.iter().enumerate() {
            let s = value as f64 / 255.0;
            let exact = if s <= 0.04045 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) };
            assert!((f64::from(*light) - 65535.0 * exact).abs() <= 0.5 + 1e-6, "{value}: {light}");
        }
    }

    #[test]
    fn every_value_comes_back_and_half_of_the_light_is_in_the_middle() {
        for value in 0..=255 {
            for other in [0, 100, 255] {
                assert_eq!((mix_value(value, other, 0), mix_value(other, value, 256)), (value, value));
            }
        }
        // Half of the light of white is 188 in sRGB, not 128.
        assert_eq!(mix(Rgb(0, 0, 0), Rgb(255, 255, 0), 128), Rgb(188, 188, 0));
    }
}
