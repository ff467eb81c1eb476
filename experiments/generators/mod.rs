//! Made facades, houses and cities whose truth is known, for where real ones may not ship or have no known truth: each
//! paper's generator, seeded. Values only: the experiments write them to files.

pub mod building_exteriors;
pub mod city_proceduralization;
pub mod facade_grammar;
