//! Properties that hold on real facades and houses; skipped without such data.

#[path = "../common/cases.rs"]
mod cases;
#[path = "../common/mod.rs"]
mod common;

#[path = "../common/cga_judge.rs"]
mod cga_judge;
mod cities;
mod completion;
#[path = "../common/doors.rs"]
mod doors;
mod facades;
mod grammar;
mod houses;
mod joint;
mod procedural_logic;
mod resize;
