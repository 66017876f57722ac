//! Files that stand beside a scene, which stays as it is: drawings, tables and pictures.

use std::path::{Path, PathBuf};

use jostle::scene::Source;

use super::Kind;
use crate::bytes;
use crate::corpus::{self, Corpus};
use crate::mutate;
use crate::worker::read_and_run;

/// Scenes that read the file `mutant` with the ending of the kind. Mutants take turns.
struct Beside {
    ending: &'static str,
    hosts: &'static [&'static str],
    seeds: Seeds,
}

/// Files to begin with. Text hosts have their own, or all have the same.
enum Seeds {
    Text(Vec<Corpus>),
    Png(Vec<Vec<u8>>),
}

pub fn drawings(folders: &[PathBuf]) -> std::io::Result<Box<dyn Kind>> {
    let hosts = &[include_str!("../../hosts/svg.ron"), include_str!("../../hosts/svg_unit.ron")];
    Ok(Box::new(Beside { ending: "svg", hosts, seeds: Seeds::Text(vec![corpus::read(folders, ".svg")?]) }))
}

pub fn tables(folders: &[PathBuf]) -> std::io::Result<Box<dyn Kind>> {
    let hosts = &[
        include_str!("../../hosts/csv_course.ron"),
        include_str!("../../hosts/csv_heights.ron"),
        include_str!("../../hosts/csv_packing.ron"),
    ];
    let seeds = ["course.csv", "ground.csv", "grains.csv"].map(|ending| corpus::read(folders, ending));
    let seeds = Seeds::Text(seeds.into_iter().collect::<Result<_, _>>()?);
    Ok(Box::new(Beside { ending: "csv", hosts, seeds }))
}

pub fn pictures(folders: &[PathBuf]) -> std::io::Result<Box<dyn Kind>> {
    let hosts = &[include_str!("../../hosts/png_count.ron"), include_str!("../../hosts/png_radius.ron")];
    Ok(Box::new(Beside { ending: "png", hosts, seeds: Seeds::Png(corpus::read_bytes(folders, ".png")?) }))
}

impl Kind for Beside {
    fn ending(&self) -> &'static str {
        self.ending
    }

    fn mutant(&mut self, seed: u64, number: u64) -> Vec<u8> {
        match &self.seeds {
            Seeds::Text(seeds) => {
                let corpus = &seeds[number as usize % seeds.len()];
                bytes::lines(mutate::mutant(corpus, seed, number), seed, number)
            }
            Seeds::Png(pictures) => bytes::png(pictures, seed, number),
        }
    }

    fn is_text(&self) -> bool {
        matches!(self.seeds, Seeds::Text(_))
    }

    fn attempt(&mut self, mutant: &[u8], number: u64, scratch: &Path) {
        let (file, host) = (scratch.join("mutant").with_extension(self.ending), scratch.join("host.ron"));
        std::fs::write(file, mutant).expect("the parent made the scratch folder");
        // A mutant that is tried alone has no number: each host reads it.
        let count = self.hosts.len() as u64;
        let turns = if number == 0 { 0..count } else { number % count..number % count + 1 };
        for turn in turns {
            std::fs::write(&host, self.hosts[turn as usize]).expect("the parent made the scratch folder");
            let source = Source::read(&host).expect("a scene of the fuzzer can be read");
            if let Some(ran) = read_and_run(&source, number) {
                ran.mark(number);
            }
        }
    }
}
