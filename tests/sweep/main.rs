//! Sweeps: definition, runs, refusals, reports.

mod papers;
mod refusals;
mod robust;
mod running;
