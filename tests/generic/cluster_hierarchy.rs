//! Ward's hierarchy, k-means and communities against slow, obvious oracles.

use edifice::cluster::{
    WardError, WeightedGraph, girvan_newman, kmeans, kmeans_unweighted, lloyd, louvain, means,
    modularity, sum_of_squares, ward, weighted_graph,
};
use edifice::rng::{Stream, categorical, stream};
use rand::{Rng, RngExt};

/// Greedy Ward: the cheapest of all pairs merges. Returns the sum of squared errors by number of clusters.
fn naive_ward(points: &[f64], d: usize, weights: &[f64]) -> Vec<f64> {
    let mut clusters: Vec<(Vec<f64>, f64)> = points
        .chunks(d)
        .zip(weights)
        .map(|(p, &w)| (p.to_vec(), w))
        .collect();
    let mut sums = vec![0.0; clusters.len() + 1];
    let mut sum = 0.0;
    while clusters.len() > 1 {
        let mut best = (f64::INFINITY, 0, 0);
        for i in 0..clusters.len() {
            for j in i + 1..clusters.len() {
                let ((a, v), (b, w)) = (&clusters[i], &clusters[j]);
                let square: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
                best = if v * w / (v + w) * square < best.0 {
                    (v * w / (v + w) * square, i, j)
                } else {
                    best
                };
            }
        }
        let (b, w) = clusters.remove(best.2);
        let (a, v) = &mut clusters[best.1];
        for (x, y) in a.iter_mut().zip(&b) {
            *x = (*v * *x + w * y) / (*v + w);
        }
        *v += w;
        sum += best.0;
        sums[clusters.len()] = sum;
    }
    sums
}

fn sse(points: &[f64], d: usize, weights: &[f64], labels: &[usize]) -> f64 {
    let k = labels.iter().max().map_or(0, |m| m + 1);
    let centres = means(points, d, weights, labels, vec![0.0; k * d]);
    sum_of_squares(points, d, weights, labels, &centres)
}

fn cloud(n: usize, d: usize, rng: &mut Stream) -> (Vec<f64>, Vec<f64>) {
    let points = (0..n * d).map(|_| rng.random::<f64>()).collect();
    (points, (0..n).map(|_| 0.1 + rng.random::<f64>()).collect())
}

#[test]
fn ward_is_the_greedy_hierarchy() {
    for seed in 0..20 {
        let mut rng = stream(seed, "ward", 0);
        let (n, d) = (rng.random_range(2..80), rng.random_range(1..5));
        let (points, weights) = cloud(n, d, &mut rng);
        let tree = ward(&points, d, &weights).unwrap();
        assert_eq!(tree.merges.len(), n - 1);
        let sums = naive_ward(&points, d, &weights);
        assert_eq!(sums.len(), n + 1);
        for (k, least) in sums.iter().enumerate().skip(1) {
            let labels = tree.cut(k);
            assert_eq!(labels.iter().max().unwrap() + 1, k);
            let found = sse(&points, d, &weights, &labels);
            assert!(
                (found - least).abs() < 1e-9,
                "seed {seed}, k {k}: {found} {least}"
            );
        }
    }
}

#[test]
fn ward_ends_on_ties_and_chains() {
    // Equal points, a lattice, and gaps that grow, where each round has one reciprocal pair.
    let equal = vec![1.0; 500];
    assert_eq!(ward(&equal, 1, &[1.0; 500]).unwrap().merges.len(), 499);
    let lattice: Vec<f64> = (0..900)
        .flat_map(|i| [f64::from(i % 30), f64::from(i / 30)])
        .collect();
    assert_eq!(ward(&lattice, 2, &[1.0; 900]).unwrap().merges.len(), 899);
    let chain: Vec<f64> = (0..300).map(|i| 1.05f64.powi(i)).collect();
    let tree = ward(&chain, 1, &[1.0; 300]).unwrap();
    let sums = naive_ward(&chain, 1, &[1.0; 300]);
    for k in [1, 2, 17, 100] {
        let found = sse(&chain, 1, &[1.0; 300], &tree.cut(k));
        assert!((found - sums[k]).abs() <= 1e-9 * sums[k].max(1.0));
    }
}

#[test]
fn ward_refuses_what_has_no_distance() {
    assert_eq!(
        ward(&[0.0, f64::NAN], 1, &[1.0, 1.0]),
        Err(WardError::NotFinite(1))
    );
    assert!(matches!(
        ward(&[0.0, 1.0], 1, &[1.0, 0.0]),
        Err(WardError::Weight { index: 1, .. })
    ));
    assert!(matches!(
        ward(&[0.0; 3], 2, &[1.0]),
        Err(WardError::Shape { .. })
    ));
    assert!(ward(&[], 3, &[]).unwrap().merges.is_empty());
}

#[test]
fn lloyd_never_raises_the_sum_and_centres_are_nearest() {
    let mut rng = stream(3, "lloyd", 0);
    let (points, weights) = cloud(300, 3, &mut rng);
    let start = points[..30].to_vec();
    let mut last = f64::INFINITY;
    for steps in 0..6 {
        let found = lloyd(&points, 3, &weights, start.clone(), steps);
        assert!(found.sse <= last + 1e-12);
        last = found.sse;
        for (p, &label) in points.chunks(3).zip(&found.labels) {
            let far = |c: &[f64]| -> f64 { p.iter().zip(c).map(|(x, y)| (x - y) * (x - y)).sum() };
            let nearest = found
                .centres
                .chunks(3)
                .map(far)
                .fold(f64::INFINITY, f64::min);
            assert!(far(&found.centres[3 * label..3 * label + 3]) <= nearest);
        }
    }
    // As many centres as points: nothing is left.
    let all = kmeans(&points, 3, &weights, 300, 3, &mut rng);
    assert!(all.sse < 1e-12);
}

/// k-means++ and Lloyd by all distances: the labels.
fn slow_kmeans(points: &[Vec<f64>], k: usize, rounds: usize, rng: &mut impl Rng) -> Vec<usize> {
    let square =
        |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum() };
    let nearest = |p: &[f64], centres: &[Vec<f64>]| {
        let far = centres.iter().map(|c| square(p, c));
        let first_least = far.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        first_least.expect("there is a centre")
    };
    let mut centres = vec![points[rng.random_range(0..points.len())].clone()];
    while centres.len() < k {
        let mass: Vec<f64> = points.iter().map(|p| nearest(p, &centres).1).collect();
        centres.push(points[categorical(&mass, rng)].clone());
    }
    let assigned = |centres: &[Vec<f64>]| -> Vec<usize> {
        points.iter().map(|p| nearest(p, centres).0).collect()
    };
    let mut labels = assigned(&centres);
    for _ in 0..rounds {
        for (c, centre) in centres.iter_mut().enumerate() {
            let own: Vec<&Vec<f64>> = (points.iter().zip(&labels))
                .filter_map(|(p, l)| (*l == c).then_some(p))
                .collect();
            for (d, value) in centre.iter_mut().enumerate().filter(|_| !own.is_empty()) {
                *value = own.iter().map(|p| p[d]).sum::<f64>() / own.len() as f64;
            }
        }
        labels = assigned(&centres);
    }
    labels
}

#[test]
fn k_means_without_weights_is_that_by_all_distances() {
    for seed in 0..400 {
        let mut rng = stream(seed, "unweighted", 0);
        let (n, width) = (rng.random_range(1..60), rng.random_range(1..5));
        // Few whole numbers: equal points, ties, and fewer distinct points than centres.
        let most = if seed % 2 == 0 { 3 } else { 1000 };
        let one = |rng: &mut Stream| {
            (0..width)
                .map(|_| f64::from(rng.random_range(0..most)))
                .collect()
        };
        let points: Vec<Vec<f64>> = (0..n).map(|_| one(&mut rng)).collect();
        let (k, rounds) = (rng.random_range(1..12), rng.random_range(0..8));
        let expected = slow_kmeans(&points, k, rounds, &mut stream(seed, "start", 0));
        let flat = points.concat();
        let found = kmeans_unweighted(&flat, width, k, rounds, &mut stream(seed, "start", 0));
        assert_eq!(
            found.labels, expected,
            "seed {seed}: {n} points, {k} centres"
        );
    }
}

#[test]
fn ward_and_lloyd_are_no_worse_than_k_means() {
    let mut rng = stream(4, "both", 0);
    let (points, weights) = cloud(1500, 4, &mut rng);
    let tree = ward(&points, 4, &weights).unwrap();
    for k in [20, 100, 400] {
        let labels = tree.cut(k);
        let centres = means(&points, 4, &weights, &labels, vec![0.0; 4 * k]);
        let ours = lloyd(&points, 4, &weights, centres, 10).sse;
        let starts = (0..5).map(|_| kmeans(&points, 4, &weights, k, 10, &mut rng).sse);
        let best = starts.fold(f64::INFINITY, f64::min);
        assert!(ours <= 1.01 * best, "k {k}: {ours} against {best}");
    }
}

/// Q = 1/2m Σ_ij (A_ij - k_i k_j / 2m) δ(c_i, c_j), by the adjacency matrix.
fn direct_modularity(n: usize, edges: &[(usize, usize, f64)], labels: &[usize]) -> f64 {
    let mut a = vec![vec![0.0; n]; n];
    for &(i, j, w) in edges {
        a[i][j] += w;
        a[j][i] += w;
    }
    let degree: Vec<f64> = a.iter().map(|row| row.iter().sum()).collect();
    let twice: f64 = degree.iter().sum();
    let mut q = 0.0;
    for i in 0..n {
        for j in 0..n {
            if labels[i] == labels[j] {
                q += (a[i][j] - degree[i] * degree[j] / twice) / twice;
            }
        }
    }
    q
}

fn random_graph(seed: u64, n: usize, share: f64) -> (Vec<(usize, usize, f64)>, WeightedGraph) {
    let mut rng = stream(seed, "graph", 0);
    let mut edges = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            let near = if i * 4 / n == j * 4 / n { 4.0 } else { 0.5 };
            if rng.random::<f64>() < share * near {
                edges.push((i, j, 0.5 + rng.random::<f64>()));
            }
        }
    }
    let graph = weighted_graph(n, &edges);
    (edges, graph)
}

#[test]
fn modularity_is_its_formula() {
    for seed in 0..30 {
        let (edges, graph) = random_graph(seed, 20, 0.1);
        if edges.is_empty() {
            continue;
        }
        let mut rng = stream(seed, "labels", 0);
        let labels: Vec<usize> = (0..20).map(|_| rng.random_range(0..4)).collect();
        let q = modularity(&graph, &labels);
        assert!((q - direct_modularity(20, &edges, &labels)).abs() < 1e-12);
    }
}

/// Edge betweenness by all shortest paths, listed one by one.
fn naive_betweenness(n: usize, edges: &[(usize, usize)]) -> Vec<f64> {
    let mut sum = vec![0.0; edges.len()];
    for s in 0..n {
        for t in s + 1..n {
            // Breadth first over whole paths: the first length that reaches t has all of them.
            let mut paths = vec![(s, Vec::new(), vec![s])];
            loop {
                let found: Vec<&Vec<usize>> =
                    paths.iter().filter(|p| p.0 == t).map(|p| &p.1).collect();
                if !found.is_empty() {
                    for path in &found {
                        for &e in path.iter() {
                            sum[e] += 1.0 / found.len() as f64;
                        }
                    }
                    break;
                }
                let mut next = Vec::new();
                for (at, path, seen) in &paths {
                    for (e, &(a, b)) in edges.iter().enumerate() {
                        for (from, to) in [(a, b), (b, a)] {
                            if from == *at && !seen.contains(&to) {
                                let mut longer = (to, path.clone(), seen.clone());
                                longer.1.push(e);
                                longer.2.push(to);
                                next.push(longer);
                            }
                        }
                    }
                }
                if next.is_empty() {
                    break;
                }
                paths = next;
            }
        }
    }
    sum
}

/// Girvan and Newman with everything computed anew after each removal.
fn naive_girvan_newman(n: usize, edges: &[(usize, usize, f64)]) -> f64 {
    let mut left: Vec<usize> = (0..edges.len()).collect();
    let mut best = f64::NEG_INFINITY;
    loop {
        let mut labels: Vec<usize> = (0..n).collect();
        for _ in 0..n {
            for &e in &left {
                let low = labels[edges[e].0].min(labels[edges[e].1]);
                labels[edges[e].0] = low;
                labels[edges[e].1] = low;
            }
        }
        best = best.max(direct_modularity(n, edges, &labels));
        if left.is_empty() {
            return best;
        }
        let plain: Vec<(usize, usize)> = left.iter().map(|&e| (edges[e].0, edges[e].1)).collect();
        let between = naive_betweenness(n, &plain);
        let mut worst = 0;
        for (i, b) in between.iter().enumerate() {
            if *b > between[worst] * (1.0 + 1e-9) {
                worst = i;
            }
        }
        left.remove(worst);
    }
}

#[test]
fn girvan_newman_is_the_slow_algorithm() {
    for seed in 0..12 {
        let (edges, graph) = random_graph(seed, 9, 0.15);
        if edges.is_empty() {
            continue;
        }
        let found = girvan_newman(&graph);
        assert!((found.modularity - modularity(&graph, &found.labels)).abs() < 1e-12);
        let slow = naive_girvan_newman(9, &edges);
        assert!(
            (found.modularity - slow).abs() < 1e-9,
            "seed {seed}: {} {slow}",
            found.modularity
        );
    }
}

#[test]
fn louvain_finds_planted_communities() {
    let (edges, graph) = random_graph(7, 120, 0.12);
    let found = louvain(&graph);
    let planted: Vec<usize> = (0..120).map(|i| i * 4 / 120).collect();
    assert!(found.modularity >= direct_modularity(120, &edges, &planted) - 1e-9);
    assert!((found.modularity - direct_modularity(120, &edges, &found.labels)).abs() < 1e-12);
    // No edges: everybody alone, and no division by zero.
    let empty = louvain(&weighted_graph(3, &[]));
    assert_eq!((empty.labels, empty.modularity), (vec![0, 1, 2], 0.0));
    assert_eq!(girvan_newman(&weighted_graph(0, &[])).labels.len(), 0);
}

/// `tests/generic/igraph/make.py` writes the table: igraph's own Girvan-Newman and its modularity.
#[test]
fn girvan_newman_is_that_of_igraph() {
    let table: serde_json::Value =
        serde_json::from_str(include_str!("igraph/graphs.json")).unwrap();
    let graphs = table["graphs"].as_array().unwrap();
    assert!(graphs.len() >= 10);
    for (i, g) in graphs.iter().enumerate() {
        let end = |e: &serde_json::Value, k: usize| e[k].as_u64().unwrap() as usize;
        let edges = g["edges"].as_array().unwrap().iter();
        let edges: Vec<_> = edges.map(|e| (end(e, 0), end(e, 1), 1.0)).collect();
        let graph = weighted_graph(g["nodes"].as_u64().unwrap() as usize, &edges);
        let found = girvan_newman(&graph).modularity;
        let expected = g["modularity"].as_f64().unwrap();
        assert!(
            (found - expected).abs() < 1e-9,
            "graph {i}: {found} {expected}"
        );
        assert!(louvain(&graph).modularity > expected - 0.1, "graph {i}");
    }
}
