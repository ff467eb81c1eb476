//! The papers' methods, one folder per paper; no method imports another.

pub mod building_exteriors;
pub mod city_proceduralization;
pub mod facade_grammar;
pub mod procedural_logic;
pub mod structure_completion;
