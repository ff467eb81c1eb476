//! Procedural logic (Weissenberg et al. 2013).
