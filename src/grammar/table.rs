//! A grammar with its symbols numbered, for walking.

use rustc_hash::FxHashMap;

use super::Grammar;

/// Symbols by number, rules by symbol.
pub(super) struct Table<'g> {
    /// Name of each symbol; starts first, then in the order of the rules.
    pub names: Vec<&'g str>,
    /// Number of each start's symbol.
    pub starts: Vec<usize>,
    /// Number of each rule's left-hand side.
    pub left: Vec<usize>,
    /// Numbers of each rule's successors, in the order of `Operation::symbols`.
    pub right: Vec<Vec<usize>>,
    /// Rules of each symbol; none for a terminal.
    pub rules_of: Vec<Vec<usize>>,
}

impl<'g> Table<'g> {
    /// Numbers the symbols of `grammar`.
    pub(crate) fn new(grammar: &'g Grammar) -> Self {
        let mut names: Vec<&'g str> = Vec::new();
        let mut numbers: FxHashMap<&'g str, usize> = FxHashMap::default();
        let mut number = |name: &'g str| {
            *numbers.entry(name).or_insert_with(|| {
                names.push(name);
                names.len() - 1
            })
        };
        let starts = grammar.starts.iter().map(|s| number(&s.symbol)).collect();
        let mut left = Vec::with_capacity(grammar.rules.len());
        let mut right: Vec<Vec<usize>> = Vec::with_capacity(grammar.rules.len());
        for rule in &grammar.rules {
            left.push(number(&rule.symbol));
            right.push(
                rule.operation
                    .symbols()
                    .into_iter()
                    .map(&mut number)
                    .collect(),
            );
        }
        let mut rules_of = vec![Vec::new(); names.len()];
        for (rule, &symbol) in left.iter().enumerate() {
            rules_of[symbol].push(rule);
        }
        Self {
            names,
            starts,
            left,
            right,
            rules_of,
        }
    }

    /// The symbols on some cycle, the first repeated at the end; `None` when derivation always ends.
    pub(crate) fn cycle(&self) -> Option<Vec<String>> {
        #[derive(Clone, Copy, PartialEq)]
        enum State {
            New,
            Open,
            Done,
        }
        let mut state = vec![State::New; self.names.len()];
        for root in 0..self.names.len() {
            if state[root] != State::New {
                continue;
            }
            state[root] = State::Open;
            let mut path = vec![(root, self.next(root))];
            while let Some((symbol, todo)) = path.last_mut() {
                let symbol = *symbol;
                match todo.next() {
                    None => {
                        state[symbol] = State::Done;
                        path.pop();
                    }
                    Some(child) if state[child] == State::Open => {
                        let from = path.iter().position(|(s, _)| *s == child).unwrap_or(0);
                        let on_cycle = path[from..].iter().map(|(s, _)| *s).chain([child]);
                        return Some(on_cycle.map(|s| self.names[s].to_owned()).collect());
                    }
                    Some(child) if state[child] == State::New => {
                        state[child] = State::Open;
                        let todo = self.next(child);
                        path.push((child, todo));
                    }
                    Some(_) => {}
                }
            }
        }
        None
    }

    /// The successors of a symbol over all its rules.
    fn next(&self, symbol: usize) -> impl Iterator<Item = usize> + '_ {
        self.rules_of[symbol]
            .iter()
            .flat_map(|&rule| self.right[rule].iter().copied())
    }

    /// For each symbol, true if some derivation reaches it from the starts.
    pub(crate) fn reachable(&self) -> Vec<bool> {
        let mut seen = vec![false; self.names.len()];
        let mut stack = self.starts.clone();
        while let Some(symbol) = stack.pop() {
            if !std::mem::replace(&mut seen[symbol], true) {
                stack.extend(self.next(symbol));
            }
        }
        seen
    }
}
