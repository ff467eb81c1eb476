//! The same cases for this crate and its peers: writes each case to a folder, prints our times.
//!
//! ```text
//! cargo bench --bench model_peers -- FOLDER
//! python benches/peers/gmm.py FOLDER
//! python benches/peers/inference.py FOLDER
//! ```

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use edifice::model::em::Stopping;
use edifice::model::gmm::{Points, Settings, fit, fit_from};
use edifice::model::network::{Evidence, Network, Variable};
use edifice::rng::{Stream, stream};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use serde_json::json;

type Outcome = Result<(), Box<dyn Error>>;

fn main() -> Outcome {
    let folder = std::env::args().skip(1).find(|a| !a.starts_with("--"));
    let folder = PathBuf::from(folder.ok_or("give a folder for the cases")?);
    fs::create_dir_all(&folder)?;
    for (rows, columns, components, repeats) in [
        (200, 49, 2, 9),
        (20_000, 20, 8, 3),
        (20_000, 49, 5, 3),
        (1_000_000, 8, 5, 1),
    ] {
        mixture(&folder, rows, columns, components, repeats)?;
    }
    let asia = fs::read_to_string("datasets/model/asia.bif")?;
    inference(
        &folder,
        "asia",
        Network::from_bif(&asia)?,
        &["asia", "dysp"],
    )?;
    for (count, parents) in [(37, 3), (100, 2)] {
        let network = random_network(count, parents, &mut stream(7, "network", count as u64))?;
        inference(&folder, &format!("random_{count}"), network, &["v3", "v20"])?;
    }
    Ok(())
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Overlapping clusters with correlated coordinates.
fn clusters(n: usize, d: usize, k: usize, rng: &mut Stream) -> Vec<f64> {
    let centres: Vec<f64> = (0..k * d)
        .map(|_| 1.2 * rng.sample::<f64, _>(StandardNormal))
        .collect();
    let mixing: Vec<f64> = (0..k * d * 3)
        .map(|_| 0.5 * rng.sample::<f64, _>(StandardNormal))
        .collect();
    let mut values = Vec::with_capacity(n * d);
    for _ in 0..n {
        let c = rng.random_range(0..k);
        let shared: [f64; 3] = std::array::from_fn(|_| rng.sample(StandardNormal));
        for j in 0..d {
            let own: f64 = rng.sample(StandardNormal);
            let mixed: f64 = (0..3)
                .map(|s| mixing[(c * d + j) * 3 + s] * shared[s])
                .sum();
            values.push(centres[c * d + j] + mixed + own);
        }
    }
    values
}

fn mixture(folder: &Path, n: usize, d: usize, k: usize, repeats: usize) -> Outcome {
    let mut rng = stream(5, "gmm", n as u64);
    let values = clusters(n, d, k, &mut rng);
    let points = Points::new(d, &values)?;
    let start = Settings {
        restarts: 1,
        stopping: Stopping {
            max_rounds: 0,
            ..Stopping::default()
        },
        ..Settings::default()
    };
    let start = fit(&points, k, &start, &mut rng)?.mixture;
    // scikit-learn's rule: when a round gains less than this, one more M step is the last. Ours
    // makes one more than that, so as to end no lower in spite of its prior.
    let tolerance = 1e-3 * n as f64;
    let until = |gain: f64, max_rounds: usize| Settings {
        stopping: Stopping {
            movement: 0.0,
            gain,
            max_rounds,
        },
        gain: 0.0,
        ..Settings::default()
    };
    let most = 200;
    let small_gain = fit_from(&points, &start, &until(tolerance, most))?;
    let settings = until(0.0, (small_gain.trace.len() + 1).min(most));
    let mut times = Vec::new();
    let mut last = None;
    for _ in 0..repeats {
        let begin = Instant::now();
        last = Some(fit_from(&points, &start, &settings)?);
        times.push(begin.elapsed().as_secs_f64());
    }
    let fitted = last.ok_or("no repeats")?;
    let id = format!("gmm_{n}x{d}_k{k}");
    println!(
        "{id} seconds {:.4} rounds {} log_likelihood {:.6}",
        median(times),
        fitted.trace.len() - 1,
        fitted.log_likelihood
    );
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    fs::write(folder.join(format!("{id}.f64")), bytes)?;
    let case = json!({
        "data": format!("{id}.f64"), "rows": n, "columns": d, "components": k, "repeats": repeats,
        "gain": tolerance, "max_rounds": most,
        "weights": start.weights(),
        "means": (0..k).flat_map(|c| start.mean(c).to_vec()).collect::<Vec<f64>>(),
        "covariances": (0..k).map(|c| start.covariance(c).to_vec()).collect::<Vec<_>>(),
    });
    fs::write(folder.join(format!("{id}.json")), case.to_string())?;
    Ok(())
}

fn random_network<R: Rng>(
    count: usize,
    most: usize,
    rng: &mut R,
) -> Result<Network, Box<dyn Error>> {
    let categories = ["a", "b", "c", "d"];
    let mut sizes = Vec::new();
    let mut variables = Vec::new();
    for i in 0..count {
        let k = rng.random_range(2..=4);
        // Near parents, as in networks drawn by people: the tree width stays small.
        let mut parents: Vec<usize> = (0..rng.random_range(0..=most))
            .filter(|_| i > 0)
            .map(|_| rng.random_range(i.saturating_sub(6)..i))
            .collect();
        parents.sort_unstable();
        parents.dedup();
        let rows: usize = parents.iter().map(|&p| sizes[p]).product();
        let mut table = Vec::new();
        for _ in 0..rows {
            let row: Vec<f64> = (0..k).map(|_| rng.random::<f64>() + 0.01).collect();
            let sum: f64 = row.iter().sum();
            table.extend(row.iter().map(|p| p / sum));
        }
        let names: Vec<String> = parents.iter().map(|p| format!("v{p}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        variables.push(Variable::table(
            &format!("v{i}"),
            &categories[..k],
            &names,
            &table,
        ));
        sizes.push(k);
    }
    Ok(Network::new(variables)?)
}

fn inference(folder: &Path, name: &str, network: Network, observed: &[&str]) -> Outcome {
    let mut given = Evidence::new();
    let mut evidence = serde_json::Map::new();
    for variable in observed {
        let category = network.categories(variable)?[0].clone();
        given = given.is(variable, &category);
        evidence.insert((*variable).to_owned(), json!(category));
    }
    let repeats = 200;
    let mut times = Vec::new();
    for _ in 0..repeats {
        let begin = Instant::now();
        std::hint::black_box(network.marginals(&given)?);
        times.push(begin.elapsed().as_secs_f64());
    }
    println!("net_{name} seconds {:.6}", median(times));
    let mut marginals = serde_json::Map::new();
    for answer in network.marginals(&given)? {
        let names = network.categories(&answer.name)?;
        let row: serde_json::Map<_, _> = names
            .iter()
            .zip(&answer.probabilities)
            .map(|(c, p)| (c.clone(), json!(p)))
            .collect();
        marginals.insert(answer.name.clone(), row.into());
    }
    fs::write(folder.join(format!("net_{name}.bif")), network.to_bif()?)?;
    let case = json!({
        "bif": format!("net_{name}.bif"), "evidence": evidence, "marginals": marginals,
        "repeats": repeats,
    });
    fs::write(folder.join(format!("net_{name}.json")), case.to_string())?;
    Ok(())
}
