//! Log-valued tables over discrete variables.

/// A function of some discrete variables; `values` are logarithms, the last variable fastest.
#[derive(Clone, Debug)]
pub(crate) struct Factor {
    pub vars: Vec<usize>,
    pub values: Vec<f64>,
}

impl Factor {
    /// Index of an assignment (of all variables) in `values`.
    pub fn index(&self, assignment: &[usize], sizes: &[usize]) -> usize {
        self.vars
            .iter()
            .fold(0, |i, &v| i * sizes[v] + assignment[v])
    }

    /// The factor with observed variables fixed.
    pub fn reduce(&self, observed: &[Option<usize>], sizes: &[usize]) -> Self {
        if self.vars.iter().all(|&v| observed[v].is_none()) {
            return self.clone();
        }
        let vars: Vec<usize> = self
            .vars
            .iter()
            .copied()
            .filter(|&v| observed[v].is_none())
            .collect();
        let mut assignment: Vec<usize> = observed.iter().map(|o| o.unwrap_or(0)).collect();
        let count: usize = vars.iter().map(|&v| sizes[v]).product();
        let mut values = Vec::with_capacity(count);
        for _ in 0..count {
            values.push(self.values[self.index(&assignment, sizes)]);
            advance(&vars, sizes, &mut assignment);
        }
        Self { vars, values }
    }

    /// Reduces over every variable not in `vars`, which must be in the factor's order.
    pub fn onto(&self, vars: &[usize], sizes: &[usize], mode: Mode) -> Self {
        let count: usize = vars.iter().map(|&v| sizes[v]).product();
        let strides = strides(&self.vars, vars, sizes);
        let mut top = vec![f64::NEG_INFINITY; count];
        walk(&self.vars, sizes, &[&strides], |at, i| {
            top[i[0]] = f64::max(top[i[0]], self.values[at]);
        });
        if mode == Mode::Max {
            return Self {
                vars: vars.to_vec(),
                values: top,
            };
        }
        let mut sums = vec![0.0; count];
        walk(&self.vars, sizes, &[&strides], |at, i| {
            if top[i[0]] > f64::NEG_INFINITY {
                sums[i[0]] += (self.values[at] - top[i[0]]).exp();
            }
        });
        for (s, t) in sums.iter_mut().zip(&top) {
            *s = if *t > f64::NEG_INFINITY {
                t + s.ln()
            } else {
                *t
            };
        }
        Self {
            vars: vars.to_vec(),
            values: sums,
        }
    }
}

/// How variables are eliminated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    Sum,
    Max,
}

/// The product of factors, over `scope` (which holds all their variables).
pub(crate) fn product(factors: &[&Factor], scope: &[usize], sizes: &[usize]) -> Factor {
    let count: usize = scope.iter().map(|&v| sizes[v]).product();
    let mut values = vec![0.0; count];
    let all: Vec<Vec<usize>> = factors
        .iter()
        .map(|f| strides(scope, &f.vars, sizes))
        .collect();
    let all: Vec<&Vec<usize>> = all.iter().collect();
    walk(scope, sizes, &all, |at, index| {
        for (f, &i) in factors.iter().zip(index) {
            values[at] += f.values[i];
        }
    });
    Factor {
        vars: scope.to_vec(),
        values,
    }
}

/// Per variable of `outer`, by how much it moves the index of a table over `inner`.
fn strides(outer: &[usize], inner: &[usize], sizes: &[usize]) -> Vec<usize> {
    outer
        .iter()
        .map(|v| match inner.iter().position(|w| w == v) {
            Some(at) => inner[at + 1..].iter().map(|&w| sizes[w]).product(),
            None => 0,
        })
        .collect()
}

/// Visits every cell of a table over `scope` with the indices of other tables given by strides.
fn walk(
    scope: &[usize],
    sizes: &[usize],
    strides: &[&Vec<usize>],
    mut visit: impl FnMut(usize, &[usize]),
) {
    let count: usize = scope.iter().map(|&v| sizes[v]).product();
    let mut digits = vec![0; scope.len()];
    let mut index = vec![0; strides.len()];
    for at in 0..count {
        visit(at, &index);
        for d in (0..scope.len()).rev() {
            digits[d] += 1;
            for (i, s) in index.iter_mut().zip(strides) {
                *i += s[d];
            }
            if digits[d] < sizes[scope[d]] {
                break;
            }
            for (i, s) in index.iter_mut().zip(strides) {
                *i -= s[d] * digits[d];
            }
            digits[d] = 0;
        }
    }
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
