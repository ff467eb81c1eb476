//! Bayesian networks: every answer against enumeration of the joint, on random networks.

use edifice_base::rng::stream;
use edifice_model::network::{Evidence, FitSettings, Network, Variable};
use edifice_model::{Cell, ModelError};
use proptest::prelude::*;
use rand::RngExt;

const NAMES: [&str; 6] = ["a", "b", "c", "d", "e", "f"];
const CATEGORIES: [&str; 3] = ["x", "y", "z"];

/// A random discrete network as (sizes, parents, tables), and the same as a [`Network`].
struct Random {
    sizes: Vec<usize>,
    parents: Vec<Vec<usize>>,
    tables: Vec<Vec<f64>>,
    network: Network,
}

fn random(seed: u64) -> Random {
    let mut rng = stream(seed, "network", 0);
    let n = rng.random_range(2..=6);
    let (mut sizes, mut parents, mut tables, mut variables) = (vec![], vec![], vec![], vec![]);
    for (i, name) in NAMES.iter().enumerate().take(n) {
        let k = rng.random_range(2..=3);
        let own: Vec<usize> = (0..i).filter(|_| rng.random::<f64>() < 0.5).collect();
        let rows: usize = own.iter().map(|&p| sizes[p]).product();
        let mut table = Vec::new();
        for _ in 0..rows {
            let mut row: Vec<f64> = (0..k).map(|_| rng.random::<f64>()).collect();
            if rng.random::<f64>() < 0.2 {
                row[0] = 0.0;
            }
            let sum: f64 = row.iter().sum();
            table.extend(row.iter().map(|p| p / sum));
        }
        let names: Vec<&str> = own.iter().map(|&p| NAMES[p]).collect();
        variables.push(Variable::table(name, &CATEGORIES[..k], &names, &table));
        sizes.push(k);
        parents.push(own);
        tables.push(table);
    }
    variables.reverse();
    Random {
        sizes,
        parents,
        tables,
        network: Network::new(variables).unwrap(),
    }
}

impl Random {
    /// Every assignment with its joint probability, straight from the definition.
    fn joint(&self) -> Vec<(Vec<usize>, f64)> {
        let count: usize = self.sizes.iter().product();
        (0..count)
            .map(|mut rest| {
                let mut v = Vec::new();
                for k in &self.sizes {
                    v.push(rest % k);
                    rest /= k;
                }
                let mut p = 1.0;
                for i in 0..v.len() {
                    let row = self.parents[i]
                        .iter()
                        .fold(0, |r, &q| r * self.sizes[q] + v[q]);
                    p *= self.tables[i][row * self.sizes[i] + v[i]];
                }
                (v, p)
            })
            .collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn answers_are_those_of_enumeration(seed in any::<u64>(), observed in 0usize..6, value in 0usize..3) {
        let random = random(seed);
        let observed = observed % random.sizes.len();
        let value = value % random.sizes[observed];
        let given = Evidence::new().is(NAMES[observed], CATEGORIES[value]);
        let mut consistent: Vec<(Vec<usize>, f64)> = random.joint();
        consistent.retain(|(v, p)| v[observed] == value && *p > 0.0);
        let total: f64 = consistent.iter().map(|c| c.1).sum();
        if total == 0.0 {
            let contradiction = matches!(
                random.network.marginals(&given),
                Err(ModelError::Contradiction { ref variable, .. }) if variable == NAMES[observed]
            );
            prop_assert!(contradiction);
            return Ok(());
        }
        prop_assert!((random.network.log_probability(&given).unwrap() - total.ln()).abs() < 1e-9);
        for answer in random.network.marginals(&given).unwrap() {
            let i = NAMES.iter().position(|n| *n == answer.name).unwrap();
            for (k, p) in answer.probabilities.iter().enumerate() {
                let slow: f64 = consistent.iter().filter(|c| c.0[i] == k).map(|c| c.1).sum();
                prop_assert!((slow / total - p).abs() < 1e-9);
            }
        }
        // The most probable explanations, all of them, in order.
        consistent.sort_by(|a, b| b.1.total_cmp(&a.1));
        let best = random.network.explanations(&given, consistent.len() + 1).unwrap();
        prop_assert_eq!(best.len(), consistent.len());
        for (fast, slow) in best.iter().zip(&consistent) {
            prop_assert!((fast.log_joint - slow.1.ln()).abs() < 1e-9);
        }
        let one = random.network.explain(&given).unwrap();
        prop_assert!((one.log_joint - consistent[0].1.ln()).abs() < 1e-9);
        // Both text formats keep every answer.
        let before = random.network.marginals(&given).unwrap();
        for again in [
            Network::from_bif(&random.network.to_bif().unwrap()).unwrap(),
            Network::from_json(&random.network.to_json().unwrap()).unwrap(),
        ] {
            prop_assert_eq!(&again.marginals(&given).unwrap(), &before);
        }
    }
}

/// z -> x (real), z -> w; x -> y (real): a mixture with a linear chain.
fn mixed() -> Network {
    Network::new(vec![
        Variable::table("z", &["no", "yes"], &[], &[0.3, 0.7]),
        Variable::table("w", &["no", "yes"], &["z"], &[0.9, 0.1, 0.4, 0.6]),
        Variable::linear("x", 1, &["z"], &[(&[0.0], &[1.0]), (&[3.0], &[2.0])]),
        Variable::linear(
            "y",
            1,
            &["x", "w"],
            &[(&[1.0, 2.0], &[0.5]), (&[-1.0, 0.5], &[1.5])],
        ),
        Variable::softmax("big", &["no", "yes"], &["x"], &[0.0, 0.0, -1.0, 2.0]),
    ])
    .unwrap()
}

fn normal(x: f64, mean: f64, variance: f64) -> f64 {
    (-(x - mean).powi(2) / (2.0 * variance)).exp() / (2.0 * std::f64::consts::PI * variance).sqrt()
}

#[test]
fn continuous_values_are_integrated_out_exactly() {
    let y = 2.0;
    // p(y, z) by the trapezoid rule over x.
    let slow: Vec<f64> = [(0.3, 0.0, 1.0, 0.1), (0.7, 3.0, 2.0, 0.6)]
        .iter()
        .map(|&(pz, mean, variance, pw)| {
            let step = 1e-3;
            let sum: f64 = (-20_000..20_000)
                .map(|i| {
                    let x = f64::from(i) * step;
                    let given = (1.0 - pw) * normal(y, 1.0 + 2.0 * x, 0.5)
                        + pw * normal(y, -1.0 + 0.5 * x, 1.5);
                    normal(x, mean, variance) * given * step
                })
                .sum();
            pz * sum
        })
        .collect();
    let given = Evidence::new().real("y", &[y]);
    let network = mixed();
    let total: f64 = slow.iter().sum();
    assert!((network.log_probability(&given).unwrap() - total.ln()).abs() < 1e-9);
    let z = network.marginal(&given, "z").unwrap();
    assert!((z[0] - slow[0] / total).abs() < 1e-9);
    let samples = network
        .sample(&given, 40_000, &mut stream(1, "draw", 0))
        .unwrap();
    let draws: Vec<f64> = (0..40_000)
        .map(|i| match samples.column("x").unwrap().cell(i) {
            Cell::Real(v) => v,
            cell => panic!("{cell:?}"),
        })
        .collect();
    let mean = draws.iter().sum::<f64>() / 40_000.0;
    let (exact, variance) = network.moments(&given, "x").unwrap();
    assert!((mean - exact[0]).abs() < 4.0 * (variance[0] / 40_000.0).sqrt());
}

#[test]
fn sigmoids_answer_where_their_parent_is_known() {
    let network = mixed();
    let given = Evidence::new().real("x", &[1.5]);
    let big = network.marginal(&given, "big").unwrap()[1];
    assert!((big - 1.0 / (1.0 + (1.0f64 - 3.0).exp())).abs() < 1e-12);
    assert!(network.marginal(&Evidence::new(), "big").is_err());
    assert!(
        network
            .log_probability(&Evidence::new().is("big", "yes"))
            .is_err()
    );
    assert!(
        network
            .sample(&Evidence::new(), 10, &mut stream(1, "s", 0))
            .is_ok()
    );
}

#[test]
fn asia_has_its_published_posteriors() {
    let text = std::fs::read_to_string("../../datasets/model/asia.bif").unwrap();
    let asia = Network::from_bif(&text).unwrap();
    let yes = |given: &Evidence, name: &str| asia.marginal(given, name).unwrap()[0];
    // Priors as in Lauritzen and Spiegelhalter 1988, Table 1 and every textbook since.
    let none = Evidence::new();
    for (name, p) in [
        ("tub", 0.0104),
        ("lung", 0.055),
        ("bronc", 0.45),
        ("either", 0.064_828),
        ("xray", 0.110_290_04),
        ("dysp", 0.435_970_6),
    ] {
        assert!(
            (yes(&none, name) - p).abs() < 1e-7,
            "{name} {}",
            yes(&none, name)
        );
    }
    // A patient back from Asia, short of breath: P(bronchitis) = 0.81, P(tuberculosis) = 0.09.
    let given = Evidence::new().is("asia", "yes").is("dysp", "yes");
    assert!(
        (yes(&given, "bronc") - 0.811).abs() < 1e-3,
        "{}",
        yes(&given, "bronc")
    );
    assert!(
        (yes(&given, "tub") - 0.088).abs() < 1e-3,
        "{}",
        yes(&given, "tub")
    );
}

#[test]
fn learns_what_made_the_data_with_holes_in_it() {
    let truth = mixed();
    let mut rng = stream(5, "data", 0);
    let data = truth.sample(&Evidence::new(), 3000, &mut rng).unwrap();
    let holes = ["z", "w", "x", "y"];
    let mut seen = edifice_model::Table::new();
    for (j, name) in holes.iter().enumerate() {
        let column = data.column(name).unwrap();
        let keep = |i: usize| !(i + 3 * j).is_multiple_of(7);
        seen = match column.categories() {
            Some(_) => seen.codes(
                name,
                &["no", "yes"],
                (0..3000).map(|i| match column.cell(i) {
                    Cell::Code(c) if keep(i) => Some(c),
                    _ => None,
                }),
            ),
            None => seen.real(
                name,
                (0..3000).map(|i| match column.cell(i) {
                    Cell::Real(v) if keep(i) => Some(v),
                    _ => None,
                }),
            ),
        }
        .unwrap();
    }
    let open = Network::new(vec![
        Variable::discrete("z", &["no", "yes"], &[]),
        Variable::discrete("w", &["no", "yes"], &["z"]),
        Variable::continuous("x", 1, &["z"]),
        Variable::continuous("y", 1, &["x", "w"]),
    ])
    .unwrap();
    let settings = FitSettings {
        restarts: 1,
        ..FitSettings::default()
    };
    let fitted = open.fit(&seen, &settings, &mut rng).unwrap();
    assert!(fitted.trace.windows(2).all(|w| w[1] >= w[0]));
    let z = fitted.network.probabilities("z").unwrap();
    assert!((z[0] - 0.3).abs() < 0.03, "{z:?}");
    let (b, s) = fitted.network.regression("y", 0).unwrap();
    assert!(
        (b[0] - 1.0).abs() < 0.1 && (b[1] - 2.0).abs() < 0.1,
        "{b:?}"
    );
    assert!((s[0] - 0.5).abs() < 0.1, "{s:?}");
}

#[test]
fn a_fit_climbs_the_posterior_and_not_the_likelihood() {
    // Nine of ten; from even odds one round is the mode under Dirichlet(a, a).
    let data = edifice_model::Table::new().binary("garage", (0..10).map(|i| Some(i < 9)));
    let data = data.unwrap();
    let even = Variable::table("garage", &["no", "yes"], &[], &[0.5, 0.5]);
    let even = Network::new(vec![even]).unwrap();
    for dirichlet in [1.5, 4.0] {
        let mut settings = FitSettings::default();
        settings.priors.dirichlet = dirichlet;
        let fitted = even.fit_from(&data, &settings).unwrap();
        let yes = (9.0 + dirichlet - 1.0) / (10.0 + 2.0 * (dirichlet - 1.0));
        let posterior = |yes: f64| {
            (9.0 + dirichlet - 1.0) * yes.ln() + (1.0 + dirichlet - 1.0) * (1.0 - yes).ln()
        };
        let gain = fitted.trace[1] - fitted.trace[0];
        let want = posterior(yes) - posterior(0.5);
        assert!((gain - want).abs() < 1e-9, "{dirichlet}: {gain} for {want}");
    }
}

#[test]
fn bad_networks_are_named() {
    let cyclic = Network::new(vec![
        Variable::discrete("a", &["n", "y"], &["b"]),
        Variable::discrete("b", &["n", "y"], &["a"]),
    ]);
    assert!(matches!(cyclic, Err(ModelError::Cycle { .. })));
    let off = Network::new(vec![Variable::table("a", &["n", "y"], &[], &[0.5, 0.6])]);
    assert!(matches!(off, Err(ModelError::Parameter { name, .. }) if name == "a"));
    let unknown = Network::new(vec![Variable::discrete("a", &["n", "y"], &["q"])]);
    assert!(matches!(unknown, Err(ModelError::Unknown { name }) if name == "q"));
    assert!(matches!(
        Network::from_json("{\"format\""),
        Err(ModelError::Corrupt { .. })
    ));
    let text = std::fs::read_to_string("../../datasets/model/asia.bif").unwrap();
    for cut in (0..text.len()).step_by(23) {
        assert!(Network::from_bif(&text[..cut]).is_err());
    }
    let asia = Network::from_bif(&text).unwrap();
    let none = asia.marginals(&Evidence::new().is("lung", "yes").is("either", "no"));
    assert!(
        matches!(none, Err(ModelError::Contradiction { variable, .. }) if variable == "either")
    );
    let strange = asia.marginals(&Evidence::new().is("lung", "maybe"));
    assert!(matches!(strange, Err(ModelError::UnseenCategory { column, .. }) if column == "lung"));
}

#[test]
fn blocks_come_in_any_order_and_nothing_twice() {
    let blocks = [
        "network n {\n}\n",
        "variable a { type discrete [ 2 ] { n, y }; }\n",
        "variable b { type discrete [ 2 ] { n, y }; }\n",
        "probability ( a ) { table 0.25, 0.75; }\n",
        "probability ( b | a ) { (n) 0.5, 0.5; (y) 0.125, 0.875; }\n",
    ];
    let plain = Network::from_bif(&blocks.concat()).unwrap();
    let order = [0, 4, 1, 3, 2].map(|i| blocks[i]).concat();
    // A byte order mark, as editors write it, is none of the words.
    assert_eq!(
        Network::from_bif(&format!("\u{feff}{order}")).unwrap(),
        plain
    );
    let text = blocks.concat();
    for (from, to, said) in [
        (
            "{ table 0.25, 0.75;",
            "{ table 0.25, 0.75; table 0.5, 0.5;",
            "line 5: `a` has",
        ),
        (
            "(y) 0.125",
            "(n) 0.25, 0.75; (y) 0.125",
            "line 6: `(n)` has probabilities already",
        ),
        (
            "(n) 0.5, 0.5;",
            "default 0.5, 0.5; default 0.1, 0.9;",
            "line 6: `b` has `default` twice",
        ),
        (
            "variable b { ",
            "variable b { type discrete [ 2 ] { y, n }; ",
            "line 4: `b` has its",
        ),
        (
            "variable b ",
            "variable a ",
            "line 4: `a` is declared twice",
        ),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text);
        let error = Network::from_bif(&changed).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}
