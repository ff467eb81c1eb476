//! Production rule inference (Sec. 4.1.2, Eq. 10), online.

use rustc_hash::FxHashMap;

use super::nary::{NaryNode, NaryTree};
use edifice_shape::Axis;

/// The call that a rule makes for one of its parts.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Call {
    /// Insert the asset with this label.
    Insert(u32),
    /// Apply the rule with this number.
    Rule(u32),
}

/// A parametric rule `r(x) -> split(d){ x_1 : r_1 | ... | x_k : r_k }` (Eq. 10).
#[derive(Debug, Clone, PartialEq)]
pub struct ParametricRule {
    /// Splitting direction.
    pub axis: Axis,
    /// The parts; every rule called has a lower number.
    pub children: Vec<Call>,
    /// Number of nodes, over all facades, that this rule replaced.
    pub uses: u64,
    /// Number of parameters, the rule's own and those carried over from the rules it calls.
    pub parameters: usize,
    /// Mean of each own parameter over its uses, in the unit of the facades.
    pub mean: Vec<f64>,
    /// Sum of squared deviations of each own parameter from its mean.
    pub deviation: Vec<f64>,
}

/// A facade as a call of a starting rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    /// Extent along x.
    pub width: f64,
    /// Extent along y.
    pub height: f64,
    /// The starting rule; an asset when the facade is one.
    pub start: Call,
    /// The parameter vector: the sizes of the starting rule's parts, then those of the rules it
    /// calls, part by part, depth first.
    pub parameters: Vec<f64>,
}

/// The rule set `R`, with one rule per operation and children, whatever the sizes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RuleSet {
    rules: Vec<ParametricRule>,
    index: FxHashMap<(Axis, Vec<Call>), u32>,
}

impl RuleSet {
    /// Adds a facade: bottom-up, each split node becomes a call of the rule with its operation and
    /// children, a new rule if there was none. Linear in the facade, whatever was added before.
    pub fn add(&mut self, tree: &NaryTree) -> Instance {
        let mut calls = vec![Call::Insert(0); tree.nodes.len()];
        for (node, content) in tree.nodes.iter().enumerate().rev() {
            calls[node] = match content {
                NaryNode::Insert(label) => Call::Insert(*label),
                NaryNode::Split {
                    axis,
                    sizes,
                    children,
                } => {
                    let children = children.iter().map(|&c| calls[c as usize]).collect();
                    let rule = self.intern(*axis, children);
                    self.rules[rule as usize].observe(sizes);
                    Call::Rule(rule)
                }
            };
        }
        tree.instance(calls[0])
    }

    /// The rules by number.
    pub fn rules(&self) -> &[ParametricRule] {
        &self.rules
    }

    /// `|R|`: number of rules.
    pub fn len(&self) -> usize {
        self.rules.len()
    }

    /// True if there is no rule.
    pub fn is_empty(&self) -> bool {
        self.rules.is_empty()
    }

    /// The number of the rule with this operation and these children, new if there was none.
    fn intern(&mut self, axis: Axis, children: Vec<Call>) -> u32 {
        let key = (axis, children);
        if let Some(&rule) = self.index.get(&key) {
            return rule;
        }
        let id = self.rules.len() as u32;
        let carried = key.1.iter().fold(0_usize, |sum, &call| {
            sum.saturating_add(self.parameter_count(call))
        });
        self.rules.push(ParametricRule {
            axis,
            children: key.1.clone(),
            uses: 0,
            parameters: carried.saturating_add(key.1.len()),
            mean: vec![0.0; key.1.len()],
            deviation: vec![0.0; key.1.len()],
        });
        self.index.insert(key, id);
        id
    }

    /// Number of parameters of a call.
    pub fn parameter_count(&self, call: Call) -> usize {
        match call {
            Call::Insert(_) => 0,
            Call::Rule(rule) => self.rules[rule as usize].parameters,
        }
    }

    /// The rules that a call applies, with repetition, itself first.
    pub fn applied(&self, start: Call) -> Vec<u32> {
        let mut applied = Vec::new();
        let mut todo = vec![start];
        while let Some(call) = todo.pop() {
            if let Call::Rule(rule) = call {
                applied.push(rule);
                todo.extend(&self.rules[rule as usize].children);
            }
        }
        applied
    }

    /// Adds a rule with its statistics, as a file tells them; `false` when there is such a rule.
    pub(super) fn restore(
        &mut self,
        axis: Axis,
        children: Vec<Call>,
        uses: u64,
        mean: Vec<f64>,
        deviation: Vec<f64>,
    ) -> bool {
        let before = self.rules.len();
        let id = self.intern(axis, children) as usize;
        if id < before {
            return false;
        }
        let rule = &mut self.rules[id];
        rule.uses = uses;
        rule.mean = mean;
        rule.deviation = deviation;
        true
    }

    /// Checks that an instance calls a rule that exists with as many parameters as it takes.
    ///
    /// # Errors
    /// [`InstanceError`].
    pub fn check(&self, instance: &Instance) -> Result<(), InstanceError> {
        if let Call::Rule(rule) = instance.start
            && rule as usize >= self.rules.len()
        {
            return Err(InstanceError::UnknownRule { rule });
        }
        let expected = self.parameter_count(instance.start);
        let found = instance.parameters.len();
        if expected == found {
            Ok(())
        } else {
            Err(InstanceError::Parameters { expected, found })
        }
    }

    /// The n-ary tree that an instance stands for.
    ///
    /// # Errors
    /// [`InstanceError`] for a call of a rule that does not exist, or a parameter vector of the
    /// wrong length.
    pub fn expand(&self, instance: &Instance) -> Result<NaryTree, InstanceError> {
        self.check(instance)?;
        let mut nodes = vec![NaryNode::Insert(0)];
        let mut at = 0;
        let mut todo = vec![(0_usize, instance.start)];
        while let Some((node, call)) = todo.pop() {
            nodes[node] = match call {
                Call::Insert(label) => NaryNode::Insert(label),
                Call::Rule(rule) => {
                    let rule = &self.rules[rule as usize];
                    let first = nodes.len();
                    let count = rule.children.len();
                    nodes.resize(first + count, NaryNode::Insert(0));
                    let children = rule.children.iter().enumerate();
                    todo.extend(children.rev().map(|(i, &call)| (first + i, call)));
                    let sizes = instance.parameters[at..at + count].to_vec();
                    at += count;
                    NaryNode::Split {
                        axis: rule.axis,
                        sizes,
                        children: (first..first + count).map(|c| c as u32).collect(),
                    }
                }
            };
        }
        Ok(NaryTree {
            width: instance.width,
            height: instance.height,
            nodes,
        })
    }
}

impl ParametricRule {
    /// Updates the running moments with one more use (Welford).
    fn observe(&mut self, sizes: &[f64]) {
        self.uses += 1;
        let count = self.uses as f64;
        for ((mean, deviation), &size) in self.mean.iter_mut().zip(&mut self.deviation).zip(sizes) {
            let before = size - *mean;
            *mean += before / count;
            *deviation += before * (size - *mean);
        }
    }
}

impl NaryTree {
    /// The tree as a call of `start`, the rule of its root.
    pub(super) fn instance(&self, start: Call) -> Instance {
        Instance {
            width: self.width,
            height: self.height,
            start,
            parameters: parameter_vector(self),
        }
    }
}

/// The sizes of all splits, depth first, children in order.
fn parameter_vector(tree: &NaryTree) -> Vec<f64> {
    let mut parameters = Vec::new();
    let mut todo = vec![0_u32];
    while let Some(node) = todo.pop() {
        if let NaryNode::Split {
            sizes, children, ..
        } = &tree.nodes[node as usize]
        {
            parameters.extend_from_slice(sizes);
            todo.extend(children.iter().rev());
        }
    }
    parameters
}

/// A call that the rule set cannot answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum InstanceError {
    /// There is no rule of this number.
    #[error("there is no rule {rule}")]
    UnknownRule {
        /// The number that was called.
        rule: u32,
    },
    /// The parameter vector does not fit the starting rule.
    #[error("the starting rule takes {expected} parameters, {found} were given")]
    Parameters {
        /// Length that the rule takes.
        expected: usize,
        /// Number of parameters given.
        found: usize,
    },
}
