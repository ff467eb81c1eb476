//! Hierarchical clustering by merging the two nearest clusters.
//!
//! Distances between clusters follow the recurrence of Lance and Williams (1967); the order of
//! merges is found by nearest-neighbour chains (Murtagh 1983), which give the same tree as merging
//! the nearest pair each time for the linkages offered here, in `O(n^2)`.

use nalgebra::DMatrix;

/// Distance between two clusters, from the distances between their members.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Linkage {
    /// Smallest.
    Single,
    /// Largest.
    Complete,
    /// Mean over all pairs.
    Average,
}

/// Two clusters become one. Items are clusters `0..n`; the `m`-th merge makes cluster `n + m`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Merge {
    /// The two clusters, the lower number first.
    pub clusters: (usize, usize),
    /// Their distance; never falls from one merge to the next.
    pub height: f64,
    /// Number of items in the new cluster.
    pub size: usize,
}

/// The history of merges over `items` items: `items - 1` of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Dendrogram {
    /// Number of items.
    pub items: usize,
    /// The merges, lowest first.
    pub merges: Vec<Merge>,
}

/// Why a matrix is no distance matrix.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DistanceError {
    /// Not square.
    #[error("the matrix is {rows} x {columns}, not square")]
    Shape {
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
    },
    /// An entry is negative or not finite, or differs from its mirror image.
    #[error("distance ({row}, {column}) is {value}, its mirror image {mirror}")]
    Entry {
        /// Row.
        row: usize,
        /// Column.
        column: usize,
        /// The entry.
        value: f64,
        /// The entry across the diagonal.
        mirror: f64,
    },
}

/// Clusters the items of a symmetric matrix of distances. `O(n^2)` time and memory.
///
/// # Errors
/// [`DistanceError`] when the matrix is not square, symmetric, finite and non-negative.
pub fn agglomerate(
    distances: &DMatrix<f64>,
    linkage: Linkage,
) -> Result<Dendrogram, DistanceError> {
    check(distances)?;
    let n = distances.nrows();
    let mut between = distances.clone();
    let mut sizes = vec![1.0; n];
    let mut alive = vec![true; n];
    let mut pairs: Vec<(usize, usize, f64)> = Vec::with_capacity(n.saturating_sub(1));
    let mut chain: Vec<usize> = Vec::new();
    while pairs.len() + 1 < n {
        if chain.is_empty() {
            chain.extend(alive.iter().position(|&live| live));
        }
        let top = chain[chain.len() - 1];
        let before = chain.len().checked_sub(2).map(|place| chain[place]);
        let nearest = nearest_neighbour(&between, &alive, top, before);
        if before != Some(nearest) {
            chain.push(nearest);
            continue;
        }
        chain.truncate(chain.len() - 2);
        let (keep, gone) = (top.min(nearest), top.max(nearest));
        pairs.push((keep, gone, between[(keep, gone)]));
        alive[gone] = false;
        for other in (0..n).filter(|&other| alive[other] && other != keep) {
            let (a, b) = (between[(keep, other)], between[(gone, other)]);
            let joined = match linkage {
                Linkage::Single => a.min(b),
                Linkage::Complete => a.max(b),
                Linkage::Average => {
                    (sizes[keep] * a + sizes[gone] * b) / (sizes[keep] + sizes[gone])
                }
            };
            between[(keep, other)] = joined;
            between[(other, keep)] = joined;
        }
        sizes[keep] += sizes[gone];
    }
    Ok(in_order(n, pairs))
}

fn check(distances: &DMatrix<f64>) -> Result<(), DistanceError> {
    let (rows, columns) = distances.shape();
    if rows != columns {
        return Err(DistanceError::Shape { rows, columns });
    }
    for row in 0..rows {
        for column in 0..=row {
            let (value, mirror) = (distances[(row, column)], distances[(column, row)]);
            if !(value.is_finite() && value >= 0.0 && value == mirror) {
                return Err(DistanceError::Entry {
                    row,
                    column,
                    value,
                    mirror,
                });
            }
        }
    }
    Ok(())
}

/// The nearest living cluster to `cluster`; among equals `preferred`, then the lowest number.
fn nearest_neighbour(
    between: &DMatrix<f64>,
    alive: &[bool],
    cluster: usize,
    preferred: Option<usize>,
) -> usize {
    let others = (0..alive.len()).filter(|&other| alive[other] && other != cluster);
    preferred
        .into_iter()
        .chain(others)
        .min_by(|&a, &b| between[(cluster, a)].total_cmp(&between[(cluster, b)]))
        .unwrap_or(cluster)
}

/// Sorts merges by height and numbers the clusters they make.
fn in_order(items: usize, mut pairs: Vec<(usize, usize, f64)>) -> Dendrogram {
    pairs.sort_by(|a, b| a.2.total_cmp(&b.2));
    let mut number: Vec<usize> = (0..items).collect();
    let mut sizes = vec![1; items];
    let mut parent: Vec<usize> = (0..items).collect();
    let mut merges = Vec::with_capacity(pairs.len());
    for (a, b, height) in pairs {
        let (a, b) = (find(&mut parent, a), find(&mut parent, b));
        let size = sizes[a] + sizes[b];
        merges.push(Merge {
            clusters: (number[a].min(number[b]), number[a].max(number[b])),
            height,
            size,
        });
        parent[b] = a;
        sizes[a] = size;
        number[a] = items + merges.len() - 1;
    }
    Dendrogram { items, merges }
}

/// Root of an item, with path halving.
fn find(parent: &mut [usize], mut item: usize) -> usize {
    while parent[item] != item {
        parent[item] = parent[parent[item]];
        item = parent[item];
    }
    item
}

impl Dendrogram {
    /// The items in the order of the leaves, so that no two branches cross.
    pub fn leaf_order(&self) -> Vec<usize> {
        let mut order = Vec::with_capacity(self.items);
        let mut todo = match self.merges.len() {
            0 => (0..self.items).rev().collect(),
            count => vec![self.items + count - 1],
        };
        while let Some(cluster) = todo.pop() {
            match cluster.checked_sub(self.items) {
                None => order.push(cluster),
                Some(merge) => {
                    let (a, b) = self.merges[merge].clusters;
                    todo.extend([b, a]);
                }
            }
        }
        order
    }

    /// Cluster of each item after all but the last `clusters - 1` merges, numbered by first item.
    pub fn cut(&self, clusters: usize) -> Vec<usize> {
        let kept = (self.items + 1).saturating_sub(clusters.max(1));
        let mut parent: Vec<usize> = (0..self.items + self.merges.len()).collect();
        for (index, merge) in self.merges.iter().take(kept.saturating_sub(1)).enumerate() {
            parent[merge.clusters.0] = self.items + index;
            parent[merge.clusters.1] = self.items + index;
        }
        let mut names = Vec::new();
        (0..self.items)
            .map(|item| {
                let root = find(&mut parent, item);
                names
                    .iter()
                    .position(|&name| name == root)
                    .unwrap_or_else(|| {
                        names.push(root);
                        names.len() - 1
                    })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use rand::RngExt;

    fn random(n: usize, index: u64) -> DMatrix<f64> {
        let mut rng = stream(5, "agglomerative", index);
        let mut distances = DMatrix::zeros(n, n);
        for i in 0..n {
            for j in 0..i {
                distances[(i, j)] = rng.random::<f64>();
                distances[(j, i)] = distances[(i, j)];
            }
        }
        distances
    }

    /// Merges the nearest pair of clusters, with distances taken anew from the members.
    fn slow(distances: &DMatrix<f64>, linkage: Linkage) -> Vec<f64> {
        let mut clusters: Vec<Vec<usize>> = (0..distances.nrows()).map(|i| vec![i]).collect();
        let mut heights = Vec::new();
        while clusters.len() > 1 {
            let mut best = (f64::INFINITY, 0, 0);
            for a in 0..clusters.len() {
                for b in 0..a {
                    let pairs = || {
                        clusters[a]
                            .iter()
                            .flat_map(|&i| clusters[b].iter().map(move |&j| distances[(i, j)]))
                    };
                    let distance = match linkage {
                        Linkage::Single => pairs().fold(f64::INFINITY, f64::min),
                        Linkage::Complete => pairs().fold(0.0, f64::max),
                        Linkage::Average => pairs().sum::<f64>() / pairs().count() as f64,
                    };
                    if distance < best.0 {
                        best = (distance, a, b);
                    }
                }
            }
            heights.push(best.0);
            let gone = clusters.remove(best.1);
            clusters[best.2].extend(gone);
        }
        heights
    }

    #[test]
    fn agrees_with_merging_the_nearest_pair() {
        for linkage in [Linkage::Single, Linkage::Complete, Linkage::Average] {
            for index in 0..20 {
                let distances = random(12, index);
                let tree = agglomerate(&distances, linkage).expect("distances");
                for (merge, height) in tree.merges.iter().zip(slow(&distances, linkage)) {
                    assert!((merge.height - height).abs() < 1e-12, "{linkage:?} {index}");
                }
                assert_eq!(tree.merges.last().map(|m| m.size), Some(12));
                let mut order = tree.leaf_order();
                order.sort_unstable();
                assert_eq!(order, (0..12).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn cuts_into_the_clusters_asked_for() {
        let distances = random(9, 1);
        let tree = agglomerate(&distances, Linkage::Average).expect("distances");
        for clusters in 1..=9 {
            let labels = tree.cut(clusters);
            assert_eq!(labels.iter().max(), Some(&(clusters - 1)), "{clusters}");
        }
    }

    #[test]
    fn few_items_and_bad_matrices() {
        let none = agglomerate(&DMatrix::zeros(0, 0), Linkage::Single).expect("nothing");
        assert!(none.leaf_order().is_empty() && none.cut(1).is_empty());
        let one = agglomerate(&DMatrix::zeros(1, 1), Linkage::Single).expect("one item");
        assert_eq!((one.leaf_order(), one.cut(1)), (vec![0], vec![0]));
        let mut bad = random(3, 0);
        bad[(0, 2)] = f64::NAN;
        assert!(matches!(
            agglomerate(&bad, Linkage::Single),
            Err(DistanceError::Entry { .. })
        ));
        assert!(matches!(
            agglomerate(&DMatrix::zeros(2, 3), Linkage::Single),
            Err(DistanceError::Shape { .. })
        ));
    }
}
