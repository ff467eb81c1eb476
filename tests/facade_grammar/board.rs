//! The leaderboard of costs: its own rows are found again, and none is below the bound of its facade.

use std::collections::BTreeMap;

use edifice::io::facade_json;
use edifice::methods::facade_grammar::{Operations, Settings, infer};
use edifice::unwatched;
use sha2::{Digest, Sha256};

/// Facades of more terminals are not inferred again here.
const SMALL: usize = 150;

fn rows() -> Vec<BTreeMap<String, String>> {
    let text = std::fs::read_to_string("datasets/facade_grammar/leaderboard.csv").unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), header.len(), "{line}");
        let pairs = header.iter().zip(cells);
        pairs
            .map(|(name, cell)| ((*name).to_owned(), cell.to_owned()))
            .collect()
    };
    lines.map(row).collect()
}

#[test]
fn no_cost_is_below_its_bound() {
    let rows = rows();
    let mut facades: BTreeMap<(&str, &str), (&str, &str)> = BTreeMap::new();
    for row in &rows {
        let cost: f64 = row["cost"].parse().unwrap();
        let bounds = rows.iter().filter(|other| {
            ["dataset", "facade", "operations"]
                .iter()
                .all(|key| other[*key] == row[*key])
        });
        for bound in bounds.filter_map(|other| other["lower_bound"].parse::<f64>().ok()) {
            assert!(bound > 0.0 && cost >= bound - 1e-6, "{row:?}");
        }
        let facade = (row["dataset"].as_str(), row["facade"].as_str());
        let content = (row["digest"].as_str(), row["terminals"].as_str());
        assert_eq!(*facades.entry(facade).or_insert(content), content);
    }
    let of = |dataset| facades.keys().filter(|(set, _)| *set == dataset).count();
    assert_eq!(
        ["shipped", "ecp2011", "graz50", "cmp"].map(of),
        [35, 104, 30, 250]
    );
}

#[test]
fn rows_of_small_shipped_facades_are_found_again() {
    let mut again = 0;
    for row in rows() {
        let small = row["terminals"].parse::<usize>().unwrap() <= SMALL;
        if row["dataset"] != "shipped" || row["by"] != "edifice" || !small {
            continue;
        }
        let name = &row["facade"];
        let folder = match name.starts_with("wu2014") {
            true => "datasets/facade_grammar",
            false => "datasets/facade_grammar/layouts",
        };
        let path = format!("{folder}/{name}.facade.json");
        let facade = facade_json::read(path.as_ref()).unwrap();
        let digest = Sha256::digest(facade_json::to_string(&facade));
        let digest: String = digest
            .iter()
            .take(8)
            .map(|byte| format!("{byte:02x}"))
            .collect();
        assert_eq!(digest, row["digest"], "{name}");
        let settings = Settings {
            operations: match row["operations"].as_str() {
                "split" => Operations::split_only(),
                _ => Operations::default(),
            },
            seed: 1,
            ..Settings::default()
        };
        let found = infer(&[facade], &settings, &unwatched).unwrap();
        let near = |value: f64, cell: &str| (value - cell.parse::<f64>().unwrap()).abs() < 1e-6;
        let cost = settings.costs.grammar(&found.grammar);
        assert!(near(cost, &row["cost"]), "{name}: {cost}, {row:?}");
        assert!(
            near(found.lower_bound.unwrap(), &row["lower_bound"]),
            "{row:?}"
        );
        again += 1;
    }
    assert!(again >= 20, "{again} rows");
}
