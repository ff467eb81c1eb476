//! Facade grammars (Wu et al. 2014).
