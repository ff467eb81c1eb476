//! Public Bayesian networks: `cargo bench --bench network_peers -- FOLDER` answers every `*.bif` of a folder without evidence
//! (all posteriors at once, then each by itself, then 1,000 draws), prints our times and writes the posteriors to
//! `NAME.ours.json`, which `networks.py` compares with pyAgrum's.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

use edifice::model::ModelError;
use edifice::model::network::{Evidence, Network};
use edifice::rng::stream;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().skip(1).find(|a| !a.starts_with("--"));
    let Some(folder) = folder else {
        println!("no folder of networks given: nothing to do");
        return Ok(());
    };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(&folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "bif") {
            files.push(path);
        }
    }
    files.sort();
    println!(
        "network,variables,all_seconds,single_slowest,single_refused,refusal_slowest,draws_seconds"
    );
    for path in files {
        answer(&path)?;
    }
    Ok(())
}

fn answer(path: &Path) -> Result<(), Box<dyn Error>> {
    let network = Network::from_bif(&std::fs::read_to_string(path)?)?;
    let nothing = Evidence::new();
    let mut all = String::from("refused");
    let mut fastest = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        if network.marginals(&nothing).is_ok() {
            fastest = fastest.min(start.elapsed().as_secs_f64());
            all = format!("{fastest:.6}");
        }
        if start.elapsed().as_secs_f64() > 5.0 {
            break;
        }
    }
    let names: Vec<String> = network.names().map(str::to_owned).collect();
    let (mut slowest, mut refused, mut refusal) = (0.0_f64, 0, 0.0_f64);
    let mut posteriors = BTreeMap::new();
    for name in &names {
        let start = Instant::now();
        let found = network.marginal(&nothing, name);
        let seconds = start.elapsed().as_secs_f64();
        match found {
            Ok(posterior) => {
                slowest = slowest.max(seconds);
                posteriors.insert(name, posterior);
            }
            Err(ModelError::TooWide { .. }) => {
                refused += 1;
                refusal = refusal.max(seconds);
            }
            Err(error) => return Err(error.into()),
        }
    }
    let start = Instant::now();
    network.sample(&nothing, 1000, &mut stream(1, "draws", 0))?;
    let draws = start.elapsed().as_secs_f64();
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    println!(
        "{name},{},{all},{slowest:.6},{refused},{refusal:.6},{draws:.6}",
        names.len()
    );
    std::fs::write(
        path.with_extension("ours.json"),
        serde_json::to_string(&posteriors)?,
    )?;
    Ok(())
}
