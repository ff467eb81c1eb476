//! Rows drawn from a learned model: forward, given some of their values, and the most probable.

use rand::{Rng, RngExt};

use super::super::conjugate::Linear;
use super::super::error::ModelError;
use super::super::gaussian::gaussian;
use super::super::table::{MISSING, Table};
use super::Priors;
use super::infer::{Scratch, joint};
use super::query::Hierarchy;
use super::schema::Rows;
use super::structure::configuration;
use edifice_base::rng::categorical;

/// Rows drawn from a model by [`Hierarchy::sample`], [`Hierarchy::sample_style`], [`Hierarchy::complete`] or
/// [`Hierarchy::most_probable`].
///
/// Draws are independent: forward `s ~ P(S)`, `h ~ P(H_g | s)`, `C_g ~ N(B_ghᵀ (1, π(C_g)), Σ_gh)`; given a row, of the posterior
/// of its hidden variables and missing values together, as exact as inference is. A draw takes the time of one inference and
/// one density, as in [the module](super). Sources: Fan and Wonka 2016, Sec. 7 (synthesis, completion); Koller and Friedman
/// 2009, Sec. 12.1.
///
/// # Examples
/// ```
/// use edifice_base::unwatched;
/// use edifice_model::{Cell, Table, em::Stopping, hierarchy::{Group, Priors, fit}};
/// use edifice_base::rng::stream;
/// let width = (0..60).map(|i| Some(if i % 3 == 0 { 5.0 } else { 12.0 } + (i % 5) as f64 * 0.1));
/// let houses = Table::new()
///     .real("width", width)?
///     .binary("garage", (0..60).map(|i| Some(i % 3 > 0)))?;
/// let groups = [Group::new("size", &["width"]), Group::new("parts", &["garage"])];
/// let model = fit(&houses, &groups, 2, &[2], &Settings::default(), 1, &unwatched)?.model;
/// let mut rng = stream(1, "draws", 0);
/// let draws = model.sample(500, &mut rng)?;
/// let told = model.log_likelihood(&draws.table)?;
/// assert!(draws.log_density.iter().zip(&told).all(|(a, b)| (a - b).abs() < 1e-9));
/// // How wide are houses with a garage? What is given stays.
/// let garage = Table::new().binary("garage", [Some(true)])?;
/// let wide = model.complete(&garage, 500, &mut rng)?.table;
/// let real = |cell: Cell| if let Cell::Real(x) = cell { x } else { f64::NAN };
/// let mean = (0..500).map(|i| real(wide.columns()[0].cell(i))).sum::<f64>() / 500.0;
/// assert!((mean - 12.2).abs() < 0.5);
/// assert!((0..500).all(|i| wide.columns()[1].cell(i) == Cell::Code(1)));
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Draws {
    /// Complete rows: real columns first, then categorical ones, in the order of the groups.
    pub table: Table,
    /// Value of S behind each row.
    pub styles: Vec<usize>,
    /// Log density of each complete row, nats, in the columns' own units.
    pub log_density: Vec<f64>,
}

impl Hierarchy {
    /// Draws `count` rows by forward sampling.
    ///
    /// # Errors
    /// [`ModelError::Empty`] for no rows.
    pub fn sample<R: Rng>(&self, count: usize, rng: &mut R) -> Result<Draws, ModelError> {
        self.draw(&Table::new(), count, None, rng)
    }

    /// Draws `count` rows of style `style`.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] when there is no such style; [`ModelError::Empty`] for no rows.
    pub fn sample_style<R: Rng>(
        &self,
        style: usize,
        count: usize,
        rng: &mut R,
    ) -> Result<Draws, ModelError> {
        if style >= self.styles() {
            return Err(ModelError::parameter(
                "style",
                format!("there are {}", self.styles()),
            ));
        }
        self.draw(&Table::new(), count, Some(style), rng)
    }

    /// Completes every row of `given` `count` times: missing values and absent columns are drawn
    /// from their joint posterior given the row's own values. Rows come in the order of `given`,
    /// the draws of one row together.
    ///
    /// # Errors
    /// As [`Hierarchy::log_likelihood`]; [`ModelError::Empty`] for no rows.
    pub fn complete<R: Rng>(
        &self,
        given: &Table,
        count: usize,
        rng: &mut R,
    ) -> Result<Draws, ModelError> {
        if given.rows() == 0 {
            return Err(ModelError::Empty { what: "rows" });
        }
        self.draw(given, count, None, rng)
    }

    /// The `count` most probable of `pool` completions of the single-row table `given` (without
    /// columns: of forward samples), most probable first, leaving out any that comes closer than
    /// `apart` standard deviations (root mean square over real columns) to a better one or to a
    /// row of `seen` with the same categories. Fewer than `count` where the pool has no more.
    ///
    /// Time: `pool` draws and at most `pool (count + rows of seen)` distances. Source: Fan and Wonka 2016, Sec. 7,
    /// *Evaluation of synthesized results*.
    ///
    /// # Errors
    /// As [`Hierarchy::complete`].
    pub fn most_probable<R: Rng>(
        &self,
        given: &Table,
        count: usize,
        pool: usize,
        apart: f64,
        seen: Option<&Table>,
        rng: &mut R,
    ) -> Result<Draws, ModelError> {
        let draws = self.draw(given, pool, None, rng)?;
        let rows = self.schema.encode(&draws.table)?;
        let known = seen.map(|t| self.schema.encode(t)).transpose()?;
        let mut order: Vec<usize> = (0..rows.rows).collect();
        order.sort_by(|&a, &b| draws.log_density[b].total_cmp(&draws.log_density[a]));
        let close = |a: &Rows, i: usize, b: &Rows, j: usize| {
            a.code(i) == b.code(j) && distance(a.real(i), b.real(j)) < apart
        };
        let mut kept: Vec<usize> = Vec::new();
        for i in order {
            if kept.len() == count {
                break;
            }
            let near_known = known
                .as_ref()
                .is_some_and(|k| (0..k.rows).any(|j| close(&rows, i, k, j)));
            if !near_known && !kept.iter().any(|&j| close(&rows, i, &rows, j)) {
                kept.push(i);
            }
        }
        Ok(Draws {
            table: draws.table.select(&kept),
            styles: kept.iter().map(|&i| draws.styles[i]).collect(),
            log_density: kept.iter().map(|&i| draws.log_density[i]).collect(),
        })
    }

    fn draw<R: Rng>(
        &self,
        given: &Table,
        count: usize,
        style: Option<usize>,
        rng: &mut R,
    ) -> Result<Draws, ModelError> {
        let mut rows = self.schema.encode(given)?;
        if given.columns().is_empty() {
            // Nothing observed: one empty row.
            rows.rows = 1;
            rows.reals = vec![f64::NAN; rows.d];
            rows.codes = vec![MISSING; rows.c];
        }
        if count == 0 || rows.rows == 0 {
            return Err(ModelError::Empty { what: "rows" });
        }
        let mut drawn = Rows {
            rows: rows.rows * count,
            reals: Vec::with_capacity(rows.rows * count * rows.d),
            codes: Vec::with_capacity(rows.rows * count * rows.c),
            ..rows
        };
        let mut styles = Vec::with_capacity(drawn.rows);
        let priors = Priors::default();
        let problem = self.problem(&rows, &priors);
        let mut scratch = Scratch::new(&self.shape);
        let mut row = Vec::new();
        for i in 0..rows.rows {
            let mut ways: Vec<(Vec<u32>, f64)> = Vec::new();
            problem.visit(
                &self.params,
                i,
                &mut scratch,
                |scratch, _, codes, weight| {
                    // P(codes | row), or P(codes, S = style | row).
                    let share = style.map_or(1.0, |s| scratch.style[s]);
                    ways.push((codes.to_vec(), weight * share));
                },
            )?;
            for _ in 0..count {
                let weights: Vec<f64> = ways.iter().map(|w| w.1).collect();
                let codes = &ways[categorical(&weights, rng)].0;
                let real = self.shape.extended(rows.real(i), codes, &mut row);
                scratch.infer(&self.shape, &self.params, real, codes);
                let (real, codes, s) = self.complete_row(real, codes, style, &mut scratch, rng);
                drawn.reals.extend(&real[..rows.d]);
                drawn.codes.extend(codes);
                styles.push(s);
            }
        }
        let mut log_density = Vec::with_capacity(drawn.rows);
        for i in 0..drawn.rows {
            let real = (self.shape).extended(drawn.real(i), drawn.code(i), &mut row);
            scratch.infer(&self.shape, &self.params, real, drawn.code(i));
            log_density.push(scratch.log_likelihood - self.log_scale(drawn.real(i)));
        }
        Ok(Draws {
            table: self.schema.decode(&drawn)?,
            styles,
            log_density,
        })
    }

    /// Draws S, then states and missing values of every group, parents before children; `real` is extended.
    fn complete_row<R: Rng>(
        &self,
        real: &[f64],
        codes: &[u32],
        style: Option<usize>,
        scratch: &mut Scratch,
        rng: &mut R,
    ) -> (Vec<f64>, Vec<u32>, usize) {
        let shape = &self.shape;
        let styles = self.styles();
        let s = style.unwrap_or_else(|| categorical(&scratch.style, rng));
        let mut real = real.to_vec();
        let mut codes = codes.to_vec();
        // Only leaves are still missing, or (nothing observed) everything was enumerated.
        for c in 0..codes.len() {
            if codes[c] == MISSING {
                let k = configuration(&shape.structure.code_parents[c], &shape.sizes, &codes);
                let size = shape.sizes[c];
                let p: Vec<f64> = (0..size)
                    .map(|v| self.params.codes[c][(k * size + v) * styles + s])
                    .collect();
                codes[c] = categorical(&p, rng) as u32;
            }
        }
        let mut only = vec![0.0; styles];
        only[s] = 1.0;
        for component in &scratch.components {
            let joint = joint(component, &only);
            let weights: Vec<f64> = joint.chunks(styles).map(|j| j[s]).collect();
            let particle = component.particles.get(categorical(&weights, rng));
            let drawn = gaussian(particle.mean, particle.cov, rng);
            for (&c, v) in component.missing.iter().zip(drawn) {
                real[c] = v;
            }
        }
        for &g in &shape.order {
            if scratch.pattern.barren.contains(&g) {
                let state = categorical(&self.forward(g, &only, &codes), rng);
                let linear = match &shape.background {
                    Some(background) if rng.random_bool(background.share) => &background.linear[g],
                    _ => &self.params.linear[g][state],
                };
                draw_linear(linear, &shape.columns[g], &mut real, rng);
            }
        }
        (real, codes, s)
    }
}

/// Root mean square difference of standardised rows.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().max(1) as f64;
    let sum: f64 = a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum();
    (sum / n).sqrt()
}

/// Fills the own columns of a group from its linear Gaussian.
fn draw_linear<R: Rng>(linear: &Linear, columns: &[usize], real: &mut [f64], rng: &mut R) {
    let mut u = vec![1.0];
    u.extend(columns.iter().map(|&c| real[c]));
    let mut mean = vec![0.0; linear.d];
    linear.mean(&u, &mut mean);
    let drawn = gaussian(&mean, &linear.covariance, rng);
    for (&c, v) in columns[linear.p - 1..].iter().zip(drawn) {
        real[c] = v;
    }
}
