//! The parts of a known grammar that are found again, without and with noise.

use serde::{Deserialize, Serialize};

use super::data;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::{
    Budget, Component, Mode, Settings, Structure, decompose, from_components,
};
use edifice_cluster::adjusted_rand_index;
use edifice_frame::Context;
use edifice_generators_city_proceduralization as synthetic;
use edifice_grammar::instance::Repeated;
use edifice_report::{Align, Table};

#[derive(Serialize, Deserialize)]
struct Found {
    cuts: f64,
    purity: f64,
    ari: f64,
    motifs: f64,
    types: f64,
    rules: f64,
}

/// Noise in per cent.
const NOISE: [u32; 3] = [0, 1, 3];
/// Greatest distance, in metres, at which a cut found is right.
const CLOSE: f64 = 0.3;

/// Runs both modes at each noise.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let motifs = ctx.budget().choose(60, 500, 500);
    ctx.setting("motifs", motifs);
    let mut units = Vec::new();
    for mode in [Mode::Paper, Mode::Best] {
        units.extend(NOISE.map(|noise| (mode, noise)));
    }
    let key = |u: &(Mode, u32)| format!("{}/{}", data::name(u.0), u.1);
    let results: Vec<Found> = ctx.units(&units, key, |u| recover(u.0, u.1, motifs, seed))?;
    let mut table = Table::new("Recovery of a city of 48 types and 8 motifs")
        .column("mode", Align::Left)
        .numbers([
            "noise, %",
            "cuts",
            "purity",
            "adjusted Rand index",
            "motifs",
            "types of components",
            "rules",
        ]);
    for ((mode, noise), f) in units.iter().zip(&results) {
        for (metric, value) in [
            ("cuts", f.cuts),
            ("purity", f.purity),
            ("adjusted_rand_index", f.ari),
            ("motifs", f.motifs),
            ("types", f.types),
            ("rules", f.rules),
        ] {
            ctx.observe(data::row(
                "synthetic",
                data::name(*mode),
                &noise.to_string(),
                metric,
                value,
                "",
            ));
        }
        table.row([
            data::name(*mode).to_owned(),
            noise.to_string(),
            format!("{:.3}", f.cuts),
            format!("{:.3}", f.purity),
            format!("{:.3}", f.ari),
            format!("{:.0}", f.motifs),
            format!("{:.0}", f.types),
            format!("{:.0}", f.rules),
        ]);
    }
    ctx.table(&table);
    ctx.note("A component's type is, in `best`, its building's type and its storey; the method chooses how many types there are. In `paper` the number of types is given: the known grammar's. A motif is found when what a rule puts down is of its six types of buildings alone, at least one of each.");
    Ok(())
}

fn recover(mode: Mode, noise: u32, motifs: usize, seed: u64) -> Result<Found> {
    let (city, truth) = synthetic::city(motifs, f64::from(noise) / 100.0, seed);
    let decomposition = decompose(&city, true, &unwatched);
    let components = &decomposition.components;
    let mut right = 0;
    for (b, t) in truth.iter().enumerate() {
        let own: Vec<_> = components.iter().filter(|c| c.building == b).collect();
        let found: Vec<f64> = own.iter().skip(1).map(|c| c.frame.base[2]).collect();
        let close = |(a, b): (&f64, &f64)| (a - b).abs() <= CLOSE;
        right += usize::from(found.len() == t.cuts.len() && found.iter().zip(&t.cuts).all(close));
    }
    // The truth of a component: its building's type and its slab.
    let labels: Vec<usize> = components
        .iter()
        .map(|c| truth[c.building].kind * 3 + c.slab.min(2))
        .collect();
    let mut distinct = labels.clone();
    distinct.sort_unstable();
    distinct.dedup();
    let settings = Settings {
        mode,
        budget: Budget::Templates(distinct.len()),
        seed,
        ..Settings::default()
    };
    let made = from_components(&city, decomposition.clone(), &settings, &unwatched)
        .map_err(Error::method)?;
    let (found, rules) = match &made.structure {
        Structure::Tree(tree) => {
            let found: Vec<usize> = made.types.uses.iter().map(|u| u.kind).collect();
            (found, tree.children.clone())
        }
        Structure::Patterns {
            buildings,
            patterns,
        } => {
            let kind = |c: &Component| buildings.labels[c.building].map_or(0, |l| l + 1);
            let slabs = components.iter().map(|c| c.slab + 1).max().unwrap_or(1);
            let found = components.iter().map(|c| kind(c) * slabs + c.slab);
            let rules = expanded(patterns, buildings.count);
            let of_first = |l: &usize| (l + 1) * slabs;
            let rules = rules.iter().map(|r| r.iter().map(of_first).collect());
            (found.collect(), rules.collect())
        }
    };
    // What a type found is in truth: what most of its components are.
    let mut votes = vec![[0usize; synthetic::TYPES]; found.iter().max().map_or(0, |m| m + 1)];
    for (&f, c) in found.iter().zip(components) {
        votes[f][truth[c.building].kind] += 1;
    }
    let kind_of = |t: usize| {
        (0..synthetic::TYPES)
            .max_by_key(|&k| votes[t][k])
            .unwrap_or(0)
    };
    let members = synthetic::TYPES / synthetic::MOTIFS;
    let mut seen = [false; synthetic::MOTIFS];
    for children in &rules {
        let mut kinds: Vec<usize> = children
            .iter()
            .filter(|&&c| c < votes.len())
            .map(|&c| kind_of(c))
            .collect();
        kinds.sort_unstable();
        kinds.dedup();
        let motif = kinds.first().map_or(0, |k| k / members);
        if kinds.len() == members && kinds.iter().all(|k| k / members == motif) {
            seen[motif] = true;
        }
    }
    Ok(Found {
        cuts: right as f64 / truth.len() as f64,
        purity: purity(&found, &labels),
        ari: adjusted_rand_index(&found, &labels),
        types: {
            let mut all = found.clone();
            all.sort_unstable();
            all.dedup();
            all.len() as f64
        },
        rules: rules.len() as f64,
        motifs: seen.iter().filter(|s| **s).count() as f64,
    })
}

/// The types of buildings that each pattern puts down.
fn expanded(patterns: &[Repeated], types: usize) -> Vec<Vec<usize>> {
    let mut out: Vec<Vec<usize>> = Vec::new();
    for pattern in patterns {
        let mut own = Vec::new();
        for m in &pattern.members {
            match m.kind.checked_sub(types) {
                // Members come first.
                Some(other) => own.extend(out[other].clone()),
                None => own.push(m.kind),
            }
        }
        out.push(own);
    }
    out
}

fn table(a: &[usize], b: &[usize]) -> std::collections::BTreeMap<(usize, usize), f64> {
    let mut counts = std::collections::BTreeMap::new();
    for (&x, &y) in a.iter().zip(b) {
        *counts.entry((x, y)).or_insert(0.0) += 1.0;
    }
    counts
}

/// Share of items whose cluster's most frequent label is theirs.
fn purity(found: &[usize], labels: &[usize]) -> f64 {
    let mut most = std::collections::BTreeMap::new();
    for ((cluster, _), n) in table(found, labels) {
        let m: &mut f64 = most.entry(cluster).or_insert(0.0);
        *m = m.max(n);
    }
    most.values().sum::<f64>() / found.len().max(1) as f64
}
