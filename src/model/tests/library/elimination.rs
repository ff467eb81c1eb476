//! Variable elimination against enumeration, on random factors; approximate answers against exact ones.

use edifice_base::rng::{Stream, stream};
use edifice_model::ModelError;
use edifice_model::elimination::{BucketTree, Factor, Mode, Order};
use edifice_model::network::{Evidence, Network, Variable};
use proptest::prelude::*;
use rand::RngExt;

/// Up to eight factors over up to six variables of one to three categories, a tenth of the cells 0.
fn factors(rng: &mut Stream) -> (Vec<Factor>, Vec<usize>) {
    let n = rng.random_range(1..=6);
    let sizes: Vec<usize> = (0..n).map(|_| rng.random_range(1..=3)).collect();
    let random = |rng: &mut Stream| {
        let mut vars: Vec<usize> = (0..n).collect();
        for i in 0..n {
            vars.swap(i, rng.random_range(0..n));
        }
        vars.truncate(rng.random_range(0..=n.min(3)));
        let cells: usize = vars.iter().map(|&v| sizes[v]).product();
        let value = |rng: &mut Stream| match rng.random::<f64>() < 0.1 {
            true => f64::NEG_INFINITY,
            // Densities far apart, as of Gaussians.
            false => rng.random_range(-2000.0..2.0),
        };
        Factor::new(vars, (0..cells).map(|_| value(rng)).collect())
    };
    let count = rng.random_range(1..=8);
    let all = (0..count).map(|_| random(rng)).collect();
    (all, sizes)
}

/// Every assignment of the variables in factors, with the logarithm of its product.
fn enumerate(factors: &[Factor], sizes: &[usize]) -> Vec<(Vec<usize>, f64)> {
    let used = |v: usize| factors.iter().any(|f| f.vars.contains(&v));
    let count = (0..sizes.len()).map(|v| if used(v) { sizes[v] } else { 1 });
    let count: Vec<usize> = count.collect();
    let all = 0..count.iter().product();
    all.map(|mut rest: usize| {
        let digits = count.iter().map(|k| {
            let digit = rest % k;
            rest /= k;
            digit
        });
        let x: Vec<usize> = digits.collect();
        let value = |f: &Factor| {
            let at = f.vars.iter().fold(0, |i, &v| i * sizes[v] + x[v]);
            f.values[at]
        };
        let log = factors.iter().map(value).sum();
        (x, log)
    })
    .collect()
}

fn log_sum(logs: impl Iterator<Item = f64> + Clone) -> f64 {
    let top = logs.clone().fold(f64::NEG_INFINITY, f64::max);
    match top == f64::NEG_INFINITY {
        true => top,
        false => top + logs.map(|l| (l - top).exp()).sum::<f64>().ln(),
    }
}

fn near(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() < 1e-9 * (1.0 + b.abs())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn sums_maxima_and_marginals_are_those_of_enumeration(seed in any::<u64>()) {
        let (factors, sizes) = factors(&mut stream(seed, "factors", 0));
        let all = enumerate(&factors, &sizes);
        let total = log_sum(all.iter().map(|a| a.1));
        let tree = BucketTree::new(factors.clone(), &sizes, Mode::Sum).unwrap();
        prop_assert!(near(tree.total, total), "{} {total}", tree.total);
        let most = BucketTree::new(factors.clone(), &sizes, Mode::Max).unwrap();
        let top = all.iter().map(|a| a.1).fold(f64::NEG_INFINITY, f64::max);
        prop_assert!(near(most.total, top), "{} {top}", most.total);
        if total == f64::NEG_INFINITY {
            return Ok(());
        }
        let beliefs = tree.beliefs();
        for factor in factors.iter().filter(|f| !f.vars.is_empty()) {
            let joint = beliefs.of(&factor.vars);
            prop_assert_eq!(joint.len(), factor.values.len());
            for (cell, p) in joint.iter().enumerate() {
                let here = |x: &[usize]| factor.vars.iter().fold(0, |i, &v| i * sizes[v] + x[v]) == cell;
                let slow = log_sum(all.iter().filter(|a| here(&a.0)).map(|a| a.1));
                prop_assert!(((slow - total).exp() - p).abs() < 1e-9, "{factor:?} {cell} {p}");
            }
        }
        // All possible assignments, the most probable first, and the first by itself.
        let mut possible: Vec<f64> = all.iter().map(|a| a.1).filter(|l| l.is_finite()).collect();
        possible.sort_by(|a, b| b.total_cmp(a));
        let found = most.best(possible.len() + 1, &vec![0; sizes.len()]);
        prop_assert_eq!(found.len(), possible.len());
        prop_assert!(found.iter().zip(&possible).all(|(f, p)| near(f.0, *p)));
        let mut one = vec![0; sizes.len()];
        most.decode(&mut one);
        prop_assert!(all.iter().any(|(x, log)| *x == one && near(*log, top)));
    }

    #[test]
    fn draws_are_possible_and_follow_the_marginals(seed in any::<u64>()) {
        let mut rng = stream(seed, "draws", 0);
        let (mut factors, sizes) = factors(&mut rng);
        // Values that leave several assignments likely.
        for value in factors.iter_mut().flat_map(|f| &mut f.values) {
            *value /= 1000.0;
        }
        let tree = BucketTree::new(factors.clone(), &sizes, Mode::Sum).unwrap();
        if tree.total == f64::NEG_INFINITY {
            return Ok(());
        }
        let mut counts = vec![vec![0.0; 3]; sizes.len()];
        const DRAWS: usize = 400;
        for _ in 0..DRAWS {
            let mut x = vec![0; sizes.len()];
            tree.draw(&mut x, &mut rng);
            let log: f64 = factors.iter().map(|f| f.values[f.index(&x, &sizes)]).sum();
            prop_assert!(log > f64::NEG_INFINITY);
            for (count, v) in counts.iter_mut().zip(x) {
                count[v] += 1.0 / DRAWS as f64;
            }
        }
        let beliefs = tree.beliefs();
        for (v, count) in counts.iter().enumerate() {
            for (p, c) in beliefs.of(&[v]).iter().zip(count) {
                // Six standard errors: one false alarm in 10^8 or so.
                let error = (p * (1.0 - p) / DRAWS as f64).sqrt();
                prop_assert!((p - c).abs() <= 6.0 * error + 1.0 / DRAWS as f64, "{p} {c}");
            }
        }
    }
}

/// A square lattice of binary variables has treewidth `side`.
fn lattice(side: usize) -> Vec<Factor> {
    let at = |x: usize, y: usize| y * side + x;
    let mut factors = Vec::new();
    for y in 0..side {
        for x in 0..side {
            for (nx, ny) in [(x + 1, y), (x, y + 1)] {
                if nx < side && ny < side {
                    factors.push(Factor::new(
                        vec![at(x, y), at(nx, ny)],
                        vec![0.1, 0.0, 0.0, 0.1],
                    ));
                }
            }
        }
    }
    factors
}

#[test]
fn width_is_known_before_any_table_is_made() {
    // Far more cells than there is memory, refused at once.
    let factors = lattice(60);
    let error = BucketTree::new(factors.clone(), &[2; 3600], Mode::Sum).unwrap_err();
    assert!(
        error.width >= 60 && error.cells >= 2_f64.powi(60),
        "{error}"
    );
    let order = Order::new(factors.iter().map(|f| &f.vars[..]), &[2; 3600]);
    assert_eq!(order.widest, error);
    // The best table has 2^11 cells; greedy orders are within a factor 8.
    let small = lattice(10);
    let order = Order::new(small.iter().map(|f| &f.vars[..]), &[2; 100]);
    order.check().unwrap();
    assert!(order.widest.cells <= 2_f64.powi(14), "{:?}", order.widest);
}

/// Every second variable of a lattice network observed or asked for.
fn grid_network(side: usize) -> Network {
    let name = |x: usize, y: usize| format!("v{x}_{y}");
    let mut variables = Vec::new();
    for y in 0..side {
        for x in 0..side {
            let mut parents = Vec::new();
            if x > 0 {
                parents.push(name(x - 1, y));
            }
            if y > 0 {
                parents.push(name(x, y - 1));
            }
            let parents: Vec<&str> = parents.iter().map(String::as_str).collect();
            let rows = 1 << parents.len();
            let table = (0..rows).flat_map(|r: u32| {
                let p = 0.3 + 0.2 * f64::from(r.count_ones());
                [1.0 - p, p]
            });
            let table: Vec<f64> = table.collect();
            variables.push(Variable::table(
                &name(x, y),
                &["no", "yes"],
                &parents,
                &table,
            ));
        }
    }
    Network::new(variables).unwrap()
}

#[test]
fn barren_variables_do_not_count() {
    let network = grid_network(40);
    let nothing = Evidence::new();
    // The whole is too wide, and says where; a corner and draws are not.
    let all = network.marginals(&nothing);
    assert!(
        matches!(all, Err(ModelError::TooWide { width, .. }) if width > 26),
        "{all:?}"
    );
    let corner = network.marginal(&nothing, "v1_1").unwrap();
    let by_hand = {
        // `P(v1_1)` over `v1_0` and `v0_1`, both children of `v0_0`.
        let child = |p: usize| [0.7 - 0.2 * p as f64, 0.3 + 0.2 * p as f64];
        let mut yes = 0.0;
        for (r, root) in [0.7, 0.3].iter().enumerate() {
            for (a, left) in child(r).iter().enumerate() {
                for (b, below) in child(r).iter().enumerate() {
                    yes += root * left * below * (0.3 + 0.2 * (a + b) as f64);
                }
            }
        }
        yes
    };
    assert!((corner[1] - by_hand).abs() < 1e-12);
    let drawn = network
        .sample(&nothing, 10, &mut stream(1, "draws", 0))
        .unwrap();
    assert_eq!((drawn.rows(), drawn.columns().len()), (10, 1600));
    // Evidence in a corner costs its ancestors alone.
    let given = Evidence::new().is("v2_2", "yes");
    assert!(network.log_probability(&given).unwrap() < 0.0);
    assert!(
        network
            .sample(&given, 5, &mut stream(1, "draws", 1))
            .is_ok()
    );
}

#[test]
fn soft_evidence_is_a_hidden_child() {
    let base = || {
        vec![
            Variable::table("rain", &["no", "yes"], &[], &[0.8, 0.2]),
            Variable::table("wet", &["no", "yes"], &["rain"], &[0.9, 0.1, 0.2, 0.8]),
        ]
    };
    let mut with_child = base();
    with_child.push(Variable::table(
        "report",
        &["no", "yes"],
        &["wet"],
        &[0.7, 0.3, 0.4, 0.6],
    ));
    let (plain, child) = (
        Network::new(base()).unwrap(),
        Network::new(with_child).unwrap(),
    );
    let soft = Evidence::new().likely("wet", &[0.3, 0.6]);
    let hard = Evidence::new().is("report", "yes");
    let a = plain.log_probability(&soft).unwrap();
    assert!((a - child.log_probability(&hard).unwrap()).abs() < 1e-12);
    for name in ["rain", "wet"] {
        let (a, b) = (plain.marginal(&soft, name), child.marginal(&hard, name));
        for (a, b) in a.unwrap().iter().zip(b.unwrap()) {
            assert!((a - b).abs() < 1e-12);
        }
    }
    for bad in [&[0.3][..], &[0.0, 0.0], &[f64::NAN, 1.0], &[-1.0, 1.0]] {
        let refused = plain.log_probability(&Evidence::new().likely("wet", bad));
        assert!(matches!(refused, Err(ModelError::Parameter { name, .. }) if name == "wet"));
    }
    // Hard evidence that the soft one excludes.
    let both = Evidence::new().likely("wet", &[1.0, 0.0]).is("wet", "yes");
    let refused = plain.log_probability(&both);
    assert!(
        matches!(refused, Err(ModelError::Contradiction { variable, .. }) if variable == "wet")
    );
}

#[test]
fn approximations_agree_with_the_exact_answer() {
    let network = grid_network(4);
    let given = Evidence::new().is("v3_3", "no").is("v1_2", "yes");
    let exact = network.marginals(&given).unwrap();
    let weighted = network.likelihood_weighting(&given, 20_000, &mut stream(1, "lw", 0));
    let gibbs = network.gibbs(&given, 20_000, &mut stream(1, "gibbs", 0));
    for estimates in [weighted.unwrap(), gibbs.unwrap()] {
        for (estimate, answer) in estimates.iter().zip(&exact) {
            assert_eq!(estimate.name, answer.name);
            for v in 0..2 {
                let off = (estimate.probabilities[v] - answer.probabilities[v]).abs();
                assert!(estimate.errors[v] < 0.02);
                assert!(
                    off <= 5.0 * estimate.errors[v] + 1e-12,
                    "{estimate:?} {answer:?}"
                );
            }
        }
    }
    let loopy = network.loopy(&given, 200, 1e-10).unwrap();
    assert!(loopy.converged && loopy.rounds > 1);
    for (belief, answer) in loopy.answers.iter().zip(&exact) {
        assert!((belief.probabilities[0] - answer.probabilities[0]).abs() < 0.02);
    }
}

#[test]
fn few_draws_that_carry_weight_are_never_sure() {
    // The evidence is near impossible unless `rare`, which one draw of a thousand has.
    let network = Network::new(vec![
        Variable::table("rare", &["no", "yes"], &[], &[0.999, 0.001]),
        Variable::table(
            "seen",
            &["no", "yes"],
            &["rare"],
            &[1.0 - 1e-9, 1e-9, 0.1, 0.9],
        ),
    ]);
    let network = network.unwrap();
    let given = Evidence::new().is("seen", "yes");
    for run in 0..20 {
        let drawn = network.likelihood_weighting(&given, 2000, &mut stream(run, "lw", 0));
        let drawn = drawn.unwrap();
        assert!(drawn[0].errors.iter().all(|e| *e > 4e-4), "{drawn:?}");
        // What is given is sure.
        assert_eq!(drawn[1].errors, [0.0, 0.0]);
    }
}

#[test]
fn standard_errors_cover_as_often_as_they_should() {
    let network = grid_network(3);
    let given = Evidence::new().is("v2_2", "no");
    let exact = network.marginal(&given, "v0_0").unwrap()[0];
    let (mut weighted, mut gibbs) = (0, 0);
    const RUNS: u64 = 200;
    for run in 0..RUNS {
        let inside = |e: &edifice_model::network::Estimate| {
            u64::from((e.probabilities[0] - exact).abs() < 1.96 * e.errors[0])
        };
        let lw = network.likelihood_weighting(&given, 500, &mut stream(run, "lw", 0));
        weighted += inside(&lw.unwrap()[0]);
        let chain = network.gibbs(&given, 2_000, &mut stream(run, "gibbs", 0));
        gibbs += inside(&chain.unwrap()[0]);
    }
    // 190 are expected; 178 is three standard errors below.
    assert!(
        weighted >= 178 && gibbs >= 170,
        "{weighted} {gibbs} of {RUNS}"
    );
}

#[test]
fn loopy_propagation_is_exact_on_trees() {
    let variables = vec![
        Variable::table("a", &["x", "y", "z"], &[], &[0.2, 0.5, 0.3]),
        Variable::table("b", &["x", "y"], &["a"], &[0.9, 0.1, 0.5, 0.5, 0.0, 1.0]),
        Variable::table("c", &["x", "y"], &["a"], &[0.3, 0.7, 0.6, 0.4, 0.2, 0.8]),
        Variable::table("d", &["x", "y"], &["b"], &[0.25, 0.75, 0.5, 0.5]),
    ];
    let network = Network::new(variables).unwrap();
    for given in [Evidence::new(), Evidence::new().is("d", "x").is("c", "y")] {
        let loopy = network.loopy(&given, 500, 1e-13).unwrap();
        assert!(loopy.converged);
        for (belief, answer) in loopy.answers.iter().zip(network.marginals(&given).unwrap()) {
            for (b, a) in belief.probabilities.iter().zip(&answer.probabilities) {
                assert!((b - a).abs() < 1e-9, "{belief:?} {answer:?}");
            }
        }
    }
    let bad = network.gibbs(&Evidence::new(), 10, &mut stream(1, "gibbs", 0));
    assert!(matches!(bad, Err(ModelError::Parameter { name, .. }) if name == "sweeps"));
}
