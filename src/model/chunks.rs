//! Sums over rows in parallel whose bytes do not depend on the number of threads: fixed chunks,
//! merged in order, a bounded number of partial sums alive at a time.

use std::ops::Range;

use rayon::prelude::*;

/// Chunks whose partial results are alive at the same time.
const ALIVE: usize = 16;

/// Folds `part(range)` over the chunks of `0..rows` with `merge`, in order of rows.
pub(crate) fn fold<T: Send, E: Send>(
    rows: usize,
    chunk: usize,
    part: impl Fn(Range<usize>) -> Result<T, E> + Sync,
    merge: impl Fn(&mut T, T),
) -> Result<T, E> {
    let count = rows.div_ceil(chunk).max(1);
    let range = |i: usize| i * chunk..((i + 1) * chunk).min(rows);
    let mut total: Option<T> = None;
    for from in (0..count).step_by(ALIVE) {
        let batch = (from..count.min(from + ALIVE)).into_par_iter();
        let parts: Vec<Result<T, E>> = batch.map(|i| part(range(i))).collect();
        for part in parts {
            match &mut total {
                None => total = Some(part?),
                Some(total) => merge(total, part?),
            }
        }
    }
    // There is always a first chunk.
    total.map_or_else(|| part(0..0), Ok)
}
