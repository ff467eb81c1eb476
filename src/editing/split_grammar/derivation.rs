//! A facade of a grammar, at its own or another size.

use edifice_base::rng;
use edifice_grammar::{Derivation, Grammar, GrammarError, derive_at, size_independent};
use edifice_layout::resize::{AlignError, align};
use edifice_shape::Facade;

/// The wanted derivation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// Index of the start.
    pub start: usize,
    /// Width and height; its own without.
    pub size: Option<(f64, f64)>,
    /// Seed of stochastic grammars.
    pub seed: u64,
    /// True if edges are aligned at another size than its own.
    pub align: bool,
}

/// A derived facade.
#[derive(Debug, Clone)]
pub struct Derived {
    /// The facade.
    pub facade: Facade,
    /// The derivation, before edges were aligned.
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
}

/// Derives a start: as it is written at its own size; at another, size-independent and with aligned edges.
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
    let grammar = size_independent(grammar);
    let derivation = at(&grammar, size)?;
    if !wish.align {
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
