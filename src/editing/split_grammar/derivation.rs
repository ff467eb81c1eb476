//! A facade of a grammar, at its own or another size.

use std::collections::BTreeSet;

use edifice_base::rng;
use edifice_grammar::{Derivation, Grammar, GrammarError, derive_at, size_independent};
use edifice_layout::resize::{AlignError, BandsError, align, resized};
use edifice_shape::Facade;

/// The way to another size than the grammar's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resizing {
    /// Edges stay where the rules put them.
    Rules,
    /// Edges are aligned, equal terminals are made equal again.
    Aligned,
    /// Whole columns and floors of the facade at its own size repeat or go, and the rest is stretched.
    Bands,
}

impl Resizing {
    /// The way for a grammar of which nothing else is said: by bands where its rules say nothing of other sizes, as in grammars that
    /// were inferred from a facade; by its rules where they have relative sizes, or choices.
    pub fn usual(grammar: &Grammar) -> Self {
        let mut symbols = BTreeSet::new();
        let plain = grammar
            .rules
            .iter()
            .all(|r| symbols.insert(&r.symbol) && !r.operation.has_relative_sizes());
        match plain {
            true => Resizing::Bands,
            false => Resizing::Aligned,
        }
    }
}

/// The wanted derivation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// Index of the start.
    pub start: usize,
    /// Width and height; its own without.
    pub size: Option<(f64, f64)>,
    /// Seed of stochastic grammars.
    pub seed: u64,
    /// The way to another size than its own.
    pub resizing: Resizing,
}

/// A derived facade.
#[derive(Debug, Clone)]
pub struct Derived {
    /// The facade.
    pub facade: Facade,
    /// The derivation, before edges were aligned; that of the own size where bands repeat.
    pub derivation: Derivation,
    /// Terminals that are equal at the own size and could not stay so.
    pub unequal: Vec<String>,
}

/// Why nothing can be derived.
#[derive(Debug, thiserror::Error)]
pub enum DeriveError {
    /// The grammar or the size.
    #[error(transparent)]
    Grammar(#[from] GrammarError),
    /// Edges cannot be aligned.
    #[error(transparent)]
    Align(#[from] AlignError),
    /// The size, for bands.
    #[error(transparent)]
    Bands(#[from] BandsError),
}

/// Derives a start: as it is written at its own size; at another, size-independent or by bands.
///
/// # Errors
/// [`DeriveError`].
pub fn derived(grammar: &Grammar, wish: &Wish) -> Result<Derived, DeriveError> {
    let own = grammar.starts.get(wish.start).map(|s| (s.width, s.height));
    let own = own.ok_or(GrammarError::StartIndex {
        index: wish.start,
        count: grammar.starts.len(),
    })?;
    let size = wish.size.unwrap_or(own);
    // The same seed draws the same rules.
    let at = |grammar: &Grammar, (width, height): (f64, f64)| {
        let mut rng = rng::stream(wish.seed, "grammar derive", 0);
        derive_at(grammar, wish.start, width, height, &mut rng)
    };
    if size == own {
        let derivation = at(grammar, own)?;
        return Ok(Derived {
            facade: derivation.facade.clone(),
            derivation,
            unequal: Vec::new(),
        });
    }
    if wish.resizing == Resizing::Bands {
        let derivation = at(grammar, own)?;
        let found = resized(&derivation.facade, size.0, size.1)?;
        return Ok(Derived {
            facade: found.facade,
            derivation,
            unequal: found.cut,
        });
    }
    let grammar = size_independent(grammar);
    let derivation = at(&grammar, size)?;
    if wish.resizing == Resizing::Rules {
        return Ok(Derived {
            facade: derivation.facade.clone(),
            derivation,
            unequal: Vec::new(),
        });
    }
    let aligned = align(&at(&grammar, own)?, &derivation)?;
    Ok(Derived {
        facade: aligned.facade,
        derivation,
        unequal: aligned.unequal,
    })
}
