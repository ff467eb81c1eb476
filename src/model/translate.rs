//! A hierarchical model as a Bayesian network: the same distribution, for everything that networks answer (any posterior,
//! explanations, soft evidence), and each engine's judge of the other.

use edifice_base::unwatched;
use std::collections::HashSet;

use super::ModelError;
use super::conjugate::Linear;
use super::hierarchy::Hierarchy;
use super::hierarchy::structure::Selector;
use super::network::{Network, Variable};

impl Hierarchy {
    /// The network of this model, in the columns' own units: the style `style` with the categories `1`, `2`, ...; for each
    /// real group with a hidden variable `GROUP kind`, likewise; for each real group a vector under the group's name (its
    /// column's name, where it has only one), and before it, where there is a background, `GROUP outlier` (1: no, 2: yes);
    /// the categorical columns. A prime tells a name from one that is taken.
    ///
    /// # Errors
    /// Those of [`Network::new`]: covariances that are singular in the columns' own units.
    pub fn to_network(&self) -> Result<Network, ModelError> {
        let (schema, structure) = (&self.schema, &self.shape.structure);
        let mut taken: HashSet<String> = schema.codes.iter().map(|c| c.name.clone()).collect();
        let mut free = |name: String| {
            let mut name = name;
            while !taken.insert(name.clone()) {
                name.push('\'');
            }
            name
        };
        let groups: Vec<String> = (0..schema.groups.len())
            .map(|g| match schema.columns(g) {
                columns if columns.len() == 1 => free(schema.reals[columns.start].name.clone()),
                _ => free(schema.groups[g].clone()),
            })
            .collect();
        let style = free("style".to_owned());
        let kinds: Vec<String> = groups.iter().map(|g| free(format!("{g} kind"))).collect();
        let outliers: Vec<String> = groups
            .iter()
            .map(|g| free(format!("{g} outlier")))
            .collect();

        let mut variables = vec![discrete(&style, structure.styles, &[], &self.params.style)];
        let styles = structure.styles;
        for (g, selector) in structure.selectors.iter().enumerate() {
            let mut parents: Vec<&str> = match selector {
                Selector::Hidden(k) => {
                    let table = by_style(&self.params.tables[g], *k, styles, 1);
                    variables.push(discrete(&kinds[g], *k, &[&style], &table));
                    vec![&kinds[g]]
                }
                Selector::Style => vec![&style],
                Selector::Codes(list) => list.iter().map(|&c| &schema.codes[c].name[..]).collect(),
            };
            let shifts = &structure.shifts[g];
            parents.extend(shifts.iter().map(|&c| &schema.codes[c].name[..]));
            let background = self.shape.background.as_ref();
            if let Some(background) = background {
                let shares = [1.0 - background.share, background.share];
                variables.push(discrete(&outliers[g], 2, &[], &shares));
                parents.push(&outliers[g]);
            }
            parents.extend(structure.parents[g].iter().map(|&p| &groups[p][..]));
            let configurations = self.shape.configurations(shifts);
            let states: Vec<(Vec<f64>, Vec<f64>)> = (0..self.params.linear[g].len())
                .flat_map(|state| configurations.iter().map(move |codes| (state, codes)))
                .flat_map(|(state, codes)| {
                    let own = &self.params.linear[g][state];
                    let both = [Some(own), background.map(|b| &b.linear[g])];
                    let both = both.into_iter().flatten();
                    both.map(move |linear| self.in_own_units(g, linear, codes))
                })
                .collect();
            let states: Vec<(&[f64], &[f64])> =
                states.iter().map(|(b, s)| (&b[..], &s[..])).collect();
            let d = schema.columns(g).len();
            variables.push(Variable::linear(&groups[g], d, &parents, &states));
        }
        for (c, column) in schema.codes.iter().enumerate() {
            let mut parents: Vec<&str> = structure.code_parents[c]
                .iter()
                .map(|&p| &schema.codes[p].name[..])
                .collect();
            parents.push(&style);
            let size = column.categories.len();
            let configurations = self.params.codes[c].len() / (size * styles);
            let table = by_style(&self.params.codes[c], size, styles, configurations);
            let names: Vec<&str> = column.categories.iter().map(String::as_str).collect();
            variables.push(Variable::table(&column.name, &names, &parents, &table));
        }
        Network::new(variables)
    }

    /// B and the covariance of a linear Gaussian of a group, both row-major, with `y = m_y + s_y y'` for standardised columns, where
    /// the columns that shift the group have the categories `codes`: the intercept then holds their shifts.
    fn in_own_units(&self, g: usize, linear: &Linear, codes: &[usize]) -> (Vec<f64>, Vec<f64>) {
        let (p, d) = (linear.p, linear.d);
        let scaled = |column: usize| {
            let real = &self.schema.reals[column];
            (real.mean, real.scale)
        };
        let (inputs, own) = self.shape.columns[g].split_at(p - 1);
        let shifts = self.shape.structure.shifts[g].iter().zip(codes);
        let shifts: Vec<usize> = shifts.map(|(&c, v)| self.shape.indicators[c] + v).collect();
        let mut b = linear.coefficients()[..d].to_vec();
        for (row, column) in linear.coefficients()[d..].chunks(d).zip(inputs) {
            match column {
                real if *real < self.schema.reals.len() => b.extend(row),
                indicator if shifts.contains(indicator) => {
                    b[..d]
                        .iter_mut()
                        .zip(row)
                        .for_each(|(b, shift)| *b += shift);
                }
                _ => {}
            }
        }
        let reals = inputs.iter().filter(|c| **c < self.schema.reals.len());
        let inputs: Vec<(f64, f64)> = reals.map(|&c| scaled(c)).collect();
        let own: Vec<(f64, f64)> = own.iter().map(|&c| scaled(c)).collect();
        let mut covariance = linear.covariance.clone();
        for (j, (mean, scale)) in own.iter().enumerate() {
            b[j] = mean + scale * b[j];
            for (i, (input_mean, input_scale)) in inputs.iter().enumerate() {
                let slope = scale * b[(i + 1) * d + j] / input_scale;
                b[(i + 1) * d + j] = slope;
                b[j] -= slope * input_mean;
            }
            for k in 0..d {
                covariance[j * d + k] *= scale * own[k].1;
            }
        }
        (b, covariance)
    }
}

/// A hidden variable with the categories 1, 2, ...
fn discrete(name: &str, k: usize, parents: &[&str], table: &[f64]) -> Variable {
    let names: Vec<String> = (1..=k).map(|i| i.to_string()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    Variable::table(name, &names, parents, table)
}

/// A table of the hierarchy, `P(v | configuration, s)` at `(configuration * k + v) * styles + s`, with the style as the last
/// parent and the value fastest. Rows are divided by their sums, which EM keeps at 1 up to rounding.
fn by_style(table: &[f64], k: usize, styles: usize, configurations: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(table.len());
    for configuration in 0..configurations {
        for s in 0..styles {
            let row = (0..k).map(|v| table[(configuration * k + v) * styles + s]);
            let sum: f64 = row.clone().sum();
            out.extend(row.map(|p| p / sum));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::em::{Em, Stopping};
    use super::super::hierarchy::{Group, Priors, Settings, Variant, learn};
    use super::super::network::FitSettings;
    use crate::Table;

    #[test]
    fn a_step_of_em_is_the_same_in_both_engines() {
        let rows = 60;
        let size = |i: usize| 5.0 + (i % 3) as f64 * 4.0 + (i * 7 % 11) as f64 / 10.0;
        let area = |i: usize| 3.0 * size(i) + (i * 5 % 13) as f64 / 5.0;
        let seen = |i: usize, v: f64| (i % 9 != 4).then_some(v);
        let table = Table::new()
            .real("size", (0..rows).map(|i| seen(i, size(i))))
            .and_then(|t| t.real("area", (0..rows).map(|i| seen(i + 2, area(i)))))
            .and_then(|t| t.binary("garage", (0..rows).map(|i| Some(i % 3 > 0))))
            .expect("a table");
        let groups = [
            Group::new("size", &["size"]),
            Group::new("area", &["area"]),
            Group::new("parts", &["garage"]),
        ];
        for variant in [Variant::Full, Variant::NoSecondLevel] {
            let settings = Settings {
                variant,
                styles: 2..=2,
                restarts: 1,
                ..Settings::default()
            };
            let learned = learn(&table, &groups, &settings, 1, &unwatched);
            let mut model = learned.expect("a model").model;
            // Away from where EM ends, so that a step moves.
            model.params.style = vec![0.9, 0.1];
            let encoded = model.schema.encode(&table).expect("rows");
            let priors = Priors::default();
            let problem = model.problem(&encoded, &priors);
            let (stats, _) = problem.expect(&model.params).expect("statistics");
            let mut stepped = model.clone();
            stepped.params = problem.maximize(&stats).expect("parameters");
            let expected = stepped.to_network().expect("a network");

            let once = FitSettings {
                priors,
                restarts: 1,
                stopping: Stopping {
                    max_rounds: 1,
                    ..Stopping::default()
                },
            };
            let start = model.to_network().expect("a network");
            let fitted = start.fit_from(&table, &once).expect("a step").network;
            for name in expected.names() {
                let near = |a: &[f64], b: &[f64]| {
                    let close = |(x, y): (&f64, &f64)| (x - y).abs() < 1e-9 * (1.0 + y.abs());
                    assert!(
                        a.iter().zip(b).all(close),
                        "{variant:?} {name}: {a:?} {b:?}"
                    );
                };
                if let Ok(table) = expected.probabilities(name) {
                    near(fitted.probabilities(name).expect("a table"), table);
                }
                for state in 0.. {
                    let Ok((b, covariance)) = expected.regression(name, state) else {
                        break;
                    };
                    let own = fitted.regression(name, state).expect("a state");
                    near(own.0, b);
                    near(own.1, covariance);
                }
            }
        }
    }
}
