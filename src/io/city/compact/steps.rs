//! Steps in which numbers are whole.

use super::error::CompactError;
use super::unit::Steps;
use edifice_grammar::instance::{InstanceGrammar, Placement};

/// Steps of a share, or of a level, in a rule with parameters.
pub(super) const SHARES: i64 = 1024;
/// Steps that are tried, the coarsest first.
const LENGTHS: [i64; 10] = [1, 2, 4, 5, 8, 10, 20, 50, 100, 1000];
const TURNS: [i64; 8] = [1, 2, 4, 5, 10, 100, 1000, 10_000];
const SHAPES: [i64; 8] = [31, 63, 127, 255, 511, 1023, 4095, 65_535];

impl Steps {
    /// The coarsest steps on which a grammar lies; the finest, where it lies on none.
    pub(super) fn of(grammar: &InstanceGrammar) -> Self {
        let placements = placements(grammar);
        let templates = || grammar.templates.iter();
        let terminals: rustc_hash::FxHashSet<&str> =
            templates().map(|t| t.symbol.as_str()).collect();
        let lengths = |p: &Placement| -> Vec<f64> {
            let size = if terminals.contains(p.symbol.as_str()) {
                p.size
            } else {
                [0.0; 3]
            };
            let numbers = p.numbers.iter().copied();
            p.at.into_iter().chain(size).chain(numbers).collect()
        };
        // Corners that no triangle has are not written.
        let corners = || {
            templates().flat_map(|t| {
                let used = t.mesh.triangles.iter().flatten();
                used.map(|&i| &t.mesh.positions[i as usize])
            })
        };
        Self {
            length: first(&LENGTHS, |s| {
                let mut all = placements.iter().flat_map(|p| lengths(p));
                all.all(|v| whole(v, s))
            }),
            turn: first(&TURNS, |s| {
                let shares = shares(grammar);
                let mut all = placements.iter().copied().chain(shares);
                all.all(|p| whole(p.turn, s))
            }),
            shape: first(&SHAPES, |s| {
                let on =
                    |p: &[f64; 3]| whole(p[0] + 0.5, s) && whole(p[1] + 0.5, s) && whole(p[2], s);
                corners().all(on)
            }),
        }
    }

    /// Steps as a file gives them.
    pub(super) fn checked(self) -> Result<Self, CompactError> {
        let usable = |v: i64| (1..=65_535).contains(&v);
        match usable(self.length) && usable(self.turn) && usable(self.shape) {
            true => Ok(self),
            false => Err(CompactError::Steps(self)),
        }
    }
}

/// A number of steps, if there are not too many.
pub(super) fn in_steps(v: f64, steps: i64) -> Result<i64, CompactError> {
    let whole = (v * steps as f64).round();
    match whole.abs() < (1_u64 << 40) as f64 {
        true => Ok(whole as i64),
        false => Err(CompactError::Number(v)),
    }
}

/// Refuses numbers that could not be written again, whatever the steps.
pub(super) fn writable(grammar: &InstanceGrammar) -> Result<(), CompactError> {
    let finest = |tried: &[i64]| tried.last().copied().unwrap_or(1);
    let (length, turn, shape) = (finest(&LENGTHS), finest(&TURNS), finest(&SHAPES));
    let shares = shares(grammar).into_iter().map(|p| (p, SHARES));
    let placed = placements(grammar).into_iter().map(|p| (p, length));
    for (p, steps) in placed.chain(shares) {
        let numbers = p.numbers.iter().copied();
        for v in p.at.into_iter().chain(p.size).chain(numbers) {
            in_steps(v, steps)?;
        }
        in_steps(p.turn, turn)?;
    }
    let corners = grammar.templates.iter().flat_map(|t| &t.mesh.positions);
    for v in corners.flatten() {
        // Corners are counted from the side of the box.
        in_steps(v.abs() + 0.5, shape)?;
    }
    Ok(())
}

/// The successors of rules with parameters, whose lengths are shares.
fn shares(grammar: &InstanceGrammar) -> Vec<&Placement> {
    let own = grammar.rules.iter().filter(|r| r.levels > 0);
    own.flat_map(|r| &r.successors).collect()
}

/// All other placements of all rules, parts of parts too.
fn placements(grammar: &InstanceGrammar) -> Vec<&Placement> {
    let mut all = Vec::new();
    let own = grammar.rules.iter().filter(|r| r.levels == 0);
    let mut open: Vec<&Placement> = own.flat_map(|r| &r.successors).collect();
    while let Some(p) = open.pop() {
        all.push(p);
        open.extend(p.parts.iter().flatten());
    }
    all
}

fn first(tried: &[i64], fits: impl Fn(i64) -> bool) -> i64 {
    let found = tried.iter().copied().find(|&s| fits(s));
    found.or(tried.last().copied()).unwrap_or(1)
}

/// True if a number is a whole number of steps, but for rounding.
fn whole(v: f64, steps: i64) -> bool {
    let scaled = v * steps as f64;
    (scaled - scaled.round()).abs() < 1e-6
}
