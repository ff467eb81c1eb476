//! Greedy moves with a tabu list, and new starts from other structures of the best one's equivalence class.

use std::collections::VecDeque;

use rand::{Rng, RngExt};

use super::super::super::error::ModelError;
use super::constraints::Allowed;
use super::families::Families;
use super::settings::SearchSettings;

/// Families counted between two questions if the search shall go on.
const FAMILIES: usize = 4096;
/// Gains below this are rounding.
const LEAST_GAIN: f64 = 1e-9;
/// Covered edges turned round at a new start, for each variable.
const TURNED: usize = 4;
/// Random moves of every second new start, as a share of the variables.
const SHAKEN: f64 = 0.1;

/// A change of one edge, from parent to child.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Move {
    Add(usize, usize),
    Remove(usize, usize),
    Reverse(usize, usize),
}

impl Move {
    fn undone(self) -> Self {
        match self {
            Self::Add(p, c) => Self::Remove(p, c),
            Self::Remove(p, c) => Self::Add(p, c),
            Self::Reverse(p, c) => Self::Reverse(c, p),
        }
    }
}

/// A structure and what its neighbours gain.
pub(super) struct Climb<'a, 'd> {
    families: &'a mut Families<'d>,
    allowed: &'a Allowed,
    settings: &'a SearchSettings,
    goes_on: &'a (dyn Fn() -> bool + Sync),
    /// True once `goes_on` has said no.
    ended: bool,
    /// Parents of every variable, ascending.
    parents: Vec<Vec<usize>>,
    score: f64,
    /// Per child and other variable: what the child's score gains when the edge is added, or taken out where it is.
    gains: Vec<Vec<f64>>,
    /// Descendants of every variable, a bit each, itself included.
    below: Vec<Vec<u64>>,
    best: (Vec<Vec<usize>>, f64),
    moves: usize,
}

impl<'a, 'd> Climb<'a, 'd> {
    /// From the required edges alone.
    pub(super) fn new(
        families: &'a mut Families<'d>,
        allowed: &'a Allowed,
        settings: &'a SearchSettings,
        goes_on: &'a (dyn Fn() -> bool + Sync),
    ) -> Result<Self, ModelError> {
        let n = families.variables();
        let mut climb = Self {
            families,
            allowed,
            settings,
            goes_on,
            ended: false,
            parents: Vec::new(),
            score: 0.0,
            gains: vec![vec![0.0; n]; n],
            below: Vec::new(),
            best: (Vec::new(), f64::NEG_INFINITY),
            moves: 0,
        };
        climb.start(allowed.required.clone());
        climb.keep();
        Ok(climb)
    }

    /// Climbs, and climbs again from other structures of the same score, and from some nearby.
    pub(super) fn run<R: Rng>(&mut self, rng: &mut R) {
        self.climb();
        for restart in 0..self.settings.restarts {
            if self.ended() {
                return;
            }
            self.start(self.best.0.clone());
            self.turn(rng);
            if restart % 2 == 1 {
                self.shake(rng);
            }
            self.climb();
        }
    }

    /// True if the search was ended early.
    pub(super) fn ended(&self) -> bool {
        self.ended
    }

    /// Asks if the search shall go on. Once false, it stays false.
    fn asked(&mut self) -> bool {
        self.ended = self.ended || !(self.goes_on)();
        !self.ended
    }

    /// The structure of highest score, its score, and the moves made.
    pub(super) fn best(self) -> (Vec<Vec<usize>>, f64, usize) {
        (self.best.0, self.best.1, self.moves)
    }

    /// The best move that is not tabu, again and again, until too many bring no new best.
    fn climb(&mut self) {
        let mut tabu: VecDeque<Move> = VecDeque::with_capacity(self.settings.tabu);
        let mut idle = 0;
        while idle <= self.settings.patience && self.asked() {
            let Some((change, gain)) = self.choose(&tabu) else {
                return;
            };
            self.apply(change, gain);
            if self.settings.tabu > 0 {
                if tabu.len() == self.settings.tabu {
                    tabu.pop_front();
                }
                tabu.push_back(change.undone());
            }
            idle = match self.keep() {
                true => 0,
                false => idle + 1,
            };
        }
    }

    /// The first move of highest gain that is allowed; one on the list only if it leads to a new best.
    fn choose(&self, tabu: &VecDeque<Move>) -> Option<(Move, f64)> {
        let wanted = self.best.1 - self.score + LEAST_GAIN;
        let mut found: Option<(Move, f64)> = None;
        let mut consider = |change: Move, gain: f64| {
            let better = found.is_none_or(|(_, most)| gain > most);
            if better && (gain > wanted || !tabu.contains(&change)) {
                found = Some((change, gain));
            }
        };
        for child in 0..self.parents.len() {
            for other in (0..self.parents.len()).filter(|&o| o != child) {
                for change in self.changes(other, child).into_iter().flatten() {
                    consider(change, self.gain(change));
                }
            }
        }
        found
    }

    /// The possible moves of the edge from `p` to `c`: to add it, or to take it out or turn it round.
    fn changes(&self, p: usize, c: usize) -> [Option<Move>; 2] {
        let room = |v: usize| self.parents[v].len() < self.settings.most_parents;
        if !self.parents[c].contains(&p) {
            let may = self.allowed.may(p, c) && room(c) && !self.reaches(c, p);
            return [may.then_some(Move::Add(p, c)), None];
        }
        if self.allowed.must(p, c) {
            return [None, None];
        }
        // Turned round, the edge closes a cycle when p reaches c on another way.
        let around = || {
            self.parents[c]
                .iter()
                .any(|&q| q != p && self.reaches(p, q))
        };
        let turn = self.allowed.may(c, p) && room(p) && !around();
        [
            Some(Move::Remove(p, c)),
            turn.then_some(Move::Reverse(p, c)),
        ]
    }

    fn gain(&self, change: Move) -> f64 {
        match change {
            Move::Add(p, c) | Move::Remove(p, c) => self.gains[c][p],
            Move::Reverse(p, c) => self.gains[c][p] + self.gains[p][c],
        }
    }

    fn apply(&mut self, change: Move, gain: f64) {
        let (Move::Add(p, c) | Move::Remove(p, c) | Move::Reverse(p, c)) = change;
        toggle(&mut self.parents[c], p);
        let mut changed = vec![c];
        if let Move::Reverse(..) = change {
            toggle(&mut self.parents[p], c);
            changed.push(p);
        }
        self.score += gain;
        self.moves += 1;
        self.below = descendants(&self.parents);
        self.refresh(&changed);
    }

    /// A new structure to go on from.
    fn start(&mut self, parents: Vec<Vec<usize>>) {
        self.parents = parents;
        self.below = descendants(&self.parents);
        let all: Vec<usize> = (0..self.parents.len()).collect();
        self.refresh(&all);
        let own = self.parents.iter().enumerate();
        self.score = own.map(|(c, own)| self.families.score(c, own)).sum();
    }

    /// Turns covered edges round at random: an edge p → c is covered when c's other parents are p's, and turning it round
    /// leads to a structure of the same class and score (Chickering 1995, Theorem 1). Which moves gain most differs.
    fn turn<R: Rng>(&mut self, rng: &mut R) {
        let n = self.parents.len();
        let mut changed = vec![false; n];
        for _ in 0..TURNED * n {
            let c = rng.random_range(0..n);
            if self.parents[c].is_empty() {
                continue;
            }
            let p = self.parents[c][rng.random_range(0..self.parents[c].len())];
            let others = self.parents[c].iter().filter(|&&q| q != p);
            let covered = others.eq(self.parents[p].iter());
            if covered && self.allowed.may(c, p) && !self.allowed.must(p, c) {
                toggle(&mut self.parents[c], p);
                toggle(&mut self.parents[p], c);
                changed[c] = true;
                changed[p] = true;
            }
        }
        self.below = descendants(&self.parents);
        let changed: Vec<usize> = (0..n).filter(|&v| changed[v]).collect();
        self.refresh(&changed);
    }

    /// Random moves, one after the other.
    fn shake<R: Rng>(&mut self, rng: &mut R) {
        let n = self.parents.len();
        for _ in 0..(SHAKEN * n as f64).ceil() as usize {
            let (p, c) = (rng.random_range(0..n), rng.random_range(0..n));
            let all = self.changes(p, c);
            let chosen = all[usize::from(rng.random::<bool>())].or(all[0]);
            if let Some(change) = chosen.filter(|_| p != c) {
                self.apply(change, self.gain(change));
            }
        }
    }

    /// Keeps the structure if it is the best so far.
    fn keep(&mut self) -> bool {
        let better = self.score > self.best.1 + LEAST_GAIN;
        if better {
            self.best = (self.parents.clone(), self.score);
        }
        better
    }

    /// The gains of moves into the given children anew.
    fn refresh(&mut self, children: &[usize]) {
        let n = self.parents.len();
        let most = self.settings.most_parents;
        let mut wanted = Vec::new();
        for &c in children {
            wanted.push((c, self.parents[c].clone()));
            for p in (0..n).filter(|&p| p != c) {
                let mut changed = self.parents[c].clone();
                toggle(&mut changed, p);
                if changed.len() <= most && (self.allowed.may(p, c) || self.parents[c].contains(&p))
                {
                    wanted.push((c, changed));
                }
            }
        }
        for part in wanted.chunks(FAMILIES) {
            if self.asked() {
                self.families.prepare(part.to_vec());
            }
        }
        for &c in children {
            let now = self.families.score(c, &self.parents[c]);
            for p in (0..n).filter(|&p| p != c) {
                let mut changed = self.parents[c].clone();
                toggle(&mut changed, p);
                let known = changed.len() <= most
                    && (self.allowed.may(p, c) || self.parents[c].contains(&p));
                self.gains[c][p] = match known {
                    // Once the search is ended, families that were not counted are no move.
                    true if self.ended => f64::NEG_INFINITY,
                    true => self.families.score(c, &changed) - now,
                    false => f64::NEG_INFINITY,
                };
            }
        }
    }

    fn reaches(&self, from: usize, to: usize) -> bool {
        self.below[from][to / 64] >> (to % 64) & 1 == 1
    }
}

/// Adds an element to an ascending list, or takes it out.
fn toggle(list: &mut Vec<usize>, element: usize) {
    match list.binary_search(&element) {
        Ok(at) => {
            list.remove(at);
        }
        Err(at) => list.insert(at, element),
    }
}

/// Descendants of every vertex, itself included, as bits.
fn descendants(parents: &[Vec<usize>]) -> Vec<Vec<u64>> {
    let n = parents.len();
    let mut children = vec![Vec::new(); n];
    let mut open: Vec<usize> = vec![0; n];
    for (c, own) in parents.iter().enumerate() {
        for &p in own {
            children[p].push(c);
            open[p] += 1;
        }
    }
    let mut below: Vec<Vec<u64>> = (0..n)
        .map(|v| {
            let mut bits = vec![0; n.div_ceil(64)];
            bits[v / 64] |= 1 << (v % 64);
            bits
        })
        .collect();
    // From the leaves up: a vertex is finished when all its children are.
    let mut ready: Vec<usize> = (0..n).filter(|&v| open[v] == 0).collect();
    while let Some(v) = ready.pop() {
        for &p in &parents[v] {
            let own = below[v].clone();
            for (bits, more) in below[p].iter_mut().zip(own) {
                *bits |= more;
            }
            open[p] -= 1;
            if open[p] == 0 {
                ready.push(p);
            }
        }
    }
    below
}
