//! What holds on real facades and houses; skipped where there are none.

#[path = "../common/mod.rs"]
mod common;

mod cities;
mod completion;
mod facades;
mod grammar;
mod houses;
mod joint;
mod procedural_logic;
