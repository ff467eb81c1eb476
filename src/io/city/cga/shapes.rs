//! Start shapes: what the axiom of a grammar puts down, each type of building with its numbers.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::error::CgaCityError;
use edifice_grammar::instance::{
    INSTANCE_LIMIT, InstanceGrammar, InstanceGrammarError, Placement, Places,
};

/// The symbol that a start shape begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    /// A rule with parameters, by index.
    Rule(usize),
    /// A template that stands by itself, by index.
    Template(usize),
}

/// A start shape.
#[derive(Debug, Clone)]
pub(super) struct Start {
    pub kind: Kind,
    pub id: String,
    /// Middle of the base, in metres, z up.
    pub at: [f64; 3],
    /// Turn in degrees.
    pub turn: f64,
    /// Values of the attributes of its kind, in metres, then factors.
    pub numbers: Vec<f64>,
    /// Width and depth of the footprint in metres.
    pub plan: [f64; 2],
}

/// Walks from the axiom; parts stand where the rules put them.
pub(super) fn starts(grammar: &InstanceGrammar) -> Result<Vec<Start>, CgaCityError> {
    let templates = grammar.templates.iter().enumerate();
    let mut symbols: FxHashMap<&str, Kind> = templates
        .map(|(i, t)| (t.symbol.as_str(), Kind::Template(i)))
        .collect();
    for (i, rule) in grammar.rules.iter().enumerate() {
        symbols.entry(&rule.symbol).or_insert(Kind::Rule(i));
    }
    let mut walk = Walk {
        grammar,
        places: Places::new(grammar),
        symbols,
        instances: 0,
        starts: Vec::new(),
    };
    let axiom = Placement::new(grammar.axiom.as_str(), [0.0; 3], 0.0, [1.0; 3]);
    let frame = Frame {
        at: [0.0; 3],
        turn: 0.0,
        scale: 1.0,
        id: None,
    };
    walk.place(&axiom, &frame)?;
    Ok(walk.starts)
}

/// The frame of a symbol, and the building that it is a part of.
struct Frame<'f> {
    at: [f64; 3],
    turn: f64,
    scale: f64,
    id: Option<&'f str>,
}

struct Walk<'g> {
    grammar: &'g InstanceGrammar,
    places: Places<'g>,
    symbols: FxHashMap<&'g str, Kind>,
    /// Templates put down so far, as a derivation counts them.
    instances: usize,
    starts: Vec<Start>,
}

impl Walk<'_> {
    fn place(&mut self, placed: &Placement, frame: &Frame<'_>) -> Result<(), CgaCityError> {
        let (sin, cos) = frame.turn.to_radians().sin_cos();
        let [x, y, z] = placed.at.map(|v| v * frame.scale);
        let [a, b, c] = frame.at;
        let at = [a + x * cos - y * sin, b + x * sin + y * cos, c + z];
        let turn = frame.turn + placed.turn;
        let id = placed.id.as_deref().or(frame.id);
        let Some(&kind) = self.symbols.get(placed.symbol.as_str()) else {
            return Err(InstanceGrammarError::UnknownPart(placed.symbol.clone()).into());
        };
        let grammar = self.grammar;
        let (numbers, plan, parts) = match kind {
            Kind::Template(_) => {
                let size = placed.size.map(|v| v * frame.scale);
                (size.to_vec(), [size[0], size[1]], 1)
            }
            Kind::Rule(index) => {
                let rule = &grammar.rules[index];
                let scale = frame.scale * placed.size[0];
                if rule.levels == 0 {
                    let frame = Frame {
                        at,
                        turn,
                        scale,
                        id,
                    };
                    return self.inside(index, placed, &frame);
                }
                let factors = rule.scale.map(|f| f * scale);
                let plan = [0, 1].map(|k| placed.numbers[k] * factors[k]);
                let numbers = placed.numbers.iter().copied().chain(factors).collect();
                (numbers, plan, rule.successors.len())
            }
        };
        self.starts.push(Start {
            kind,
            id: id.map_or_else(|| format!("instance-{}", self.instances), str::to_owned),
            at,
            turn,
            numbers,
            plan,
        });
        self.instances += parts;
        match self.instances > INSTANCE_LIMIT {
            true => Err(InstanceGrammarError::TooLarge.into()),
            false => Ok(()),
        }
    }

    /// Everything that a rule without parameters puts down; identifiers are those of this instance.
    fn inside(
        &mut self,
        rule: usize,
        own: &Placement,
        frame: &Frame<'_>,
    ) -> Result<(), CgaCityError> {
        // Parts stand where the rules put them.
        let bare = Placement {
            parts: Vec::new(),
            ..own.clone()
        };
        for (i, placed) in self.places.of(rule, &bare).into_iter().enumerate() {
            let Some(placed) = placed else { continue };
            let mut part = placed.into_owned();
            if let Some(Some(residual)) = own.parts.get(i) {
                part.id = residual.id.clone().or(part.id);
            }
            self.place(&part, frame)?;
        }
        Ok(())
    }
}

/// Commonest values of the numbers of each kind of start shapes; of several the least.
pub(super) fn commonest(starts: &[Start]) -> BTreeMap<Kind, Vec<f64>> {
    let mut counts: BTreeMap<Kind, Vec<FxHashMap<u64, usize>>> = BTreeMap::new();
    for start in starts {
        let own = counts.entry(start.kind).or_default();
        own.resize_with(start.numbers.len(), FxHashMap::default);
        for (counts, v) in own.iter_mut().zip(&start.numbers) {
            *counts.entry(v.to_bits()).or_default() += 1;
        }
    }
    // The bits of numbers above 0 are in the order of the numbers.
    let most = |counts: FxHashMap<u64, usize>| {
        let best = counts.into_iter().max_by_key(|&(v, n)| (n, u64::MAX - v));
        best.map_or(1.0, |(v, _)| f64::from_bits(v))
    };
    let kinds = counts.into_iter();
    kinds
        .map(|(kind, counts)| (kind, counts.into_iter().map(most).collect()))
        .collect()
}
