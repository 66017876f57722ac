//! Scenes: each is read, and a good one runs and is drawn for some ticks.

use std::path::{Path, PathBuf};

use jostle::scene::Source;

use super::Kind;
use crate::corpus::{self, Corpus};
use crate::mutate::mutant;
use crate::worker::{DRAWN, draw, read_and_run};

struct Scenes(Corpus);

pub fn make(folders: &[PathBuf]) -> std::io::Result<Box<dyn Kind>> {
    Ok(Box::new(Scenes(corpus::read(folders, ".ron")?)))
}

impl Kind for Scenes {
    fn ending(&self) -> &'static str {
        "ron"
    }

    fn mutant(&mut self, seed: u64, number: u64) -> Vec<u8> {
        mutant(&self.0, seed, number).into_bytes()
    }

    fn attempt(&mut self, bytes: &[u8], number: u64, scratch: &Path) {
        let text = String::from_utf8_lossy(bytes);
        // In memory: a mutant names no file of this machine.
        let Some(ran) = read_and_run(&Source::new("mutant.ron", text.as_ref()), number) else { return };
        if number.is_multiple_of(DRAWN) && ran.is_to_be_drawn() {
            let scene = scratch.join("mutant.ron");
            std::fs::write(&scene, bytes).expect("the parent made the scratch folder");
            draw(&scene, &ran, number, scratch);
        }
        ran.mark(number);
    }
}
