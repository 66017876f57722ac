//! The program and computer that made a report.

/// Program, compiler, computer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Made {
    /// Lines of name and value.
    pub lines: Vec<(&'static str, String)>,
}

impl Made {
    /// Those of this program and this computer. A program without a commit passes `None`.
    pub fn here(commit: Option<&str>) -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let system = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
        let processor = processor().unwrap_or_else(|| "unknown".to_owned());
        let lines = vec![
            ("jostle", env!("CARGO_PKG_VERSION").to_owned()),
            ("commit", commit.unwrap_or("unknown").to_owned()),
            ("rustc", env!("JOSTLE_RUSTC").to_owned()),
            ("system", system),
            ("processor", format!("{processor}, {cores} cores, {}", jostle_simd::Level::best())),
        ];
        Self { lines }
    }
}

/// The name of the processor, if the system has it in a file.
fn processor() -> Option<String> {
    let told = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = told.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
