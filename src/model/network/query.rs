//! Questions to a network.

use rand::Rng;
use rand::rngs::SmallRng;

use super::super::error::ModelError;
use super::super::gaussian::gaussian;
use super::super::linalg::{categorical_of_logs, log_sum_exp};
use super::evidence::{Evidence, Question, softmax};
use super::factor::{Factor, Mode};
use super::tree::Tree;
use super::{Cpd, Network};

/// Posterior of one variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The variable.
    pub name: String,
    /// P(category | evidence), in order of the categories.
    pub probabilities: Vec<f64>,
}

/// An assignment of categories to all discrete variables, with the continuous ones integrated out.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// (variable, category) in order of the variables, observed ones included.
    pub values: Vec<(String, String)>,
    /// `log P(assignment, evidence)`, nats.
    pub log_joint: f64,
}

impl Network {
    pub(crate) fn tree(&self, question: &Question, mode: Mode) -> Result<Tree, ModelError> {
        let tree = Tree::new(question.factors.clone(), &self.sizes, mode);
        let tree = tree.ok_or_else(|| {
            ModelError::parameter("network", "a table of the elimination would be too large")
        })?;
        if tree.total.is_finite() {
            return Ok(tree);
        }
        Err(ModelError::Contradiction {
            row: 0,
            variable: self.culprit(question),
        })
    }

    /// The first observed variable at which the evidence becomes impossible.
    fn culprit(&self, question: &Question) -> String {
        let mut known = question.known.clone();
        known.discrete.fill(None);
        known.real.fill(f64::NAN);
        for &n in &self.order {
            known.discrete[n] = question.known.discrete[n];
            for c in self.nodes[n].coordinates.clone() {
                known.real[c] = question.known.real[c];
            }
            let total = self
                .question(known.clone())
                .ok()
                .and_then(|q| Tree::new(q.factors, &self.sizes, Mode::Sum))
                .map(|t| t.total);
            if total.is_some_and(|t| !t.is_finite()) {
                return self.nodes[n].name.clone();
            }
        }
        "the evidence as a whole".to_owned()
    }

    /// `log p(evidence)`, nats: a density over the observed coordinates.
    ///
    /// # Errors
    /// Names or categories that are not there, values that are not finite, a softmax whose
    /// continuous parent is not observed; [`ModelError::Contradiction`] for probability zero.
    pub fn log_probability(&self, evidence: &Evidence) -> Result<f64, ModelError> {
        let question = self.question(self.known(evidence)?)?;
        Ok(self.tree(&question, Mode::Sum)?.total)
    }

    /// P(variable | evidence) of one discrete variable.
    ///
    /// # Errors
    /// As [`Network::log_probability`]; [`ModelError::Kind`] for a real vector.
    pub fn marginal(&self, evidence: &Evidence, name: &str) -> Result<Vec<f64>, ModelError> {
        let n = self.find(name)?;
        if !self.nodes[n].is_discrete() {
            return Err(ModelError::Kind {
                column: name.to_owned(),
                got: "a real vector",
                expected: "discrete",
            });
        }
        let all = self.marginals(evidence)?;
        let found = all.into_iter().find(|a| a.name == name);
        found.map(|a| a.probabilities).ok_or_else(|| {
            ModelError::parameter(name, "a continuous parent of it must be observed")
        })
    }

    /// P(variable | evidence) of every discrete variable, in order of the variables; a softmax
    /// whose continuous parents are unknown is left out.
    ///
    /// # Errors
    /// As [`Network::log_probability`].
    pub fn marginals(&self, evidence: &Evidence) -> Result<Vec<Answer>, ModelError> {
        let question = self.question(self.known(evidence)?)?;
        let tree = self.tree(&question, Mode::Sum)?;
        let beliefs = tree.beliefs();
        let mut answers = Vec::new();
        for (n, node) in self
            .nodes
            .iter()
            .enumerate()
            .filter(|(_, n)| n.is_discrete())
        {
            let probabilities = match question.known.discrete[n] {
                Some(v) => (0..self.sizes[n])
                    .map(|i| f64::from(u8::from(i == v)))
                    .collect(),
                // The last variable of a bucket's scope is its own.
                None => match beliefs.iter().find(|b| b.vars.last() == Some(&n)) {
                    Some(belief) => distribution(&belief.onto(&[n], &self.sizes, Mode::Sum)),
                    None => continue,
                },
            };
            answers.push(Answer {
                name: node.name.clone(),
                probabilities,
            });
        }
        Ok(answers)
    }

    /// Mean and covariance (row-major) of a real vector given evidence: the moments of its exact
    /// posterior, a mixture of Gaussians.
    ///
    /// # Errors
    /// As [`Network::log_probability`]; [`ModelError::Kind`] for a discrete variable.
    pub fn moments(
        &self,
        evidence: &Evidence,
        name: &str,
    ) -> Result<(Vec<f64>, Vec<f64>), ModelError> {
        let n = self.find(name)?;
        if self.nodes[n].is_discrete() {
            return Err(ModelError::Kind {
                column: name.to_owned(),
                got: "discrete",
                expected: "a real vector",
            });
        }
        let own: Vec<usize> = self.nodes[n].coordinates.clone().collect();
        let known = self.known(evidence)?;
        // Ask for n explicitly: it is linked as if its children were observed.
        let question = self.question_about(known, n)?;
        let tree = self.tree(&question, Mode::Sum)?;
        let d = own.len();
        let (mut mean, mut second) = (vec![0.0; d], vec![0.0; d * d]);
        for linked in question.linked.iter().filter(|l| l.nodes.contains(&n)) {
            let weights = self.weights(&tree, &linked.vars);
            for (particle, w) in linked.particles.iter().zip(weights) {
                let place: Vec<Option<usize>> = own
                    .iter()
                    .map(|c| linked.missing.iter().position(|m| m == c))
                    .collect();
                let at = |i: usize| match place[i] {
                    Some(m) => particle.mean[m],
                    None => question.known.real[own[i]],
                };
                for i in 0..d {
                    mean[i] += w * at(i);
                    for j in 0..d {
                        second[i * d + j] += w * at(i) * at(j);
                        if let (Some(a), Some(b)) = (place[i], place[j]) {
                            second[i * d + j] += w * particle.cov[a * linked.missing.len() + b];
                        }
                    }
                }
            }
        }
        for i in 0..d {
            for j in 0..d {
                second[i * d + j] -= mean[i] * mean[j];
            }
        }
        Ok((mean, second))
    }

    /// P(configuration of `vars` | evidence), the last variable fastest; they share a bucket.
    pub(crate) fn weights(&self, tree: &Tree, vars: &[usize]) -> Vec<f64> {
        if vars.is_empty() {
            return vec![1.0];
        }
        let beliefs = tree.beliefs();
        let belief = beliefs
            .iter()
            .find(|b| vars.iter().all(|v| b.vars.contains(v)));
        belief.map_or_else(Vec::new, |b| {
            distribution(&b.onto(vars, &self.sizes, Mode::Sum))
        })
    }

    /// The `count` most probable explanations, most probable first.
    ///
    /// # Errors
    /// As [`Network::log_probability`].
    pub fn explanations(
        &self,
        evidence: &Evidence,
        count: usize,
    ) -> Result<Vec<Explanation>, ModelError> {
        let question = self.question(self.known(evidence)?)?;
        let tree = self.tree(&question, Mode::Max)?;
        let start = question.known.assignment();
        let found = tree.best(count, &start);
        Ok(found
            .into_iter()
            .map(|(log_joint, assignment)| Explanation {
                values: self.named(&assignment),
                log_joint,
            })
            .collect())
    }

    /// The most probable explanation.
    ///
    /// # Errors
    /// As [`Network::log_probability`].
    pub fn explain(&self, evidence: &Evidence) -> Result<Explanation, ModelError> {
        let question = self.question(self.known(evidence)?)?;
        let tree = self.tree(&question, Mode::Max)?;
        let mut assignment = question.known.assignment();
        tree.decode(&mut assignment, None::<&mut SmallRng>);
        Ok(Explanation {
            values: self.named(&assignment),
            log_joint: tree.total,
        })
    }

    fn named(&self, assignment: &[usize]) -> Vec<(String, String)> {
        let nodes = self
            .nodes
            .iter()
            .zip(assignment)
            .filter(|(n, _)| n.is_discrete());
        nodes
            .map(|(n, &v)| (n.name.clone(), n.categories[v].clone()))
            .collect()
    }

    /// Draws `count` joint assignments given evidence (none: forward samples), each as complete
    /// evidence by index: categories of every node, and all coordinates.
    ///
    /// # Errors
    /// As [`Network::log_probability`].
    pub fn sample<R: Rng>(
        &self,
        evidence: &Evidence,
        count: usize,
        rng: &mut R,
    ) -> Result<super::super::table::Table, ModelError> {
        let question = self.question(self.known(evidence)?)?;
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
        let mut table = super::super::table::Table::new();
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

    /// Name of the data column of a coordinate: the variable's own name when it has only one,
    /// `name[i]` otherwise.
    pub(crate) fn column_name(&self, n: usize, i: usize) -> String {
        let node = &self.nodes[n];
        if node.coordinates.len() == 1 {
            node.name.clone()
        } else {
            format!("{}[{i}]", node.name)
        }
    }

    fn draw<R: Rng>(
        &self,
        question: &Question,
        tree: &Tree,
        rng: &mut R,
    ) -> (Vec<usize>, Vec<f64>) {
        let mut assignment = question.known.assignment();
        let mut real = question.known.real.clone();
        tree.decode(&mut assignment, Some(rng));
        for linked in &question.linked {
            let index = linked
                .vars
                .iter()
                .fold(0, |i, &v| i * self.sizes[v] + assignment[v]);
            let particle = &linked.particles[index];
            let drawn = gaussian(&particle.mean, &particle.cov, rng);
            for (&c, v) in linked.missing.iter().zip(drawn) {
                real[c] = v;
            }
        }
        // What has no evidence below it follows its parents, in order.
        for &n in &self.order {
            let node = &self.nodes[n];
            let open = question.known.discrete[n].is_none()
                && !question.factors.iter().any(|f| f.vars.contains(&n));
            let from = self.configuration(n, &assignment) * self.sizes[n];
            match &node.cpd {
                Cpd::Softmax(weights) if open => {
                    let logs = softmax(weights, &node.regressors, &real, self.sizes[n]);
                    assignment[n] = categorical_of_logs(&logs[from..from + self.sizes[n]], rng);
                }
                Cpd::Table(table) if open => {
                    let row = table[from..from + self.sizes[n]].iter();
                    assignment[n] =
                        categorical_of_logs(&row.map(|p| p.ln()).collect::<Vec<_>>(), rng);
                }
                Cpd::Linear(_) if question.free.contains(&n) => {
                    if let Some(linear) = self.state(n, &assignment) {
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
                _ => {}
            }
        }
        (assignment, real)
    }
}

/// Probabilities from log values.
pub(crate) fn distribution(factor: &Factor) -> Vec<f64> {
    let total = log_sum_exp(&factor.values);
    factor.values.iter().map(|v| (v - total).exp()).collect()
}
