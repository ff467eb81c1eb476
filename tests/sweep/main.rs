//! Sweeps: definition, runs, refusals, reports.

#[path = "../common/cases.rs"]
mod cases;
mod commands;
mod judges;
mod leaderboard;
#[cfg(unix)]
mod lies;
mod papers;
mod refusals;
mod research_objects;
mod robust;
mod running;
