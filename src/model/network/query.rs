//! Questions to a network.

use super::super::elimination::{BucketTree, Mode, TooWide};
use super::super::error::ModelError;
use super::Network;
use super::evidence::{Asked, Evidence, Known, Question};

/// Posterior of one variable: `P(y | e) = Σ_x P(x, y, e) / P(e)`, as many numbers as it has categories, of sum 1.
///
/// [`Network::marginals`] gives one for every discrete variable from one pass forward and one backward over the buckets
/// (Koller and Friedman 2009, Ch. 9 and 10): time linear in the cells of all their tables. [`Network::marginal`] is for a
/// single variable, and leaves out more that is barren.
///
/// # Examples
/// ```
/// use edifice_model::network::{Evidence, Network, Variable};
/// let network = Network::new(vec![
///     Variable::table("ill", &["no", "yes"], &[], &[0.99, 0.01]),
///     Variable::table("test", &["-", "+"], &["ill"], &[0.95, 0.05, 0.1, 0.9]),
/// ])?;
/// let answers = network.marginals(&Evidence::new().is("test", "+"))?;
/// assert_eq!(answers[0].name, "ill");
/// // Bayes' rule by hand.
/// assert!((answers[0].probabilities[1] - 0.009 / (0.009 + 0.0495)).abs() < 1e-12);
/// assert_eq!(answers[1].probabilities, [0.0, 1.0]);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The variable.
    pub name: String,
    /// P(category | evidence), in order of the categories.
    pub probabilities: Vec<f64>,
}

/// An assignment of categories to all discrete variables, with the continuous ones integrated out.
///
/// The most probable one, `argmax_x P(x, e)`, comes from [`Network::explain`], the best few from [`Network::explanations`]
/// (elimination by maxima; Koller and Friedman 2009, Sec. 13.2). It need not consist of the most probable category of
/// every variable. Time: one pass over the buckets, as for [`Answer`]; each explanation beyond the first adds at most
/// `O(n k)` partial assignments for n variables of at most k categories.
///
/// # Examples
/// ```
/// use edifice_model::network::{Evidence, Network, Variable};
/// let network = Network::new(vec![
///     Variable::table("a", &["0", "1"], &[], &[0.4, 0.6]),
///     Variable::table("b", &["0", "1"], &["a"], &[0.1, 0.9, 0.5, 0.5]),
/// ])?;
/// let nothing = Evidence::new();
/// let best = network.explain(&nothing)?;
/// // P(a = 0, b = 1) = 0.36 is most, although P(a = 1) = 0.6.
/// assert_eq!(best.values[0].1, "0");
/// assert!((best.log_joint - 0.36_f64.ln()).abs() < 1e-12);
/// let all = network.explanations(&nothing, 10)?;
/// assert!((all.iter().map(|e| e.log_joint.exp()).sum::<f64>() - 1.0).abs() < 1e-12);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// (variable, category) in order of the variables, observed ones included.
    pub values: Vec<(String, String)>,
    /// `log P(assignment, evidence)`, nats.
    pub log_joint: f64,
}

impl Network {
    /// Eliminates the factors of a question.
    ///
    /// # Errors
    /// [`ModelError::TooWide`]; [`ModelError::Contradiction`] for evidence of probability zero.
    pub(crate) fn tree(&self, question: &Question, mode: Mode) -> Result<BucketTree, ModelError> {
        let tree = BucketTree::new(question.factors.clone(), &self.sizes, mode);
        self.possible(tree.map_err(|e| self.too_wide(&e))?, question)
    }

    fn too_wide(&self, error: &TooWide) -> ModelError {
        ModelError::TooWide {
            variable: self.nodes[error.variable].name.clone(),
            width: error.width,
            cells: error.cells,
        }
    }

    fn possible(&self, tree: BucketTree, question: &Question) -> Result<BucketTree, ModelError> {
        if tree.total > f64::NEG_INFINITY {
            return Ok(tree);
        }
        Err(ModelError::Contradiction {
            row: None,
            variable: self.culprit(&question.known),
        })
    }

    /// The first observed variable, parents before children, at which the evidence becomes impossible: by bisection, as
    /// more evidence does not make it possible again.
    fn culprit(&self, known: &Known) -> String {
        let soft = |n: usize| known.soft.iter().any(|(s, _)| *s == n);
        let seen = |n: &usize| {
            let mut own = self.nodes[*n].coordinates.clone();
            known.discrete[*n].is_some() || soft(*n) || own.any(|c| !known.real[c].is_nan())
        };
        let observed: Vec<usize> = self.order.iter().copied().filter(seen).collect();
        let (mut possible, mut impossible) = (0, observed.len());
        while impossible - possible > 1 {
            let middle = (possible + impossible) / 2;
            let mut first = known.clone();
            for &n in &observed[middle..] {
                first.discrete[n] = None;
                first.soft.retain(|(s, _)| *s != n);
                first.real[self.nodes[n].coordinates.clone()].fill(f64::NAN);
            }
            let question = self.question(first, Asked::Evidence).ok();
            let total = question
                .and_then(|q| BucketTree::new(q.factors, &self.sizes, Mode::Sum).ok())
                .map(|t| t.total);
            match total {
                Some(f64::NEG_INFINITY) => impossible = middle,
                _ => possible = middle,
            }
        }
        match observed.get(possible) {
            Some(&n) => self.nodes[n].name.clone(),
            None => "no evidence".to_owned(),
        }
    }

    /// `log p(evidence)`, nats: a density over the observed coordinates.
    ///
    /// # Errors
    /// Names or categories that are not there, values that are not finite, a softmax whose
    /// continuous parent is not observed; [`ModelError::Contradiction`] for probability zero.
    pub fn log_probability(&self, evidence: &Evidence) -> Result<f64, ModelError> {
        let question = self.question(self.known(evidence)?, Asked::Evidence)?;
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
        let question = self.question(self.known(evidence)?, Asked::Variable(n))?;
        if let Some(v) = question.known.discrete[n] {
            self.tree(&question, Mode::Sum)?;
            return Ok(certain(v, self.sizes[n]));
        }
        let tree = match BucketTree::new(question.factors.clone(), &self.sizes, Mode::Sum) {
            Ok(tree) => tree,
            // The rest is independent of it given the evidence.
            Err(_) => BucketTree::new(question.component(n), &self.sizes, Mode::Sum)
                .map_err(|e| self.too_wide(&e))?,
        };
        Ok(self.possible(tree, &question)?.beliefs().of(&[n]))
    }

    /// P(variable | evidence) of every discrete variable, in order of the variables; a softmax
    /// whose continuous parents are unknown is left out.
    ///
    /// # Errors
    /// As [`Network::log_probability`].
    pub fn marginals(&self, evidence: &Evidence) -> Result<Vec<Answer>, ModelError> {
        let question = self.question(self.known(evidence)?, Asked::Discrete)?;
        let tree = self.tree(&question, Mode::Sum)?;
        let beliefs = tree.beliefs();
        let nodes = self.nodes.iter().enumerate();
        let answers = nodes.filter(|(_, node)| node.is_discrete());
        let answers = answers.map(|(n, node)| Answer {
            name: node.name.clone(),
            probabilities: match question.known.discrete[n] {
                Some(v) => certain(v, self.sizes[n]),
                None => beliefs.of(&[n]),
            },
        });
        Ok(answers.filter(|a| !a.probabilities.is_empty()).collect())
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
        let question = self.question(known, Asked::Variable(n))?;
        let tree = self.tree(&question, Mode::Sum)?;
        let beliefs = tree.beliefs();
        let d = own.len();
        let (mut mean, mut second) = (vec![0.0; d], vec![0.0; d * d]);
        for linked in question.linked.iter().filter(|l| l.nodes.contains(&n)) {
            let weights = beliefs.of(&linked.vars);
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

    /// The `count` most probable explanations, most probable first.
    ///
    /// # Errors
    /// As [`Network::log_probability`].
    pub fn explanations(
        &self,
        evidence: &Evidence,
        count: usize,
    ) -> Result<Vec<Explanation>, ModelError> {
        let question = self.question(self.known(evidence)?, Asked::Discrete)?;
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
        let question = self.question(self.known(evidence)?, Asked::Discrete)?;
        let tree = self.tree(&question, Mode::Max)?;
        let mut assignment = question.known.assignment();
        tree.decode(&mut assignment);
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
}

/// The distribution of an observed variable of `k` categories.
fn certain(value: usize, k: usize) -> Vec<f64> {
    (0..k).map(|i| f64::from(u8::from(i == value))).collect()
}
