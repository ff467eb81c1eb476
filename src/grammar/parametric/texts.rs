//! The program of shared phrases: strings, and the phrases that stand in them.

use rustc_hash::FxHashMap;

use super::bodies::{Body, Letter};
use edifice_shape::Axis;

/// Letters of the longest phrase.
pub const LONGEST: usize = 14;

/// A string of the program.
pub(super) struct Text {
    pub axis: Axis,
    pub letters: Vec<Letter>,
    /// Phrases that stand in it: first place, one past the last, and the index of the phrase's text.
    pub arcs: Vec<(usize, usize, usize)>,
}

/// Bodies first, then the phrases that may be opened.
pub(super) struct Texts {
    pub texts: Vec<Text>,
    pub bodies: usize,
}

impl Texts {
    pub(super) fn new(bodies: &[Body]) -> Self {
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
    pub(super) fn path(&self, text: usize, open: &[bool]) -> (usize, Vec<(usize, Option<usize>)>) {
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
    pub(super) fn cost(&self, open: &[bool], split: f64) -> f64 {
        let texts = (0..self.texts.len()).filter(|&k| open[k]);
        texts
            .map(|k| self.path(k, open).0 as f64 + if k < self.bodies { 0.0 } else { split })
            .sum()
    }

    /// Opens the phrase that saves the most until none saves, then closes those that save nothing.
    pub(super) fn greedy(&self, split: f64) -> Vec<bool> {
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
    pub(super) fn close(&self, open: &mut [bool], split: f64) -> f64 {
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
}
