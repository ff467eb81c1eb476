//! Sweeps: definition, runs, refusals, reports.

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
