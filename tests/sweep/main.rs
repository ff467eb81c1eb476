//! Sweeps: definition, runs, refusals, reports.

mod commands;
mod judges;
mod leaderboard;
#[cfg(unix)]
mod lies;
mod papers;
mod refusals;
mod robust;
mod running;
