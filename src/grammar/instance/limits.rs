//! Limits of grammars of instances.

/// Most placed templates that a derivation may have.
pub const INSTANCE_LIMIT: usize = 20_000_000;

/// Deepest nesting of rules.
pub(super) const DEEPEST: usize = 64;
