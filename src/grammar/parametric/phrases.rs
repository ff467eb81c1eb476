//! Strings that several rules share, as rules of their own: the cheapest choice, with a bound.
//!
//! Every rule is a string `s` over one direction ([`Bodies`]). A *phrase* is a string of 2 to
//! [`LONGEST`] letters that stands at least twice in the strings of its direction; as a rule of its own it
//! costs Wu's split plus the letters of its own string, and stands for one letter wherever it is used. A split
//! whose whole string stands elsewhere is used there at no further cost. Chosen are the phrases `y_p` and a path
//! `z` through every string, whose arcs are single letters or phrases:
//! ```text
//! min  sum_s c(s) + sum_p c_split y_p + sum_a z_a
//! s.t. z is a path from the first to the last place of every string s, and of every phrase p with flow y_p,
//!      z_a <= y_p for every arc a of phrase p (1 in a string, y_p of the other in a phrase),
//!      y_p in {0, 1}, z >= 0
//! ```
//! For fixed `y` the rest is a shortest path, so that only `y` is branched on; the start is greedy, and the bound is the
//! Lagrangian one of `program.rs`. A proof holds for the collapse of repeats that made the strings, and for phrases of
//! this length.

use rustc_hash::FxHashMap;

use super::bodies::{Bodies, Body, Letter};
use super::program::branch_and_bound;
use crate::Costs;
use edifice_shape::Axis;

/// Letters of the longest phrase.
pub const LONGEST: usize = 14;

/// One written rule: a body or a phrase, whose letters may be further phrases.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Direction.
    pub axis: Axis,
    /// Whether it is a repeat.
    pub repeat: bool,
    /// What is written: letters, or phrases by the index of their rule.
    pub parts: Vec<Part>,
}

/// One symbol of a written rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// A label by its index.
    Label(u32),
    /// A written rule by its index.
    Rule(u32),
}

/// The rules with their shared phrases.
#[derive(Debug, Clone, PartialEq)]
pub struct Sharing {
    /// The written rules; the first are the bodies in their order, then come the phrases.
    pub rules: Vec<Written>,
    /// Number of rules that are bodies.
    pub bodies: usize,
    /// Wu's cost of the rules.
    pub cost: f64,
    /// No choice of phrases costs less.
    pub lower_bound: f64,
}

impl Sharing {
    /// Whether no choice of phrases is cheaper.
    pub fn is_proven(&self) -> bool {
        self.cost <= self.lower_bound + 1e-6
    }
}

/// A string of the program.
pub(super) struct Text {
    axis: Axis,
    pub letters: Vec<Letter>,
    /// Phrases that stand in it: first place, one past the last, and the index of the phrase's text.
    pub arcs: Vec<(usize, usize, usize)>,
}

/// Bodies first, then the phrases that may be opened.
pub(super) struct Texts {
    pub texts: Vec<Text>,
    pub bodies: usize,
}

/// Chooses the phrases. `costs` are those of a split and a repeat.
pub fn share(bodies: &Bodies, costs: &Costs) -> Sharing {
    let texts = Texts::new(&bodies.bodies);
    let fixed: f64 = bodies
        .bodies
        .iter()
        .map(|body| operation_cost(body, costs))
        .sum();
    let start = texts.greedy(costs.split);
    let (open, bound) = branch_and_bound(&texts, start, costs.split);
    let cost = fixed + texts.cost(&open, costs.split);
    Sharing {
        rules: texts.written(&open, &bodies.bodies),
        bodies: texts.bodies,
        cost,
        lower_bound: (fixed + bound).min(cost),
    }
}

fn operation_cost(body: &Body, costs: &Costs) -> f64 {
    if body.repeat {
        costs.repeat
    } else {
        costs.split
    }
}

impl Texts {
    fn new(bodies: &[Body]) -> Self {
        let mut found: FxHashMap<(Axis, &[Letter]), usize> = FxHashMap::default();
        for body in bodies {
            for from in 0..body.letters.len() {
                for to in from + 2..=body.letters.len().min(from + LONGEST) {
                    *found
                        .entry((body.axis, &body.letters[from..to]))
                        .or_default() += 1;
                }
            }
        }
        // A split that stands whole in another string is used there for nothing.
        let mut text_of: FxHashMap<(Axis, &[Letter]), usize> = FxHashMap::default();
        for (k, body) in bodies.iter().enumerate() {
            if !body.repeat && body.letters.len() >= 2 {
                text_of.insert((body.axis, &body.letters), k);
            }
        }
        let mut phrases: Vec<(Axis, &[Letter])> = found
            .iter()
            .filter(|(key, count)| **count >= 2 && !text_of.contains_key(*key))
            .map(|(key, _)| *key)
            .collect();
        phrases.sort_unstable_by(|a, b| (b.1.len(), a).cmp(&(a.1.len(), b)));
        for (k, phrase) in phrases.iter().enumerate() {
            text_of.insert(*phrase, bodies.len() + k);
        }
        let longest = text_of.keys().map(|key| key.1.len()).max().unwrap_or(0);
        let strings = bodies
            .iter()
            .map(|body| (body.axis, &body.letters[..]))
            .chain(phrases);
        let texts = strings.enumerate().map(|(own, (axis, letters))| {
            let mut arcs = Vec::new();
            for from in 0..letters.len() {
                for to in from + 2..=letters.len().min(from + longest) {
                    if let Some(&text) = text_of.get(&(axis, &letters[from..to]))
                        && text != own
                    {
                        arcs.push((from, to, text));
                    }
                }
            }
            Text {
                axis,
                letters: letters.to_vec(),
                arcs,
            }
        });
        Self {
            texts: texts.collect(),
            bodies: bodies.len(),
        }
    }

    /// Fewest parts of a text with the open phrases, and the parts: places where they start and their text.
    fn path(&self, text: usize, open: &[bool]) -> (usize, Vec<(usize, Option<usize>)>) {
        let Text { letters, arcs, .. } = &self.texts[text];
        let n = letters.len();
        let mut best: Vec<(usize, usize, Option<usize>)> = vec![(0, 0, None); n + 1];
        let mut at = 0;
        // Arcs are sorted by where they start: relax forwards.
        for place in best.iter_mut().skip(1) {
            place.0 = usize::MAX;
        }
        for from in 0..n {
            let reached = best[from].0 + 1;
            if reached < best[from + 1].0 {
                best[from + 1] = (reached, from, None);
            }
            while let Some(&(start, to, phrase)) = arcs.get(at)
                && start == from
            {
                at += 1;
                if open[phrase] && reached < best[to].0 {
                    best[to] = (reached, from, Some(phrase));
                }
            }
        }
        let mut parts = Vec::new();
        let mut place = n;
        while place > 0 {
            let (_, from, phrase) = best[place];
            parts.push((from, phrase));
            place = from;
        }
        parts.reverse();
        (best[n].0, parts)
    }

    /// Cost of the open phrases and of all paths, without the operations of the bodies.
    pub fn cost(&self, open: &[bool], split: f64) -> f64 {
        let texts = (0..self.texts.len()).filter(|&k| open[k]);
        texts
            .map(|k| self.path(k, open).0 as f64 + if k < self.bodies { 0.0 } else { split })
            .sum()
    }

    /// Opens the phrase that saves the most until none saves, then closes those that save nothing.
    fn greedy(&self, split: f64) -> Vec<bool> {
        let mut open: Vec<bool> = (0..self.texts.len()).map(|k| k < self.bodies).collect();
        let mut users: Vec<Vec<usize>> = vec![Vec::new(); self.texts.len()];
        for (k, text) in self.texts.iter().enumerate() {
            for &(_, _, phrase) in &text.arcs {
                if users[phrase].last() != Some(&k) {
                    users[phrase].push(k);
                }
            }
        }
        let mut paths: Vec<usize> = (0..self.texts.len())
            .map(|k| self.path(k, &open).0)
            .collect();
        // What opening a phrase saves now; an upper bound later, evaluated again when it comes first.
        let saves = |phrase: usize, open: &mut Vec<bool>, paths: &[usize]| -> f64 {
            let own = self.path(phrase, open).0 as f64;
            open[phrase] = true;
            let texts = users[phrase].iter().filter(|&&k| open[k] && k != phrase);
            let saved: usize = texts.map(|&k| paths[k] - self.path(k, open).0).sum();
            open[phrase] = false;
            saved as f64 - own - split
        };
        loop {
            let mut best = (1e-9, None);
            for phrase in self.bodies..self.texts.len() {
                if open[phrase] {
                    continue;
                }
                let saved = saves(phrase, &mut open, &paths);
                if saved > best.0 {
                    best = (saved, Some(phrase));
                }
            }
            let Some(phrase) = best.1 else { break };
            open[phrase] = true;
            for &k in users[phrase].iter().chain([&phrase]) {
                paths[k] = self.path(k, &open).0;
            }
        }
        self.close(&mut open, split);
        open
    }

    /// Closes the phrases that save nothing, one after another, and returns the cost.
    pub fn close(&self, open: &mut [bool], split: f64) -> f64 {
        let mut cost = self.cost(open, split);
        for phrase in self.bodies..self.texts.len() {
            if open[phrase] {
                open[phrase] = false;
                let without = self.cost(open, split);
                if without <= cost {
                    cost = without;
                } else {
                    open[phrase] = true;
                }
            }
        }
        cost
    }

    /// The rules that a choice writes.
    fn written(&self, open: &[bool], bodies: &[Body]) -> Vec<Written> {
        let mut number = vec![0; self.texts.len()];
        let chosen: Vec<usize> = (0..self.texts.len()).filter(|&k| open[k]).collect();
        for (n, &k) in chosen.iter().enumerate() {
            number[k] = n as u32;
        }
        let write = |&k: &usize| {
            let part = |(from, phrase): (usize, Option<usize>)| match phrase {
                Some(phrase) => Part::Rule(number[phrase]),
                None => match self.texts[k].letters[from] {
                    Letter::Label(label) => Part::Label(label),
                    Letter::Body(body) => Part::Rule(body),
                },
            };
            Written {
                axis: self.texts[k].axis,
                repeat: bodies.get(k).is_some_and(|body| body.repeat),
                parts: self.path(k, open).1.into_iter().map(part).collect(),
            }
        };
        chosen.iter().map(write).collect()
    }
}
