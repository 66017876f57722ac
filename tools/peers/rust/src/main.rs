//! Runs scenes in Rapier and Box2D: a job a line of JSON on standard input, an answer a line on standard output.
//!
//! `tools/peers/peers` writes the jobs. `--versions` prints what was built in.

mod box2d;
mod job;
mod rapier;

use std::error::Error;
use std::io::{BufRead, Write};

use job::{Answer, Job};

fn main() -> Result<(), Box<dyn Error>> {
    if std::env::args().any(|argument| argument == "--versions") {
        let rapier = locked("rapier2d");
        println!(
            "{}",
            serde_json::json!({ "rapier-f32": rapier, "rapier-f64": locked("rapier2d-f64"), "box2d": box2d::version() })
        );
        return Ok(());
    }
    for line in std::io::stdin().lock().lines() {
        let job: Job = serde_json::from_str(&line?)?;
        let answer = match job.engine.as_str() {
            "rapier-f32" => job::run(&job, || rapier::single::world(&job)),
            "rapier-f64" => job::run(&job, || rapier::double::world(&job)),
            "box2d" => job::run(&job, || box2d::world(&job)),
            other => Answer { failed: Some(format!("no engine {other}")), ..Answer::default() },
        };
        println!("{}", serde_json::to_string(&answer)?);
        std::io::stdout().flush()?;
    }
    Ok(())
}

/// The version of a package in the lock file.
fn locked(package: &str) -> String {
    let after = include_str!("../Cargo.lock").split(&format!("name = \"{package}\"\nversion = \"")).nth(1);
    after.and_then(|text| text.split('"').next()).unwrap_or("unknown").to_string()
}
