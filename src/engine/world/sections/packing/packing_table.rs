//! The table of a packing: comma-separated values, a line for each atom, in SI units.

use std::borrow::Cow;
use std::collections::BTreeMap;

use glam::DVec2;

use crate::scene::{cells, count, drop_empty_ends, exact, separator, suggest};
use crate::shapes::AtomSpec;
use crate::shapes::mass_properties::{self, InertiaRule, MassProperties};

/// The columns that there are. The first three are needed.
pub const COLUMNS: [&str; 8] = ["x", "y", "radius", "vx", "vy", "spin", "angle", "body"];
const NEEDED: usize = 3;
/// Atoms of one body may deviate from rigid motion by this share of the greatest speed in the table. Numbers of three
/// digits deviate less.
const RIGID: f64 = 0.01;

/// One line of a table: one atom.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Row {
    position: DVec2,
    radius: f64,
    velocity: DVec2,
    spin: f64,
    angle: f64,
    line: usize,
}

/// The atoms of a packing, body by body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PackingTable {
    rows: Vec<Row>,
    /// The first row of each body, and the number of rows at the end.
    first: Vec<usize>,
    /// Whether the table gives the spin of bodies. Otherwise the velocities of their atoms give it.
    has_spin: bool,
}

/// A mistake in a table: where, what, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableMistake {
    /// Number of the line, from one.
    pub line: usize,
    /// The name of the column, unless it is the line as a whole.
    pub column: Option<String>,
    /// The mistake.
    pub why: String,
    /// The remedy.
    pub help: String,
}

/// One body of a packing as it starts.
#[derive(Clone, Debug, PartialEq)]
pub struct PackedBody {
    /// Centre of mass, in m.
    pub position: DVec2,
    /// Angle, in rad.
    pub angle: f64,
    /// Velocity of the centre of mass, in m/s.
    pub velocity: DVec2,
    /// Spin, in rad/s.
    pub spin: f64,
    /// Mass, moment of inertia and atoms.
    pub properties: MassProperties,
}

fn wrong(line: usize, column: Option<&str>, why: impl Into<String>, help: impl Into<String>) -> TableMistake {
    TableMistake { line, column: column.map(str::to_owned), why: why.into(), help: help.into() }
}

impl PackingTable {
    /// Reads a table of at most `most` rows.
    ///
    /// # Errors
    /// The first mistake in it.
    pub fn read(text: &str, most: u64) -> Result<Self, TableMistake> {
        let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
        let mut lines = lines.map(|(index, line)| (index + 1, line.trim()));
        let mut lines = lines.by_ref().filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let needed = "the first line names the columns: `x,y,radius`, and any of `vx,vy,spin,angle,body`";
        let Some((line, header)) = lines.next() else { return Err(wrong(1, None, "holds nothing", needed)) };
        let separator = separator(header);
        let columns = columns(line, header, separator, needed)?;
        let has = |name: &str| columns.iter().any(|&column| COLUMNS[column] == name);
        let (has_spin, has_body) = (has("spin"), has("body"));
        for (there, missing) in [("vx", "vy"), ("vy", "vx")] {
            if has(there) && !has(missing) {
                let why = format!("is missing, although there is `{there}`");
                let help =
                    format!("add the column `{missing}`, of zeros if nothing moves that way; or remove `{there}`");
                return Err(wrong(line, Some(missing), why, help));
            }
        }
        let mut rows = Vec::new();
        let mut bodies: Vec<usize> = Vec::new();
        let mut known: BTreeMap<i64, usize> = BTreeMap::new();
        // Lines of nothing but separators are what programs make of empty ones.
        for (line, text) in
            lines.filter(|(_, text)| text.chars().any(|letter| letter != separator && !letter.is_whitespace()))
        {
            if rows.len() as u64 == most {
                return Err(wrong(line, None, format!("is one atom too many: the limit is {most}"), "keep fewer rows"));
            }
            let values = numbers(line, text, separator, &columns)?;
            let [x, y, radius, vx, vy, spin, angle, body] = values;
            if radius <= 0.0 {
                let why = format!("must be above zero, got {}", exact(radius));
                return Err(wrong(line, Some("radius"), why, "give each atom a radius in metres"));
            }
            let body = if has_body {
                if body.fract() != 0.0 || body.abs() > 9e15 {
                    let why = format!("must be a whole number, got {body}");
                    return Err(wrong(line, Some("body"), why, "rows of the same number form one rigid body"));
                }
                let next = known.len();
                *known.entry(body as i64).or_insert(next)
            } else {
                rows.len()
            };
            bodies.push(body);
            rows.push(Row { position: DVec2::new(x, y), radius, velocity: DVec2::new(vx, vy), spin, angle, line });
        }
        if rows.is_empty() {
            return Err(wrong(line, None, "is followed by no row", "write a row of numbers for each atom"));
        }
        let table = Self::grouped(rows, &bodies, has_spin);
        table.bodies_are_rigid()?;
        Ok(table)
    }

    /// Puts the rows of each body side by side, bodies in the order of their first rows.
    fn grouped(rows: Vec<Row>, bodies: &[usize], has_spin: bool) -> Self {
        let count = bodies.iter().max().map_or(0, |last| last + 1);
        let mut first = vec![0; count + 1];
        for &body in bodies {
            first[body + 1] += 1;
        }
        for body in 0..count {
            first[body + 1] += first[body];
        }
        let mut next = first.clone();
        let mut sorted = vec![Row::default(); rows.len()];
        for (row, &body) in rows.into_iter().zip(bodies) {
            sorted[next[body]] = row;
            next[body] += 1;
        }
        Self { rows: sorted, first, has_spin }
    }

    /// The number of atoms that it holds.
    pub fn atom_count(&self) -> usize {
        self.rows.len()
    }

    /// The number of bodies that they form.
    pub fn body_count(&self) -> usize {
        self.first.len() - 1
    }

    /// Centre and radius of each atom.
    pub fn discs(&self) -> impl Iterator<Item = (DVec2, f64)> {
        self.rows.iter().map(|row| (row.position, row.radius))
    }

    fn rows_of(&self, body: usize) -> &[Row] {
        &self.rows[self.first[body]..self.first[body + 1]]
    }

    /// A body, made of a material of that density in kg/m2.
    pub fn body(&self, body: usize, density: f64) -> PackedBody {
        let rows = self.rows_of(body);
        let (origin, angle) = (rows[0].position, rows[0].angle);
        let (sine, cosine) = libm::sincos(angle);
        let direction = DVec2::new(cosine, sine);
        // In the frame of the body. Differences come first, so that a lone disc lies exactly in its middle.
        let spec = |row: &Row| AtomSpec {
            offset: DVec2::new(cosine, -sine).rotate(row.position - origin),
            radius: row.radius,
            mass: None,
            stiffness: None,
        };
        let specs: Vec<AtomSpec> = rows.iter().map(spec).collect();
        let properties = mass_properties::of(&specs, None, InertiaRule::Discs, density);
        let position = origin + direction.rotate(properties.center);
        if rows.len() == 1 {
            return PackedBody { position, angle, velocity: rows[0].velocity, spin: rows[0].spin, properties };
        }
        // Of rigid motion: its mean, and its turn about the mean.
        let weight = |row: &Row| row.radius * row.radius;
        let sum: f64 = rows.iter().map(weight).sum();
        let velocity = rows.iter().map(|row| weight(row) * row.velocity).sum::<DVec2>() / sum;
        let spin = if self.has_spin {
            rows[0].spin
        } else {
            let arm = |row: &Row| row.position - position;
            let turn: f64 = rows.iter().map(|row| weight(row) * arm(row).perp_dot(row.velocity - velocity)).sum();
            let size: f64 = rows.iter().map(|row| weight(row) * arm(row).length_squared()).sum();
            if size > 0.0 { turn / size } else { 0.0 }
        };
        PackedBody { position, angle, velocity, spin, properties }
    }

    /// All atoms of a body have its spin and angle, and move with it.
    fn bodies_are_rigid(&self) -> Result<(), TableMistake> {
        let fastest = self.rows.iter().map(|row| row.velocity.length()).fold(0.0, f64::max);
        for number in 0..self.body_count() {
            let rows = self.rows_of(number);
            let Some((head, rest)) = rows.split_first().filter(|(_, rest)| !rest.is_empty()) else { continue };
            for row in rest {
                for (column, same) in [("spin", row.spin == head.spin), ("angle", row.angle == head.angle)] {
                    if !same {
                        let why = format!("differs from that in line {}, of the same body", head.line);
                        return Err(wrong(row.line, Some(column), why, "all atoms of a body turn as one"));
                    }
                }
            }
            let body = self.body(number, 1.0);
            for row in rows {
                let arm = row.position - body.position;
                let off = (row.velocity - body.velocity - body.spin * arm.perp()).length();
                if off > RIGID * fastest {
                    let why = format!("moves otherwise than the body that it belongs to, by {} m/s", exact(off));
                    let help = "`vx` and `vy` are the velocity of the atom's own centre, as the body moves and turns";
                    return Err(wrong(row.line, None, why, help));
                }
            }
        }
        Ok(())
    }
}

/// The cells of a line, of which at least so many count: empty ones behind them are left out.
fn cells_of(line: usize, text: &str, separator: char, wanted: usize) -> Result<Vec<Cow<'_, str>>, TableMistake> {
    let Some(mut cells) = cells(text, separator) else {
        return Err(wrong(line, None, "has a quote that is not closed", "remove the quote; numbers need none"));
    };
    drop_empty_ends(&mut cells, wanted);
    Ok(cells)
}

/// The index of each column in [`COLUMNS`].
fn columns(line: usize, header: &str, separator: char, needed: &str) -> Result<Vec<usize>, TableMistake> {
    let mut columns = Vec::new();
    for (index, name) in cells_of(line, header, separator, 1)?.iter().map(AsRef::as_ref).enumerate() {
        if name.is_empty() {
            let why = format!("has no name for column {}", index + 1);
            return Err(wrong(line, None, why, "name each column, and leave out those that are none of a packing"));
        }
        if name.parse::<f64>().is_ok() {
            return Err(wrong(line, None, format!("holds no names of columns: `{name}` is a number"), needed));
        }
        let Some(column) = COLUMNS.iter().position(|known| *known == name) else {
            let help = suggest::among(name, COLUMNS.into_iter(), "columns", '`');
            return Err(wrong(line, Some(name), "is no column of a packing", help));
        };
        if columns.contains(&column) {
            return Err(wrong(line, Some(name), "stands there twice", "remove one of the two columns"));
        }
        columns.push(column);
    }
    match (0..NEEDED).find(|column| !columns.contains(column)) {
        Some(missing) => Err(wrong(line, Some(COLUMNS[missing]), "is missing", needed)),
        None => Ok(columns),
    }
}

/// The numbers of a line, in the order of [`COLUMNS`]; zero if the table has no such column.
fn numbers(line: usize, text: &str, separator: char, columns: &[usize]) -> Result<[f64; COLUMNS.len()], TableMistake> {
    let mut values = [0.0; COLUMNS.len()];
    let cells = cells_of(line, text, separator, columns.len())?;
    if cells.len() != columns.len() {
        let why = format!("has {}, not {}", count(cells.len(), "value", "values"), columns.len());
        return Err(wrong(line, None, why, "each row has a value for each column"));
    }
    for (cell, &column) in cells.iter().zip(columns) {
        let wrong = |why: String, help| wrong(line, Some(COLUMNS[column]), why, help);
        values[column] = match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => value,
            Ok(_) => {
                return Err(wrong(
                    format!("must be a finite number, got `{cell}`"),
                    "look for the cause in the program that made the table",
                ));
            }
            Err(_) if cell.is_empty() => {
                return Err(wrong("is empty".to_owned(), "each row has a value for each column"));
            }
            Err(_) => {
                let help = "numbers are in SI units and without them, with a decimal point, such as `0.02`";
                return Err(wrong(format!("is not a number: `{cell}`"), help));
            }
        };
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<PackingTable, TableMistake> {
        PackingTable::read(text, 4)
    }

    #[test]
    fn columns_stand_in_any_order() {
        let table = read("# settled\n radius, y,x ,vy,vx\n\n0.5,2,1,-3,7\r\n0.25,4,3,0,0\n").unwrap();
        assert_eq!((table.atom_count(), table.body_count()), (2, 2));
        let body = table.body(0, 4.0 / std::f64::consts::PI);
        assert_eq!((body.position, body.velocity), (DVec2::new(1.0, 2.0), DVec2::new(7.0, -3.0)));
        // A disc of density 4/pi and radius 1/2: m = 1 and I = m r2/2.
        assert_eq!((body.properties.mass, body.properties.inertia), (1.0, 0.125));
        assert_eq!(table.body(1, 1.0).position, DVec2::new(3.0, 4.0));
    }

    /// Spreadsheets write names and numbers in quotes, semicolons, tabs, and separators at the ends of lines and in empty lines.
    #[test]
    fn tables_of_other_programs_are_read() {
        let plain = read("x,y,radius\n1,2,0.5\n3,4,0.25\n").unwrap();
        for text in [
            "\"x\",\"y\",\"radius\"\n\"1\",\"2\",\"0.5\"\n3,4,0.25\n",
            "x,y,radius,\n1,2,0.5,\n3,4,0.25,\n",
            "x,y,radius\n1,2,0.5,,\n3,4,0.25\n,,\n",
            "x;y;radius\n1;2;0.5\n3;4;0.25;\n",
            "x\ty\tradius\n1\t2\t0.5\n3\t4\t0.25\n",
        ] {
            assert_eq!(read(text), Ok(plain.clone()), "{text:?}");
        }
    }

    /// Two equal atoms turn about their middle with 2 rad/s while it moves with (1, 0). Atoms of one body need not
    /// follow each other. All numbers are exact.
    #[test]
    fn rows_of_one_number_form_a_rigid_body() {
        let rows = "7,0,0,0.5,1,-2\n3,9,9,0.5,0,0\n7,2,0,0.5,1,2\n";
        let table = read(&format!("body,x,y,radius,vx,vy\n{rows}")).unwrap();
        assert_eq!((table.atom_count(), table.body_count()), (3, 2));
        let body = table.body(0, 1.0);
        assert_eq!((body.position, body.velocity, body.spin), (DVec2::X, DVec2::X, 2.0));
        assert_eq!(body.properties.atoms[1].offset, DVec2::X);
        assert_eq!(table.body(1, 1.0).position, DVec2::splat(9.0));
    }

    /// The column takes precedence, and it is checked against the velocities.
    #[test]
    fn a_spin_has_to_go_with_the_velocities() {
        let table =
            |spin: &str| read(&format!("x,y,radius,vx,vy,spin,body\n0,0,1,0,-2,{spin},1\n2,0,1,0,2,{spin},1\n"));
        assert_eq!(table("2.001").map(|table| table.body(0, 1.0).spin), Ok(2.001));
        assert_eq!(table("2.1").map_err(|wrong| wrong.line), Err(2));
    }

    /// A turned body keeps its atoms at the positions of the table.
    #[test]
    fn an_angle_turns_the_frame_and_not_the_atoms() {
        let table = read("x,y,radius,angle,body\n1,1,0.5,1.2,0\n1,4,0.5,1.2,0\n").unwrap();
        let body = table.body(0, 1.0);
        let (sine, cosine) = libm::sincos(body.angle);
        let there = body.position + DVec2::new(cosine, sine).rotate(body.properties.atoms[1].offset);
        // Rounding of a turn there and back, of lengths of a few metres.
        assert!((there - DVec2::new(1.0, 4.0)).length() < 1e-14, "{there}");
        assert_eq!(body.angle, 1.2);
    }

    #[test]
    fn mistakes_are_told_with_line_and_column() {
        for (text, line, column, why) in [
            ("", 1, None, "holds nothing"),
            ("1,2,3\n", 1, None, "holds no names of columns"),
            ("x,y\n1,2\n", 1, Some("radius"), "is missing"),
            ("x,y,radius,mass\n", 1, Some("mass"), "is no column"),
            ("x,y,radius,x\n", 1, Some("x"), "stands there twice"),
            ("x,y,radius\n", 1, None, "is followed by no row"),
            ("x,y,radius\n\n1,2,a\n", 3, Some("radius"), "is not a number: `a`"),
            ("x,y,radius\n1,inf,1\n", 2, Some("y"), "must be a finite number"),
            ("x,y,radius\n1,2,0\n", 2, Some("radius"), "must be above zero"),
            ("x,y,radius\n1,2\n", 2, None, "has 2 values, not 3"),
            ("x,y,radius\n1\n", 2, None, "has 1 value, not 3"),
            ("x,y,radius\n1,2,\n", 2, Some("radius"), "is empty"),
            ("x,,y,radius\n1,2,3,4\n", 1, None, "has no name for column 2"),
            ("\"x,y,radius\n1,2,3\n", 1, None, "has a quote that is not closed"),
            ("x;y;radius\n0,5;1;2\n", 2, Some("x"), "is not a number: `0,5`"),
            ("x,y,radius,vx\n1,2,3,4\n", 1, Some("vy"), "is missing, although there is `vx`"),
            ("vy,x,y,radius\n1,2,3,4\n", 1, Some("vx"), "is missing, although there is `vy`"),
            ("x,y,radius\n1,2,3,4\n", 2, None, "has 4 values, not 3"),
            ("x,y,radius,body\n1,2,3,0.5\n", 2, Some("body"), "must be a whole number"),
            ("x,y,radius,body,angle\n1,2,3,1,0\n4,2,3,1,1\n", 3, Some("angle"), "differs from that in line 2"),
            ("x,y,radius\n1,1,1\n2,2,2\n3,3,3\n4,4,4\n5,5,5\n", 6, None, "is one atom too many"),
        ] {
            let found = read(text).expect_err(text);
            assert_eq!((found.line, found.column.as_deref()), (line, column), "{text:?}");
            assert!(found.why.contains(why), "{text:?}: {}", found.why);
        }
    }
}
