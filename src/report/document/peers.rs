//! Curves of other engines, from the table that `tools/peers/peers` writes.

use crate::work_precision::Peer;

/// The names in its first line, by which the columns are found.
const COLUMNS: [&str; 9] = ["problem", "unit", "engine", "version", "settings", "step", "error", "cpu", "failed"];
/// Problems that the other engines run in the same scene and norm. In all others they use contacts of rigid bodies.
const SAME: [&str; 5] = ["free_flight", "constant_acceleration", "linear_drag", "spring_mass", "incline"];

/// A setting of another engine.
#[derive(Clone, Debug)]
struct Row {
    problem: String,
    engine: String,
    error: f64,
    seconds: f64,
}

/// Settings of other engines.
#[derive(Clone, Debug, Default)]
pub struct Peers(Vec<Row>);

impl Peers {
    /// Reads a table.
    ///
    /// # Errors
    /// The error names the mistake, with its line.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut lines = text.lines().enumerate();
        let head = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
        if head != COLUMNS {
            return Err(format!("line 1: the columns of `tools/peers/peers` are expected: {}", COLUMNS.join(",")));
        }
        let mut rows = Vec::new();
        for (index, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
            let cells = cells(line);
            let [problem, _, engine, version, _, _, error, seconds, failed] = &cells[..] else {
                return Err(format!("line {}: {} columns instead of {}", index + 1, cells.len(), COLUMNS.len()));
            };
            if !failed.is_empty() {
                continue;
            }
            let number = |what: &str, text: &str| {
                text.parse::<f64>().map_err(|_| format!("line {}: {what}: `{text}` is not a number", index + 1))
            };
            rows.push(Row {
                problem: problem.clone(),
                engine: format!("{engine} {version}"),
                error: number("error", error)?,
                seconds: number("cpu", seconds)?,
            });
        }
        Ok(Self(rows))
    }

    /// The curves for a problem: the Pareto front of each engine, from coarse to fine.
    pub fn curves(&self, problem: &str) -> Vec<Peer> {
        let mut peers: Vec<Peer> = Vec::new();
        for row in self.0.iter().filter(|row| row.problem == problem && row.error.is_finite()) {
            let point = (row.error, row.seconds);
            match peers.iter_mut().find(|peer| peer.name == row.engine) {
                Some(peer) => peer.points.push(point),
                None => peers.push(Peer { name: row.engine.clone(), points: vec![point] }),
            }
        }
        for peer in &mut peers {
            peer.points.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.total_cmp(&b.0)));
            let mut least = f64::INFINITY;
            peer.points.retain(|(error, _)| {
                let better = *error < least;
                least = least.min(*error);
                better
            });
        }
        peers
    }

    /// The caption below a diagram with their curves.
    pub fn caption(problem: &str) -> &'static str {
        if SAME.contains(&problem) {
            "Other engines: the same scene and norm. Each engine has its best settings. Times are CPU times of one thread."
        } else {
            "Other engines: the same question for rigid bodies, against the answer for rigid bodies. Jostle's contacts are \
             springs, so its errors are against the answer for springs. Each engine has its best settings. Times are CPU times of one thread."
        }
    }

    /// Whether there are no curves.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// The cells of a line of comma-separated values; quotes are doubled within quotes.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                cells.last_mut().expect("never empty").push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            _ => cells.last_mut().expect("never empty").push(letter),
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "problem,unit,engine,version,settings,step,error,cpu,failed\n";

    #[test]
    fn of_each_engine_stays_what_nothing_of_it_beats() {
        let table = format!(
            "{HEAD}a,m,box2d,3,default,0.1,0.5,1e-5,\na,m,box2d,3,\"{{\"\"n\"\": 1, \"\"m\"\": 2}}\",0.1,0.6,2e-5,\n\
             a,m,box2d,3,default,0.01,0.05,1e-4,\na,m,rapier,1,default,0.1,0.1,1e-5,\nb,m,rapier,1,default,0.1,,,it ended\n"
        );
        let peers = Peers::read(&table).unwrap();
        let curves = peers.curves("a");
        assert_eq!(curves.len(), 2);
        assert_eq!((curves[0].name.as_str(), &curves[0].points[..]), ("box2d 3", &[(0.5, 1e-5), (0.05, 1e-4)][..]));
        assert!(peers.curves("b").is_empty());
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        assert!(Peers::read("x,y\n").unwrap_err().contains("line 1"));
        assert!(Peers::read(&format!("{HEAD}a,m,b\n")).unwrap_err().contains("line 2: 3 columns"));
        assert!(Peers::read(&format!("{HEAD}a,m,b,1,d,0.1,x,1,\n")).unwrap_err().contains("`x` is not a number"));
    }
}
