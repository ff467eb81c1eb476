//! Structure search on known networks: `cargo bench --bench structure_peers -- FOLDER [ROWS]` draws rows from every `*.bif`
//! of a folder, learns the structure back, prints our times, scores and what of the skeleton is lost and added, and writes the
//! rows to `NAME.csv`, from which `structure.py` learns with pyAgrum and pgmpy.

use std::collections::BTreeSet;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

use edifice::model::network::structure::{Score, SearchSettings, score, search};
use edifice::model::network::{Evidence, Network};
use edifice::model::{Cell, Table};
use edifice::rng::stream;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1).filter(|a| !a.starts_with("--"));
    let Some(folder) = arguments.next() else {
        println!("no folder of networks given: nothing to do");
        return Ok(());
    };
    let rows = arguments.next().map_or(Ok(10_000), |a| a.parse())?;
    let mut files = Vec::new();
    for entry in std::fs::read_dir(&folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "bif") {
            files.push(path);
        }
    }
    files.sort();
    println!("network,score,variables,edges,lost,added,score_found,score_truth,seconds");
    for path in files {
        learn(&path, rows)?;
    }
    Ok(())
}

fn learn(path: &Path, rows: usize) -> Result<(), Box<dyn Error>> {
    let truth = Network::from_bif(&std::fs::read_to_string(path)?)?;
    let mut rng = stream(1, "structure peers", 0);
    let data = truth.sample(&Evidence::new(), rows, &mut rng)?;
    std::fs::write(path.with_extension("csv"), csv(&data))?;
    let names: Vec<&str> = truth.names().collect();
    let mut parents = Vec::new();
    let mut known = BTreeSet::new();
    for (child, name) in names.iter().enumerate() {
        let place = |p: &str| names.iter().position(|n| *n == p).unwrap_or(0);
        let own: Vec<usize> = truth.parents(name)?.into_iter().map(place).collect();
        known.extend(own.iter().map(|&p| (p.min(child), p.max(child))));
        parents.push(own);
    }
    for (label, kind) in [("bdeu", Score::Bdeu(1.0)), ("bic", Score::Bic)] {
        let settings = SearchSettings {
            score: kind,
            ..SearchSettings::default()
        };
        let start = Instant::now();
        let found = search(&data, &settings, 1)?;
        let seconds = start.elapsed().as_secs_f64();
        let place = |name: &String| names.iter().position(|n| n == name).unwrap_or(0);
        let pair = |(p, c): &(String, String)| (place(p), place(c));
        let pairs = found.edges.iter().map(pair);
        let learned: BTreeSet<_> = pairs.map(|(p, c)| (p.min(c), p.max(c))).collect();
        println!(
            "{},{label},{},{},{},{},{:.2},{:.2},{seconds:.3}",
            path.file_stem().unwrap_or_default().to_string_lossy(),
            names.len(),
            known.len(),
            known.difference(&learned).count(),
            learned.difference(&known).count(),
            found.score,
            score(&data, &parents, kind)?
        );
    }
    Ok(())
}

fn csv(data: &Table) -> String {
    let names: Vec<&str> = data.columns().iter().map(|c| c.name()).collect();
    let mut text = names.join(",") + "\n";
    for row in 0..data.rows() {
        let cell = |column: &edifice::model::Column| match column.cell(row) {
            // Numbers, so that no reader takes a category for one; `c` keeps them categories.
            Cell::Code(code) => format!("c{code}"),
            _ => String::new(),
        };
        let cells: Vec<String> = data.columns().iter().map(cell).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}
