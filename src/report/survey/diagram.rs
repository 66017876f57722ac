//! The work-precision diagram of a problem as SVG: error to the right, cost upwards, both by powers of ten, a curve for each
//! course. What did not run is told in the legend.

use std::fmt::Write;

use super::{Course, Sheet};
use crate::raster::Theme;

const WIDTH: f64 = 880.0;
const HEIGHT: f64 = 460.0;
/// Margins around the plot: left, top, right (the legend), bottom.
const MARGINS: [f64; 4] = [74.0, 16.0, 290.0, 52.0];
/// Colours of curves, by names of the palette, and how their lines are broken in turn.
const COLORS: [&str; 7] = ["vermilion", "blue", "teal", "purple", "orange", "sky", "brown"];
const DASHES: [&str; 3] = ["", "7 4", "2 4"];
/// Errors below count as this: rounding, and exact zeros.
const LEAST_ERROR: f64 = 1e-16;

/// Powers of ten from below the least to above the greatest.
struct Decades {
    low: f64,
    high: f64,
}

impl Decades {
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = values
            .map(libm::log10)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return Self { low: -1.0, high: 0.0 };
        }
        Self { low: low.floor(), high: high.ceil().max(low.floor() + 1.0) }
    }

    /// From 0 at the lower end to 1 at the upper.
    fn share(&self, value: f64) -> f64 {
        (libm::log10(value) - self.low) / (self.high - self.low)
    }

    /// The powers that are named: not too many of them.
    fn named(&self) -> impl Iterator<Item = i32> {
        let every = ((self.high - self.low) / 8.0).ceil().max(1.0) as i32;
        (self.low as i32..=self.high as i32).filter(move |power| power.rem_euclid(every) == 0)
    }
}

/// The diagram of a sheet.
///
/// # Panics
/// Never: the theme it is drawn in comes with the program.
pub fn diagram(sheet: &Sheet) -> String {
    let theme = Theme::named("paper").expect("it comes with the program");
    let reached = || sheet.cells.iter().filter_map(|cell| cell.outcome.as_ref().ok());
    let errors = Decades::around(reached().map(|reached| reached.error.max(LEAST_ERROR)).chain([1e-2]));
    let costs = Decades::around(reached().map(|reached| reached.cost));
    let [left, top, right, bottom] = MARGINS;
    let (wide, high) = (WIDTH - left - right, HEIGHT - top - bottom);
    let x = |error: f64| left + wide * errors.share(error.max(LEAST_ERROR));
    let y = |cost: f64| top + high * (1.0 - costs.share(cost));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" font-size=\"13\">\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>\n"
    );
    for power in errors.named() {
        let at = x(libm::pow(10.0, f64::from(power)));
        let _ = writeln!(
            svg,
            "<path d=\"M{at:.1} {top}V{:.1}\" stroke=\"#dddddd\"/><text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            top + high,
            top + high + 19.0,
            power_of_ten(power)
        );
    }
    for power in costs.named() {
        let at = y(libm::pow(10.0, f64::from(power)));
        let _ = writeln!(
            svg,
            "<path d=\"M{left} {at:.1}H{:.1}\" stroke=\"#dddddd\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            left + wide,
            left - 8.0,
            at + 4.0,
            power_of_ten(power)
        );
    }
    let unit = if sheet.problem.unit == "1" { String::new() } else { format!(" in {}", sheet.problem.unit) };
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">error{unit}</text>\
         <text transform=\"translate(18 {:.1}) rotate(-90)\" text-anchor=\"middle\">seconds per second of physics</text>",
        left + wide / 2.0,
        HEIGHT - 10.0,
        top + high / 2.0
    );
    for (number, course) in sheet.courses().into_iter().enumerate() {
        let color = theme
            .color(COLORS[number % COLORS.len()])
            .map_or_else(String::new, |color| format!("#{:02x}{:02x}{:02x}", color.0, color.1, color.2));
        let dash = DASHES[number / COLORS.len() % DASHES.len()];
        let points: Vec<(f64, f64)> = sheet
            .of(course)
            .filter_map(|cell| cell.outcome.as_ref().ok().map(|reached| (x(reached.error), y(reached.cost))))
            .collect();
        let line: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\" stroke-dasharray=\"{dash}\"/>",
            line.join(" ")
        );
        for (x, y) in points {
            let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\" fill=\"{color}\"/>");
        }
        let at = top + 12.0 + 19.0 * number as f64;
        let from = left + wide + 18.0;
        let _ = writeln!(
            svg,
            "<path d=\"M{from} {at}h26\" stroke=\"{color}\" stroke-width=\"2\" stroke-dasharray=\"{dash}\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            from + 34.0,
            at + 4.0,
            legend(sheet, course)
        );
    }
    svg.push_str("</svg>\n");
    svg
}

fn legend(sheet: &Sheet, course: Course) -> String {
    let failed = sheet.of(course).filter(|cell| cell.outcome.is_err()).count();
    let all = sheet.of(course).count();
    match failed {
        0 => course.name(),
        failed if failed == all => format!("{}: does not run", course.name()),
        failed => format!("{}: {failed} of {all} fail", course.name()),
    }
}

fn power_of_ten(power: i32) -> String {
    format!("10<tspan dy=\"-5\" font-size=\"10\">{power}</tspan>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_hold_all_values() {
        let decades = Decades::around([3e-5, 0.2].into_iter());
        assert_eq!((decades.low, decades.high), (-5.0, 0.0));
        assert!((decades.share(1e-5)).abs() < 1e-12 && (decades.share(1.0) - 1.0).abs() < 1e-12);
        assert_eq!(decades.named().collect::<Vec<_>>(), [-5, -4, -3, -2, -1, 0]);
        // One value, and none at all.
        assert_eq!(Decades::around([1.0].into_iter()).high, 1.0);
        assert!(Decades::around(std::iter::empty()).high > Decades::around(std::iter::empty()).low);
    }
}
