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

/// A learned hierarchical model: Eq. 1 of [the module](super) with its parameters.
///
/// Rows that it is asked about are a [`Table`] whose columns are found by name, in any order and in the units of the training
/// data; what is missing or has no column is summed or integrated out. It comes from [`learn`](super::learn()) or
/// [`fit`](super::fit()); [`Hierarchy::sample`] and [`Hierarchy::complete`] draw from it ([`Draws`](super::Draws)),
/// [`Hierarchy::to_network`] makes it a network, for questions beyond those here. Time of a question: as in the module.
/// Sources: Fan and Wonka 2016, Sec. 5.2; Koller and Friedman 2009, Ch. 9 and 14.
///
/// # Examples
/// ```
/// use edifice_model::{Table, em::Stopping, hierarchy::{Group, Hierarchy, Priors, fit}};
/// let width = (0..60).map(|i| Some(if i % 3 == 0 { 5.0 } else { 12.0 } + (i % 5) as f64 * 0.1));
/// let houses = Table::new()
///     .real("width", width)?
///     .binary("garage", (0..60).map(|i| Some(i % 3 > 0)))?;
/// let groups = [Group::new("size", &["width"]), Group::new("parts", &["garage"])];
/// let model = fit(&houses, &groups, 2, &[2], &Priors::default(), &Stopping::default(), 1)?.model;
/// // Of one house no more is known than that it has a garage. Bayes' rule by hand:
/// let garage = Table::new().binary("garage", [Some(true)])?;
/// let (p, yes) = (model.style_probabilities(), model.category_probabilities("garage")?);
/// let total = p[0] * yes[0][1] + p[1] * yes[1][1];
/// assert!((model.style_posterior(&garage)?[0][0] - p[0] * yes[0][1] / total).abs() < 1e-12);
/// assert!((model.log_likelihood(&garage)?[0] - total.ln()).abs() < 1e-12);
/// // It is wide, then.
/// let kinds = &model.state_posterior(&garage, "size")?[0];
/// assert!(kinds[0].max(kinds[1]) > 0.9 && (kinds[0] + kinds[1] - 1.0).abs() < 1e-12);
/// // Stored and read, it is the same model.
/// let read = Hierarchy::from_json(&model.to_json()?)?;
/// assert_eq!(read.style_posterior(&houses)?, model.style_posterior(&houses)?);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
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

    /// P(S = s), |S| numbers of sum 1.
    pub fn style_probabilities(&self) -> &[f64] {
        &self.params.style
    }

    /// A table of the model's columns without rows, in the order of its draws: their kinds and categories.
    ///
    /// # Errors
    /// [`ModelError::Duplicate`] for a model that was stored with two columns of one name.
    pub fn columns(&self) -> Result<Table, ModelError> {
        self.schema.decode(&Rows {
            rows: 0,
            d: self.schema.reals.len(),
            c: self.schema.codes.len(),
            reals: Vec::new(),
            codes: Vec::new(),
        })
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

    /// Number of free parameters, as BIC counts them.
    ///
    /// `|S| - 1 + Σ_g k_g (p_g d_g + d_g (d_g + 1)/2) + Σ_c |S| r_c (n_c - 1)` for n_c categories given r_c configurations of a
    /// column's other parents, and `|S| (k_g - 1)` for each H_g. Of the indicators of a categorical parent, which sum to 1, one
    /// is not counted in p_g.
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
    /// its categories per style. Of a column with other parents, given the first category of each.
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
    pub(crate) fn problem<'a>(&'a self, rows: &'a Rows, priors: &'a Priors) -> Problem<'a> {
        Problem {
            schema: &self.schema,
            rows,
            priors,
            shape: self.shape.clone(),
            within: None,
        }
    }

    /// `log p(row)` of every row, nats, in the columns' own units; missing values and columns that
    /// `data` lacks are integrated out. A density over the observed real values times a probability of the categories, so that
    /// it may be positive; a row without values has 0.
    ///
    /// # Errors
    /// An unseen category, a column of the wrong kind, or evidence of probability zero; [`ModelError::Parameter`] for a row that
    /// lacks too many categories that have children.
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

    /// P(S = s | row) of every row: rows x |S|,
    /// `P(s | x) ∝ P(s) Π_k P(E_k | s) Π_g Σ_h P(h | s) p(C_g | h, π(C_g))` over what the row has.
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

    /// P(state of `group` | row) of every row, rows x k_g: of its hidden variable where it has one,
    /// `P(h | x) = Σ_s P(s | x) P(h | s, x)`; else of S, or of the configuration of its categorical parents.
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
