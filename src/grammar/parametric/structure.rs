//! The rule of the whole facade, and rules that the library does not have.
//!
//! A root that `n` of the library's `N` facades have comes with probability `(1 - q) n / N`; any other one with
//! `q = (n_1 + 1/2) / (N + 1)`, where `n_1` roots came once (Good and Turing's estimate). It is then spelled: its
//! symbol, and, when that is a new rule, its direction and its items one after another, where new rules are spelled in place.
//! Tokens of rules follow one another with probability `(n(a, b) + beta p_0(b)) / (n(a) + beta)` over the library's
//! rules of the same direction, each counted once; `p_0` is the share of the token in all rules, smoothed.
//! New labels are spelled in bytes.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::coder::Coder;
use super::rules::{Item, Rule, Rules, Symbol};
use super::tree::{DEPTH_LIMIT, index};
use edifice_shape::Axis;

/// Weight of the unconditional distribution of tokens.
const BETA: f64 = 1.0;

/// Longest label, in bytes.
pub(super) const LABEL_LIMIT: usize = 4096;

/// Most items of a rule that is read from a code.
const ITEM_LIMIT: usize = 1 << 16;

/// The tokens that a rule is spelled with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum Token {
    /// Before the first item, and after the last.
    End,
    /// A repeat starts.
    Open,
    /// A repeat ends.
    Close,
    /// A label that was not seen; its bytes follow.
    NewLabel,
    /// A rule that was not seen; it follows.
    NewRule,
    /// A known symbol.
    Known(Symbol),
}

/// Roots and successions of tokens that were seen.
#[derive(Debug, Clone, Default)]
pub struct StructureTable {
    roots: BTreeMap<Symbol, u32>,
    follows: FxHashMap<(Axis, Token), BTreeMap<Token, u32>>,
    seen: [BTreeMap<Token, u32>; 2],
}

impl StructureTable {
    /// The roots with the number of their facades.
    pub fn roots(&self) -> &BTreeMap<Symbol, u32> {
        &self.roots
    }

    /// Adds the root of a facade, or takes it away.
    pub fn change_root(&mut self, root: Symbol, more: bool) {
        let count = self.roots.entry(root).or_default();
        *count = if more {
            *count + 1
        } else {
            count.saturating_sub(1)
        };
        if *count == 0 {
            self.roots.remove(&root);
        }
    }

    /// Adds a rule.
    pub fn add_rule(&mut self, rule: &Rule) {
        let mut previous = Token::End;
        for token in tokens(rule) {
            *self
                .follows
                .entry((rule.axis, previous))
                .or_default()
                .entry(token)
                .or_default() += 1;
            *self.seen[index(rule.axis)].entry(token).or_default() += 1;
            previous = token;
        }
    }
}

fn tokens(rule: &Rule) -> Vec<Token> {
    let mut out = Vec::new();
    for item in &rule.items {
        let symbols = item.symbols().iter().map(|&s| Token::Known(s));
        if item.is_repeat() {
            out.push(Token::Open);
            out.extend(symbols);
            out.push(Token::Close);
        } else {
            out.extend(symbols);
        }
    }
    out.push(Token::End);
    out
}

/// Spells structures.
pub(super) struct Speller<'s, C> {
    /// The coder that meets the choices.
    pub coder: &'s mut C,
    /// The tables of the library.
    pub table: &'s StructureTable,
    /// Rules of the library, and after them those of the facade that it does not have. While a known facade is
    /// written they are only read up to what was spelled so far.
    pub rules: &'s mut Rules,
    /// The rules of the facade that is written; none while a facade is read or drawn.
    pub known: Option<&'s Rules>,
    /// Number of labels and of rules that the library has.
    pub library: (usize, usize),
}

/// The numbers in the table at hand of labels and rules of the known one.
struct Names {
    label: BTreeMap<u32, u32>,
    rule: BTreeMap<u32, u32>,
}

impl<C: Coder> Speller<'_, C> {
    /// Chooses the root; `value` is the root in the known rules. The result is in [`Speller::rules`].
    pub(super) fn root(&mut self, value: Option<Symbol>) -> Option<Symbol> {
        let roots: Vec<(Symbol, u32)> = self.table.roots.iter().map(|(&s, &n)| (s, n)).collect();
        let all: u32 = roots.iter().map(|root| root.1).sum();
        let once = roots.iter().filter(|root| root.1 == 1).count() as f64;
        let new = (once + 0.5) / (f64::from(all) + 1.0);
        let mut names = Names {
            label: BTreeMap::new(),
            rule: BTreeMap::new(),
        };
        let mut weights: Vec<f64> = roots
            .iter()
            .map(|root| (1.0 - new) * f64::from(root.1) / f64::from(all.max(1)))
            .collect();
        weights.push(new);
        let at = value.map(|root| {
            roots
                .iter()
                .position(|known| known.0 == root)
                .unwrap_or(roots.len())
        });
        let at = self.coder.choose(&weights, at)?;
        if let Some(&(root, _)) = roots.get(at) {
            return Some(root);
        }
        // Terminals of a facade of one region, known rules, or a new rule with its direction.
        let axis = value.map(|root| match root {
            Symbol::Terminal(_) => 0,
            Symbol::Rule(_) => match self.known.and_then(|known| known.axis(root)) {
                Some(Axis::Y) => 1,
                _ => 2,
            },
        });
        match self.coder.choose(&[0.05, 0.9, 0.05], axis)? {
            0 => self.symbol(None, Token::End, value, &mut names, 0),
            1 => self.symbol(Some(Axis::Y), Token::End, value, &mut names, 0),
            _ => self.symbol(Some(Axis::X), Token::End, value, &mut names, 0),
        }
    }

    /// Spells one symbol outside of any rule: a label (no axis), or a rule of a direction.
    fn symbol(
        &mut self,
        axis: Option<Axis>,
        previous: Token,
        value: Option<Symbol>,
        names: &mut Names,
        depth: usize,
    ) -> Option<Symbol> {
        let token = match axis {
            None => self.token(
                &self.labels_only(),
                previous,
                None,
                value.map(|v| self.tell(v, names)),
            )?,
            Some(axis) => {
                let mut may = vec![(Token::NewRule, 1.0)];
                may.extend(self.rules_of(axis).map(|s| (Token::Known(s), 0.5)));
                self.token(&may, previous, None, value.map(|v| self.tell(v, names)))?
            }
        };
        self.finish(token, axis, value, names, depth)
    }

    /// The symbol of a chosen token, spelling what is new.
    fn finish(
        &mut self,
        token: Token,
        axis: Option<Axis>,
        value: Option<Symbol>,
        names: &mut Names,
        depth: usize,
    ) -> Option<Symbol> {
        match token {
            Token::Known(symbol) => Some(symbol),
            Token::NewLabel => {
                let label = match (value, self.known) {
                    (Some(Symbol::Terminal(own)), Some(known)) => {
                        Some(known.labels()[own as usize].clone())
                    }
                    _ => None,
                };
                let bytes = self.bytes(label.as_deref())?;
                let symbol = self.rules.label(&String::from_utf8(bytes).ok()?);
                if let (Some(Symbol::Terminal(own)), Symbol::Terminal(new)) = (value, symbol) {
                    names.label.insert(own, new);
                }
                Some(symbol)
            }
            Token::NewRule => {
                let rule = match (value, self.known) {
                    (Some(Symbol::Rule(own)), Some(known)) => Some(known.rule(own)),
                    _ => None,
                };
                let new = self.rule(axis?, rule, names, depth + 1)?;
                let symbol = self.rules.intern(new);
                if let (Some(Symbol::Rule(own)), Symbol::Rule(new)) = (value, symbol) {
                    names.rule.insert(own, new);
                }
                Some(symbol)
            }
            _ => None,
        }
    }

    /// The token for a symbol of the known rules.
    fn tell(&self, symbol: Symbol, names: &Names) -> Token {
        let own = |index: u32, given: &BTreeMap<u32, u32>, library: usize| {
            given
                .get(&index)
                .copied()
                .or(((index as usize) < library).then_some(index))
        };
        let (labels, rules) = self.library;
        match symbol {
            Symbol::Terminal(l) => own(l, &names.label, labels)
                .map_or(Token::NewLabel, |l| Token::Known(Symbol::Terminal(l))),
            Symbol::Rule(r) => {
                own(r, &names.rule, rules).map_or(Token::NewRule, |r| Token::Known(Symbol::Rule(r)))
            }
        }
    }

    fn labels_only(&self) -> Vec<(Token, f64)> {
        let labels =
            (0..self.rules.labels().len() as u32).map(|l| (Token::Known(Symbol::Terminal(l)), 1.0));
        labels.chain([(Token::NewLabel, 0.1)]).collect()
    }

    fn rules_of(&self, axis: Axis) -> impl Iterator<Item = Symbol> {
        let rules = self.rules.rules().iter().enumerate();
        rules
            .filter(move |(_, rule)| rule.axis == axis)
            .map(|(k, _)| Symbol::Rule(k as u32))
    }

    /// Spells the items of a rule.
    fn rule(
        &mut self,
        axis: Axis,
        value: Option<&Rule>,
        names: &mut Names,
        depth: usize,
    ) -> Option<Rule> {
        if depth > DEPTH_LIMIT {
            return None;
        }
        let mut written = value.map(|rule| tokens(rule).into_iter());
        let (mut items, mut period): (Vec<Item>, Option<Vec<Symbol>>) = (Vec::new(), None);
        let mut previous = Token::End;
        while items.len() < ITEM_LIMIT {
            let next = written
                .as_mut()
                .map(|tokens| tokens.next().unwrap_or(Token::End));
            let value = match next {
                Some(Token::Known(symbol)) => Some(symbol),
                _ => None,
            };
            let told = next.map(|token| match token {
                Token::Known(symbol) => self.tell(symbol, names),
                other => other,
            });
            let mut may = vec![(Token::NewRule, 0.5), (Token::NewLabel, 0.02)];
            match &period {
                None => may.extend([(Token::End, 0.5), (Token::Open, 0.5)]),
                Some(_) => may.push((Token::Close, 0.5)),
            }
            let labels = (0..self.rules.labels().len() as u32).map(Symbol::Terminal);
            may.extend(
                labels
                    .chain(self.rules_of(axis.other()))
                    .map(|s| (Token::Known(s), 0.1)),
            );
            let token = self.token(&may, previous, Some(axis), told)?;
            match token {
                Token::End => {
                    let enough = items.len() > 1 || items.first().is_some_and(Item::is_repeat);
                    return enough.then_some(Rule { axis, items });
                }
                Token::Open => period = Some(Vec::new()),
                Token::Close => items.push(Item::Repeat(period.take().filter(|p| !p.is_empty())?)),
                _ => {
                    let symbol = self.finish(token, Some(axis.other()), value, names, depth)?;
                    match &mut period {
                        Some(period) => period.push(symbol),
                        None => items.push(Item::Part(symbol)),
                    }
                }
            }
            previous = token;
        }
        None
    }

    /// Chooses one of the tokens that may come, with their smoothing weights.
    fn token(
        &mut self,
        may: &[(Token, f64)],
        previous: Token,
        axis: Option<Axis>,
        value: Option<Token>,
    ) -> Option<Token> {
        let follows = axis.and_then(|axis| self.table.follows.get(&(axis, previous)));
        let seen = axis.map(|axis| &self.table.seen[index(axis)]);
        let count = |counts: Option<&BTreeMap<Token, u32>>, token| {
            f64::from(counts.and_then(|c| c.get(&token)).copied().unwrap_or(0))
        };
        let base: Vec<f64> = may
            .iter()
            .map(|&(token, smoothing)| count(seen, token) + smoothing)
            .collect();
        let sum: f64 = base.iter().sum();
        let weights: Vec<f64> = may
            .iter()
            .zip(&base)
            .map(|(&(token, _), base)| count(follows, token) + BETA * base / sum)
            .collect();
        let at = match value {
            Some(value) => Some(may.iter().position(|token| token.0 == value)?),
            None => None,
        };
        Some(may[self.coder.choose(&weights, at)?].0)
    }

    /// Spells a label: letters are likelier than other bytes; 0 ends it.
    fn bytes(&mut self, label: Option<&str>) -> Option<Vec<u8>> {
        let weights: Vec<f64> = (0..256u32)
            .map(|byte| match byte as u8 {
                0 => 4.0,
                b'a'..=b'z' => 1.0,
                b'A'..=b'Z' | b'0'..=b'9' | b'_' | b'-' | b' ' => 0.2,
                _ => 0.01,
            })
            .collect();
        let mut bytes = Vec::new();
        while bytes.len() <= LABEL_LIMIT {
            let value = label.map(|l| {
                l.as_bytes()
                    .get(bytes.len())
                    .copied()
                    .map_or(0, usize::from)
            });
            match self.coder.choose(&weights, value)? {
                0 => return (!bytes.is_empty()).then_some(bytes),
                byte => bytes.push(byte as u8),
            }
        }
        None
    }
}
