//! Draws from a network.

use rand::Rng;

use super::super::elimination::{BucketTree, Mode};
use super::super::error::ModelError;
use super::super::gaussian::gaussian;
use super::super::linalg::{categorical, categorical_of_logs};
use super::super::table::Table;
use super::evidence::{Asked, Evidence, Known, Question, softmax};
use super::{Cpd, Network};

impl Network {
    /// Draws `count` joint assignments given evidence, exactly: what the evidence depends on by elimination, the rest from
    /// its parents (without evidence all of it, so that width does not matter). One row for each draw, one column for
    /// each discrete variable and each coordinate.
    ///
    /// # Errors
    /// As [`Network::log_probability`].
    pub fn sample<R: Rng>(
        &self,
        evidence: &Evidence,
        count: usize,
        rng: &mut R,
    ) -> Result<Table, ModelError> {
        self.draws(self.known(evidence)?, count, rng)
    }

    /// Completes every row of a table `count` times: draws given what the row has; columns that the table lacks, and missing
    /// cells, are drawn. Rows of the result are those of the first row, then of the second, and so on, with all columns of the network.
    ///
    /// # Errors
    /// As [`Network::log_likelihood`].
    pub fn complete<R: Rng>(
        &self,
        data: &Table,
        count: usize,
        rng: &mut R,
    ) -> Result<Table, ModelError> {
        let mut all: Option<Table> = None;
        for (i, row) in self.table_rows(data)?.into_iter().enumerate() {
            let drawn = self.draws(row, count, rng).map_err(|e| e.in_row(i))?;
            all = Some(match all {
                None => drawn,
                Some(mut before) => {
                    before.append(&drawn);
                    before
                }
            });
        }
        all.ok_or(ModelError::Empty { what: "rows" })
    }

    /// Names of the columns that a table of the network has, with the categories of discrete ones: the variables' names, `name[i]` for
    /// the coordinates of a vector of several.
    pub fn table_columns(&self) -> Vec<(String, Option<&[String]>)> {
        let mut all = Vec::new();
        for (n, node) in self.nodes.iter().enumerate() {
            if node.is_discrete() {
                all.push((node.name.clone(), Some(&node.categories[..])));
            }
            let real = (0..node.coordinates.len()).map(|i| (self.column_name(n, i), None));
            all.extend(real);
        }
        all
    }

    fn draws<R: Rng>(&self, known: Known, count: usize, rng: &mut R) -> Result<Table, ModelError> {
        let question = self.question(known, Asked::Evidence)?;
        let tree = self.tree(&question, Mode::Sum)?;
        let mut codes: Vec<Vec<Option<usize>>> = vec![Vec::new(); self.nodes.len()];
        let mut reals: Vec<Vec<Option<f64>>> = vec![Vec::new(); self.width];
        for _ in 0..count {
            let (assignment, real) = self.draw(&question, &tree, rng);
            for (column, v) in codes.iter_mut().zip(assignment) {
                column.push(Some(v));
            }
            for (column, v) in reals.iter_mut().zip(real) {
                column.push(v.is_finite().then_some(v));
            }
        }
        let mut table = Table::new();
        for (n, node) in self.nodes.iter().enumerate() {
            if node.is_discrete() {
                let names: Vec<&str> = node.categories.iter().map(String::as_str).collect();
                table = table.codes(&node.name, &names, codes[n].iter().copied())?;
            }
            for (i, c) in node.coordinates.clone().enumerate() {
                let name = self.column_name(n, i);
                table = table.real(&name, reals[c].iter().copied())?;
            }
        }
        Ok(table)
    }

    fn draw<R: Rng>(
        &self,
        question: &Question,
        tree: &BucketTree,
        rng: &mut R,
    ) -> (Vec<usize>, Vec<f64>) {
        let mut assignment = question.known.assignment();
        let mut real = question.known.real.clone();
        tree.draw(&mut assignment, rng);
        for linked in &question.linked {
            let vars = linked.vars.iter();
            let index = vars.fold(0, |i, &v| i * self.sizes[v] + assignment[v]);
            let particle = linked.particles.get(index);
            let drawn = gaussian(particle.mean, particle.cov, rng);
            for (&c, v) in linked.missing.iter().zip(drawn) {
                real[c] = v;
            }
        }
        for &n in &question.left_out {
            self.draw_node(n, &mut assignment, &mut real, rng);
        }
        (assignment, real)
    }

    /// Draws a node given its parents.
    pub(super) fn draw_node<R: Rng>(
        &self,
        n: usize,
        assignment: &mut [usize],
        real: &mut [f64],
        rng: &mut R,
    ) {
        let node = &self.nodes[n];
        let (configuration, k) = (self.configuration(n, assignment), self.sizes[n]);
        let own = configuration * k..(configuration + 1) * k;
        match &node.cpd {
            Cpd::Table(table) => assignment[n] = categorical(&table[own], rng),
            Cpd::Softmax(weights) => {
                let logs = softmax(weights, &node.regressors, real, k);
                assignment[n] = categorical_of_logs(&logs[own], rng);
            }
            Cpd::Linear(states) => {
                let linear = &states[configuration];
                let mut u = vec![1.0];
                u.extend(node.regressors.iter().map(|&c| real[c]));
                let mut mean = vec![0.0; linear.d];
                linear.mean(&u, &mut mean);
                let drawn = gaussian(&mean, &linear.covariance, rng);
                for (c, v) in node.coordinates.clone().zip(drawn) {
                    real[c] = v;
                }
            }
        }
    }
}
