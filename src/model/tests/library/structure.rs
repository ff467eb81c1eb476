//! Structure search for discrete networks: scores by definition and by enumeration of all structures, constraints, known
//! networks from samples.

use std::collections::HashMap;

use edifice_base::rng::stream;
use edifice_model::network::structure::{Score, SearchSettings, score, search, search_incomplete};
use edifice_model::network::{Evidence, Network};
use edifice_model::{Cell, ModelError, Table};
use proptest::prelude::*;
use rand::RngExt;
use statrs::function::gamma::ln_gamma;

/// Columns of `sizes` categories, dependent on earlier ones at random.
fn random(sizes: &[usize], rows: usize, seed: u64) -> Table {
    let mut rng = stream(seed, "random table", 0);
    let mut columns: Vec<Vec<usize>> = Vec::new();
    for &size in sizes {
        let parent = (!columns.is_empty()).then(|| rng.random_range(0..columns.len()));
        let column = (0..rows).map(|i| match parent {
            Some(p) if rng.random::<f64>() < 0.6 => columns[p][i] % size,
            _ => rng.random_range(0..size),
        });
        let column = column.collect();
        columns.push(column);
    }
    let names = ["a", "b", "c", "d", "e"];
    let kinds = ["0", "1", "2", "3"];
    let add = |table: Table, (j, column): (usize, &Vec<usize>)| {
        let codes = column.iter().map(|&c| Some(c));
        table.codes(names[j], &kinds[..sizes[j]], codes).unwrap()
    };
    columns.iter().enumerate().fold(Table::new(), add)
}

fn code(data: &Table, column: usize, row: usize) -> usize {
    match data.columns()[column].cell(row) {
        Cell::Code(c) => c,
        _ => panic!("complete"),
    }
}

/// The score of a structure, family by family and row by row, as it is defined.
fn plain_score(data: &Table, sizes: &[usize], parents: &[Vec<usize>], kind: Score) -> f64 {
    let mut total = 0.0;
    for (child, parents) in parents.iter().enumerate() {
        let q: usize = parents.iter().map(|&p| sizes[p]).product();
        let r = sizes[child];
        let mut counts: HashMap<Vec<usize>, Vec<f64>> = HashMap::new();
        for row in 0..data.rows() {
            let key = parents.iter().map(|&p| code(data, p, row)).collect();
            counts.entry(key).or_insert_with(|| vec![0.0; r])[code(data, child, row)] += 1.0;
        }
        for own in counts.values() {
            let n: f64 = own.iter().sum();
            match kind {
                Score::Bic => {
                    let seen = own.iter().filter(|k| **k > 0.0);
                    total += seen.map(|k| k * (k / n).ln()).sum::<f64>();
                }
                Score::Bdeu(ess) => {
                    let (a, a_k) = (ess / q as f64, ess / (q * r) as f64);
                    total += ln_gamma(a) - ln_gamma(a + n);
                    total += own
                        .iter()
                        .map(|k| ln_gamma(a_k + k) - ln_gamma(a_k))
                        .sum::<f64>();
                }
            }
        }
        if kind == Score::Bic {
            total -= 0.5 * ((r - 1) * q) as f64 * (data.rows() as f64).ln();
        }
    }
    total
}

fn acyclic(parents: &[Vec<usize>]) -> bool {
    let mut done = vec![false; parents.len()];
    for _ in 0..parents.len() {
        for v in 0..parents.len() {
            done[v] |= parents[v].iter().all(|&p| done[p]);
        }
    }
    done.iter().all(|d| *d)
}

/// Every acyclic structure over `n` variables.
fn structures(n: usize) -> Vec<Vec<Vec<usize>>> {
    let pairs: Vec<(usize, usize)> = (0..n).flat_map(|a| (0..a).map(move |b| (a, b))).collect();
    let all = (0..3_usize.pow(pairs.len() as u32)).map(|mut which| {
        let mut parents = vec![Vec::new(); n];
        for &(a, b) in &pairs {
            match which % 3 {
                1 => parents[a].push(b),
                2 => parents[b].push(a),
                _ => {}
            }
            which /= 3;
        }
        parents.iter_mut().for_each(|p| p.sort_unstable());
        parents
    });
    all.filter(|p| acyclic(p)).collect()
}

fn parents_of(found: &Network, data: &Table) -> Vec<Vec<usize>> {
    let names: Vec<&str> = data.columns().iter().map(|c| c.name()).collect();
    let place = |name: &str| names.iter().position(|n| *n == name).unwrap();
    let own = |name: &&str| {
        found
            .parents(name)
            .unwrap()
            .into_iter()
            .map(place)
            .collect()
    };
    names.iter().map(own).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn the_search_finds_the_best_of_all_structures(
        sizes in prop::collection::vec(1_usize..4, 1..5),
        rows in 1_usize..120,
        seed in 0_u64..1000,
        bic in any::<bool>(),
    ) {
        let data = random(&sizes, rows, seed);
        let kind = if bic { Score::Bic } else { Score::Bdeu(1.0 + (seed % 7) as f64) };
        let settings = SearchSettings { score: kind, restarts: 5, ..SearchSettings::default() };
        let found = search(&data, &settings, seed).unwrap();
        let parents = parents_of(&found.network, &data);
        prop_assert!(acyclic(&parents));
        let plain = plain_score(&data, &sizes, &parents, kind);
        prop_assert!((plain - found.score).abs() < 1e-6, "{} {}", plain, found.score);
        prop_assert!((score(&data, &parents, kind).unwrap() - plain).abs() < 1e-6);
        let all = structures(sizes.len());
        let most = all.iter().map(|p| plain_score(&data, &sizes, p, kind)).fold(f64::MIN, f64::max);
        prop_assert!(found.score > most - 1e-6, "{} {}", found.score, most);
    }
}

#[test]
fn equivalent_structures_score_alike() {
    let data = random(&[2, 3, 4], 200, 5);
    for kind in [Score::Bic, Score::Bdeu(3.0)] {
        let chain = score(&data, &[vec![], vec![0], vec![1]], kind).unwrap();
        let fork = score(&data, &[vec![1], vec![], vec![1]], kind).unwrap();
        let back = score(&data, &[vec![1], vec![2], vec![]], kind).unwrap();
        assert!((chain - fork).abs() < 1e-6 && (chain - back).abs() < 1e-6);
        let collider = score(&data, &[vec![], vec![0, 2], vec![]], kind).unwrap();
        assert!((collider - chain).abs() > 1e-3);
    }
}

fn asia() -> Network {
    Network::from_bif(include_str!("../../../../datasets/model/asia.bif")).unwrap()
}

fn sampled(network: &Network, rows: usize, seed: u64) -> Table {
    let given = Evidence::new();
    network
        .sample(&given, rows, &mut stream(seed, "sample", 0))
        .unwrap()
}

#[test]
fn the_skeleton_of_asia_comes_back() {
    let truth = asia();
    let data = sampled(&truth, 10_000, 1);
    let found = search(&data, &SearchSettings::default(), 1).unwrap();
    let undirected = |edges: &[(String, String)]| {
        let both = edges
            .iter()
            .map(|(a, b)| (a.min(b).clone(), a.max(b).clone()));
        both.collect::<std::collections::BTreeSet<_>>()
    };
    let mut known = Vec::new();
    for name in truth.names() {
        let parents = truth.parents(name).unwrap();
        known.extend(parents.iter().map(|p| ((*p).to_owned(), name.to_owned())));
    }
    let (known, learned) = (undirected(&known), undirected(&found.edges));
    // A visit to Asia raises tuberculosis from 1 to 5 %, one row in a hundred; `either` is lung cancer or tuberculosis, so
    // that shortness of breath goes with lung cancer nearly as well.
    assert!(known.difference(&learned).count() <= 2, "{learned:?}");
    assert!(learned.difference(&known).count() <= 1, "{learned:?}");
    // The structure found is at least as good as the true one.
    let truth_score = score(
        &data,
        &parents_of(&truth, &data),
        SearchSettings::default().score,
    )
    .unwrap();
    assert!(found.score >= truth_score - 1e-6);
}

/// Rows with holes: the score is the likelihood of what is seen less half a logarithm of the rows for each free number, and moves and
/// families of all rounds are counted.
#[test]
fn the_score_of_rows_with_holes_is_that_of_their_network() {
    let whole = random(&[2, 3, 2], 300, 4);
    let mut seen = Table::new();
    for (j, name) in ["a", "b", "c"].into_iter().enumerate() {
        let sizes = [2, 3, 2];
        let codes = (0..300).map(|i| ((i + j) % 5 > 0).then(|| code(&whole, j, i)));
        seen = seen
            .codes(name, &["0", "1", "2"][..sizes[j]], codes)
            .unwrap();
    }
    let settings = SearchSettings::default();
    let found = search_incomplete(&seen, &settings, 1, &|| true).unwrap();
    let network = &found.network;
    let likelihood: f64 = network.log_likelihood(&seen).unwrap().iter().sum();
    let size = |name: &str| network.categories(name).unwrap().len();
    let free = network.names().map(|name| {
        let parents = network.parents(name).unwrap();
        (size(name) - 1) * parents.into_iter().map(size).product::<usize>()
    });
    let penalty = 0.5 * free.sum::<usize>() as f64 * 300f64.ln();
    assert!((found.score - (likelihood - penalty)).abs() < 1e-6);
    // Several rounds, each of which looks at every family at least.
    let one = search(&whole, &settings, 1).unwrap();
    assert!(found.moves > one.moves && found.families > one.families);
}

#[test]
fn constraints_hold() {
    let data = sampled(&asia(), 2000, 2);
    let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
    let settings = SearchSettings {
        required: vec![pair("dysp", "asia")],
        forbidden: vec![pair("smoke", "lung"), pair("lung", "smoke")],
        tiers: vec![vec!["smoke".into()], vec!["xray".into(), "dysp".into()]],
        most_parents: 2,
        ..SearchSettings::default()
    };
    let found = search(&data, &settings, 1).unwrap();
    assert!(found.edges.contains(&pair("dysp", "asia")));
    for (p, c) in &found.edges {
        let pair = [p.as_str(), c.as_str()];
        assert!(pair != ["smoke", "lung"] && pair != ["lung", "smoke"]);
        assert!(!(c == "smoke" && (p == "xray" || p == "dysp")));
    }
    assert!(
        parents_of(&found.network, &data)
            .iter()
            .all(|p| p.len() <= 2)
    );
    let bad = |change: SearchSettings| search(&data, &change, 1).unwrap_err();
    let circle = vec![pair("asia", "tub"), pair("tub", "asia")];
    let circle = bad(SearchSettings {
        required: circle,
        ..SearchSettings::default()
    });
    assert!(matches!(circle, ModelError::Cycle { .. }), "{circle}");
    let both = bad(SearchSettings {
        required: vec![pair("asia", "tub")],
        forbidden: vec![pair("asia", "tub")],
        ..SearchSettings::default()
    });
    assert!(both.to_string().contains("asia"), "{both}");
    let unknown = bad(SearchSettings {
        forbidden: vec![pair("asia", "nobody")],
        ..SearchSettings::default()
    });
    assert_eq!(
        unknown,
        ModelError::Unknown {
            name: "nobody".into()
        }
    );
    let ess = bad(SearchSettings {
        score: Score::Bdeu(f64::NAN),
        ..SearchSettings::default()
    });
    assert!(matches!(ess, ModelError::Parameter { .. }), "{ess}");
}

#[test]
fn what_cannot_be_counted_is_named() {
    let real = Table::new().real("w", [Some(1.0), Some(2.0)]).unwrap();
    assert!(matches!(
        search(&real, &SearchSettings::default(), 1),
        Err(ModelError::Kind { .. })
    ));
    let missing = Table::new().binary("b", [Some(true), None]).unwrap();
    let error = search(&missing, &SearchSettings::default(), 1).unwrap_err();
    assert_eq!(
        error,
        ModelError::Missing {
            column: "b".into(),
            row: 1
        }
    );
    assert!(search(&Table::new(), &SearchSettings::default(), 1).is_err());
    // One column, and columns that never vary.
    let one = Table::new().binary("b", [Some(true); 3]).unwrap();
    let found = search(&one, &SearchSettings::default(), 1).unwrap();
    assert!(found.edges.is_empty() && found.score.is_finite());
}

#[test]
fn the_same_seed_gives_the_same_structure_with_any_number_of_threads() {
    let data = sampled(&asia(), 1000, 3);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| search(&data, &SearchSettings::default(), 7).unwrap())
    };
    let (one, two) = (with(1), with(2));
    assert_eq!(one.edges, two.edges);
    assert_eq!(one.score.to_bits(), two.score.to_bits());
    assert_eq!(one.network, two.network);
}
