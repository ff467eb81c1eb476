//! Sweeps: definition, runs, refusals, reports.

mod commands;
mod papers;
mod refusals;
mod robust;
mod running;
