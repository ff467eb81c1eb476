//! Questions to a learned model: its parts, likelihood, posteriors.

use super::super::error::ModelError;
use super::super::table::Table;
use super::Priors;
use super::Variant;
use super::fit::{Problem, Scored};
use super::infer::Scratch;
use super::params::{Params, Shape};
use super::schema::{Rows, Schema};
use super::structure::configuration;
use super::wide::states;

/// A learned hierarchical model.
#[derive(Clone, Debug)]
pub struct Hierarchy {
    pub(crate) schema: Schema,
    pub(crate) shape: Shape,
    pub(crate) params: Params,
    pub(crate) variant: Variant,
}

impl Hierarchy {
    pub(crate) fn new(schema: Schema, shape: Shape, params: Params, variant: Variant) -> Self {
        Self {
            schema,
            shape,
            params,
            variant,
        }
    }

    /// Which of the paper's models this is.
    pub fn variant(&self) -> Variant {
        self.variant
    }

    /// Cardinality of S.
    pub fn styles(&self) -> usize {
        self.shape.structure.styles
    }

    /// P(S = s).
    pub fn style_probabilities(&self) -> &[f64] {
        &self.params.style
    }

    /// Names of the real groups, in the model's order.
    pub fn real_groups(&self) -> &[String] {
        &self.schema.groups
    }

    /// Number of Gaussians of each real group: the cardinality of its hidden variable where it has
    /// one.
    pub fn cardinalities(&self) -> Vec<usize> {
        (0..self.shape.groups())
            .map(|g| self.shape.states(g))
            .collect()
    }

    /// Number of free parameters.
    pub fn free_parameters(&self) -> usize {
        self.shape.free_parameters()
    }

    /// Lateral edges as (parent, child): between real groups, then from categorical columns to real groups and to
    /// categorical columns.
    pub fn lateral_edges(&self) -> Vec<(String, String)> {
        let structure = &self.shape.structure;
        let group = |g: usize| self.schema.groups[g].clone();
        let code = |c: usize| self.schema.codes[c].name.clone();
        let mut edges = Vec::new();
        for (g, parents) in structure.parents.iter().enumerate() {
            edges.extend(parents.iter().map(|&p| (group(p), group(g))));
        }
        for (g, selector) in structure.selectors.iter().enumerate() {
            if let super::structure::Selector::Codes(list) = selector {
                edges.extend(list.iter().map(|&c| (code(c), group(g))));
            }
        }
        for (g, list) in structure.shifts.iter().enumerate() {
            edges.extend(list.iter().map(|&c| (code(c), group(g))));
        }
        for (c, parents) in structure.code_parents.iter().enumerate() {
            edges.extend(parents.iter().map(|&p| (code(p), code(c))));
        }
        edges
    }

    /// P(category | S = s) of a categorical column without parents other than S: one vector over
    /// its categories per style.
    ///
    /// # Errors
    /// [`ModelError::Unknown`].
    pub fn category_probabilities(&self, column: &str) -> Result<Vec<Vec<f64>>, ModelError> {
        let c = self.schema.codes.iter().position(|c| c.name == column);
        let c = c.ok_or_else(|| unknown(column))?;
        let (k, s) = (self.shape.sizes[c], self.styles());
        let at = |v: usize, s_: usize| self.params.codes[c][v * s + s_];
        Ok((0..s)
            .map(|s_| (0..k).map(|v| at(v, s_)).collect())
            .collect())
    }

    /// P(H_g = h | S = s) of a real group with a hidden variable: one vector over h per style.
    ///
    /// # Errors
    /// [`ModelError::Unknown`] for a group that is not there or has no hidden variable.
    pub fn state_probabilities(&self, group: &str) -> Result<Vec<Vec<f64>>, ModelError> {
        let g = self.group(group)?;
        let (k, s) = (self.shape.states(g), self.styles());
        if !self.shape.hidden(g) {
            return Err(unknown(group));
        }
        let at = |h: usize, s_: usize| self.params.tables[g][h * s + s_];
        Ok((0..s)
            .map(|s_| (0..k).map(|h| at(h, s_)).collect())
            .collect())
    }

    fn group(&self, name: &str) -> Result<usize, ModelError> {
        let found = self.schema.groups.iter().position(|g| g == name);
        found.ok_or_else(|| unknown(name))
    }

    fn with<T>(
        &self,
        data: &Table,
        f: impl FnOnce(&Problem, &Rows) -> Result<T, ModelError>,
    ) -> Result<T, ModelError> {
        let rows = self.schema.encode(data)?;
        f(&self.problem(&rows, &Priors::default()), &rows)
    }

    /// These rows under this model; the priors are not asked.
    pub(in crate::model) fn problem<'a>(
        &'a self,
        rows: &'a Rows,
        priors: &'a Priors,
    ) -> Problem<'a> {
        Problem {
            schema: &self.schema,
            rows,
            priors,
            shape: self.shape.clone(),
        }
    }

    /// `log p(row)` of every row, nats, in the columns' own units; missing values and columns that
    /// `data` lacks are integrated out.
    ///
    /// # Errors
    /// An unseen category, a column of the wrong kind, or evidence of probability zero.
    pub fn log_likelihood(&self, data: &Table) -> Result<Vec<f64>, ModelError> {
        self.with(data, |problem, rows| {
            let mut scratch = Scratch::new(&self.shape);
            (0..rows.rows)
                .map(|i| {
                    let l = problem.visit(&self.params, i, &mut scratch, |_, _, _, _| {})?;
                    Ok(l - self.log_scale(rows.real(i)))
                })
                .collect()
        })
    }

    /// `Σ log scale` over the observed real values of a row: from standardised to own units.
    pub(super) fn log_scale(&self, real: &[f64]) -> f64 {
        let scales = real.iter().zip(&self.schema.reals);
        scales
            .filter(|(v, _)| !v.is_nan())
            .map(|(_, c)| c.scale.ln())
            .sum()
    }

    /// P(S = s | row) of every row.
    ///
    /// # Errors
    /// As [`Hierarchy::log_likelihood`].
    pub fn style_posterior(&self, data: &Table) -> Result<Vec<Vec<f64>>, ModelError> {
        self.with(data, |problem, rows| {
            let mut scratch = Scratch::new(&self.shape);
            let mut all = Vec::with_capacity(rows.rows);
            for i in 0..rows.rows {
                let mut posterior = vec![0.0; self.styles()];
                problem.visit(&self.params, i, &mut scratch, |scratch, _, _, weight| {
                    for (p, r) in posterior.iter_mut().zip(&scratch.style) {
                        *p += weight * r;
                    }
                })?;
                all.push(posterior);
            }
            Ok(all)
        })
    }

    /// P(state of `group` | row) of every row: of its hidden variable where it has one.
    ///
    /// # Errors
    /// [`ModelError::Unknown`], and as [`Hierarchy::log_likelihood`].
    pub fn state_posterior(&self, data: &Table, group: &str) -> Result<Vec<Vec<f64>>, ModelError> {
        let g = self.group(group)?;
        self.with(data, |problem, rows| {
            let scored = Scored::view(&self.shape, &self.params);
            let mut scratch = Scratch::new(&self.shape);
            let mut all = Vec::with_capacity(rows.rows);
            for i in 0..rows.rows {
                let mut posterior = vec![0.0; self.shape.states(g)];
                problem.visit(
                    &self.params,
                    i,
                    &mut scratch,
                    |scratch, _, codes, weight| {
                        let found = states(scratch, &scored).into_iter().find(|(k, _)| *k == g);
                        let own = match found {
                            Some((_, own)) => own,
                            None => self.forward(g, &scratch.style, codes),
                        };
                        for (p, r) in posterior.iter_mut().zip(&own) {
                            *p += weight * r;
                        }
                    },
                )?;
                all.push(posterior);
            }
            Ok(all)
        })
    }

    /// P(state of g) given P(s), when nothing below says more.
    pub(super) fn forward(&self, g: usize, style: &[f64], codes: &[u32]) -> Vec<f64> {
        use super::structure::Selector;
        let styles = style.len();
        match &self.shape.structure.selectors[g] {
            Selector::Style => style.to_vec(),
            Selector::Codes(c) => {
                let mut p = vec![0.0; self.shape.states(g)];
                p[configuration(c, &self.shape.sizes, codes)] = 1.0;
                p
            }
            Selector::Hidden(k) => (0..*k)
                .map(|h| {
                    let row = &self.params.tables[g][h * styles..(h + 1) * styles];
                    row.iter().zip(style).map(|(p, r)| p * r).sum()
                })
                .collect(),
        }
    }
}

impl Scored {
    /// A fit without statistics, for reading posteriors.
    fn view(shape: &Shape, params: &Params) -> Self {
        Self {
            shape: shape.clone(),
            params: params.clone(),
            stats: shape.stats(),
            score: 0.0,
        }
    }
}

fn unknown(name: &str) -> ModelError {
    ModelError::Unknown {
        name: name.to_owned(),
    }
}
