//! A sparse matrix while it is written, entry by entry.

use clarabel::algebra::CscMatrix;

/// Entries in any order; those of one place add up.
#[derive(Default)]
pub(super) struct Triplets {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Triplets {
    /// Without entries, with room for so many.
    pub(crate) fn with_capacity(count: usize) -> Self {
        Self {
            rows: Vec::with_capacity(count),
            columns: Vec::with_capacity(count),
            values: Vec::with_capacity(count),
        }
    }

    pub(crate) fn entry(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    /// The matrix of so many rows and columns, by two sorts by counting: O(entries + rows + columns).
    pub(crate) fn matrix(self, rows: usize, columns: usize) -> CscMatrix<f64> {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        if !self.rows.is_sorted() {
            order = sorted(&order, &self.rows, rows).0;
        }
        let (order, starts) = sorted(&order, &self.columns, columns);
        let mut pointers = Vec::with_capacity(columns + 1);
        let mut places = Vec::with_capacity(order.len());
        let mut values: Vec<f64> = Vec::with_capacity(order.len());
        pointers.push(0);
        for column in starts.windows(2) {
            let first = places.len();
            for &i in &order[column[0]..column[1]] {
                if places.len() > first && places.last() == Some(&self.rows[i]) {
                    let last = values.len() - 1;
                    values[last] += self.values[i];
                } else {
                    places.push(self.rows[i]);
                    values.push(self.values[i]);
                }
            }
            pointers.push(places.len());
        }
        CscMatrix::new(rows, columns, pointers, places, values)
    }
}

/// `order` sorted by the key of each, which is below `count`, equal ones as they were; and where each key starts.
fn sorted(order: &[usize], keys: &[usize], count: usize) -> (Vec<usize>, Vec<usize>) {
    let mut starts = vec![0; count + 1];
    for &key in keys {
        starts[key + 1] += 1;
    }
    for key in 0..count {
        starts[key + 1] += starts[key];
    }
    let mut next = starts.clone();
    let mut out = vec![0; order.len()];
    for &i in order {
        out[next[keys[i]]] = i;
        next[keys[i]] += 1;
    }
    (out, starts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_in_any_order_are_those_of_the_solvers_own_assembly() {
        let entries = [
            (2, 1, 1.0),
            (0, 1, 2.0),
            (2, 1, 0.5),
            (1, 3, -1.0),
            (0, 0, 4.0),
            (0, 1, 1.0),
        ];
        let mut own = Triplets::default();
        entries.iter().for_each(|&(r, c, v)| own.entry(r, c, v));
        let theirs = CscMatrix::new_from_triplets(
            3,
            4,
            entries.iter().map(|e| e.0).collect(),
            entries.iter().map(|e| e.1).collect(),
            entries.iter().map(|e| e.2).collect(),
        );
        assert_eq!(own.matrix(3, 4), theirs);
    }
}
