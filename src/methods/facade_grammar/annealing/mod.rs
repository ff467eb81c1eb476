//! Second stage of the default method: annealing over the set of non-terminal types.
//!
//! A grammar is determined by its set `N` of non-terminal region types: given `N`, the best rule of
//! each type is a shortest path over strips that are terminals or members of `N` (or a grid of such
//! cells), independent of all others, and the cost is the sum over the members. A move adds a type,
//! removes one, exchanges one for another with a shifted border, or adds all successors of a rule that
//! the splitting heuristic draws; only the rules that the move touches are found anew. A type that no
//! rule uses any more leaves the set; a member left without a rule gets one that calls in further
//! members, priced with what approximate dynamic programming learnt.

mod moves;
mod nonterminal_set;

pub(super) use nonterminal_set::NonterminalSet;
