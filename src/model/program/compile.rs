//! Programs of finite choices as Bayesian networks.
//!
//! A program that makes the same choices `x_1, .., x_n` in every run, each of finitely many values, is a network: the probabilities of
//! x_i and the weights `w_j` are functions of the choices before them. Which choices a function depends on is found by running
//! the program on assignments of all choices: where two assignments agree on the known parents and the function differs, a search by
//! halves between the two meets a further parent, after `log2 n` runs. Then the function is tabulated over its parents. A
//! weight `w_j` becomes a child that was seen, with `P(seen | parents) = w_j / max w_j`.
//!
//! # Deviations and readings
//! - The program is a black box: a function is found independent of a choice when it does not differ on random assignments
//!   of the others, [`PROBES`] or more for each function. A dependence that shows itself only in a share s of all assignments is overlooked with
//!   probability `(1 - s)^PROBES`; [`compile`] ends with as many further runs that compare the whole, and refuses on a difference.
//!
//! Sources: Koller and Friedman 2009, Sec. 3.2; Blum 1994 (functions of few relevant variables).

use std::collections::BTreeMap;

use rand::RngExt;

use super::address::Address;
use super::dist::Dist;
use super::error::ProgramError;
use super::exact::{any, logs};
use super::trace::Value;
use super::{Handler, Program};
use crate::ModelError;
use crate::elimination::advance;
use crate::network::{self, Network, Variable};
use edifice_base::rng::{Stream, stream};

/// Random assignments on which a function has to agree.
pub(super) const PROBES: usize = 64;
/// Of these at least so many for each configuration of its parents.
const EACH: usize = 2;
/// Most configurations of the parents of one function.
const MOST: usize = 1 << 14;

/// A program as a network, and the evidence that its observations are.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// A variable for each choice, named as its address, with categories `0`, `1`, ..; a variable `weight j` for each observation or factor
    /// that depends on a choice; the variable `nothing` of one category where there are none.
    pub network: Network,
    /// That every weight was seen.
    pub evidence: network::Evidence,
    /// Sum of the logarithms of the largest weights, nats.
    pub log_scale: f64,
}

impl Compiled {
    /// `log Z`, exactly, nats.
    ///
    /// # Errors
    /// As [`Network::log_probability`].
    pub fn log_evidence(&self) -> Result<f64, ModelError> {
        Ok(self.network.log_probability(&self.evidence)? + self.log_scale)
    }

    /// Posterior probabilities of the values at an address, exactly.
    ///
    /// # Errors
    /// As [`Network::marginal`].
    pub fn marginal(&self, at: impl Into<Address>) -> Result<Vec<f64>, ModelError> {
        self.network
            .marginal(&self.evidence, &at.into().to_string())
    }
}

/// The program as a network, to be asked by variable elimination: exact as long as each choice depends on few others, however many there are.
///
/// Runs of the program: some 64 for each function and parent, and two for each entry of a table.
///
/// # Errors
/// [`ProgramError::NotFinite`]; [`ProgramError::Changing`] where runs make other choices, or a dependence was overlooked;
/// [`ProgramError::TooMany`] configurations of parents; those of running the program.
///
/// # Examples
/// A hidden Markov chain of 60 steps, which has 2⁶⁰ ways through it:
/// ```
/// use edifice_model::program::{Handler, Program, compile, dist::{bernoulli, normal}};
/// struct Chain;
/// impl Program for Chain {
///     type Out = ();
///     fn run<H: Handler>(&self, h: &mut H) {
///         let mut state = false;
///         for i in 0..60 {
///             state = h.sample(("state", i), bernoulli(if state { 0.9 } else { 0.1 }));
///             h.observe(normal(if state { 1.0 } else { 0.0 }, 1.0), &(if i < 30 { 0.0 } else { 1.0 }).into());
///         }
///     }
/// }
/// let compiled = compile(&Chain)?;
/// assert!(compiled.marginal(("state", 5))?[1] < 0.2 && compiled.marginal(("state", 55))?[1] > 0.8);
/// # Ok::<(), edifice_model::program::ProgramError>(())
/// ```
pub fn compile<P: Program>(program: &P) -> Result<Compiled, ProgramError> {
    let mut rng = stream(0, "program/compile", 0);
    let probe = Probe::new(program, &mut rng)?;
    let n = probe.choices.len();
    let first = probe.ask(&vec![0; n])?;
    let mut functions = Vec::with_capacity(n + first.len());
    for f in 0..first.len() {
        // A choice depends on those before it; a weight may on any.
        let before = if f < n { f } else { n };
        functions.push(probe.function(f, before, &mut rng)?);
    }
    probe.verify(&functions, &mut rng)?;
    probe.network(&functions)
}

/// A function of choices: its parents, and its values for each configuration of them, the last fastest.
struct Function {
    parents: Vec<usize>,
    values: Vec<Vec<f64>>,
}

struct Probe<'p, P> {
    program: &'p P,
    choices: Vec<Address>,
    sizes: Vec<usize>,
}

impl<'p, P: Program> Probe<'p, P> {
    fn new(program: &'p P, rng: &mut Stream) -> Result<Self, ProgramError> {
        let mut handler = Assigned {
            known: None,
            draw: Some(rng),
            ..Assigned::new()
        };
        program.run(&mut handler);
        match handler.error {
            Some(error) => Err(error),
            None => Ok(Self {
                program,
                choices: handler.choices,
                sizes: handler.sizes,
            }),
        }
    }

    /// All functions at an assignment: log probabilities of each choice's values, then each log weight.
    fn ask(&self, assignment: &[usize]) -> Result<Vec<Vec<f64>>, ProgramError> {
        let mut handler = Assigned {
            known: Some(assignment),
            ..Assigned::new()
        };
        self.program.run(&mut handler);
        if let Some(error) = handler.error {
            return Err(error);
        }
        let same = handler.choices == self.choices && handler.sizes == self.sizes;
        if !same {
            let mut pairs = handler.choices.iter().zip(&self.choices);
            let other = pairs.find(|(a, b)| a != b).map(|(a, _)| a);
            let at = other.or(self.choices.last()).map(Address::to_string);
            let at = at.unwrap_or_else(|| "the first choice".to_owned());
            return Err(ProgramError::Changing { at });
        }
        let mut all = handler.logs;
        all.extend(handler.weights.into_iter().map(|w| vec![w]));
        Ok(all)
    }

    fn one(&self, f: usize, assignment: &[usize]) -> Result<Vec<f64>, ProgramError> {
        let mut all = self.ask(assignment)?;
        match f < all.len() {
            true => Ok(all.swap_remove(f)),
            false => Err(self.changing(f)),
        }
    }

    fn changing(&self, f: usize) -> ProgramError {
        let weight = || format!("observation {}", f + 1 - self.choices.len());
        let at = self.choices.get(f).map_or_else(weight, Address::to_string);
        ProgramError::Changing { at }
    }

    fn random(&self, rng: &mut Stream) -> Vec<usize> {
        let sizes = self.sizes.iter();
        sizes.map(|&k| rng.random_range(0..k)).collect()
    }

    /// Parents and table of a function of the first `before` choices.
    fn function(
        &self,
        f: usize,
        before: usize,
        rng: &mut Stream,
    ) -> Result<Function, ProgramError> {
        let mut parents: Vec<usize> = Vec::new();
        'again: loop {
            let sizes = parents.iter().map(|&p| self.sizes[p]);
            let count = sizes.fold(1_usize, |n, k| n.saturating_mul(k));
            if count > MOST {
                return Err(ProgramError::TooMany { most: MOST });
            }
            let mut values = Vec::with_capacity(count);
            let mut at = vec![0; self.sizes.len()];
            for _ in 0..count {
                let mut known: Option<(Vec<usize>, Vec<f64>)> = None;
                for _ in 0..EACH.max(PROBES.div_ceil(count)) {
                    let mut x = self.random(rng);
                    parents.iter().for_each(|&p| x[p] = at[p]);
                    let found = self.one(f, &x)?;
                    let (start, expected) = known.get_or_insert_with(|| (x.clone(), found.clone()));
                    if !equal(expected, &found) {
                        let parent = self.between(f, before, start, &x)?;
                        if parents.contains(&parent) {
                            return Err(self.changing(f));
                        }
                        parents.push(parent);
                        parents.sort_unstable();
                        continue 'again;
                    }
                }
                values.extend(known.map(|(_, v)| v));
                advance(&parents, &self.sizes, &mut at);
            }
            return Ok(Function { parents, values });
        }
    }

    /// A choice that makes a difference between two assignments on which a function differs.
    fn between(
        &self,
        f: usize,
        before: usize,
        from: &[usize],
        to: &[usize],
    ) -> Result<usize, ProgramError> {
        let differ: Vec<usize> = (0..before).filter(|&i| from[i] != to[i]).collect();
        let mixed = |m: usize| {
            let mut x = from.to_vec();
            differ[..m].iter().for_each(|&i| x[i] = to[i]);
            x
        };
        let start = self.one(f, from)?;
        let (mut low, mut high) = (0, differ.len());
        // The function depends on something that is no choice before it.
        if equal(&start, &self.one(f, &mixed(high))?) {
            return Err(self.changing(f));
        }
        while high - low > 1 {
            let middle = low.midpoint(high);
            match equal(&start, &self.one(f, &mixed(middle))?) {
                true => low = middle,
                false => high = middle,
            }
        }
        Ok(differ[high - 1])
    }

    /// Compares all functions on further assignments.
    fn verify(&self, functions: &[Function], rng: &mut Stream) -> Result<(), ProgramError> {
        for _ in 0..PROBES {
            let x = self.random(rng);
            let found = self.ask(&x)?;
            for (f, function) in functions.iter().enumerate() {
                let parents = function.parents.iter();
                let at = parents.fold(0, |i, &p| i * self.sizes[p] + x[p]);
                if !found.get(f).is_some_and(|v| equal(&function.values[at], v)) {
                    return Err(self.changing(f));
                }
            }
        }
        Ok(())
    }

    fn network(&self, functions: &[Function]) -> Result<Compiled, ProgramError> {
        let names: Vec<String> = self.choices.iter().map(Address::to_string).collect();
        let parents = |f: &Function| -> Vec<&str> {
            let all = f.parents.iter();
            all.map(|&p| names[p].as_str()).collect()
        };
        let mut variables = Vec::with_capacity(functions.len());
        let mut evidence = network::Evidence::new();
        let mut log_scale = 0.0;
        let mut labels: BTreeMap<usize, Vec<String>> = BTreeMap::new();
        for (f, function) in functions.iter().enumerate() {
            let Some(&k) = self.sizes.get(f) else {
                let all = || function.values.iter().flatten().copied();
                let top = all().fold(f64::NEG_INFINITY, f64::max);
                if top == f64::NEG_INFINITY {
                    return Err(ProgramError::Impossible {
                        tried: all().count(),
                    });
                }
                log_scale += top;
                if !function.parents.is_empty() {
                    let name = format!("weight {}", f + 1 - self.choices.len());
                    let seen = all().map(|log| (log - top).exp());
                    let table: Vec<f64> = seen.flat_map(|p| [1.0 - p, p]).collect();
                    evidence = evidence.is(&name, "seen");
                    let categories = ["not seen", "seen"];
                    variables.push(Variable::table(
                        &name,
                        &categories,
                        &parents(function),
                        &table,
                    ));
                }
                continue;
            };
            let labels = labels
                .entry(k)
                .or_insert_with(|| (0..k).map(|i| i.to_string()).collect());
            let categories: Vec<&str> = labels.iter().map(String::as_str).collect();
            let table: Vec<f64> = function.values.iter().flatten().map(|l| l.exp()).collect();
            let table = Variable::table(&names[f], &categories, &parents(function), &table);
            variables.push(table);
        }
        if variables.is_empty() {
            // A network has at least one variable.
            variables.push(Variable::table("nothing", &["0"], &[], &[1.0]));
        }
        Ok(Compiled {
            network: Network::new(variables)?,
            evidence,
            log_scale,
        })
    }
}

/// Equal up to rounding.
fn equal(a: &[f64], b: &[f64]) -> bool {
    let close = |(a, b): (&f64, &f64)| a == b || (a - b).abs() <= 1e-12 * (1.0 + a.abs());
    a.len() == b.len() && a.iter().zip(b).all(close)
}

/// Runs by an assignment, or by random values, and notes every function.
struct Assigned<'a> {
    known: Option<&'a [usize]>,
    draw: Option<&'a mut Stream>,
    choices: Vec<Address>,
    sizes: Vec<usize>,
    logs: Vec<Vec<f64>>,
    weights: Vec<f64>,
    error: Option<ProgramError>,
}

impl Assigned<'_> {
    fn new() -> Self {
        Self {
            known: None,
            draw: None,
            choices: Vec::new(),
            sizes: Vec::new(),
            logs: Vec::new(),
            weights: Vec::new(),
            error: None,
        }
    }
}

impl Handler for Assigned<'_> {
    type Real = f64;

    fn sample<D: Dist<f64>>(&mut self, at: impl Into<Address>, d: D) -> D::Value {
        let address = at.into();
        let logs = match logs(&address, &d) {
            Ok(logs) => logs,
            Err(error) => {
                self.error.get_or_insert(error);
                return any(&d);
            }
        };
        let (place, k) = (self.choices.len(), logs.len());
        let value = match (self.known, &mut self.draw) {
            (Some(known), _) => known
                .get(place)
                .copied()
                .unwrap_or(0)
                .min(k.saturating_sub(1)),
            (None, Some(rng)) if k > 0 => rng.random_range(0..k),
            _ => 0,
        };
        if self.choices.contains(&address) {
            let at = address.to_string();
            self.error.get_or_insert(ProgramError::Duplicate { at });
        }
        self.choices.push(address);
        self.sizes.push(k);
        self.logs.push(logs);
        d.load(&Value::Whole(value as u64))
            .unwrap_or_else(|| any(&d))
    }

    fn observe<D: Dist<f64>>(&mut self, d: D, x: &D::Value) {
        let log = d.log_density(x);
        self.factor(log);
    }

    fn factor(&mut self, log: f64) {
        if log.is_nan() || log == f64::INFINITY {
            let at = format!("observation {}", self.weights.len() + 1);
            self.error.get_or_insert(ProgramError::NotANumber { at });
        }
        self.weights.push(log);
    }
}
