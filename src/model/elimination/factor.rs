//! Log-valued tables over discrete variables, and the loops over their cells.

/// A function `f(x_1, .., x_m)` of some discrete variables, f ≥ 0; `values` are natural logarithms, the last variable fastest.
///
/// Of variables with k_1 .. k_m categories it has `Π_i k_i` values, at `(.. (x_1 k_2 + x_2) k_3 + ..) k_m + x_m`; `-∞`
/// stands for 0. A variable is a number, its place in `sizes`, which has the number of categories of each. Source: Koller and
/// Friedman 2009, Sec. 4.2.
///
/// # Examples
/// ```
/// use edifice_model::elimination::Factor;
/// let sizes = [2, 3];
/// let f = Factor::new(vec![1, 0], [1.0_f64, 2.0, 3.0, 4.0, 5.0, 6.0].map(f64::ln).to_vec());
/// // Variable 0 is 1 and variable 1 is 2; in the factor variable 1 comes first.
/// assert_eq!(f.index(&[1, 2], &sizes), 2 * 2 + 1);
/// let rest = f.reduce(&[Some(1), None], &sizes);
/// assert_eq!(rest, Factor::new(vec![1], [2.0_f64, 4.0, 6.0].map(f64::ln).to_vec()));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// Its variables, each once.
    pub vars: Vec<usize>,
    /// One value for each configuration of them.
    pub values: Vec<f64>,
}

impl Factor {
    /// A factor; that there is one value for each configuration is not checked.
    pub fn new(vars: Vec<usize>, values: Vec<f64>) -> Self {
        Self { vars, values }
    }

    /// Index of an assignment (of all variables) in `values`; O(m).
    pub fn index(&self, assignment: &[usize], sizes: &[usize]) -> usize {
        index(&self.vars, assignment, sizes)
    }

    /// The factor with observed variables fixed, a function of the others. `observed` has an entry for every variable of `sizes`;
    /// O(m) for each value that is left.
    pub fn reduce(self, observed: &[Option<usize>], sizes: &[usize]) -> Self {
        if self.vars.iter().all(|&v| observed[v].is_none()) {
            return self;
        }
        let vars = self.vars.iter().copied();
        let vars: Vec<usize> = vars.filter(|&v| observed[v].is_none()).collect();
        let mut assignment: Vec<usize> = observed.iter().map(|o| o.unwrap_or(0)).collect();
        let count: usize = vars.iter().map(|&v| sizes[v]).product();
        let mut values = Vec::with_capacity(count);
        for _ in 0..count {
            values.push(self.values[self.index(&assignment, sizes)]);
            advance(&vars, sizes, &mut assignment);
        }
        Self { vars, values }
    }
}

/// Index of an assignment in a table over `vars`.
pub(super) fn index(vars: &[usize], assignment: &[usize], sizes: &[usize]) -> usize {
    vars.iter().fold(0, |i, &v| i * sizes[v] + assignment[v])
}

/// The next assignment of `vars`, the last fastest.
pub(crate) fn advance(vars: &[usize], sizes: &[usize], assignment: &mut [usize]) {
    for &v in vars.iter().rev() {
        assignment[v] += 1;
        if assignment[v] < sizes[v] {
            return;
        }
        assignment[v] = 0;
    }
}

/// The cells of a table over `outer` beside those of a table over `inner`, whose variables are all among `outer`'s: calls
/// `visit(start, length, at, moves)` for every run of `length` cells from `start`; beside them the cells from `at` of the
/// inner table, one after the other where it `moves`, else always the same one.
pub(super) fn runs(
    outer: &[usize],
    inner: &[usize],
    sizes: &[usize],
    mut visit: impl FnMut(usize, usize, usize, bool),
) {
    // By how much each variable of `outer` moves the index of the inner table.
    let mut strides = vec![0; outer.len()];
    let mut stride = 1;
    for &v in inner.iter().rev() {
        if let Some(at) = outer.iter().position(|&w| w == v) {
            strides[at] = stride;
        }
        stride *= sizes[v];
    }
    // The longest run at the end of `outer` over which the inner index follows or stands still.
    let moves = strides.last().is_some_and(|&s| s == 1);
    let (mut length, mut left) = (1, outer.len());
    while left > 0 && strides[left - 1] == if moves { length } else { 0 } {
        length *= sizes[outer[left - 1]];
        left -= 1;
    }
    let count: usize = outer[..left].iter().map(|&v| sizes[v]).product();
    let (mut digits, mut at) = (vec![0; left], 0);
    for run in 0..count {
        visit(run * length, length, at, moves);
        for d in (0..left).rev() {
            digits[d] += 1;
            at += strides[d];
            if digits[d] < sizes[outer[d]] {
                break;
            }
            at -= strides[d] * digits[d];
            digits[d] = 0;
        }
    }
}

/// Adds a factor to the table over `scope`, which holds all its variables.
pub(super) fn add(values: &mut [f64], scope: &[usize], factor: &Factor, sizes: &[usize]) {
    let inner = &factor.values;
    runs(scope, &factor.vars, sizes, |start, length, at, moves| {
        let out = &mut values[start..start + length];
        if moves {
            let along = &inner[at..at + length];
            out.iter_mut().zip(along).for_each(|(o, i)| *o += i);
        } else {
            let one = inner[at];
            out.iter_mut().for_each(|o| *o += one);
        }
    });
}

/// Sums a table of probabilities over the variables of `scope` that are not in `vars`.
pub(super) fn sum_onto(
    values: &[f64],
    scope: &[usize],
    vars: &[usize],
    sizes: &[usize],
) -> Vec<f64> {
    let mut sums = vec![0.0; vars.iter().map(|&v| sizes[v]).product()];
    runs(scope, vars, sizes, |start, length, at, moves| {
        let own = &values[start..start + length];
        if moves {
            let out = &mut sums[at..at + length];
            out.iter_mut().zip(own).for_each(|(o, v)| *o += v);
        } else {
            sums[at] += own.iter().sum::<f64>();
        }
    });
    sums
}

#[cfg(test)]
mod tests {
    use super::{Factor, add, sum_onto};
    use edifice_base::rng::stream;
    use rand::RngExt;

    /// Every assignment of some variables of a table, in the order of its cells.
    fn assignments(vars: &[usize], sizes: &[usize]) -> Vec<Vec<usize>> {
        let longer = |all: Vec<Vec<usize>>, &v: &usize| {
            let values = |x: Vec<usize>| {
                (0..sizes[v]).map(move |value| {
                    let mut x = x.clone();
                    x[v] = value;
                    x
                })
            };
            all.into_iter().flat_map(values).collect()
        };
        vars.iter().fold(vec![vec![0; sizes.len()]], longer)
    }

    /// Sums onto some of a table's variables, and sums with a table over them, cell by cell.
    #[test]
    fn tables_are_summed_and_added_cell_by_cell() {
        let mut rng = stream(1, "tables", 0);
        for case in 0..300 {
            let n = rng.random_range(1..=5);
            let sizes: Vec<usize> = (0..n).map(|_| rng.random_range(1..=3)).collect();
            let mut scope: Vec<usize> = (0..n).collect();
            for i in 0..n {
                scope.swap(i, rng.random_range(0..n));
            }
            // Some of the variables, now and then in the order of the table, so that runs of cells move along.
            let mut vars = scope.clone();
            if rng.random::<bool>() {
                vars.sort_unstable();
            }
            let from = rng.random_range(0..=n);
            let vars = &vars[from..];
            let cells = assignments(&scope, &sizes);
            let values: Vec<f64> = cells.iter().map(|_| rng.random_range(0.0..1.0)).collect();
            let alike = |x: &[usize], y: &[usize]| vars.iter().all(|&v| x[v] == y[v]);
            let inner = assignments(vars, &sizes);
            let sums = sum_onto(&values, &scope, vars, &sizes);
            assert_eq!(sums.len(), inner.len());
            for (sum, y) in sums.iter().zip(&inner) {
                let here = cells.iter().zip(&values).filter(|(x, _)| alike(x, y));
                let slow: f64 = here.map(|(_, value)| value).sum();
                assert!((sum - slow).abs() < 1e-12, "{case}: {sum} is not {slow}");
            }
            let factor = Factor::new(vars.to_vec(), sums);
            let mut added = values.clone();
            add(&mut added, &scope, &factor, &sizes);
            for ((x, sum), value) in cells.iter().zip(&added).zip(&values) {
                let beside = inner.iter().position(|y| alike(x, y)).unwrap();
                let slow = value + factor.values[beside];
                assert!((sum - slow).abs() < 1e-12, "{case}: {sum} is not {slow}");
            }
        }
    }
}
