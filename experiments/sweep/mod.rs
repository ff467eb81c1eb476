//! Sweeps: ablations and comparisons from one file, on one machine or a cluster.
//!
//! A sweep file (TOML) names a [`Study`], what is varied, the instances and the seeds ([`definition`]). From it come a [`Plan`] of
//! tasks that are keyed by their content, results in one [`journal`] per shard, and tables, tests and figures ([`report`]).
//! A folder holds everything of a sweep:
//!
//! | file | what |
//! | --- | --- |
//! | `plan.jsonl` | arms, instances, tasks |
//! | `journal/I-of-N.jsonl` | what shard `I` of `N` found, a line per task |
//! | `results.csv`, `times.csv` | the same as tables; the first is the same bytes however the tasks were run |
//! | `report/` | tables and figures |
//! | `data/` | unpacked data sets |
//!
//! A key is a hash of study, settings, command with its files, instance, what is learnt from, seed, and the sources that the study is made of
//! ([`Study::sources`]). So a changed arm is run alone, and results of changed methods are not mixed in.
//!
//! An arm is a built-in method, or a [`command`]: a program in any language that reads a question from files and writes an answer to a file. Both
//! pass the same judge ([`trial`]).

mod bounds;
pub mod bundle;
pub mod collect;
pub mod command;
pub mod definition;
pub mod examples;
pub mod given;
pub mod instances;
pub mod journal;
pub mod plan;
pub mod record;
pub mod report;
pub mod ro_crate;
pub mod run;
mod shared;
pub mod statistics;
pub mod study;
pub mod submit;
pub mod trial;

pub use given::Given;
pub use plan::Plan;
pub use shared::Shared;
pub use study::{Better, Outcome, Study};
