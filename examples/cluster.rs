//! Clustering by distance: histograms of facade elements, their chi-square distances, a dendrogram.
//! `cargo run --example cluster --no-default-features`

use edifice::cluster::{Histogram, Linkage, adjusted_rand_index, agglomerate, chi_square};
use nalgebra::DMatrix;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let facades = [
        "window window window door",
        "window window window window door",
        "window balcony window balcony",
        "balcony window balcony balcony window",
    ];
    let histograms: Vec<Histogram<&str>> = facades
        .iter()
        .map(|words| Histogram::count(words.split(' ')).normalized())
        .collect();
    let n = facades.len();
    let distances = DMatrix::from_fn(n, n, |i, j| chi_square(&histograms[i], &histograms[j]));
    println!("distances:{distances:.3}");
    let tree = agglomerate(&distances, Linkage::Average)?;
    let clusters = tree.cut(2);
    println!(
        "clusters: {clusters:?}, in the order of the tree: {:?}",
        tree.leaf_order()
    );
    assert_eq!(adjusted_rand_index(&clusters, &[0, 0, 1, 1]), 1.0);
    Ok(())
}
