//! The sweep file: what is varied, over which instances and seeds.

mod arms;
mod file;
mod place;
mod task;

pub use arms::{Arm, arms};
pub use file::{Definition, ReportOptions, read};
pub use place::{nearest, suggestion};
pub use task::TaskOptions;
