//! Questions to factor graphs and their fits against enumeration of all states.

mod annealed;
mod asked;
mod fits;

use edifice_base::rng::Stream;
use edifice_model::factor_graph::{Factor, Gibbs};
use rand::RngExt;

fn product(a: usize, b: usize, weight: usize) -> Factor {
    Factor {
        variables: vec![a, b],
        weight,
        feature: Box::new(|x| (x[0] * x[1]) as f64),
    }
}

fn alone(a: usize, weight: usize) -> Factor {
    Factor {
        variables: vec![a],
        weight,
        feature: Box::new(|x| x[0] as f64),
    }
}

/// A Boltzmann machine of n bits: a weight for each bit and each pair.
fn machine(n: usize) -> Gibbs {
    let mut factors: Vec<Factor> = (0..n).map(|i| alone(i, i)).collect();
    for a in 0..n {
        for b in a + 1..n {
            let weight = factors.len();
            factors.push(product(a, b, weight));
        }
    }
    Gibbs::new(vec![2; n], factors).unwrap()
}

/// All states, in order.
fn states(sizes: &[usize]) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new()];
    for &k in sizes {
        all = all
            .into_iter()
            .flat_map(|s: Vec<usize>| (0..k).map(move |v| [&s[..], &[v]].concat()))
            .collect();
    }
    all
}

fn features(n: usize, x: &[usize]) -> Vec<f64> {
    let mut all: Vec<f64> = x.iter().map(|v| *v as f64).collect();
    for a in 0..n {
        for b in a + 1..n {
            all.push((x[a] * x[b]) as f64);
        }
    }
    all
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn random(count: usize, scale: f64, rng: &mut Stream) -> Vec<f64> {
    (0..count)
        .map(|_| scale * (2.0 * rng.random::<f64>() - 1.0))
        .collect()
}

/// Draws from a random machine by enumeration.
fn data(n: usize, weights: &[f64], count: usize, rng: &mut Stream) -> Vec<Vec<usize>> {
    let all = states(&vec![2; n]);
    let p: Vec<f64> = all
        .iter()
        .map(|x| dot(weights, &features(n, x)).exp())
        .collect();
    (0..count)
        .map(|_| all[edifice_base::rng::categorical(&p, rng)].clone())
        .collect()
}

/// A restricted machine: visible bits 0..v, hidden ones after them.
fn restricted(v: usize, h: usize) -> Gibbs {
    let mut factors: Vec<Factor> = (0..v + h).map(|i| alone(i, i)).collect();
    for a in 0..v {
        for b in v..v + h {
            let weight = factors.len();
            factors.push(product(a, b, weight));
        }
    }
    let hidden: Vec<usize> = (v..v + h).collect();
    Gibbs::new(vec![2; v + h], factors)
        .unwrap()
        .hidden(&hidden)
        .unwrap()
}
