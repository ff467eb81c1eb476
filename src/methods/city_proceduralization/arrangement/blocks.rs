//! Blocks: rows and buildings with less than a street between them.

use petgraph::unionfind::UnionFind;
use rustc_hash::FxHashMap;

use super::rectangle::{Rectangle, near};

/// A gap that is wider, in metres, is a street.
const STREET: f64 = 6.0;

/// The blocks of a plan as lists of rows, in the order of their first rows.
pub(super) fn blocks(plan: &[Rectangle], rows: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut row_of = vec![0; plan.len()];
    for (r, row) in rows.iter().enumerate() {
        row.iter().for_each(|&i| row_of[i] = r);
    }
    let mut sets = UnionFind::new(rows.len());
    for [i, j] in near(plan, STREET) {
        sets.union(row_of[i], row_of[j]);
    }
    let mut place: FxHashMap<usize, usize> = FxHashMap::default();
    let mut out: Vec<Vec<usize>> = Vec::new();
    for (row, set) in sets.into_labeling().into_iter().enumerate() {
        let block = *place.entry(set).or_insert(out.len());
        match out.get_mut(block) {
            Some(list) => list.push(row),
            None => out.push(vec![row]),
        }
    }
    out
}
