//! Sweeps: definition, runs, refusals, reports.

mod commands;
mod judges;
mod papers;
mod refusals;
mod robust;
mod running;
